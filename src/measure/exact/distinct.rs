//! An upper bound of the dimension by counting distinct pieces, for sets without finitely many types.

use glam::DAffine3;

use super::Effort;
use super::neighbours::{Pair, Register};
use super::sizes::{Generations, Piece};
use crate::saturating::real;

/// Maximum number of pieces, over all generations and sets.
const MAX_PIECES: usize = 60_000;

/// Returns an upper bound of the dimension: log N / (n log 1/ρ) with the maximum N of distinct pieces that a
/// set has in generation n, for the n that gives the least.
///
/// The maximum over all sets is submultiplicative: N(m + n) ≤ N(m) N(n).
pub(super) fn upper_bound(generations: &Generations, effort: Effort) -> Option<f64> {
    let most = effort.of(MAX_PIECES);
    let counts: Vec<Vec<usize>> = (0..generations.size())
        .map(|set| counts(generations, set, most / generations.size()))
        .collect();
    let last = counts.iter().map(Vec::len).min()?;
    let bounds = (1..last).map(|generation| {
        let most = counts.iter().map(|counts| counts[generation]).max();
        libm::log(real(most.unwrap_or(0))) / (real(generation) * generations.depth)
    });
    bounds.min_by(f64::total_cmp)
}

/// Counts the distinct pieces of a set by generation, as far as the limit permits.
fn counts(generations: &Generations, set: usize, limit: usize) -> Vec<usize> {
    let grow = libm::exp(generations.depth);
    let mut pieces = vec![(Piece { set, wait: 0 }, DAffine3::IDENTITY)];
    let mut counts = vec![1];
    let mut total = 0;
    loop {
        let mut register = Register::default();
        let mut next = Vec::new();
        // Pieces are compared in the unit of their generation.
        for (piece, map) in &pieces {
            for step in generations.steps(*piece) {
                let mut map = *map * step.map;
                map.matrix3 *= grow;
                map.translation *= grow;
                let pair = Pair {
                    first: step.piece,
                    second: step.piece,
                    map,
                };
                if register.number(pair).1 {
                    next.push((step.piece, map));
                }
            }
            if total + next.len() > limit {
                return counts;
            }
        }
        if register.too_close {
            return counts;
        }
        total += next.len();
        counts.push(next.len());
        pieces = next;
    }
}
