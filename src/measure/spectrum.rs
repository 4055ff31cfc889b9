//! Generalised dimensions D_q: the growth of entropies of a set's mass as boxes get smaller.

use std::num::NonZero;

use super::averaging::averaged;
use super::box_counting::{BoxCounting, Boxes};
use super::cover::Grid;
use super::limit::{Cascade, Moments};
use super::mass::Masses;
use super::raster::distance;
use super::regression::{Estimate, Reading, estimate};
use super::sample::Sample;
use super::space::Space;
use super::statistics::{logarithm, mean, readings};
use crate::bits::Bits;
use crate::geometry::Point;
use crate::parallel::map;
use crate::saturating::real;

/// Generalised dimension D_q of a set (Hentschel & Procaccia 1983), and its evidence.
#[derive(Clone, Debug)]
pub struct Generalised {
    /// Order q: 0 gives the box-counting dimension, 1 the information dimension, 2 the correlation dimension.
    pub order: f64,
    /// The dimension; `None` if there are fewer than three sizes.
    pub estimate: Option<Estimate>,
    /// Sides of boxes, from the largest on, and the entropies for these: ln Σ p^q / (1 − q), or −Σ p ln p for
    /// q = 1, where p are the fractions of the mass in the boxes. For pictures, the smallest entropy of all
    /// grids; for points, the mean. For a measure on a limit set, balls about its points take the place of
    /// boxes: ln (mean of p^(q − 1)) / (1 − q), or the mean of −ln p.
    pub entropies: Vec<(f64, f64)>,
}

/// Side of the smallest boxes, in pixels, whose masses are those of the set; the masses of pixels are all
/// equal.
const COARSER: f64 = 8.0;

impl Generalised {
    /// Returns the result for an order of which nothing is measured.
    #[must_use]
    pub fn unmeasured(order: f64) -> Self {
        Self {
            order,
            estimate: None,
            entropies: Vec::new(),
        }
    }

    /// Returns the dimension of order 0, from box counts.
    #[must_use]
    pub fn of_boxes(counting: &BoxCounting) -> Self {
        let entropy = |it: &Boxes| (it.size, logarithm(it.count));
        Self {
            order: 0.0,
            estimate: counting.estimate,
            entropies: counting.boxes.iter().map(entropy).collect(),
        }
    }

    /// Measures the dimensions of a picture for several orders. All set pixels have the same mass.
    ///
    /// Sizes are used from 8 pixels up to a quarter of the picture's long side. Neither the width of a pen
    /// nor rims are taken into account: the difference between the dimension of order 0 and the dimension
    /// that was `counted`, where both are known, is part of the errors.
    #[must_use]
    pub fn of_pixels(
        pixels: &Bits,
        counted: Option<Estimate>,
        orders: &[f64],
        grids: &[Grid],
        threads: NonZero<usize>,
    ) -> Vec<Self> {
        let largest = pixels.width().max(pixels.height()) / 4;
        let masses = |grid: &Grid| Some(Masses::of_pixels(pixels, distance(grid.shift, largest)));
        let range = [COARSER, real(largest)];
        let orders = [orders, &[0.0]].concat();
        let mut spectrum = of_masses(&orders, grids, threads, range, masses).unwrap_or_default();
        let number = spectrum.pop().and_then(|it| it.estimate);
        let off = number.zip(counted);
        let off = off.map_or(0.0, |(number, counted)| number.value - counted.value);
        let estimates = spectrum.iter_mut().filter_map(|it| it.estimate.as_mut());
        estimates.for_each(|it| it.std_error = libm::hypot(it.std_error, off));
        spectrum
    }

    /// Measures the dimensions of a measure on a limit set for several orders, in balls about its points that
    /// are each smaller by the factor `base` than those before.
    ///
    /// The default base is the smallest power of the set's own period that is at least 1.8, or else 2. Balls
    /// go from about half the extent down to 10⁻⁸ of it, or to where too many copies overlap, in `series`
    /// series of sizes. The results do not [rise](Self::fall) with the order.
    #[must_use]
    pub fn of_measure<M: Space>(
        measure: &Cascade<M>,
        orders: &[f64],
        base: Option<f64>,
        series: NonZero<usize>,
        threads: NonZero<usize>,
    ) -> Vec<Self> {
        let extent = measure.set().bounds().size().max_element();
        if extent <= 0.0 {
            let of = |&order: &f64| Self {
                order,
                estimate: BoxCounting::of_point().estimate,
                entropies: Vec::new(),
            };
            return orders.iter().map(of).collect();
        }
        let base = base.unwrap_or_else(|| base_of(measure.set().period()));
        let moments = Moments::of(measure, orders, base, series, threads);
        let of = |(number, &order): (usize, &f64)| {
            let readings = moments.readings(number);
            let estimate = averaged(&readings, most(M::Point::DIMENSION, order))
                .or_else(|| estimate(&readings))
                .and_then(|it| measure.set().believed(it));
            Self {
                order,
                estimate: estimate.map(|estimate| {
                    with_drift(estimate, &readings, most(M::Point::DIMENSION, order))
                }),
                entropies: readings.iter().map(|it| (it.size, it.log)).collect(),
            }
        };
        let mut spectrum: Vec<Self> = orders.iter().enumerate().map(of).collect();
        Self::fall(&mut spectrum);
        spectrum
    }

