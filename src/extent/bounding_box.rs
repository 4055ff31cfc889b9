//! Bounding box of an approximant, by a search or a walk.

use std::convert::Infallible;

use crate::geometry::Bounds;
use crate::graph::Graph;

use crate::grow::{Counter, Enter, Growth, WalkError, walk};

use super::{Bounded, Limits, Reaches, search};

#[cfg(test)]
mod tests;

/// Computes the bounding box of an approximant, without stroke width: by branch and bound if the graph
/// bounds all subtrees, otherwise by a walk over all elements.
///
/// [`Graph::bounds`] returns the box without either, where it can.
///
/// # Errors
///
/// Returns an error if the walk ends early.
pub fn bounding_box<F: Bounded>(
    graph: &Graph<F>,
    growth: &Growth<'_>,
) -> Result<Bounds<F::Point>, WalkError<Infallible>> {
    let reaches = Reaches {
        all: &graph.reaches(graph.outline_radii()),
        pads: &vec![0.0; graph.objects().len()],
    };
    let limits = Limits::instead_of(growth.max_elements);
    if let Some(bounds) = search(graph, growth, &reaches, limits, |_| Enter::Replace) {
        return Ok(bounds);
    }
    let mut counter = Counter::one_by_one(graph);
    walk(graph, growth, &mut counter)?;
    Ok(counter.bounds)
}
