//! Areas of outlines of limited size, decided for every sample.

use super::polygon::bounds;
use super::{CoverageBuffer, FINE, Position, SAMPLES, cover, index};

/// Maximum number of vertices of an outline whose area is covered.
pub(crate) const MAX_CORNERS: usize = 1 << 12;

/// Maximum number of pixels of its bounding box.
const MAX_PIXELS: i64 = 1 << 14;

/// Winding numbers of an outline about the samples of a pixel, modulo 256; during summation, their
/// differences from those of the pixel to the left.
type Windings = [i8; SAMPLES as usize];

/// Scratch memory for winding numbers.
pub(super) type Scratch = Vec<Windings>;

/// Offsets of samples from the left border of their pixels, by number.
const BESIDE: [f64; SAMPLES as usize] = {
    let mut beside = [0.0; SAMPLES as usize];
    let mut number = 0;
    while number < SAMPLES {
        beside[number as usize] = (super::column(number) as f64 + 0.5) / SAMPLES as f64;
        number += 1;
    }
    beside
};

/// Returns whether an outline is within the limits, so that [`CoverageBuffer::polygon`] covers its area whatever its
/// shape.
pub(crate) fn has_room(vertices: &[Position]) -> bool {
    let [least, most] = bounds(vertices);
    let side = |axis: usize| (most[axis].saturating_sub(least[axis]) / FINE).saturating_add(2);
    (1..=MAX_CORNERS).contains(&vertices.len()) && side(0).saturating_mul(side(1)) <= MAX_PIXELS
}

impl CoverageBuffer {
    /// Covers the area of an outline, the samples with nonzero winding number, if it is within the limits.
    /// Otherwise covers nothing and returns `false`.
    ///
    /// Every sample is decided by itself: every side is followed through the rows of samples, each of which
    /// has one sample of every pixel.
    pub(super) fn area(&mut self, vertices: &[Position]) -> bool {
        if !has_room(vertices) {
            return false;
        }
        let Some([columns, rows]) = self.pixels(bounds(vertices)) else {
            return true;
        };
        if self.is_full(columns, rows) {
            return true;
        }
        let [width, height] = [columns, rows].map(|[first, last]| index(last - first + 1));
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.resize(scratch.len().max(width * height), [0; SAMPLES as usize]);
        follow(
            vertices,
            columns[0],
            rows,
            |row, sample, column, winding| {
                if column < width {
                    let cell = &mut scratch[row * width + column][sample];
                    *cell = cell.wrapping_add(winding);
                }
            },
        );
        for (row, windings) in (rows[0]..=rows[1]).zip(scratch.chunks_exact_mut(width)) {
            let start = self.cell([columns[0], row]);
            let mut all = [0; SAMPLES as usize];
            for (cell, windings) in self.cells[start..start + width].iter().zip(windings) {
                for (sum, more) in all.iter_mut().zip(std::mem::replace(windings, [0; 64])) {
                    *sum = i8::wrapping_add(*sum, more);
                }
                cover(cell, wound(&all));
            }
        }
        self.scratch = scratch;
        self.touched.add(columns, rows);
        true
    }

    /// Covers a convex polygon in at most two columns and two rows, by the same samples as [`CoverageBuffer::area`].
    #[inline]
    pub(super) fn tiny(&mut self, vertices: &[Position], columns: [i64; 2], rows: [i64; 2]) {
        let mut masks = [[0; 2]; 2];
        follow(vertices, columns[0], rows, |row, sample, column, _| {
            // Samples between two sides.
            let [first, second] = &mut masks[row];
            *first ^= u64::from(column == 0) << sample;
            *second ^= u64::from(column <= 1) << sample;
        });
        for (row, masks) in (rows[0]..=rows[1]).zip(masks) {
            for (column, mask) in (columns[0]..=columns[1]).zip(masks) {
                cover(&self.cells[self.cell([column, row])], mask);
            }
        }
        self.touched.add(columns, rows);
    }
}

/// Follows the sides of a polygon through the rows of samples of some rows of pixels. For each crossing,
/// `meet` receives the row of pixels, the row of samples in it, the first column whose sample lies to the
/// right, counted from the first column, and the contribution to the winding numbers.
#[inline]
#[expect(clippy::cast_precision_loss, reason = "columns of a picture")]
fn follow(
    vertices: &[Position],
    first_column: i64,
    rows: [i64; 2],
    mut meet: impl FnMut(usize, usize, usize, i8),
) {
    let left = first_column as f64 - 1.0;
    let lines = [rows[0], rows[1] + 1].map(|row| row * i64::from(SAMPLES));
    let mut before = vertices.last().copied().unwrap_or_default();
    for &vertex in vertices {
        follow_side(before, vertex, left, lines, &mut meet);
        before = vertex;
    }
}

/// Follows one side through the rows of samples from `lines[0]` to before `lines[1]`, always from its upper
/// end, so that both polygons that share it see the same crossings.
#[inline]
#[expect(clippy::cast_precision_loss, reason = "exact on the picture")]
pub(super) fn follow_side(
    from: Position,
    to: Position,
    left: f64,
    lines: [i64; 2],
    mut meet: impl FnMut(usize, usize, usize, i8),
) {
    let is_down = from[1] < to[1];
    let winding = if is_down { 1 } else { -1 };
    let (upper, lower) = if is_down { (from, to) } else { (to, from) };
    // Positions are relative to the end of the side, so that crossings do not depend on the rows.
    let start = line_below(upper[1]);
    let first = start.max(lines[0]);
    let end = line_below(lower[1]).min(lines[1]);
    if first >= end {
        return;
    }
    let slope = (lower[0] as f64 - upper[0] as f64) / (lower[1] as f64 - upper[1] as f64);
    let line = FINE as f64 / f64::from(SAMPLES);
    let down = (start as f64 + 0.5) * line - upper[1] as f64;
    let place = (upper[0] as f64 + down * slope) / FINE as f64 - left;
    let step = slope / f64::from(SAMPLES);
    for number in first..end {
        let sample = index(number) % SAMPLES as usize;
        let crossing = place + (number - start) as f64 * step - BESIDE[sample];
        let row = index(number - lines[0]) / SAMPLES as usize;
        meet(row, sample, whole(crossing), winding);
    }
}

/// Returns the first row of samples at or below a position.
#[inline]
fn line_below(y: i64) -> i64 {
    /// Positions are clamped to this; visible ones are much nearer.
    const FAR: i64 = 1 << 48;
    let samples = i64::from(SAMPLES);
    let y = y.clamp(-FAR, FAR);
    // Samples lie in the middle of their rows, hence the doubled resolution; the quotient is rounded up.
    (2 * samples * y - FINE + 2 * FINE - 1).div_euclid(2 * FINE)
}

/// Returns the samples with nonzero winding number, as bits.
#[inline]
pub(super) fn wound<W: Copy + Default + PartialEq>(windings: &[W; SAMPLES as usize]) -> u64 {
    // Multiplier that gathers eight bytes of 0 or 1 into eight bits.
    const GATHER: u64 = 0x0102_0408_1020_4080;
    let mut bits = [0; 8];
    for (bits, windings) in bits.iter_mut().zip(windings.as_chunks::<8>().0) {
        let ones = windings.map(|winding| u8::from(winding != W::default()));
        *bits = (u64::from_le_bytes(ones).wrapping_mul(GATHER) >> 56) as u8;
    }
    u64::from_le_bytes(bits)
}

#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "what lies to the left becomes the first column"
)]
fn whole(crossing: f64) -> usize {
    crossing as u32 as usize
}
