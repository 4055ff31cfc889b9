//! Parts of sets of boxes, and sets with room around them.

use super::Bits;

impl Bits {
    /// Returns the boxes of a window whose upper left box is at a column and row, which may be negative; boxes
    /// outside the set's own are empty.
    #[must_use]
    pub fn window(&self, [left, top]: [isize; 2], width: usize, height: usize) -> Self {
        let mut window = Self::new(width, height);
        let stride = width.div_ceil(64);
        if stride == 0 {
            return window;
        }
        let last = u64::MAX >> (width.wrapping_neg() % 64);
        for (number, words) in window.words.chunks_exact_mut(stride).enumerate() {
            let Some(row) = top.checked_add_unsigned(number) else {
                break;
            };
            let Some(row) = usize::try_from(row).ok().filter(|&row| row < self.height) else {
                continue;
            };
            let row = self.row(row);
            let mut column = left;
            for word in &mut *words {
                *word = word_at(row, column);
                column = column.saturating_add(64);
            }
            words[stride - 1] &= last;
        }
        window
    }

    /// Returns the boxes that are not set.
    #[must_use]
    pub fn complement(&self) -> Self {
        let mut complement = self.clone();
        let stride = self.width.div_ceil(64);
        if stride > 0 {
            let last = u64::MAX >> (self.width.wrapping_neg() % 64);
            for words in complement.words.chunks_exact_mut(stride) {
                words.iter_mut().for_each(|word| *word = !*word);
                words[stride - 1] &= last;
            }
        }
        complement
    }

    /// Returns the number of boxes that are set in one of two sets of one size, and not in the other.
    #[must_use]
    pub fn difference(&self, other: &Self) -> u64 {
        let pairs = self.words.iter().zip(&other.words);
        let ones = pairs.map(|(one, other)| u64::from((one ^ other).count_ones()));
        ones.sum()
    }

    /// Adds the boxes of a set of the same size.
    pub fn add(&mut self, other: &Self) {
        let pairs = self.words.iter_mut().zip(&other.words);
        pairs.for_each(|(all, word)| *all |= word);
    }

    /// Removes the boxes of a set of the same size.
    pub fn remove(&mut self, other: &Self) {
        let pairs = self.words.iter_mut().zip(&other.words);
        pairs.for_each(|(rest, word)| *rest &= !word);
    }

    /// Keeps the boxes that are also in a set of the same size.
    pub fn keep(&mut self, other: &Self) {
        let pairs = self.words.iter_mut().zip(&other.words);
        pairs.for_each(|(rest, word)| *rest &= word);
    }

    /// Sets the boxes of a row from a column up to another; columns outside are left out.
    pub fn set_span(&mut self, row: usize, from: usize, to: usize) {
        let to = to.min(self.width);
        if row >= self.height || from >= to {
            return;
        }
        let stride = self.width.div_ceil(64);
        let words = &mut self.words[row * stride..][..stride];
        let (first, last) = (from / 64, (to - 1) / 64);
        let (head, tail) = (u64::MAX << (from % 64), u64::MAX >> (63 - (to - 1) % 64));
        if first == last {
            words[first] |= head & tail;
        } else {
            words[first] |= head;
            words[first + 1..last].fill(u64::MAX);
            words[last] |= tail;
        }
    }
}

/// Returns the 64 bits of a row from a column on, which may be outside.
fn word_at(row: &[u64], column: isize) -> u64 {
    let get = |word: isize| {
        let word = usize::try_from(word).ok().and_then(|word| row.get(word));
        word.copied().unwrap_or_default()
    };
    let (word, shift) = (column.div_euclid(64), column.rem_euclid(64));
    match shift {
        0 => get(word),
        shift => get(word) >> shift | get(word + 1) << (64 - shift),
    }
}
