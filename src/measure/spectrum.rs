//! The spectrum of dimensions D_q: how entropies of a set's mass grow as boxes get smaller.

use std::num::NonZero;

use super::averaging::averaged;
use super::bits::Bits;
use super::box_counting::{BoxCounting, Boxes, PLANE};
use super::cover::{Grid, deviation, mean, on_all};
use super::limit::LimitSet;
use super::mass::{COARSEST, FINENESS, Masses};
use super::raster::whole;
use super::regression::{Estimate, Reading, estimate};
use super::sample::Sample;

/// A dimension of the spectrum D_q (Hentschel & Procaccia 1983), and its evidence.
#[derive(Clone, Debug)]
pub struct Generalised {
    /// The order: 0 counts boxes, 1 is the information dimension, 2 the correlation dimension.
    pub order: f64,
    /// The dimension; none if there are fewer than three sizes.
    pub estimate: Option<Estimate>,
    /// By the side of the boxes, from the largest on: ln Σ p^q / (1 − q), or −Σ p ln p for q = 1, where
    /// p are the parts of the mass in the boxes; the least of all grids, or their mean for points.
    pub entropies: Vec<(f64, f64)>,
}

/// In boxes that are so many times as large as those whose masses are equal, masses are a set's own.
const COARSER: f64 = 8.0;

impl Generalised {
    /// That of order 0, as boxes have told it.
    #[must_use]
    pub fn of_boxes(counting: &BoxCounting) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "a logarithm is rounded")]
        let entropy = |it: &Boxes| (it.size, libm::log(it.count.max(1) as f64));
        Self {
            order: 0.0,
            estimate: counting.estimate,
            entropies: counting.boxes.iter().map(entropy).collect(),
        }
    }

    /// Those of a picture, all of whose set pixels have the same mass, for some orders.
    ///
    /// Used are boxes of at least 8 pixels, of which at least 4 make the long side of the picture.
    #[must_use]
    pub fn of_pixels(
        pixels: &Bits,
        orders: &[f64],
        grids: &[Grid],
        threads: NonZero<usize>,
    ) -> Vec<Self> {
        let largest = pixels.width().max(pixels.height()) / 4;
        let masses = |grid: &Grid| Some(Masses::of_pixels(pixels, whole(grid.shift, largest)));
        #[expect(clippy::cast_precision_loss, reason = "pictures are smaller than that")]
        let range = [COARSER, largest as f64];
        of_masses(orders, grids, threads, range, masses).unwrap_or_default()
    }

    /// Those of a limit set whose mass is the same in all boxes of a fine grid that it meets, for some
    /// orders.
    ///
    /// Used are boxes from 1/128 to a quarter of the extent on four grids, or from coarser ones where the
    /// set cannot be covered by smaller boxes; none if not even by 128 in a row.
    #[must_use]
    pub fn of_limit(
        set: &LimitSet,
        orders: &[f64],
        grids: &[Grid],
        threads: NonZero<usize>,
    ) -> Vec<Self> {
        const GRIDS: usize = 4;
        let grids = &grids[..grids.len().min(GRIDS)];
        let extent = set.bounds().size().max_element();
        let by = |boxes: usize| {
            #[expect(clippy::cast_precision_loss, reason = "grids are small")]
            let finest = extent * COARSER / boxes as f64;
            let masses = |grid: &Grid| Masses::of_limit(set, grid, boxes);
            of_masses(orders, grids, threads, [finest, extent * COARSEST], masses)
        };
        FINENESS.into_iter().find_map(by).unwrap_or_default()
    }

    /// Those of points as a sample of a set, for some orders.
    ///
    /// Used are boxes of the sizes that box counting may use, up to a quarter of the extent.
    #[must_use]
    pub fn of_sample(sample: &Sample, orders: &[f64], finest: f64) -> Vec<Self> {
        let sizes = &sample.sizes()[..sample.enough()];
        let coarsest = sizes.first().map_or(0.0, |first| first / 2.0);
        let used = sizes.iter().enumerate();
        let used = used.filter(|(_, size)| **size >= finest && **size <= coarsest * SLACK);
        let used: Vec<(usize, f64)> = used.map(|(number, &size)| (number, size)).collect();
        let of = |&order: &f64| {
            let entropies = used.iter();
            let entropies =
                entropies.map(|&(number, size)| (size, sample.entropies(number, order)));
            fitted(order, &entropies.collect::<Vec<_>>(), true)
        };
        orders.iter().map(of).collect()
    }
}

