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
    /// Returns the number of elements of approximant `steps`, provided that no approximant up to it
    /// exceeds `max_elements`; `None` if the graph has no forecast, or none within a reasonable time.
    ///
    /// # Errors
    ///
    /// If the limit is exceeded: the number of elements, and the deepest step within the limit.
    pub fn check_size(&self, steps: u32, max_elements: u64) -> Result<Option<u64>, TooLarge> {
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
