use std::convert::Infallible;

use crate::geometry::Bounds;
use crate::graph::Graph;

use super::{Element, Enter, Fractal, Growth, Reaches, Visitor, WalkError, search, walk};

#[cfg(test)]
mod tests;

/// The box of what an approximant draws, without stroke width: by a search for what reaches
/// farthest, where the graph tells how far things reach, or by walking over all of it.
///
/// [`Graph::bounds`] tells it without either where it can.
///
/// # Errors
///
/// If the walk ends early.
pub fn extent(graph: &Graph, growth: &Growth<'_>) -> Result<Bounds, WalkError<Infallible>> {
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
