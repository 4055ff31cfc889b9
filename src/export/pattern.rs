//! Patterns: elements of a run in its unit frame, column by column, in the plane.

use std::sync::{Arc, PoisonError, RwLock};

use crate::fast_hash::FastMap;
use crate::geometry::{Direction, Homothety, LARGEST_ENTRY};
use crate::grow::Run;

use super::listed::Listed;

/// Elements of a run in its unit frame, in the plane. Runs of one block in one direction have one pattern.
pub(super) struct Pattern {
    /// Coordinates in the order of the columns.
    pub(super) coordinates: [Vec<f64>; 4],
    pub(super) fertile: Vec<bool>,
    pub(super) direction: Vec<u8>,
    pub(super) visible: Vec<bool>,
    /// Whether elements join the preceding one, but for the first, where it depends on the run.
    pub(super) joined: Vec<bool>,
    /// Largest absolute value of an entry of the elements' maps.
    largest: f64,
}

/// Patterns by block and direction, for all threads.
pub(super) type Patterns = Arc<RwLock<FastMap<(u64, Direction), Arc<Pattern>>>>;

impl Pattern {
    /// Returns the pattern of a run, which is computed where there is none yet.
    pub(super) fn find<F: Listed>(patterns: &Patterns, run: &Run<'_, F>) -> Arc<Self> {
        let key = (run.number(), run.frame().direction());
        let known = patterns.read().unwrap_or_else(PoisonError::into_inner);
        if let Some(pattern) = known.get(&key) {
            return Arc::clone(pattern);
        }
        drop(known);
        let pattern = Arc::new(Self::of(run));
        let mut known = patterns.write().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(known.entry(key).or_insert(pattern))
    }

    fn of<F: Listed>(run: &Run<'_, F>) -> Self {
        let mut pattern = Self {
            coordinates: [const { Vec::new() }; 4],
            fertile: Vec::new(),
            direction: Vec::new(),
            visible: Vec::new(),
            joined: Vec::new(),
            largest: 0.0,
        };
        for element in run.in_unit_frame().elements() {
            match element.frame.listed(&Homothety::IDENTITY, false) {
                Some((coordinates, entries)) => {
                    let columns = pattern.coordinates.iter_mut();
                    for (column, &value) in columns.zip(coordinates.as_ref()) {
                        column.push(value);
                    }
                    pattern.largest = pattern.largest.max(largest(entries.as_ref()));
                }
                None => pattern.largest = f64::INFINITY,
            }
            pattern.fertile.push(element.fertile);
            pattern.direction.push(element.frame.direction().number());
            pattern.visible.push(element.visible);
            pattern.joined.push(element.joined);
        }
        pattern
    }

    /// Returns whether the elements of a run with a frame are certainly in range, and their coordinates in the units to which
    /// a homothety leads are finite.
    pub(super) fn is_in_range<F: Listed>(&self, frame: F, place: &Homothety<F::Point>) -> bool {
        let Some((_, entries)) = frame.listed(place, false) else {
            return false;
        };
        let own = largest(entries.as_ref());
        // In the plane, an entry of a product is a sum of two products of entries, and perhaps an entry.
        let bound = 2.0 * own * self.largest + own;
        bound < LARGEST_ENTRY && bound * place.ratio() < LARGEST_ENTRY
    }
}

/// Returns the largest absolute value.
fn largest(values: &[f64]) -> f64 {
    let absolute = values.iter().map(|value| value.abs());
    absolute.fold(0.0, f64::max)
}
