//! Dimensions as slopes over few decades, with an error that accounts for systematic deviations.
//!
//! Counts of boxes are a power of the size only in the limit: rims, gaps and coarse boxes bend the line, and
//! the residuals of neighbouring sizes are correlated. The slope is therefore estimated in two ways. One is
//! the slope of the finer half of the sizes. The other is that of all sizes with a correction to scaling, y =
//! a + D x + c exp(−θ x) with x = ln (1 / size), where θ is the best fit (as for critical exponents: Wegner
//! 1972). A correction is accepted if c is more than three standard errors above 0, as where boxes of a rim
//! add to those of the set. (Where slopes fall as boxes get smaller, small boxes have more likely lost thin
//! parts of a picture.) The first slope lags behind a bend and the second overshoots it: the estimate is
//! their mean. Without a significant bend, the estimate is the first slope, and the second is that of all
//! sizes without a correction. The difference between the second slope and the estimate is part of the error.

use crate::saturating::real;

/// Measurement at one size of boxes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reading {
    pub(super) size: f64,
    /// Logarithm of the measured quantity.
    pub(super) log: f64,
    /// Standard deviation of the logarithm over grids.
    pub(super) scatter: f64,
    /// Growth of the logarithm since the previous size.
    pub(super) growth: f64,
    /// Standard error of the growth.
    pub(super) growth_error: f64,
}

/// Dimension as the slope of a weighted regression of a logarithm on ln (1 / size).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The dimension: the mean over models and ranges, weighted by likelihood. For pictures that the boxes of
    /// a base fit, the mean of local slopes. For few sizes, the slope of the finer half of them, or its mean
    /// with the slope of all of them with a correction to scaling, where that is significant.
    pub value: f64,
    /// Standard error of the dimension: that of the regression, increased for correlated residuals of
    /// neighbouring sizes, and the difference to other estimates of the slope.
    pub std_error: f64,
    /// Smallest and largest size that were used, in the units of the set; means where there are several
    /// ranges.
    pub range: [f64; 2],
    /// Fraction of the variance that a straight line through all sizes explains, from 0 to 1.
    pub r_squared: f64,
    /// Logarithm at size 1, on the line with this slope through the mean of the sizes that determine it.
    pub intercept: f64,
    /// Number of sizes that were used; 0 if nothing had to be measured.
    pub sizes: usize,
}

impl Estimate {
    /// Returns the number of decades that the range spans.
    #[must_use]
    pub fn decades(&self) -> f64 {
        libm::log10(self.range[1] / self.range[0])
    }
}

impl Estimate {
    /// Returns the estimate with an error increased by half of the drift of local slopes over the finer half
    /// of the decades. The drift beyond the smallest size is not known: slopes that drift as 1 / ln (1 /
    /// size) have as much drift left.
    pub(super) fn drifting(self, drift: f64) -> Self {
        Self {
            std_error: libm::hypot(self.std_error, drift / 2.0),
            ..self
        }
    }
}

/// Lower bound of the scatter: grids are few, and none of them is optimal.
const MIN_SCATTER: f64 = 0.01;

/// Lower bound of the factor by which the variance is reduced where a line fits better than the scatter
/// implies.
const MIN_FACTOR: f64 = 0.05;

/// Minimum number of sizes for a correction to scaling.
const MIN_SIZES: usize = 5;

/// Number of standard errors above 0 beyond which a coefficient is significant.
const SIGNIFICANT: f64 = 3.0;

/// Estimates the slope of readings, from the largest size to the smallest. Returns `None` if there are fewer
/// than three.
pub(super) fn estimate(readings: &[Reading]) -> Option<Estimate> {
    if readings.len() < 3 {
        return None;
    }
    let points = Points::of(readings);
    let all = points.fit(None);
    let half = readings.len().div_ceil(2).max(3);
    let fine_points = Points::of(&readings[readings.len() - half..]);
    let fine = fine_points.fit(None);
    let (value, error, other) = match points.corrected() {
        Some(corrected) => {
            let value = f64::midpoint(fine.slope, corrected.slope);
            (value, corrected.error, corrected.slope)
        }
        None => (fine.slope, fine.error, all.slope),
    };
    let (x, y) = fine_points.middle();
    Some(Estimate {
        value: value + 0.0,
        std_error: libm::hypot(error, other - value),
        range: [readings[readings.len() - 1].size, readings[0].size],
        r_squared: points.r_squared(&all),
        intercept: y - value * x,
        sizes: readings.len(),
    })
}

