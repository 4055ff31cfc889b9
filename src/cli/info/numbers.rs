//! Numbers of `kfrac info` as JSON.

use serde::Serialize;

use crate::count::Count;

use super::super::readable;
use super::number;

/// Serializes counts as decimal strings, because they may exceed the numbers that readers of JSON support.
pub(super) fn decimals<S: serde::Serializer>(
    counts: &Option<Vec<Count>>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    match counts {
        Some(counts) => serializer.collect_seq(counts.iter().map(Decimal)),
        None => serializer.serialize_none(),
    }
}

struct Decimal<'a>(&'a Count);

impl Serialize for Decimal<'_> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self.0)
    }
}

/// Serializes estimates rounded to two digits, which is their precision.
pub(super) fn rounded<S: serde::Serializer>(
    estimates: &Option<Vec<Option<f64>>>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let two_digits = |value| number(readable::two_digits(value));
    let estimates = estimates.as_ref().map(|estimates| {
        let rounded = estimates.iter().map(|estimate| estimate.map(two_digits));
        rounded.collect::<Vec<_>>()
    });
    estimates.serialize(serializer)
}

/// Serializes an estimate that is rounded already.
pub(super) fn whole<S: serde::Serializer>(
    bytes: &Option<f64>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    bytes.map(number).serialize(serializer)
}

/// Serializes coordinates; whole numbers have no fraction, as in the tables.
pub(super) fn coordinates<S: serde::Serializer>(
    point: &[f64],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(point.iter().map(|value| number(value + 0.0)))
}
