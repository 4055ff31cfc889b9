//! Addresses of points of a limit set, and their notation.

use std::fmt;
use std::str::FromStr;

use crate::geometry::DVec2;

/// Address of a point: a sequence of positions, whose nested elements have exactly this point in common,
/// or its coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Address {
    /// Position in the initiator, followed at each replacement by the position in the generator as
    /// listed, counted across its parts, including seed parts: an initial sequence, then a periodic one.
    Path {
        /// Initial sequence.
        first: Vec<u32>,
        /// Period, which is not empty.
        repeated: Vec<u32>,
    },
    /// Point of the plane, in the model's units.
    Point(DVec2),
    /// Point of the plane whose coordinates have more digits than doubles.
    LongPoint([LongDecimal; 2]),
}

/// Decimal without an exponent, of more digits than a double.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LongDecimal(String);

impl LongDecimal {
    /// Largest number of digits.
    const MAX_DIGITS: usize = 20_000;

    /// Parses a decimal; `None` if it has an exponent, or too many digits.
    fn parse(text: &str) -> Option<Self> {
        let digits = text.strip_prefix('-').unwrap_or(text);
        let is_plain = digits.chars().all(|c| c.is_ascii_digit() || c == '.');
        (is_plain && text.len() <= Self::MAX_DIGITS).then(|| Self(text.to_owned()))
    }

    /// Returns the digits as written.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// Returns the nearest double.
    #[must_use]
    pub fn near(&self) -> f64 {
        self.0.parse().unwrap_or(0.0)
    }
}

/// Number of characters up to which decimals are read as doubles, whose shortest notation has 17 digits.
const SHORT: usize = 20;

/// Error: a text is not an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AddressError {
    /// The text has another form.
    #[error(
        "an address is a way of positions that goes on for ever, such as 0.2.(1), or a point x,y"
    )]
    Unreadable,
    /// The sequence is finite.
    #[error(
        "this way ends at an element, which is no point yet: what is repeated for ever stands in \
         brackets at its end, as in 0.2.(1)"
    )]
    Ends,
    /// The address has too many positions.
    #[error("an address has {MAX_POSITIONS} positions at most")]
    TooLong,
}

const MAX_POSITIONS: usize = 1_000_000;

impl Address {
    /// Returns the point in doubles; `None` for a sequence of positions.
    pub(crate) fn near(&self) -> Option<DVec2> {
        match self {
            Self::Path { .. } => None,
            Self::Point(point) => Some(*point),
            Self::LongPoint([x, y]) => Some(DVec2::new(x.near(), y.near())),
        }
    }
}

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        let text = text.trim();
        if let Some((x, y)) = text.split_once(',') {
            let number = |text: &str| match text.trim().parse::<f64>() {
                Ok(number) if number.is_finite() => Ok(number),
                _ => Err(AddressError::Unreadable),
            };
            let point = DVec2::new(number(x)?, number(y)?);
            let long = [x, y].map(|text| LongDecimal::parse(text.trim()));
            return Ok(match long {
                [Some(x), Some(y)] if x.0.len().max(y.0.len()) > SHORT => Self::LongPoint([x, y]),
                _ => Self::Point(point),
            });
        }
        let Some((first, repeated)) = text.split_once('(') else {
            positions(text)?;
            return Err(AddressError::Ends);
        };
        let repeated = repeated.strip_suffix(')').ok_or(AddressError::Unreadable)?;
        let first = match first {
            "" => Vec::new(),
            _ => positions(first.strip_suffix('.').unwrap_or(first))?,
        };
        let repeated = positions(repeated)?;
        if first.len() + repeated.len() > MAX_POSITIONS {
            return Err(AddressError::TooLong);
        }
        Ok(Self::Path { first, repeated })
    }
}

/// Parses positions separated by full stops.
fn positions(text: &str) -> Result<Vec<u32>, AddressError> {
    let read = |position: &str| match position.trim() {
        digits if digits.starts_with('+') => Err(AddressError::Unreadable),
        digits => digits.parse().map_err(|_| AddressError::Unreadable),
    };
    text.split('.').map(read).collect()
}

/// Formats the address in the notation that is parsed.
impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (first, repeated) = match self {
            Self::Point(point) => return write!(f, "{},{}", point.x, point.y),
            Self::LongPoint([x, y]) => return write!(f, "{},{}", x.0, y.0),
            Self::Path { first, repeated } => (first, repeated),
        };
        let joined = |positions: &[u32]| {
            let all: Vec<String> = positions.iter().map(u32::to_string).collect();
            all.join(".")
        };
        if !first.is_empty() {
            write!(f, "{}.", joined(first))?;
        }
        write!(f, "({})", joined(repeated))
    }
}

#[cfg(test)]
mod tests {
    use super::{Address, AddressError};

    #[test]
    fn addresses_are_printed_as_they_are_written() {
        for text in [
            "0.2.(1)",
            "(0)",
            "3.(0.12.7)",
            "0.5,-2",
            "0.1234567890123456789012345678901234567890,-2",
        ] {
            assert_eq!(text.parse::<Address>().unwrap().to_string(), text);
        }
        assert_eq!("0(1)".parse::<Address>(), "0.(1)".parse());
        for text in ["0", "0.1.2"] {
            assert_eq!(text.parse::<Address>(), Err(AddressError::Ends), "{text}");
        }
        for text in [
            "",
            "x",
            "0.(1",
            "0.(1).2",
            "()",
            "0..(1)",
            "-1.(0)",
            "1,",
            "1,inf",
            "99999999999.(0)",
        ] {
            assert_eq!(
                text.parse::<Address>(),
                Err(AddressError::Unreadable),
                "{text}"
            );
        }
    }
}
