//! Points as a sample of a set: the contents of boxes, and the number of boxes that the sample misses.
//!
//! A box that the set meets is seen if a point of the sample lies in it, and the counts of small boxes are
//! therefore too low. The number of missed boxes is estimated from those that a half and a quarter of the
//! points would miss (rarefaction: Hurlbert 1971). The number decreases as a power of the number of points:
//! by a half for each doubling where a smooth density is cut by the rims of boxes, by less where the set is
//! thin there.

use std::num::NonZero;

use crate::geometry::Point;
use crate::parallel::map;
use crate::saturating::{real, whole};

use super::cover::{Grid, Scale};
use super::points::Points;
use super::space::Space;
use super::statistics::{deviation, mean};

/// Maximum part of the boxes that half of the points may miss; beyond it, there are too few points.
const MAX_MISSED: f64 = 0.08;

/// Bounds of the part of the missed boxes that twice the points would still miss.
const LEFT: [f64; 2] = [1.0 / 2.0, 2.0 / 3.0];

/// The contents of boxes of several sizes, on several grids.
#[derive(Clone, Debug)]
pub struct Sample {
    /// Dimension of the space of the points.
    pub(super) dimension: usize,
    /// Sides of the boxes, from the largest on.
    sizes: Vec<f64>,
    /// Contents by grid and size.
    tallies: Vec<Vec<Tally>>,
}

/// The boxes of one size on one grid.
#[derive(Clone, Debug)]
struct Tally {
    /// Numbers of distinct places in a box, with the number of boxes for each.
    places: Vec<(u32, u32)>,
    /// Numbers of points in a box, with the number of boxes for each.
    points: Vec<(u32, u32)>,
}

/// A box that holds points.
#[derive(Clone, Copy)]
struct Held {
    /// Coordinates of the box, the first in the lowest bits.
    key: u64,
    places: u32,
    points: u32,
}

impl<M: Space> Points<M> {
    /// Returns the contents of boxes whose sides are the extent divided by powers of a base.
    ///
    /// # Panics
    ///
    /// Panics if the base is 1.
    #[must_use]
    pub fn sample(
        &self,
        base: NonZero<usize>,
        grids: &[Grid<M>],
        threads: NonZero<usize>,
    ) -> Sample {
        assert!(base.get() > 1, "boxes get smaller");
        let (_, turned) = self.own(&Grid::ALONG);
        let extent = turned.size().max_element() * (1.0 + 4e-9);
        let base = u32::try_from(base.get()).unwrap_or(u32::MAX);
        let powers = (1..).map(|level| libm::pow(f64::from(base), f64::from(level)));
        let finest = libm::exp2(f64::from(self.levels()));
        let sizes: Vec<f64> = powers
            .take_while(|power| *power <= finest)
            .map(|power| extent / power)
            .collect();
        let tallies = map(grids, threads.get(), |_, grid| match sizes.last() {
            Some(&finest) => self.tallies(grid, finest, sizes[0], base, sizes.len()),
            None => Vec::new(),
        });
        let sizes = sizes.into_iter().map(|size| size * self.extent());
        Sample {
            dimension: M::Point::DIMENSION,
            sizes: sizes.collect(),
            tallies,
        }
    }

    /// Returns the contents of boxes of `sizes` sizes on one grid, from the largest on. The smallest has a
    /// side of `size`, in units of the extent.
    fn tallies(
        &self,
        grid: &Grid<M>,
        size: f64,
        largest: f64,
        base: u32,
        sizes: usize,
    ) -> Vec<Tally> {
        let (own, turned) = self.own(grid);
        let (map, _) = own.map(&turned, size, largest);
        let mut boxes: Vec<Held> = Vec::new();
        for (at, points) in self.places() {
            let at = map.apply(at).coordinates();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "points lie on the grid, and casts from floats saturate"
            )]
            let key = packed(M::Point::DIMENSION, at.map(|at| u64::from(at as u32)));
            let held = Held {
                key,
                places: 1,
                points,
            };
            join(&mut boxes, held);
        }
        let mut tallies = Vec::new();
        for level in 0..sizes {
            if level > 0 {
                boxes
                    .iter_mut()
                    .for_each(|held| held.key = coarser(M::Point::DIMENSION, held.key, base));
            }
            boxes.sort_unstable_by_key(|held| held.key);
            let finer = std::mem::take(&mut boxes);
            finer.into_iter().for_each(|held| join(&mut boxes, held));
            tallies.push(Tally::of(&boxes));
        }
        tallies.reverse();
        tallies
    }
}

