//! Shapes that points are drawn from, all of their points being equally likely.

use std::f64::consts::TAU;

use crate::geometry::{DAffine2, DVec2};

use super::moments::{Raw, outer};
use super::random::Scalar;

/// A shape of the plane from which points are drawn: by length from lines, by area from areas.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The pieces, each with the measure of all pieces up to its end.
    pieces: Vec<(f64, Piece)>,
}

/// A shape without points, without a length or an area, or beyond all numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the shape has no extent to draw points from")]
pub struct NoExtent;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Piece {
    Point(DVec2),
    Segment([DVec2; 2]),
    Triangle([DVec2; 3]),
    /// The image of the unit disk.
    Ellipse(DAffine2),
}

impl Shape {
    /// A single point.
    ///
    /// # Errors
    ///
    /// If a coordinate is not finite.
    pub fn point(point: DVec2) -> Result<Self, NoExtent> {
        if !point.is_finite() {
            return Err(NoExtent);
        }
        Ok(Self {
            pieces: vec![(1.0, Piece::Point(point))],
        })
    }

    /// A line through points, drawn from by length.
    ///
    /// # Errors
    ///
    /// If it has no length or no finite one.
    pub fn polyline(points: &[DVec2]) -> Result<Self, NoExtent> {
        let sides = points.windows(2).map(|ends| {
            let [a, b] = [ends[0], ends[1]];
            ((b - a).length(), Piece::Segment([a, b]))
        });
        Self::of_pieces(sides)
    }

    /// What a closed polygon winds around, drawn from by area. Parts that it winds around more than
    /// once count once.
    ///
    /// # Errors
    ///
    /// If it has no area or no finite one.
    pub fn polygon(vertices: &[DVec2]) -> Result<Self, NoExtent> {
        if !vertices.iter().all(|vertex| vertex.is_finite()) {
            return Err(NoExtent);
        }
        Self::of_pieces(triangles(vertices).into_iter().map(|[a, b, c]| {
            let area = (b - a).perp_dot(c - a).abs() / 2.0;
            (area, Piece::Triangle([a, b, c]))
        }))
    }

    /// The image of the unit disk under a map: an ellipse, or a disk; drawn from by area.
    ///
    /// # Errors
    ///
    /// If it has no area or no finite one.
    pub fn ellipse(map: DAffine2) -> Result<Self, NoExtent> {
        if !map.is_finite() {
            return Err(NoExtent);
        }
        let area = map.matrix2.determinant().abs();
        Self::of_pieces([(area, Piece::Ellipse(map))].into_iter())
    }

    fn of_pieces(pieces: impl Iterator<Item = (f64, Piece)>) -> Result<Self, NoExtent> {
        let mut total = 0.0;
        let mut cumulated = Vec::new();
        for (measure, piece) in pieces {
            total += measure;
            if measure > 0.0 {
                cumulated.push((total, piece));
            }
        }
        if total > 0.0 && f64::is_finite(total) {
            Ok(Self { pieces: cumulated })
        } else {
            Err(NoExtent)
        }
    }

    /// Draws a point.
    pub(super) fn draw(&self, random: &mut Scalar) -> DVec2 {
        let total = self.pieces.last().map_or(0.0, |(total, _)| *total);
        let at = random.unit() * total;
        let piece = self.pieces.partition_point(|(end, _)| *end <= at);
        // Rounding may reach the very end.
        let (_, piece) = self.pieces[piece.min(self.pieces.len() - 1)];
        match piece {
            Piece::Point(point) => point,
            Piece::Segment([a, b]) => a.lerp(b, random.unit()),
            Piece::Triangle([a, b, c]) => {
                let (mut u, mut v) = (random.unit(), random.unit());
                if u + v > 1.0 {
                    (u, v) = (1.0 - u, 1.0 - v);
                }
                a + (b - a) * u + (c - a) * v
            }
            Piece::Ellipse(map) => {
                let radius = random.unit().sqrt();
                let (sine, cosine) = libm::sincos(random.unit() * TAU);
                map.transform_point2(DVec2::new(cosine, sine) * radius)
            }
        }
    }

    /// The moments of its points, all of which are equally likely.
    pub(super) fn moments(&self) -> Raw {
        let mut sum = Raw::point(DVec2::ZERO, 0.0);
        let mut before = 0.0;
        for &(end, piece) in &self.pieces {
            sum = sum.plus(piece.moments(), end - before);
            before = end;
        }
        Raw::point(DVec2::ZERO, 0.0).plus(sum, 1.0 / before)
    }
}

impl Piece {
    fn moments(self) -> Raw {
        let square = |point: DVec2| outer(point, point);
        let (first, second) = match self {
            Self::Point(point) => (point, square(point)),
            Self::Segment([a, b]) => (
                (a + b) / 2.0,
                (square(a) + square(b) + square(a + b)) * (1.0 / 6.0),
            ),
            Self::Triangle([a, b, c]) => (
                (a + b + c) / 3.0,
                (square(a) + square(b) + square(c) + square(a + b + c)) * (1.0 / 12.0),
            ),
            Self::Ellipse(map) => (
                map.translation,
                map.matrix2 * map.matrix2.transpose() * 0.25 + square(map.translation),
            ),
        };
        Raw {
            mass: 1.0,
            first,
            second,
        }
    }
}

