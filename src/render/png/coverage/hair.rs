//! Hairlines: strokes so thin that their lines would fall between the samples.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use super::pen::part;
use super::{CoverageBuffer, FINE, MARGIN, Position, index};

/// Thin lines close to each other, drawn as one box that is no larger than a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SegmentBatch {
    /// Twice its centre, in hundredths of a pixel.
    pub(crate) middle: [i32; 2],
    /// Width and height, in hundredths of a pixel.
    pub(crate) extent: [u32; 2],
    /// Area of the lines, in pixels.
    pub(crate) area: f32,
    /// Width of the lines, in pixels.
    pub(crate) width: f32,
}

/// Maximum length of the pieces of a line, along either axis, in hundredths of a pixel. With its width, a piece is no
/// longer than a pixel.
const PIECE: i64 = 75;

/// Maximum length of the pieces that lie in four pixels: elsewhere, the absorption of every pixel depends on one
/// coordinate, in which a piece is as even as its box.
const SHORT: i64 = 25;

/// Number of binary places of reciprocals.
const RECIPROCAL_PLACES: u32 = 24;
/// Reciprocals of twice the extents of boxes, with these places.
const RECIPROCALS: [u64; 128] = {
    let mut parts = [0; 128];
    let mut extent = 1;
    while extent < parts.len() {
        parts[extent] = (1 << RECIPROCAL_PLACES) / (2 * extent as u64);
        extent += 1;
    }
    parts
};

/// Number of binary places of positions along a line.
const PLACES: u32 = 16;

/// Stored logarithm of a transmittance of 1 / e.
const UNIT: f32 = (1 << 24) as f32;

/// Pen so thin that its lines would fall between the samples.
///
/// A line absorbs a fraction of a pixel's light. Lines are assumed to be independent of each other within a
/// pixel, so that their transmittances multiply, as in a stack of transparent layers. The logarithms are
/// summed as integers, so that the sum does not depend on the order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HairPen {
    /// Width, in hundredths of a pixel: edges are blurred to whole hundredths.
    width: i64,
    /// Absorption per hundredth of a pixel of length, in `UNIT`s.
    ink: f32,
    /// Length that both ends add to a line, in hundredths of a pixel.
    ends: f32,
}

/// Returns the absorption of a line, as a multiple of the area that it covers: w times this is -ln(1 - w)
/// within 0.1 %, so that a line through a whole pixel absorbs a fraction that equals its width.
#[inline]
fn thickness(w: f32) -> f32 {
    1.0 + w * (0.5 + 0.41 * w)
}

impl HairPen {
    /// Smallest width that is too large, in pixels.
    pub(crate) const TOO_WIDE: f64 = 0.25;

    /// Creates a pen of a width above 0, whose caps extend lines by `cap` widths at each end.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "hairs are thin, and need no more than f32"
    )]
    pub(crate) fn new(width: f64, cap: f64) -> Self {
        let w = width as f32;
        let ink = w * thickness(w);
        let fine = FINE as f32;
        Self {
            width: ((width * FINE as f64 + 0.5) as i64).max(1),
            ink: ink * (UNIT / fine),
            ends: cap as f32 * w * (2.0 * fine),
        }
    }
}

/// Absorption by cell; empty until a hairline is drawn.
///
/// Atomic for the same reason as the cells of samples.
#[derive(Default)]
pub(super) struct Hairs {
    cells: Vec<AtomicU32>,
}

impl Hairs {
    /// Returns the absorption of a cell, in `UNIT`s, and clears the cell.
    #[inline]
    pub(super) fn take(&self, cell: usize) -> u32 {
        let Some(cell) = self.cells.get(cell) else {
            return 0;
        };
        let taken = cell.load(Relaxed);
        if taken != 0 {
            cell.store(0, Relaxed);
        }
        taken
    }

    /// Returns whether any of some cells absorbs anything.
    #[inline]
    pub(super) fn has_any(&self, cells: Range<usize>) -> bool {
        let cells = self.cells.get(cells).unwrap_or_default();
        cells.iter().fold(0, |all, cell| all | cell.load(Relaxed)) != 0
    }

    fn make_room(&mut self, count: usize) {
        self.cells = bytemuck::zeroed_vec(count);
    }

    /// Returns whether no cell absorbs anything.
    #[cfg(test)]
    pub(super) fn is_clear(&self) -> bool {
        self.cells.iter().all(|cell| cell.load(Relaxed) == 0)
    }
}

/// Returns the fraction of a pixel's light that hairlines absorb, from their absorption.
#[inline]
pub(super) fn absorbed(taken: u32) -> f32 {
    if taken == 0 {
        return 0.0;
    }
    #[expect(clippy::cast_precision_loss, reason = "seven digits are enough")]
    let taken = taken as f32;
    -libm::expm1f(-taken / UNIT)
}

#[inline]
fn add(cell: &AtomicU32, ink: u32) {
    cell.store(cell.load(Relaxed).saturating_add(ink), Relaxed);
}

impl CoverageBuffer {
    /// Draws a line of a hairline pen. `ends` adds the length of both ends, for the first line of a path.
    #[inline]
    pub(crate) fn hair(&mut self, pen: &HairPen, from: Position, to: Position, ends: bool) {
        if self.hairs.cells.is_empty() {
            self.hairs.make_room(self.cells.len());
        }
        if self.is_near(from) && self.is_near(to) {
            self.near_hair(pen, from, to, ends);
        } else if let Some([from, to]) = self.clipped(from, to) {
            self.near_hair(pen, from, to, ends);
        }
    }

