//! The exact Euclidean distance transform, with the nearest pixel of the set (Meijster, Roerdink & Hesselink 2000).

mod columns;
mod envelope;

use std::num::NonZero;

use crate::bits::Bits;
use crate::parallel::for_each;

pub(super) use columns::Columns;
pub(super) use envelope::Envelope;

/// Number of rows that one thread transforms at once.
pub(super) const BAND: usize = 64;

/// Largest sum of the squared sides of a picture: squared distances are numbers of 32 bits.
const MAX_DIAGONAL: u64 = u32::MAX as u64;

/// The reason for which a set has no distance map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoDistances {
    /// No pixel is set.
    #[error("the set is empty: there is no distance to it")]
    Empty,
    /// The diagonal of the picture is longer than 65,535 pixels.
    #[error(
        "distances in a picture of {width} x {height} pixels do not fit in 32 bits: its diagonal is longer than 65535 pixels"
    )]
    TooLarge {
        /// Number of columns.
        width: usize,
        /// Number of rows.
        height: usize,
    },
}

/// For every pixel of a picture, the distance of its centre to the nearest pixel of a set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DistanceMap {
    width: usize,
    height: usize,
    squared: Vec<u32>,
    nearest: Vec<u32>,
}

impl DistanceMap {
    /// Computes the distances to a set of pixels, in time proportional to the number of all pixels.
    ///
    /// # Errors
    ///
    /// Returns an error if the set is empty or the picture's diagonal longer than 65,535 pixels.
    pub fn to(set: &Bits, threads: NonZero<usize>) -> Result<Self, NoDistances> {
        let (width, height) = (set.width(), set.height());
        let square = |side: usize| (side as u64).saturating_mul(side as u64);
        if square(width).saturating_add(square(height)) > MAX_DIAGONAL {
            return Err(NoDistances::TooLarge { width, height });
        }
        if set.is_empty() {
            return Err(NoDistances::Empty);
        }
        let mut squared = vec![0; width * height];
        let mut nearest = vec![0; width * height];
        let bands = squared
            .chunks_mut(BAND * width)
            .zip(nearest.chunks_mut(BAND * width))
            .enumerate();
        for_each(bands, threads.get(), |(band, (squared, nearest))| {
            let first = band * BAND;
            Columns::fill(set, first, nearest);
            let mut envelope = Envelope::default();
            let rows = squared
                .chunks_exact_mut(width)
                .zip(nearest.chunks_exact_mut(width));
            for (row, (squared, nearest)) in rows.enumerate() {
                envelope.fill(first + row, squared, nearest);
            }
        });
        Ok(Self {
            width,
            height,
            squared,
            nearest,
        })
    }

    /// Returns the number of columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns the squared distances in pixels, row by row from the top; 0 for pixels of the set.
    #[must_use]
    pub fn squared(&self) -> &[u32] {
        &self.squared
    }

    /// Returns the index (row × width + column) of the nearest pixel of the set for each pixel, row by row from the
    /// top; of several, one, on any number of threads.
    #[must_use]
    pub fn nearest(&self) -> &[u32] {
        &self.nearest
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::bits::tests::random_bits;

    const ONE: NonZero<usize> = NonZero::<usize>::MIN;

    fn naive(set: &Bits, column: usize, row: usize) -> Option<u32> {
        let squares = set.set_boxes().map(|[x, y]| {
            let [x, y] = [x.abs_diff(column), y.abs_diff(row)];
            u32::try_from(x * x + y * y).unwrap()
        });
        squares.min()
    }

    fn check(set: &Bits) {
        let map = DistanceMap::to(set, NonZero::new(3).unwrap());
        assert_eq!(map, DistanceMap::to(set, ONE));
        let Ok(map) = map else {
            assert_eq!(map, Err(NoDistances::Empty));
            assert!(set.is_empty());
            return;
        };
        for (index, (&squared, &nearest)) in map.squared.iter().zip(&map.nearest).enumerate() {
            let [column, row] = [index % set.width(), index / set.width()];
            assert_eq!(Some(squared), naive(set, column, row), "{column} {row}");
            let nearest = nearest as usize;
            let [x, y] = [nearest % set.width(), nearest / set.width()];
            assert!(set.get(x, y));
            let [x, y] = [x.abs_diff(column), y.abs_diff(row)];
            assert_eq!(x * x + y * y, squared as usize);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(96))]

        #[test]
        fn distances_are_the_least(set in random_bits(150, 80)) {
            check(&set);
        }
    }

    #[test]
    fn one_pixel_is_nearest_to_all() {
        for [column, row] in [[0, 0], [63, 64], [70, 199]] {
            let mut set = Bits::new(71, 200);
            set.set(column, row);
            check(&set);
        }
    }

    #[test]
    fn without_distances_there_is_a_reason() {
        let empty = DistanceMap::to(&Bits::new(5, 0), ONE);
        assert_eq!(empty, Err(NoDistances::Empty));
        let mut long = Bits::new(70_000, 1);
        long.set(0, 0);
        let message = DistanceMap::to(&long, ONE).unwrap_err().to_string();
        assert!(message.contains("70000 x 1 pixels"), "{message}");
    }
}
