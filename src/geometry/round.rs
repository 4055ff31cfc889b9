//! Round primitives in space: the ball, the cylinder and the cone.

use glam::{DMat3, DVec3};

use super::HalfSpace;
use crate::expression::degrees;

/// Number of parts of a turn over which surfaces are integrated.
const PARTS: u32 = 64;

/// Canonical primitive with a curved surface (Hart 1992, section 2). All are convex; their affine images are
/// ellipsoids, and cylinders and cones over ellipses, which may be oblique.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Round {
    /// The ball of radius 1 about the origin.
    Ball,
    /// The solid cylinder of radius 1 about the y axis, from y = 0 to y = 1.
    Cylinder,
    /// The solid cone about the y axis, from a disk of radius 1 at y = 0 to the apex at y = 1.
    Cone,
}

impl Round {
    /// Returns the volume.
    #[must_use]
    pub fn volume(self) -> f64 {
        use std::f64::consts::PI;
        match self {
            Self::Ball => 4.0 / 3.0 * PI,
            Self::Cylinder => PI,
            Self::Cone => PI / 3.0,
        }
    }

    /// Returns the support function: the largest x · `direction` over the points x.
    #[inline]
    #[must_use]
    pub fn support(self, direction: DVec3) -> f64 {
        let around = || (direction.x * direction.x + direction.z * direction.z).sqrt();
        match self {
            Self::Ball => direction.length(),
            Self::Cylinder => around() + direction.y.max(0.0),
            Self::Cone => around().max(direction.y),
        }
    }

    /// Returns a point at which the [support function](Self::support) is attained.
    #[must_use]
    pub fn farthest(self, direction: DVec3) -> DVec3 {
        let around = DVec3::new(direction.x, 0.0, direction.z);
        let rim = || around.normalize_or_zero();
        match self {
            Self::Ball => direction.normalize_or(DVec3::Y),
            Self::Cylinder if direction.y > 0.0 => rim() + DVec3::Y,
            Self::Cone if direction.y > around.length() => DVec3::Y,
            Self::Cylinder | Self::Cone => rim(),
        }
    }

    /// Returns the numbers a, b and c of the quadratic surface x² + z² + a y² + 2 b y + c = 0. A point with a
    /// value of at most 0 that lies between the [caps](Self::caps) belongs to the primitive.
    #[must_use]
    #[inline]
    pub fn quadric(self) -> [f64; 3] {
        match self {
            Self::Ball => [1.0, 0.0, -1.0],
            Self::Cylinder => [0.0, 0.0, -1.0],
            // x² + z² = (1 − y)²
            Self::Cone => [-1.0, 1.0, -1.0],
        }
    }

    /// Returns the half-spaces that bound the primitive, beside its quadratic surface.
    #[must_use]
    pub fn caps(self) -> Vec<HalfSpace> {
        let cap = |normal: DVec3, distance: f64| HalfSpace { normal, distance };
        match self {
            Self::Ball => Vec::new(),
            Self::Cylinder | Self::Cone => vec![cap(DVec3::NEG_Y, 0.0), cap(DVec3::Y, 1.0)],
        }
    }

    /// Returns the surface of the image under a linear map, where both sides of a flat image count.
    ///
    /// It is the integral of |cof(A) n| over the surface with the normal n (Nanson 1878): over the angle by the
    /// trapezoidal rule, whose error falls exponentially, and over the height of the ball by Gauss's. The relative
    /// error is below 1e-9 for half axes of which none is longer than ten times another.
    #[must_use]
    pub fn surface(self, linear: &DMat3) -> f64 {
        let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
        let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
        let share = std::f64::consts::TAU / f64::from(PARTS);
        let circle: Vec<[f64; 2]> = (0..PARTS)
            .map(|part| {
                let angle = 360.0 * (f64::from(part) + 0.5) / f64::from(PARTS);
                [degrees::cos(angle), degrees::sin(angle)]
            })
            .collect();
        let around = |radius: f64, height: f64| -> f64 {
            let parts = circle.iter().map(|[cosine, sine]| {
                (cofactors * DVec3::new(radius * cosine, height, radius * sine)).length()
            });
            parts.sum::<f64>() * share
        };
        let disk = std::f64::consts::PI * cofactors.y_axis.length();
        match self {
            Self::Cylinder => around(1.0, 0.0) + 2.0 * disk,
            // The normal is (1, 1)/√2 across a slant of length √2, of which half is covered.
            Self::Cone => around(1.0, 1.0) / 2.0 + disk,
            Self::Ball => {
                let mut sum = 0.0;
                // The unit sphere has the same area between two heights as the cylinder around it.
                for part in 0..16 {
                    for (node, weight) in GAUSS {
                        let height = (f64::from(part) + node) / 8.0 - 1.0;
                        let radius = (1.0 - height * height).max(0.0).sqrt();
                        sum += weight / 8.0 * around(radius, height);
                    }
                }
                sum
            }
        }
    }
}