    /// Draws a segment batch.
    #[inline]
    pub(crate) fn batch(&mut self, batch: &SegmentBatch) {
        if self.hairs.cells.is_empty() {
            self.hairs.make_room(self.cells.len());
        }
        let extent = batch.extent.map(|extent| i64::from(extent).clamp(1, FINE));
        let ink = batch.area * thickness(batch.width) * UNIT;
        self.blot(batch.middle.map(i64::from), extent, [0; 2], whole(ink));
    }

    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "no more than the width of the pen"
    )]
    fn near_hair(&mut self, pen: &HairPen, from: Position, to: Position, ends: bool) {
        let way = [to[0] - from[0], to[1] - from[1]];
        let [across, down] = way.map(|along| along as f32);
        let length = (across * across + down * down).sqrt();
        let ends = if ends { pen.ends } else { 0.0 };
        // Extent of the line's width along both axes.
        let broad = if length > 0.0 {
            let broad = pen.width as f32 / length;
            [down, across].map(|other| (other.abs() * broad + 0.5) as i64)
        } else {
            [pen.width; 2]
        };
        // Twice the centre, so that halves are whole numbers.
        let middle = [from[0] + to[0], from[1] + to[1]];
        let extent = way.map(i64::abs);
        let longest = extent[0].max(extent[1]);
        if longest <= PIECE {
            let ink = (length + ends) * pen.ink;
            let extent = [0, 1].map(|axis| extent[axis] + broad[axis]);
            self.blot(middle, extent, way, whole(ink));
        } else {
            // The ends are drawn at the start of the line, so that its other pieces do not depend on them.
            if ends > 0.0 {
                let ink = whole(ends * pen.ink);
                self.blot(from.map(|at| 2 * at), [pen.width; 2], [0; 2], ink);
            }
            let pieces = (longest + PIECE - 1) / PIECE;
            let ink = whole(length * pen.ink / pieces as f32);
            let step = way.map(|along| part(along << (PLACES + 1), pieces));
            let way = step.map(|step| (step + (1 << PLACES)) >> (PLACES + 1));
            let extent = [0, 1].map(|axis| way[axis].abs() + broad[axis]);
            let mut at = [0, 1].map(|axis| (from[axis] << (PLACES + 1)) + step[axis] / 2);
            for _ in 0..pieces {
                self.blot(at.map(|place| place >> PLACES), extent, way, ink);
                at = [at[0] + step[0], at[1] + step[1]];
            }
        }
    }

    /// Spreads absorption over a box no larger than a pixel, given by twice its centre and by its extent. If the box is that
    /// of a line, `way` leads from one end of the line to the other.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "parts of an ink")]
    fn blot(&mut self, middle: [i64; 2], extent: [i64; 2], way: [i64; 2], ink: u32) {
        let first = [MARGIN, MARGIN - self.top];
        let least = [0, 1].map(|axis| middle[axis] - extent[axis] + 2 * FINE * first[axis]);
        // Negative positions become larger than any buffer.
        let cell = least.map(|least| index(least) / (2 * FINE) as usize);
        let [max_columns, max_rows] = self.size.map(|side| index(side + 2 * MARGIN) - 2);
        if cell[0] > max_columns || cell[1] > max_rows {
            return;
        }
        let within = [0, 1].map(|axis| least[axis] - cell[axis] as i64 * 2 * FINE);
        let beyond = [0, 1].map(|axis| within[axis] + 2 * extent[axis] - 2 * FINE);
        if beyond[0] > 0 && beyond[1] > 0 && way[0].abs().max(way[1].abs()) > SHORT {
            return self.blot_halves(middle, extent, way, ink);
        }
        let [column, row] = [0, 1].map(|axis| cell[axis] as i64 - first[axis]);
        self.touched.add([column, column + 1], [row, row + 1]);
        let start = cell[1] * self.stride + cell[0];
        let cells = &self.hairs.cells[start..start + self.stride + 2];
        if beyond[0] <= 0 && beyond[1] <= 0 {
            add(&cells[0], ink);
            return;
        }
        let share = |axis: usize, ink: u32| {
            let beyond =
                beyond[axis].max(0) as u64 * RECIPROCALS[index(extent[axis]) % RECIPROCALS.len()];
            ((u64::from(ink) * beyond) >> RECIPROCAL_PLACES) as u32
        };
        let lower = share(1, ink);
        let [upper_right, lower_right] = [ink - lower, lower].map(|ink| share(0, ink));
        add(&cells[0], ink - lower - upper_right);
        add(&cells[1], upper_right);
        add(&cells[self.stride], lower - lower_right);
        add(&cells[self.stride + 1], lower_right);
    }

    /// Spreads the absorption of a line over the boxes of its halves.
    fn blot_halves(&mut self, middle: [i64; 2], extent: [i64; 2], way: [i64; 2], ink: u32) {
        let half = way.map(|along| along / 2);
        let extent = [0, 1].map(|axis| extent[axis] - half[axis].abs());
        // The centre is doubled.
        let [before, after] =
            [-1, 1].map(|side| [0, 1].map(|axis| middle[axis] + side * half[axis]));
        self.blot(before, extent, half, ink / 2);
        self.blot(after, extent, half, ink - ink / 2);
    }
}

/// Returns an absorption in whole `UNIT`s.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
fn whole(ink: f32) -> u32 {
    ink as u32
}
