//! L-systems whose turtle moves in space.

use crate::expression::degrees;
use crate::geometry::{DMat3, DVec3, rotation};
use crate::rule::Body;
use crate::style::Tube;

use super::{Action, LSystem};

/// An L-system in space: words, and what its turtle needs beside them.
///
/// The turtle's heading H, the direction L to its left and the direction U upwards from its back are orthonormal, and
/// H × L = U (Prusinkiewicz & Lindenmayer 1990, section 1.5). In the start heading 0 they are the axes x, y and z.
#[derive(Clone, Debug, PartialEq)]
pub struct LSystemInSpace {
    pub(crate) words: LSystem,
    /// Start rotation, whose columns are H, L and U; `None` for the heading of the words in the plane z = 0.
    pub(crate) start: Option<DMat3>,
    pub(crate) tropism: Option<Tropism>,
    pub(crate) stamps: Vec<Body>,
}

/// Tropism: a force that bends the turtle's way towards a direction.
///
/// After every line the turtle is turned by the angle e · |H × T|, in radians, about the axis H × T (Prusinkiewicz &
/// Lindenmayer 1990, section 2.3.3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tropism {
    /// The vector T; its length counts.
    pub towards: DVec3,
    /// The susceptibility to bending e, in radians.
    pub susceptibility: f64,
}

impl Tropism {
    /// Returns the turn after a line along a heading of length 1.
    #[must_use]
    pub fn turn(&self, heading: DVec3) -> DMat3 {
        let across = heading.cross(self.towards);
        let angle = (self.susceptibility * across.length()).to_degrees();
        match across.try_normalize() {
            Some(axis) => rotation(axis, degrees::cos(angle), degrees::sin(angle)),
            None => DMat3::IDENTITY,
        }
    }
}

/// Reason why an L-system in space is read word by word, and not compiled to a graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoGraph {
    /// The turtle is levelled.
    #[error("'$' depends on the heading in space")]
    Level,
    /// There is a tropism.
    #[error("tropism depends on the heading in space")]
    Tropism,
    /// A production has a context.
    #[error("productions have contexts")]
    Contexts,
    /// The turtle has a second heading.
    #[error("the turtle exchanges its headings, or turns regardless of reflections")]
    Way,
    /// The effects of modules depend on draws.
    #[error("its modules differ from draw to draw")]
    Draws,
    /// There are too many modules with different arguments.
    #[error("its modules are too many")]
    Modules,
}

impl LSystemInSpace {
    /// Returns symbols, axiom and productions.
    #[must_use]
    pub fn words(&self) -> &LSystem {
        &self.words
    }

    /// Returns the tropism, if there is one.
    #[must_use]
    pub fn tropism(&self) -> Option<&Tropism> {
        self.tropism.as_ref()
    }

    /// Returns the tubes that lines are drawn as, if the style asks for them.
    #[must_use]
    pub fn tube(&self) -> Option<Tube> {
        self.words.metadata.style.tube
    }

    /// Returns the system that stands for its limit set, without actions on width and colour, and without tubes.
    pub(crate) fn in_limit(&self) -> Self {
        let mut limit = self.clone();
        limit.words = self.words.in_limit();
        limit.words.metadata.style.tube = None;
        limit
    }

    /// Returns why the system cannot be compiled to a graph, as far as its symbols and productions show it.
    #[must_use]
    pub fn walked(&self) -> Option<NoGraph> {
        let mut actions = self.words.symbols.iter().flat_map(|it| &it.meaning);
        if actions.any(|action| matches!(action, Action::Level)) {
            Some(NoGraph::Level)
        } else if self.tropism.is_some() {
            Some(NoGraph::Tropism)
        } else if !self.words.is_context_free() {
            Some(NoGraph::Contexts)
        } else if self.words.depends_on_the_way() {
            Some(NoGraph::Way)
        } else {
            None
        }
    }
}
