//! Strokes with corners and flat ends, drawn as a polygon for every line, corner and end.

use crate::render::surface::{FINE, Pen, Position};
use crate::style::{Cap, Join};

use super::coverage::CoverageBuffer;
use super::skia::MITER_LIMIT;
use super::stroker::Trail;

/// Maximum width of these strokes, in pixels.
const WIDEST: f64 = 4.0;

/// Maximum length of the pieces in which lines are drawn, in pixels.
const PIECE: f64 = 48.0;

/// Number of vertices of the polygon that replaces a disc.
const DISC: usize = 24;

/// Pen for these strokes.
#[derive(Clone, Copy)]
pub(super) struct FlatPen {
    /// Half the width, in hundredths of a pixel.
    half: f64,
    cap: Cap,
    join: Join,
}

impl FlatPen {
    /// Returns the pen for strokes up to a width of `WIDEST` without dashes.
    pub(super) fn of(pen: Pen) -> Option<Self> {
        let is_drawn = pen.dash == 0.0 && pen.width > 0.0 && pen.width <= WIDEST;
        is_drawn.then_some(Self {
            half: pen.width / 2.0 * FINE,
            cap: pen.cap,
            join: pen.join,
        })
    }
}

/// Stroke in progress.
pub(super) struct FlatStroke {
    pen: FlatPen,
    /// Minimum and maximum of the positions that may be visible.
    seen: [[f64; 2]; 2],
    /// Rounded offsets of the two sides of horizontal and vertical lines from the centre line.
    sides: [i64; 2],
    start: Position,
    at: Position,
    /// Directions of the first and the last line of the subpath.
    directions: Option<[[f64; 2]; 2]>,
    /// Whether a subpath has begun that is neither closed nor ended.
    is_open: bool,
}

impl FlatStroke {
    /// Creates a stroke on a picture of a given size in pixels.
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    pub(super) fn new(pen: FlatPen, size: [i64; 2]) -> Self {
        let beyond = 4.0 * pen.half + PIECE * FINE;
        Self {
            pen,
            seen: [[-beyond; 2], size.map(|side| side as f64 * FINE + beyond)],
            sides: [-pen.half, pen.half].map(|side| rounded([side; 2])[0]),
            start: [0; 2],
            at: [0; 2],
            directions: None,
            is_open: false,
        }
    }

    /// Begins a subpath.
    pub(super) fn start(&mut self, at: Position, plane: &mut CoverageBuffer) {
        self.end(plane);
        (self.start, self.at) = (at, at);
        self.directions = None;
        self.is_open = true;
    }

    /// Continues a subpath.
    pub(super) fn go_on(&mut self, trail: &Trail) {
        (self.start, self.at, self.is_open) = (trail.start, trail.at, trail.is_open);
        let sides = |[first, last]: [Position; 2]| [[trail.start, first], [last, trail.at]];
        let between = trail.between.map(sides);
        self.directions = between.map(|sides| sides.map(|[from, to]| direction(from, to).0));
    }

    /// Draws a straight line.
    pub(super) fn line(&mut self, to: Position, plane: &mut CoverageBuffer) {
        let (direction, length) = direction(self.at, to);
        if length == 0.0 {
            return;
        }
        self.piece(self.at, to, direction, plane);
        self.directions = Some(match self.directions {
            None => [direction; 2],
            Some([first, last]) => {
                self.corner(self.at, last, direction, plane);
                [first, direction]
            }
        });
        self.at = to;
    }

    /// Closes the subpath.
    pub(super) fn close(&mut self, plane: &mut CoverageBuffer) {
        self.line(self.start, plane);
        match self.directions {
            Some([first, last]) => {
                self.corner(self.start, last, first, plane);
                self.is_open = false;
            }
            None => self.end(plane),
        }
    }

    /// Ends the subpath, if it is open.
    pub(super) fn end(&mut self, plane: &mut CoverageBuffer) {
        if !std::mem::take(&mut self.is_open) {
            return;
        }
        let dot = [[-1.0, 0.0], [1.0, 0.0]];
        let [back, on] = match self.directions {
            Some([first, last]) => [first.map(|part| -part), last],
            None => dot,
        };
        self.cap(self.start, back, plane);
        self.cap(self.at, on, plane);
    }

    /// Draws a line without its ends, in pieces of limited length.
    fn piece(&self, from: Position, to: Position, direction: [f64; 2], plane: &mut CoverageBuffer) {
        if let Some(axis) = (0..2).find(|&axis| from[axis] == to[axis]) {
            let mut least = [0, 1].map(|axis| from[axis].min(to[axis]));
            let mut most = [0, 1].map(|axis| from[axis].max(to[axis]));
            least[axis] = least[axis].saturating_add(self.sides[0]);
            most[axis] = most[axis].saturating_add(self.sides[1]);
            if plane.rectangle(least, most) {
                return;
            }
        }
        let across = [-direction[1], direction[0]].map(|part| part * self.pen.half);
        let [start, end] = [from, to].map(point);
        let along = sub(end, start);
        let Some([first, last]) = self.seen_part(start, along) else {
            return;
        };
        let length = f64::hypot(along[0], along[1]) * (last - first);
        let pieces = (length / (PIECE * FINE)).ceil().max(1.0);
        let place = |number: f64| {
            let part = first + (last - first) * number / pieces;
            [0, 1].map(|axis| start[axis] + part * along[axis])
        };
        let (mut before, mut number) = (place(0.0), 0.0);
        while number < pieces {
            number += 1.0;
            let next = place(number);
            let back = across.map(|part| -part);
            plane.polygon(&[
                rounded(add(before, across)),
                rounded(add(next, across)),
                rounded(add(next, back)),
                rounded(add(before, back)),
            ]);
            before = next;
        }
    }

