//! Drawing of round solids into a depth buffer: every sample has the exact depth of the surface.

use crate::geometry::{DAffine3, DVec3, HalfSpace, Round};

use super::buffer::{Buffer, CLASS_BITS};
use super::camera::Projection;
use super::lit::Classes;
use super::solid::View;

/// Points of a ray: `start` + w · `along`, for real w.
#[derive(Clone, Copy)]
struct Ray {
    start: DVec3,
    along: DVec3,
}

/// Draws the image of a primitive under a map that is not singular. `rectangle` contains what is seen of it on the
/// tile.
#[expect(clippy::cast_precision_loss, reason = "tiles are small")]
pub(super) fn draw(
    buffer: &mut Buffer,
    view: &View<'_>,
    primitive: Round,
    place: &DAffine3,
    [left, top, right, bottom]: [usize; 4],
    classes: &mut Classes<'_>,
) {
    let inverse = place.matrix3.inverse();
    let middle = place.translation;
    for y in top..bottom {
        let row = &mut buffer.row_mut(y)[left..right];
        let at_y = view.corner[1] + y as f64 + 0.5;
        for (x, key) in (left..right).zip(row) {
            let at_x = view.corner[0] + x as f64 + 0.5;
            // The distance along the ray is that from the middle, or in perspective from the viewer.
            let seen = match view.projection {
                Projection::Parallel => Ray {
                    start: DVec3::new(at_x, at_y, middle.z),
                    along: DVec3::Z,
                },
                Projection::Central {
                    focus,
                    middle: axis,
                } => Ray {
                    start: DVec3::ZERO,
                    along: DVec3::new((at_x - axis[0]) / focus, (at_y - axis[1]) / focus, -1.0),
                },
            };
            let inside = Ray {
                start: inverse * (seen.start - middle),
                along: inverse * seen.along,
            };
            let span = span(primitive, inside);
            let Some([low, high]) = cut(span, view.cuts, seen) else {
                continue;
            };
            let (z, way) = match view.projection {
                Projection::Parallel => (middle.z + high, high),
                Projection::Central { .. } if low > 0.0 => (-low, low),
                Projection::Central { .. } => continue,
            };
            let depth = view.depths.of(z) << CLASS_BITS;
            if depth > *key {
                continue;
            }
            let class = match classes {
                Classes::One(class) => *class,
                Classes::OfNormals(of) => {
                    let point = inside.start + inside.along * way;
                    of(match view.cuts.is_empty() || span.contains(&way) {
                        true => inverse.transpose() * normal(primitive, point),
                        false => nearest_cut(view.cuts, seen.start + seen.along * way),
                    })
                }
            };
            *key = (*key).min(depth | u32::from(class));
        }
    }
}

/// Returns the part of a ray within a primitive, which may be empty.
fn span(primitive: Round, Ray { start, along }: Ray) -> [f64; 2] {
    let [a, b, c] = primitive.quadric();
    let square = along.x * along.x + along.z * along.z + a * along.y * along.y;
    let half = start.x * along.x + start.z * along.z + (a * start.y + b) * along.y;
    let rest = start.x * start.x + start.z * start.z + (a * start.y + 2.0 * b) * start.y + c;
    let [mut low, mut high] = [f64::NEG_INFINITY, f64::INFINITY];
    let discriminant = half * half - square * rest;
    if square == 0.0 && half == 0.0 {
        if rest > 0.0 {
            return [high, low];
        }
    } else if square == 0.0 {
        let end = -rest / (2.0 * half);
        *(if half > 0.0 { &mut high } else { &mut low }) = end;
    } else if discriminant < 0.0 && square > 0.0 {
        return [high, low];
    } else {
        // The form without cancellation.
        let root = discriminant.max(0.0).sqrt();
        let sum = -(half + root.copysign(half));
        let roots = match sum == 0.0 {
            true => [0.0; 2],
            false => [sum / square, rest / sum],
        };
        let [first, last] = [roots[0].min(roots[1]), roots[0].max(roots[1])];
        // A ray that is steeper than a cone is within it outside of the roots: below its apex on one side.
        match square > 0.0 {
            true => [low, high] = [first, last],
            false if along.y > 0.0 => high = first,
            false => low = last,
        }
    }
    if primitive != Round::Ball {
        // The caps y = 0 and y = 1.
        if along.y == 0.0 {
            if !(0.0..=1.0).contains(&start.y) {
                return [f64::INFINITY, f64::NEG_INFINITY];
            }
        } else {
            let ends = [-start.y / along.y, (1.0 - start.y) / along.y];
            low = low.max(ends[0].min(ends[1]));
            high = high.min(ends[0].max(ends[1]));
        }
    }
    [low, high]
}

/// Returns a vector outwards across the surface of a primitive at a point of it.
fn normal(primitive: Round, point: DVec3) -> DVec3 {
    let [a, b, c] = primitive.quadric();
    let DVec3 { x, y, z } = point;
    let inside = -(x * x + z * z + (a * y + 2.0 * b) * y + c);
    // A point on a cap is farther from the quadric than from the cap.
    let is_on = |away: f64| away < inside;
    match primitive {
        Round::Cylinder | Round::Cone if is_on(y) => DVec3::NEG_Y,
        Round::Cylinder if is_on(1.0 - y) => DVec3::Y,
        _ => DVec3::new(x, a * y + b, z),
    }
}

/// Returns the normal of the half-space on whose plane a point lies.
fn nearest_cut(cuts: &[HalfSpace], point: DVec3) -> DVec3 {
    let away = |cut: &HalfSpace| {
        let distance = cut.distance - cut.normal.dot(point);
        (distance / cut.normal.length()).abs()
    };
    let nearest = cuts.iter().min_by(|a, b| away(a).total_cmp(&away(b)));
    nearest.map_or(DVec3::Z, |cut| cut.normal)
}

/// Returns the part of a ray that lies within half-spaces, too; `None` if it is empty.
fn cut([mut low, mut high]: [f64; 2], cuts: &[HalfSpace], ray: Ray) -> Option<[f64; 2]> {
    for HalfSpace { normal, distance } in cuts {
        let along = normal.dot(ray.along);
        let rest = distance - normal.dot(ray.start);
        if along > 0.0 {
            high = high.min(rest / along);
        } else if along < 0.0 {
            low = low.max(rest / along);
        } else if rest < 0.0 {
            return None;
        }
    }
    (low <= high).then_some([low, high])
}

#[cfg(test)]
mod tests {
    use super::super::buffer::SIDE;
    use super::super::solid::{Depths, Pencil, depth_of};
    use super::*;
    use crate::geometry::{DMat2, DMat3, DVec2, Solid};

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
            let [low, high] = span(primitive, ray(start, along));
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
            let [low, high] = span(primitive, ray(start, along));
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
            Pencil::default().draw(&mut buffer, &view, &ball, &map, all, class);
            let square = linear * linear.transpose();
            let shadow =
                DMat2::from_cols(square.x_axis.truncate(), square.y_axis.truncate()).inverse();
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
            let value =
                point.x * point.x + point.z * point.z + (a * point.y + 2.0 * b) * point.y + c;
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
                let [low, high] = span(primitive, ray);
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
}
