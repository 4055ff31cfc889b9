//! Dimensions as means over models, for counts over many decades.
//!
//! Counts are a power of the size only in the limit. Besides the straight line, all lines with a second power
//! are fitted, N = A size^-D (1 + C size^θ), from every size on. Where two exponents are close together, or
//! powers are multiplied by a logarithm, slopes drift over many decades, and no second power dies out over
//! the sizes. All lines with a power of the logarithm are therefore fitted as well, N = A size^-D ln(1 /
//! size)^c, whose local slopes are D + c / ln(1 / size). For each model, D is fitted to the growth of counts
//! from size to size. The weight of a model is its likelihood, times 1/e for every size that it leaves out,
//! and times a penalty for additional parameters (Akaike 1974; averages over models and ranges: Jay & Neil
//! 2021). D is the weighted mean, and its error includes the spread of the models: where local slopes drift,
//! the mean lies beyond the last of them, and its error is large.

use crate::saturating::{real, whole};

use super::regression::{Estimate, Reading, line};
use super::statistics::weighted_means;

/// Range of the exponents θ of a second power, and of the coefficients C at the largest size: those above
/// zero, and the magnitudes of those below.
const EXPONENTS: [f64; 2] = [0.1, 1.6];
const EXPONENT_STEPS: i32 = 24;
const MAX_PART: [f64; 2] = [0.1, 50.0];
const MIN_PART: [f64; 2] = [0.1, 0.8];
const PARTS_ABOVE: i32 = 32;
const PARTS_BELOW: i32 = 8;

/// Range of the magnitudes of the exponents c of a logarithm, and the logarithm of the ratio of the extent to
/// the largest size.
const POWERS: [f64; 2] = [0.2, 1.5];
const POWER_STEPS: i32 = 16;
const LARGEST: f64 = 2.0;

/// Penalties of a second power, and of a logarithm, to the logarithm of a model's prior.
const POWER_COSTS: f64 = 4.0;
const LOGARITHM_COSTS: f64 = 1.5;

/// Lower bound of the error of a growth.
const MIN_ERROR: f64 = 0.001;

/// Fraction of the mean growth below which counts do not grow.
const GAP: f64 = 0.25;

/// Minimum number of sizes in every range.
const MIN_SIZES: usize = 4;

/// Growth of counts from a size to the next smaller one.
struct Growth {
    /// Logarithm of the ratio of the sizes.
    step: f64,
    /// Logarithm of the ratio of the counts.
    log: f64,
    weight: f64,
}

/// Correction by a second power or a logarithm: its addition to the growth from each size to the next, and
/// the logarithm of the model's prior.
struct Correction {
    growth: Vec<f64>,
    prior: f64,
}

/// A line, with or without a correction, fitted from a size on.
#[derive(Clone, Copy)]
struct Fit {
    from: usize,
    slope: f64,
    variance: f64,
    chi_squared: f64,
    prior: f64,
}

/// Estimates the slope of readings, from the largest size to the smallest, as a mean over models whose slopes
/// are at most `most`. Returns `None` if there are fewer than five readings.
pub(super) fn averaged(readings: &[Reading], most: f64) -> Option<Estimate> {
    if readings.len() < MIN_SIZES + 1 {
        return None;
    }
    let growths = growths(readings);
    let corrections = corrections(readings);
    let last = growths.len() + 1 - MIN_SIZES;
    let starts = (0..=last).flat_map(|from| {
        let fit = |correction: &Correction| Fit::of(&growths, correction, from, most);
        corrections.iter().map(fit).collect::<Vec<_>>()
    });
    let fits: Vec<Fit> = starts.collect();
    // Where no model fits as well as the errors imply, errors are too small.
    let reduced = fits.iter().filter(|fit| fit.from < last);
    let reduced = reduced.map(|fit| fit.chi_squared / real(growths.len() - fit.from - 1));
    let excess = reduced.fold(f64::INFINITY, f64::min);
    let excess = if excess.is_finite() {
        excess.max(1.0)
    } else {
        1.0
    };
    let weight = |fit: &Fit| fit.prior - real(fit.from) - fit.chi_squared / (2.0 * excess);
    let best = fits.iter().map(weight).fold(f64::NEG_INFINITY, f64::max);
    let mean = |of: &dyn Fn(&Fit) -> f64| {
        let fits = fits.iter();
        let [mean] = weighted_means(fits.map(|fit| ([of(fit)], libm::exp(weight(fit) - best))));
        mean
    };
    let value = mean(&|fit| fit.slope);
    let away = |fit: &Fit| fit.variance * excess + (fit.slope - value) * (fit.slope - value);
    let from = mean(&|fit| real(fit.from)).round();
    let range = &readings[whole(from)..];
    let (r_squared, intercept) = line(range, value);
    Some(Estimate {
        value: value + 0.0,
        std_error: mean(&away).sqrt(),
        range: [range[range.len() - 1].size, range[0].size],
        r_squared,
        intercept,
        sizes: range.len(),
    })
}

