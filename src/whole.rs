/// The whole number below; 0 for those below 0 and for what is no number, the largest for those beyond.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
pub(crate) fn whole(number: f64) -> usize {
    number as usize
}