/// Triangles that together are what a polygon winds around: between the heights at which it has
/// corners or crosses itself, its sides part a strip into trapezoids.
fn triangles(vertices: &[DVec2]) -> Vec<[DVec2; 3]> {
    let next = vertices.iter().cycle().skip(1);
    let sides: Vec<_> = vertices.iter().copied().zip(next.copied()).collect();
    let mut heights: Vec<f64> = vertices.iter().map(|vertex| vertex.y).collect();
    for (index, &first) in sides.iter().enumerate() {
        let crossings = sides[..index].iter();
        heights.extend(crossings.filter_map(|&second| crossing(first, second)));
    }
    heights.sort_by(f64::total_cmp);
    heights.dedup();
    let mut triangles = Vec::new();
    for strip in heights.windows(2) {
        let [low, high] = [strip[0], strip[1]];
        let mut across: Vec<_> = sides
            .iter()
            .filter(|(a, b)| a.y.min(b.y) <= low && a.y.max(b.y) >= high)
            .map(|&(a, b)| {
                let at = |y: f64| DVec2::new(a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)), y);
                (at(low), at(high), if b.y > a.y { 1 } else { -1 })
            })
            .collect();
        across.sort_by(|a, b| (a.0.x + a.1.x).total_cmp(&(b.0.x + b.1.x)));
        let mut winding = 0;
        for pair in across.windows(2) {
            winding += pair[0].2;
            if winding != 0 {
                let [(a, d, _), (b, c, _)] = [pair[0], pair[1]];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    triangles
}

/// The height at which two sides cross.
fn crossing((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> Option<f64> {
    let denominator = (b - a).perp_dot(d - c);
    let along = (c - a).perp_dot(d - c) / denominator;
    let other = (c - a).perp_dot(b - a) / denominator;
    let inside = 0.0..=1.0;
    (inside.contains(&along) && inside.contains(&other)).then_some(a.y + (b.y - a.y) * along)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(shape: &Shape, count: usize) -> Vec<DVec2> {
        let mut random = Scalar::new(1, 0);
        (0..count).map(|_| shape.draw(&mut random)).collect()
    }

    fn share(points: &[DVec2], is_in: impl Fn(&DVec2) -> bool) -> f64 {
        points.iter().filter(|point| is_in(point)).count() as f64 / points.len() as f64
    }

    /// Of 40,000 draws a share is known to four standard errors of 0.0025 at most.
    const COUNT: usize = 40_000;
    const ERROR: f64 = 0.01;

    #[test]
    fn lines_are_drawn_from_by_length() {
        let corner = [DVec2::ZERO, DVec2::X * 3.0, DVec2::new(3.0, 1.0)];
        let points = points(&Shape::polyline(&corner).unwrap(), COUNT);
        assert!(points.iter().all(|p| p.y == 0.0 || p.x == 3.0));
        assert!((share(&points, |p| p.y == 0.0) - 0.75).abs() < ERROR);
        assert!((share(&points, |p| p.x < 1.0) - 0.25).abs() < ERROR);
    }

    #[test]
    fn polygons_are_drawn_from_by_area() {
        // An L of three unit squares, in either sense.
        let mut corners = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
            .map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
        for _ in 0..2 {
            let points = points(&Shape::polygon(&corners).unwrap(), COUNT);
            assert!(points.iter().all(|p| p.x <= 1.0 || p.y <= 1.0));
            for square in [DVec2::ZERO, DVec2::X, DVec2::Y] {
                let inside = share(&points, |p| (*p - square).floor() == DVec2::ZERO);
                assert!((inside - 1.0 / 3.0).abs() < ERROR);
            }
            corners.reverse();
        }
    }

    /// A pentagram winds around the pentagon in its middle twice.
    #[test]
    fn a_polygon_that_crosses_itself_is_drawn_from_once() {
        let vertex = |k: u32| {
            let (sine, cosine) = libm::sincos(TAU * f64::from(2 * k) / 5.0);
            DVec2::new(cosine, sine)
        };
        let star: Vec<_> = (0..5).map(vertex).collect();
        let shape = Shape::polygon(&star).unwrap();
        let area = shape.pieces.last().unwrap().0;
        // Ten triangles from the centre with sides 1 and r, the radius of the pentagon, and 36° between.
        let inner = (3.0 - 5f64.sqrt()) / 2.0;
        let expected = 5.0 * libm::sin(TAU / 10.0) * inner;
        assert!((area - expected).abs() < 1e-12, "{area} {expected}");
    }

    #[test]
    fn ellipses_are_drawn_from_by_area() {
        let map = DAffine2::from_cols_array(&[3.0, 0.0, 0.0, 1.0, 1.0, 2.0]);
        let points = points(&Shape::ellipse(map).unwrap(), COUNT);
        let back = map.inverse();
        let radius = |p: &DVec2| back.transform_point2(*p).length();
        assert!(points.iter().all(|p| radius(p) <= 1.0 + 1e-12));
        assert!((share(&points, |p| radius(p) < 0.5) - 0.25).abs() < ERROR);
        assert!((share(&points, |p| p.x < 1.0 && p.y < 2.0) - 0.25).abs() < ERROR);
    }

    #[test]
    fn what_has_no_extent_is_refused() {
        let line = [DVec2::ZERO, DVec2::X, DVec2::X * 3.0];
        assert_eq!(Shape::polygon(&line), Err(NoExtent));
        assert_eq!(Shape::polygon(&[]), Err(NoExtent));
        assert_eq!(Shape::polyline(&[DVec2::X; 3]), Err(NoExtent));
        assert_eq!(Shape::polyline(&[]), Err(NoExtent));
        assert_eq!(Shape::point(DVec2::NAN), Err(NoExtent));
        let huge = [DVec2::ZERO, DVec2::splat(f64::INFINITY), DVec2::X];
        assert_eq!(Shape::polygon(&huge), Err(NoExtent));
        assert_eq!(Shape::polyline(&huge), Err(NoExtent));
        let flat = DAffine2::from_cols_array(&[1.0, 0.0, 2.0, 0.0, 0.0, 0.0]);
        assert_eq!(Shape::ellipse(flat), Err(NoExtent));
    }
}
