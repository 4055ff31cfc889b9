//! Systems of sets that are made of smaller copies of each other, from which dimensions are computed.

use std::borrow::Cow;

use crate::digraph::{Edge, longest_paths, parts};
use crate::geometry::{Affine, DAffine2, Frame, Linear, Point};
use crate::graph::Graph;
use crate::measure::copies::fixed_copies;
use glam::{DAffine3, DMat3};

/// A copy of one set inside another: the set `from` holds the image of the set `to` under the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Copy {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) map: DAffine3,
}

impl Edge for Copy {
    fn ends(&self) -> [usize; 2] {
        [self.from, self.to]
    }

    fn between(&self, [from, to]: [usize; 2]) -> Self {
        Self { from, to, ..*self }
    }
}

/// Sets K₀, K₁, … that are unions of copies, K_from = ∪ map(K_to) over the copies in `from` (Mauldin &
/// Williams 1988). One set that holds copies of itself only is the attractor of an iterated function system
/// (Hutchinson 1981).
///
/// Guarantees: the numbers of sets are in range, and all maps are finite.
#[derive(Clone, Debug)]
pub struct GraphDirectedSystem {
    /// Dimension of the space: 2 or 3.
    pub(super) space: usize,
    pub(super) size: usize,
    pub(super) copies: Vec<Copy>,
}

impl GraphDirectedSystem {
    /// Creates sets of the plane from their copies: the number of the set that holds a copy, the number of
    /// the set that is copied, and the map.
    ///
    /// Returns `None` if a number is not finite.
    #[must_use]
    pub fn plane(copies: impl IntoIterator<Item = (usize, usize, DAffine2)>) -> Option<Self> {
        Self::of_maps(copies)
    }

    /// Creates sets in space from their copies, as [`plane`](Self::plane) does.
    #[must_use]
    pub fn space(copies: impl IntoIterator<Item = (usize, usize, DAffine3)>) -> Option<Self> {
        Self::of_maps(copies)
    }

    /// Creates sets from their copies, as [`plane`](Self::plane) does.
    pub(super) fn of_maps<M: Affine>(
        copies: impl IntoIterator<Item = (usize, usize, M)>,
    ) -> Option<Self> {
        let copies = copies.into_iter().map(|(from, to, map)| Copy {
            from,
            to,
            map: map.in_space(),
        });
        let copies: Vec<Copy> = copies.collect();
        let numbers = copies.iter().flat_map(|copy| [copy.from, copy.to]);
        let size = numbers.max().map_or(0, |most| most + 1);
        let finite = copies.iter().all(|copy| copy.map.is_finite());
        finite.then_some(Self {
            space: M::Point::DIMENSION,
            size,
            copies,
        })
    }

    /// Creates the limit sets of a graph's fertile elements, without those that stay infertile.
    ///
    /// Returns `None` if the graph is not a list of fixed maps, or has resets.
    #[must_use]
    pub fn of<F: Frame>(graph: &Graph<F>) -> Option<Self> {
        Self::of_maps(fixed_copies(graph)?)
    }

    /// Returns the number of every set's strongly connected component, and the components, each with its sets
    /// numbered from 0. A copy never leads to a component of a higher number.
    ///
    /// The dimension of the whole is the largest of those of components that have a copy inside: every point
    /// lies in a copy of one, and there are countably many copies.
    pub(super) fn components(&self) -> (Vec<usize>, Vec<Self>) {
        let (component, parts) = parts(self.size, &self.copies);
        let parts = parts.into_iter().map(|(size, copies)| Self {
            space: self.space,
            size,
            copies,
        });
        (component, parts.collect())
    }

    /// Returns `true` if all maps are similarities.
    pub(super) fn is_similar(&self) -> bool {
        // The embedding of the plane scales the third direction by the square root of the area.
        self.copies.iter().all(|copy| {
            let linear = copy.map.matrix3;
            let ratio = ratio(linear);
            let turn = linear / ratio;
            ratio > 0.0 && (turn.transpose() * turn).abs_diff_eq(DMat3::IDENTITY, 1e-9)
        })
    }

    /// Returns the sets, each in a unit of its own, in which all maps contract if the products along all
    /// cycles do. Dimensions are unchanged. Systems of maps that are not similarities are returned unchanged.
    pub(super) fn in_own_units(&self) -> Cow<'_, Self> {
        // Minimum contraction of every map, as a logarithm; the largest one that the cycles permit is used.
        const LEAST: [f64; 4] = [1e-1, 1e-2, 1e-3, 1e-4];
        if !self.is_similar() || self.shrinks() {
            return Cow::Borrowed(self);
        }
        let units = LEAST.into_iter().find_map(|least| self.units(least));
        let Some(units) = units else {
            return Cow::Borrowed(self);
        };
        let copies = self.copies.iter().map(|copy| {
            let [outer, inner] = [copy.from, copy.to].map(|set| libm::exp(units[set]));
            let map = DAffine3 {
                matrix3: copy.map.matrix3 * (inner / outer),
                translation: copy.map.translation / outer,
            };
            Copy { map, ..*copy }
        });
        Cow::Owned(Self {
            copies: copies.collect(),
            ..*self
        })
    }

    /// Returns units for all sets, as logarithms: the lengths of the longest paths of copies,
    /// where `more` is added for every copy. Returns `None` where these are unbounded, or where that takes too long.
    fn units(&self, more: f64) -> Option<Vec<f64>> {
        let mut ways = vec![Vec::new(); self.size];
        for (from, to, ratio) in self.ratios() {
            ways[from].push((to, libm::log(ratio)));
        }
        longest_paths(&ways, more, f64::INFINITY)
    }

    /// Returns `true` if all maps are similarities that contract.
    pub(super) fn shrinks(&self) -> bool {
        self.is_similar() && self.ratios().all(|(_, _, ratio)| ratio < 1.0)
    }

    /// Iterates over the copies as edges with ratios: from, to, ratio.
    pub(super) fn ratios(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        let copies = self.copies.iter();
        copies.map(|copy| (copy.from, copy.to, ratio(copy.map.matrix3)))
    }
}

/// Returns the ratio of a similarity.
pub(super) fn ratio(linear: DMat3) -> f64 {
    linear.mean_ratio()
}
