//! Coverage of pixels: sixty-four samples in each, as the bits of a number.
//!
//! What is drawn sets the bits of the samples that it covers. What covers a sample twice leaves
//! it covered once, so overlaps of any number add no ink, and neither order nor division of the
//! work shows. The mask method is Carpenter's (The A-buffer, 1984). Lines so thin that they would
//! fall between the samples are summed beside them, in a way that has no order either.

mod area;
mod curve;
mod hair;
mod least;
mod pen;
mod polygon;
mod stamp;
#[cfg(test)]
mod tests;
mod winding;

use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

pub(crate) use area::{MOST_CORNERS, has_room};
pub(crate) use curve::{bounding, bounding_within, flattened, flattened_within};
pub(crate) use hair::HairPen;
use hair::Hairs;
pub(crate) use pen::RoundPen;
pub(crate) use stamp::{Sheet, Stamp};

/// A position in hundredths of a pixel.
type Position = [i64; 2];

/// Units of positions to a pixel.
const FINE: i64 = 100;

/// The samples of a pixel: as many as a cell has bits.
const SAMPLES: u32 = u64::BITS;

/// Coverage of a whole pixel.
pub(crate) const WHOLE: u32 = SAMPLES << 8;

/// Pixels around the picture that are drawn on and never seen, so that nothing that touches the
/// picture needs to be cut.
pub(crate) const MARGIN: i64 = 5;

/// Where sample `number` lies in its pixel. The samples form a lattice; no two of them share a
/// row or a column, so that edges that are nearly level, or upright, have 65 shades too.
fn sample(number: u32) -> [f64; 2] {
    // Of all lattices of this kind one whose shortest vectors are longest.
    [column(number), number].map(|place| (f64::from(place) + 0.5) / f64::from(SAMPLES))
}

/// The column of a sample; its row is its number.
const fn column(number: u32) -> u32 {
    number * 19 % SAMPLES
}

/// The samples, as bits, for which `covers` holds.
fn mask(covers: impl Fn([f64; 2]) -> bool) -> u64 {
    (0..SAMPLES).fold(0, |mask, number| {
        mask | (u64::from(covers(sample(number))) << number)
    })
}

/// Which samples of a picture are covered.
pub(crate) struct Plane {
    /// Width and height in pixels, of the picture and of the rows that the plane has of it,
    picture: [i64; 2],
    size: [i64; 2],
    /// of which this is the first.
    top: i64,
    /// The cells of a row, the margins' among them.
    stride: usize,
    /// By rows. Atomic so that the compiler does not join neighbours into wider stores: prints
    /// overlap, and to load what was stored in other portions takes a processor long. Shared so that
    /// others see what is covered all over.
    cells: Arc<[AtomicU64]>,
    /// What is thinner than that.
    hairs: Hairs,
    touched: Touched,
    scratch: area::Scratch,
    windings: winding::Windings,
}

/// The pixels outside of which nothing has been covered: first and last column, first and last row.
#[derive(Clone, Copy)]
struct Touched {
    columns: [i64; 2],
    rows: [i64; 2],
}

impl Touched {
    const NOTHING: Self = Self {
        columns: [i64::MAX, i64::MIN],
        rows: [i64::MAX, i64::MIN],
    };

    #[inline]
    fn add(&mut self, [left, right]: [i64; 2], [top, bottom]: [i64; 2]) {
        let [first, last] = self.columns;
        self.columns = [first.min(left), last.max(right)];
        let [first, last] = self.rows;
        self.rows = [first.min(top), last.max(bottom)];
    }
}

impl Plane {
    /// Bytes that a pixel takes.
    pub(crate) const BYTES: u64 = 12;

    /// A plane where nothing is covered.
    #[cfg(test)]
    pub(crate) fn new(size: [u32; 2]) -> Self {
        Self::of_rows(size, 0..size[1])
    }

