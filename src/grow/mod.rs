//! Growing: the walk over the elements of an approximant, in order, streamed.
//!
//! The walk goes depth-first through the graph. It holds one entry a level, so its memory grows
//! with the number of steps and not with the number of elements. Where new fractals are seeded, a
//! fractal is walked once for its own elements and again, to ever greater depth, for its seeds. What
//! an object becomes in its last steps, or before it is too short to be replaced, is worked out once, as a
//! block, for visitors that take elements by [`Run`]s. Many threads walk over the subtrees of one walk, and what they make of
//! them comes in order. Who only wants to know the box of it all has no need of a walk where the graph
//! tells how far things reach: a search replaces only what may reach farther than what it has found. A
//! limit set whose copies overlap is found without elements, by cells of the plane.

mod block;
mod cells;
mod census;
mod count;
mod descent;
mod evaluator;
mod extent;
mod outlines;
mod progress;
mod search;
mod sizes;
mod spans;
mod start;
mod tally;
mod walk;

pub use block::{Run, Stick};
pub use count::{Counted, count};
pub use extent::extent;
pub(crate) use outlines::{OutlineError, outlines};
pub use progress::Progress;
pub(crate) use search::{Reaches, search};
pub use spans::{Seam, walk_in_spans};
pub use walk::{Growth, Walked, walk};

pub(crate) use cells::{Field, Found, Layer, LimitCells, Search, Stopped};
pub(crate) use census::{Census, Kind};
pub(crate) use evaluator::{Evaluator, Moment};
pub(crate) use spans::{Division, Ranks, walk_with};
pub(crate) use start::Standing;

use std::ops::Range;

use crate::geometry::Frame;
use crate::graph::CompileError;
use crate::instancing::Coat;

/// An element of an approximant.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    /// Where it stands.
    pub frame: Frame,
    /// Its length as a multiple of the initiator element's that it descends from.
    pub length: f64,
    /// What it is tinted with.
    pub coat: Coat,
    /// Its rank in its fractal, from 1.
    pub index: u128,
    /// The object that it is.
    pub object: usize,
    /// The step of its birth: 0 for the initiator's elements.
    pub born: u32,
    /// Whether it is replaced in the next step.
    pub fertile: bool,
    /// Whether its first point of traversal joins the last one of the element before it; the first
    /// element of a fractal joins the last one if the fractal is a ring.
    pub joined: bool,
}

impl Element {
    /// The element as one that may be replaced.
    #[must_use]
    pub fn subtree(&self) -> Subtree {
        Subtree {
            frame: self.frame,
            object: self.object,
            born: self.born,
        }
    }
}

/// A fractal of an approximant: a list of elements of one age.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fractal {
    /// Its number in the order of the walk, from 0.
    pub number: u64,
    /// Its age: the number of times that it has been replaced.
    pub age: u32,
    /// Whether it began as a closed chain.
    pub is_ring: bool,
}

/// An element that the walk is about to replace.
#[derive(Clone, Copy, Debug)]
pub struct Subtree {
    /// Where it stands.
    pub frame: Frame,
    /// The object that it is.
    pub object: usize,
    /// The step of its birth: 0 for the initiator's elements.
    pub born: u32,
}

/// What a walk does with an element that can be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Enter {
    /// It is replaced.
    Replace,
    /// It is visited as an element, as if its approximant were the last; it seeds nothing.
    Keep,
    /// Nothing of it is visited. The elements before and after it are not joined.
    Skip,
}

/// What receives the elements of a walk.
pub trait Visitor {
    /// What may go wrong in it.
    type Error;

    /// A fractal begins.
    ///
    /// # Errors
    ///
    /// Whatever ends the walk.
    fn begin(&mut self, fractal: Fractal) -> Result<(), Self::Error>;

    /// A visitor of a span of a walk begins in the middle of a fractal.
    fn go_on(&mut self, _: Fractal) {}

    /// A visitor of a span of a walk sees these ranks of one fractal, where that is known before.
    fn expect(&mut self, _: Range<u128>) {}

    /// Says what is done with an element that can be replaced. An element may be asked about more
    /// than once, where fractals are walked again for their seeds: the answer must be the same, unless
    /// nothing that becomes of the element matters any more.
    ///
    /// Not asked where a walk counts indices ([`Graph::counts_index`](crate::graph::Graph)): what
    /// is not visited could not be counted.
    #[inline]
    fn enter(&mut self, _: &Subtree) -> Enter {
        Enter::Replace
    }

    /// The length below which nothing is replaced, if [`Visitor::enter`] may say anything but
    /// [`Enter::Replace`]; 0 if there is none. A walk on several threads is divided by it; objects
    /// that lead to seeds which are placed as the initiator may be replaced at any length.
    fn cuts(&self) -> Option<f64> {
        None
    }

    /// An element of the fractal, in order of traversal.
    ///
    /// # Errors
    ///
    /// Whatever ends the walk.
    fn element(&mut self, element: &Element) -> Result<(), Self::Error>;

    /// Whether elements whose places are fixed come by runs, as many of them do then, without being
    /// asked for one by one: only a length, if anything, says what [`Visitor::enter`] keeps. Their frames
    /// may differ in the last bits from those of elements that come one by one.
    fn takes_runs(&self) -> bool {
        false
    }

    /// The most elements that a run should have, of those that it may have.
    fn longest_run(&self) -> u64 {
        u64::MAX
    }

    /// Elements of the fractal in a row, if the visitor [takes runs](Visitor::takes_runs).
    ///
    /// # Errors
    ///
    /// Whatever ends the walk.
    fn run(&mut self, run: &Run<'_>) -> Result<(), Self::Error> {
        run.elements()
            .try_for_each(|element| self.element(&element))
    }

    /// The fractal ends. `joined` tells whether its last element is drawn to the very end of the
    /// chain that started it: the fractal is a closed path if its first element is joined as well.
    ///
    /// # Errors
    ///
    /// Whatever ends the walk.
    fn end(&mut self, joined: bool) -> Result<(), Self::Error>;
}

/// Why a walk ends early.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WalkError<E> {
    /// There are more elements than allowed.
    #[error("there are more than {limit} elements")]
    TooManyElements {
        /// The largest number allowed.
        limit: u64,
    },
    /// The elements are few, but the way to them is long.
    #[error("more than {limit} elements that are replaced lie on the way to those that are drawn")]
    TooLong {
        /// The largest number of replaced elements that are visited.
        limit: u64,
    },
    /// A generator has a point that is not finite.
    #[error(transparent)]
    NotFinite(#[from] CompileError),
    /// The walk was cancelled.
    #[error("interrupted")]
    Cancelled,
    /// What the visitor said.
    #[error("{0}")]
    Visitor(E),
}
