//! The pixels of a picture, covered by boxes.

use std::num::NonZero;

use super::bits::Bits;
use super::cover::{Grid, Scale, least};

/// How the set pixels of a picture are covered by boxes of `base`, base², … pixels, and of one.
///
/// The sides of boxes are in pixels. Grids are moved by whole pixels and not turned: pixels are
/// squares of the grid themselves. None has boxes larger than the picture's long side.
///
/// # Panics
///
/// If the base is 1.
#[must_use]
pub fn raster_scales(
    pixels: &Bits,
    base: NonZero<usize>,
    grids: &[Grid],
    threads: NonZero<usize>,
) -> Vec<Scale> {
    let base = base.get();
    assert!(base > 1, "boxes get larger");
    let longest = pixels.width().max(pixels.height());
    let sides = std::iter::successors(Some(1), |side: &usize| side.checked_mul(base));
    let sides: Vec<usize> = sides.take_while(|&side| side <= longest).collect();
    let largest = sides.last().copied().unwrap_or(1);
    #[expect(clippy::cast_precision_loss, reason = "pictures are smaller than that")]
    let sizes: Vec<f64> = sides.iter().rev().map(|&side| side as f64).collect();
    least(&sizes, grids, threads, |grid| {
        let shift = whole(grid.shift, largest);
        let mut counts = if base == 2 {
            pyramid(pixels, shift, sides.len())
        } else {
            let count = |&side: &usize| {
                pixels
                    .coarser(side, shift.map(|shift| shift % side))
                    .count()
            };
            sides.iter().map(count).collect()
        };
        counts.reverse();
        counts
    })
}

/// How far a grid begins before a picture, in pixels.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    clippy::cast_sign_loss,
    reason = "the shift is below the largest box"
)]
pub(super) fn whole(shift: crate::geometry::DVec2, largest: usize) -> [usize; 2] {
    (shift * largest as f64)
        .to_array()
        .map(|shift| shift as usize)
}

/// The counts of boxes of 1, 2, 4 … pixels whose grid begins so many pixels before the picture.
fn pyramid(pixels: &Bits, shift: [usize; 2], levels: usize) -> Vec<u64> {
    let mut counts = vec![pixels.count()];
    let mut folded: Option<Bits> = None;
    for level in 1..levels {
        let odd = shift.map(|shift| shift >> (level - 1) & 1 == 1);
        let next = folded.as_ref().unwrap_or(pixels).folded(odd);
        counts.push(next.count());
        folded = Some(next);
    }
    counts
}
