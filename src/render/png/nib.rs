use std::sync::Arc;

use crate::render::surface::{Pen, Position};
use crate::style::{Cap, Join};

use super::coverage::{HairPen, Plane, RoundPen};
use super::flat::{FlatPen, FlatStroke};

/// What draws a stroke as coverage.
#[derive(Clone)]
pub(super) enum Nib {
    /// A round pen.
    Round(Arc<RoundPen>),
    /// A hair.
    Hair(HairPen),
    /// A pen for corners or flat ends.
    Flat(FlatPen),
}

/// The round pens that have been used, by width.
#[derive(Default)]
pub(super) struct Nibs(Vec<(f64, Arc<RoundPen>)>);

impl Nibs {
    /// The nib of a pen, if there is one.
    #[inline]
    pub(super) fn nib(&mut self, pen: Pen) -> Option<Nib> {
        let width = pen.width;
        if pen.dash != 0.0 {
            return None;
        }
        if width > 0.0 && width < HairPen::TOO_WIDE {
            return Some(Nib::Hair(HairPen::new(width, pen.overshoot())));
        }
        let is_round = pen.cap == Cap::Round && pen.join == Join::Round;
        if !is_round || !RoundPen::WIDTHS.contains(&width) {
            return FlatPen::of(pen).map(Nib::Flat);
        }
        let known = self.0.iter().find(|(known, _)| *known == width);
        let pen = known.map(|(_, pen)| Arc::clone(pen)).unwrap_or_else(|| {
            let pen = Arc::new(RoundPen::new(width));
            self.0.push((width, Arc::clone(&pen)));
            pen
        });
        Some(Nib::Round(pen))
    }
}

/// State of a subpath.
#[derive(Clone, Copy, Default)]
pub(super) struct Trail {
    /// Its first and its current position.
    pub(super) start: Position,
    pub(super) at: Position,
    /// The second vertex and the last but one, once there are two.
    pub(super) between: Option<[Position; 2]>,
    /// Whether it has begun and is neither closed nor ended.
    pub(super) is_open: bool,
}

impl Trail {
    /// Begins a subpath.
    #[inline]
    pub(super) fn of(start: Position) -> Self {
        Self {
            start,
            at: start,
            between: None,
            is_open: true,
        }
    }

    /// Adds a line.
    #[inline]
    pub(super) fn go_to(&mut self, to: Position) {
        if to != self.at {
            let [first, _] = self.between.unwrap_or([to; 2]);
            self.between = Some([first, self.at]);
            self.at = to;
        }
    }
}

/// A nib in use, with the state of its subpath.
pub(super) enum Hand {
    Round(Arc<RoundPen>),
    /// A hair, and whether a subpath has just begun.
    Hair {
        pen: HairPen,
        begins: bool,
    },
    Flat(FlatStroke),
}

impl Hand {
    /// Takes a nib into use on a picture of a size in pixels.
    pub(super) fn of(nib: &Nib, size: [i64; 2]) -> Self {
        match nib {
            Nib::Round(pen) => Self::Round(Arc::clone(pen)),
            Nib::Hair(pen) => Self::Hair {
                pen: *pen,
                begins: false,
            },
            Nib::Flat(pen) => Self::Flat(FlatStroke::new(*pen, size)),
        }
    }

    /// Begins a subpath.
    #[inline]
    pub(super) fn start(&mut self, plane: &mut Plane, at: Position) {
        match self {
            Self::Round(pen) => plane.dot(pen, at),
            Self::Hair { begins, .. } => *begins = true,
            Self::Flat(stroke) => stroke.start(at, plane),
        }
    }

    /// Goes on with a subpath whose part before was drawn on another plane, perhaps.
    #[inline]
    pub(super) fn go_on(&mut self, plane: &mut Plane, trail: &Trail) {
        match self {
            Self::Round(pen) => plane.reach(pen, trail.at),
            Self::Hair { .. } => {}
            Self::Flat(stroke) => stroke.go_on(trail),
        }
    }

    /// Lines on from a position, one after another.
    #[inline]
    pub(super) fn lines(&mut self, plane: &mut Plane, mut from: Position, to: &[Position]) {
        match self {
            Self::Round(pen) => {
                for &to in to {
                    plane.line(pen, from, to);
                    from = to;
                }
            }
            Self::Hair { pen, begins } => {
                for &to in to {
                    plane.hair(pen, from, to, std::mem::take(begins));
                    from = to;
                }
            }
            Self::Flat(stroke) => to.iter().for_each(|&to| stroke.line(to, plane)),
        }
    }

    /// Closes the subpath, whose last line leads to its start.
    pub(super) fn close(&mut self, plane: &mut Plane) {
        if let Self::Flat(stroke) = self {
            stroke.close(plane);
        }
    }

    /// Ends the subpath where it is.
    pub(super) fn end(&mut self, plane: &mut Plane) {
        if let Self::Flat(stroke) = self {
            stroke.end(plane);
        }
    }
}
