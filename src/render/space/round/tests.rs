//! Tests of rays that meet balls, cylinders and cones.

use super::super::buffer::SIDE;
use super::super::solid::{Body, Depths, Pencil, depth_of};
use super::*;
use crate::geometry::{DMat2, DVec2, Solid};

fn met(primitive: Round, ray: Ray) -> [f64; 2] {
    let surface = Surface {
        primitive,
        inverse: DMat3::IDENTITY,
        middle: DVec3::ZERO,
    };
    surface.span(ray)
}

#[test]
fn spans_are_exact() {
    let ray = |start: [f64; 3], along: [f64; 3]| Ray {
        start: start.into(),
        along: along.into(),
    };
    for (primitive, start, along, expected) in [
        (Round::Ball, [0.6, 0.0, 0.0], [0.0, 0.0, 1.0], [-0.8, 0.8]),
        (Round::Ball, [0.0, 0.0, 3.0], [0.0, 0.0, -2.0], [1.0, 2.0]),
        (
            Round::Cylinder,
            [0.6, 0.5, 0.0],
            [0.0, 0.0, 1.0],
            [-0.8, 0.8],
        ),
        (
            Round::Cylinder,
            [0.6, 7.0, 0.0],
            [0.0, 1.0, 0.0],
            [-7.0, -6.0],
        ),
        (
            Round::Cylinder,
            [0.0, 0.0, 0.0],
            [1.0, 2.0, 0.0],
            [0.0, 0.5],
        ),
        (Round::Cone, [0.0, 0.5, 0.0], [0.0, 0.0, 1.0], [-0.5, 0.5]),
        (Round::Cone, [0.25, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.75]),
        (
            Round::Cone,
            [0.25, 0.0, 0.0],
            [0.0, -1.0, 0.0],
            [-0.75, 0.0],
        ),
        // Along a line of the surface.
        (Round::Cone, [1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 1.0]),
        (Round::Cone, [-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0]),
    ] {
        let [low, high] = met(primitive, ray(start, along));
        assert!(
            (low - expected[0]).abs() < 1e-12 && (high - expected[1]).abs() < 1e-12,
            "{primitive:?} {start:?}: {low} {high}"
        );
    }
    for (primitive, start, along) in [
        (Round::Ball, [1.1, 0.0, 0.0], [0.0, 0.0, 1.0]),
        (Round::Cylinder, [1.1, 0.0, 0.0], [0.0, 1.0, 0.0]),
        (Round::Cylinder, [0.0, 1.1, 0.0], [0.0, 0.0, 1.0]),
        (Round::Cone, [0.0, 1.1, 0.0], [1.0, 0.0, 0.0]),
        (Round::Cone, [1.1, 0.0, 0.0], [0.0, 1.0, 0.0]),
    ] {
        let [low, high] = met(primitive, ray(start, along));
        assert!(low > high, "{primitive:?} {start:?}: {low} {high}");
    }
}

/// The depth of an ellipsoid is that of a Schur complement: with the matrix M = A Aᵀ of the image of the ball,
/// P that of its shadow and m the rest of its last row, z = m P⁻¹ d + √((Mzz − m P⁻¹ m)(1 − d P⁻¹ d)).
#[test]
fn depths_of_ellipsoids_are_analytic() {
    let sheared = DMat3::from_cols(
        DVec3::new(60.0, 10.0, -5.0),
        DVec3::new(20.0, 45.0, 30.0),
        DVec3::new(-12.0, 8.0, 25.0),
    );
    let view = View {
        projection: Projection::Parallel,
        depths: Depths::new([-150.0, 150.0]),
        cuts: &[],
        corner: [0.0; 2],
    };
    let middle = DVec3::new(128.0, 126.5, 11.0);
    for linear in [DMat3::from_diagonal(DVec3::splat(90.0)), sheared] {
        let mut buffer = Buffer::new();
        let ball = Solid::round(Round::Ball, DAffine3::IDENTITY);
        let map = DAffine3::from_mat3_translation(linear, middle);
        let all = [0, 0, SIDE, SIDE];
        let class = Classes::One(5);
        Pencil::default().draw(&mut buffer, &view, &Body::new(&ball, &map), all, class);
        let square = linear * linear.transpose();
        let shadow = DMat2::from_cols(square.x_axis.truncate(), square.y_axis.truncate()).inverse();
        let across = shadow * square.z_axis.truncate();
        let thick = square.z_axis.z - across.dot(square.z_axis.truncate());
        let mut seen = 0;
        for y in 0..SIDE {
            for (x, key) in buffer.row(y).iter().enumerate() {
                let at = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - middle.truncate();
                let inside = 1.0 - at.dot(shadow * at);
                let depth = (inside >= 0.0).then(|| {
                    let z = middle.z + across.dot(at) + (thick * inside).sqrt();
                    view.depths.of(z)
                });
                match (depth_of(*key), depth) {
                    (Some(depth), Some(expected)) => {
                        assert!(depth.abs_diff(expected) <= 1, "{x} {y}: {depth} {expected}");
                        seen += 1;
                    }
                    (found, None) => assert!(found.is_none() || inside > -1e-12),
                    (None, Some(_)) => assert!(inside < 1e-12),
                }
            }
        }
        assert!(seen > 5000, "{seen}");
    }
}

/// A point of a span belongs to the primitive, and the next one beyond its ends does not.
#[test]
fn spans_agree_with_membership() {
    let is_in = |primitive: Round, point: DVec3| {
        let [a, b, c] = primitive.quadric();
        let value = point.x * point.x + point.z * point.z + (a * point.y + 2.0 * b) * point.y + c;
        let caps = primitive.caps();
        value <= 0.0 && { caps.iter() }.all(|cap| cap.normal.dot(point) <= cap.distance)
    };
    let turn = DMat3::from_cols(
        DVec3::new(0.3, 1.2, -0.4),
        DVec3::new(-0.9, 0.1, 0.5),
        DVec3::new(0.2, -0.3, 0.7),
    );
    let mut hits = 0;
    for primitive in [Round::Ball, Round::Cylinder, Round::Cone] {
        for number in 0..400 {
            let x = f64::from(number % 20) / 8.0 - 1.2;
            let y = f64::from(number / 20) / 8.0 - 1.2;
            let along = turn * DVec3::new(x / 3.0, y / 4.0, 1.0);
            let ray = Ray {
                start: turn * DVec3::new(x, y, 0.0),
                along,
            };
            let [low, high] = met(primitive, ray);
            for step in -100..=100 {
                let w = f64::from(step) / 25.0;
                if (w - low).abs().min((w - high).abs()) < 1e-9 {
                    continue;
                }
                let expected = low < w && w < high;
                assert_eq!(
                    is_in(primitive, ray.start + along * w),
                    expected,
                    "{primitive:?}"
                );
                hits += usize::from(expected);
            }
        }
    }
    assert!(hits > 1000, "{hits}");
}
