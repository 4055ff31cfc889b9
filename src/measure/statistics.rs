//! Means, deviations and readings of repeated counts, and the logarithms that are fitted.

use crate::saturating::real;

use super::regression::Reading;

/// Returns the mean of values.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / real(values.len())
}

/// Returns the means of several values with weights.
pub(super) fn weighted_means<const N: usize>(
    values: impl Iterator<Item = ([f64; N], f64)>,
) -> [f64; N] {
    let (mut sums, mut all) = ([0.0; N], 0.0);
    for (values, weight) in values {
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += weight * value;
        }
        all += weight;
    }
    sums.map(|sum| sum / all)
}

/// Returns the standard deviation of values; 0 for fewer than two.
pub(super) fn deviation(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    if values.len() < 2 {
        return 0.0;
    }
    let mean = mean(&values);
    let squares = values.iter().map(|value| (value - mean) * (value - mean));
    (squares.sum::<f64>() / real(values.len() - 1)).sqrt()
}

/// Returns the natural logarithm of a count; 0 for none.
#[expect(clippy::cast_precision_loss, reason = "a logarithm is rounded")]
pub(super) fn logarithm(count: u64) -> f64 {
    libm::log(count.max(1) as f64)
}

/// Returns the readings of logarithms that were found several times for each size, from the largest size on;
/// sizes at which one of them is not finite are left out.
///
/// `kept` returns the logarithm and its growth since the preceding size, from the logarithms at both sizes.
pub(super) fn readings(
    logs: impl Iterator<Item = (f64, Vec<f64>)>,
    kept: impl Fn(&[f64], &[f64]) -> [f64; 2],
) -> Vec<Reading> {
    let all = logs.filter(|(_, logs)| logs.iter().all(|log| log.is_finite()));
    let all: Vec<(f64, Vec<f64>)> = all.collect();
    let reading = |(number, (size, logs)): (usize, &(f64, Vec<f64>))| {
        let last = &all[number.saturating_sub(1)].1;
        let [log, growth] = kept(logs, last);
        Reading {
            size: *size,
            log,
            scatter: deviation(logs.iter().copied()),
            growth,
            growth_error: deviation(differences(logs, last)) / real(logs.len()).sqrt(),
        }
    };
    all.iter().enumerate().map(reading).collect()
}

/// Iterates over the differences between values and those before.
pub(super) fn differences(values: &[f64], before: &[f64]) -> impl Iterator<Item = f64> {
    values
        .iter()
        .zip(before)
        .map(|(value, before)| value - before)
}
