//! Bounding box of an approximant, by a search or a walk.

use std::convert::Infallible;

use crate::geometry::{Bounds, Frame, Frame2, Outline};
use crate::graph::Graph;

use crate::grow::{Element, Enter, FractalInfo, Growth, Visitor, WalkError, walk};

use super::{Bounded, Reaches, search};

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
        all: &graph.reaches(|object| graph.outline_radius(object)),
        pads: &vec![0.0; graph.objects().len()],
    };
    if let Some(bounds) = search(graph, growth, &reaches, |_| Enter::Replace) {
        return Ok(bounds);
    }
    let mut extent = Extent {
        graph,
        bounds: Bounds::EMPTY,
    };
    walk(graph, growth, &mut extent)?;
    Ok(extent.bounds)
}

struct Extent<'g, F: Frame = Frame2> {
    graph: &'g Graph<F>,
    bounds: Bounds<F::Point>,
}

impl<F: Frame> Visitor<F> for Extent<'_, F> {
    type Error = Infallible;

    fn begin(&mut self, _: FractalInfo) -> Result<(), Infallible> {
        Ok(())
    }

    fn element(&mut self, element: &Element<F>) -> Result<(), Infallible> {
        if let Some(base_element) = self.graph.drawn(element.object) {
            base_element.add_to(&mut self.bounds, &element.frame, 0.0);
        }
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}
