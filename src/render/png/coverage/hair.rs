use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

use super::{FINE, MARGIN, Plane, Position, index};

/// Lines are drawn in pieces no longer than this, in hundredths of a pixel, across and down.
const PIECE: i64 = 25;

/// Places on the way along a line have so many binary places.
const PLACES: u32 = 16;

/// The logarithm that is kept of a part that lets 1 / e of the light through.
const UNIT: f32 = (1 << 24) as f32;

/// A pen so thin that its lines would fall between the samples.
///
/// What it draws is told by how much of a pixel's light it takes. Lines are taken to lie in a pixel
/// independently of each other, so that what all of them let through is the product of what each
/// does, as in a stack of transparent layers. Sums of logarithms say the same in any order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HairPen {
    /// The width in hundredths of a pixel: edges are blurred to whole ones.
    width: i64,
    /// What a line takes for each hundredth of its length, in `UNIT`s.
    ink: f32,
    /// What both ends of a line add to its length, in hundredths.
    ends: f32,
}

/// What a line takes of a pixel's light, as a part of the area that it covers: w times this is
/// -ln(1 - w) within 0.1 %, so that a line through a whole pixel takes just its width.
#[inline]
fn thickness(w: f32) -> f32 {
    1.0 + w * (0.5 + 0.41 * w)
}

impl HairPen {
    /// The least width that is too large, in pixels.
    pub(crate) const TOO_WIDE: f64 = 0.25;

    /// A pen of a width above 0, whose lines are longer at each end by so many widths.
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

/// What takes light, by cell; nothing anywhere as long as there are no cells.
///
/// Atomic for the same reason as the cells of samples.
#[derive(Default)]
pub(super) struct Hairs {
    cells: Vec<AtomicU32>,
}

impl Hairs {
    /// The part of a cell's light that hairs take, which they then no longer do.
    #[inline]
    pub(super) fn take(&mut self, cell: usize) -> f32 {
        let cell = self.cells.get_mut(cell);
        let taken = cell.map_or(0, |cell| std::mem::take(cell.get_mut()));
        if taken == 0 {
            return 0.0;
        }
        #[expect(clippy::cast_precision_loss, reason = "seven digits are enough")]
        let taken = taken as f32;
        -libm::expm1f(-taken / UNIT)
    }

    /// Returns whether no hair has ever been drawn.
    pub(super) fn is_empty(&self) -> bool {
        self.cells.is_empty()
    }

    /// Has cells if others have.
    pub(super) fn make_room_for(&mut self, others: &Self) {
        if self.cells.is_empty() {
            self.make_room(others.cells.len());
        }
    }

    fn make_room(&mut self, count: usize) {
        self.cells = std::iter::repeat_with(|| AtomicU32::new(0))
            .take(count)
            .collect();
    }

    /// Takes in some cells what others take, which they then no longer do.
    pub(super) fn take_over(&mut self, others: &mut Self, cells: Range<usize>) {
        if others.cells.is_empty() {
            return;
        }
        let others = &mut others.cells[cells.clone()];
        for (cell, other) in self.cells[cells].iter().zip(others) {
            add(cell, std::mem::take(other.get_mut()));
        }
    }
}

#[inline]
fn add(cell: &AtomicU32, ink: u32) {
    cell.store(cell.load(Relaxed).saturating_add(ink), Relaxed);
}

impl Plane {
    /// A line of a hair pen, with ends if it is the first of its path: they add to its length.
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

    /// Hairs that lie near each other, as a box that is no larger than a pixel: twice its middle, and
    /// its extent, in hundredths of a pixel; the area of the hairs in pixels, and their width.
    #[inline]
    pub(crate) fn tuft(&mut self, middle: [i32; 2], extent: [u32; 2], area: f32, width: f32) {
        if self.hairs.cells.is_empty() {
            self.hairs.make_room(self.cells.len());
        }
        let extent = extent.map(|extent| i64::from(extent).clamp(1, FINE));
        self.blot(
            middle.map(i64::from),
            extent,
            area * thickness(width) * UNIT,
        );
    }

    #[inline]
    fn near_hair(&mut self, pen: &HairPen, from: Position, to: Position, ends: bool) {
        let way = [to[0] - from[0], to[1] - from[1]];
        let [across, down] = way.map(|along| along as f32);
        let length = (across * across + down * down).sqrt();
        let ends = if ends { pen.ends } else { 0.0 };
        // Twice the middle, so that halves are whole.
        let middle = [from[0] + to[0], from[1] + to[1]];
        let extent = way.map(i64::abs);
        let longest = extent[0].max(extent[1]);
        if longest <= PIECE {
            let ink = (length + ends) * pen.ink;
            self.blot(middle, extent.map(|extent| extent + pen.width), ink);
        } else {
            // Where the line begins: whether it does is not seen from far along it.
            if ends > 0.0 {
                self.blot(from.map(|at| 2 * at), [pen.width; 2], ends * pen.ink);
            }
            let ink = length * pen.ink;
            let pieces = (longest + PIECE - 1) / PIECE;
            let step = way.map(|along| (along << (PLACES + 1)) / pieces);
            let extent = extent.map(|extent| extent / pieces + pen.width);
            let mut at = [0, 1].map(|axis| (from[axis] << (PLACES + 1)) + step[axis] / 2);
            let ink = ink / pieces as f32;
            for _ in 0..pieces {
                self.blot(at.map(|place| place >> PLACES), extent, ink);
                at = [at[0] + step[0], at[1] + step[1]];
            }
        }
    }

    /// Spreads ink over a box that is no larger than a pixel: twice its middle, and its extent.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts from floats saturate"
    )]
    fn blot(&mut self, middle: [i64; 2], extent: [i64; 2], ink: f32) {
        let first = [MARGIN, MARGIN - self.top];
        let least = [0, 1].map(|axis| middle[axis] - extent[axis] + 2 * FINE * first[axis]);
        // What is negative becomes larger than any plane.
        let cell = least.map(|least| index(least) / (2 * FINE) as usize);
        let [most_columns, most_rows] = self.size.map(|side| index(side + 2 * MARGIN) - 2);
        if cell[0] > most_columns || cell[1] > most_rows {
            return;
        }
        let within = [0, 1].map(|axis| least[axis] - cell[axis] as i64 * 2 * FINE);
        let beyond = [0, 1].map(|axis| within[axis] + 2 * extent[axis] - 2 * FINE);
        let [column, row] = [0, 1].map(|axis| cell[axis] as i64 - first[axis]);
        self.touched.add([column, column + 1], [row, row + 1]);
        let start = cell[1] * self.stride + cell[0];
        let cells = &self.hairs.cells[start..start + self.stride + 2];
        if beyond[0] <= 0 && beyond[1] <= 0 {
            add(&cells[0], ink as u32);
            return;
        }
        let share = |axis: usize| beyond[axis].max(0) as f32 / (2 * extent[axis]) as f32;
        let (right, below) = (share(0), share(1));
        let (upper, lower) = (ink * (1.0 - below), ink * below);
        add(&cells[0], (upper * (1.0 - right)) as u32);
        add(&cells[1], (upper * right) as u32);
        add(&cells[self.stride], (lower * (1.0 - right)) as u32);
        add(&cells[self.stride + 1], (lower * right) as u32);
    }
}