    /// Returns the part of a line that may be visible, from 0 to 1 (Liang & Barsky 1984).
    fn seen_part(&self, start: [f64; 2], along: [f64; 2]) -> Option<[f64; 2]> {
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for axis in 0..2 {
            let [low, high] = self.seen.map(|end| end[axis] - start[axis]);
            if along[axis] == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (enters, leaves) = (low / along[axis], high / along[axis]);
            first = first.max(enters.min(leaves));
            last = last.min(enters.max(leaves));
        }
        (first <= last).then_some([first, last])
    }

    /// Fills the gap between two lines that meet.
    fn corner(&self, at: Position, [a, b]: [f64; 2], [c, d]: [f64; 2], plane: &mut CoverageBuffer) {
        let (cross, dot) = (a * d - b * c, a * c + b * d);
        if cross == 0.0 && dot > 0.0 {
            return;
        }
        if self.pen.join == Join::Round {
            return self.disc(at, plane);
        }
        if self.pen.join == Join::Miter && dot == 0.0 && (a == 0.0 || b == 0.0) {
            // The mitre of a right angle is a square.
            let ([mut left, mut top], [mut right, mut bottom]) = (at, at);
            let grow = |near: &mut i64, far: &mut i64, is_back: bool| {
                let (place, side) = if is_back { (near, 0) } else { (far, 1) };
                *place = place.saturating_add(self.sides[side]);
            };
            grow(&mut left, &mut right, c - a > 0.0);
            grow(&mut top, &mut bottom, d - b > 0.0);
            if plane.rectangle([left, top], [right, bottom]) {
                return;
            }
        }
        // The corner lies on the outer side of the turn.
        let side = if cross > 0.0 {
            -self.pen.half
        } else {
            self.pen.half
        };
        let middle = point(at);
        let before = [middle[0] - b * side, middle[1] + a * side];
        let after = [middle[0] - d * side, middle[1] + c * side];
        let is_sharp = 2.0 > f64::from(MITER_LIMIT * MITER_LIMIT) * (1.0 + dot);
        if self.pen.join == Join::Miter && !is_sharp {
            let far = side / (1.0 + dot);
            let tip = [middle[0] - (b + d) * far, middle[1] + (a + c) * far];
            plane.polygon(&[at, rounded(before), rounded(tip), rounded(after)]);
        } else {
            plane.polygon(&[at, rounded(before), rounded(after)]);
        }
    }

    /// Draws the cap beyond the end of a line.
    fn cap(&self, at: Position, direction: [f64; 2], plane: &mut CoverageBuffer) {
        match self.pen.cap {
            Cap::Butt => {}
            Cap::Round => self.disc(at, plane),
            Cap::Square => {
                let on = direction.map(|part| part * self.pen.half);
                let across = [-on[1], on[0]];
                let back = across.map(|part| -part);
                let near = point(at);
                let far = add(near, on);
                plane.polygon(&[
                    rounded(add(near, across)),
                    rounded(add(far, across)),
                    rounded(add(far, back)),
                    rounded(add(near, back)),
                ]);
            }
        }
    }

    fn disc(&self, at: Position, plane: &mut CoverageBuffer) {
        let middle = point(at);
        // The polygon has the area of the disc.
        let step = std::f64::consts::TAU / DISC as f64;
        let radius = self.pen.half * (step / libm::sin(step)).sqrt();
        let corners: [Position; DISC] = std::array::from_fn(|number| {
            let (sine, cosine) = libm::sincos(number as f64 * step);
            rounded(add(middle, [radius * cosine, radius * sine]))
        });
        plane.polygon(&corners);
    }
}

/// Returns the direction and the length of a line.
#[inline]
fn direction(from: Position, to: Position) -> ([f64; 2], f64) {
    let along = sub(point(to), point(from));
    let length = if along[0] == 0.0 || along[1] == 0.0 {
        (along[0] + along[1]).abs()
    } else {
        f64::hypot(along[0], along[1])
    };
    (along.map(|part| part / length), length)
}

#[expect(clippy::cast_precision_loss, reason = "what is seen is exact")]
fn point(position: Position) -> [f64; 2] {
    position.map(|fine| fine as f64)
}

#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "what is seen is small"
)]
fn rounded(point: [f64; 2]) -> Position {
    point.map(|fine| {
        let towards_zero = (fine + 0.5) as i64;
        towards_zero - i64::from(fine + 0.5 < towards_zero as f64)
    })
}

fn add(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

fn sub(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}
