use super::{FINE, MARGIN, Plane, Position, cover, index, mask};

/// Where the pen can stand: steps to a pixel, as a power of two.
const STEP_BITS: u32 = 4;
const STEPS: i64 = 1 << STEP_BITS;

/// Positions are reckoned in steps with so many binary places.
const PLACES: u32 = 28;

/// Steps with places that are a hundredth of a pixel.
const HUNDREDTH: i64 = ((STEPS << PLACES) + FINE / 2) / FINE;

/// Numbers of prints to a length have so many binary places,
const DENSITY_PLACES: u32 = 20;

/// as have the parts of one by their number; ways are shifted first so that products fit.
const PART_PLACES: u32 = 24;
const PART_SHIFT: u32 = 8;
const PARTS: [i64; 128] = {
    let mut parts = [0; 128];
    let mut number = 1;
    while number < 128 {
        parts[number] = (1 << PART_PLACES) / number as i64;
        number += 1;
    }
    parts
};

/// From one print of the pen to the next it is no farther than this part of the width, and no
/// farther than so many pixels. Between them the edge of a line is hollow by 0.02 pixels at most,
/// and a line has 1 % less ink.
const SPACING: f64 = 0.25;
const MOST_SPACING: f64 = 0.4;

/// A round pen: the line that it draws is what a disk covers that moves along, as strokes with
/// round joins and caps are. It is drawn as a row of prints of the disk, each from a table.
pub(crate) struct RoundPen {
    /// From the centre to the left and upper sides, in steps with places, less half a step.
    reach: i64,
    /// Prints to a hundredth of a pixel, with `DENSITY_PLACES`.
    density: i64,
    prints: Prints,
}

/// What a pen covers of a square of so many pixels, by the place of the disk's upper left corner
/// in the first of them.
enum Prints {
    Two(Vec<Print<2>>),
    Three(Vec<Print<3>>),
    Four(Vec<Print<4>>),
    Five(Vec<Print<5>>),
}

type Print<const SIDE: usize> = [[u64; SIDE]; SIDE];

impl RoundPen {
    /// The widths that there are pens of, in pixels: what is thinner falls between the samples.
    pub(crate) const WIDTHS: std::ops::RangeInclusive<f64> = 0.25..=4.0;

    /// A pen of one of the [`WIDTHS`](Self::WIDTHS).
    #[expect(clippy::cast_possible_truncation, reason = "pens are small")]
    pub(crate) fn new(width: f64) -> Self {
        let radius = width / 2.0;
        let spacing = (SPACING * width).min(MOST_SPACING) * FINE as f64;
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

/// The prints of a pen, by rows of places.
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

impl Plane {
    /// A dot.
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

    /// Takes a position as one that the pen has been to on this plane, whatever has covered the dot there:
    /// what lies between it and the next one may then be covered.
    #[inline]
    pub(crate) fn reach(&mut self, pen: &RoundPen, at: Position) {
        if self.is_near(at) {
            self.touch(corner(pen, at));
        }
    }

    /// A line on from where the pen has been on this plane: with a dot, a line or [`Plane::reach`].
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
        // Where the line starts has been touched before.
        self.touch(end);
    }

    /// Covers what the pen covers with the upper left corner of its box in a place.
    #[inline(always)]
    fn print<const SIDE: usize>(&mut self, prints: &[Print<SIDE>], corner: [i64; 2]) {
        let [x, y] = corner.map(place);
        let (column, row) = (x >> STEP_BITS, (y >> STEP_BITS) - self.top);
        let (column, row) = (column + MARGIN, row + MARGIN);
        let (column, row) = (index(column), index(row));
        let [most_columns, most_rows] = self.size.map(|side| index(side + MARGIN));
        if column > most_columns || row > most_rows {
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
        // The widest pen reaches into the fourth pixel after the first.
        self.touched.add([column, column + 4], [row, row + 4]);
    }

    /// Whether a position lies near enough to be seen, which most often it does.
    #[inline]
    pub(super) fn is_near(&self, [x, y]: Position) -> bool {
        // What lies too far left or above is larger than any side.
        let most = self.picture.map(|side| index((side + 2 * MARGIN) * FINE));
        index(x + MARGIN * FINE) <= most[0] && index(y + MARGIN * FINE) <= most[1]
    }

    /// The part of a line that lies near enough to be seen.
    #[cold]
    pub(super) fn clipped(&self, from: Position, to: Position) -> Option<[Position; 2]> {
        clipped(from, to, self.picture.map(|side| (side + MARGIN) * FINE))
    }
}

/// The part of a line in a box, after Liang and Barsky (1984).
#[expect(
    clippy::cast_possible_truncation,
    reason = "what is clipped lies in the box"
)]
fn clipped(from: Position, to: Position, most: [i64; 2]) -> Option<[Position; 2]> {
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        let (start, along) = (from[axis] as f64, (to[axis] - from[axis]) as f64);
        let (low, high) = ((-MARGIN * FINE) as f64 - start, most[axis] as f64 - start);
        if along == 0.0 {
            if low > 0.0 || high < 0.0 {
                return None;
            }
            continue;
        }
        let (enters, leaves) = (low / along, high / along);
        first = first.max(enters.min(leaves));
        last = last.min(enters.max(leaves));
    }
    (first <= last).then(|| {
        [first, last].map(|part| {
            [0, 1].map(|axis| from[axis] + ((to[axis] - from[axis]) as f64 * part) as i64)
        })
    })
}

/// How many prints come after the first. Of the length it is enough to know it within 7 %: the
/// larger extent and three eighths of the smaller.
#[inline]
fn pieces(pen: &RoundPen, from: Position, to: Position) -> i64 {
    let [x, y] = [0, 1].map(|axis| (to[axis] - from[axis]).abs());
    let length = x.max(y) + 3 * x.min(y) / 8;
    ((length * pen.density) >> DENSITY_PLACES) + 1
}

/// One of several equal parts of a way.
#[inline]
fn part(way: i64, parts: i64) -> i64 {
    match PARTS.get(index(parts)) {
        Some(part) => ((way >> PART_SHIFT) * part) >> (PART_PLACES - PART_SHIFT),
        None => way / parts,
    }
}

/// Where the upper left corner of the pen's box is, in steps with places, if the pen stands at a
/// position; half a step further, so that places are rounded.
#[inline]
fn corner(pen: &RoundPen, position: Position) -> [i64; 2] {
    position.map(|fine| fine * HUNDREDTH - pen.reach)
}

#[inline]
fn place(corner: i64) -> i64 {
    corner >> PLACES
}
