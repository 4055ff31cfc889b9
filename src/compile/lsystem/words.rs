//! L-systems with random productions: the position of a module is found by reading the modules before it,
//! with the draws of its path.

use crate::draws::Path;
use crate::expression::Interval;
use crate::graph::{Alternative, Buffers, CompileError, Instance, Source, Successor};
use crate::lsystem::TurtleFrame;
use crate::rule::{ElementContext, Extent, Part};

use super::effects::Effects;
use super::far::Far;
use super::reader::{Of, Reader};
use super::state::TurtleState;

/// Word that may replace a kind with `left` steps left.
#[derive(Debug)]
pub(super) struct Written<F: TurtleFrame> {
    pub(super) kind: usize,
    pub(super) left: u32,
    /// Nominal length of the kind.
    pub(super) unit: Far<F::Point>,
    /// Positions of all modules that may draw.
    pub(super) positions: Vec<u32>,
    /// Bounds on the drawing of each.
    pub(super) extents: Vec<Extent>,
}

/// Words of an L-system by kind and number of steps left, with the effects that are required to read
/// them.
#[derive(Debug)]
pub(super) struct Words<F: TurtleFrame> {
    pub(super) effects: Effects<F>,
    pub(super) written: Vec<Written<F>>,
}

impl<F: TurtleFrame> Words<F> {
    /// Returns bounds on the drawings of a word's modules.
    fn extents(&self, word: usize) -> &[Extent] {
        &self.written[word].extents
    }

    /// Overwrites a production with the word that the draws of a path select among `words`, interpreted
    /// with the draws of the path.
    fn evaluate(&self, words: &[Alternative], path: Path, production: &mut Successor<F>) {
        production.clear();
        let effects = &self.effects;
        let Written { kind, left, .. } = self.written[words[0].generator];
        let of = &effects.kinds.all[kind];
        let drawn = of.drawn(path);
        let written = &self.written[words[drawn].generator];
        let mut reader = Reader::new(effects, TurtleState::SAME, true);
        let word = &of.alternatives[drawn].word;
        if reader.read(word, left - 1, path).is_err() {
            return;
        }
        let mut spots = written.positions.iter().zip(&words[drawn].objects);
        for part in &reader.parts {
            // Modules that could draw but do not are skipped.
            let Some((_, &object)) = spots.find(|(position, _)| **position == part.position) else {
                return;
            };
            let steps = match &part.of {
                Of::Subtree(_, drawn) => drawn.size,
                Of::Step { .. } | Of::Polygon(_) | Of::Stamp(_) => Far::of_length(1.0),
            };
            let frame = part.pose.frame(effects.compass, steps, written.unit);
            production.body.instances.push(Instance {
                corners: None,
                joined: part.joined,
                ..Instance::new(object, frame, part.position)
            });
        }
        production.body.meets_frame = reader.meets();
    }
}

impl<F: TurtleFrame> Source<F> for Words<F> {
    fn evaluate(
        &self,
        alternatives: &[Alternative],
        path: Path,
        _: &ElementContext,
        _: &mut Buffers<F>,
        production: &mut Successor<F>,
    ) -> Result<(), CompileError> {
        self.evaluate(alternatives, path, production);
        Ok(())
    }

    fn parts(&self, _: usize) -> &[Part] {
        &[]
    }

    fn extents(&self, word: usize, _: f64, _: &[Interval; 4], _: F::Point) -> Vec<Extent> {
        self.extents(word).to_vec()
    }
}
