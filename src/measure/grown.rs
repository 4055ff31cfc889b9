//! Points near a limit set that has to be grown because its maps are drawn by chance or change from step to
//! step.

use std::convert::Infallible;

use crate::geometry::DVec2;
use crate::graph::Graph;
use crate::grow::{Element, Enter, Growth, Subtree, Visitor, WalkError, walk};

/// Points near the limit set of one draw, and their resolution.
#[derive(Clone, Debug)]
pub struct GrownPoints {
    /// Midpoints of fertile elements that are no longer than the detail.
    pub points: Vec<DVec2>,
    /// Length down to which elements have been replaced, in the rule's units.
    pub detail: f64,
}

/// Grows fertile elements down to a length that is halved repeatedly, as long as there are at most `most` of
/// them.
///
/// The length starts at an eighth of the longest element of the initiator and ends at about 1/4096 of it.
///
/// # Errors
///
/// Returns an error if the walk ends early, or if the first length already gives more than `most` elements.
/// Where indices are counted, nothing can be cut off, and all elements of the last step are taken.
pub fn grown(
    graph: &Graph,
    growth: &Growth<'_>,
    most: usize,
) -> Result<GrownPoints, WalkError<Infallible>> {
    let start = graph.initiator(growth.steps).instances.iter();
    let longest = start.map(|instance| instance.length).fold(0.0, f64::max);
    let at = |detail: f64| {
        let mut tips = Tips {
            detail,
            most,
            points: Vec::new(),
        };
        match walk(graph, growth, &mut tips) {
            Ok(_) => Ok(Some(GrownPoints {
                points: tips.points,
                detail,
            })),
            Err(WalkError::Visitor(Enough)) => Ok(None),
            Err(error) => Err(error.map_visitor(|Enough| unreachable!("that is no error"))),
        }
    };
    const FINEST: f64 = 1.0 / 4096.0;
    let mut detail = longest / 8.0;
    let mut best = at(detail)?.ok_or(WalkError::TooManyElements { limit: most as u64 })?;
    while detail > FINEST * longest {
        detail /= 2.0;
        match at(detail) {
            Ok(Some(finer)) => best = finer,
            // The finest length that is possible has been reached.
            Ok(None) | Err(WalkError::TooManyElements { .. } | WalkError::TooLong { .. }) => break,
            Err(error) => return Err(error),
        }
    }
    Ok(best)
}

/// Stops a walk that has found the maximum number of points.
struct Enough;

struct Tips {
    detail: f64,
    most: usize,
    points: Vec<DVec2>,
}

impl Visitor for Tips {
    type Error = Enough;

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        if subtree.frame.length() <= self.detail {
            Enter::Keep
        } else {
            Enter::Replace
        }
    }

    fn element(&mut self, element: &Element) -> Result<(), Enough> {
        if !element.fertile {
            return Ok(());
        }
        if self.points.len() == self.most {
            return Err(Enough);
        }
        let [from, to] = element.frame.ends();
        self.points.push(from.midpoint(to));
        Ok(())
    }
}
