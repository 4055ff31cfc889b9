//! Resolution of fractal interpolation.

use crate::document::{InterpolationDocument, Scales};
use crate::ifs::{InterpolationError, Shape, interpolate, scale_of_dimension};

use super::Resolver;
use super::ifs::{Maps, OfIfs};

impl Resolver<OfIfs> {
    /// Computes the maps of fractal interpolation. The initial set is the line between the ends of the
    /// curve.
    pub(super) fn interpolation(&mut self, document: &InterpolationDocument) -> Option<Maps> {
        let points = self.points(&document.points);
        let scales = match &document.scale {
            Some(Scales::One(number)) => Some(vec![self.constant(number)?]),
            Some(Scales::Each(numbers)) => {
                let values: Vec<_> = numbers.iter().map(|number| self.constant(number)).collect();
                Some(values.into_iter().collect::<Option<_>>()?)
            }
            None => None,
        };
        let dimension = match &document.dimension {
            Some(number) => Some(self.constant(number)?),
            None => None,
        };
        let points = points?;
        let scales = match (scales, dimension) {
            (Some(scales), _) => Ok(scales),
            (None, dimension) => {
                let dimension = dimension.unwrap_or(1.0);
                scale_of_dimension(&points, dimension).map(|scale| vec![scale])
            }
        };
        let maps = scales.and_then(|scales| interpolate(&points, &scales));
        let maps = maps.map_err(|error| self.refuse_interpolation(document, &error));
        let maps = maps.ok()?;
        let ends = [points[0], points[points.len() - 1]];
        Some(Maps {
            maps,
            initial: Shape::polyline(&ends),
            chained: true,
        })
    }

    fn refuse_interpolation(
        &mut self,
        document: &InterpolationDocument,
        error: &InterpolationError,
    ) {
        let point = |number: usize| document.points.get(number).map(|point| &point.place);
        let place = match *error {
            InterpolationError::PointNotFinite { point: number }
            | InterpolationError::NotIncreasing { point: number } => point(number),
            InterpolationError::Scale { number, .. } => match &document.scale {
                Some(Scales::One(number)) => Some(&number.place),
                Some(Scales::Each(numbers)) => numbers.get(number).map(|number| &number.place),
                None => None,
            },
            InterpolationError::Dimension { .. } => {
                document.dimension.as_ref().map(|number| &number.place)
            }
            InterpolationError::TooFewPoints { .. }
            | InterpolationError::NumberOfScales { .. }
            | InterpolationError::OnALine => None,
        };
        let place = place.unwrap_or(&document.place).clone();
        self.error(&place, error.to_string());
    }
}
