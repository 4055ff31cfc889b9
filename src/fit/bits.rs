//! The number of bits that the numbers of a candidate need.

use super::collage::Form;
use super::orbit::{Level, Orbit};
use super::refine::Numbers;
use super::{Candidate, Shape};

/// Fall of the intersection over union that rounding may cause.
const FALL: f64 = 0.005;

/// Returns the least number of bits a number for which the intersection over union falls by at most [`FALL`], times
/// the number of numbers.
///
/// Numbers are images of points of the shape, from twice the longer side of the picture below 0 to twice that above.
#[expect(clippy::cast_precision_loss, reason = "pictures are small")]
pub(super) fn of(shape: &Shape, candidate: &Candidate, form: Form) -> u64 {
    const MOST: u32 = 24;
    let numbers = Numbers::new(shape, candidate, form);
    let exact = numbers.of(candidate);
    let level = Level::new(shape, 256);
    let mut orbit = Orbit::new(&level);
    let whole = orbit.iou(candidate, &level);
    let range = 4.0 * shape.size()[0].max(shape.size()[1]) as f64;
    let enough = (4..MOST).find(|&bits| {
        let step = range / f64::from(1u32 << bits);
        let rounded: Vec<f64> = exact
            .iter()
            .map(|value| (value / step).round() * step)
            .collect();
        orbit.iou(&numbers.candidate(&rounded), &level) >= whole - FALL
    });
    u64::from(enough.unwrap_or(MOST)) * exact.len() as u64
}
