//! Distance of two fractals.

use crate::geometry::Homothety;
use crate::graph::Graph;
use crate::measure::{Covering, Distance, NoCover, Precision, Subject, Subset, hausdorff};
use crate::model::Model;

use super::{Error, Fractal};

/// Number of steps for which graphs are compiled if limit sets are compared.
const STEPS: u32 = 64;

impl Fractal {
    /// Returns the Hausdorff distance of two fractals, in the unit of their files, with a bound of its error: of their limit
    /// sets, or of their approximants of `steps` steps. Closed outlines and solids include their interior.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// use kfrac::{Fractal, measure::Precision};
    ///
    /// let (koch, straight) = (Fractal::named("koch")?, Fractal::parse("initiator: segment\ngenerator: [[0, 0], [1/2, 0], [1, 0]]")?);
    /// let distance = koch.compare(&straight, None, &Precision { tolerance: 0.01, ..Precision::default() })?;
    /// // The tip of the curve is farthest from the segment.
    /// assert!((distance.value() - 3_f64.sqrt() / 6.0).abs() <= distance.error);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If one lies in the plane and one in space, if there is no such set, or if it cannot be covered by points.
    pub fn compare(
        &self,
        other: &Self,
        steps: Option<u32>,
        precision: &Precision,
    ) -> Result<Distance, Error> {
        self.check_cancelled()?;
        let space = [self, other].map(|it| it.graph_to_compare_in_space(steps));
        let unit = match space {
            [Some(first), Some(second)] => {
                return self.distance(other, [&first?, &second?], steps, precision, 1.0);
            }
            [None, None] => self.plane_to_compare(other, steps)?,
            _ => {
                let message = "a set of the plane has no distance from it";
                return Err(Error::InSpace(message));
            }
        };
        let (first, second) = unit;
        let ratio = first.place().ratio();
        self.distance(other, [&first, &second], steps, precision, ratio)
    }

    /// Returns the graphs of two sets of the plane, in coordinates that suit the first.
    fn plane_to_compare(&self, other: &Self, steps: Option<u32>) -> Result<(Graph, Graph), Error> {
        let compile = |it: &Self, place: &Homothety| {
            let model = match steps {
                Some(_) => std::borrow::Cow::Borrowed(&it.model),
                None => it.model.of_limit(),
            };
            let steps = steps.unwrap_or(STEPS);
            let graph = model.compile_within(place, steps, it.seed, it.max_elements);
            graph.map_err(|error| Error::from(it.model.diagnostic(&error)))
        };
        let place = self.model.place();
        let place = place.map_err(|error| self.model.diagnostic(&error.into()))?;
        let first = compile(self, &place)?;
        let second = compile(other, first.place())?;
        Ok((first, second))
    }

    /// Returns the graph of a set in space for a comparison; `None` in the plane.
    fn graph_to_compare_in_space(
        &self,
        steps: Option<u32>,
    ) -> Option<Result<Graph<crate::geometry::Frame3>, Error>> {
        let growth = self.growth(self.model.resolved_steps_in_space(steps));
        let drawn = { &self.model }.drawn_in_space(steps, &growth, crate::style::ColorBy::None)?;
        Some(match drawn {
            Ok(drawn) => Ok(drawn.graph),
            Err(error) => Err(Self::not_drawn(&self.model, error)),
        })
    }

    /// Returns the distance of two graphs, whose unit is `unit` in the files' units.
    fn distance<F: Covering>(
        &self,
        other: &Self,
        graphs: [&Graph<F>; 2],
        steps: Option<u32>,
        precision: &Precision,
        unit: f64,
    ) -> Result<Distance, Error> {
        let models: [&Model; 2] = [&self.model, &other.model];
        let failed = |which: usize, error: NoCover| match error {
            NoCover::Walk(crate::grow::WalkError::NotFinite(error)) => {
                models[which].diagnostic(&error).into()
            }
            error => Error::Compare(error),
        };
        let subject = |which: usize| {
            let set = match steps {
                None => Subset::Limit,
                Some(steps) => Subset::Approximant([self, other][which].growth(steps)),
            };
            Subject::new(graphs[which], set).map_err(|error| failed(which, error))
        };
        let subjects = [subject(0)?, subject(1)?];
        let distance = hausdorff([&subjects[0], &subjects[1]], precision)
            .map_err(|(which, error)| failed(which, error))?;
        Ok(Distance {
            there: distance.there * unit,
            back: distance.back * unit,
            error: distance.error * unit,
            wanted: distance.wanted * unit,
            ..distance
        })
    }
}
