//! Maps of an L-system that rewrites edges.

use crate::compile::Chords;
use crate::graph::Instance;
use crate::lsystem::LSystem;
use crate::zoom::fixed::Fixed;

/// Maps of an L-system that rewrites edges.
pub(super) struct OfTurtle {
    chords: Chords,
}

impl OfTurtle {
    /// Evaluates the maps of a system; `None` if it does not rewrite edges.
    pub(super) fn new(system: &LSystem, bits: usize) -> Option<Self> {
        let chords = Chords::of(system, bits)?;
        Some(Self { chords })
    }

    /// Returns the map of a line of the axiom, or of one in the replacement of an object.
    pub(super) fn child(&self, parent: Option<usize>, instance: &Instance) -> Fixed {
        let Chords { initiator, objects } = &self.chords;
        let lines = parent.map_or(initiator, |object| &objects[object]);
        let [from, to] = &lines[instance.position as usize];
        Fixed::between(from, to, instance.frame.direction())
    }
}
