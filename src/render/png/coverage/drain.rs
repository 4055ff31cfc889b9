//! Draining of coverage buffers: the coverage of every pixel, row by row, on any thread.

use std::ops::Range;
use std::sync::atomic::Ordering::Relaxed;

use super::{CoverageBuffer, MARGIN, SAMPLES, Touched, WHOLE, index};

/// Number of cells that are worth a thread.
const WORTH: usize = 1 << 16;

/// Number of cells of a row that are passed over at once where nothing is covered.
const BLANK: usize = 16;

/// Coverage of buffers for the same rows of a picture, which is taken from them row by row.
///
/// Samples of the buffers are united and absorptions added, so that the division of paths between buffers
/// has no effect.
pub(crate) struct Drain<'b> {
    buffers: Vec<&'b CoverageBuffer>,
    /// Rows and columns, including margins, where anything may be covered.
    rows: Range<usize>,
    columns: Range<usize>,
    /// Width and number of the rows, in pixels.
    size: [usize; 2],
}

/// Pixels of some rows.
pub(crate) struct Block<'p, T> {
    /// First row, of those with margins.
    row: usize,
    pixels: &'p mut [T],
}

impl<'b> Drain<'b> {
    /// Begins to drain buffers of one size; `None` if there are none.
    pub(crate) fn of(buffers: impl IntoIterator<Item = &'b mut CoverageBuffer>) -> Option<Self> {
        let mut touched = Touched::NOTHING;
        let mut take = |buffer: &'b mut CoverageBuffer| {
            let Touched { columns, rows } = buffer.touched;
            touched.add(columns, rows);
            buffer.touched = Touched::NOTHING;
            &*buffer
        };
        let buffers: Vec<_> = buffers.into_iter().map(&mut take).collect();
        let first = *buffers.first()?;
        let [rows, columns] = first.cells_in(touched);
        Some(Self {
            rows,
            columns,
            size: first.size.map(index),
            buffers,
        })
    }

    /// Clears the margins, and divides the pixels that may be covered, which are given row by row, into blocks
    /// that are worth a thread each.
    pub(crate) fn blocks<'p, T>(&self, pixels: &'p mut [T]) -> impl Iterator<Item = Block<'p, T>> {
        let Self { rows, size, .. } = self;
        let margin = index(MARGIN);
        let [from, to] = [rows.start, rows.end].map(|row| row.clamp(margin, margin + size[1]));
        (rows.start..from.min(rows.end)).for_each(|row| self.row(row, |_, _| {}));
        (to.max(rows.start)..rows.end).for_each(|row| self.row(row, |_, _| {}));
        let step = WORTH.div_ceil(self.columns.len().max(1));
        let pixels = &mut pixels[(from - margin) * size[0]..(to - margin) * size[0]];
        let blocks = pixels.chunks_mut(step * size[0]);
        let blocks = (from..).step_by(step).zip(blocks);
        blocks.map(|(row, pixels)| Block { row, pixels })
    }

    /// Calls `paint` with every covered pixel of a block and its coverage, and clears it.
    pub(crate) fn paint<T>(&self, block: Block<'_, T>, paint: impl Fn(&mut T, u32)) {
        let rows = block.pixels.chunks_exact_mut(self.size[0]);
        for (row, pixels) in (block.row..).zip(rows) {
            self.row(row, |column, covered| {
                if let Some(pixel) = pixels.get_mut(column.wrapping_sub(index(MARGIN))) {
                    paint(pixel, covered);
                }
            });
        }
    }

    /// Calls `paint` with the column and the coverage of the covered cells of a row, and clears them.
    fn row(&self, row: usize, mut paint: impl FnMut(usize, u32)) {
        let Some(stride) = self.buffers.first().map(|buffer| buffer.stride) else {
            return;
        };
        let start = row * stride;
        for first in self.columns.clone().step_by(BLANK) {
            let end = self.columns.end.min(first + BLANK);
            let cells = start + first..start + end;
            let has = |buffer: &&CoverageBuffer| buffer.has_any(cells.clone());
            if !self.buffers.iter().any(has) {
                continue;
            }
            for column in first..end {
                let cell = start + column;
                let taken = self.buffers.iter().map(|buffer| buffer.take(cell));
                let (samples, absorbed) = taken.fold((0, 0), |(samples, absorbed), taken| {
                    (samples | taken.0, u32::saturating_add(absorbed, taken.1))
                });
                if samples == 0 && absorbed == 0 {
                    continue;
                }
                let covered = covered(samples.count_ones(), super::hair::absorbed(absorbed));
                if covered > 0 {
                    paint(column, covered);
                }
            }
        }
    }
}

impl CoverageBuffer {
    /// Returns whether any of some cells is covered. Most cells are not.
    #[inline]
    fn has_any(&self, cells: Range<usize>) -> bool {
        let samples = self.cells[cells.clone()].iter();
        let covered = samples.fold(0, |all, cell| all | cell.load(Relaxed)) != 0;
        covered || self.hairs.has_any(cells)
    }

    /// Returns the samples and the absorption of a cell, and clears it.
    #[inline]
    fn take(&self, cell: usize) -> (u64, u32) {
        let samples = self.cells[cell].load(Relaxed);
        if samples != 0 {
            self.cells[cell].store(0, Relaxed);
        }
        (samples, self.hairs.take(cell))
    }
}

/// Returns the coverage of a pixel from its covered samples and from the covered fraction of the rest.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "no more than `WHOLE`, and exact"
)]
fn covered(samples: u32, part: f32) -> u32 {
    let free = WHOLE - samples * (WHOLE / SAMPLES);
    WHOLE - free + (free as f32 * part + 0.5) as u32
}

#[cfg(test)]
impl CoverageBuffer {
    /// Returns the coverage of every pixel, row by row, and clears the buffer.
    pub(crate) fn drained(&mut self) -> Vec<u32> {
        drained(std::slice::from_mut(self))
    }
}

/// Returns the coverage of every pixel of buffers of one size, row by row, and clears the buffers.
#[cfg(test)]
pub(crate) fn drained(buffers: &mut [CoverageBuffer]) -> Vec<u32> {
    let [width, height] = buffers[0].size.map(index);
    let mut pixels = vec![0; width * height];
    let drain = Drain::of(&mut *buffers).unwrap();
    let blocks = drain.blocks(&mut pixels);
    blocks.for_each(|block| drain.paint(block, |pixel, covered| *pixel = covered));
    let is_clear = |buffer: &CoverageBuffer| {
        let cells = buffer.cells.iter().all(|cell| cell.load(Relaxed) == 0);
        cells && buffer.hairs.is_clear()
    };
    assert!(buffers.iter().all(is_clear));
    pixels
}
