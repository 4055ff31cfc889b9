//! Points near a limit set that has to be grown: where maps are drawn, or change from step to step.

use std::convert::Infallible;

use crate::geometry::DVec2;
use crate::graph::{Graph, Replacement};
use crate::grow::{Element, Enter, Fractal, Growth, Subtree, Visitor, WalkError, walk};

/// Points near the limit set of one draw, and how near.
#[derive(Clone, Debug)]
pub struct Grown {
    /// The middles of fertile elements that are no longer than the detail.
    pub points: Vec<DVec2>,
    /// The length at which elements have not been replaced any more, in the rule's units.
    pub detail: f64,
}

/// Grows fertile elements down to a length that halves again and again, as long as there are no more
/// than `most` of them.
///
/// # Errors
///
/// If the walk ends early, or if there are more at once. Where indices are counted, nothing can be
/// cut off, and all elements of the last step are taken.
pub fn grown(
    graph: &Graph,
    growth: &Growth<'_>,
    most: usize,
) -> Result<Grown, WalkError<Infallible>> {
    let start = graph.initiator(growth.steps).instances.iter();
    let longest = start.map(|instance| instance.length).fold(0.0, f64::max);
    let at = |detail: f64| {
        let mut tips = Tips {
            graph,
            detail,
            most,
            points: Vec::new(),
        };
        match walk(graph, growth, &mut tips) {
            Ok(_) => Ok(Some(Grown {
                points: tips.points,
                detail,
            })),
            Err(WalkError::Visitor(Enough)) => Ok(None),
            Err(WalkError::TooManyElements { limit }) => Err(WalkError::TooManyElements { limit }),
            Err(WalkError::TooLong { limit }) => Err(WalkError::TooLong { limit }),
            Err(WalkError::NotFinite(error)) => Err(WalkError::NotFinite(error)),
            Err(WalkError::Cancelled) => Err(WalkError::Cancelled),
        }
    };
    const FINEST: f64 = 1.0 / 4096.0;
    let mut detail = longest / 8.0;
    let mut best = at(detail)?.ok_or(WalkError::TooManyElements { limit: most as u64 })?;
    while detail > FINEST * longest {
        detail /= 2.0;
        match at(detail) {
            Ok(Some(finer)) => best = finer,
            // What is known is as fine as it gets.
            Ok(None) | Err(WalkError::TooManyElements { .. } | WalkError::TooLong { .. }) => break,
            Err(error) => return Err(error),
        }
    }
    Ok(best)
}

/// There are as many points as may be.
struct Enough;

struct Tips<'g> {
    graph: &'g Graph,
    detail: f64,
    most: usize,
    points: Vec<DVec2>,
}

impl Visitor for Tips<'_> {
    type Error = Enough;

    fn begin(&mut self, _: Fractal) -> Result<(), Enough> {
        Ok(())
    }

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        if subtree.frame.length() <= self.detail {
            Enter::Keep
        } else {
            Enter::Replace
        }
    }

    fn element(&mut self, element: &Element) -> Result<(), Enough> {
        let object = &self.graph.objects()[element.object];
        if matches!(object.replacement, Replacement::Kept) {
            return Ok(());
        }
        if self.points.len() == self.most {
            return Err(Enough);
        }
        let [from, to] = element.frame.ends();
        self.points.push(from.midpoint(to));
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Enough> {
        Ok(())
    }
}
