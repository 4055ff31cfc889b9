//! Check of the number of elements of an approximant against a limit.

use crate::count::Count;
use crate::geometry::Frame;

use super::Graph;

/// Error: an approximant has more elements than are allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// Number of elements; `None` if it was not computed, because it has several thousand digits or takes
    /// too much work.
    pub elements: Option<Count>,
    /// Deepest step within the limit; `None` if step 0 exceeds it.
    pub deepest: Option<u32>,
}

/// Limit of digits beyond which the number of elements of a refused approximant is not computed.
const MAX_DIGITS: usize = 5_000;

impl<F: Frame> Graph<F> {
    /// Returns the largest number of steps, up to `steps`, within which no approximant has more than `most` elements; 0 if
    /// approximant 0 has more, and `steps` as far as the graph has no forecast or consists of one approximant.
    pub(crate) fn deepest_step(&self, steps: u32, most: u64) -> u32 {
        let most = Count::from(most);
        let Some(mut forecast) = self.forecast().filter(|_| !self.is_of_one_step()) else {
            return steps;
        };
        while forecast.elements() <= most {
            if forecast.step() == steps || !forecast.advance() {
                return steps;
            }
        }
        forecast.step().saturating_sub(1)
    }

    /// Returns the number of elements of approximant `steps`, provided that no approximant up to it
    /// exceeds `max_elements`; `None` if the graph has no forecast, or none within a reasonable time.
    ///
    /// # Errors
    ///
    /// If the limit is exceeded: the number of elements, and the deepest step within the limit.
    pub fn check_size(&self, steps: u32, max_elements: u64) -> Result<Option<u64>, TooLarge> {
        self.check_counting(steps, max_elements, true)
    }

    /// Returns an error, with the deepest step within the limit if there is one, where [`check_size`](Self::check_size) does,
    /// but does not count the elements of further steps.
    #[cfg(feature = "cli")]
    pub(crate) fn check_fits(&self, steps: u32, max_elements: u64) -> Result<(), Option<u32>> {
        let checked = self.check_counting(steps, max_elements, false);
        checked.map(|_| ()).map_err(|error| error.deepest)
    }

    /// Checks the number of elements of an approximant. If it exceeds the limit, it is computed only if `is_counted`.
    fn check_counting(
        &self,
        steps: u32,
        max_elements: u64,
        is_counted: bool,
    ) -> Result<Option<u64>, TooLarge> {
        let Some(mut forecast) = self.forecast() else {
            return Ok(None);
        };
        if self.is_of_one_step() {
            let elements = forecast.elements().to_u64();
            return Ok(elements.filter(|elements| *elements <= max_elements));
        }
        let most = Count::from(max_elements);
        let mut deepest = None;
        let mut refused = false;
        for step in 0..=steps {
            let elements = forecast.elements();
            refused |= elements > most;
            if !refused {
                deepest = Some(step);
            } else if step == steps {
                return Err(TooLarge {
                    elements: Some(elements),
                    deepest,
                });
            }
            if step == steps {
                return Ok(elements.to_u64());
            }
            if refused && !is_counted {
                break;
            }
            if elements.digits() > MAX_DIGITS || !forecast.advance() {
                break;
            }
        }
        match refused {
            true => Err(TooLarge {
                elements: None,
                deepest,
            }),
            false => Ok(None),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

    use crate::Fractal;

    #[test]
    fn deepest_steps_are_those_of_checks() {
        for name in ["koch", "dragon", "pythagoras", "maple-leaf", "archipelago"] {
            let fractal = Fractal::named(name).unwrap();
            let graph = fractal.model().compile(8).unwrap();
            for most in [0, 1, 5, 100, 5_000, u64::MAX] {
                let checked = match graph.check_size(8, most) {
                    Ok(_) => 8,
                    Err(refused) => refused.deepest.unwrap_or(0),
                };
                assert_eq!(graph.deepest_step(8, most), checked, "{name} {most}");
                #[cfg(feature = "cli")]
                {
                    let refused = graph.check_size(8, most).err();
                    let deepest = refused.map(|refused| refused.deepest);
                    assert_eq!(graph.check_fits(8, most).err(), deepest, "{name} {most}");
                }
            }
        }
    }
}