    /// Makes dimensions not rise with the order, as those of no measure do (Beck 1990): neighbours that do
    /// are replaced by their mean, weighted by their errors (pool adjacent violators: Ayer et al. 1955). The
    /// displacement of a dimension is part of its error.
    pub fn fall(spectrum: &mut [Self]) {
        let mut order: Vec<usize> = (0..spectrum.len())
            .filter(|&number| spectrum[number].estimate.is_some())
            .collect();
        order.sort_by(|&a, &b| spectrum[a].order.total_cmp(&spectrum[b].order));
        let mut pools: Vec<Pool> = Vec::new();
        for &number in &order {
            let Some(estimate) = &spectrum[number].estimate else {
                continue;
            };
            let error = estimate.std_error.max(MIN_ERROR);
            let mut pool = Pool {
                value: estimate.value,
                weight: 1.0 / (error * error),
                members: vec![number],
            };
            while let Some(last) = pools.pop_if(|last| last.value < pool.value) {
                pool = last.with(pool);
            }
            pools.push(pool);
        }
        for pool in pools.into_iter().filter(|pool| pool.members.len() > 1) {
            for number in pool.members {
                if let Some(estimate) = &mut spectrum[number].estimate {
                    let moved = pool.value - estimate.value;
                    estimate.std_error = libm::hypot(estimate.std_error, moved);
                    estimate.value = pool.value;
                }
            }
        }
    }

    /// Measures the dimensions of points as a sample of a set for several orders.
    ///
    /// Sizes are used that box counting may use, up to a quarter of the extent if they are halved.
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
            fitted(order, entropies, Some(sample.dimension))
        };
        orders.iter().map(of).collect()
    }
}

/// Dimensions of neighbouring orders that are averaged.
struct Pool {
    value: f64,
    weight: f64,
    members: Vec<usize>,
}

/// Minimum error where dimensions are averaged.
const MIN_ERROR: f64 = 1e-9;

impl Pool {
    fn with(mut self, next: Self) -> Self {
        let weight = self.weight + next.weight;
        self.value = (self.value * self.weight + next.value * next.weight) / weight;
        self.weight = weight;
        self.members.extend(next.members);
        self
    }
}

/// Returns the smallest power of a period that is at least 1.8, or 2 if there is no period.
fn base_of(period: Option<f64>) -> f64 {
    const LEAST: f64 = 1.8;
    period.map_or(2.0, |period| {
        let power = (libm::log(LEAST) / libm::log(period)).ceil();
        libm::pow(period, power.max(1.0))
    })
}

/// Returns the mean slope of readings, and its standard error.
fn slope(readings: &[Reading]) -> (f64, f64) {
    let pairs = readings.windows(2);
    let of = |pair: &[Reading]| {
        let step = libm::log(pair[0].size / pair[1].size);
        (pair[1].growth / step, pair[1].growth_error / step)
    };
    let (slopes, errors): (Vec<f64>, Vec<f64>) = pairs.map(of).unzip();
    let squares: Vec<f64> = errors.iter().map(|error| error * error).collect();
    (mean(&slopes), (mean(&squares) / real(slopes.len())).sqrt())
}

/// Extrapolates an estimate where slopes still drift as balls get smaller: to the limit of the mean slopes of
/// the last three quarters of all sizes, if each halves the distance to the limit. The limit lies a third of
/// the whole drift beyond the last mean slope, and half of the drift is part of its error.
///
/// The estimate is unchanged where slopes drift by no more than its error. Where the drift may be chance, or
/// slopes do not drift in one direction, only half of the drift is added to the error.
fn with_drift(estimate: Estimate, readings: &[Reading], most: f64) -> Estimate {
    const SIGNIFICANT: f64 = 3.0;
    let quarter = readings.len().saturating_sub(1) / 4;
    if quarter == 0 {
        return estimate;
    }
    let from = |number: usize| readings.len() - 1 - number * quarter;
    let [(first, coarse), (second, _), (last, fine)] =
        [3, 2, 1].map(|number| slope(&readings[from(number)..=from(number - 1)]));
    let (drift, chance) = (last - first, libm::hypot(coarse, fine));
    if drift.abs() <= estimate.std_error {
        return estimate;
    }
    let goes_on = (second - first) * (last - second) > 0.0;
    if drift.abs() <= SIGNIFICANT * chance || !goes_on {
        return estimate.drifting(drift);
    }
    Estimate {
        value: (last + drift / 3.0).min(most),
        std_error: libm::hypot(chance, drift / 2.0),
        range: [readings[readings.len() - 1].size, readings[from(3)].size],
        sizes: 3 * quarter + 1,
        ..estimate
    }
}