/// Sizes that differ by rounding only are the same.
const SLACK: f64 = 1.0 + 1e-6;

/// The spectrum of masses on several grids, over boxes of sizes in a range.
fn of_masses(
    orders: &[f64],
    grids: &[Grid],
    threads: NonZero<usize>,
    [finest, coarsest]: [f64; 2],
    masses: impl Fn(&Grid) -> Option<Masses> + Sync,
) -> Option<Vec<Generalised>> {
    // By grid, size and order.
    let entropies = on_all(grids, threads, |_, grid| {
        let mut masses = masses(grid)?;
        let mut entropies = Vec::new();
        while masses.size() <= coarsest * SLACK {
            if masses.size() * SLACK >= finest {
                entropies.push((masses.size(), masses.entropies(orders)));
            }
            masses = masses.folded();
        }
        entropies.reverse();
        Some(entropies)
    });
    let entropies: Vec<Vec<(f64, Vec<f64>)>> = entropies.into_iter().collect::<Option<_>>()?;
    let sizes = entropies.iter().map(Vec::len).min().unwrap_or_default();
    let of = |(number, &order): (usize, &f64)| {
        let by_size = (0..sizes).map(|size| {
            let all = entropies.iter().map(|grid| grid[size].1[number]);
            (entropies[0][size].0, all.collect())
        });
        fitted(order, &by_size.collect::<Vec<_>>(), false)
    };
    Some(orders.iter().enumerate().map(of).collect())
}

/// The slope of entropies by size and grid; of sizes, those are used at which all are finite.
///
/// Of a set that is known, the least entropy of all grids is kept, as the least cover is; of a sample,
/// their mean.
fn fitted(order: f64, entropies: &[(f64, Vec<f64>)], is_sample: bool) -> Generalised {
    let finite = |by_grid: &Vec<f64>| by_grid.iter().all(|entropy| entropy.is_finite());
    let entropies = entropies.iter().filter(|(_, by_grid)| finite(by_grid));
    let entropies: Vec<_> = entropies.collect();
    let kept = |by_grid: &[f64]| {
        if is_sample {
            mean(by_grid)
        } else {
            by_grid.iter().copied().fold(f64::INFINITY, f64::min)
        }
    };
    let reading = |(number, (size, by_grid)): (usize, &&(f64, Vec<f64>))| {
        let last = &entropies[number.saturating_sub(1)].1;
        let growth = by_grid.iter().zip(last).map(|(a, b)| a - b);
        #[expect(clippy::cast_precision_loss, reason = "grids are few")]
        let grids = by_grid.len() as f64;
        Reading {
            size: *size,
            log: kept(by_grid),
            scatter: deviation(by_grid.iter().copied()),
            growth: kept(by_grid) - kept(last),
            growth_error: deviation(growth) / grids.sqrt(),
        }
    };
    let readings: Vec<Reading> = entropies.iter().enumerate().map(reading).collect();
    // Of negative orders, dimensions may be larger than the plane's.
    let most = if order < 0.0 { f64::INFINITY } else { PLANE };
    let averaged = is_sample.then(|| averaged(&readings, most)).flatten();
    Generalised {
        order,
        estimate: averaged.or_else(|| estimate(&readings)),
        entropies: readings.iter().map(|it| (it.size, it.log)).collect(),
    }
}
