//! Covers by boxes of many sizes, on grids that are moved and turned.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use crate::geometry::{Bounds, DAffine2, DVec2};

/// How a set is covered by boxes of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The side of a box, in the units of the set.
    pub size: f64,
    /// The number of boxes of the least cover that was found.
    pub count: u64,
    /// The standard deviation of the natural logarithm of the count among all grids.
    pub scatter: f64,
}

/// How a grid lies on a set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// By how much the set is turned against the grid: radians, counter-clockwise, below π/2.
    pub angle: f64,
    /// How far the grid begins below and left of the set, in parts of the largest box, from 0 to 1.
    pub shift: DVec2,
}

impl Grid {
    /// Along the axes, from the lower left corner of the set.
    pub const ALONG: Self = Self {
        angle: 0.0,
        shift: DVec2::ZERO,
    };

    /// So many grids: the first along the axes from the lower left corner of the set, the others
    /// spread evenly (by the golden section and its like in two dimensions).
    #[must_use]
    pub fn spread(count: NonZero<usize>) -> Vec<Self> {
        // The positive roots of x² = x + 1 and x³ = x + 1, inverted.
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        const PLASTIC: f64 = 0.754_877_666_246_692_7;
        let spread = (0..count.get()).map(|number| {
            #[expect(clippy::cast_precision_loss, reason = "grids are few")]
            let number = number as f64;
            Self {
                angle: (number * GOLDEN).fract() * std::f64::consts::FRAC_PI_2,
                shift: (DVec2::new(PLASTIC, PLASTIC * PLASTIC) * number).fract(),
            }
        });
        spread.collect()
    }

    /// The map from the plane to a grid of boxes of side 1 that covers a turned box, and the numbers
    /// of its columns and rows. The largest box has a side of `largest`.
    pub(super) fn map(&self, turned: &Bounds, size: f64, largest: f64) -> (DAffine2, [usize; 2]) {
        // What lies on the rim of the set must not open new boxes because of rounding.
        const HAIR: f64 = 1e-9;
        let hair = HAIR * turned.size().max_element();
        let corner = turned.min() - hair - self.shift * largest;
        let extent = (turned.max() + hair - corner) / size;
        let map = DAffine2::from_scale(DVec2::splat(1.0 / size))
            * DAffine2::from_translation(-corner)
            * DAffine2::from_mat2(self.turn());
        (map, extent.to_array().map(whole))
    }

    /// The turn alone.
    pub(super) fn turn(&self) -> crate::geometry::DMat2 {
        let (sin, cos) = libm::sincos(self.angle);
        crate::geometry::DMat2::from_cols(DVec2::new(cos, sin), DVec2::new(-sin, cos))
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
fn whole(extent: f64) -> usize {
    (extent.ceil() as usize).max(1)
}

/// Counts the boxes of all sizes on all grids, and keeps the least count of every size.
///
/// `count` tells the counts for all sizes on one grid. The result does not depend on the threads.
pub(super) fn least(
    sizes: &[f64],
    grids: &[Grid],
    threads: NonZero<usize>,
    count: impl Fn(&Grid) -> Vec<u64> + Sync,
) -> Vec<Scale> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut counts = Vec::new();
        while let Some(grid) = grids.get(next.fetch_add(1, Ordering::Relaxed)) {
            counts.push(count(grid));
        }
        counts
    };
    let mut counts = Vec::new();
    thread::scope(|scope| {
        let others: Vec<_> = (1..threads.get().min(grids.len()))
            .map(|_| scope.spawn(work))
            .collect();
        counts.extend(work());
        for other in others {
            match other.join() {
                Ok(more) => counts.extend(more),
                Err(cause) => std::panic::resume_unwind(cause),
            }
        }
    });
    let scale = |(number, &size): (usize, &f64)| {
        let mut all: Vec<u64> = counts.iter().map(|counts| counts[number]).collect();
        // Sums must not depend on who was first.
        all.sort_unstable();
        Scale {
            size,
            count: all.first().copied().unwrap_or_default(),
            scatter: scatter(&all),
        }
    };
    sizes.iter().enumerate().map(scale).collect()
}

/// The standard deviation of logarithms.
#[expect(clippy::cast_precision_loss, reason = "a deviation is an estimate")]
fn scatter(counts: &[u64]) -> f64 {
    if counts.len() < 2 {
        return 0.0;
    }
    let logs: Vec<f64> = counts
        .iter()
        .map(|&count| libm::log(count.max(1) as f64))
        .collect();
    let mean = logs.iter().sum::<f64>() / logs.len() as f64;
    let squares = logs.iter().map(|log| (log - mean) * (log - mean));
    (squares.sum::<f64>() / (logs.len() - 1) as f64).sqrt()
}
