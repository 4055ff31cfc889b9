//! Growth: depth-first walks that stream the elements of an approximant in order.
//!
//! A walk holds one entry for each level of the graph: its memory grows with the number of steps, not with
//! the number of elements. A fractal that seeds new fractals is walked once for its own elements, and again,
//! to increasing depth, for its seeds. The expansion of an object over its last steps, or down to a cutoff
//! length, is computed once, as a block, for visitors that accept elements in [`Run`]s. Several threads can
//! walk over subtrees of one walk; their results are taken in order.
//!
//! A bounding box needs no walk where the graph bounds all subtrees: a search replaces only elements whose
//! subtrees may extend beyond the box found before. A limit set whose copies overlap is computed without
//! elements, on cells of the plane.

mod block;
mod cells;
mod census;
mod colony;
mod count;
mod descent;
mod elements;
mod evaluator;
mod found;
mod fractals;
mod outlines;
mod progress;
mod sizes;
mod span;
mod spans;
mod start;
mod tally;
mod walk;
mod whole;

#[cfg(test)]
mod tests;

pub(crate) use block::KeptBlocks;
pub use block::{LineElement, Run};
pub use colony::{Colony, Taken};
pub(crate) use count::Counter;
pub use count::{Counted, count};
pub use elements::Elements;
pub(crate) use outlines::{OutlineError, outlines};
pub use progress::Progress;
pub use spans::{Seam, walk_in_spans};
pub use walk::{Growth, Walked, walk};

pub(crate) use cells::{CellSearch, Field, FoundCells, Layer, LimitCells, Stopped};
pub(crate) use census::{Census, Cohort};
pub(crate) use colony::{ColonyKind, ColonyKinds};
pub(crate) use evaluator::{Evaluator, ReplacementContext};
pub(crate) use spans::{Division, Ranks, walk_with};
pub(crate) use start::{TraversalState, seed_placement};

use std::ops::RangeInclusive;

use crate::geometry::{Frame, Frame2};
use crate::graph::CompileError;
use crate::instancing::Appearance;

/// Element of an approximant.
#[derive(Clone, Copy, Debug)]
pub struct Element<F: Frame = Frame2> {
    /// Frame, in the graph's coordinates.
    pub frame: F,
    /// Length as a multiple of that of the initiator's element from which it descends; that of the frame is absolute.
    pub length: f64,
    /// Appearance composed of its own and those of its ancestors.
    pub appearance: Appearance,
    /// Rank in its fractal, from 1.
    pub index: u128,
    /// Number of its object.
    pub object: usize,
    /// Step of its birth: 0 for the initiator's elements.
    pub born: u32,
    /// Whether it is replaced in the next step.
    pub fertile: bool,
    /// Whether it is drawn.
    pub visible: bool,
    /// Whether its first point of traversal joins the last one of the preceding element; the first element
    /// of a fractal joins the last one if the fractal is a ring.
    pub joined: bool,
}

impl<F: Frame> Element<F> {
    /// Returns the element as the root of a subtree.
    #[must_use]
    pub fn subtree(&self) -> Subtree<F> {
        Subtree {
            frame: self.frame,
            object: self.object,
            born: self.born,
        }
    }
}

/// Fractal of an approximant: the elements that descend from the initiator, or from one seed part, without
/// the fractals that they seed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FractalInfo {
    /// Number in the order of the walk, from 0.
    pub number: u64,
    /// Age: the number of steps since its birth.
    pub age: u32,
    /// Whether the chain from which it starts is closed.
    pub is_ring: bool,
}

/// Element that a walk is about to replace, as the root of a subtree.
#[derive(Clone, Copy, Debug)]
pub struct Subtree<F: Frame = Frame2> {
    /// Frame, in the graph's coordinates.
    pub frame: F,
    /// Number of its object.
    pub object: usize,
    /// Step of its birth: 0 for the initiator's elements.
    pub born: u32,
}

/// Decision of a visitor about an element that can be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Enter {
    /// Replaces the element. Its descendants may come as a [run](Visitor::run).
    Replace,
    /// Replaces the element, and decides about its descendants, which do not come as a run.
    Divide,
    /// Visits the element itself, as in the last approximant; it seeds nothing.
    Keep,
    /// Visits neither the element nor its subtree. The elements before and after it are not joined.
    Skip,
}

/// Receiver of the elements of a walk.
pub trait Visitor<F: Frame = Frame2> {
    /// Error that ends a walk.
    type Error;

