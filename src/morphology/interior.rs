//! Distances of the pixels of a set to the nearest pixel outside it.

use std::num::NonZero;

use crate::bits::Bits;

use super::distance::{DistanceMap, NoDistances};

/// A set with, for each of its pixels, the squared distance to the nearest pixel outside. There is a row or column of
/// empty pixels on each side.
pub(super) struct Interior {
    pub(super) bits: Bits,
    pub(super) map: DistanceMap,
}

impl Interior {
    /// Measures a set that is not empty.
    pub(super) fn of(bits: &Bits, threads: NonZero<usize>) -> Result<Self, NoDistances> {
        if bits.is_empty() {
            return Err(NoDistances::Empty);
        }
        let bits = bits.window([-1, -1], bits.width() + 2, bits.height() + 2);
        let map = DistanceMap::to(&bits.complement(), threads)?;
        Ok(Self { bits, map })
    }

    /// Returns the largest squared distance.
    pub(super) fn largest(&self) -> u32 {
        self.map.squared().iter().copied().max().unwrap_or(0)
    }

    /// Iterates over the pixels of the set: index and squared distance.
    pub(super) fn pixels(&self) -> impl Iterator<Item = (usize, u32)> {
        let all = self.map.squared().iter().copied().enumerate();
        all.filter(|&(_, squared)| squared > 0)
    }

    /// Returns the column and row in the picture of a pixel of the set.
    pub(super) fn place(&self, index: usize) -> [usize; 2] {
        let width = self.map.width();
        [index % width - 1, index / width - 1]
    }

    /// Returns the squared distances of the eight neighbours of a pixel, round it: those at even places share a side.
    pub(super) fn neighbours(&self, index: usize) -> [u32; 8] {
        around(index, self.map.width()).map(|place| self.map.squared()[place])
    }
}

/// Returns the indices of the eight neighbours of a pixel that is not on the rim, round it from the right.
#[inline]
pub(super) fn around(index: usize, width: usize) -> [usize; 8] {
    [
        index + 1,
        index + 1 + width,
        index + width,
        index + width - 1,
        index - 1,
        index - 1 - width,
        index - width,
        index - width + 1,
    ]
}
