//! Lines of L-systems that have limit sets, to arbitrary precision.

use crate::lsystem::LSystem;

use super::effects::Effects;
use super::limit::Limit;
use super::long::{Displacements, Sums as _, Vector};
use super::similar::Edges;
use super::state::TurtleState;

/// Ends of the lines of a word, by position, in multiples of 2^-bits.
pub(super) type Lines = Vec<[Vector; 2]>;

/// Lines of the graph of an L-system that rewrites edges, or stands for its limit set, to arbitrary precision.
#[derive(Debug)]
pub(crate) struct Chords {
    /// Lines of the axiom.
    pub(crate) initiator: Lines,
    /// Lines that replace each object of the graph, relative to the chord of the object.
    pub(crate) objects: Vec<Lines>,
}

impl Chords {
    /// Computes the lines of a system to a number of bits; `None` if every step of it has an initiator of its own.
    pub(crate) fn of(system: &LSystem, bits: usize) -> Option<Self> {
        if system.in_limit {
            return Some(Limit::of(system, bits).ok()?.chords(bits));
        }
        let effects = Effects::closed(system, 1).ok()?;
        let edges = Edges { effects };
        edges.draws().ok()?;
        let effects = &edges.effects;
        let mut ways = Displacements::new(effects.compass, Some(bits));
        let (initiator, _) = ways.lines(effects, &effects.kinds.axiom, edges.start().pose)?;
        let mut objects = Vec::new();
        for key in edges.objects().ok()?.into_keys() {
            let kind = &effects.kinds.all[key.kind];
            let word = kind.alternatives.first().map(|only| &only.word[..]);
            let (lines, chord) =
                ways.lines(effects, word.unwrap_or_default(), TurtleState::SAME.pose)?;
            let seen = |line: [Vector; 2]| line.map(|end| quotient(&end, &chord, bits));
            objects.push(lines.into_iter().map(seen).collect());
        }
        Some(Self { initiator, objects })
    }
}

/// Returns the quotient of vectors as complex numbers, in multiples of 2^-`bits`; 0 if the divisor is 0.
fn quotient([a, b]: &Vector, [c, d]: &Vector, bits: usize) -> Vector {
    let below = c * c + d * d;
    if below.is_zero() {
        return [below.clone(), below];
    }
    [a * c + b * d, b * c - a * d].map(|above| (above << bits) / &below)
}
