//! Covers by boxes of many sizes, on grids that are moved and turned.

use std::num::NonZero;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::whole::whole;

/// How a set is covered by boxes of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The side of a box, in the units of the set.
    pub size: f64,
    /// The number of boxes of the least cover that was found, or what a sample tells it to be.
    pub count: u64,
    /// The standard deviation of the natural logarithm of the count among all grids.
    pub scatter: f64,
    /// How much the logarithm of the count grows since the size before: of the least covers, or on the
    /// mean of all grids where counts come from a sample.
    pub growth: f64,
    /// The standard error of the growth.
    pub growth_error: f64,
    /// Whether the count comes from a sample of boxes.
    pub sampled: bool,
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
        (map, extent.to_array().map(boxes))
    }

    /// The turn alone.
    pub(super) fn turn(&self) -> crate::geometry::DMat2 {
        let (sin, cos) = libm::sincos(self.angle);
        crate::geometry::DMat2::from_cols(DVec2::new(cos, sin), DVec2::new(-sin, cos))
    }
}

/// How many boxes hold an extent.
fn boxes(extent: f64) -> usize {
    whole(extent.ceil()).max(1)
}

/// Returns the results of `count` for every grid, in the order of the grids.
pub(super) fn on_all<G: Sync, T: Send>(
    grids: &[G],
    threads: NonZero<usize>,
    count: impl Fn(usize, &G) -> T + Sync,
) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut told = Vec::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(grid) = grids.get(number) else {
                return told;
            };
            told.push((number, count(number, grid)));
        }
    };
    let mut told = Vec::new();
    thread::scope(|scope| {
        let others: Vec<_> = (1..threads.get().min(grids.len()))
            .map(|_| scope.spawn(work))
            .collect();
        told.extend(work());
        for other in others {
            match other.join() {
                Ok(more) => told.extend(more),
                Err(cause) => std::panic::resume_unwind(cause),
            }
        }
    });
    told.sort_by_key(|(number, _)| *number);
    told.into_iter().map(|(_, told)| told).collect()
}

/// Counts the boxes of all sizes on all grids, and keeps the least count of every size.
///
/// `count` tells the counts for the sizes on one grid; where it ends early, so do the sizes. The result
/// does not depend on the threads.
pub(super) fn least(
    sizes: &[f64],
    grids: &[Grid],
    threads: NonZero<usize>,
    count: impl Fn(&Grid) -> Vec<u64> + Sync,
) -> Vec<Scale> {
    let counts = on_all(grids, threads, |_, grid| count(grid));
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
    let told = counts.iter().map(Vec::len).min().unwrap_or_default();
    sizes.iter().take(told).enumerate().map(scale).collect()
}

#[expect(clippy::cast_precision_loss, reason = "a logarithm is rounded")]
fn logarithm(count: u64) -> f64 {
    libm::log(count.max(1) as f64)
}

/// The standard deviation of some values; 0 of fewer than two.
pub(super) fn deviation(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    if values.len() < 2 {
        return 0.0;
    }
    let mean = mean(&values);
    let squares = values.iter().map(|value| (value - mean) * (value - mean));
    #[expect(clippy::cast_precision_loss, reason = "grids are few")]
    let freedom = (values.len() - 1) as f64;
    (squares.sum::<f64>() / freedom).sqrt()
}

/// The mean of some values.
#[expect(clippy::cast_precision_loss, reason = "grids are few")]
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
