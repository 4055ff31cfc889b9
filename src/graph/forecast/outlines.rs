//! Outlines that a graph draws: whether areas are enclosed.

use crate::geometry::{Frame, Outline as _, Point as _};
use crate::graph::{Chain, Graph, Object, Replacement, is_ring};

/// Kind of the outlines that a graph draws.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Outlines {
    /// All base elements are closed.
    ClosedElements,
    /// Every fractal is one closed path.
    ClosedPaths,
    Other,
}

impl<F: Frame> Graph<F> {
    /// Returns whether every fractal is one closed path of stroked elements at every step.
    #[must_use]
    pub fn draws_closed_paths(&self) -> bool {
        self.outlines() == Outlines::ClosedPaths
    }

    /// Returns the kind of the outlines that the graph draws.
    pub(super) fn outlines(&self) -> Outlines {
        let mut visible = self.objects.iter().filter(|object| object.visible);
        if visible.all(|object| self.base_elements()[object.base_element].is_closed()) {
            return Outlines::ClosedElements;
        }
        let closed = |chain: &Chain<F>| chain.is_joined() && chain.fractals().all(is_ring);
        let seeds = |object: &Object<F>| match &object.replacement {
            Replacement::Fixed(successor) => successor.seeds.iter().all(|seed| closed(&seed.chain)),
            Replacement::Kept | Replacement::Unresolved => true,
            Replacement::Evaluated(_) => false,
        };
        let encloses = F::Point::ZERO.triangle(F::Point::ZERO).is_some();
        if encloses
            && self.starts().all(closed)
            && self.objects.iter().all(seeds)
            && self.keeps_lines()
        {
            Outlines::ClosedPaths
        } else {
            Outlines::Other
        }
    }
}