    /// One of some rows of a picture. Positions are those in the picture, and what is covered is
    /// what the plane of all of it would have covered in these rows.
    pub(crate) fn of_rows([width, height]: [u32; 2], rows: Range<u32>) -> Self {
        let picture = [i64::from(width), i64::from(height)];
        let top = i64::from(rows.start);
        let size = [picture[0], i64::from(rows.end) - top];
        let [stride, rows] = size.map(|side| index(side + 2 * MARGIN));
        Self {
            picture,
            size,
            top,
            stride,
            cells: (0..stride * rows).map(|_| AtomicU64::new(0)).collect(),
            hairs: Hairs::default(),
            touched: Touched::NOTHING,
            scratch: Vec::new(),
            windings: winding::Windings::default(),
        }
    }

    /// Returns the width and height of the picture, in pixels.
    pub(crate) fn picture(&self) -> [i64; 2] {
        self.picture
    }

    /// Has other rows of the picture, as many from this one on. Nothing may be covered.
    pub(crate) fn move_to(&mut self, top: u32) {
        self.top = top.into();
    }

    /// The samples that are covered, by pixel, by rows, with a margin of [`MARGIN`] around the picture.
    pub(crate) fn cells(&self) -> Arc<[AtomicU64]> {
        Arc::clone(&self.cells)
    }

    /// The rows and columns, the margins among them, where something may be covered, which is then
    /// forgotten.
    fn take_touched(&mut self) -> [Range<usize>; 2] {
        let Touched { columns, rows } = std::mem::replace(&mut self.touched, Touched::NOTHING);
        let rows = rows.map(|row| row.saturating_sub(self.top));
        let range = |[first, last]: [i64; 2], side: i64| {
            let (first, last) = (first.max(-MARGIN), last.min(side + MARGIN - 1));
            if first > last {
                return 0..0;
            }
            index(first + MARGIN)..index(last + MARGIN + 1)
        };
        [range(rows, self.size[1]), range(columns, self.size[0])]
    }

    /// Covers what another plane of the same size does, which it then no longer does. In which order
    /// planes come does not show.
    pub(crate) fn take_over(&mut self, other: &mut Self) {
        let touched = other.touched;
        self.touched.add(touched.columns, touched.rows);
        self.hairs.make_room_for(&other.hairs);
        let [rows, columns] = other.take_touched();
        for row in rows {
            let start = row * self.stride;
            let cells = start + columns.start..start + columns.end;
            let others = &other.cells[cells.clone()];
            for (cell, other) in self.cells[cells.clone()].iter().zip(others) {
                let samples = other.load(Relaxed);
                if samples > 0 {
                    cover(cell, samples);
                    other.store(0, Relaxed);
                }
            }
            self.hairs.take_over(&mut other.hairs, cells);
        }
    }

    /// Gives every pixel that is covered with how much of it is, in any order, and uncovers all.
    /// Pixels are numbered by rows.
    pub(crate) fn drain(&mut self, mut paint: impl FnMut(usize, u32)) {
        let [rows, columns] = self.take_touched();
        let [width, height] = self.size.map(index);
        let margin = index(MARGIN);
        let has_hairs = !self.hairs.is_empty();
        // The margins are uncovered with the rest.
        let seen = margin..margin + width;
        for row in rows {
            let start = row * self.stride;
            let shown = (margin..margin + height).contains(&row);
            let cells = start + columns.start..start + columns.end;
            for (column, cell) in columns.clone().zip(&self.cells[cells]) {
                let samples = cell.load(Relaxed).count_ones();
                // Most cells of many layers are empty.
                if samples == 0 && !has_hairs {
                    continue;
                }
                cell.store(0, Relaxed);
                let hairs = self.hairs.take(start + column);
                let covered = covered(samples, hairs);
                if covered > 0 && shown && seen.contains(&column) {
                    let pixel = (row - margin) * width + column - margin;
                    paint(pixel, covered);
                }
            }
        }
    }
}

/// Covers samples of a pixel, on a plane on which no other thread draws.
#[inline(always)]
fn cover(cell: &AtomicU64, samples: u64) {
    cell.store(cell.load(Relaxed) | samples, Relaxed);
}

/// How much of a pixel is covered by samples and, of the rest, by a part.
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

/// A number that is known not to be negative.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "what is negative becomes larger than any plane"
)]
fn index(number: i64) -> usize {
    number as usize
}
