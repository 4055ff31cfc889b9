use std::convert::Infallible;
use std::num::NonZero;

use crate::geometry::Bounds;
use crate::graph::Graph;

use super::{Element, Fractal, Growth, Run, Visitor, WalkError, Walked, walk_in_spans};

/// Counting is fast: spans must be long to be worth while.
const MANY: u64 = 1 << 16;

/// What an approximant is found to have, by walking over all of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counted {
    /// The numbers of elements and of fractals.
    pub walked: Walked,
    /// The number of elements that are replaced in the next step.
    pub fertile: u64,
    /// The sum of |p1 − p0| over all elements.
    pub length: f64,
    /// The box of what is drawn, without strokes; empty if nothing is visible.
    pub bounds: Bounds,
}

/// Walks over an approximant on several threads, and tells what it has.
///
/// This knows nothing of forecasts and of what the graph tells of bounds: it puts every element in
/// its place. The result does not depend on the number of threads, to the last bit.
///
/// # Errors
///
/// If the walk ends early.
pub fn count(
    graph: &Graph,
    growth: &Growth<'_>,
    threads: NonZero<usize>,
) -> Result<Counted, WalkError<Infallible>> {
    let none = Counter {
        graph,
        fertile: 0,
        length: 0.0,
        bounds: Bounds::EMPTY,
    };
    let mut all = none;
    let walked = walk_in_spans(
        graph,
        growth,
        threads,
        Some(MANY),
        || none,
        |span, _| {
            all.fertile += span.fertile;
            all.length += span.length;
            all.bounds.add_all(&span.bounds);
            *span = none;
            Ok(())
        },
    )?;
    Ok(Counted {
        walked,
        fertile: all.fertile,
        length: all.length,
        bounds: all.bounds,
    })
}

/// Counts what it sees.
#[derive(Clone, Copy)]
struct Counter<'g> {
    graph: &'g Graph,
    fertile: u64,
    length: f64,
    bounds: Bounds,
}

impl Visitor for Counter<'_> {
    type Error = Infallible;

    fn takes_runs(&self) -> bool {
        true
    }

    fn begin(&mut self, _: Fractal) -> Result<(), Infallible> {
        Ok(())
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.fertile += u64::from(element.fertile);
        self.length += element.frame.length();
        let object = &self.graph.objects()[element.object];
        if object.visible {
            let base_element = &self.graph.base_elements()[object.base_element];
            base_element.add_to(&mut self.bounds, &element.frame.map, 0.0);
        }
        Ok(())
    }

    fn run(&mut self, run: &Run<'_>) -> Result<(), Infallible> {
        self.fertile += run.fertile();
        self.length += run.length();
        run.add_to(&mut self.bounds);
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}
