//! Notation of numbers that is read as the same double.

use crate::build::NumberText;
use crate::build::written::sequence;
use crate::document::node::Value;
use crate::geometry::{DAffine2, DMat2, DVec2};

/// Largest denominator of fractions.
const LARGEST_DENOMINATOR: u32 = 36;

/// Number of characters up to which decimals are not replaced by fractions.
const SHORT: usize = 6;

/// Writes a number as a fraction, if that is the same double and the decimals are longer than [`SHORT`], or
/// else in the fewest digits.
pub(super) fn value(number: f64) -> Value {
    match fraction(number) {
        Some(fraction) => Value::Text(fraction),
        None => NumberText::from(number + 0.0).0,
    }
}

/// Writes a number inside an expression.
pub(super) fn text(number: f64) -> String {
    fraction(number).unwrap_or_else(|| (number + 0.0).to_string())
}

fn fraction(number: f64) -> Option<String> {
    // Adding zero turns minus zero into zero.
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

/// Writes the rows of a matrix.
pub(super) fn matrix(matrix: DMat2) -> Value {
    points([matrix.row(0), matrix.row(1)])
}

/// Writes the factor or the two factors of a diagonal matrix; `None` for any other matrix.
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

/// Returns whether two maps are equal, to rounding.
pub(super) fn is_same(a: &DAffine2, b: &DAffine2) -> bool {
    const ROUNDING: f64 = 1e-12;
    let size = 1.0 + a.translation.abs().max_element();
    let linear = (a.matrix2 - b.matrix2).abs();
    let shift = (a.translation - b.translation).abs();
    linear.x_axis.max(linear.y_axis).max_element() <= ROUNDING
        && shift.max_element() <= ROUNDING * size
}
