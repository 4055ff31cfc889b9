//! Sets of boxes as bits: the occupied boxes of one size, which can be folded to larger boxes.

mod dilation;
mod window;

use crate::morton::gathered;
use crate::saturating::ones;

/// Boxes in rows, a bit for each: set where the box is occupied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bits {
    width: usize,
    height: usize,
    /// Words of 64 boxes, the first in the lowest bit; bits beyond the width are not set.
    words: Vec<u64>,
}

impl Bits {
    /// Creates a set of `width` × `height` empty boxes.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            words: vec![0; width.div_ceil(64) * height],
        }
    }

    /// Creates the set of the boxes whose bytes are at or above a threshold; rows follow each other without
    /// gaps.
    ///
    /// # Panics
    ///
    /// Panics if there are not width × height bytes.
    #[must_use]
    pub fn of_bytes(bytes: &[u8], width: usize, height: usize, threshold: u8) -> Self {
        assert_eq!(bytes.len(), width * height, "a byte for every box");
        let mut bits = Self::new(width, height);
        if width == 0 {
            return bits;
        }
        let rows = bytes.chunks_exact(width);
        for (row, words) in rows.zip(bits.words.chunks_exact_mut(width.div_ceil(64))) {
            for (bytes, word) in row.chunks(64).zip(words) {
                let (eights, rest) = bytes.as_chunks::<8>();
                for (number, eight) in eights.iter().enumerate() {
                    *word |= flags(*eight, threshold) << (8 * number);
                }
                for (number, &byte) in rest.iter().enumerate() {
                    *word |= u64::from(byte >= threshold) << (8 * eights.len() + number);
                }
            }
        }
        bits
    }

    /// Creates the set of the boxes, by column and row, for which a condition holds.
    #[must_use]
    pub fn of(width: usize, height: usize, is_set: impl Fn(usize, usize) -> bool) -> Self {
        let mut bits = Self::new(width, height);
        for row in 0..height {
            for column in (0..width).filter(|&column| is_set(column, row)) {
                bits.set(column, row);
            }
        }
        bits
    }

    /// Returns the number of boxes in a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// Sets a box.
    ///
    /// # Panics
    ///
    /// Panics, or sets another bit, if the place is outside.
    #[inline]
    pub fn set(&mut self, column: usize, row: usize) {
        self.words[row * self.width.div_ceil(64) + column / 64] |= 1 << (column % 64);
    }

    /// Sets a box, or clears it.
    ///
    /// # Panics
    ///
    /// Panics, or changes another bit, if the place is outside.
    #[inline]
    pub fn assign(&mut self, column: usize, row: usize, is_set: bool) {
        let word = &mut self.words[row * self.width.div_ceil(64) + column / 64];
        *word = *word & !(1 << (column % 64)) | u64::from(is_set) << (column % 64);
    }

    /// Returns `true` if a box is set.
    ///
    /// # Panics
    ///
    /// Panics, or reads another bit, if the place is outside.
    #[inline]
    #[must_use]
    pub fn get(&self, column: usize, row: usize) -> bool {
        self.words[row * self.width.div_ceil(64) + column / 64] >> (column % 64) & 1 == 1
    }

    /// Sets a box. Returns `true` if it was not set before.
    #[inline]
    pub(crate) fn insert(&mut self, column: usize, row: usize) -> bool {
        let word = &mut self.words[row * self.width.div_ceil(64) + column / 64];
        let before = *word;
        *word |= 1 << (column % 64);
        *word != before
    }

    /// Empties all boxes.
    pub(crate) fn clear(&mut self) {
        self.words.fill(0);
    }

    /// Takes the boxes of a set of the same size.
    pub(crate) fn copy(&mut self, other: &Self) {
        self.words.copy_from_slice(&other.words);
    }

    /// Returns the words of all rows.
    pub(crate) fn words(&self) -> &[u64] {
        &self.words
    }

    /// Returns the words of all rows for changes; bits beyond the width must stay empty.
    pub(crate) fn words_mut(&mut self) -> &mut [u64] {
        &mut self.words
    }

    /// Returns the number of words in a row.
    pub(crate) fn stride(&self) -> usize {
        self.width.div_ceil(64)
    }

    /// Returns the bits of the last word of a row that are within the width.
    pub(crate) fn last_word(&self) -> u64 {
        u64::MAX >> ((64 - self.width % 64) % 64)
    }

    /// Returns the words of up to `count` rows from a row on.
    pub(crate) fn rows(&self, first: usize, count: usize) -> &[u64] {
        let stride = self.width.div_ceil(64);
        let rows = self.words.get(first * stride..).unwrap_or_default();
        &rows[..(count * stride).min(rows.len())]
    }

    /// Creates the union of two sets from their words; missing words are empty.
    pub(crate) fn union(width: usize, height: usize, [one, other]: [&[u64]; 2]) -> Self {
        let mut union = Self::new(width, height);
        for words in [one, other] {
            let pairs = union.words.iter_mut().zip(words);
            pairs.for_each(|(all, word)| *all |= word);
        }
        union
    }

    /// Creates the set of the rows of several sets of one width, one below the other.
    pub(crate) fn stacked(width: usize, parts: impl Iterator<Item = Self>) -> Self {
        let mut stacked = Self::new(width, 0);
        for mut part in parts {
            stacked.height += part.height;
            stacked.words.append(&mut part.words);
        }
        stacked
    }

    /// Returns the words of a row.
    #[must_use]
    pub fn row(&self, row: usize) -> &[u64] {
        let stride = self.width.div_ceil(64);
        &self.words[row * stride..][..stride]
    }

    /// Returns the number of boxes that are set.
    #[must_use]
    pub fn count(&self) -> u64 {
        let ones = self.words.iter().map(|word| u64::from(word.count_ones()));
        ones.sum()
    }

    /// Returns `true` if no box is set.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.words.iter().all(|&word| word == 0)
    }

    /// Iterates over the column and row of the boxes that are set, row by row.
    pub fn set_boxes(&self) -> impl Iterator<Item = [usize; 2]> {
        let places = move |row| {
            let words = self.row(row).iter().enumerate();
            words.flat_map(move |(number, &word)| {
                ones(word).map(move |bit| [64 * number + bit as usize, row])
            })
        };
        (0..self.height).flat_map(places)
    }

    /// Returns the number of marked boxes, rounded.
    #[expect(clippy::cast_precision_loss, reason = "counts that large are rounded")]
    pub(crate) fn area(&self) -> f64 {
        self.count() as f64
    }

    /// Returns the set in boxes twice as large. The first box of a row or column covers two smaller ones, or
    /// only one where the grid is shifted.
    #[must_use]
    pub fn folded(&self, shift: [bool; 2]) -> Self {
        let [left, top] = shift.map(usize::from);
        let width = (self.width + left).div_ceil(2);
        let height = (self.height + top).div_ceil(2);
        let mut folded = Self::new(width, height);
        if width == 0 {
            return folded;
        }
        let empty = vec![0; self.width.div_ceil(64)];
        for (number, row) in folded
            .words
            .chunks_exact_mut(width.div_ceil(64))
            .enumerate()
        {
            // One of the two rows may lie outside.
            let below = 2 * number + 1 - top;
            let upper = match below.checked_sub(1) {
                Some(above) => self.row(above),
                None => &empty,
            };
            let lower = if below < self.height {
                self.row(below)
            } else {
                &empty
            };
            fold(upper, lower, left, row);
        }
        folded
    }

    /// Returns the set in boxes `side` times as large, on a grid that begins `shift` boxes (fewer than
    /// `side`) before this one in both directions.
    ///
    /// # Panics
    ///
    /// Panics if a shift is not smaller than the side.
    #[must_use]
    pub fn coarser(&self, side: usize, shift: [usize; 2]) -> Self {
        assert!(
            shift.iter().all(|&shift| shift < side),
            "a shift is less than a box"
        );
        let [left, top] = shift;
        let mut coarser = Self::new(
            (self.width + left).div_ceil(side),
            (self.height + top).div_ceil(side),
        );
        let mut band = vec![0; self.width.div_ceil(64)];
        for row in 0..coarser.height {
            let from = (row * side).saturating_sub(top);
            let to = ((row + 1) * side - top).min(self.height);
            band.fill(0);
            for below in from..to {
                let words = band.iter_mut().zip(self.row(below));
                words.for_each(|(all, word)| *all |= word);
            }
            for column in 0..coarser.width {
                let from = (column * side).saturating_sub(left);
                let to = ((column + 1) * side - left).min(self.width);
                if any(&band, from, to) {
                    coarser.set(column, row);
                }
            }
        }
        coarser
    }
}