/// Returns the growths between sizes, weighted by their variances. In a set with strong gaps, counts do not grow at some sizes,
/// wherever the grid lies, and grow unevenly at the others. A size without growth has the larger of the variances of the
/// nearest sizes with growth: by its own, it would outweigh them.
fn growths(readings: &[Reading]) -> Vec<Growth> {
    let step = |pair: &[Reading]| libm::log(pair[0].size / pair[1].size);
    let pairs = || readings.windows(2);
    let mean = pairs().map(|pair| pair[1].growth).sum::<f64>() / pairs().map(step).sum::<f64>();
    let grows = |pair: &[Reading]| pair[1].growth >= GAP * mean * step(pair);
    let variance =
        |pair: &[Reading]| pair[1].growth_error * pair[1].growth_error + MIN_ERROR * MIN_ERROR;
    let of = |nearest: Option<&[Reading]>| nearest.map_or(0.0, variance);
    let growth = |(at, pair): (usize, &[Reading])| {
        let before = of(readings[..at + 2].windows(2).rfind(|pair| grows(pair)));
        let after = of(readings[at..].windows(2).find(|pair| grows(pair)));
        Growth {
            step: step(pair),
            log: pair[1].growth,
            weight: 1.0 / variance(pair).max(before).max(after),
        }
    };
    pairs().enumerate().map(growth).collect()
}

impl Fit {
    fn of(growths: &[Growth], correction: &Correction, from: usize, most: f64) -> Self {
        let growths = growths[from..].iter().zip(&correction.growth[from..]);
        let (mut norm, mut sum) = (0.0, 0.0);
        for (growth, more) in growths.clone() {
            norm += growth.weight * growth.step * growth.step;
            sum += growth.weight * growth.step * (growth.log - more);
        }
        let slope = (sum / norm).min(most);
        let squares = growths.map(|(growth, more)| {
            let rest = growth.log - more - slope * growth.step;
            growth.weight * rest * rest
        });
        Self {
            from,
            slope,
            variance: 1.0 / norm,
            chi_squared: squares.sum(),
            prior: correction.prior,
        }
    }
}

/// Returns all corrections: none, second powers of all exponents and coefficients, and logarithms to all
/// powers.
fn corrections(readings: &[Reading]) -> Vec<Correction> {
    let parts =
        spread(MAX_PART, PARTS_ABOVE).chain(spread(MIN_PART, PARTS_BELOW).map(|part| -part));
    let parts: Vec<f64> = parts.collect();
    let models = real(parts.len()) * f64::from(EXPONENT_STEPS);
    let correction = |log: &dyn Fn(f64) -> f64, prior: f64| {
        let at = |reading: &Reading| log(reading.size / readings[0].size);
        let pairs = readings.windows(2);
        Correction {
            growth: pairs.map(|pair| at(&pair[1]) - at(&pair[0])).collect(),
            prior,
        }
    };
    let mut corrections = vec![Correction {
        growth: vec![0.0; readings.len() - 1],
        prior: 0.0,
    }];
    for exponent in spread(EXPONENTS, EXPONENT_STEPS) {
        let of = |part: f64| {
            let log = |size: f64| libm::log1p(part * libm::pow(size, exponent));
            correction(&log, -POWER_COSTS - libm::log(models))
        };
        corrections.extend(parts.iter().copied().map(of));
    }
    let models = 2.0 * f64::from(POWER_STEPS);
    for power in spread(POWERS, POWER_STEPS).flat_map(|power| [power, -power]) {
        let log = |size: f64| power * libm::log(LARGEST - libm::log(size));
        corrections.push(correction(&log, -LOGARITHM_COSTS - libm::log(models)));
    }
    corrections
}

