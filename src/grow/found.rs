//! Results of a descent: elements, blocks in the place of elements, and subtrees left to other descents.

use crate::geometry::{Frame, Frame2};

use super::Subtree;
use super::block::{Blocks, Run};
use super::sizes::Sizes;
use super::start::TraversalState;

/// Element that a descent has reached.
#[derive(Clone, Copy, Debug)]
pub(super) struct FoundElement<F: Frame = Frame2> {
    pub(super) state: TraversalState<F>,
    pub(super) object: usize,
    /// Step of its birth.
    pub(super) level: u32,
    pub(super) joined: bool,
    /// Rank at its level; 0 unless ranks are counted.
    pub(super) rank: u64,
    /// Rank in its fractal, from 1; for an element that is replaced, the rank of its first descendant.
    pub(super) index: u128,
}

impl<F: Frame> FoundElement<F> {
    /// Returns the element as the root of a subtree.
    pub(super) fn subtree(&self) -> Subtree<F> {
        Subtree {
            frame: self.state.frame,
            object: self.object,
            born: self.level,
        }
    }
}

/// Element that a descent has reached and whose subtree it leaves to another descent.
#[derive(Clone, Copy, Debug)]
pub(super) struct FoundSubtree<F: Frame> {
    /// Root of the subtree; `joined` is whether the preceding element ends where it starts.
    pub(super) root: FoundElement<F>,
    /// Upper bound of its number of descendants.
    pub(super) size: u64,
    /// Whether its end point is also that of every replaced ancestor of which it is the last part.
    pub(super) meets_end: bool,
}

/// Next position of a descent.
pub(super) enum Next<'b, F: Frame> {
    /// Element of the approximant.
    Element(FoundElement<F>),
    /// Consecutive elements, if the descent stops at blocks.
    Run(Run<'b, F>),
    /// Element to be replaced, if the descent stops at subtrees. The descent assumes that its last
    /// descendant reaches its end point.
    Subtree(FoundSubtree<F>),
    /// Many elements were replaced since the last result: an opportunity to stop.
    Pause,
    /// End of the fractal.
    End,
}

/// Condition under which a descent does not replace an element.
#[derive(Clone, Copy)]
pub(super) enum Stop<'b, F: Frame> {
    Nowhere,
    /// The element is replaced by a block.
    AtBlocks(&'b Blocks<F>),
    /// The number of descendants is known to be small.
    AtSubtrees(&'b Sizes),
}
