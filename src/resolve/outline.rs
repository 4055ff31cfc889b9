//! Resolution of outlines: a point followed by straight and curved pieces.

use crate::document::{BaseElementDocument, PieceDocument};
use crate::geometry::DVec2;
use crate::rule::{Piece, arc};

use super::Resolver;

impl<K> Resolver<K> {
    /// Resolves the start and the pieces of an outline in its own coordinates. Reports mistakes;
    /// returns `None` if a coordinate is unknown.
    pub(super) fn outline(
        &mut self,
        document: &BaseElementDocument,
    ) -> Option<(DVec2, Vec<Piece>)> {
        let written = document.pieces.as_deref().unwrap_or_default();
        let mut pieces = written.iter();
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
            // The missing points have been reported.
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
                        // Degree elevation of the quadratic curve.
                        [a] => Piece::Cubic(from.lerp(*a, 2.0 / 3.0), end.lerp(*a, 2.0 / 3.0), end),
                        _ => Piece::Line(end),
                    });
                }
            }
            from = outline.last().map_or(from, Piece::end);
        }
        // `closed: true` implies a straight last side; only a curved one is written.
        let round = !matches!(written.last(), Some(PieceDocument::Line(_)));
        if from == start
            && !(document.closed && round)
            && let Some(last) = written.last()
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
}