/// Returns the fraction of the variance that a straight line through readings explains, and the logarithm at
/// size 1 on the line with slope `slope` through their mean.
pub(super) fn line(readings: &[Reading], slope: f64) -> (f64, f64) {
    let points = Points::of(readings);
    let (x, y) = points.middle();
    (points.r_squared(&points.fit(None)), y - slope * x)
}

/// Readings as columns: abscissas, ordinates and weights.
pub(super) struct Points {
    x: Vec<f64>,
    y: Vec<f64>,
    weights: Vec<f64>,
}

/// Result of a regression.
pub(super) struct Fit {
    pub(super) slope: f64,
    pub(super) error: f64,
    /// Weighted sum of the squares of the residuals.
    residual: f64,
    /// Coefficient of the correction in standard errors.
    significance: f64,
}

impl Points {
    /// Creates columns from rows of an abscissa, an ordinate and a weight.
    pub(super) fn new(rows: impl Iterator<Item = (f64, f64, f64)>) -> Self {
        let rows: Vec<_> = rows.collect();
        Self {
            x: rows.iter().map(|row| row.0).collect(),
            y: rows.iter().map(|row| row.1).collect(),
            weights: rows.iter().map(|row| row.2).collect(),
        }
    }

    fn of(readings: &[Reading]) -> Self {
        let weight = |it: &Reading| 1.0 / (it.scatter * it.scatter + MIN_SCATTER * MIN_SCATTER);
        Self {
            x: readings.iter().map(|it| -libm::log(it.size)).collect(),
            y: readings.iter().map(|it| it.log).collect(),
            weights: readings.iter().map(weight).collect(),
        }
    }

    /// Returns the best of all lines with a correction, if its coefficient is significant.
    fn corrected(&self) -> Option<Fit> {
        if self.x.len() < MIN_SIZES {
            return None;
        }
        let exponents = (4..=30).map(|number| 0.05 * f64::from(number));
        let fits = exponents.map(|exponent| self.fit(Some(exponent)));
        let best = fits.min_by(|a, b| a.residual.total_cmp(&b.residual))?;
        (best.significance > SIGNIFICANT).then_some(best)
    }

    /// Fits a line, or a line with a correction of an exponent, by weighted least squares.
    ///
    /// A coefficient is the regression of y on the residual of its column, once all other columns are
    /// projected out (Frisch & Waugh 1933).
    pub(super) fn fit(&self, exponent: Option<f64>) -> Fit {
        let first = self.x[0];
        let ones = vec![1.0; self.x.len()];
        let x: Vec<f64> = self.x.iter().map(|x| x - first).collect();
        let bend: Option<Vec<f64>> =
            exponent.map(|exponent| x.iter().map(|x| libm::exp(-exponent * x)).collect());
        let others: Vec<&[f64]> = [Some(&ones), bend.as_ref()]
            .into_iter()
            .flatten()
            .map(Vec::as_slice)
            .collect();
        let slope = self.rest(&x, &others);
        let norm = self.dot(&slope, &slope);
        let mut basis = others.clone();
        basis.push(&x);
        let residuals = self.rest(&self.y, &basis);
        let residual = self.dot(&residuals, &residuals);
        // The exponent is fitted as well.
        let fitted = 2 + 2 * usize::from(bend.is_some());
        let freedom = real(self.x.len().saturating_sub(fitted).max(1));
        let factor = (residual / freedom).max(MIN_FACTOR);
        let significance = bend.as_ref().map_or(0.0, |bend| {
            let rest = self.rest(bend, &[&ones, &x]);
            let norm = self.dot(&rest, &rest);
            self.dot(&rest, &self.y) / (norm * factor).sqrt()
        });
        Fit {
            slope: self.dot(&slope, &self.y) / norm,
            error: (factor / norm * self.inflation(&residuals)).sqrt(),
            residual,
            significance,
        }
    }

