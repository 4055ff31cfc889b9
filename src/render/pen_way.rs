//! Drawings on their way: the first part of all lines, in the order in which a pen draws them.

use std::io;

use crate::parallel::Team;
use crate::style::{Blend, Colour};

use super::drawing::Drawing;
use super::error::RenderError;
use super::paint::{Paint, Pen, Position};
use super::surface::Surface;

/// Number of chords by which a curve is measured.
const CHORDS: u32 = 16;

/// Drawing that ends after a share of the length of its outlines. An area that is left unfinished is bounded by a line
/// from the pen to the start.
pub(super) struct PenWay<'d, D> {
    pub(super) drawing: &'d D,
    /// Share of the length, from 0 to 1.
    pub(super) share: f64,
}

impl<D: Drawing> Drawing for PenWay<'_, D> {
    fn size(&self) -> [u32; 2] {
        self.drawing.size()
    }

    fn background(&self) -> Option<Colour> {
        self.drawing.background()
    }

    fn pen(&self) -> Pen {
        self.drawing.pen()
    }

    fn has_default_ink(&self) -> bool {
        self.drawing.has_default_ink()
    }

    fn blend(&self) -> Blend {
        self.drawing.blend()
    }

    fn draw<'w>(&'w self, surface: &mut impl Surface, team: &Team<'w>) -> Result<(), RenderError> {
        let mut measured = Tip::new(surface, None);
        self.drawing.draw(&mut measured, team)?;
        let end = measured.way * self.share;
        self.drawing.draw(&mut Tip::new(surface, Some(end)), team)
    }
}

/// Tip of the pen, which passes on what it draws up to the end of its way.
struct Tip<'s, S> {
    surface: &'s mut S,
    /// Length of the whole way, in units of positions; `None` if the way is measured only.
    end: Option<f64>,
    /// Length of the way so far.
    way: f64,
    /// Whether the surface has a path.
    is_open: bool,
    /// Current point and start of the subpath.
    at: [Position; 2],
}

impl<'s, S: Surface> Tip<'s, S> {
    fn new(surface: &'s mut S, end: Option<f64>) -> Self {
        Self {
            surface,
            end,
            way: 0.0,
            is_open: false,
            at: [[0; 2]; 2],
        }
    }

    /// Returns whether the way goes on.
    fn goes_on(&self) -> bool {
        self.end.is_some_and(|end| self.way < end)
    }

    /// Moves on by a length, and returns the share of it that is drawn.
    fn share_of(&mut self, length: f64) -> f64 {
        let left = match self.end {
            Some(end) if self.is_open => end - self.way,
            _ => 0.0,
        };
        self.way += length;
        if left <= 0.0 {
            0.0
        } else if left >= length {
            1.0
        } else {
            left / length
        }
    }

    /// Draws a line as far as the way goes; returns whether the way reaches its end, which is not drawn then.
    fn reaches(&mut self, to: Position) -> bool {
        let from = std::mem::replace(&mut self.at[0], to);
        let share = self.share_of(distance(from, to));
        if share > 0.0 && share < 1.0 {
            let tip = between(from, to, share);
            if tip != from {
                self.surface.line_to(tip);
            }
        }
        share == 1.0
    }
}

impl<S: Surface> Surface for Tip<'_, S> {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        self.is_open = self.goes_on();
        match self.is_open {
            true => self.surface.begin(paint),
            false => Ok(()),
        }
    }

    fn move_to(&mut self, to: Position) {
        self.at = [to; 2];
        if self.is_open && self.goes_on() {
            self.surface.move_to(to);
        }
    }

    fn line_to(&mut self, to: Position) {
        if self.reaches(to) {
            self.surface.line_to(to);
        }
    }

    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        let from = std::mem::replace(&mut self.at[0], to);
        let curve = Curve([from, a, b, to]);
        let share = self.share_of(curve.length());
        if share == 1.0 {
            self.surface.curve_to(a, b, to);
        } else if share > 0.0 {
            let Curve([_, a, b, tip]) = curve.up_to(share);
            if tip != from {
                self.surface.curve_to(a, b, tip);
            }
        }
    }

    fn close(&mut self) {
        if self.reaches(self.at[1]) {
            self.surface.close();
        }
    }

    fn hand_on(&mut self) -> io::Result<()> {
        match self.is_open {
            true => self.surface.hand_on(),
            false => Ok(()),
        }
    }

    fn end(&mut self) -> io::Result<()> {
        match std::mem::take(&mut self.is_open) {
            true => self.surface.end(),
            false => Ok(()),
        }
    }

    fn broadens(&self, paint: &Paint) -> bool {
        self.surface.broadens(paint)
    }

    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<bool> {
        match self.end {
            Some(_) => self.surface.enter(corner, size),
            None => Ok(true),
        }
    }

    fn leave(&mut self) -> io::Result<()> {
        match self.end {
            Some(_) => self.surface.leave(),
            None => Ok(()),
        }
    }

    fn label(&mut self, text: &str) {
        if self.goes_on() {
            self.surface.label(text);
        }
    }
}

/// Cubic Bézier curve.
struct Curve([Position; 4]);

impl Curve {
    /// Returns the lengths of its chords.
    fn chords(&self) -> impl Iterator<Item = f64> {
        let point = |number: u32| self.first(f64::from(number) / f64::from(CHORDS)).0[3];
        (0..CHORDS).map(move |number| distance(point(number), point(number + 1)))
    }

    /// Returns the length.
    fn length(&self) -> f64 {
        self.chords().sum()
    }

    /// Returns the curve up to a share of its length, evenly along every chord.
    fn up_to(&self, share: f64) -> Self {
        let mut left = share * self.length();
        let mut before = 0.0;
        for chord in self.chords() {
            if left <= chord {
                before += if chord > 0.0 { left / chord } else { 0.0 };
                break;
            }
            left -= chord;
            before += 1.0;
        }
        self.first(before / f64::from(CHORDS))
    }

    /// Returns the curve up to a parameter from 0 to 1 (de Casteljau).
    fn first(&self, t: f64) -> Self {
        let [from, a, b, to] = self.0;
        let [one, two, three] = [[from, a], [a, b], [b, to]].map(|[p, q]| between(p, q, t));
        let [four, five] = [[one, two], [two, three]].map(|[p, q]| between(p, q, t));
        Self([from, one, four, between(four, five, t)])
    }
}

/// Returns the distance of two positions.
fn distance(from: Position, to: Position) -> f64 {
    let [x, y] = way(from, to);
    libm::hypot(x, y)
}

/// Returns the vector from a position to another.
#[expect(clippy::cast_precision_loss, reason = "positions are small")]
fn way(from: Position, to: Position) -> [f64; 2] {
    [0, 1].map(|axis| (to[axis] - from[axis]) as f64)
}

/// Returns the position at a share of the way between two.
fn between(from: Position, to: Position, share: f64) -> Position {
    let way = way(from, to).map(|it| (it * share).round());
    #[expect(clippy::cast_possible_truncation, reason = "between two positions")]
    let tip = [0, 1].map(|axis| from[axis] + way[axis] as i64);
    tip
}
