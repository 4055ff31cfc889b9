//! Base elements.

use crate::document::{BaseElementDocument, PieceDocument, Point};
use crate::geometry::{DVec2, Direction, Frame};

use super::super::base_element::arc;
use super::super::{BaseElement, Piece};
use super::Resolver;

impl Resolver {
    /// The number of a base element, which is made if its place is new.
    pub(super) fn base_element(&mut self, document: &BaseElementDocument) -> usize {
        let known = self
            .base_element_places
            .iter()
            .find(|(place, _)| *place == document.place);
        if let Some((_, known)) = known {
            return *known;
        }
        let before = self.diagnostics.len();
        let (outline, frame) = (self.outline(document), self.base_frame(document));
        let made = match (outline, frame) {
            (Some((start, pieces)), Some(frame)) if self.diagnostics.len() == before => {
                let map = frame.map.inverse();
                let pieces = pieces.iter().map(|piece| piece.transformed(&map)).collect();
                let start = map.transform_point2(start);
                let made = BaseElement::new(start, pieces, document.closed);
                if made.is_none() {
                    self.error_with_hint(
                        &document.place,
                        "this base element has no extent",
                        "its points must not all be the same",
                    );
                }
                made
            }
            _ => None,
        };
        // Something harmless in the place of a wrong one, so that it is not reported again.
        let number = self.known_or_new(made.unwrap_or_else(BaseElement::line));
        self.base_element_places
            .push((document.place.clone(), number));
        number
    }

    /// One number for all that look alike, whether named twice or written twice.
    fn known_or_new(&mut self, made: BaseElement) -> usize {
        let known = self.base_elements.iter().position(|known| *known == made);
        known.unwrap_or_else(|| {
            self.base_elements.push(made);
            self.base_elements.len() - 1
        })
    }

    fn outline(&mut self, document: &BaseElementDocument) -> Option<(DVec2, Vec<Piece>)> {
        let mut pieces = document.pieces.iter();
        let start = match pieces.next() {
            Some(PieceDocument::Line(point)) => self.constant_point(point)?,
            Some(PieceDocument::Arc { to, .. } | PieceDocument::Curve { to, .. }) => {
                self.error_with_hint(
                    &to.place,
                    "a base element begins with a point",
                    "points: [[0, 0], ...]",
                );
                return None;
            }
            // The reader has said that there is no point.
            None => return None,
        };
        let mut from = start;
        let mut outline = Vec::new();
        for piece in pieces {
            match piece {
                PieceDocument::Line(to) => outline.push(Piece::Line(self.constant_point(to)?)),
                PieceDocument::Arc { to, through } => {
                    let (end, middle) = (self.constant_point(to)?, self.constant_point(through)?);
                    match arc(from, middle, end) {
                        Some(pieces) => outline.extend(pieces),
                        None => {
                            let message = "the three points of this arc lie on a line";
                            let hint = "write a point for a straight piece";
                            self.error_with_hint(&through.place, message, hint);
                            outline.push(Piece::Line(end));
                        }
                    }
                }
                PieceDocument::Curve { to, control } => {
                    let end = self.constant_point(to)?;
                    let control: Option<Vec<_>> = control
                        .iter()
                        .map(|point| self.constant_point(point))
                        .collect();
                    outline.push(match control?.as_slice() {
                        [a, b] => Piece::Cubic(*a, *b, end),
                        // A quadratic curve as the cubic that it is.
                        [a] => Piece::Cubic(from.lerp(*a, 2.0 / 3.0), end.lerp(*a, 2.0 / 3.0), end),
                        _ => Piece::Line(end),
                    });
                }
            }
            from = outline.last().map_or(from, Piece::end);
        }
        // A straight last side is drawn by `closed: true`, a round one is written.
        let round = !matches!(document.pieces.last(), Some(PieceDocument::Line(_)));
        if from == start
            && !(document.closed && round)
            && let Some(last) = document.pieces.last()
        {
            let hint = if round {
                "write `closed: true`"
            } else if outline.len() == 1 {
                "a base element needs an extent: points: [[0, 0], [1, 0]]"
            } else if document.closed {
                "leave out the last point: `closed: true` goes back to the first"
            } else {
                "leave out the last point and write `closed: true`"
            };
            let message = "the first and the last point of this base element coincide";
            self.error_with_hint(&last.end().place, message, hint);
        }
        Some((start, outline))
    }

    /// The frame that a base element's own coordinates have in the unit frame.
    fn base_frame(&mut self, document: &BaseElementDocument) -> Option<Frame> {
        let mut end = |point: &Option<Point>, default: DVec2| match point {
            Some(point) => self.constant_point(point),
            None => Some(default),
        };
        let (from, to) = (
            end(&document.from, DVec2::ZERO)?,
            end(&document.to, DVec2::X)?,
        );
        if from == to {
            let place = document
                .from
                .as_ref()
                .or(document.to.as_ref())
                .map(|point| &point.place);
            let place = place.unwrap_or(&document.place).clone();
            self.error_with_hint(
                &place,
                "`from` and `to` of this base element coincide",
                "they come to lie on (0, 0) and (1, 0)",
            );
        }
        Some(Frame::between(from, to, Direction::Normal))
    }
}