    /// Returns the weighted inner product.
    fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        let products = a.iter().zip(b).zip(&self.weights);
        products.map(|((a, b), weight)| weight * a * b).sum()
    }

    /// Returns the residual of a column orthogonal to others (Gram–Schmidt, twice because of rounding).
    fn rest(&self, column: &[f64], others: &[&[f64]]) -> Vec<f64> {
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for other in others {
            let mut rest = other.to_vec();
            (0..2).for_each(|_| basis.iter().for_each(|it| self.take_out(&mut rest, it)));
            basis.push(rest);
        }
        let mut rest = column.to_vec();
        (0..2).for_each(|_| basis.iter().for_each(|it| self.take_out(&mut rest, it)));
        rest
    }

    fn take_out(&self, column: &mut [f64], other: &[f64]) {
        let norm = self.dot(other, other);
        if norm > 0.0 {
            let part = self.dot(column, other) / norm;
            column
                .iter_mut()
                .zip(other)
                .for_each(|(entry, other)| *entry -= part * other);
        }
    }

    /// Returns the weighted means of x and y.
    fn middle(&self) -> (f64, f64) {
        let total: f64 = self.weights.iter().sum();
        let ones = vec![1.0; self.x.len()];
        (
            self.dot(&ones, &self.x) / total,
            self.dot(&ones, &self.y) / total,
        )
    }

    fn r_squared(&self, line: &Fit) -> f64 {
        let (_, mean) = self.middle();
        let away: Vec<f64> = self.y.iter().map(|y| y - mean).collect();
        let all = self.dot(&away, &away);
        // A level line through level points explains all of the variance.
        if all > 0.0 {
            (1.0 - line.residual / all).max(0.0)
        } else {
            1.0
        }
    }

    /// Returns the factor by which the variance of a slope is larger where residuals follow an autoregression
    /// of the first order (Bartlett 1946).
    fn inflation(&self, residuals: &[f64]) -> f64 {
        const MOST: f64 = 0.8;
        let scaled = residuals.iter().zip(&self.weights);
        let scaled: Vec<f64> = scaled
            .map(|(value, weight)| value * weight.sqrt())
            .collect();
        let squares: f64 = scaled.iter().map(|value| value * value).sum();
        let products: f64 = scaled.windows(2).map(|pair| pair[0] * pair[1]).sum();
        if squares <= 0.0 {
            return 1.0;
        }
        let correlation = (products / squares).clamp(0.0, MOST);
        (1.0 + correlation) / (1.0 - correlation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn readings(sizes: i32, log: impl Fn(f64) -> f64) -> Vec<Reading> {
        let reading = |level: i32| {
            let x = f64::from(level) * std::f64::consts::LN_2;
            Reading {
                size: libm::exp(-x),
                log: log(x),
                scatter: 0.0,
                growth: log(x) - log(x - std::f64::consts::LN_2),
                growth_error: 0.0,
            }
        };
        (3..3 + sizes).map(reading).collect()
    }

    #[test]
    fn a_power_has_its_exponent() {
        for exponent in [0.0, 0.5, 1.2618595, 2.0] {
            let estimate = estimate(&readings(8, |x| 0.7 + exponent * x)).unwrap();
            assert!((estimate.value - exponent).abs() < 1e-9, "{estimate:?}");
            assert!(estimate.std_error < 0.003, "{estimate:?}");
            assert!(estimate.r_squared > 1.0 - 1e-9, "{estimate:?}");
            assert!((estimate.intercept - 0.7).abs() < 1e-6, "{estimate:?}");
        }
    }

    #[test]
    fn a_bend_is_followed_and_told_as_an_error() {
        // A disc with a rim: boxes of the area and boxes of the rim.
        let bent = readings(8, |x| {
            libm::log(libm::exp(2.0 * x) + 2.0 * libm::exp(1.3 * x))
        });
        let estimate = estimate(&bent).unwrap();
        assert!((estimate.value - 2.0).abs() < 0.02, "{estimate:?}");
        assert!(
            (estimate.value - 2.0).abs() < 2.0 * estimate.std_error,
            "{estimate:?}"
        );
    }

    #[test]
    fn residuals_that_go_together_make_the_error_larger() {
        let waves = |period: f64| {
            readings(12, |x| {
                x + 0.05 * libm::sin(2.0 * std::f64::consts::PI * x / period)
            })
        };
        let (quick, slow) = (
            Points::of(&waves(1.5)).fit(None),
            Points::of(&waves(6.0)).fit(None),
        );
        assert!(
            slow.error > 1.5 * quick.error,
            "{} {}",
            slow.error,
            quick.error
        );
    }

    #[test]
    fn two_sizes_are_too_few() {
        assert_eq!(estimate(&readings(2, |x| x)), None);
    }
}
