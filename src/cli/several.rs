//! Several whole numbers on the command line: `1..9`, `0,2,4`, or both.

use std::fmt;
use std::ops::RangeInclusive;

use super::number;

/// Several whole numbers, at least one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Several<T>(Vec<T>);

impl<T: Copy + Ord> Several<T> {
    pub(super) fn one(number: T) -> Self {
        Self(vec![number])
    }

    pub(super) fn as_slice(&self) -> &[T] {
        &self.0
    }

    pub(super) fn first(&self) -> T {
        self.0[0]
    }

    pub(super) fn largest(&self) -> T {
        self.0.iter().copied().fold(self.first(), T::max)
    }

    pub(super) fn count(&self) -> u32 {
        u32::try_from(self.0.len()).unwrap_or(u32::MAX)
    }

    /// Returns whether there are several numbers.
    pub(super) fn is_plural(&self) -> bool {
        self.0.len() > 1
    }
}

impl Several<u32> {
    /// Returns all numbers from 0 to `last`.
    pub(super) fn up_to(last: u32) -> Self {
        Self((0..=last).collect())
    }
}

impl<T: Copy + Into<u64> + TryFrom<u64>> Several<T> {
    /// Returns a parser for up to `most` numbers within bounds: `0..6` is 0 to 6, both included, and `0,2,4` is a list. `what`
    /// is the name of a number in messages, such as `a number of steps`.
    pub(super) fn parser(
        what: &'static str,
        bounds: RangeInclusive<T>,
        most: usize,
    ) -> impl Fn(&str) -> Result<Self, String> + Clone {
        let parse = number::whole(what, (*bounds.start()).into()..=(*bounds.end()).into());
        move |text| {
            let mut all = Vec::new();
            for part in text.split(',') {
                let (first, last) = part.split_once("..").unwrap_or((part, part));
                let (first, last) = (parse(first.trim())?, parse(last.trim())?);
                if first > last {
                    return Err("a range begins with the smaller number, as 0..6".into());
                }
                let room = (most - all.len()) as u64;
                if last - first >= room {
                    return Err(format!("no more than {most} numbers can be given"));
                }
                all.extend((first..=last).filter_map(|number| T::try_from(number).ok()));
            }
            Ok(Self(all))
        }
    }
}

/// Formats the numbers in the notation of the command line.
impl<T: Copy + Into<u64> + fmt::Display> fmt::Display for Several<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let follow = |pair: &[T]| pair[1].into().checked_sub(pair[0].into()) == Some(1);
        match &self.0[..] {
            [first, .., last] if self.0.windows(2).all(follow) => write!(f, "{first}..{last}"),
            all => {
                let all: Vec<_> = all.iter().map(T::to_string).collect();
                f.write_str(&all.join(","))
            }
        }
    }
}
