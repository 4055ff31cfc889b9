//! The place of a snapped system that follows from its maps and a picture alone.

use std::sync::atomic::AtomicBool;

use crate::geometry::DVec2;

use super::super::orbit::{Level, Orbit, outside};
use super::super::{FitError, Silhouette};
use super::{Placed, Snapped, upright};

/// Steps of a pixel to which places are rounded, if the picture stays exact.
const STEPS: [f64; 6] = [1.0, 0.5, 0.25, 0.125, 0.0625, 0.03125];
/// Number of rounds in which the middle along each number is taken.
const ROUNDS: usize = 2;
/// Number of pictures after which the result is taken as it is.
const PICTURES: usize = 4;
/// Number of parts of an attractor that is drawn too slowly to look for its middle.
const LARGE: usize = 300_000;
/// Number of places that are improved.
const TRIED: usize = 3;
/// Parts of the range of scales, and of the room that is left then, at which places are tried.
const SCALES: [f64; 5] = [0.02, 0.25, 0.5, 0.75, 0.98];
const OFFSETS: [f64; 3] = [0.0, -0.9, 0.9];

impl Snapped {
    /// Returns the system in the place in which its picture is most like the shape: upright, if its picture can be the
    /// shape's there.
    pub(super) fn found(
        &self,
        shape: &Silhouette,
        level: &Level,
        orbit: &mut Orbit,
        cancel: Option<&AtomicBool>,
    ) -> Result<Placed, FitError> {
        for frame in self.boxed(shape, cancel)? {
            let placed = self.polished(shape, frame, false, cancel)?;
            if placed.wrong == 0 {
                return Ok(placed);
            }
        }
        let settled = self.settled(shape, level, orbit);
        let turned = self.polished(shape, settled, true, cancel)?;
        let straight = upright(turned.frame[1]).filter(|_| turned.wrong == 0);
        if let Some(unit) = straight {
            let placed = self.polished(shape, [turned.frame[0], unit], false, cancel)?;
            if placed.wrong == 0 {
                return Ok(placed);
            }
        }
        Ok(turned)
    }

    /// Returns the system in the middle of the places in which its picture is that of the shape, given one of them, with
    /// numbers as round as can be.
    ///
    /// The picture of the result has the same result, as far as the same maps and an exact place are found again.
    pub(super) fn canonical(
        &self,
        shape: &Silhouette,
        placed: Placed,
        cancel: Option<&AtomicBool>,
    ) -> Result<Placed, FitError> {
        if upright(placed.frame[1]).is_none() || placed.drawn.parts > LARGE {
            return Ok(placed);
        }
        let mut best = self.round(shape, placed, cancel)?;
        for _ in 0..PICTURES {
            let Ok(picture) = Silhouette::new(best.drawn.pixels.clone()) else {
                break;
            };
            let start = self.drawn(&picture, best.frame, cancel)?;
            let next = self.round(&picture, start, cancel)?;
            let is_same = next.candidate == best.candidate;
            let is_exact = next.drawn.is(shape.bits());
            if is_exact {
                best = next;
            }
            if is_same || !is_exact {
                break;
            }
        }
        Ok(best)
    }

    /// Returns the system in the middle of the places in which its picture is that of the shape, along each number of its
    /// place, rounded to the largest step with which the picture is still the shape's.
    fn round(
        &self,
        shape: &Silhouette,
        placed: Placed,
        cancel: Option<&AtomicBool>,
    ) -> Result<Placed, FitError> {
        let Some(unit) = upright(placed.frame[1]).map(DVec2::normalize_or_zero) else {
            return Ok(placed);
        };
        let Some([middle, half]) = self.placed([DVec2::ZERO, unit]).bounds() else {
            return Ok(placed);
        };
        // Numbers: the middle of the attractor's box, and half its longer side.
        let size = half.max_element();
        let frame = |[x, y, reach]: [f64; 3]| {
            let length = reach / size;
            [DVec2::new(x, y) - length * middle, length * unit]
        };
        let length = placed.frame[1].length();
        let centre = placed.frame[0] + length * middle;
        let mut numbers = [centre.x, centre.y, length * size];
        let is_exact = |numbers| Ok(self.drawn(shape, frame(numbers), cancel)?.wrong == 0);
        if !is_exact(numbers)? {
            return Ok(placed);
        }
        for _ in 0..ROUNDS {
            for axis in 0..3 {
                let mut ends = [0.0; 2];
                for (end, sign) in ends.iter_mut().zip([-1.0, 1.0]) {
                    let moved = |by: f64| {
                        let mut moved = numbers;
                        moved[axis] += sign * by;
                        moved
                    };
                    *end = sign * reached(|by| is_exact(moved(by)))?;
                }
                numbers[axis] += (ends[0] + ends[1]) / 2.0;
            }
        }
        for step in STEPS {
            let rounded = numbers.map(|value| (value / step).round() * step);
            let placed = self.drawn(shape, frame(rounded), cancel)?;
            if placed.wrong == 0 {
                return Ok(placed);
            }
        }
        Ok(placed)
    }

    /// Returns upright frames in which the box of the attractor is that of the shape, those whose pictures are most like the
    /// shape; none if the frame is not upright, or the boxes have different forms.
    fn boxed(
        &self,
        shape: &Silhouette,
        cancel: Option<&AtomicBool>,
    ) -> Result<Vec<[DVec2; 2]>, FitError> {
        let Some(unit) = upright(self.frame[1]).map(DVec2::normalize_or_zero) else {
            return Ok(Vec::new());
        };
        let Some([middle, half]) = self.placed([DVec2::ZERO, unit]).bounds() else {
            return Ok(Vec::new());
        };
        let size = shape.bounds().size() + 1.0;
        // Along each axis the attractor reaches into the first and the last pixel.
        let range = |size: f64, half: f64| match half < 1e-3 {
            true => [0.0, f64::INFINITY],
            false => [size - 2.0, size].map(|size| size / (2.0 * half)),
        };
        let [x, y] = [range(size.x, half.x), range(size.y, half.y)];
        let (low, high) = (x[0].max(y[0]), x[1].min(y[1]));
        if !high.is_finite() || low > 1.02 * high {
            return Ok(Vec::new());
        }
        let mut all: Vec<(f64, [DVec2; 2])> = Vec::new();
        for part in SCALES {
            let scale = low + part * (high - low);
            let room = ((size - 2.0 * scale * half) / 2.0).clamp(DVec2::ZERO, DVec2::ONE);
            for right in OFFSETS {
                for up in OFFSETS {
                    let centre = shape.middle() + room * DVec2::new(right, up);
                    let frame = [centre - scale * middle, scale * unit];
                    let drawn = self.placed(frame).roughly(shape.size(), cancel)?;
                    let wrong = outside(&drawn, shape.bits()) + outside(shape.bits(), &drawn);
                    all.push((wrong, frame));
                }
            }
        }
        all.sort_by(|one, other| one.0.total_cmp(&other.0));
        all.truncate(TRIED);
        Ok(all.into_iter().map(|(_, frame)| frame).collect())
    }
}

/// Returns how far a number may be changed, to an accuracy of 1/128, up to 2.
fn reached(holds: impl Fn(f64) -> Result<bool, FitError>) -> Result<f64, FitError> {
    let (mut low, mut high) = (0.0, 1.0 / 16.0);
    while high <= 2.0 && holds(high)? {
        (low, high) = (high, 2.0 * high);
    }
    while high - low > 1.0 / 128.0 {
        let middle = (low + high) / 2.0;
        match holds(middle)? {
            true => low = middle,
            false => high = middle,
        }
    }
    Ok(low)
}