/// Iterates over `steps` numbers from `least` to `most` in geometric progression.
fn spread([least, most]: [f64; 2], steps: i32) -> impl Iterator<Item = f64> {
    let all = libm::log(most / least);
    let part = move |step| f64::from(step) / f64::from(steps - 1);
    (0..steps).map(move |step| least * libm::exp(all * part(step)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readings(sizes: i32, error: f64, log: impl Fn(f64) -> f64) -> Vec<Reading> {
        let reading = |level: i32| {
            let x = f64::from(level) * std::f64::consts::LN_2;
            Reading {
                size: libm::exp(-x),
                log: log(x),
                scatter: 0.0,
                growth: log(x) - log(x - std::f64::consts::LN_2),
                growth_error: error,
            }
        };
        (1..=sizes).map(reading).collect()
    }

    #[test]
    fn a_power_has_its_exponent() {
        for exponent in [0.5, 1.2618595, 1.9] {
            let estimate = averaged(&readings(20, 0.0, |x| 0.7 + exponent * x), 2.0).unwrap();
            assert!((estimate.value - exponent).abs() < 1e-3, "{estimate:?}");
            assert!(estimate.std_error < 0.003, "{estimate:?}");
            assert!(estimate.r_squared > 1.0 - 1e-9, "{estimate:?}");
        }
    }

    #[test]
    fn a_second_power_is_seen_and_told_apart() {
        // Boxes of an area, and those of its rim.
        let bent = readings(25, 0.002, |x| {
            libm::log(libm::exp(1.9 * x) + 2.0 * libm::exp(1.4 * x))
        });
        let estimate = averaged(&bent, 2.0).unwrap();
        assert!((estimate.value - 1.9).abs() < 0.005, "{estimate:?}");
        let off = (estimate.value - 1.9).abs();
        assert!(off < 2.0 * estimate.std_error, "{estimate:?}");
    }

    #[test]
    fn slopes_that_go_on_drifting_are_followed() {
        // A power multiplied by a logarithm, and two exponents that are close together (a Lévy curve).
        let logarithm = |x: f64| 1.1 * x + 0.5 * libm::log(x + 1.0);
        let close = |x: f64| libm::log(libm::exp(1.95 * x) - 0.7 * libm::exp(1.88 * x));
        let cases: [(f64, &dyn Fn(f64) -> f64); 2] = [(1.1, &logarithm), (1.95, &close)];
        for (exponent, log) in cases {
            let readings = readings(28, 0.002, log);
            let estimate = averaged(&readings, 2.0).unwrap();
            let off = (estimate.value - exponent).abs();
            assert!(off < 2.0 * estimate.std_error, "{estimate:?}");
            let last = readings[27].growth / std::f64::consts::LN_2;
            assert!(off < (last - exponent).abs(), "{estimate:?} {last}");
        }
    }

    #[test]
    fn counts_that_are_known_less_well_have_a_larger_error() {
        let error = |error| {
            averaged(&readings(20, error, |x| 1.3 * x), 2.0)
                .unwrap()
                .std_error
        };
        assert!(error(0.05) > 5.0 * error(0.005));
    }

    #[test]
    fn waves_that_no_model_has_make_the_error_larger() {
        let waves = |height: f64| {
            let log = |x: f64| 1.3 * x + height * libm::sin(4.0 * x);
            averaged(&readings(20, 0.002, log), 2.0).unwrap()
        };
        let estimate = waves(0.05);
        assert!(
            estimate.std_error > 3.0 * waves(0.0).std_error,
            "{estimate:?}"
        );
        assert!(
            (estimate.value - 1.3).abs() < 2.0 * estimate.std_error,
            "{estimate:?}"
        );
    }

    #[test]
    fn sizes_without_growth_do_not_outweigh_the_others() {
        // Two copies by a ratio between 1/4 and 1/1024: counts grow at the sizes of the copies, on some grids earlier.
        for period in [2, 3, 4, 6, 10] {
            let mut readings = readings(40, 0.0, |_| 0.0);
            let mut log = 0.0;
            for (level, reading) in readings.iter_mut().enumerate() {
                let grows = level % period == 0;
                reading.growth = if grows { std::f64::consts::LN_2 } else { 0.0 };
                reading.growth_error = if grows { 0.1 } else { 0.0 };
                log += reading.growth;
                reading.log = log;
            }
            let estimate = averaged(&readings, 2.0).unwrap();
            let off = (estimate.value - 1.0 / period as f64).abs();
            assert!(off < 2.0 * estimate.std_error, "{period}: {estimate:?}");
            assert!(estimate.std_error < 0.2, "{period}: {estimate:?}");
        }
    }

    #[test]
    fn four_sizes_are_too_few() {
        assert_eq!(averaged(&readings(4, 0.0, |x| x), 2.0), None);
    }
}
