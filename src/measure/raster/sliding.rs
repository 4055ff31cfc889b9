//! Box counts averaged over all grids: the mean count of a size is the area of a dilation.
//!
//! Of all grids of boxes of s pixels, one in s² has a corner at any given pixel. The mean number of boxes
//! that meet a set is therefore the number of positions of one box that meets it, divided by s²: the area of
//! the set dilated by the box (the Minkowski sausage). The mean is free of the variation between the few
//! grids of a least cover, and can be computed for boxes of any integer side.

use std::borrow::Cow;
use std::num::NonZero;

use crate::bits::Bits;
use crate::saturating::real;

/// Mean number of boxes of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::measure) struct Mean {
    /// Side of a box in pixels.
    pub(in crate::measure) size: f64,
    /// Mean number of boxes that meet the set, over all grids.
    pub(in crate::measure) boxes: f64,
}

/// Minimum number of shifts along each side that grids of large boxes are averaged over.
const PLACES: usize = 8;

/// Sides, in pixels, of the squares that measure the thickness of a set.
const FILLING: std::ops::RangeInclusive<usize> = 2..=6;

/// Maximum number of blocks in a row: in larger pictures, pixels are joined to larger blocks.
const FINE: usize = 1 << 12;

/// Computes the mean counts of boxes of 1 to 8 pixels, and of four sizes to each doubling beyond, from the
/// smallest up to the long side of the picture. In pictures larger than 4096 pixels, sizes are multiples of
/// blocks of 2, 4 … pixels.
pub(in crate::measure) fn means(pixels: &Bits, threads: NonZero<usize>) -> Vec<Mean> {
    let longest = pixels.width().max(pixels.height());
    let mut means = Vec::new();
    let mut blocks = Cow::Borrowed(pixels);
    let mut block = 1;
    let first = longest.div_ceil(FINE).next_power_of_two();
    while block < first || block * PLACES <= longest || block == 1 {
        let mut dilated = Cow::Borrowed(&*blocks);
        // Blocks that are too small are only folded.
        let mut places = if block < first { 2 * PLACES } else { 1 };
        while places < 2 * PLACES && places * block <= longest {
            if block == first || places >= PLACES {
                means.push(mean(&dilated, places, block));
            }
            let more = match places {
                PLACES.. => PLACES / 4,
                _ if block == first => 1,
                _ => places,
            };
            dilated = Cow::Owned(dilated.dilated(more, threads));
            places += more;
        }
        // Alternating shifts keep the grids of larger blocks off the rims of the set.
        let odd = block.trailing_zeros() % 2 == 1;
        blocks = Cow::Owned(blocks.folded([odd, !odd]));
        block *= 2;
    }
    means
}

fn mean(dilated: &Bits, places: usize, block: usize) -> Mean {
    Mean {
        size: real(places * block),
        boxes: dilated.area() / real(places * places),
    }
}

/// Returns the thickness of a set, in pixels beyond the first: the sum of the parts of the set that are
/// filled by squares of 2, 3 … 6 pixels inside it. The thickness is near w − 1 for lines that are w pixels
/// wide, and 5 for filled shapes. In large pictures, only some bands of rows are examined.
pub(in crate::measure) fn thickness(pixels: &Bits, threads: NonZero<usize>) -> f64 {
    const THIN: f64 = 0.3;
    let bands = pixels.bands();
    let pixels = bands.as_ref();
    let all = pixels.area().max(1.0);
    let mut thickness = 0.0;
    for side in FILLING {
        let mut filled = pixels.eroded(side);
        let mut places = 1;
        while places < side {
            let more = places.min(side - places);
            filled = filled.dilated(more, threads);
            places += more;
        }
        let part = filled.area() / all;
        thickness += part;
        if part < THIN {
            break;
        }
    }
    thickness
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns pseudorandom pixels, of which one in 32 is set.
    fn chance(width: usize, height: usize) -> Bits {
        let mut bits = Bits::new(width, height);
        let mut state = 7u64;
        for row in 0..height {
            for column in 0..width {
                state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                if state >> 59 == 0 {
                    bits.set(column, row);
                }
            }
        }
        bits
    }

    #[test]
    fn a_mean_is_that_of_all_grids() {
        let bits = chance(150, 70);
        for mean in means(&bits, NonZero::new(3).unwrap()) {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a side in pixels"
            )]
            let side = mean.size as usize;
            let shifts = || (0..side).step_by(1 + side / 20);
            let grids = shifts().flat_map(|left| shifts().map(move |top| [left, top]));
            let counts: Vec<f64> = grids
                .map(|shift| bits.coarser(side, shift).count() as f64)
                .collect();
            let naive = counts.iter().sum::<f64>() / counts.len() as f64;
            // Grids of boxes of 16 pixels and more are shifted by several pixels.
            let tolerance = if side < 16 { 1e-12 } else { 0.15 };
            let off = (mean.boxes / naive - 1.0).abs();
            assert!(off < tolerance, "{side}: {} {naive}", mean.boxes);
        }
    }

    #[test]
    fn threads_change_nothing() {
        let bits = chance(200, 1100);
        let of = |threads| means(&bits, NonZero::new(threads).unwrap());
        assert_eq!(of(1), of(3));
    }

    #[test]
    fn large_pictures_are_looked_at_in_larger_blocks() {
        let mut line = Bits::new(9000, 3);
        (0..9000).for_each(|column| line.set(column, 1));
        let means = means(&line, NonZero::<usize>::MIN);
        let all: Vec<f64> = means.iter().take(9).map(|mean| mean.size).collect();
        assert_eq!(all, [4.0, 8.0, 12.0, 16.0, 20.0, 24.0, 28.0, 32.0, 40.0]);
        for mean in means.iter().filter(|mean| mean.size < 1000.0) {
            // A line of L pixels meets L / s + 1 boxes, less the length of a single pixel.
            let off = mean.boxes - (9000.0 / mean.size + 1.0);
            assert!(off.abs() < 1.0, "{mean:?}");
        }
    }

    #[test]
    fn squares_fill_what_is_as_thick() {
        let one = NonZero::<usize>::MIN;
        let line = |width: usize| {
            let mut bits = Bits::new(300, 10);
            (0..300).for_each(|column| (0..width).for_each(|row| bits.set(column, row)));
            thickness(&bits, one)
        };
        assert_eq!([1, 2, 3, 10].map(line), [0.0, 1.0, 2.0, 5.0]);
    }

    #[test]
    fn what_is_cropped_holds_all() {
        for [left, top] in [[0, 0], [3, 5], [64, 1], [130, 0]] {
            let own = chance(90, 40).cropped().into_owned();
            let mut moved = Bits::new(300, 60);
            for row in 0..own.height() {
                for column in (0..own.width()).filter(|&column| own.get(column, row)) {
                    moved.set(column + left, row + top);
                }
            }
            assert_eq!(*moved.cropped(), own, "{left} {top}");
        }
        assert_eq!(Bits::new(70, 3).cropped().count(), 0);
    }
}
