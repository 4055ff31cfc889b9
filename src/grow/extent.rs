use std::convert::Infallible;

use crate::geometry::Bounds;
use crate::graph::Graph;

use super::{Element, Fractal, Growth, Visitor, WalkError, walk};

/// The box of what an approximant draws, without stroke width, by walking over all of it.
///
/// [`Graph::bounds`] tells it without a walk where it can.
///
/// # Errors
///
/// If the walk ends early.
pub fn extent(graph: &Graph, growth: &Growth<'_>) -> Result<Bounds, WalkError<Infallible>> {
    let mut extent = Extent {
        graph,
        bounds: Bounds::EMPTY,
    };
    walk(graph, growth, &mut extent)?;
    Ok(extent.bounds)
}

struct Extent<'g> {
    graph: &'g Graph,
    bounds: Bounds,
}

impl Visitor for Extent<'_> {
    type Error = Infallible;

    fn begin(&mut self, _: Fractal) -> Result<(), Infallible> {
        Ok(())
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        let object = &self.graph.objects()[element.object];
        if object.visible {
            let base_element = &self.graph.base_elements()[object.base_element];
            base_element.add_to(&mut self.bounds, &element.frame.map, 0.0);
        }
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}
