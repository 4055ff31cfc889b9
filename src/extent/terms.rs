//! States of the search for the farthest point: objects with a direction in their frame, and an offset.

use std::collections::hash_map::Entry;

use crate::fast_hash::FastMap;
use crate::geometry::{Frame, Point};
use crate::graph::Instance;

/// Object with a vector and an offset: the points x that it draws contribute offset + x·vector.
pub(super) struct SupportTerm<F: Frame> {
    pub(super) object: usize,
    pub(super) vector: F::Point,
    pub(super) offset: f64,
    /// Accumulated rounding error of the offset.
    pub(super) lost: f64,
}

/// Returns the state of an instance in the place of the object of a state.
pub(super) fn child<F: Frame>(
    instance: &Instance<F>,
    vector: F::Point,
    offset: f64,
    lost: f64,
) -> SupportTerm<F> {
    let shift = vector.dot(instance.frame.origin());
    // Knuth's exact sum of two doubles (TwoSum) keeps the errors of many levels from accumulating.
    let sum = offset + shift;
    let rounded = sum - offset;
    let error = (offset - (sum - rounded)) + (shift - rounded);
    SupportTerm {
        object: instance.object,
        vector: instance.frame.pullback(vector),
        offset: sum,
        lost: lost + error,
    }
}

/// Keeps the farthest of the states that are equal but for the offset.
pub(super) fn merged<F: Frame>(
    states: impl Iterator<Item = SupportTerm<F>>,
) -> Vec<SupportTerm<F>> {
    let mut kept: Vec<SupportTerm<F>> = Vec::new();
    let mut numbers = FastMap::default();
    for state in states {
        match numbers.entry((state.object, key(state.vector))) {
            Entry::Occupied(number) => {
                let known: &mut SupportTerm<F> = &mut kept[*number.get()];
                if (known.offset, known.lost) < (state.offset, state.lost) {
                    (known.offset, known.lost) = (state.offset, state.lost);
                }
            }
            Entry::Vacant(free) => {
                free.insert(kept.len());
                kept.push(state);
            }
        }
    }
    kept
}

/// Returns a key that is equal for vectors that differ by rounding: the direction, and the length to as many digits.
fn key<P: Point>(vector: P) -> ([i64; 3], u64) {
    /// Number of low bits of a double that are dropped, by rounding: truncation would separate the
    /// neighbours of powers of two.
    const ROUNDED: u32 = 19;
    let (unit, length) = unit_and_length(vector);
    (
        decimals(unit),
        (length.to_bits() + (1 << (ROUNDED - 1))) >> ROUNDED,
    )
}

/// Returns a key that is equal for directions that differ by rounding: that of a vector, to ten decimals.
pub(super) fn direction_key<P: Point>(vector: P) -> [i64; 3] {
    decimals(unit_and_length(vector).0)
}

fn unit_and_length<P: Point>(vector: P) -> (P, f64) {
    match vector.length() {
        length if length > 0.0 && length.is_finite() => (vector / length, length),
        // Squares of large and of small numbers leave the range of doubles.
        _ => {
            let unit = (vector / vector.abs().max_element()).normalize_or_zero();
            (unit, vector.dot(unit))
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn decimals<P: Point>(unit: P) -> [i64; 3] {
    unit.coordinates()
        .map(|value| (value * 1e10).round() as i64)
}
