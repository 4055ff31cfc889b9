use std::sync::Arc;

use crate::render::surface::{Pen, Position};
use crate::style::{Cap, Join};

use super::coverage::{HairPen, Plane, RoundPen};

/// What draws a stroke as coverage.
#[derive(Clone)]
pub(super) enum Nib {
    /// A round pen.
    Round(Arc<RoundPen>),
    /// A hair, and whether a subpath has just begun.
    Hair { pen: HairPen, begins: bool },
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
            return Some(Nib::Hair {
                pen: HairPen::new(width, pen.overshoot()),
                begins: false,
            });
        }
        let is_round = pen.cap == Cap::Round && pen.join == Join::Round;
        if !is_round || !RoundPen::WIDTHS.contains(&width) {
            return None;
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

impl Nib {
    /// Begins a subpath.
    #[inline]
    pub(super) fn start(&mut self, plane: &mut Plane, at: Position) {
        match self {
            Self::Round(pen) => plane.dot(pen, at),
            Self::Hair { begins, .. } => *begins = true,
        }
    }

    /// Goes on with a subpath whose part before was drawn on another plane, perhaps.
    #[inline]
    pub(super) fn go_on(&self, plane: &mut Plane, at: Position) {
        if let Self::Round(pen) = self {
            plane.reach(pen, at);
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
        }
    }
}
