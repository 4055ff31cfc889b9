//! Conversion between floating-point numbers and integers.

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

/// Returns a count as a floating-point number: exact up to 2⁵³, rounded beyond.
#[inline]
#[expect(
    clippy::cast_precision_loss,
    reason = "counts that large are only estimated with"
)]
pub(crate) fn real(count: usize) -> f64 {
    count as f64
}

/// Iterates over the positions of the ones of a word, from the lowest on.
pub(crate) fn ones(mut word: u64) -> impl Iterator<Item = u32> {
    std::iter::from_fn(move || {
        let bit = word.trailing_zeros();
        word &= word.wrapping_sub(1);
        (bit < u64::BITS).then_some(bit)
    })
}
