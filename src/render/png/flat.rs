//! Strokes with corners and flat ends: a polygon for every line, corner and end.

use crate::render::surface::{FINE, Pen, Position};
use crate::style::{Cap, Join};

use super::skia::MITER_LIMIT;

/// The widest strokes that are drawn so, in pixels.
const WIDEST: f64 = 4.0;

/// Lines are drawn in pieces of so many pixels.
const PIECE: f64 = 48.0;

/// The corners of what stands for a disc.
const DISC: usize = 24;

/// A stroke that is being drawn.
#[derive(Clone, Copy)]
pub(super) struct FlatStroke {
    /// Half the width, in the units of positions.
    half: f64,
    cap: Cap,
    join: Join,
    /// The least and the most of what can be seen.
    seen: [[f64; 2]; 2],
    start: Position,
    at: Position,
    /// The directions of the first line of the subpath and of the last.
    directions: Option<[[f64; 2]; 2]>,
    /// Whether a subpath has begun that is neither closed nor ended.
    is_open: bool,
}

impl FlatStroke {
    /// The stroke of a pen, on a picture, if it is drawn so.
    pub(super) fn of(pen: Pen, size: [u32; 2]) -> Option<Self> {
        let is_drawn = pen.dash == 0.0 && pen.width > 0.0 && pen.width <= WIDEST;
        let half = pen.width / 2.0 * FINE;
        let beyond = 4.0 * half + PIECE * FINE;
        is_drawn.then_some(Self {
            half,
            cap: pen.cap,
            join: pen.join,
            seen: [
                [-beyond; 2],
                size.map(|side| f64::from(side) * FINE + beyond),
            ],
            start: [0; 2],
            at: [0; 2],
            directions: None,
            is_open: false,
        })
    }

    /// Begins a subpath.
    pub(super) fn start(&mut self, at: Position, draw: &mut impl FnMut(&[Position])) {
        self.end(draw);
        (self.start, self.at) = (at, at);
        self.directions = None;
        self.is_open = true;
    }

    /// A straight line.
    pub(super) fn line(&mut self, to: Position, draw: &mut impl FnMut(&[Position])) {
        let from = point(self.at);
        let along = sub(point(to), from);
        let length = f64::hypot(along[0], along[1]);
        if length == 0.0 {
            return;
        }
        let direction = along.map(|part| part / length);
        self.piece(self.at, to, direction, draw);
        self.directions = Some(match self.directions {
            None => [direction; 2],
            Some([first, last]) => {
                self.corner(self.at, last, direction, draw);
                [first, direction]
            }
        });
        self.at = to;
    }

    /// Closes the subpath.
    pub(super) fn close(&mut self, draw: &mut impl FnMut(&[Position])) {
        self.line(self.start, draw);
        match self.directions {
            Some([first, last]) => {
                self.corner(self.start, last, first, draw);
                self.is_open = false;
            }
            None => self.end(draw),
        }
    }

    /// Ends the subpath, if it is open.
    pub(super) fn end(&mut self, draw: &mut impl FnMut(&[Position])) {
        if !std::mem::take(&mut self.is_open) {
            return;
        }
        let dot = [[-1.0, 0.0], [1.0, 0.0]];
        let [back, on] = match self.directions {
            Some([first, last]) => [first.map(|part| -part), last],
            None => dot,
        };
        self.cap(self.start, back, draw);
        self.cap(self.at, on, draw);
    }

    /// The sides of a line, in pieces that are not long.
    fn piece(
        &self,
        from: Position,
        to: Position,
        direction: [f64; 2],
        draw: &mut impl FnMut(&[Position]),
    ) {
        let across = [-direction[1], direction[0]].map(|part| part * self.half);
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
            draw(&[
                rounded(add(before, across)),
                rounded(add(next, across)),
                rounded(add(next, back)),
                rounded(add(before, back)),
            ]);
            before = next;
        }
    }

    /// What part of a line may be seen, from 0 to 1 (Liang & Barsky 1984).
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

    /// What fills the gap between two lines that meet.
    fn corner(
        &self,
        at: Position,
        [a, b]: [f64; 2],
        [c, d]: [f64; 2],
        draw: &mut impl FnMut(&[Position]),
    ) {
        let (cross, dot) = (a * d - b * c, a * c + b * d);
        if cross == 0.0 && dot > 0.0 {
            return;
        }
        if self.join == Join::Round {
            return self.disc(at, draw);
        }
        // On the outer side of the turn.
        let side = if cross > 0.0 { -self.half } else { self.half };
        let middle = point(at);
        let before = [middle[0] - b * side, middle[1] + a * side];
        let after = [middle[0] - d * side, middle[1] + c * side];
        let is_sharp = 2.0 > f64::from(MITER_LIMIT * MITER_LIMIT) * (1.0 + dot);
        if self.join == Join::Miter && !is_sharp {
            let far = side / (1.0 + dot);
            let tip = [middle[0] - (b + d) * far, middle[1] + (a + c) * far];
            draw(&[at, rounded(before), rounded(tip), rounded(after)]);
        } else {
            draw(&[at, rounded(before), rounded(after)]);
        }
    }

    /// What a line has beyond its end.
    fn cap(&self, at: Position, direction: [f64; 2], draw: &mut impl FnMut(&[Position])) {
        match self.cap {
            Cap::Butt => {}
            Cap::Round => self.disc(at, draw),
            Cap::Square => {
                let on = direction.map(|part| part * self.half);
                let across = [-on[1], on[0]];
                let back = across.map(|part| -part);
                let near = point(at);
                let far = add(near, on);
                draw(&[
                    rounded(add(near, across)),
                    rounded(add(far, across)),
                    rounded(add(far, back)),
                    rounded(add(near, back)),
                ]);
            }
        }
    }

    fn disc(&self, at: Position, draw: &mut impl FnMut(&[Position])) {
        let middle = point(at);
        // As large as the disc.
        let step = std::f64::consts::TAU / DISC as f64;
        let radius = self.half * (step / libm::sin(step)).sqrt();
        let corners: [Position; DISC] = std::array::from_fn(|number| {
            let (sine, cosine) = libm::sincos(number as f64 * step);
            rounded(add(middle, [radius * cosine, radius * sine]))
        });
        draw(&corners);
    }
}

#[expect(clippy::cast_precision_loss, reason = "what is seen is exact")]
fn point(position: Position) -> [f64; 2] {
    position.map(|fine| fine as f64)
}

#[expect(clippy::cast_possible_truncation, reason = "what is seen is small")]
fn rounded(point: [f64; 2]) -> Position {
    point.map(|fine| (fine + 0.5).floor() as i64)
}

fn add(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

fn sub(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}
