//! Similar sets: sets of which one is the image of the other under a similarity about its start.

use std::collections::BTreeMap;

use crate::geometry::DVec2;

use super::pieces::{Piece, ROUNDING, Set};

/// Limit of the number of pairs of sets that are compared.
const MAX_PAIRS: usize = 1 << 12;

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

/// Returns whether the union of pieces is similar to that of others, piece by piece in their order.
///
/// Two sets are similar if all pieces of one are images of those of the other, in the same order; for pairs that occur
/// again, that is assumed. Greatest solutions of these conditions are right, because the sets are determined by their
/// pieces (Hutchinson 1981).
pub(super) fn are_alike(sets: &[Set], a: &[Piece], b: &[Piece]) -> bool {
    let [a, b] = [a, b].map(|pieces| pieces.iter().map(Near::from).collect::<Vec<_>>());
    [false, true].into_iter().any(|mirrored| {
        let unknown = Similarity {
            factor: None,
            mirrored,
        };
        let mut search = Search {
            sets,
            known: BTreeMap::new(),
            open: Vec::new(),
        };
        search.pieces(&a, &b, unknown) && search.finish()
    })
}

struct Search<'s> {
    sets: &'s [Set],
    /// Factors of the similarities of pairs of sets, mirrored or not.
    known: BTreeMap<(usize, usize, bool), Vec<Option<DVec2>>>,
    open: Vec<(usize, usize, Similarity)>,
}

impl Search<'_> {
    fn finish(&mut self) -> bool {
        let mut count = 0;
        while let Some((a, b, by)) = self.open.pop() {
            count += 1;
            let [one, other] = [a, b].map(|it| &self.sets[it]);
            if count > MAX_PAIRS || one.is_line != other.is_line {
                return false;
            }
            let [one, other] =
                [one, other].map(|it| it.pieces.iter().map(Near::from).collect::<Vec<_>>());
            if !self.pieces(&one, &other, by) {
                return false;
            }
        }
        true
    }

    /// Compares pieces, and adds the pairs of their sets.
    fn pieces(&mut self, a: &[Near], b: &[Near], by: Similarity) -> bool {
        if a.len() != b.len() {
            return false;
        }
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
            return false;
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
            );
        }
        true
    }

    fn add(&mut self, a: usize, b: usize, by: Similarity) {
        let known = self.known.entry((a, b, by.mirrored)).or_default();
        let is_known = |known: &Option<DVec2>| match (known, by.factor) {
            (None, None) => true,
            (Some(known), Some(factor)) => is_near(*known, factor),
            _ => false,
        };
        if !known.iter().any(is_known) {
            known.push(by.factor);
            self.open.push((a, b, by));
        }
    }
}
