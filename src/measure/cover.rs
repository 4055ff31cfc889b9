//! Covers by boxes of many sizes, on grids that are shifted and turned.

use std::num::NonZero;

use crate::geometry::{Bounds, DAffine2, Linear, Point};
use crate::parallel::map;
use crate::saturating::{real, whole};

use super::space::Space;
use super::statistics::{deviation, logarithm};

/// Cover of a set by boxes of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Side of a box, in the units of the set.
    pub size: f64,
    /// Number of boxes of the smallest cover that was found, or its estimate from a sample.
    pub count: u64,
    /// Standard deviation of the natural logarithm of the count over all grids.
    pub scatter: f64,
    /// Growth of the natural logarithm of the count since the previous size: of the smallest covers, or of
    /// the mean over all grids where counts come from a sample.
    pub growth: f64,
    /// Standard error of the growth.
    pub growth_error: f64,
    /// Whether the count is estimated from a sample of boxes.
    pub sampled: bool,
}

impl Scale {
    /// Returns the local slope to a finer scale.
    pub(super) fn slope_to(&self, finer: &Self) -> f64 {
        (logarithm(finer.count) - logarithm(self.count)) / libm::log(self.size / finer.size)
    }
}

/// Position of a grid relative to a set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid<M: Space = DAffine2> {
    /// Turn of the set against the grid: in the plane an angle in radians, counter-clockwise; in space a
    /// rotation.
    pub turn: M::Turn,
    /// Distance at which the grid begins before the set along every axis, as a fraction of the largest box,
    /// from 0 to 1.
    pub shift: M::Point,
}

/// Numbers of boxes along the axes; 1 along those beyond the dimension of the set's space.
pub(super) type Counts = [usize; 3];

impl<M: Space> Grid<M> {
    /// The grid along the axes, from the lower left corner of the set.
    pub const ALONG: Self = Self {
        turn: M::ALONG,
        shift: M::Point::ZERO,
    };

    /// Creates `count` grids: the first along the axes from the lower left corner of the set, the others
    /// spread evenly (by the golden section and its analogues in more dimensions).
    #[must_use]
    pub fn spread(count: NonZero<usize>) -> Vec<Self> {
        let spread = (0..count.get()).map(|number| {
            let (turn, shift) = M::spread(real(number));
            Self { turn, shift }
        });
        spread.collect()
    }

    /// Returns the map from the plane to a grid of boxes of side 1 that covers a turned box, and the numbers
    /// of its columns and rows. Before the map, boxes have the side `size`, and the largest ones `largest`.
    pub(super) fn map(&self, turned: &Bounds<M::Point>, size: f64, largest: f64) -> (M, Counts) {
        // Points on the rim of the set must not open new boxes because of rounding.
        const HAIR: f64 = 1e-9;
        let hair = HAIR * turned.size().max_element();
        let hair = M::Point::splat(hair);
        let corner = turned.min() - hair - self.shift * largest;
        let extent = (turned.max() + hair - corner) / size;
        let map = M::new(M::Linear::IDENTITY * (1.0 / size), M::Point::ZERO)
            * M::new(M::Linear::IDENTITY, -corner)
            * M::new(self.linear(), M::Point::ZERO);
        (map, extent.coordinates().map(boxes))
    }

    /// Returns the rotation by which the set is turned.
    pub(super) fn linear(&self) -> M::Linear {
        M::rotation(&self.turn)
    }
}

/// Returns the number of boxes of side 1 that cover an extent.
fn boxes(extent: f64) -> usize {
    whole(extent.ceil()).max(1)
}

/// Counts the boxes of all sizes on all grids, and keeps the smallest count of every size.
///
/// `count` returns the counts for the sizes on one grid; sizes beyond the shortest of these lists are
/// dropped. The result does not depend on the number of threads.
pub(super) fn least<M: Space>(
    sizes: &[f64],
    grids: &[Grid<M>],
    threads: NonZero<usize>,
    count: impl Fn(&Grid<M>) -> Vec<u64> + Sync,
) -> Vec<Scale> {
    let counts = map(grids, threads.get(), |_, grid| count(grid));
    let logs = |number: usize| counts.iter().map(move |counts| logarithm(counts[number]));
    let least = |number: usize| {
        let counts = counts.iter().map(|counts| counts[number]);
        counts.min().unwrap_or(0)
    };
    let scale = |(number, &size): (usize, &f64)| {
        let last = number.checked_sub(1);
        let growth = |last| logs(number).zip(logs(last)).map(|(log, last)| log - last);
        let of_min = |last| logarithm(least(number)) - logarithm(least(last));
        Scale {
            size,
            count: least(number),
            scatter: deviation(logs(number)),
            growth: last.map(of_min).unwrap_or_default(),
            growth_error: last.map(|last| deviation(growth(last))).unwrap_or_default(),
            sampled: false,
        }
    };
    let counted = counts.iter().map(Vec::len).min().unwrap_or_default();
    sizes.iter().take(counted).enumerate().map(scale).collect()
}
