//! The first pass of the distance transform: the nearest set pixel in the same column.

use crate::bits::Bits;
use crate::saturating::ones;

/// Mark of a column without set pixels.
pub(super) const NONE: u32 = u32::MAX;

/// The rows of the set pixels that are next in each column.
pub(in crate::morphology) struct Columns(Vec<u32>);

impl Columns {
    /// Fills rows from `first` on with the row of the nearest set pixel of each column, the upper one of two, or
    /// [`NONE`].
    pub(in crate::morphology) fn fill(set: &Bits, first: usize, nearest: &mut [u32]) {
        let width = set.width();
        let rows = nearest.len() / width;
        let mut above = Self::next(set, (0..first).rev());
        for (row, nearest) in (first..).zip(nearest.chunks_exact_mut(width)) {
            above.pass(set, row);
            nearest.copy_from_slice(&above.0);
        }
        let mut below = Self::next(set, first + rows..set.height());
        for (row, nearest) in nearest.chunks_exact_mut(width).enumerate().rev() {
            let row = first + row;
            below.pass(set, row);
            let row = number(row);
            for (nearest, &below) in nearest.iter_mut().zip(&below.0) {
                // With rows below 2¹⁶, a missing one is farther than all others.
                let is_nearer = below - row < row.abs_diff(*nearest);
                *nearest = if is_nearer { below } else { *nearest };
            }
        }
    }

    /// Finds the first set pixel of each column in some rows.
    fn next(set: &Bits, rows: impl Iterator<Item = usize>) -> Self {
        let mut next = vec![NONE; set.width()];
        let mut missing = vec![u64::MAX; set.width().div_ceil(64)];
        if let Some(last) = missing.last_mut() {
            *last >>= set.width().wrapping_neg() % 64;
        }
        for row in rows {
            let mut all = 0;
            for (word, (missing, &bits)) in missing.iter_mut().zip(set.row(row)).enumerate() {
                for bit in ones(*missing & bits) {
                    next[64 * word + bit as usize] = number(row);
                }
                *missing &= !bits;
                all |= *missing;
            }
            if all == 0 {
                break;
            }
        }
        Self(next)
    }

    /// Notes the set pixels of a row.
    fn pass(&mut self, set: &Bits, row: usize) {
        for (next, &bits) in self.0.chunks_mut(64).zip(set.row(row)) {
            if bits == u64::MAX {
                next.fill(number(row));
            } else {
                ones(bits).for_each(|bit| next[bit as usize] = number(row));
            }
        }
    }
}

/// Returns a row of a picture whose sides are below 2¹⁶.
#[expect(clippy::cast_possible_truncation, reason = "sides are below 2¹⁶")]
fn number(row: usize) -> u32 {
    row as u32
}
