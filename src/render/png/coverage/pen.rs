//! Round pens: strokes as rows of prints of a disc, which are tabulated.

use crate::geometry::{DVec2, clip};

use super::{CoverageBuffer, FINE, MARGIN, Position, cover, index, mask};

/// Steps per pixel at which the pen can stand, as a power of two.
const STEP_BITS: u32 = 4;
const STEPS: i64 = 1 << STEP_BITS;

/// Number of binary places of positions in steps.
const PLACES: u32 = 28;

/// A hundredth of a pixel, in steps with these places.
const HUNDREDTH: i64 = ((STEPS << PLACES) + FINE / 2) / FINE;

/// Number of binary places of densities of prints.
const DENSITY_PLACES: u32 = 20;

/// Number of binary places of the reciprocals of numbers of parts.
const PART_PLACES: u32 = 24;
/// Shift that is applied to distances before multiplication, so that products fit.
const PART_SHIFT: u32 = 8;
/// Reciprocals of numbers of parts.
const PARTS: [i64; 128] = {
    let mut parts = [0; 128];
    let mut number = 1;
    while number < 128 {
        parts[number] = (1 << PART_PLACES) / number as i64;
        number += 1;
    }
    parts
};

/// Maximum distance between successive prints, as a fraction of the width. Between prints, the edge of a line
/// recedes by at most 0.02 pixels, and a line covers 1 % less.
const SPACING: f64 = 0.25;
/// Maximum distance between successive prints, in pixels.
const MAX_SPACING: f64 = 0.4;

/// Round pen. Its lines cover the area of a moving disc, as strokes with round joins and caps do. A line is
/// drawn as a row of prints of the disc, each from a table.
pub(crate) struct RoundPen {
    /// Distance from the centre to the left and upper sides, in steps with places, minus half a step.
    reach: i64,
    /// Number of prints per hundredth of a pixel, with `DENSITY_PLACES`.
    density: i64,
    prints: Prints,
}

/// Masks of a pen in a square of pixels, by the position of the disc's upper left corner in the first pixel.
enum Prints {
    Two(Vec<Print<2>>),
    Three(Vec<Print<3>>),
    Four(Vec<Print<4>>),
    Five(Vec<Print<5>>),
}

type Print<const SIDE: usize> = [[u64; SIDE]; SIDE];

impl RoundPen {
    /// Widths of pens, in pixels; thinner lines fall between the samples.
    pub(crate) const WIDTHS: std::ops::RangeInclusive<f64> = 0.25..=4.0;

    /// Creates a pen of one of the [`WIDTHS`](Self::WIDTHS).
    #[expect(clippy::cast_possible_truncation, reason = "pens are small")]
    pub(crate) fn new(width: f64) -> Self {
        let radius = width / 2.0;
        let spacing = (SPACING * width).min(MAX_SPACING) * FINE as f64;
        let one = (STEPS << PLACES) as f64;
        Self {
            reach: (radius * one) as i64 - (1 << (PLACES - 1)),
            density: (f64::from(1 << DENSITY_PLACES) / spacing) as i64,
            prints: if width <= 1.0 {
                Prints::Two(prints(radius))
            } else if width <= 2.0 {
                Prints::Three(prints(radius))
            } else if width <= 3.0 {
                Prints::Four(prints(radius))
            } else {
                Prints::Five(prints(radius))
            },
        }
    }
}

/// Returns the prints of a pen, by rows of positions.
fn prints<const SIDE: usize>(radius: f64) -> Vec<Print<SIDE>> {
    let centre = |step: i64| step as f64 / STEPS as f64 + radius;
    let places = (0..STEPS).flat_map(|y| (0..STEPS).map(move |x| [centre(x), centre(y)]));
    let pixel = |[x, y]: [f64; 2], column: usize, row: usize| {
        let (x, y) = (x - column as f64, y - row as f64);
        mask(|[u, v]| (u - x) * (u - x) + (v - y) * (v - y) <= radius * radius)
    };
    places
        .map(|centre| {
            std::array::from_fn(|row| std::array::from_fn(|column| pixel(centre, column, row)))
        })
        .collect()
}

impl CoverageBuffer {
    /// Draws a dot.
    #[inline]
    pub(crate) fn dot(&mut self, pen: &RoundPen, at: Position) {
        if self.is_near(at) {
            match &pen.prints {
                Prints::Two(prints) => self.print(prints, corner(pen, at)),
                Prints::Three(prints) => self.print(prints, corner(pen, at)),
                Prints::Four(prints) => self.print(prints, corner(pen, at)),
                Prints::Five(prints) => self.print(prints, corner(pen, at)),
            }
            self.touch(corner(pen, at));
        }
    }

    /// Records that the pen has been at a position, the dot at which may be on another buffer. The line to
    /// the next position may then be covered.
    #[inline]
    pub(crate) fn reach(&mut self, pen: &RoundPen, at: Position) {
        if self.is_near(at) {
            self.touch(corner(pen, at));
        }
    }