/// Compares eight bytes with a threshold: bit n is set if byte n is at or above it. All eight are compared in
/// one word.
#[inline]
fn flags(bytes: [u8; 8], threshold: u8) -> u64 {
    const ONES: u64 = 0x0101_0101_0101_0101;
    const HIGH: u64 = 0x80 * ONES;
    let bytes = u64::from_le_bytes(bytes);
    // The lower seven bits are compared by a subtraction that borrows nothing from the next byte.
    let lower = (bytes | HIGH) - u64::from(threshold & 0x7f) * ONES;
    let reached = if threshold < 0x80 {
        bytes | lower
    } else {
        bytes & lower
    };
    // The product gathers the first bit of every byte in the last one.
    ((reached & HIGH) >> 7).wrapping_mul(0x0102_0408_1020_4080) >> 56
}

/// Returns `true` if a bit in `from..to` is set.
fn any(words: &[u64], from: usize, to: usize) -> bool {
    if from >= to {
        return false;
    }
    let (first, last) = (from / 64, (to - 1) / 64);
    (first..=last).any(|number| {
        let mut word = words[number];
        if number == first {
            word &= u64::MAX << (from % 64);
        }
        if number == last {
            word &= u64::MAX >> (63 - (to - 1) % 64);
        }
        word != 0
    })
}

