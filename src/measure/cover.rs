//! Covers by boxes of many sizes, on grids that are shifted and turned.

use std::num::NonZero;

use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::parallel::map;
use crate::saturating::{real, whole};

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
pub struct Grid {
    /// Angle by which the set is turned against the grid: radians, counter-clockwise, from 0 to below π/2.
    pub angle: f64,
    /// Distance at which the grid begins left of and below the set, as a fraction of the largest box, from 0
    /// to 1.
    pub shift: DVec2,
}

impl Grid {
    /// The grid along the axes, from the lower left corner of the set.
    pub const ALONG: Self = Self {
        angle: 0.0,
        shift: DVec2::ZERO,
    };

    /// Creates `count` grids: the first along the axes from the lower left corner of the set, the others
    /// spread evenly (by the golden section and its analogue in two dimensions).
    #[must_use]
    pub fn spread(count: NonZero<usize>) -> Vec<Self> {
        // The reciprocals of the positive roots of x² = x + 1 and x³ = x + 1.
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        const PLASTIC: f64 = 0.754_877_666_246_692_7;
        let spread = (0..count.get()).map(|number| {
            let number = real(number);
            Self {
                angle: (number * GOLDEN).fract() * std::f64::consts::FRAC_PI_2,
                shift: (DVec2::new(PLASTIC, PLASTIC * PLASTIC) * number).fract(),
            }
        });
        spread.collect()
    }

    /// Returns the map from the plane to a grid of boxes of side 1 that covers a turned box, and the numbers
    /// of its columns and rows. Before the map, boxes have the side `size`, and the largest ones `largest`.
    pub(super) fn map(&self, turned: &Bounds, size: f64, largest: f64) -> (DAffine2, [usize; 2]) {
        // Points on the rim of the set must not open new boxes because of rounding.
        const HAIR: f64 = 1e-9;
        let hair = HAIR * turned.size().max_element();
        let corner = turned.min() - hair - self.shift * largest;
        let extent = (turned.max() + hair - corner) / size;
        let map = DAffine2::from_scale(DVec2::splat(1.0 / size))
            * DAffine2::from_translation(-corner)
            * DAffine2::from_mat2(self.turn());
        (map, extent.to_array().map(boxes))
    }

    /// Returns the rotation by which the set is turned.
    pub(super) fn turn(&self) -> crate::geometry::DMat2 {
        let (sin, cos) = libm::sincos(self.angle);
        crate::geometry::DMat2::from_cols(DVec2::new(cos, sin), DVec2::new(-sin, cos))
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
pub(super) fn least(
    sizes: &[f64],
    grids: &[Grid],
    threads: NonZero<usize>,
    count: impl Fn(&Grid) -> Vec<u64> + Sync,
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
        let of_least = |last| logarithm(least(number)) - logarithm(least(last));
        Scale {
            size,
            count: least(number),
            scatter: deviation(logs(number)),
            growth: last.map(of_least).unwrap_or_default(),
            growth_error: last.map(|last| deviation(growth(last))).unwrap_or_default(),
            sampled: false,
        }
    };
    let counted = counts.iter().map(Vec::len).min().unwrap_or_default();
    sizes.iter().take(counted).enumerate().map(scale).collect()
}
