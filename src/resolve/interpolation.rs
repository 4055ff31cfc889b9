//! Resolution of fractal interpolation.

use crate::document::{InterpolationDocument, Scales};
use crate::expression::{Program, Symbols};
use crate::ifs::{InterpolationError, Shape, interpolate, pieces, scale_of_dimension};

use super::Resolver;
use super::ifs::{Maps, OfIfs};
use super::numbers::values;

impl Resolver<OfIfs> {
    /// Computes the maps of fractal interpolation. The initial set is the line between the ends of the
    /// curve.
    pub(super) fn interpolation(&mut self, document: &InterpolationDocument) -> Option<Maps> {
        let points = self.points(&document.points);
        let numbers = match &document.scale {
            Scales::One(number) | Scales::Dimension(number) => std::slice::from_ref(number),
            Scales::Each(numbers) => numbers,
        };
        let numbers: Vec<_> = numbers.iter().map(|it| self.constant_program(it)).collect();
        let factors = numbers.iter().map(Program::as_constant);
        let factors: Vec<f64> = factors.collect::<Option<_>>()?;
        let written = points?;
        let points = values(&written);
        let found = match &document.scale {
            Scales::Dimension(_) => scale_of_dimension(&points, factors[0])
                .map(|scale| (vec![scale], vec![Program::constant(scale)])),
            _ => Ok((factors, numbers)),
        };
        let maps = found.and_then(|(factors, scales)| {
            let maps = interpolate(&points, &factors)?;
            Ok((maps, pieces(&mut Symbols, &written, &scales)))
        });
        let maps = maps.map_err(|error| self.refuse_interpolation(document, &error));
        let (maps, written) = maps.ok()?;
        let ends = [points[0], points[points.len() - 1]];
        Some(Maps {
            maps,
            written,
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
            InterpolationError::Scale { number: index, .. } => match &document.scale {
                Scales::One(number) | Scales::Dimension(number) => Some(&number.place),
                Scales::Each(numbers) => numbers.get(index).map(|number| &number.place),
            },
            InterpolationError::Dimension { .. } => match &document.scale {
                Scales::Dimension(number) => Some(&number.place),
                _ => None,
            },
            InterpolationError::TooFewPoints { .. }
            | InterpolationError::NumberOfScales { .. }
            | InterpolationError::OnALine => None,
        };
        let place = place.unwrap_or(&document.place).clone();
        self.error(&place, error.to_string());
    }
}