/// Appends a box to others, or adds its contents to the last of them if that has the same key.
fn join(boxes: &mut Vec<Held>, held: Held) {
    match boxes.last_mut() {
        Some(last) if last.key == held.key => {
            last.places += held.places;
            last.points = last.points.saturating_add(held.points);
        }
        _ => boxes.push(held),
    }
}

/// Returns the key of the box `base` times as large that holds a box.
fn coarser(dimension: usize, key: u64, base: u32) -> u64 {
    let base = u64::from(base);
    let width = 64 / dimension;
    let mask = (1 << width) - 1;
    let at = [0, 1, 2].map(|axis| match axis < dimension {
        true => (key >> (axis * width) & mask) / base,
        false => 0,
    });
    packed(dimension, at)
}

/// Returns the key of a box: its coordinates, of 32 bits each in the plane and of 21 bits in space.
fn packed(dimension: usize, [x, y, z]: [u64; 3]) -> u64 {
    match dimension {
        2 => x | y << 32,
        _ => x | y << 21 | z << 42,
    }
}

impl Tally {
    fn of(boxes: &[Held]) -> Self {
        Self {
            places: histogram(boxes.iter().map(|held| held.places)),
            points: histogram(boxes.iter().map(|held| held.points)),
        }
    }

    /// Returns the expected number of boxes that a random part of the places meets.
    fn met_by(&self, part: f64) -> f64 {
        let met = |places| 1.0 - libm::pow(1.0 - part, f64::from(places));
        let boxes = self.places.iter();
        boxes
            .map(|&(places, boxes)| f64::from(boxes) * met(places))
            .sum()
    }
}

/// Returns the distinct numbers in increasing order, with the frequency of each.
pub(super) fn histogram(numbers: impl Iterator<Item = u32>) -> Vec<(u32, u32)> {
    let mut numbers: Vec<u32> = numbers.collect();
    numbers.sort_unstable();
    let runs = numbers.chunk_by(|a, b| a == b);
    let counted = runs.map(|run| (run[0], u32::try_from(run.len()).unwrap_or(u32::MAX)));
    counted.collect()
}

/// Numbers of boxes of one size that are met, by grid.
struct Met {
    seen: Vec<f64>,
    /// Estimated numbers that include the boxes that the points miss.
    all: Vec<f64>,
    /// Part of the boxes that half of the points would miss.
    missed_by_half: f64,
    /// Variance of the logarithm of a number between samples, if every box that half of the points would miss
    /// is present by chance.
    chance: f64,
}

impl Met {
    /// Returns the smallest cover, and its growth since the previous size.
    fn scale(&self, size: f64, before: Option<&Self>) -> Scale {
        let (growth, growth_error) = before.map(|it| self.growth(it)).unwrap_or_default();
        let least = self.seen.iter().copied().fold(f64::INFINITY, f64::min);
        Scale {
            size,
            count: whole(least) as u64,
            scatter: deviation(self.seen.iter().map(|&it| libm::log(it))),
            growth,
            growth_error,
            sampled: false,
        }
    }

    /// Returns the growth of the logarithm in the mean over all grids, and its standard error.
    fn growth(&self, before: &Self) -> (f64, f64) {
        let by = |this: &[f64], last: &[f64]| -> Vec<f64> {
            let both = this.iter().zip(last);
            both.map(|(a, b)| libm::log(a / b)).collect()
        };
        let growth = by(&self.all, &before.all);
        let of_grids = deviation(growth.iter().copied()) / real(growth.len()).sqrt();
        // Half of the correction for missed boxes counts as an error.
        let of_missed = (mean(&growth) - mean(&by(&self.seen, &before.seen))) / 2.0;
        let of_chance = (self.chance + before.chance).sqrt();
        let error = libm::hypot(libm::hypot(of_grids, of_missed), of_chance);
        (mean(&growth), error)
    }
}

