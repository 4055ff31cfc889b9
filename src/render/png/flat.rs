//! Strokes with corners and flat ends, drawn as a polygon for every line, corner and end.

use crate::geometry::{DVec2, clip};
use crate::render::paint::{FINE, Pen, Position};
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
    seen: [DVec2; 2],
    /// Rounded offsets of the two sides of horizontal and vertical lines from the centre line.
    sides: [i64; 2],
    start: Position,
    at: Position,
    /// Directions of the first and the last line of the subpath.
    directions: Option<[DVec2; 2]>,
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
            seen: [
                DVec2::splat(-beyond),
                DVec2::from_array(size.map(|side| side as f64 * FINE + beyond)),
            ],
            sides: [-pen.half, pen.half].map(|side| rounded(DVec2::splat(side))[0]),
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
        let [back, on] = match self.directions {
            Some([first, last]) => [-first, last],
            None => [DVec2::NEG_X, DVec2::X],
        };
        self.cap(self.start, back, plane);
        self.cap(self.at, on, plane);
    }

    /// Draws a line without its ends, in pieces of limited length.
    fn piece(&self, from: Position, to: Position, direction: DVec2, plane: &mut CoverageBuffer) {
        if let Some(axis) = (0..2).find(|&axis| from[axis] == to[axis]) {
            let mut least = [0, 1].map(|axis| from[axis].min(to[axis]));
            let mut most = [0, 1].map(|axis| from[axis].max(to[axis]));
            least[axis] = least[axis].saturating_add(self.sides[0]);
            most[axis] = most[axis].saturating_add(self.sides[1]);
            if plane.rectangle(least, most) {
                return;
            }
        }
        let across = direction.perp() * self.pen.half;
        let [start, end] = [from, to].map(point);
        let along = end - start;
        let Some([first, last]) = clip(start, along, self.seen[0], self.seen[1]) else {
            return;
        };
        let length = f64::hypot(along.x, along.y) * (last - first);
        let pieces = (length / (PIECE * FINE)).ceil().max(1.0);
        let place = |number: f64| start + along * (first + (last - first) * number / pieces);
        let (mut before, mut number) = (place(0.0), 0.0);
        while number < pieces {
            number += 1.0;
            let next = place(number);
            plane.polygon(&[
                rounded(before + across),
                rounded(next + across),
                rounded(next - across),
                rounded(before - across),
            ]);
            before = next;
        }
    }

    /// Fills the gap between two lines that meet.
    fn corner(&self, at: Position, from: DVec2, to: DVec2, plane: &mut CoverageBuffer) {
        let ([a, b], [c, d]) = (from.to_array(), to.to_array());
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
        let [before, after] = [from, to].map(|way| middle + way.perp() * side);
        let is_sharp = 2.0 > f64::from(MITER_LIMIT * MITER_LIMIT) * (1.0 + dot);
        if self.pen.join == Join::Miter && !is_sharp {
            let far = side / (1.0 + dot);
            let tip = middle + (from + to).perp() * far;
            plane.polygon(&[at, rounded(before), rounded(tip), rounded(after)]);
        } else {
            plane.polygon(&[at, rounded(before), rounded(after)]);
        }
    }

    /// Draws the cap beyond the end of a line.
    fn cap(&self, at: Position, direction: DVec2, plane: &mut CoverageBuffer) {
        match self.pen.cap {
            Cap::Butt => {}
            Cap::Round => self.disc(at, plane),
            Cap::Square => {
                let on = direction * self.pen.half;
                let (near, across) = (point(at), on.perp());
                let far = near + on;
                plane.polygon(&[
                    rounded(near + across),
                    rounded(far + across),
                    rounded(far - across),
                    rounded(near - across),
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
            rounded(middle + DVec2::new(cosine, sine) * radius)
        });
        plane.polygon(&corners);
    }
}

/// Returns the direction and the length of a line.
#[inline]
fn direction(from: Position, to: Position) -> (DVec2, f64) {
    let along = point(to) - point(from);
    let length = if along.x == 0.0 || along.y == 0.0 {
        (along.x + along.y).abs()
    } else {
        f64::hypot(along.x, along.y)
    };
    (along / length, length)
}

#[expect(clippy::cast_precision_loss, reason = "what is seen is exact")]
fn point(position: Position) -> DVec2 {
    DVec2::from_array(position.map(|fine| fine as f64))
}

#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "what is seen is small"
)]
fn rounded(point: DVec2) -> Position {
    point.to_array().map(|fine| {
        let towards_zero = (fine + 0.5) as i64;
        towards_zero - i64::from(fine + 0.5 < towards_zero as f64)
    })
}
