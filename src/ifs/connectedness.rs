//! Whether an attractor is connected: certificates of disconnectedness, and the cases in which a theorem decides.
//!
//! An attractor A = f_1(A) ∪ … ∪ f_n(A) is connected if and only if the graph is in which i and j are joined where
//! f_i(A) and f_j(A) meet (Hata, "On the structure of self-similar sets", 1985, theorem 4.6). For two maps this is the
//! question of Barnsley & Harrington ("A Mandelbrot set for pairs of linear maps", 1985).
//!
//! Two pieces do not meet if all pairs of smaller pieces in them are apart, and pieces are apart if discs or other convex
//! sets about them are. A depth-first descent over pairs of pieces whose discs meet, of which the larger one is divided,
//! thus certifies that pieces are disjoint. A certificate accounts for the rounding errors of the descent; it holds for the maps with exactly
//! the numbers that are given.

mod disc;
mod pieces;
mod touching;
mod translations;

#[cfg(test)]
mod tests;

use super::Ifs;
use crate::geometry::DAffine2;
pub(in crate::ifs) use disc::{Centred, Shrunk};
use pieces::Pieces;
use touching::{Meeting, bottleneck, meet_by_theorem};
use translations::Translations;

/// Whether the attractor of a system is connected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Connectedness {
    /// The attractor is disconnected. The certificate consists of pieces under compositions of at most this number of maps.
    Disconnected(u32),
    /// The attractor is connected: see [`ConnectednessSearch::of`].
    Connected,
    /// Pieces under compositions of [`ConnectednessSearch::depth`] maps do not certify that the attractor is disconnected.
    NotCertified,
    /// The search has exceeded its budget, or no disc about the attractor was found.
    Undecided,
    /// The system does not contract and has no attractor.
    DoesNotContract,
}

/// Search for a certificate that an attractor is disconnected.
#[derive(Clone, Debug)]
pub struct ConnectednessSearch {
    depth: u32,
    budget: u32,
    translations: Translations,
    pieces: Pieces,
}

/// Number of pairs of pieces whose discs are compared.
type Budget = u32;

impl ConnectednessSearch {
    /// Number of maps in a composition, by default.
    pub const DEPTH: u32 = 32;
    /// Largest number of maps in a composition. Rounding errors prevent certificates by smaller pieces.
    pub const MAX_DEPTH: u32 = 200;
    /// Default limit of the number of pairs of pieces that are compared for a system.
    pub const BUDGET: u32 = 100_000;

    /// Creates a search by compositions of at most `depth` maps, up to [`MAX_DEPTH`](Self::MAX_DEPTH).
    #[must_use]
    pub fn new(depth: u32) -> Self {
        Self {
            depth: depth.clamp(1, Self::MAX_DEPTH),
            budget: Self::BUDGET,
            translations: Translations::default(),
            pieces: Pieces::default(),
        }
    }

    /// Sets the limit of the number of pairs of pieces that are compared for a system.
    #[must_use]
    pub fn budget(self, budget: u32) -> Self {
        Self { budget, ..self }
    }

    /// Returns the largest number of maps in a composition.
    #[must_use]
    pub fn depth(&self) -> u32 {
        self.depth
    }

    /// Determines whether the attractor of maps is connected.
    ///
    /// [`Connected`](Connectedness::Connected) is returned where pieces that provably meet join all maps:
    ///
    /// - f_i and f_j are equal;
    /// - |det f_i| + |det f_j| ≥ 1. Otherwise the pieces of the attractor B of these two maps would be disjoint, and
    ///   the images of a neighbourhood of B would be disjoint subsets of a smaller neighbourhood, which has less area. For
    ///   {s z + 1, s z − 1} this is |s| ≥ 1/√2;
    /// - both are homotheties, x → r x + t, with |r_i| + |r_j| ≥ 1, for the same reason on the line through their fixed
    ///   points: real s from 1/2.
    ///
    /// A single map has one point, which is connected.
    ///
    /// The linear part of all maps may be the same matrix L, in which case x − y for points with f_i(x) = f_j(y) lies in
    /// A − A, and the search follows w → L⁻¹(w − d) over the differences d of translations, as long as w is in a disc
    /// about A − A. Where discs certify nothing, octagons do it.
    pub fn of(&mut self, maps: &[DAffine2]) -> Connectedness {
        let mut budget = self.budget;
        let shrunk = match Shrunk::of(maps) {
            Ok(shrunk) => shrunk,
            Err(verdict) => return verdict,
        };
        let theorem = |[i, j]: [usize; 2]| meet_by_theorem(&maps[i], &maps[j]);
        let depth = self.depth;
        if let Some(common) = self.translations.prepare(&shrunk, depth) {
            return bottleneck(maps.len(), theorem, |pair| {
                self.translations.meeting(&common, pair, depth, &mut budget)
            });
        }
        let centred = match Centred::of(&shrunk, &mut budget) {
            Ok(centred) => centred,
            Err(verdict) => return verdict,
        };
        bottleneck(maps.len(), theorem, |pair| {
            self.pieces.meeting(&centred, pair, depth, &mut budget)
        })
    }
}

impl Ifs {
    /// Determines whether the attractor is connected, by [`ConnectednessSearch::of`]; `None` for systems with a digraph or
    /// condensation sets, for whose attractors the theorem does not hold.
    ///
    /// ```
    /// use kfrac::geometry::DVec2;
    /// use kfrac::ifs::{Connectedness, ConnectednessSearch, Definition, Ifs, Map, complex};
    ///
    /// let pair = |re: f64, im: f64| {
    ///     let maps = [1.0, -1.0].map(|t| Map::new(complex(DVec2::new(re, im), DVec2::new(t, 0.0))));
    ///     let ifs = Ifs::new(Definition { maps: maps.into(), ..Definition::default() });
    ///     ifs.unwrap().connectedness(&mut ConnectednessSearch::new(32))
    /// };
    /// assert_eq!(pair(0.3, 0.3), Some(Connectedness::Disconnected(1)));
    /// assert_eq!(pair(0.6, 0.6), Some(Connectedness::Connected));
    /// ```
    pub fn connectedness(&self, search: &mut ConnectednessSearch) -> Option<Connectedness> {
        let is_plain = !self.is_recurrent() && self.condensation().is_empty();
        let maps: Vec<DAffine2> = self.maps().iter().map(|map| map.affine).collect();
        is_plain.then(|| search.of(&maps))
    }
}