impl Sample {
    /// Returns the sides of the boxes, from the largest on.
    pub(super) fn sizes(&self) -> &[f64] {
        &self.sizes
    }

    /// Returns the number of sizes, from the largest on, for which there are enough points.
    pub(super) fn enough(&self) -> usize {
        let missed = |number: &usize| self.met(*number).missed_by_half;
        let all = 0..self.sizes.len();
        all.take_while(|number| missed(number) <= MAX_MISSED)
            .count()
    }

    fn met(&self, number: usize) -> Met {
        let by = |part: f64| -> Vec<f64> {
            let tallies = self.tallies.iter();
            tallies
                .map(|tallies| tallies[number].met_by(part))
                .collect()
        };
        let (seen, half, quarter) = (by(1.0), by(0.5), by(0.25));
        let sum = |of: &[f64]| of.iter().sum::<f64>();
        let [first, second] = [sum(&half) - sum(&quarter), sum(&seen) - sum(&half)];
        let left = if first > 0.0 { second / first } else { 0.0 }.clamp(LEFT[0], LEFT[1]);
        let all = seen.iter().zip(&half);
        let all = all.map(|(seen, half)| seen + (seen - half) * left / (1.0 - left));
        Met {
            all: all.collect(),
            missed_by_half: second / sum(&seen),
            chance: second * real(seen.len()) / (sum(&seen) * sum(&seen)),
            seen,
        }
    }

    /// Returns the smallest covers, and the growth of the counts in the mean over all grids, with a
    /// correction for missed boxes.
    #[must_use]
    pub fn scales(&self) -> Vec<Scale> {
        let met: Vec<Met> = (0..self.sizes.len())
            .map(|number| self.met(number))
            .collect();
        let before = std::iter::once(None).chain(met.iter().map(Some));
        let sizes = self.sizes.iter().zip(&met).zip(before);
        sizes
            .map(|((&size, met), before)| met.scale(size, before))
            .collect()
    }

    /// Estimates the Rényi entropies of the points' distribution over boxes of a size, by grid.
    ///
    /// Sums of powers are estimated without bias by falling factorials (Grassberger 1988).
    pub(super) fn entropies(&self, number: usize, order: f64) -> Vec<f64> {
        let entropy = |tallies: &Vec<Tally>| entropy(&tallies[number].points, order);
        self.tallies.iter().map(entropy).collect()
    }
}

/// Estimates the Rényi entropy from numbers of points in a box and the number of boxes for each, in nats.
fn entropy(boxes: &[(u32, u32)], order: f64) -> f64 {
    let boxes = || {
        boxes
            .iter()
            .map(|&(points, boxes)| (f64::from(points), f64::from(boxes)))
    };
    let total: f64 = boxes().map(|(points, boxes)| points * boxes).sum();
    if (order - 1.0).abs() < 1e-9 {
        let mean = boxes().map(|(points, boxes)| boxes * points * digamma(points));
        return digamma(total) - mean.sum::<f64>() / total;
    }
    let all = falling(total, order);
    let parts = boxes().map(|(points, boxes)| boxes * libm::exp(falling(points, order) - all));
    libm::log(parts.sum::<f64>()) / (1.0 - order)
}

/// Returns the logarithm of n (n − 1) … (n − q + 1), or of Γ(n + 1) / Γ(n + 1 − q) where q is not an integer.
fn falling(number: f64, order: f64) -> f64 {
    if number + 1.0 - order <= 0.0 {
        return f64::NEG_INFINITY;
    }
    libm::lgamma(number + 1.0) - libm::lgamma(number + 1.0 - order)
}

/// Returns the derivative of ln Γ (Abramowitz & Stegun 6.3.5 and 6.3.18), to about 12 digits.
fn digamma(mut at: f64) -> f64 {
    let mut before = 0.0;
    while at < 12.0 {
        before -= 1.0 / at;
        at += 1.0;
    }
    let square = 1.0 / (at * at);
    let series =
        square * (1.0 / 12.0 - square * (1.0 / 120.0 - square * (1.0 / 252.0 - square / 240.0)));
    before + libm::log(at) - 0.5 / at - series
}
