//! Numbers on the command line.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Returns a parser for whole numbers within bounds. `what` is the name in messages, such as `a number of
/// steps`.
pub(super) fn whole<T>(
    what: &'static str,
    bounds: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<T, String> + Clone
where
    T: FromStr + PartialOrd + Display + Clone,
{
    move |text| match text.parse::<T>() {
        Ok(number) if bounds.contains(&number) => Ok(number),
        _ => Err(format!(
            "{what} is a whole number from {} to {}",
            bounds.start(),
            bounds.end()
        )),
    }
}

/// Parses a number of degrees.
pub(super) fn degrees(text: &str) -> Result<f64, String> {
    let degrees = text.parse::<f64>().ok().filter(|it| it.is_finite());
    degrees.ok_or_else(|| "expected a number of degrees".into())
}

/// Parses a number from 0 to 1.
pub(super) fn share(text: &str) -> Result<f64, String> {
    let share = text.parse::<f64>().ok();
    let share = share.filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "expected a number from 0 to 1".into())
}
