//! Whether an approximant is within a number of elements.

use super::{Count, Graph};

/// An approximant that has more elements than are allowed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// The number of elements, unless it has more than some thousand digits.
    pub elements: Option<Count>,
    /// The deepest step within the limit; `None` if there is none.
    pub deepest: Option<u32>,
}

/// Numbers of more digits than this are not worked out only to be refused.
const MOST_DIGITS: usize = 5_000;

/// A forecast that takes more additions than this is given up.
const MOST_WORK: usize = 2_000_000;

impl Graph {
    /// The number of elements of an approximant, if all up to it are within a number of elements;
    /// where the graph does not tell, or not soon, they are.
    ///
    /// # Errors
    ///
    /// If they are not: how many elements there are, and how deep one can go.
    pub fn check_size(&self, steps: u32, most_elements: u64) -> Result<Option<u64>, TooLarge> {
        let Some(mut forecast) = self.forecast() else {
            return Ok(None);
        };
        let most = Count::from(most_elements);
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
            } else if elements.digits() > MOST_DIGITS || forecast.work > MOST_WORK {
                return Err(TooLarge {
                    elements: None,
                    deepest,
                });
            }
            if step == steps {
                return Ok(elements.to_u64());
            }
            if !refused && forecast.work > MOST_WORK || !forecast.advance() {
                break;
            }
        }
        Ok(None)
    }
}
