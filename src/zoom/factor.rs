//! Magnification factors beyond the range of doubles.

use std::fmt;
use std::str::FromStr;

use dashu_float::round::mode::HalfEven;
use dashu_float::{DBig, FBig};
use dashu_int::IBig;

/// Magnification relative to the view of the whole: a positive number of 192 bits.
///
/// The notation is a decimal, with or without exponent, or a power of a decimal: `1e1000`, `3^5000`.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    value: FBig<HalfEven, 2>,
    text: String,
}

/// Error: a text is not a magnification factor.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FactorError {
    /// The text is not a positive number.
    #[error("a zoom is a number above 0, such as 250, 1e1000 or 3^5000")]
    Unreadable,
    /// The factor is too large or too small.
    #[error("the zoom goes to 1e{MAX_DIGITS} at most, and to 1e-{MIN_DIGITS} at least")]
    Beyond,
}

const BITS: usize = 192;

/// Largest decimal exponent; larger factors take too long.
const MAX_DIGITS: u32 = 10_000;

/// Largest negative decimal exponent; with smaller factors a picture shows a point.
const MIN_DIGITS: u32 = 6;

impl FromStr for Factor {
    type Err = FactorError;

    fn from_str(text: &str) -> Result<Self, FactorError> {
        let written = text.trim();
        let value = match written.split_once('^') {
            Some((base, exponent)) => {
                let base = decimal(base.trim())?;
                let exponent: i32 = exponent
                    .trim()
                    .parse()
                    .map_err(|_| FactorError::Unreadable)?;
                let digits = log10(&base) * f64::from(exponent);
                check(digits)?;
                base.powi(IBig::from(exponent))
            }
            None => decimal(written)?,
        };
        check(log10(&value))?;
        Ok(Self {
            value,
            text: written.to_owned(),
        })
    }
}

/// Formats the factor as it was written.
impl fmt::Display for Factor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl Factor {
    /// Least factor.
    pub const LEAST: f64 = 1e-6;

    /// Returns the factor 1: no magnification.
    #[must_use]
    pub fn one() -> Self {
        Self {
            value: FBig::ONE,
            text: "1".into(),
        }
    }

    /// Returns the nearest double; infinity if the factor is beyond the range.
    #[must_use]
    pub fn to_f64(&self) -> f64 {
        self.value.to_f64().value()
    }

    /// Returns the binary logarithm.
    #[must_use]
    pub fn log2(&self) -> f64 {
        log10(&self.value) * std::f64::consts::LOG2_10
    }

    /// Returns the product of a number and the factor, in multiples of 2^-`bits`.
    pub(super) fn times(&self, number: f64, bits: usize) -> IBig {
        let number = FBig::<HalfEven, 2>::try_from(number).unwrap_or(FBig::ZERO);
        let product = number.with_precision(BITS).value() * &self.value;
        (product << isize::try_from(bits).unwrap_or(isize::MAX))
            .to_int()
            .value()
    }
}

fn check(digits: f64) -> Result<(), FactorError> {
    if digits > f64::from(MAX_DIGITS) || digits < -f64::from(MIN_DIGITS) {
        return Err(FactorError::Beyond);
    }
    Ok(())
}

/// Parses a positive decimal.
fn decimal(text: &str) -> Result<FBig<HalfEven, 2>, FactorError> {
    let is_plain = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-');
    if !text.chars().all(is_plain) || !text.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        return Err(FactorError::Unreadable);
    }
    // A long exponent is rejected without evaluation.
    let exponent = text.split_once(['e', 'E']).map(|(_, exponent)| exponent);
    if exponent.is_some_and(|exponent| exponent.len() > 8) {
        let is_number = exponent.is_some_and(|text| text.parse::<f64>().is_ok());
        return Err(if is_number {
            FactorError::Beyond
        } else {
            FactorError::Unreadable
        });
    }
    if let Some(exponent) = exponent {
        let exponent: i32 = exponent.parse().map_err(|_| FactorError::Unreadable)?;
        check(f64::from(exponent))?;
    }
    let decimal = DBig::from_str(text).map_err(|_| FactorError::Unreadable)?;
    if decimal <= DBig::ZERO {
        return Err(FactorError::Unreadable);
    }
    let binary = decimal.with_base_and_precision::<2>(BITS).value();
    Ok(binary.with_rounding())
}

fn log10(value: &FBig<HalfEven, 2>) -> f64 {
    let value = value.clone().with_precision(64).value();
    value.log10().to_f64().value()
}

#[cfg(test)]
mod tests {
    use super::{Factor, FactorError};

    #[test]
    fn factors_are_decimals_and_powers() {
        let read = |text: &str| text.parse::<Factor>();
        for (text, same) in [
            ("3^4", "81"),
            ("1e3", "1000"),
            ("2.5e1", "25"),
            (".5", "0.5"),
            ("2^-2", "0.25"),
        ] {
            let (read, same) = (read(text).unwrap(), read(same).unwrap());
            assert_eq!(read.times(3.0, 100), same.times(3.0, 100), "{text}");
            assert_eq!(read.to_string(), text);
        }
        let log = read("3^5000").unwrap().log2();
        assert!((log - 5000.0 * libm::log2(3.0)).abs() < 1e-9, "{log}");
        for text in [
            "", "x", "-1", "0", "1e", "^2", "2^", "2^x", "2^0.5", "1e5x", "inf", "NaN",
        ] {
            assert_eq!(read(text), Err(FactorError::Unreadable), "{text}");
        }
        for text in ["1e10001", "1e999999999999", "7^99999999", "1e-9", "0.1^99"] {
            assert_eq!(read(text), Err(FactorError::Beyond), "{text}");
        }
    }
}
