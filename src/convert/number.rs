//! Numbers that read as they are.

use crate::build::Number;
use crate::build::written::sequence;
use crate::document::node::Value;
use crate::geometry::{DAffine2, DMat2, DVec2};

/// Denominators of fractions.
const LARGEST_DENOMINATOR: u32 = 36;

/// Numbers of no more characters are not written as fractions.
const SHORT: usize = 6;

/// A number: as a fraction, if that is the same double and shorter to read, or in the fewest digits.
pub(super) fn value(number: f64) -> Value {
    match fraction(number) {
        Some(fraction) => Value::Text(fraction),
        None => Number::from(number + 0.0).0,
    }
}

/// The same in a formula.
pub(super) fn text(number: f64) -> String {
    fraction(number).unwrap_or_else(|| (number + 0.0).to_string())
}

fn fraction(number: f64) -> Option<String> {
    // Minus zero is zero.
    if (number + 0.0).to_string().len() <= SHORT {
        return None;
    }
    (2..=LARGEST_DENOMINATOR).find_map(|denominator| {
        let denominator = f64::from(denominator);
        let numerator = (number * denominator).round();
        let is_same = numerator.abs() < 1000.0 && numerator / denominator == number;
        is_same.then(|| format!("{numerator}/{denominator}"))
    })
}

pub(super) fn point(point: DVec2) -> Value {
    sequence([value(point.x), value(point.y)])
}

pub(super) fn points(all: impl IntoIterator<Item = DVec2>) -> Value {
    sequence(all.into_iter().map(point))
}

/// The rows of a matrix.
pub(super) fn matrix(matrix: DMat2) -> Value {
    points([matrix.row(0), matrix.row(1)])
}

/// The factor or factors of a map that turns nothing.
pub(super) fn scale(matrix: DMat2) -> Option<Value> {
    let (x, y) = (matrix.x_axis, matrix.y_axis);
    let turns = x.y != 0.0 || y.x != 0.0;
    let factor = if x.x == y.y {
        value(x.x)
    } else {
        sequence([value(x.x), value(y.y)])
    };
    (!turns).then_some(factor)
}

/// Whether two maps are the same, to rounding.
pub(super) fn is_same(a: &DAffine2, b: &DAffine2) -> bool {
    const ROUNDING: f64 = 1e-12;
    let size = 1.0 + a.translation.abs().max_element();
    let linear = (a.matrix2 - b.matrix2).abs();
    let shift = (a.translation - b.translation).abs();
    linear.x_axis.max(linear.y_axis).max_element() <= ROUNDING
        && shift.max_element() <= ROUNDING * size
}
