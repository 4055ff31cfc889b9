//! Similar sets: sets of which one is the image of the other under a similarity about its start.

use std::collections::BTreeMap;

use crate::geometry::DVec2;

use super::NoGrowth;
use super::budget::Budget;
use super::pieces::{Piece, ROUNDING, Set};

/// Limit of the number of pairs of sets that are compared.
const MAX_PAIRS: usize = 1 << 12;

/// Number of comparisons of pieces in doubles that take as long as an operation with long numbers.
const COMPARED: usize = 4;

/// Similarity z ↦ `factor` z, or `factor` z̄ if it is mirrored; the factor may not be known yet.
#[derive(Clone, Copy)]
struct Similarity {
    factor: Option<DVec2>,
    mirrored: bool,
}

/// Pieces as numbers in doubles.
struct Near {
    set: usize,
    place: DVec2,
    factor: DVec2,
    mirrored: bool,
}

impl From<&Piece> for Near {
    fn from(piece: &Piece) -> Self {
        let [place, factor] = piece.map.near();
        Self {
            set: piece.set,
            place,
            factor,
            mirrored: piece.map.mirrored,
        }
    }
}

fn conjugate(z: DVec2, mirrored: bool) -> DVec2 {
    if mirrored { DVec2::new(z.x, -z.y) } else { z }
}

fn quotient(a: DVec2, b: DVec2) -> DVec2 {
    conjugate(b, true).rotate(a) / b.length_squared()
}

fn is_near(a: DVec2, b: DVec2) -> bool {
    a.distance(b) <= ROUNDING * (1.0 + a.length())
}

/// Sets and unions of pieces as numbers in doubles.
pub(super) struct Sets<'s> {
    all: &'s [Set],
    pieces: Vec<Vec<Near>>,
    unions: Vec<Vec<Near>>,
    budget: &'s Budget,
}

impl<'s> Sets<'s> {
    /// Rounds the pieces of sets, and of the unions that are compared.
    pub(super) fn of(
        all: &'s [Set],
        unions: &[Vec<Piece>],
        budget: &'s Budget,
    ) -> Result<Self, NoGrowth> {
        let near = |pieces: &Vec<Piece>| -> Result<Vec<Near>, NoGrowth> {
            budget.spend(pieces.len())?;
            Ok(pieces.iter().map(Near::from).collect())
        };
        Ok(Self {
            all,
            pieces: all
                .iter()
                .map(|it| near(&it.pieces))
                .collect::<Result<_, _>>()?,
            unions: unions.iter().map(near).collect::<Result<_, _>>()?,
            budget,
        })
    }

    /// Returns whether a union of pieces is similar to another, piece by piece in their order.
    ///
    /// Two sets are similar if all pieces of one are images of those of the other, in the same order; for pairs that occur
    /// again, that is assumed. Greatest solutions of these conditions are right, because the sets are determined by their
    /// pieces (Hutchinson 1981).
    ///
    /// # Errors
    ///
    /// If the comparison takes too much work.
    pub(super) fn are_alike(&self, a: usize, b: usize) -> Result<bool, NoGrowth> {
        for mirrored in [false, true] {
            let unknown = Similarity {
                factor: None,
                mirrored,
            };
            let mut search = Search {
                sets: self,
                known: BTreeMap::new(),
                open: Vec::new(),
            };
            let [a, b] = [a, b].map(|it| &self.unions[it]);
            if search.pieces(a, b, unknown)? && search.finish()? {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

struct Search<'s> {
    sets: &'s Sets<'s>,
    /// Factors of the similarities of pairs of sets, mirrored or not.
    known: BTreeMap<(usize, usize, bool), Vec<Option<DVec2>>>,
    open: Vec<(usize, usize, Similarity)>,
}

impl Search<'_> {
    fn finish(&mut self) -> Result<bool, NoGrowth> {
        let mut count = 0;
        while let Some((a, b, by)) = self.open.pop() {
            count += 1;
            let sets = self.sets;
            let [one, other] = [a, b].map(|it| &sets.all[it]);
            if count > MAX_PAIRS || one.is_line != other.is_line {
                return Ok(false);
            }
            if !self.pieces(&sets.pieces[a], &sets.pieces[b], by)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Compares pieces, and adds the pairs of their sets.
    fn pieces(&mut self, a: &[Near], b: &[Near], by: Similarity) -> Result<bool, NoGrowth> {
        if a.len() != b.len() {
            return Ok(false);
        }
        self.sets.budget.spend(a.len().div_ceil(COMPARED))?;
        let image = |a: &Near| conjugate(a.place, by.mirrored);
        let mut factor = by.factor;
        for (a, b) in a.iter().zip(b) {
            if factor.is_none() && a.place.length() > ROUNDING {
                factor = Some(quotient(b.place, image(a)));
            }
        }
        let is_placed = |(a, b): (&Near, &Near)| match factor {
            Some(factor) => factor.length() > ROUNDING && is_near(image(a).rotate(factor), b.place),
            None => b.place.length() <= ROUNDING,
        };
        if !a.iter().zip(b).all(is_placed) {
            return Ok(false);
        }
        for (a, b) in a.iter().zip(b) {
            // b.factor τ'(w ρ z) = u σ(a.factor) σ(τ(z)), where τ and τ' mirror the pieces and σ the sets.
            let inner = factor.map(|factor| {
                let turned = conjugate(a.factor, by.mirrored).rotate(factor);
                conjugate(quotient(turned, b.factor), b.mirrored)
            });
            let mirrored = a.mirrored ^ b.mirrored ^ by.mirrored;
            self.add(
                a.set,
                b.set,
                Similarity {
                    factor: inner,
                    mirrored,
                },
            )?;
        }
        Ok(true)
    }

    fn add(&mut self, a: usize, b: usize, by: Similarity) -> Result<(), NoGrowth> {
        let known = self.known.entry((a, b, by.mirrored)).or_default();
        self.sets.budget.spend(known.len() / COMPARED)?;
        let is_known = |known: &Option<DVec2>| match (known, by.factor) {
            (None, None) => true,
            (Some(known), Some(factor)) => is_near(*known, factor),
            _ => false,
        };
        if !known.iter().any(is_known) {
            known.push(by.factor);
            self.open.push((a, b, by));
        }
        Ok(())
    }
}
