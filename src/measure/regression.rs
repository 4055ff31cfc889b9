//! Dimensions as slopes over few decades, with an error that does not flatter them.
//!
//! Counts of boxes are a power of the size only in the limit: rims, gaps and coarse boxes bend the
//! line, and the residuals of neighbouring sizes go together. So the slope is told in two ways. One
//! is that of the finer half of the sizes. The other is that of all sizes with a correction to
//! scaling, y = a + D x + c exp(−θ x) with x = ln (1 / size), where θ is what fits best (as for
//! critical exponents: Wegner 1972); it is believed if c is more than three standard errors above 0:
//! there are boxes of a rim, say, beside those of the set. (Where slopes fall as boxes get smaller, small
//! boxes have more likely lost thin parts of a picture.)
//! The first lags behind a bend and the second runs ahead of it: the estimate is their mean. Where
//! there is no such bend, it is the first, and the second is the slope of all sizes. How far the second
//! lies from the estimate is part of its error.

/// A measurement at one size of boxes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reading {
    pub(super) size: f64,
    /// The logarithm of what is measured.
    pub(super) log: f64,
    /// The standard deviation of the logarithm among grids.
    pub(super) scatter: f64,
    /// How much it grows since the size before.
    pub(super) growth: f64,
    /// The standard error of that.
    pub(super) growth_error: f64,
}

/// A dimension as the slope of a weighted regression of a logarithm on ln (1 / size).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The dimension: the mean over models and ranges, by their likelihood. Of pictures that the boxes of
    /// a base fit: the mean of local slopes. Of few sizes: the slope of the finer half of them, or its mean
    /// with the slope of all of them with a correction to scaling, where that is significant.
    pub value: f64,
    /// Its standard error: that of the regression, made larger as far as residuals of neighbouring
    /// sizes go together, and how far other ways to tell the slope lie from it.
    pub std_error: f64,
    /// The smallest and the largest size that were used, in the units of the set; on the mean, where
    /// there are several ranges.
    pub range: [f64; 2],
    /// The part of the variance that a straight line through all sizes explains, from 0 to 1.
    pub r_squared: f64,
    /// The logarithm at size 1, on the line with this slope through the middle of the sizes that tell
    /// it.
    pub intercept: f64,
    /// The number of sizes that were used; 0 if nothing had to be measured.
    pub sizes: usize,
}

impl Estimate {
    /// The decades that the range spans.
    #[must_use]
    pub fn decades(&self) -> f64 {
        libm::log10(self.range[1] / self.range[0])
    }
}

impl Estimate {
    /// With an error for local slopes that have drifted so far over the finer half of the decades: how far
    /// they go on is not known. Those that drift as 1 / ln (1 / size) do have as much before them.
    pub(super) fn drifting(self, drift: f64) -> Self {
        Self {
            std_error: libm::hypot(self.std_error, drift / 2.0),
            ..self
        }
    }
}

/// A scatter below this is not believed: grids are few, and none is the best one.
const LEAST_SCATTER: f64 = 0.01;

/// Where a line fits better than the scatter tells, errors are made smaller, but no more than so.
const LEAST_FACTOR: f64 = 0.05;

/// A correction to scaling takes so many sizes, at least.
const LEAST_SIZES: usize = 5;

/// A coefficient that is so many standard errors above 0 is significant.
const SIGNIFICANT: f64 = 3.0;

/// The slope of readings, from the largest size to the smallest; none if there are fewer than three.
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

/// What part of the variance a straight line through readings explains, and the logarithm at size 1 on
/// a line with a slope through their middle.
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

/// A regression.
pub(super) struct Fit {
    pub(super) slope: f64,
    pub(super) error: f64,
    /// The weighted sum of the squares of the residuals.
    residual: f64,
    /// The coefficient of the correction in standard errors.
    significance: f64,
}

impl Points {
    /// Of abscissas, ordinates and weights.
    pub(super) fn new(rows: impl Iterator<Item = (f64, f64, f64)>) -> Self {
        let rows: Vec<_> = rows.collect();
        Self {
            x: rows.iter().map(|row| row.0).collect(),
            y: rows.iter().map(|row| row.1).collect(),
            weights: rows.iter().map(|row| row.2).collect(),
        }
    }

    fn of(readings: &[Reading]) -> Self {
        let weight = |it: &Reading| 1.0 / (it.scatter * it.scatter + LEAST_SCATTER * LEAST_SCATTER);
        Self {
            x: readings.iter().map(|it| -libm::log(it.size)).collect(),
            y: readings.iter().map(|it| it.log).collect(),
            weights: readings.iter().map(weight).collect(),
        }
    }

    /// The best of all lines with a correction, if that is significant.
    fn corrected(&self) -> Option<Fit> {
        if self.x.len() < LEAST_SIZES {
            return None;
        }
        let exponents = (4..=30).map(|number| 0.05 * f64::from(number));
        let fits = exponents.map(|exponent| self.fit(Some(exponent)));
        let best = fits.min_by(|a, b| a.residual.total_cmp(&b.residual))?;
        (best.significance > SIGNIFICANT).then_some(best)
    }

    /// A line, or a line with a correction of an exponent, by weighted least squares.
    ///
    /// A coefficient is what a column has to do with y once all other columns are taken out of it
    /// (Frisch & Waugh 1933).
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
        // The exponent is one more that was fitted.
        let fitted = 2 + 2 * usize::from(bend.is_some());
        let freedom = count(self.x.len().saturating_sub(fitted).max(1));
        let factor = (residual / freedom).max(LEAST_FACTOR);
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

    /// The weighted inner product.
    fn dot(&self, a: &[f64], b: &[f64]) -> f64 {
        let products = a.iter().zip(b).zip(&self.weights);
        products.map(|((a, b), weight)| weight * a * b).sum()
    }

    /// What is left of a column when others are taken out of it (Gram–Schmidt, twice over for the
    /// sake of rounding).
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

    /// The weighted means of x and y.
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
        // A level line through level points explains everything.
        if all > 0.0 {
            (1.0 - line.residual / all).max(0.0)
        } else {
            1.0
        }
    }

    /// How much larger the variance of a slope is where residuals follow each other as those of an
    /// autoregression of the first order (Bartlett 1946).
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

#[expect(clippy::cast_precision_loss, reason = "sizes are few")]
fn count(number: usize) -> f64 {
    number as f64
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
        // A disc with a rim: boxes of area and boxes of the rim.
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
