//! Numbers on the command line.

use std::fmt::{self, Display};
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

/// Several whole numbers, at least one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Several<T>(Vec<T>);

impl<T> Several<T> {
    /// Returns all numbers of a list; `None` if it is empty.
    pub(super) fn new(all: Vec<T>) -> Option<Self> {
        (!all.is_empty()).then_some(Self(all))
    }

    pub(super) fn one(number: T) -> Self {
        Self(vec![number])
    }

    /// Returns whether there are several numbers.
    pub(super) fn is_plural(&self) -> bool {
        self.0.len() > 1
    }

    pub(super) fn as_slice(&self) -> &[T] {
        &self.0
    }
}

impl<T: Copy + Into<u64>> Several<T> {
    /// Returns whether the numbers do not all follow each other.
    pub(super) fn is_list(&self) -> bool {
        let follow = |pair: &[T]| pair[0].into().checked_add(1) == Some(pair[1].into());
        !self.0.windows(2).all(follow)
    }
}

impl<T: Copy + Ord + Default> Several<T> {
    pub(super) fn first(&self) -> T {
        self.0.first().copied().unwrap_or_default()
    }

    pub(super) fn largest(&self) -> T {
        self.0.iter().copied().max().unwrap_or_default()
    }
}

impl<T: TryFrom<u64> + Into<u64>> Several<T> {
    /// Returns all numbers from `first` to `last`.
    pub(super) fn range(first: T, last: T) -> Self {
        let all = (first.into()..=last.into()).map(T::try_from);
        Self(all.filter_map(Result::ok).collect())
    }
}

/// Formats the numbers in the notation of the command line.
impl<T: Copy + Display + Into<u64>> Display for Several<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let [first, .., last] = self.0[..]
            && !self.is_list()
        {
            return write!(f, "{first}..{last}");
        }
        let all: Vec<_> = self.0.iter().map(T::to_string).collect();
        f.write_str(&all.join(","))
    }
}

/// Returns a parser for several whole numbers within bounds: `0..6` is 0 to 6, both included, and `0,2,4` is a list.
/// `what` is the name of one in messages.
pub(super) fn several<T>(
    what: &'static str,
    bounds: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<Several<T>, String> + Clone
where
    T: FromStr + PartialOrd + Display + Copy + TryFrom<u64> + Into<u64>,
{
    const MOST: u64 = 100_000;
    let one = whole(what, bounds);
    move |text| {
        let mut all = Vec::new();
        for part in text.split(',') {
            let (first, last) = part.split_once("..").unwrap_or((part, part));
            let (first, last) = (one(first.trim())?, one(last.trim())?);
            if first > last {
                return Err("write 0..6, or a list such as 0,2,4".into());
            }
            if last.into() - first.into() >= MOST - (all.len() as u64).min(MOST) {
                return Err(format!("a list has no more than {MOST} numbers"));
            }
            all.extend(Several::range(first, last).0);
        }
        Ok(Several(all))
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

#[cfg(test)]
mod tests {
    use super::several;

    #[test]
    fn several_numbers_are_ranges_and_lists() {
        let seeds = several("a seed", 0..=u64::MAX);
        for (text, all, written) in [
            ("7", &[7][..], "7"),
            ("1..4", &[1, 2, 3, 4], "1..4"),
            ("3, 5,9", &[3, 5, 9], "3,5,9"),
            ("1..3,9", &[1, 2, 3, 9], "1,2,3,9"),
            ("18446744073709551615", &[u64::MAX], "18446744073709551615"),
            (
                "18446744073709551614..18446744073709551615",
                &[u64::MAX - 1, u64::MAX],
                "18446744073709551614..18446744073709551615",
            ),
        ] {
            let read = seeds(text).unwrap();
            assert_eq!(read.as_slice(), all);
            assert_eq!(read.to_string(), written);
        }
        for wrong in [
            "",
            "1..",
            "4..1",
            "1,,2",
            "-1",
            "1.5",
            "0..100000",
            "0..18446744073709551615",
        ] {
            assert!(seeds(wrong).is_err(), "{wrong}");
        }
    }
}
