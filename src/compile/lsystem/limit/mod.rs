//! Limit sets of L-systems (Dekking 1982, "Recurrent sets").
//!
//! Let the turtle's displacement by every module grow by a factor κ with every step, in the limit; then the drawing of
//! a module, divided by κⁿ after n steps, approaches the union of the drawings of its successor's modules, divided by κ
//! and placed by the sums of the displacements before them. These maps contract if |κ| > 1, and have one family of
//! compact sets as their limit (Hutchinson 1981; Mauldin & Williams 1988). Drawings that grow less become points. If
//! κ = 1, lines are kept, and factors of the turtle's steps may make the maps contract.
//!
//! Directions are those of [a period](growth) of steps. If the sets of its steps differ, approximants approach several
//! sets in turn, and there is no limit set.

mod alike;
mod budget;
mod growth;
mod number;
mod pieces;
mod polynomial;
mod prime;
mod space;
mod turns;

use std::sync::Arc;

use dashu_int::IBig;

use crate::geometry::{DVec2, Direction, Frame2};
use crate::graph::{Chain, Graph, Instance, Object, Replacement};
use crate::lsystem::{Compass, LSystem, NoGrowth};
use crate::rule::BaseElement;

use self::growth::{Growth, Steps};
use self::number::{Complex, Numbers};
use self::pieces::{Piece, Pieces, SetMap as _};
use self::turns::Reader;
use super::chords::Chords;
use super::kinds::{Kinds, MAX_CLOSED};

/// Additional bits of the numbers in which growth is decided.
const BITS: usize = 1024;

/// Largest number of modules of all successors together.
const MAX_MODULES: usize = 5000;

/// Checks that modules are replaced, and read by the turtle, regardless of all others, and that they are not too many.
fn check(system: &LSystem) -> Result<(), NoGrowth> {
    let successors = system.productions.iter().map(|it| it.successor.len());
    let modules: usize = successors.sum();
    if !system.is_deterministic() {
        Err(NoGrowth::Draws)
    } else if !system.is_context_free() {
        Err(NoGrowth::Contexts)
    } else if system.depends_on_the_way() {
        Err(NoGrowth::Actions)
    } else if modules > MAX_MODULES {
        Err(NoGrowth::Size)
    } else {
        Ok(())
    }
}

/// Limit set of an L-system: its sets, each in a frame from the start of the set to a point of its own.
pub(super) struct Limit {
    pieces: Pieces,
    /// End of the frame of every set.
    ends: Vec<Complex>,
    /// Map of the axiom's pieces to the coordinates of the system.
    start: Complex,
}

impl Limit {
    /// Computes the limit set of a system, in numbers of at least `bits` bits.
    pub(super) fn of(system: &LSystem, bits: usize) -> Result<Self, NoGrowth> {
        check(system)?;
        let kinds = Kinds::of(system, u32::MAX, MAX_CLOSED).map_err(|_| NoGrowth::Arguments)?;
        let reader = Reader::new(system, &kinds);
        let bits = bits + BITS;
        let mut numbers = Numbers::new(reader.compass, bits).ok_or(NoGrowth::Turns)?;
        let mut steps = Steps::of(&reader)?;
        let growth = Growth::of(&mut steps, &reader, &mut numbers)?;
        let pieces = Pieces::of(&reader, &steps, &growth, &mut numbers)?;
        let one = Complex::real(1.0, bits);
        let ends = pieces.ends();
        if pieces.axiom.is_empty() {
            return Err(NoGrowth::Empty);
        }
        let mut lines = pieces.axiom.iter();
        let first = lines.find_map(|piece| Some((piece, ends[piece.set].as_ref()?)));
        let (first, end) = first.ok_or(NoGrowth::Points)?;
        // The first piece is as long as a step, in the direction of the turtle.
        let mut scale = Complex::real(system.length(), bits);
        if !growth.is_one {
            let chord = &first.map.image(end) - &first.map.place;
            scale = (&first.map.factor * &scale).over(&chord);
        }
        let heading = Compass::of(system).of_degrees(system.start());
        Ok(Self {
            start: &scale * &numbers.direction(heading).value,
            ends: ends
                .into_iter()
                .map(|end| end.unwrap_or_else(|| one.clone()))
                .collect(),
            pieces,
        })
    }

    /// Returns the ends of a piece in the frame of a set, or in the coordinates of the system.
    fn line(&self, piece: &Piece, of: Option<usize>) -> [Complex; 2] {
        let end = piece.map.image(&self.ends[piece.set]);
        [piece.map.place.clone(), end].map(|point| match of {
            Some(set) => point.over(&self.ends[set]),
            None => &point * &self.start,
        })
    }

    /// Returns the chain of pieces in the frame of a set, or of the axiom.
    fn chain(&self, pieces: &[Piece], of: Option<usize>) -> Chain {
        let mut instances: Vec<Instance> = Vec::new();
        let (mut last, mut starts) = (DVec2::ZERO, false);
        for (piece, position) in pieces.iter().zip(0..) {
            let [from, to] = self.line(piece, of).map(|end| end.near(0));
            let joins = from.distance(last) <= JOINED * (1.0 + last.length());
            if instances.is_empty() {
                starts = joins;
            }
            // The frame of a set that is mirrored differs if it is not the line of its displacement.
            let direction = match piece.map.mirrored {
                true => Direction::YReflected,
                false => Direction::Normal,
            };
            instances.push(Instance {
                corners: None,
                frame: Frame2::between(from, to, direction),
                length: from.distance(to),
                joined: joins && !instances.is_empty(),
                position,
                object: piece.set,
            });
            last = to;
        }
        Chain {
            meets_frame: [starts, last.distance(DVec2::X) <= JOINED],
            ..Chain::loose(instances)
        }
    }

    /// Returns the graph that has the limit set.
    pub(super) fn graph(&self) -> Result<Graph, NoGrowth> {
        let sets = self.pieces.sets.iter().enumerate();
        let objects = sets.map(|(number, set)| Object {
            behaviour: number,
            replacement: match set.is_line {
                true => Replacement::Kept,
                false => {
                    let chain = self.chain(&set.pieces, Some(number));
                    Replacement::Fixed(Arc::new(chain.into()))
                }
            },
            ..Object::kept(0)
        });
        let start = Chain {
            meets_frame: [false; 2],
            ..self.chain(&self.pieces.axiom, None)
        };
        let graph = Graph {
            middle: DVec2::new(0.5, 0.0),
            ..Graph::of(objects.collect(), [BaseElement::line()], vec![start])
        };
        match graph.contracts() {
            true => Ok(graph),
            false => Err(NoGrowth::Slow),
        }
    }

    /// Returns the lines of the graph in multiples of 2^-`bits`.
    pub(super) fn chords(&self, bits: usize) -> Chords {
        let lines = |pieces: &[Piece], of: Option<usize>| -> Vec<[[IBig; 2]; 2]> {
            let lines = pieces.iter().map(|piece| self.line(piece, of));
            lines.map(|line| line.map(|end| end.fixed(bits))).collect()
        };
        let sets = self.pieces.sets.iter().enumerate();
        Chords {
            initiator: lines(&self.pieces.axiom, None),
            objects: sets
                .map(|(number, set)| lines(&set.pieces, Some(number)))
                .collect(),
        }
    }
}

/// Distance, in lengths of the whole, at which ends meet.
const JOINED: f64 = 1e-9;
