//! Exact counts and the bounding box of an approximant, by a walk over all of its elements.

use std::convert::Infallible;
use std::num::NonZero;

use crate::geometry::{Bounds, DVec2, Frame, Outline};
use crate::graph::Graph;

use super::{Element, Growth, Run, Visitor, WalkError, Walked, walk_in_spans};

/// Number of elements in a span. Counting is fast: only long spans are worth the overhead.
const MANY: u64 = 1 << 16;

/// Result of [`count`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Counted<P = DVec2> {
    /// Numbers of elements and of fractals.
    pub walked: Walked,
    /// Number of elements that are replaced in the next step.
    pub fertile: u64,
    /// Sum of |p1 − p0| over all elements.
    pub length: f64,
    /// Bounding box of the outlines, without strokes; empty if nothing is visible.
    pub bounds: Bounds<P>,
}

/// Counts the elements of an approximant and computes its bounding box, on several threads.
///
/// Neither the forecast nor the bounds of the graph are used: every element is placed. The result does not
/// depend on the number of threads, to the last bit.
///
/// # Errors
///
/// Returns an error if the walk ends early.
pub fn count<F: Frame>(
    graph: &Graph<F>,
    growth: &Growth<'_>,
    threads: NonZero<usize>,
) -> Result<Counted<F::Point>, WalkError<Infallible>> {
    let none = Counter {
        takes_runs: true,
        ..Counter::one_by_one(graph)
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

/// Visitor that counts elements and extends a box.
#[derive(Clone, Copy)]
pub(crate) struct Counter<'g, F: Frame> {
    graph: &'g Graph<F>,
    takes_runs: bool,
    fertile: u64,
    length: f64,
    /// Box of the visible elements.
    pub(crate) bounds: Bounds<F::Point>,
}

impl<'g, F: Frame> Counter<'g, F> {
    /// Creates a visitor of elements, which takes no runs of them.
    pub(crate) fn one_by_one(graph: &'g Graph<F>) -> Self {
        Self {
            graph,
            takes_runs: false,
            fertile: 0,
            length: 0.0,
            bounds: Bounds::EMPTY,
        }
    }
}

impl<F: Frame> Visitor<F> for Counter<'_, F> {
    type Error = Infallible;

    fn takes_runs(&self) -> bool {
        self.takes_runs
    }

    fn element(&mut self, element: &Element<F>) -> Result<(), Infallible> {
        self.fertile += u64::from(element.fertile);
        self.length += element.frame.length();
        if let Some(base_element) = self.graph.drawn(element.object) {
            base_element.add_to(&mut self.bounds, &element.frame, 0.0);
        }
        Ok(())
    }

    fn run(&mut self, run: &Run<'_, F>) -> Result<(), Infallible> {
        self.fertile += run.fertile();
        self.length += run.length();
        run.add_to(&mut self.bounds);
        Ok(())
    }
}
