//! Strokers, which draw strokes as coverage: round pens, hairlines, and pens with corners or flat ends.

use std::sync::Arc;

use crate::render::paint::{Pen, Position};
use crate::style::{Cap, Join};

use super::coverage::{CoverageBuffer, HairPen, RoundPen};
use super::flat::{FlatPen, FlatStroke};

/// Stroker.
#[derive(Clone)]
pub(super) enum Stroker {
    /// Round pen.
    Round(Arc<RoundPen>),
    /// Hairline.
    Hair(HairPen),
    /// Pen with corners or flat ends.
    Flat(FlatPen),
}

/// Round pens that have been used, by width.
#[derive(Default)]
pub(super) struct Strokers(Vec<(f64, Arc<RoundPen>)>);

impl Strokers {
    /// Returns the stroker of a pen, if its strokes are drawn as coverage.
    #[inline]
    pub(super) fn stroker(&mut self, pen: Pen) -> Option<Stroker> {
        let width = pen.width;
        if pen.dash != 0.0 {
            return None;
        }
        if width > 0.0 && width < HairPen::TOO_WIDE {
            return Some(Stroker::Hair(HairPen::new(width, pen.overshoot())));
        }
        let is_round = pen.cap == Cap::Round && pen.join == Join::Round;
        if !is_round || !RoundPen::WIDTHS.contains(&width) {
            return FlatPen::of(pen).map(Stroker::Flat);
        }
        let known = self.0.iter().find(|(known, _)| *known == width);
        let pen = known.map(|(_, pen)| Arc::clone(pen)).unwrap_or_else(|| {
            let pen = Arc::new(RoundPen::new(width));
            self.0.push((width, Arc::clone(&pen)));
            pen
        });
        Some(Stroker::Round(pen))
    }
}

/// State of a subpath.
#[derive(Clone, Copy, Default)]
pub(super) struct Trail {
    /// First position.
    pub(super) start: Position,
    /// Current position.
    pub(super) at: Position,
    /// Second vertex and last vertex but one, once there are two.
    pub(super) between: Option<[Position; 2]>,
    /// Whether the subpath has begun and is neither closed nor ended.
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

/// Stroker in use, with the state of its subpath.
pub(super) enum Hand {
    Round(Arc<RoundPen>),
    /// Hairline, and whether a subpath has just begun.
    Hair {
        pen: HairPen,
        begins: bool,
    },
    Flat(FlatStroke),
}

impl Hand {
    /// Puts a stroker to use on a picture of a given size in pixels.
    pub(super) fn of(stroker: &Stroker, size: [i64; 2]) -> Self {
        match stroker {
            Stroker::Round(pen) => Self::Round(Arc::clone(pen)),
            Stroker::Hair(pen) => Self::Hair {
                pen: *pen,
                begins: false,
            },
            Stroker::Flat(pen) => Self::Flat(FlatStroke::new(*pen, size)),
        }
    }

    /// Begins a subpath.
    #[inline]
    pub(super) fn start(&mut self, plane: &mut CoverageBuffer, at: Position) {
        match self {
            Self::Round(pen) => plane.dot(pen, at),
            Self::Hair { begins, .. } => *begins = true,
            Self::Flat(stroke) => stroke.start(at, plane),
        }
    }

    /// Continues a subpath, the beginning of which may have been drawn on another coverage buffer.
    #[inline]
    pub(super) fn go_on(&mut self, plane: &mut CoverageBuffer, trail: &Trail) {
        match self {
            Self::Round(pen) => plane.reach(pen, trail.at),
            Self::Hair { .. } => {}
            Self::Flat(stroke) => stroke.go_on(trail),
        }
    }

    /// Draws lines from a position to the following ones, one after another.
    #[inline]
    pub(super) fn lines(
        &mut self,
        plane: &mut CoverageBuffer,
        mut from: Position,
        to: &[Position],
    ) {
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

    /// Draws lines, each as a subpath, by pairs of ends.
    pub(super) fn segments(&mut self, plane: &mut CoverageBuffer, ends: &[Position]) {
        let ends = ends.as_chunks().0.iter();
        match self {
            Self::Round(pen) => {
                for &[from, to] in ends {
                    plane.dot(pen, from);
                    plane.line(pen, from, to);
                }
            }
            Self::Hair { pen, .. } => {
                ends.for_each(|&[from, to]| plane.hair(pen, from, to, true));
            }
            Self::Flat(stroke) => {
                for &[from, to] in ends {
                    stroke.start(from, plane);
                    stroke.line(to, plane);
                }
            }
        }
    }

    /// Closes the subpath; its last line leads to its start.
    pub(super) fn close(&mut self, plane: &mut CoverageBuffer) {
        if let Self::Flat(stroke) = self {
            stroke.close(plane);
        }
    }

    /// Ends the subpath at its current position.
    pub(super) fn end(&mut self, plane: &mut CoverageBuffer) {
        if let Self::Flat(stroke) = self {
            stroke.end(plane);
        }
    }
}