    /// Draws a line from a position where the pen has been on this buffer: by a dot, a line or
    /// [`CoverageBuffer::reach`].
    #[inline]
    pub(crate) fn line(&mut self, pen: &RoundPen, from: Position, to: Position) {
        if self.is_near(from) && self.is_near(to) {
            self.near_line(pen, from, to);
        } else if let Some([from, to]) = self.clipped(from, to) {
            self.touch(corner(pen, from));
            self.near_line(pen, from, to);
        }
    }

    #[inline]
    fn near_line(&mut self, pen: &RoundPen, from: Position, to: Position) {
        match &pen.prints {
            Prints::Two(prints) => self.line_of(prints, pen, from, to),
            Prints::Three(prints) => self.line_of(prints, pen, from, to),
            Prints::Four(prints) => self.line_of(prints, pen, from, to),
            Prints::Five(prints) => self.line_of(prints, pen, from, to),
        }
    }

    #[inline]
    fn line_of<const SIDE: usize>(
        &mut self,
        prints: &[Print<SIDE>],
        pen: &RoundPen,
        from: Position,
        to: Position,
    ) {
        let (start, end) = (corner(pen, from), corner(pen, to));
        if start.map(place) == end.map(place) {
            return;
        }
        let pieces = pieces(pen, from, to);
        if pieces > 1 {
            let step = |axis: usize| part(end[axis] - start[axis], pieces);
            let (step, mut at) = ([step(0), step(1)], start);
            for _ in 1..pieces {
                at = [at[0] + step[0], at[1] + step[1]];
                self.print(prints, at);
            }
        }
        self.print(prints, end);
        // The start of the line has been recorded before.
        self.touch(end);
    }

    /// Covers the print of the pen with the upper left corner of its box at a given position.
    #[inline(always)]
    fn print<const SIDE: usize>(&mut self, prints: &[Print<SIDE>], corner: [i64; 2]) {
        let [x, y] = corner.map(place);
        let (column, row) = (x >> STEP_BITS, (y >> STEP_BITS) - self.top);
        let (column, row) = (column + MARGIN, row + MARGIN);
        let (column, row) = (index(column), index(row));
        let [max_columns, max_rows] = self.size.map(|side| index(side + MARGIN));
        if column > max_columns || row > max_rows {
            return;
        }
        let start = row * self.stride + column;
        let print = &prints[index(((y & (STEPS - 1)) << STEP_BITS) | (x & (STEPS - 1)))];
        let cells = &self.cells[start..start + (SIDE - 1) * self.stride + SIDE];
        for (row, masks) in print.iter().enumerate() {
            let cells = &cells[row * self.stride..][..SIDE];
            for (cell, mask) in cells.iter().zip(masks) {
                cover(cell, *mask);
            }
        }
    }

    #[inline]
    fn touch(&mut self, corner: [i64; 2]) {
        let [column, row] = corner.map(|corner| place(corner) >> STEP_BITS);
        // The widest pen extends to the fourth pixel after the first.
        self.touched.add([column, column + 4], [row, row + 4]);
    }

    /// Returns whether a position is near enough to the picture to be visible, as most are.
    #[inline]
    pub(super) fn is_near(&self, [x, y]: Position) -> bool {
        // Positions too far left or above become larger than any side.
        let most = self.picture.map(|side| index((side + 2 * MARGIN) * FINE));
        index(x + MARGIN * FINE) <= most[0] && index(y + MARGIN * FINE) <= most[1]
    }

    /// Returns the part of a line that is near enough to the picture to be visible.
    #[cold]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "what is clipped lies in the box"
    )]
    pub(super) fn clipped(&self, from: Position, to: Position) -> Option<[Position; 2]> {
        let way = [0, 1].map(|axis| to[axis] - from[axis]);
        let most = self.picture.map(|side| (side + MARGIN) * FINE);
        let [start, along, low, high] = [from, way, [-MARGIN * FINE; 2], most]
            .map(|at| DVec2::from_array(at.map(|fine| fine as f64)));
        let ends = clip(start, along, low, high)?;
        Some(ends.map(|part| [0, 1].map(|axis| from[axis] + (along[axis] * part) as i64)))
    }
}

/// Returns the number of prints after the first. An approximation of the length within 7 % suffices: the
/// larger extent plus three eighths of the smaller.
#[inline]
fn pieces(pen: &RoundPen, from: Position, to: Position) -> i64 {
    let [x, y] = [0, 1].map(|axis| (to[axis] - from[axis]).abs());
    let length = x.max(y) + 3 * x.min(y) / 8;
    ((length * pen.density) >> DENSITY_PLACES) + 1
}

/// Returns one of `parts` equal parts of a distance.
#[inline]
pub(super) fn part(way: i64, parts: i64) -> i64 {
    match PARTS.get(index(parts)) {
        Some(part) => ((way >> PART_SHIFT) * part) >> (PART_PLACES - PART_SHIFT),
        None => way / parts,
    }
}

/// Returns the upper left corner of the box of a pen at a position, in steps with places. Half a step is
/// added, so that [`place`] rounds.
#[inline]
fn corner(pen: &RoundPen, position: Position) -> [i64; 2] {
    position.map(|fine| fine * HUNDREDTH - pen.reach)
}

#[inline]
fn place(corner: i64) -> i64 {
    corner >> PLACES
}
