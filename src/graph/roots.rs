//! Ancestry of a graph that continues a partially grown set instead of starting a new one.

use std::ops::Range;

use crate::draws::Path;
use crate::geometry::{Frame, Frame2};
use crate::instancing::Appearance;

use super::Chain;

/// Ancestry of the elements and fractals from which a graph starts in the middle of growth.
#[derive(Clone, Debug, Default)]
pub(crate) struct Roots<F: Frame = Frame2> {
    /// Ancestry of the elements of the initiator and of the [seeded](Self::seeded) chains, by position.
    pub(crate) elements: Vec<Root>,
    /// Fractals seeded before, in the order of their parent fractals, each after its parent; the seeds of
    /// one fractal are in the order of their birth steps, then of the elements that seeded them.
    pub(crate) seeded: Vec<SeededFractal<F>>,
}

/// Ancestry of an element.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Root {
    /// Step of its birth.
    pub(crate) level: u32,
    pub(crate) path: Path,
    /// Length relative to that of the initiator element from which it descends.
    pub(crate) length: f64,
    /// Appearance that its ancestors and itself apply.
    pub(crate) appearance: Appearance,
}

/// Fractal that was seeded before.
#[derive(Clone, Debug)]
pub(crate) struct SeededFractal<F: Frame = Frame2> {
    /// Number of the fractal that seeded it: that of an image of the initiator, which come first, or its number in the
    /// list after them.
    pub(crate) by: usize,
    /// Position of the first root whose descendants come after the element that seeded it.
    pub(crate) before: u32,
    /// Step of its birth.
    pub(crate) born: u32,
    /// Roots that it consists of.
    pub(crate) chain: Chain<F>,
}

impl<F: Frame> Roots<F> {
    /// Returns the range of fractals that a fractal has seeded before.
    pub(crate) fn seeded_by(&self, fractal: usize) -> Range<usize> {
        let from = self.seeded.partition_point(|seeded| seeded.by < fractal);
        let to = self.seeded.partition_point(|seeded| seeded.by <= fractal);
        from..to
    }
}
