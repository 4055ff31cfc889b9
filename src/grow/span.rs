//! Consecutive parts of a walk, which threads take over.

use crate::geometry::Frame;

use super::FractalInfo;
use super::colony::{Colony, Taken};
use super::found::{FoundElement, FoundSubtree};

/// Item of a span.
pub(super) enum SpanItem<'w, F: Frame> {
    /// Beginning of a fractal, with the step of its birth.
    Begin(FractalInfo, u32),
    Element(FoundElement<F>),
    Subtree(FoundSubtree<F>),
    /// Part of a colony that the visitor takes.
    Colony(Colony<'w, F>, Taken),
    /// End of the fractal; the flag holds only if the preceding element ends where its subtree does.
    End(bool),
}

/// Limit of a span.
#[derive(Clone, Copy, Default)]
pub(super) struct Position {
    pub(super) fractal: FractalInfo,
    /// Step in which the fractal was born.
    pub(super) born: u32,
    /// Number of its elements before the limit, if known; otherwise 0.
    pub(super) before: u128,
}

/// Consecutive part of a walk.
#[derive(Default)]
pub(super) struct Span<'w, F: Frame> {
    pub(super) from: Position,
    /// Position where it ends.
    pub(super) to: Position,
    pub(super) items: Vec<SpanItem<'w, F>>,
    /// Upper bound of its number of elements, plus 1 for each subtree and each fractal that begins.
    pub(super) size: u64,
    /// Number of visits above its subtrees.
    pub(super) visited: u64,
}

impl<'w, F: Frame> Span<'w, F> {
    /// Restarts at the end of another span.
    pub(super) fn follow(&mut self, other: &Self) {
        self.items.clear();
        (self.from, self.to) = (other.to, other.to);
        (self.size, self.visited) = (0, 0);
    }

    pub(super) fn push(&mut self, item: SpanItem<'w, F>, size: u64) {
        self.items.push(item);
        self.size += size;
    }

    /// Returns whether the span begins within a fractal.
    pub(super) fn goes_on(&self) -> bool {
        !matches!(
            self.items.first(),
            Some(SpanItem::Begin(..) | SpanItem::Colony(..))
        )
    }
}
