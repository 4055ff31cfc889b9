//! Similar sets in space: sets of which one is the image of the other under a similarity about its start.

use std::collections::BTreeMap;

use crate::geometry::{DAffine3, DMat3, DVec3};

use super::super::NoGrowth;
use super::super::budget::Budget;
use super::super::pieces::{Piece, ROUNDING, Set};
use super::growth::rotation;

/// Limit of the number of pairs of sets that are compared.
const MAX_PAIRS: usize = 1 << 12;

/// Number of comparisons of similarities that count as one operation.
const COMPARED: usize = 16;

/// Largest number of pieces from whose places a similarity is found.
const MAX_PLACES: usize = 1 << 8;

/// Sets, of which one may be a point, that is left out.
#[derive(Clone, Copy)]
pub(super) struct Sets<'s> {
    pub(super) all: &'s [Set<DAffine3>],
    pub(super) point: Option<usize>,
    pub(super) budget: &'s Budget,
}

impl<'s> Sets<'s> {
    /// Returns whether the union of pieces is similar to that of others, piece by piece in their order.
    ///
    /// Two sets are similar if all pieces of one are images of those of the other, in the same order; for pairs that occur
    /// again, that is assumed. Greatest solutions of these conditions are right, because the sets are determined by their
    /// pieces (Hutchinson 1981).
    ///
    /// # Errors
    ///
    /// If the comparison takes too much work.
    pub(super) fn are_alike(
        self,
        a: &'s [Piece<DAffine3>],
        b: &'s [Piece<DAffine3>],
    ) -> Result<bool, NoGrowth> {
        let mirror = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
        let Some([from, to]) = self.places(a, b)? else {
            return Ok(false);
        };
        for mirror in [DMat3::IDENTITY, mirror] {
            let seen: Vec<DVec3> = to.iter().map(|it| mirror * *it).collect();
            let size = |places: &[DVec3]| places.iter().map(|it| it.length()).fold(0.0, f64::max);
            let similarity = rotation(&from, &seen)
                .map_or(mirror, |turn| mirror * turn * (size(&to) / size(&from)));
            let mut search = Search {
                sets: self,
                known: BTreeMap::new(),
                open: Vec::new(),
            };
            if search.pieces(a, b, similarity)? && search.finish()? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Returns the pieces that are not points.
    fn extended(self, pieces: &'s [Piece<DAffine3>]) -> impl Iterator<Item = &'s Piece<DAffine3>> {
        pieces.iter().filter(move |it| self.point != Some(it.set))
    }

    /// Returns corresponding places in two unions, of pieces that are replaced until these suffice to find a similarity;
    /// `None` if the pieces do not correspond.
    fn places(
        self,
        a: &'s [Piece<DAffine3>],
        b: &'s [Piece<DAffine3>],
    ) -> Result<Option<[Vec<DVec3>; 2]>, NoGrowth> {
        let mut both = [a, b].map(|pieces| -> Vec<(DAffine3, usize)> {
            self.extended(pieces).map(|it| (it.map, it.set)).collect()
        });
        let mut found = [Vec::new(), Vec::new()];
        loop {
            let count = both[0].len();
            if count != both[1].len() {
                return Ok(None);
            }
            for (found, parts) in found.iter_mut().zip(&both) {
                found.extend(parts.iter().map(|(map, _)| map.translation));
            }
            if count > MAX_PLACES || found[0].len() > 4 * MAX_PLACES {
                return Ok(Some(found));
            }
            let inner = both
                .iter()
                .flatten()
                .map(|(_, set)| self.all[*set].pieces.len());
            self.budget.spend(inner.sum())?;
            both = both.map(|parts| {
                let inner = parts.into_iter().flat_map(|(map, set)| {
                    let pieces = self.extended(&self.all[set].pieces);
                    pieces.map(move |piece| (map * piece.map, piece.set))
                });
                inner.collect()
            });
            if both[0].is_empty() && both[1].is_empty() {
                return Ok(Some(found));
            }
        }
    }
}

struct Search<'s> {
    sets: Sets<'s>,
    /// Similarities of pairs of sets.
    known: BTreeMap<(usize, usize), Vec<DMat3>>,
    open: Vec<(usize, usize, DMat3)>,
}

impl Search<'_> {
    fn finish(&mut self) -> Result<bool, NoGrowth> {
        let mut count = 0;
        while let Some((a, b, by)) = self.open.pop() {
            count += 1;
            let [one, other] = [a, b].map(|it| &self.sets.all[it]);
            if count > MAX_PAIRS || one.is_line != other.is_line {
                return Ok(false);
            }
            if one.is_line && !is_near(by * DVec3::X, DVec3::X) {
                return Ok(false);
            }
            if !self.pieces(&one.pieces, &other.pieces, by)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Compares pieces, and adds the pairs of their sets.
    fn pieces(
        &mut self,
        a: &[Piece<DAffine3>],
        b: &[Piece<DAffine3>],
        by: DMat3,
    ) -> Result<bool, NoGrowth> {
        let (sets, count) = (self.sets, |pieces| self.sets.extended(pieces).count());
        if count(a) != count(b) {
            return Ok(false);
        }
        for (a, b) in sets.extended(a).zip(sets.extended(b)) {
            if !is_near(by * a.map.translation, b.map.translation) {
                return Ok(false);
            }
            let inner = b.map.matrix3.inverse() * by * a.map.matrix3;
            let known = self.known.entry((a.set, b.set)).or_default();
            sets.budget.spend(1 + known.len() / COMPARED)?;
            let is_known =
                |known: &DMat3| (0..3).all(|axis| is_near(known.col(axis), inner.col(axis)));
            if !known.iter().any(is_known) {
                known.push(inner);
                self.open.push((a.set, b.set, inner));
            }
        }
        Ok(true)
    }
}

fn is_near(a: DVec3, b: DVec3) -> bool {
    a.distance(b) <= 10.0 * ROUNDING * (1.0 + a.length())
}
