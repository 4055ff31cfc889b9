//! Resolution of plane sets.

use crate::document::{EllipseDocument, FormDocument, Number, Point, ShapeDocument};
use crate::geometry::DVec2;
use crate::ifs::Shape;

use super::Resolver;

impl<K> Resolver<K> {
    /// Resolves a set. Reports mistakes and returns `None`.
    pub(super) fn set(&mut self, document: &ShapeDocument) -> Option<Shape> {
        let before = self.mistakes;
        let shape = match document.form.as_ref()? {
            FormDocument::Point(point) => Some(Shape::Point(self.constant_point(point)?)),
            FormDocument::Outline { points, closed } => {
                let written = points;
                let points = self.points(points)?;
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
                } = &**ellipse;
                let centre = self.constant_point(centre);
                let values = self.numbers(axes);
                let angle = match rotate {
                    Some(rotate) => self.constant(rotate),
                    None => Some(0.0),
                };
                let values = values?;
                if let Some(index) = values.iter().position(|axis| *axis <= 0.0) {
                    let message = format!("{} is no radius: it must be above 0", values[index]);
                    self.error(&axes[index].place, message);
                }
                Shape::ellipse(centre?, values.into(), angle?)
            }
            FormDocument::Fractal(fractal) => Some(self.fractal(fractal)?),
        };
        // The moments of a closed shape without area are not defined.
        let shape = shape.filter(|shape| shape.moments().is_some());
        if shape.is_none() && self.mistakes == before {
            let hint = "its points must not all be the same, or on one line for a polygon";
            self.error_with_hint(&document.place, "this set has no extent", hint);
        }
        shape
    }

    /// Evaluates points. Returns `None` if a coordinate is unknown.
    pub(super) fn points(&mut self, points: &[Point]) -> Option<Vec<DVec2>> {
        let points: Vec<_> = points
            .iter()
            .map(|point| self.constant_point(point))
            .collect();
        points.into_iter().collect()
    }

    pub(super) fn numbers<const N: usize>(&mut self, numbers: &[Number; N]) -> Option<[f64; N]> {
        let values: Vec<_> = numbers.iter().map(|number| self.constant(number)).collect();
        let values: Option<Vec<_>> = values.into_iter().collect();
        values?.try_into().ok()
    }
}
