//! Uniform sampling of points from convex solids.

use std::sync::Arc;

use crate::geometry::{Bounds, DAffine3, DMat3, DVec3, Outline, Solid};

use super::random::Scalar;
use super::walked::SetSampler;

/// Samples points of convex solids: uniformly from each, and from several in proportion to their surfaces, or to their
/// lengths if none has a surface.
///
/// Points are drawn from a box around the solid before it is placed, until one lies inside.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidSampler {
    /// Solids, each with the total surface of all up to it, and the box around it before it is placed.
    solids: Vec<(f64, Solid, Bounds<DVec3>)>,
}

/// Maximum number of faces of a polyhedron: all triples of faces are examined.
const MAX_FACES: usize = 64;

/// Maximum number of draws for a point. The box of a convex body is at most six times as large in practice.
const MAX_DRAWS: u32 = 10_000;

const ROUNDING: f64 = 1e-9;

impl SetSampler<DAffine3> for SolidSampler {
    fn of_set(set: &Arc<[Solid]>) -> Option<Self> {
        // Where none has a surface, lengths decide, and points are equal.
        let length = |solid: &Solid| match solid.corners() {
            [from, to] => from.distance(*to),
            _ => 0.0,
        };
        let weights = [
            &Solid::signed_area as &dyn Fn(&Solid) -> f64,
            &length,
            &|_| 1.0,
        ];
        let weight =
            { weights.into_iter() }.find(|weight| set.iter().any(|it| weight(it) > 0.0))?;
        let mut total = 0.0;
        let solids = set.iter().map(|solid| {
            total += weight(solid);
            Some((total, solid.clone(), unplaced_box(solid)?))
        });
        let solids: Vec<_> = solids.collect::<Option<_>>()?;
        (total > 0.0 && total.is_finite()).then_some(Self { solids })
    }

    fn sample(&self, random: &mut Scalar) -> DVec3 {
        let total = self.solids.last().map_or(0.0, |(total, ..)| *total);
        let at = random.unit() * total;
        let solid = self.solids.partition_point(|(end, ..)| *end <= at);
        // Rounding may give the end itself.
        let (_, solid, bounds) = &self.solids[solid.min(self.solids.len() - 1)];
        let mut point = DVec3::ZERO;
        for _ in 0..MAX_DRAWS {
            let share = DVec3::new(random.unit(), random.unit(), random.unit());
            point = bounds.min() + bounds.size() * share;
            if contains(solid, point) {
                break;
            }
        }
        solid.place().transform_point3(point)
    }
}

/// Returns whether a solid contains a point before it is placed.
fn contains(solid: &Solid, point: DVec3) -> bool {
    let in_quadric = solid.primitive().is_none_or(|round| {
        let [a, b, c] = round.quadric();
        let DVec3 { x, y, z } = point;
        x * x + z * z + (a * y + 2.0 * b) * y + c <= ROUNDING
    });
    let mut faces = solid.faces().iter();
    in_quadric && faces.all(|face| face.normal.dot(point) <= face.distance + ROUNDING)
}

/// Returns the bounding box of a solid before it is placed; `None` if it has too many faces.
fn unplaced_box(solid: &Solid) -> Option<Bounds<DVec3>> {
    if let Some(round) = solid.primitive() {
        let ends = [1.0, -1.0].map(|sign| {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            DVec3::from_array(axes.map(|axis| sign * round.support(axis * sign)))
        });
        return Some(Bounds::new(ends[1], ends[0]));
    }
    let faces = solid.faces();
    if faces.len() > MAX_FACES {
        return None;
    }
    let mut bounds = Bounds::EMPTY;
    for (a, first) in faces.iter().enumerate() {
        for (b, second) in faces.iter().enumerate().skip(a + 1) {
            for third in &faces[b + 1..] {
                let rows = DMat3::from_cols(first.normal, second.normal, third.normal);
                let distances = DVec3::new(first.distance, second.distance, third.distance);
                let corner = rows.transpose().inverse() * distances;
                if corner.is_finite() && contains(solid, corner) {
                    bounds.add(corner);
                }
            }
        }
    }
    (!bounds.is_empty()).then_some(bounds)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Round;

    fn mean(solids: &[Solid]) -> (DVec3, DVec3) {
        const COUNT: u32 = 40_000;
        let sampler = SolidSampler::of_set(&solids.into()).unwrap();
        let mut random = Scalar::new(1, 0);
        let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
        for _ in 0..COUNT {
            let point = sampler.sample(&mut random);
            sum += point;
            squares += point * point;
        }
        (sum / f64::from(COUNT), squares / f64::from(COUNT))
    }

    #[test]
    fn solids_are_drawn_from_uniformly() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let (centre, _) = mean(&[Solid::hull(&corners)]);
        assert!(centre.abs_diff_eq(DVec3::splat(0.25), 0.005), "{centre}");
        let (centre, _) = mean(&[Solid::hull(&corners[1..])]);
        assert!(
            centre.abs_diff_eq(DVec3::splat(1.0 / 3.0), 0.005),
            "{centre}"
        );
        // Of a ball, the mean square of a coordinate is a fifth of that of the radius.
        let (centre, squares) = mean(&[Solid::round(Round::Ball, DAffine3::IDENTITY)]);
        assert!(centre.abs_diff_eq(DVec3::ZERO, 0.01), "{centre}");
        assert!(squares.abs_diff_eq(DVec3::splat(0.2), 0.005), "{squares}");
        let (centre, _) = mean(&[Solid::round(Round::Cone, DAffine3::IDENTITY)]);
        assert!(centre.abs_diff_eq(DVec3::Y / 4.0, 0.01), "{centre}");
        // Segments have no surfaces; they are 1 and 3 long.
        let segment = |from: f64, to: f64| Solid::hull(&[DVec3::X * from, DVec3::X * to]);
        let (centre, _) = mean(&[segment(0.0, 1.0), segment(10.0, 13.0)]);
        assert!(
            (centre.x - (0.5 + 3.0 * 11.5) / 4.0).abs() < 0.1,
            "{centre}"
        );
        // Cubes of sides 1 and 2 have surfaces 6 and 24.
        let cube = |from: f64, side: f64| {
            let corner = DVec3::splat(from);
            Solid::cuboid(&Bounds::new(corner, corner + side))
        };
        let (centre, _) = mean(&[cube(0.0, 1.0), cube(10.0, 2.0)]);
        assert!(centre.abs_diff_eq(DVec3::splat(0.1 + 8.8), 0.1), "{centre}");
    }
}
