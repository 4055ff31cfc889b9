//! L-systems whose productions are drawn: where what comes later stands is found by reading what stands
//! before it, by the draws of its path.

use crate::graph::{Alternative, Instance, Production};
use crate::rule::Extent;
use crate::rule::draw::Path;

use super::effects::Effects;
use super::far::Far;
use super::reader::{Of, Reader};
use super::state::State;

/// A word that may replace a kind with so many steps left.
#[derive(Debug)]
pub(super) struct Written {
    pub(super) kind: usize,
    pub(super) left: u32,
    /// How long the kind counts.
    pub(super) unit: Far,
    /// The positions of all that may be drawn, and what holds of it wherever it stands.
    pub(super) positions: Vec<u32>,
    pub(super) extents: Vec<Extent>,
}

/// The words of an L-system, by kind and level, with all it takes to read them.
#[derive(Debug)]
pub(crate) struct Words {
    pub(super) effects: Effects,
    pub(super) written: Vec<Written>,
}

impl Words {
    /// What holds of what a word may draw.
    pub(crate) fn extents(&self, word: usize) -> &[Extent] {
        &self.written[word].extents
    }

    /// Overwrites a production with what the draws of a path make of words, one of which replaces an object.
    pub(crate) fn evaluate(&self, words: &[Alternative], path: Path, production: &mut Production) {
        production.seeds.clear();
        production.body.instances.clear();
        production.body.meets_frame = [false; 2];
        let effects = &self.effects;
        let Written { kind, left, .. } = self.written[words[0].generator];
        let of = &effects.kinds.all[kind];
        let drawn = of.drawn(path);
        let written = &self.written[words[drawn].generator];
        let mut reader = Reader::new(effects, State::SAME, true);
        let word = &of.alternatives[drawn].word;
        if reader.read(word, left - 1, path).is_err() {
            return;
        }
        let mut spots = written.positions.iter().zip(&words[drawn].objects);
        for part in &reader.parts {
            // What may be drawn and is not is passed over.
            let Some((_, &object)) = spots.find(|(position, _)| **position == part.position) else {
                return;
            };
            let steps = match &part.of {
                Of::Subtree(_, drawn) => drawn.size,
                Of::Step { .. } | Of::Polygon(_) => Far::of_length(1.0),
            };
            let frame = part.pose.frame(effects.compass, steps, written.unit);
            production.body.instances.push(Instance {
                length: frame.length(),
                frame,
                joined: part.joined,
                position: part.position,
                object,
            });
        }
        production.body.meets_frame = reader.meets();
    }
}