/// Folds two rows to one row of boxes twice as large.
fn fold(upper: &[u64], lower: &[u64], left: usize, folded: &mut [u64]) {
    let mut carried = 0;
    let mut both = upper.iter().zip(lower).map(|(upper, lower)| {
        let word = upper | lower;
        let shifted = word << left | carried;
        carried = word >> 63 & left as u64;
        u64::from(gathered(shifted | shifted >> 1))
    });
    for word in folded.iter_mut() {
        let low = both.next();
        let high = both.next();
        *word = low.unwrap_or_default() | high.unwrap_or_default() << 32;
    }
    drop(both);
    // The last box may hold only the bit that was shifted out.
    if carried == 1 {
        let words = upper.len();
        folded[words / 2] |= 1 << (32 * (words % 2));
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use proptest::prelude::*;

    use super::Bits;

    type Rectangle = (usize, usize, usize, usize, bool);

    /// Returns pictures up to a size: none, some or all of their pixels are set, singly or as rectangles.
    pub(crate) fn random_bits(width: usize, height: usize) -> impl Strategy<Value = Bits> {
        let size = (1..=width, 1..=height);
        size.prop_flat_map(|(width, height)| {
            let rectangle = (0..width, 0..height, 0..width, 0..height, any::<bool>());
            let dots = prop::collection::vec((0..width, 0..height), 0..30);
            (prop::collection::vec(rectangle, 0..8), dots).prop_map(move |(rectangles, dots)| {
                let is_set = |column: usize, row: usize| {
                    let in_rectangle = |&(x, y, other_x, other_y, _): &Rectangle| {
                        (x.min(other_x)..=x.max(other_x)).contains(&column)
                            && (y.min(other_y)..=y.max(other_y)).contains(&row)
                    };
                    let last = rectangles.iter().rev().find(|it| in_rectangle(it));
                    last.is_some_and(|&(.., set)| set) != dots.contains(&(column, row))
                };
                Bits::of(width, height, is_set)
            })
        })
    }
}