    /// Begins a fractal.
    ///
    /// # Errors
    ///
    /// Returns an error to end the walk.
    fn begin(&mut self, _: FractalInfo) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Resumes a fractal that an earlier span of the walk began.
    fn go_on(&mut self, _: FractalInfo) {}

    /// Decides about an element that can be replaced. Walks for seeds, and those on several threads, repeat the call
    /// for an element; the result must be the same each time, unless the subtree of the element no longer matters.
    ///
    /// Not called if the walk counts indices ([`Graph::counts_index`](crate::graph::Graph)), because elements
    /// that are not visited could not be counted.
    #[inline]
    fn enter(&mut self, _: &Subtree<F>) -> Enter {
        Enter::Replace
    }

    /// Returns the length below which elements are not replaced, if [`Visitor::enter`] may return anything
    /// but [`Enter::Replace`]; 0 if no length is the limit. A walk on several threads is divided by this
    /// length; objects that lead to seeds placed as the initiator may be replaced at any length.
    fn cuts(&self) -> Option<f64> {
        None
    }

    /// Receives an element of the fractal, in order of traversal.
    ///
    /// # Errors
    ///
    /// Returns an error to end the walk.
    fn element(&mut self, element: &Element<F>) -> Result<(), Self::Error>;

    /// Returns whether the visitor accepts runs of elements whose frames are fixed. [`Visitor::enter`] is not
    /// called for the elements of a run: where it returns [`Enter::Replace`], it has to return that for all descendants
    /// but those that it keeps for being shorter than [`Visitor::cuts`], or that [`Visitor::run`] leaves out. Frames of
    /// elements in runs may differ by rounding from those of single elements.
    fn takes_runs(&self) -> bool {
        false
    }

    /// Returns the largest number of elements that a run should have.
    fn longest_run(&self) -> u64 {
        u64::MAX
    }

    /// Receives consecutive elements of the fractal, if the visitor [accepts runs](Visitor::takes_runs).
    ///
    /// # Errors
    ///
    /// Returns an error to end the walk.
    fn run(&mut self, run: &Run<'_, F>) -> Result<(), Self::Error> {
        run.elements()
            .try_for_each(|element| self.element(&element))
    }

    /// Returns the ages of the fractals that are visited, which are all unless a visitor overrides this.
    /// Fractals of other ages are not counted in the numbers of the others.
    fn ages(&self) -> RangeInclusive<u32> {
        0..=u32::MAX
    }

    /// Returns the part of a colony that the visitor takes as a whole, in [`Visitor::colony`]. For this part
    /// the methods for elements and fractals are not called. Only called for seeds of fixed successors.
    fn takes(&self, _: &Colony<'_, F>) -> Taken {
        Taken::Nothing
    }

    /// Visits the part of a colony that [`Visitor::takes`] has returned, between two fractals.
    ///
    /// # Errors
    ///
    /// Returns an error to end the walk.
    fn colony(&mut self, _: &Colony<'_, F>, _: Taken) -> Result<(), Self::Error> {
        Ok(())
    }

    /// Ends the fractal. `joined` is whether its last element reaches the end of the chain from which the
    /// fractal starts: the fractal is a closed path if its first element is joined as well.
    ///
    /// # Errors
    ///
    /// Returns an error to end the walk.
    fn end(&mut self, _: bool) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// Error of a walk.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WalkError<E> {
    /// The number of elements exceeds the limit.
    #[error("there are more than {limit} elements")]
    TooManyElements {
        /// Largest number of elements.
        limit: u64,
    },
    /// The number of replaced elements visited exceeds the limit, although few elements are drawn.
    #[error("more than {limit} elements that are replaced lie on the way to those that are drawn")]
    TooLong {
        /// Largest number of elements visited, replaced ones included.
        limit: u64,
    },
    /// A generator has a point that is not finite.
    #[error(transparent)]
    NotFinite(#[from] CompileError),
    /// The walk was cancelled.
    #[error("interrupted")]
    Cancelled,
    /// Error that the visitor returned.
    #[error("{0}")]
    Visitor(E),
}

impl<E> WalkError<E> {
    /// Replaces the error of a visitor by the result of `map`.
    pub(crate) fn map_visitor<T>(self, map: impl FnOnce(E) -> T) -> WalkError<T> {
        match self {
            Self::TooManyElements { limit } => WalkError::TooManyElements { limit },
            Self::TooLong { limit } => WalkError::TooLong { limit },
            Self::NotFinite(error) => WalkError::NotFinite(error),
            Self::Cancelled => WalkError::Cancelled,
            Self::Visitor(error) => WalkError::Visitor(map(error)),
        }
    }
}
