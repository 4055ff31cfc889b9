use crate::render::surface::{Pen, Position};
use crate::style::{Cap, Join};

use super::coverage::{HairPen, Plane, RoundPen};

/// What draws a stroke as coverage.
pub(super) enum Nib {
    /// A round pen, by its place among those that have been used.
    Round(usize),
    /// A hair, and whether a subpath has just begun.
    Hair { pen: HairPen, begins: bool },
}

/// The round pens that have been used, by width.
#[derive(Default)]
pub(super) struct Nibs(Vec<(f64, RoundPen)>);

impl Nibs {
    /// The nib of a pen, if there is one.
    #[inline]
    pub(super) fn nib(&mut self, pen: Pen) -> Option<Nib> {
        let width = pen.width;
        if pen.dash != 0.0 {
            return None;
        }
        if width > 0.0 && width < HairPen::TOO_WIDE {
            let cap = match pen.cap {
                Cap::Butt => 0.0,
                // As much as half a disc.
                Cap::Round => std::f64::consts::FRAC_PI_8,
                Cap::Square => 0.5,
            };
            return Some(Nib::Hair {
                pen: HairPen::new(width, cap),
                begins: false,
            });
        }
        let is_round = pen.cap == Cap::Round && pen.join == Join::Round;
        if !is_round || !RoundPen::WIDTHS.contains(&width) {
            return None;
        }
        let known = self.0.iter().position(|(known, _)| *known == width);
        Some(Nib::Round(known.unwrap_or_else(|| {
            self.0.push((width, RoundPen::new(width)));
            self.0.len() - 1
        })))
    }
}

impl Nib {
    /// Begins a subpath.
    #[inline]
    pub(super) fn start(&mut self, plane: &mut Plane, nibs: &Nibs, at: Position) {
        match self {
            Self::Round(place) => {
                if let Some((_, pen)) = nibs.0.get(*place) {
                    plane.dot(pen, at);
                }
            }
            Self::Hair { begins, .. } => *begins = true,
        }
    }

    /// Lines on from a position, one after another.
    #[inline]
    pub(super) fn lines(
        &mut self,
        plane: &mut Plane,
        nibs: &Nibs,
        mut from: Position,
        to: impl IntoIterator<Item = Position>,
    ) {
        match self {
            Self::Round(place) => {
                if let Some((_, pen)) = nibs.0.get(*place) {
                    for to in to {
                        plane.line(pen, from, to);
                        from = to;
                    }
                }
            }
            Self::Hair { pen, begins } => {
                for to in to {
                    plane.hair(pen, from, to, std::mem::take(begins));
                    from = to;
                }
            }
        }
    }
}
