//! States of the search for the farthest point: objects with a direction in their frame, and an offset.

use std::hash::Hasher as _;

use crate::fast_hash::{FastHasher, FastMap};
use crate::geometry::{Frame, Point};
use crate::graph::Instance;

/// Object with a vector and an offset: the points x that it draws contribute offset + x·vector.
pub(super) struct SupportTerm<F: Frame> {
    pub(super) object: usize,
    pub(super) vector: F::Point,
    pub(super) offset: f64,
    /// Accumulated rounding error of the offset.
    pub(super) lost: f64,
    /// Upper bound of the contributions, as far as it is known.
    pub(super) most: f64,
    /// Number of the state of the level before from which it comes.
    pub(super) parent: u32,
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
        most: f64::INFINITY,
        parent: 0,
    }
}

/// States of a level, of which the farthest is kept of those that are equal but for the offset. It has the vector of the one
/// whose parent comes first: vectors of equal states differ by rounding, and the result must not depend on the order in which
/// they are met.
pub(super) struct Merged<F: Frame> {
    kept: Vec<SupportTerm<F>>,
    /// Numbers of the kept states by hash: keys would take more memory than the states.
    numbers: FastMap<u64, u32>,
    /// Further states that share a hash, with it; there are hardly any.
    others: Vec<(u64, u32)>,
}

/// Where a state belongs among merged ones.
pub(super) struct Slot {
    hash: u64,
    /// Number of the kept state that equals it but for the offset.
    known: Option<usize>,
}

impl<F: Frame> Default for Merged<F> {
    fn default() -> Self {
        Self {
            kept: Vec::new(),
            numbers: FastMap::default(),
            others: Vec::new(),
        }
    }
}

impl<F: Frame> Merged<F> {
    /// Finds the slot of a state; `None` if one that equals it, and is no less far, is kept.
    pub(super) fn slot(&mut self, state: &SupportTerm<F>) -> Option<Slot> {
        let own = identity(state);
        let hash = hash(&own);
        let is_same = |number: &u32| {
            let known = &self.kept[*number as usize];
            let is_equal = known.object == state.object && known.vector == state.vector;
            is_equal || identity(known) == own
        };
        let others = { self.others.iter() }.filter(|(it, _)| *it == hash);
        let others = others.map(|(_, number)| number);
        let known = self.numbers.get(&hash).into_iter().chain(others);
        let known = known.copied().find(is_same).map(|number| number as usize);
        if let Some(known) = known {
            let known = &mut self.kept[known];
            if state.parent < known.parent {
                (known.vector, known.parent) = (state.vector, state.parent);
            }
            if (known.offset, known.lost) >= (state.offset, state.lost) {
                return None;
            }
        }
        Some(Slot { hash, known })
    }

    /// Keeps a state in its slot.
    pub(super) fn put(&mut self, slot: &Slot, state: SupportTerm<F>) {
        if let Some(known) = slot.known {
            let known = &mut self.kept[known];
            (known.offset, known.lost) = (state.offset, state.lost);
            known.most = state.most;
            return;
        }
        #[expect(clippy::cast_possible_truncation, reason = "states are limited")]
        let new = self.kept.len() as u32;
        if *self.numbers.entry(slot.hash).or_insert(new) != new {
            self.others.push((slot.hash, new));
        }
        self.kept.push(state);
    }

    /// Returns the number of states.
    pub(super) fn len(&self) -> usize {
        self.kept.len()
    }

    /// Returns the states that may reach as far as a value, in the order of their parents.
    pub(super) fn reaching(mut self, certain: f64) -> Vec<SupportTerm<F>> {
        self.kept.retain(|state| !falls_short(state.most, certain));
        self.kept.sort_by_key(|state| state.parent);
        self.kept
    }

    /// Drops the states that do not reach as far as a value.
    pub(super) fn drop_short(&mut self, certain: f64) {
        for state in std::mem::take(self).reaching(certain) {
            let slot = Slot {
                hash: hash(&identity(&state)),
                known: None,
            };
            self.put(&slot, state);
        }
    }
}

impl<F: Frame> FromIterator<SupportTerm<F>> for Merged<F> {
    fn from_iter<I: IntoIterator<Item = SupportTerm<F>>>(states: I) -> Self {
        let mut merged = Self::default();
        for state in states {
            if let Some(slot) = merged.slot(&state) {
                merged.put(&slot, state);
            }
        }
        merged
    }
}

/// Returns whether an upper bound is less than what is certain. No comparison holds where nothing is certain yet.
pub(super) fn falls_short(most: f64, certain: f64) -> bool {
    most < certain
}

/// Returns what equal states share but for rounding: the object, and the key of the vector.
fn identity<F: Frame>(state: &SupportTerm<F>) -> (usize, ([i64; 3], u64)) {
    (state.object, key(state.vector))
}

/// Returns a hash of an object with the key of a vector.
fn hash((object, (unit, length)): &(usize, ([i64; 3], u64))) -> u64 {
    let mut hasher = FastHasher::default();
    hasher.write_usize(*object);
    unit.iter()
        .for_each(|it| hasher.write_u64(it.cast_unsigned()));
    hasher.write_u64(*length);
    hasher.finish()
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
    // Rounds as `round` does, which is a function where the processor need not have it.
    unit.coordinates()
        .map(|value| (value * 1e10 + 0.5_f64.copysign(value)) as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{DVec2, Frame2};

    /// Vectors that differ by rounding are equal; offsets and parents decide what is kept of them, in any order.
    #[test]
    fn merged_states_do_not_depend_on_the_order() {
        let state = |number: u32| SupportTerm::<Frame2> {
            object: number as usize % 3,
            vector: DVec2::from_angle(f64::from(number % 5))
                * (1.0 + 1e-15 * f64::from(number % 4)),
            offset: f64::from(number * 7 % 11),
            lost: 0.0,
            most: f64::from(number * 7 % 11) + 1.0,
            parent: number,
        };
        let listed = |numbers: &mut dyn Iterator<Item = u32>, certain: f64| {
            let merged: Merged<Frame2> = numbers.map(state).collect();
            let states = merged.reaching(certain).into_iter();
            states
                .map(|it| (it.object, it.vector, it.offset, it.most, it.parent))
                .collect::<Vec<_>>()
        };
        let expected = listed(&mut (0..60), f64::NEG_INFINITY);
        assert_eq!(expected.len(), 15);
        for it in &expected {
            let alike = (0..60).filter(|other| other % 15 == it.4);
            assert_eq!(
                it.2,
                alike.map(|other| state(other).offset).fold(0.0, f64::max)
            );
        }
        assert_eq!(listed(&mut (0..60).rev(), f64::NEG_INFINITY), expected);
        assert_eq!(
            listed(&mut (0..60).map(|it| it * 37 % 60), f64::NEG_INFINITY),
            expected
        );
        let far = listed(&mut (0..60), 10.5);
        assert_eq!(
            far,
            expected
                .into_iter()
                .filter(|it| it.3 >= 10.5)
                .collect::<Vec<_>>()
        );
    }

    #[test]
    fn dropping_keeps_what_reaches() {
        let state = |number: u32| SupportTerm::<Frame2> {
            object: number as usize,
            vector: DVec2::X,
            offset: f64::from(number),
            lost: 0.0,
            most: f64::from(number),
            parent: 0,
        };
        let mut merged: Merged<Frame2> = (0..100).map(state).collect();
        merged.drop_short(40.0);
        assert_eq!(merged.len(), 60);
        assert!(merged.slot(&state(50)).is_none() && merged.slot(&state(30)).is_some());
    }
}
