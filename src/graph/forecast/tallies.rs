//! Tallies by object.

use std::collections::BTreeMap;

use super::Tally;

/// Place of objects without a tally.
const NONE: u32 = u32::MAX;

/// Tallies of objects. They are found by number while they are added up, and sorted afterwards.
pub(super) struct Tallies {
    /// Place of the tally of each object.
    places: Vec<u32>,
    all: Vec<(usize, Tally)>,
}

impl Tallies {
    /// Creates tallies of so many objects.
    pub(super) fn new(objects: usize) -> Self {
        Self {
            places: vec![NONE; objects],
            all: Vec::new(),
        }
    }

    /// Returns the tally of an object, to be added up.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "graphs have fewer than 2³² objects"
    )]
    pub(super) fn of(&mut self, object: usize) -> &mut Tally {
        let place = &mut self.places[object];
        if *place == NONE {
            *place = self.all.len() as u32;
            self.all.push((object, Tally::default()));
        }
        &mut self.all[*place as usize].1
    }

    /// Sorts the tallies by object. None may be added until they are taken.
    pub(super) fn sort(&mut self) {
        for (object, _) in &self.all {
            self.places[*object] = NONE;
        }
        self.all.sort_unstable_by_key(|(object, _)| *object);
    }

    /// Replaces all tallies.
    pub(super) fn set(&mut self, tallies: BTreeMap<usize, Tally>) {
        self.all = tallies.into_iter().collect();
    }

    /// Returns all tallies, sorted, and leaves none.
    pub(super) fn take(&mut self) -> Vec<(usize, Tally)> {
        std::mem::take(&mut self.all)
    }

    /// Iterates over the tallies, by object.
    pub(super) fn iter(&self) -> impl Iterator<Item = (usize, &Tally)> + Clone {
        self.all.iter().map(|(object, tally)| (*object, tally))
    }
}
