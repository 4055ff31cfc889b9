//! The drift of local slopes. A dimension is a limit, which local slopes that drift have not reached.

use super::regression::{Points, Reading};

/// Change of the local slopes of a logarithm as boxes get smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trend {
    /// Rise of the slopes from boxes to boxes ten times smaller.
    pub per_decade: f64,
    /// Standard error of the rise.
    pub std_error: f64,
}

/// Minimum number of local slopes for a trend.
const MIN_SLOPES: usize = 4;

/// Number of standard errors from 0 beyond which a trend is significant.
const SIGNIFICANT: f64 = 4.0;

/// Lower bound of the standard error of a growth between sizes, in nats.
const MIN_ERROR: f64 = 0.001;

impl Trend {
    /// Fits a trend to readings, from the largest size to the smallest. Returns `None` if there are too few.
    pub(super) fn of(readings: &[Reading]) -> Option<Self> {
        let slope = |pair: &[Reading]| {
            let [coarse, fine] = [pair[0], pair[1]];
            let step = libm::log(coarse.size / fine.size);
            let error = fine.growth_error.max(MIN_ERROR) / step;
            let middle = -libm::log(coarse.size * fine.size) / 2.0;
            (middle, fine.growth / step, 1.0 / (error * error))
        };
        if readings.len() <= MIN_SLOPES {
            return None;
        }
        let fit = Points::new(readings.windows(2).map(slope)).fit(None);
        Some(Self {
            per_decade: fit.slope * std::f64::consts::LN_10,
            std_error: fit.error * std::f64::consts::LN_10,
        })
    }

    /// Returns the drift of the slopes over the range of the readings.
    pub(super) fn over(&self, readings: &[Reading]) -> f64 {
        let ends = readings.first().zip(readings.last());
        let decades = ends.map(|(coarse, fine)| libm::log10(coarse.size / fine.size));
        self.per_decade * decades.unwrap_or_default()
    }

    /// Returns `true` if slopes drift by more than four standard errors.
    #[must_use]
    pub fn is_significant(&self) -> bool {
        self.per_decade.abs() > SIGNIFICANT * self.std_error
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trend(slope: impl Fn(f64) -> f64, error: f64) -> Trend {
        let reading = |level: i32| {
            let x = f64::from(level);
            Reading {
                size: libm::exp(-x),
                log: 0.0,
                scatter: 0.0,
                growth: slope(x - 0.5),
                growth_error: error,
            }
        };
        Trend::of(&(0..12).map(reading).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn a_drift_is_seen_and_chance_is_not() {
        let chance = |x: f64| 0.02 * libm::sin(7.0 * x * x);
        let drifting = trend(|x| 1.8 + 0.02 * x + chance(x) / 10.0, 0.005);
        assert!(drifting.is_significant(), "{drifting:?}");
        let rise = 0.02 * std::f64::consts::LN_10;
        assert!((drifting.per_decade - rise).abs() < 0.01, "{drifting:?}");
        let level = trend(|x| 1.8 + chance(x), 0.02);
        assert!(!level.is_significant(), "{level:?}");
    }
}
