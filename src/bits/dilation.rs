//! Dilation and erosion of sets of boxes by squares, and their restriction to their extent.

use std::borrow::Cow;
use std::num::NonZero;

use crate::parallel::for_each;

use super::Bits;

/// Minimum number of rows per thread.
const ROWS: usize = 1 << 9;

impl Bits {
    /// Returns the smallest part that holds all boxes that are set; empty if none is.
    pub(crate) fn cropped(&self) -> Cow<'_, Self> {
        let is_empty = |row: &usize| self.row(*row).iter().all(|&word| word == 0);
        let above = (0..self.height).take_while(is_empty).count();
        let below = (above..self.height).rev().take_while(is_empty).count();
        let rows = above..self.height - below;
        let mut all = vec![0; self.width.div_ceil(64)];
        for row in rows.clone() {
            let words = all.iter_mut().zip(self.row(row));
            words.for_each(|(all, word)| *all |= word);
        }
        let first = all.iter().position(|&word| word != 0);
        let last = all.iter().rposition(|&word| word != 0);
        let (Some(first), Some(last)) = (first, last) else {
            return Cow::Owned(Self::new(0, 0));
        };
        let left = 64 * first + all[first].trailing_zeros() as usize;
        let right = 64 * last + 64 - all[last].leading_zeros() as usize;
        if (left, right, rows.len()) == (0, self.width, self.height) {
            return Cow::Borrowed(self);
        }
        let corner = [left, above].map(usize::cast_signed);
        Cow::Owned(self.window(corner, right - left, rows.len()))
    }

    /// Returns bands of rows, evenly spread and separated by empty rows, if there are more than 2¹⁸ words;
    /// else the set itself.
    pub(crate) fn bands(&self) -> Cow<'_, Self> {
        const MAX_WORDS: usize = 1 << 18;
        const BAND: usize = 256;
        const PARTED: usize = 8;
        let stride = self.width.div_ceil(64);
        let every = self.words.len().div_ceil(MAX_WORDS).max(1);
        if every == 1 {
            return Cow::Borrowed(self);
        }
        let bands = self.words.chunks(BAND * stride).step_by(every);
        let mut some = Self::new(self.width, 0);
        for band in bands {
            some.words.extend_from_slice(band);
            some.words.extend(std::iter::repeat_n(0, PARTED * stride));
        }
        some.height = some.words.len() / stride;
        Cow::Owned(some)
    }

    /// Joins every box with the boxes that lie `more` to the right, below, and both: squares with a side of
    /// at least `more` boxes grow by `more`.
    ///
    /// # Panics
    ///
    /// Panics if `more` is not from 1 to 63.
    pub(crate) fn dilated(&self, more: usize, threads: NonZero<usize>) -> Self {
        assert!((1..64).contains(&more), "words are shifted by less than 64");
        let mut dilated = Self::new(self.width + more, self.height + more);
        let stride = dilated.width.div_ceil(64);
        let threads = threads.get().min(dilated.height.div_ceil(ROWS)).max(1);
        let band = dilated.height.div_ceil(threads).max(1);
        let bands = dilated.words.chunks_mut(band * stride).enumerate();
        for_each(bands, threads, |(number, words)| {
            self.dilate(more, number * band, words, stride);
        });
        dilated
    }

    /// Fills the rows of a dilated set from row `from` on.
    fn dilate(&self, more: usize, from: usize, words: &mut [u64], stride: usize) {
        let empty = vec![0; self.width.div_ceil(64)];
        let row = |row: Option<usize>| match row {
            Some(row) if row < self.height => self.row(row),
            _ => &empty,
        };
        for (number, words) in words.chunks_exact_mut(stride).enumerate() {
            let number = from + number;
            let (here, above) = (row(Some(number)), row(number.checked_sub(more)));
            let mut carried = 0;
            for (word, (here, above)) in words.iter_mut().zip(here.iter().zip(above)) {
                let both = here | above;
                *word = both | both << more | carried;
                carried = both >> (64 - more);
            }
            if let Some(word) = words.get_mut(here.len()) {
                *word = carried;
            }
        }
    }

    /// Returns the upper left boxes of all filled squares of `side` boxes.
    ///
    /// # Panics
    ///
    /// Panics if the side is not from 1 to 63.
    pub(crate) fn eroded(&self, side: usize) -> Self {
        assert!((1..64).contains(&side), "words are shifted by less than 64");
        let mut eroded = self.clone();
        let stride = self.width.div_ceil(64);
        if stride == 0 {
            return eroded;
        }
        let mut inner = vec![0; stride];
        for row in 0..self.height {
            // Boxes outside are not set.
            inner.fill(if row + side <= self.height {
                u64::MAX
            } else {
                0
            });
            for below in row..(row + side).min(self.height) {
                let words = inner.iter_mut().zip(self.row(below));
                words.for_each(|(inner, word)| *inner &= word);
            }
            let words = &mut eroded.words[row * stride..][..stride];
            for (number, word) in words.iter_mut().enumerate() {
                let next = inner.get(number + 1).copied().unwrap_or_default();
                *word = (1..side).fold(inner[number], |word, shift| {
                    word & (inner[number] >> shift | next << (64 - shift))
                });
            }
        }
        eroded
    }
}
