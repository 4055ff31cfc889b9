//! Coverage of pixels: sixty-four samples per pixel, as the bits of a number.
//!
//! Drawing sets the bits of the samples that are covered. A sample that is covered twice stays covered once,
//! so that overlaps add nothing, and neither the order nor the division of the work has an effect. The mask
//! method is Carpenter's (The A-buffer, 1984). Lines so thin that they would fall between the samples are
//! summed separately, also independently of the order.

mod area;
mod curve;
mod drain;
mod hair;
mod least;
mod pen;
mod polygon;
mod sprite;
#[cfg(test)]
mod tests;
mod winding;

use std::ops::Range;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

pub(crate) use area::{MAX_CORNERS, has_room};
pub(crate) use curve::{bounding, bounding_within, flattened, flattened_within};
pub(crate) use drain::Drain;
use hair::Hairs;
pub(crate) use hair::{HairPen, SegmentBatch};
pub(crate) use pen::RoundPen;
pub(crate) use sprite::{Sprite, SpritePaint, SpriteSheet};

/// Position in hundredths of a pixel.
type Position = [i64; 2];

/// Units of positions per pixel.
const FINE: i64 = 100;

/// Number of samples per pixel: the number of bits of a cell.
const SAMPLES: u32 = u64::BITS;

/// Coverage of a whole pixel.
pub(crate) const WHOLE: u32 = SAMPLES << 8;

/// Width of the margin around the picture, in pixels. The margin is drawn on and never visible, so that
/// shapes that touch the picture need not be clipped.
pub(crate) const MARGIN: i64 = 5;

/// Returns the position of a sample in its pixel. The samples form a lattice; no two of them share a row or a
/// column, so that nearly horizontal or vertical edges also have 65 shades.
fn sample(number: u32) -> [f64; 2] {
    // Of all lattices of this kind, one with the longest shortest vectors.
    [column(number), number].map(|place| (f64::from(place) + 0.5) / f64::from(SAMPLES))
}

/// Returns the column of a sample; its row is its number.
const fn column(number: u32) -> u32 {
    number * 19 % SAMPLES
}

/// Returns the samples for which `covers` holds, as bits.
fn mask(covers: impl Fn([f64; 2]) -> bool) -> u64 {
    (0..SAMPLES).fold(0, |mask, number| {
        mask | (u64::from(covers(sample(number))) << number)
    })
}

/// Coverage buffer: the covered samples of some rows of a picture.
pub(crate) struct CoverageBuffer {
    /// Width and height of the picture, in pixels.
    picture: [i64; 2],
    /// Width and number of the rows, in pixels.
    size: [i64; 2],
    /// First of the rows.
    top: i64,
    /// Number of cells per row, including margins.
    stride: usize,
    /// Cells, by rows. Atomic, so that the compiler does not combine neighbouring stores: prints overlap, and
    /// loads that span several recent stores are slow.
    cells: Box<[AtomicU64]>,
    /// Lines that would fall between the samples.
    hairs: Hairs,
    touched: Touched,
    scratch: area::Scratch,
    windings: winding::Windings,
}

/// Bounds of the pixels that may be covered: first and last column, first and last row.
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

impl CoverageBuffer {
    /// Memory per pixel, in bytes.
    pub(crate) const BYTES: u64 = 12;

    /// Creates an empty buffer.
    #[cfg(test)]
    pub(crate) fn new(size: [u32; 2]) -> Self {
        Self::of_rows(size, 0..size[1])
    }

    /// Creates an empty buffer for some rows of a picture. Positions are those in the picture. The coverage
    /// of these rows equals that in a buffer for the whole picture.
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
            // Memory that is zero already, and taken where anything is covered.
            cells: bytemuck::zeroed_slice_box(stride * rows),
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

    /// Moves the empty buffer to as many other rows of the picture.
    pub(crate) fn move_to(&mut self, top: u32) {
        self.top = top.into();
    }

    /// Returns the rows and columns of cells, including margins, where anything may be covered.
    fn cells_in(&self, touched: Touched) -> [Range<usize>; 2] {
        let range = |[first, last]: [i64; 2], side: i64| {
            let (first, last) = (first.max(-MARGIN), last.min(side + MARGIN - 1));
            if first > last {
                return 0..0;
            }
            index(first + MARGIN)..index(last + MARGIN + 1)
        };
        let rows = touched.rows.map(|row| row.saturating_sub(self.top));
        [
            range(rows, self.size[1]),
            range(touched.columns, self.size[0]),
        ]
    }
}

/// Covers samples of a pixel, on a buffer on which no other thread draws.
#[inline(always)]
fn cover(cell: &AtomicU64, samples: u64) {
    cell.store(cell.load(Relaxed) | samples, Relaxed);
}

/// Converts a number to an index; negative numbers become larger than any index of a buffer.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "what is negative becomes larger than any plane"
)]
fn index(number: i64) -> usize {
    number as usize
}
