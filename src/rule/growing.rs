//! Rules between two steps: the last replacement is drawn while it grows out of the elements that it replaces.

use std::collections::BTreeSet;

use crate::expression::Interval;
use crate::geometry::Point;

use super::frame::Place;
use super::{Generator, Rule};

/// Growth of the points of a generator from the element that it replaces to their places.
///
/// A point (x, y) begins at its foot on the element, (x, 0) with x between 0 and 1, and moves in a straight line.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Growing {
    /// Number of the first approximant whose replacement grows.
    step: f64,
    /// Share of the way that has been covered, from 0 to 1.
    share: f64,
    /// Numbers of the points at the ends of elements.
    points: BTreeSet<usize>,
}

impl Growing {
    /// Moves points back to where they are in the replacement of an approximant.
    pub(crate) fn move_points<P: Point>(&self, step: f64, points: &mut [P]) {
        if step < self.step {
            return;
        }
        for &number in &self.points {
            let [x, y, z] = points[number].coordinates();
            let foot = x.clamp(0.0, 1.0);
            let place = [
                foot + self.share * (x - foot),
                self.share * y,
                self.share * z,
            ];
            points[number] = P::of_coordinates(place);
        }
    }

    /// Returns a box of the places of a point in all replacements, from a box of the places that it grows to.
    pub(crate) fn range(&self, [x, y, z]: Place) -> Place {
        let along = |x: f64| {
            let foot = x.clamp(0.0, 1.0);
            foot + self.share * (x - foot)
        };
        let away = |it: Interval| it.or(Interval::new(self.share * it.low, self.share * it.high));
        let along = Interval::new(along(x.low), along(x.high));
        [x.or(along), away(y), away(z)]
    }
}

impl Rule {
    /// Returns the rule whose step `steps` is drawn while it grows: at a `share` of 0 the elements of the last
    /// replacement lie on the element that they replace, at 1 in their places.
    #[must_use]
    pub fn between(&self, steps: u32, share: f64) -> Self {
        let generators = self.generators.iter().map(|generator| {
            let ends = generator.elements().flat_map(|it| [it.from, it.to]);
            let growing = Growing {
                step: f64::from(steps) - 1.0,
                share,
                points: ends.collect(),
            };
            Generator {
                growing: Some(growing),
                ..generator.clone()
            }
        });
        Self {
            generators: generators.collect(),
            ..self.clone()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DVec2;

    #[test]
    fn points_grow_from_their_feet() {
        let growing = |share| Growing {
            step: 2.0,
            share,
            points: BTreeSet::from([0, 2]),
        };
        let places = [
            DVec2::new(0.5, 0.6),
            DVec2::new(0.5, 0.6),
            DVec2::new(1.5, -1.0),
        ];
        let at = |share, step| {
            let mut points = places;
            growing(share).move_points(step, &mut points);
            points
        };
        assert_eq!(at(0.0, 1.0), places);
        assert_eq!(at(1.0, 2.0), places);
        let half = [DVec2::new(0.5, 0.3), places[1], DVec2::new(1.25, -0.5)];
        assert_eq!(at(0.5, 2.0), half);
        assert_eq!(at(0.0, 3.0)[2], DVec2::new(1.0, 0.0));
        for (share, place) in [(0.0, places[2]), (0.5, places[0])] {
            let written = [place.x, place.y, 0.0].map(Interval::point);
            let range = growing(share).range(written);
            for point in [
                place,
                at(share, 2.0)[if place == places[0] { 0 } else { 2 }],
            ] {
                let within =
                    |axis: usize| (range[axis].low..=range[axis].high).contains(&point[axis]);
                assert!((0..2).all(within), "{share}");
            }
        }
    }
}
