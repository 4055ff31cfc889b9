//! Box counting on the pixels of a picture.

mod sliding;

use std::num::NonZero;

pub(super) use sliding::{Mean, means, thickness};

use super::cover::{Grid, Scale, least};
use super::statistics::mean;
use crate::bits::Bits;
use crate::geometry::DVec2;
use crate::saturating::{real, whole};

/// Covers the set pixels of a picture by boxes with sides of …, `base`², `base` and 1 pixels.
///
/// The sides of boxes are in pixels, from the largest to the smallest. Grids are shifted by whole pixels and
/// not turned: pixels are squares of the grid themselves. No box is larger than the picture's long side.
///
/// # Panics
///
/// Panics if the base is 1.
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
    let sizes: Vec<f64> = sides.iter().rev().map(|&side| real(side)).collect();
    least(&sizes, grids, threads, |grid| {
        let shift = distance(grid.shift, largest);
        let mut counts = pyramid(pixels, shift, base, sides.len());
        counts.reverse();
        counts
    })
}

/// Returns the distance at which a grid begins before a picture, in pixels.
pub(super) fn distance(shift: DVec2, largest: usize) -> [usize; 2] {
    (shift * real(largest)).to_array().map(whole)
}

/// Counts the boxes of 1, `base`, base² … pixels on the grid that begins `shift` pixels before the picture.
fn pyramid(pixels: &Bits, mut shift: [usize; 2], base: usize, levels: usize) -> Vec<u64> {
    let mut counts = vec![pixels.count()];
    let mut coarser: Option<Bits> = None;
    for _ in 1..levels {
        let finer = coarser.as_ref().unwrap_or(pixels);
        let own = shift.map(|shift| shift % base);
        let next = match base {
            2 => finer.folded(own.map(|shift| shift == 1)),
            _ => finer.coarser(base, own),
        };
        shift = shift.map(|shift| shift / base);
        counts.push(next.count());
        coarser = Some(next);
    }
    counts
}

/// Returns the base for which the counts on the picture's own grid follow a power of the size throughout, if
/// there is one: the picture then shows a set of squares that are divided by this number.
///
/// Bases from 2 to 10 are tried, if the highest power of the base that is not larger than the long side
/// divides it.
pub(super) fn own_base(pixels: &Bits) -> Option<NonZero<usize>> {
    const LARGEST: usize = 10;
    let longest = pixels.width().max(pixels.height());
    let fits = |base: &usize| {
        let powers = std::iter::successors(Some(*base), |power| power.checked_mul(*base));
        let highest = powers.take_while(|power| *power <= longest).last();
        highest.is_some_and(|power| longest.is_multiple_of(power))
    };
    let bases = (2..=LARGEST).filter(fits).filter_map(NonZero::new);
    bases.into_iter().find(|&base| {
        let scales = raster_scales(pixels, base, &[Grid::ALONG], NonZero::<usize>::MIN);
        regular(&scales).is_some()
    })
}

/// Returns the mean of the local slopes of counts, and the largest deviation from it, where all slopes are
/// equal to the precision of pixels.
pub(super) fn regular(scales: &[Scale]) -> Option<(f64, f64)> {
    const MIN_SLOPES: usize = 4;
    const TOLERANCE: f64 = 0.004;
    let slopes = scales.windows(2).map(|pair| {
        let [coarse, fine] = [&pair[0], &pair[1]];
        coarse.slope_to(fine)
    });
    // The largest box may reach beyond the picture.
    let slopes: Vec<f64> = slopes.skip(1).collect();
    let slope = mean(&slopes);
    let away = slopes.iter().map(|it| (it - slope).abs());
    let most = away.fold(0.0, f64::max);
    (slopes.len() >= MIN_SLOPES && most <= TOLERANCE).then_some((slope, most))
}
