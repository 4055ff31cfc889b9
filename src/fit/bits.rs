//! The number of bits that the numbers of a candidate need.

use std::sync::atomic::AtomicBool;

use super::collage::Form;
use super::refine::Numbers;
use super::{Candidate, FitError, Silhouette, score};

/// Fall of the intersection over union that rounding may cause.
const FALL: f64 = 0.005;
/// Largest number of bits of a number.
const MOST: u32 = 24;

/// Returns the least number of bits a number for which the intersection over union falls by at most [`FALL`], times
/// the number of numbers.
///
/// Stored are the images of points of the shape, from twice the longer side of the picture below 0 to twice that above,
/// and centres and radii of disks. Attractors are drawn [roughly](Candidate::roughly).
#[expect(clippy::cast_precision_loss, reason = "pictures are small")]
pub(super) fn of(
    shape: &Silhouette,
    candidate: &Candidate,
    cancel: Option<&AtomicBool>,
) -> Result<u64, FitError> {
    let numbers = Numbers::new(shape, candidate, Form::of(candidate));
    let exact = numbers.of(candidate);
    let iou = |candidate: &Candidate| {
        let drawn = candidate.roughly(shape.size(), cancel)?;
        Ok(score::iou(shape.bits(), &drawn))
    };
    let whole = iou(candidate)?;
    let range = 4.0 * shape.size()[0].max(shape.size()[1]) as f64;
    let mut enough = MOST;
    for bits in 5..MOST {
        let step = range / f64::from(1u32 << bits);
        let rounded: Vec<f64> = { exact.iter() }
            .map(|value| (value / step).round() * step)
            .collect();
        // Rounded coarsely, maps need not contract.
        let iou = match iou(&numbers.candidate(&rounded)) {
            Ok(iou) => iou,
            Err(FitError::DoesNotContract) => continue,
            Err(error) => return Err(error),
        };
        if iou >= whole - FALL {
            enough = bits;
            break;
        }
    }
    Ok(u64::from(enough) * exact.len() as u64)
}
