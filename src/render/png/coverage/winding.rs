//! Areas of any size, from the winding numbers of outlines around the samples of some rows of pixels.
//!
//! Only pixels that a side crosses are processed one by one; the winding numbers are constant between them.

use super::area::{follow_side, wound};
use super::{CoverageBuffer, Position, SAMPLES, cover, index};

/// Number for each sample of a pixel.
type Samples = [i16; SAMPLES as usize];

/// Scratch memory for winding numbers.
#[derive(Default)]
pub(super) struct Windings {
    /// Differences of winding numbers between the samples of a pixel and those of its left neighbour, by
    /// rows; all zero except while an area is covered.
    pixels: Vec<Samples>,
    /// Pixels whose differences may be nonzero, as bits, by rows.
    marks: Vec<u64>,
}

impl CoverageBuffer {
    /// Covers the samples with nonzero winding number, modulo 2^16, in the rows of pixels from `first` to
    /// `last`. The sides of the closed outlines may come in any order.
    pub(crate) fn wound_around(
        &mut self,
        [first, last]: [i64; 2],
        sides: impl Iterator<Item = [Position; 2]>,
    ) {
        let rows = [first.max(self.top), last.min(self.top + self.size[1] - 1)];
        if rows[0] > rows[1] || self.size[0] == 0 {
            return;
        }
        let mut windings = std::mem::take(&mut self.windings);
        let (width, height) = (index(self.size[0]), index(rows[1] - rows[0] + 1));
        windings.follow([width, height], rows, sides);
        for row in 0..height {
            self.cover_wound(&mut windings, width, rows[0], row);
        }
        self.windings = windings;
        self.touched.add([0, self.size[0] - 1], rows);
    }

    /// Covers one row and clears its differences.
    fn cover_wound(&mut self, windings: &mut Windings, width: usize, top: i64, row: usize) {
        let words = width.div_ceil(64);
        let marks = &mut windings.marks[row * words..][..words];
        let pixels = &mut windings.pixels[row * width..][..width];
        let line = i64::try_from(row).unwrap_or(i64::MAX);
        let start = self.cell([0, top + line]);
        let cells = &self.cells[start..start + width];
        let (mut sum, mut mask, mut done) = ([0; SAMPLES as usize], 0, 0);
        let fill = |from: usize, to: usize, mask: u64| {
            if mask != 0 {
                cells[from..to].iter().for_each(|cell| cover(cell, mask));
            }
        };
        for (word, bits) in marks.iter_mut().enumerate() {
            let mut bits = std::mem::take(bits);
            while bits != 0 {
                let column = 64 * word + bits.trailing_zeros() as usize;
                bits &= bits - 1;
                fill(done, column, mask);
                for (sum, more) in sum.iter_mut().zip(&mut pixels[column]) {
                    *sum = i16::wrapping_add(*sum, std::mem::take(more));
                }
                mask = wound(&sum);
                done = column;
            }
        }
        fill(done, width, mask);
    }
}

impl Windings {
    /// Adds the crossings of sides with the rows of samples.
    fn follow(
        &mut self,
        [width, height]: [usize; 2],
        rows: [i64; 2],
        sides: impl Iterator<Item = [Position; 2]>,
    ) {
        let words = width.div_ceil(64);
        let room = |used: usize, needed: usize| used.max(needed);
        let (pixels, marks) = (self.pixels.len(), self.marks.len());
        self.pixels
            .resize(room(pixels, width * height), [0; SAMPLES as usize]);
        self.marks.resize(room(marks, words * height), 0);
        let lines = [rows[0], rows[1] + 1].map(|row| row * i64::from(SAMPLES));
        sides.for_each(|[from, to]| {
            follow_side(from, to, -1.0, lines, |row, sample, column, winding| {
                if column < width {
                    let more = &mut self.pixels[row * width + column][sample];
                    *more = more.wrapping_add(i16::from(winding));
                    self.marks[row * words + column / 64] |= 1 << (column % 64);
                }
            });
        });
    }
}
