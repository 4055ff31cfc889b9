//! Resolution of plane sets.

use crate::document::{EllipseDocument, FormDocument, ShapeDocument};
use crate::geometry::DVec2;
use crate::ifs::Shape;

use super::Resolver;
use super::numbers::values;

impl<K> Resolver<K> {
    /// Resolves a set. Reports mistakes and returns `None`.
    pub(super) fn set(&mut self, document: &ShapeDocument) -> Option<Shape> {
        let before = self.mistakes;
        let shape = match document.form.as_ref()? {
            FormDocument::Point(point) => Some(Shape::Point(self.constant_point(point)?)),
            FormDocument::Outline { points, closed } => {
                let written = points;
                let points = values(&self.points(points)?);
                let returns = points.first() == points.last();
                if let (true, Some(last)) = (returns && points.len() > 2, written.last()) {
                    let message = "the last point is the first one again";
                    let hint = if *closed {
                        "leave it out: a polygon goes back to its first point"
                    } else {
                        "write `polygon` without it"
                    };
                    self.error_with_hint(&last.place, message, hint);
                }
                if *closed {
                    Shape::polygon(&points)
                } else {
                    Shape::polyline(&points)
                }
            }
            FormDocument::Ellipse(ellipse) => {
                let EllipseDocument {
                    centre,
                    axes,
                    rotate,
                    ..
                } = &**ellipse;
                let origin = Some(DVec2::ZERO);
                let centre = { centre.as_ref() }.map_or(origin, |point| self.constant_point(point));
                let axes = axes.each_ref();
                let lengths = self.numbers(axes);
                let angle = match rotate {
                    Some(rotate) => self.constant(rotate),
                    None => Some(0.0),
                };
                let lengths = values(&[lengths?])[0];
                let mut written = lengths.to_array().into_iter().zip(axes);
                if let Some((length, axis)) = written.find(|(length, _)| *length <= 0.0) {
                    let message = format!("{length} is no radius: it must be above 0");
                    self.error(&axis.place, message);
                }
                Shape::ellipse(centre?, lengths, angle?)
            }
            FormDocument::Fractal(fractal) => Some(self.fractal(fractal)?),
            // Solids were reported when the file was read.
            FormDocument::Solid(_) => None,
        };
        // The moments of a closed shape without area are not defined.
        let shape = shape.filter(|shape| shape.moments().is_some());
        if shape.is_none() && self.mistakes == before {
            let hint = "its points must not all be the same, or on one line for a polygon";
            self.error_with_hint(&document.place, "this set has no extent", hint);
        }
        shape
    }
}
