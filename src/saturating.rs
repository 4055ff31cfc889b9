//! Saturating conversion of floating-point numbers to integers.

/// Rounds a number towards 0 to an integer; negative numbers and NaN yield 0, numbers beyond the range
/// the largest integer.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
pub(crate) fn whole(number: f64) -> usize {
    number as usize
}