/// Nodes and weights of the Gauss–Legendre quadrature over [0, 1] with 4 nodes.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

#[cfg(test)]
mod tests {
    use glam::DAffine3;

    use super::*;
    use crate::geometry::{Outline, Solid, rotation};

    const ALL: [Round; 3] = [Round::Ball, Round::Cylinder, Round::Cone];

    #[test]
    fn surfaces_in_closed_form() {
        use std::f64::consts::PI;
        let of = |round: Round, x: f64, y: f64, z: f64| {
            round.surface(&DMat3::from_diagonal(DVec3::new(x, y, z)))
        };
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-8 * b, "{a} {b}");
        close(of(Round::Ball, 1.0, 1.0, 1.0), 4.0 * PI);
        close(of(Round::Cylinder, 2.0, 5.0, 2.0), 28.0 * PI);
        close(of(Round::Cone, 3.0, 4.0, 3.0), 24.0 * PI);
        // An oblate spheroid with the half axes 2 and 1.
        let e = 3f64.sqrt() / 2.0;
        close(
            of(Round::Ball, 2.0, 1.0, 2.0),
            8.0 * PI + PI / e * ((1.0 + e) / (1.0 - e)).ln(),
        );
        // Flat images have two sides.
        close(of(Round::Ball, 2.0, 0.0, 3.0), 12.0 * PI);
    }

    /// The support function of an image is the largest value on points of its surface.
    #[test]
    fn supports_are_those_of_points() {
        let turned = rotation(DVec3::new(1.0, -2.0, 0.5), 0.6, 0.8);
        let shear = DMat3::from_cols(DVec3::X, DVec3::new(0.7, 0.5, 0.2), DVec3::Z * 0.1);
        let map = DAffine3::from_mat3_translation(turned * shear, DVec3::new(3.0, -1.0, 2.0));
        for round in ALL {
            let solid = Solid::round(round, map);
            let axes = [DVec3::X, DVec3::NEG_Y, DVec3::new(0.3, -0.2, 0.8)];
            for axis in axes {
                let mut most = f64::NEG_INFINITY;
                for row in 0..=200 {
                    for column in 0..400 {
                        let y = f64::from(row) / 200.0;
                        let angle = std::f64::consts::TAU * f64::from(column) / 400.0;
                        let (y, radius) = match round {
                            Round::Ball => (2.0 * y - 1.0, (4.0 * y * (1.0 - y)).sqrt()),
                            Round::Cylinder => (y, 1.0),
                            Round::Cone => (y, 1.0 - y),
                        };
                        let point = DVec3::new(radius * angle.cos(), y, radius * angle.sin());
                        most = most.max(map.transform_point3(point).dot(axis));
                    }
                }
                let support = solid.support(axis);
                let inside = map.matrix3.transpose() * axis;
                let farthest = map.transform_point3(round.farthest(inside));
                assert!((farthest.dot(axis) - support).abs() < 1e-12, "{round:?}");
                assert!(
                    support >= most - 1e-12 && support < most + 1e-3,
                    "{round:?}"
                );
            }
            let bounds = solid.bounds(&DAffine3::IDENTITY);
            assert!((bounds.max().x - solid.support(DVec3::X)).abs() < 1e-14);
            assert!((bounds.min().z + solid.support(DVec3::NEG_Z)).abs() < 1e-14);
        }
    }
}