/// Returns the upper bound of the dimension of an order; for negative orders, dimensions may exceed that of
/// the space.
fn most(dimension: usize, order: f64) -> f64 {
    if order < 0.0 {
        f64::INFINITY
    } else {
        real(dimension)
    }
}

/// Relative tolerance within which sizes count as equal.
const SLACK: f64 = 1.0 + 1e-6;

/// Computes the dimensions of masses on several grids, from boxes with sizes in a range.
fn of_masses(
    orders: &[f64],
    grids: &[Grid],
    threads: NonZero<usize>,
    [finest, coarsest]: [f64; 2],
    masses: impl Fn(&Grid) -> Option<Masses> + Sync,
) -> Option<Vec<Generalised>> {
    // Entropies by grid, size and order.
    let entropies = map(grids, threads.get(), |_, grid| {
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
        fitted(order, by_size, None)
    };
    Some(orders.iter().enumerate().map(of).collect())
}

/// Fits the slope of entropies by size and grid, over the sizes at which all are finite.
///
/// For a set that is known, the smallest entropy of all grids is kept, as the smallest cover is; for a
/// sample in a space of the dimension `sampled`, their mean.
fn fitted(
    order: f64,
    entropies: impl Iterator<Item = (f64, Vec<f64>)>,
    sampled: Option<usize>,
) -> Generalised {
    let kept = |by_grid: &[f64]| {
        if sampled.is_some() {
            mean(by_grid)
        } else {
            by_grid.iter().copied().fold(f64::INFINITY, f64::min)
        }
    };
    let readings = readings(entropies, |by_grid, last| {
        [kept(by_grid), kept(by_grid) - kept(last)]
    });
    let averaged = sampled.and_then(|dimension| averaged(&readings, most(dimension, order)));
    Generalised {
        order,
        estimate: averaged.or_else(|| estimate(&readings)),
        entropies: readings.iter().map(|it| (it.size, it.log)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(order: f64, value: f64, std_error: f64) -> Generalised {
        Generalised {
            order,
            estimate: Some(Estimate {
                value,
                std_error,
                range: [0.1, 1.0],
                r_squared: 1.0,
                intercept: 0.0,
                sizes: 5,
            }),
            entropies: Vec::new(),
        }
    }

    #[test]
    fn dimensions_do_not_rise_with_the_order() {
        let mut spectrum = vec![
            of(2.0, 1.3, 0.01),
            of(0.0, 1.0, 0.01),
            of(1.0, 1.2, 0.02),
            of(5.0, 0.9, 0.01),
        ];
        Generalised::fall(&mut spectrum);
        let known: Vec<Estimate> = spectrum.iter().filter_map(|it| it.estimate).collect();
        // The errors give 1 and 1.3 four times the weight of 1.2.
        let mean = (4.0 * 1.0 + 1.2 + 4.0 * 1.3) / 9.0;
        for estimate in &known[..3] {
            assert!((estimate.value - mean).abs() < 1e-12, "{estimate:?}");
        }
        assert!(known[0].std_error > 0.1 && known[1].std_error > 0.1);
        assert_eq!(known[3].value, 0.9);
        assert_eq!(known[3].std_error, 0.01);
    }

    #[test]
    fn slopes_that_drift_tell_a_larger_error() {
        // 2 − ε^0.1 / 4 approaches 2 slowly.
        let slope = |level: i32| 2.0 - 0.25 * libm::exp2(-0.1 * f64::from(level));
        let mut log = 0.0;
        let readings = (0..25).map(|level| {
            let growth = slope(level) * std::f64::consts::LN_2;
            log += growth;
            Reading {
                size: libm::exp2(-f64::from(level)),
                log,
                scatter: 0.0,
                growth,
                growth_error: 0.001,
            }
        });
        let readings: Vec<Reading> = readings.collect();
        let plain = of(1.0, 1.9, 0.002).estimate.unwrap();
        let known = with_drift(plain, &readings, 2.0);
        assert!((known.value - 2.0).abs() < 0.04, "{known:?}");
        assert!(
            (known.value - 2.0).abs() < 2.0 * known.std_error,
            "{known:?}"
        );
    }
}
