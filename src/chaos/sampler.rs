//! Uniform sampling of points from shapes.

use crate::geometry::{DAffine2, DVec2};
use crate::ifs::Shape;
use crate::rule::BaseElement;

use super::random::Scalar;
use super::walked::SetSampler;

/// Samples points from a shape: from lines by length, from the region that closed outlines wind around by
/// area.
///
/// Curves are replaced by chords, enough that none is farther from its curve than 1e-4 of the shape's size
/// where the outline has no sharp bends.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampler {
    /// Pieces, each with the total measure of all pieces up to its end.
    pieces: Vec<(f64, Piece)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Piece {
    Point(DVec2),
    Segment([DVec2; 2]),
    Triangle([DVec2; 3]),
}

/// Number of chords of a curve.
const CHORDS: u32 = 64;

/// Maximum number of heights at which the sides of an outline end or cross, and of triangles.
const MAX_PARTS: usize = 1 << 16;

/// Maximum number of sides of a closed outline: all pairs of sides are examined.
const MAX_SIDES: usize = 1 << 13;

/// Maximum number of pieces of a union.
const MAX_PIECES: usize = 1 << 21;

impl SetSampler<DAffine2> for Sampler {
    fn of_set(set: &Shape) -> Option<Self> {
        Self::of(set)
    }

    fn sample(&self, random: &mut Scalar) -> DVec2 {
        self.draw(random)
    }
}

impl Sampler {
    /// Creates the sampler of a shape. Returns `None` if the shape has no extent, is not finite, or has an
    /// outline with too many corners and crossings to be divided into triangles.
    pub(super) fn of(shape: &Shape) -> Option<Self> {
        let outline = match shape {
            Shape::Point(point) => {
                let pieces = vec![(1.0, Piece::Point(*point))];
                return point.is_finite().then_some(Self { pieces });
            }
            Shape::Outline(outline) => outline,
            Shape::Union(_) => return Self::of_union(shape),
        };
        Self::of_outline(outline)
    }

    /// Creates the sampler of a union, whose outlines are weighted by their shares.
    fn of_union(shape: &Shape) -> Option<Self> {
        let mut pieces = Vec::new();
        let mut before = 0.0;
        for (share, outline) in shape.shares() {
            let own = Self::of_outline(outline)?.pieces;
            let scale = share / own.last()?.0;
            pieces.extend(
                own.iter()
                    .map(|(end, piece)| (before + end * scale, *piece)),
            );
            before += share;
            if pieces.len() > MAX_PIECES {
                return None;
            }
        }
        (before > 0.0 && before.is_finite()).then_some(Self { pieces })
    }

    fn of_outline(outline: &BaseElement) -> Option<Self> {
        let corners = outline.corners(&DAffine2::IDENTITY, CHORDS);
        if !corners.iter().all(|corner| corner.is_finite()) {
            return None;
        }
        if outline.is_closed() {
            if corners.len() > MAX_SIDES {
                return None;
            }
            let triangles = triangles(&corners)?.into_iter();
            Self::of_pieces(triangles.map(|[a, b, c]| {
                let area = (b - a).perp_dot(c - a).abs() / 2.0;
                (area, Piece::Triangle([a, b, c]))
            }))
        } else {
            Self::of_pieces(corners.windows(2).map(|ends| {
                let [a, b] = [ends[0], ends[1]];
                ((b - a).length(), Piece::Segment([a, b]))
            }))
        }
    }

    fn of_pieces(pieces: impl Iterator<Item = (f64, Piece)>) -> Option<Self> {
        let mut total = 0.0;
        let mut cumulated = Vec::new();
        for (measure, piece) in pieces {
            total += measure;
            if measure > 0.0 {
                cumulated.push((total, piece));
            }
        }
        let has_extent = total > 0.0 && f64::is_finite(total);
        has_extent.then_some(Self { pieces: cumulated })
    }

    /// Draws a point.
    pub(super) fn draw(&self, random: &mut Scalar) -> DVec2 {
        let total = self.pieces.last().map_or(0.0, |(total, _)| *total);
        let at = random.unit() * total;
        let piece = self.pieces.partition_point(|(end, _)| *end <= at);
        // Rounding may give the end itself.
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
        }
    }
}

/// Divides the region that a polygon winds around into triangles: between the heights at which it has corners
/// or crosses itself, its sides divide a strip into trapezoids. Parts that it winds around more than once
/// count once. Returns `None` if there are too many triangles.
fn triangles(vertices: &[DVec2]) -> Option<Vec<[DVec2; 3]>> {
    let next = vertices.iter().cycle().skip(1);
    let sides: Vec<_> = vertices.iter().copied().zip(next.copied()).collect();
    let mut heights: Vec<f64> = vertices.iter().map(|vertex| vertex.y).collect();
    for (index, &first) in sides.iter().enumerate() {
        let crossings = sides[..index].iter();
        heights.extend(crossings.filter_map(|&second| crossing(first, second)));
        if heights.len() > MAX_PARTS {
            return None;
        }
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
        if triangles.len() > MAX_PARTS {
            return None;
        }
    }
    Some(triangles)
}

/// Returns the height at which two sides cross.
fn crossing((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> Option<f64> {
    let denominator = (b - a).perp_dot(d - c);
    let along = (c - a).perp_dot(d - c) / denominator;
    let other = (c - a).perp_dot(b - a) / denominator;
    let inside = 0.0..=1.0;
    (inside.contains(&along) && inside.contains(&other)).then_some(a.y + (b.y - a.y) * along)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn polyline(points: &[DVec2]) -> Sampler {
        Sampler::of(&Shape::polyline(points).unwrap()).unwrap()
    }

    fn polygon(points: &[DVec2]) -> Sampler {
        Sampler::of(&Shape::polygon(points).unwrap()).unwrap()
    }

    fn points(sampler: &Sampler, count: usize) -> Vec<DVec2> {
        let mut random = Scalar::new(1, 0);
        (0..count).map(|_| sampler.draw(&mut random)).collect()
    }

    fn share(points: &[DVec2], is_in: impl Fn(&DVec2) -> bool) -> f64 {
        points.iter().filter(|point| is_in(point)).count() as f64 / points.len() as f64
    }

    /// The standard error of a share of 40,000 draws is at most 0.0025; the tolerance is four times that.
    const COUNT: usize = 40_000;
    const ERROR: f64 = 0.01;

    #[test]
    fn lines_are_drawn_from_by_length() {
        let corner = [DVec2::ZERO, DVec2::X * 3.0, DVec2::new(3.0, 1.0)];
        let points = points(&polyline(&corner), COUNT);
        assert!(points.iter().all(|p| p.y == 0.0 || p.x == 3.0));
        assert!((share(&points, |p| p.y == 0.0) - 0.75).abs() < ERROR);
        assert!((share(&points, |p| p.x < 1.0) - 0.25).abs() < ERROR);
    }

    #[test]
    fn polygons_are_drawn_from_by_area() {
        // An L of three unit squares, with either orientation.
        let mut corners = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
            .map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
        for _ in 0..2 {
            let points = points(&polygon(&corners), COUNT);
            assert!(points.iter().all(|p| p.x <= 1.0 || p.y <= 1.0));
            for square in [DVec2::ZERO, DVec2::X, DVec2::Y] {
                let inside = share(&points, |p| (*p - square).floor() == DVec2::ZERO);
                assert!((inside - 1.0 / 3.0).abs() < ERROR);
            }
            corners.reverse();
        }
    }

    /// A pentagram winds around its central pentagon twice.
    #[test]
    fn a_polygon_that_crosses_itself_is_drawn_from_once() {
        let vertex = |k: u32| {
            let (sine, cosine) = libm::sincos(TAU * f64::from(2 * k) / 5.0);
            DVec2::new(cosine, sine)
        };
        let star: Vec<_> = (0..5).map(vertex).collect();
        let area = polygon(&star).pieces.last().unwrap().0;
        // Ten triangles from the centre with sides 1 and r, the circumradius of the pentagon, and an angle of
        // 36° between them.
        let inner = (3.0 - 5f64.sqrt()) / 2.0;
        let expected = 5.0 * libm::sin(TAU / 10.0) * inner;
        assert!((area - expected).abs() < 1e-12, "{area} {expected}");
    }

    #[test]
    fn ellipses_are_drawn_from_by_area() {
        let (centre, half_axes) = (DVec2::new(1.0, 2.0), DVec2::new(3.0, 1.0));
        let ellipse = Shape::ellipse(centre, half_axes, 0.0).unwrap();
        let points = points(&Sampler::of(&ellipse).unwrap(), COUNT);
        let radius = |p: &DVec2| ((*p - centre) / half_axes).length();
        assert!(points.iter().all(|p| radius(p) <= 1.0 + 1e-6));
        assert!((share(&points, |p| radius(p) < 0.5) - 0.25).abs() < ERROR);
        assert!((share(&points, |p| p.x < 1.0 && p.y < 2.0) - 0.25).abs() < ERROR);
        // The chords cut off area beyond this circle.
        assert!((share(&points, |p| radius(p) > 0.995) - 0.01).abs() < 0.002);
    }

    #[test]
    fn what_has_no_extent_is_refused() {
        let line = [DVec2::ZERO, DVec2::X, DVec2::X * 3.0];
        let flat = Shape::polygon(&line).unwrap();
        assert_eq!(Sampler::of(&flat), None);
        assert_eq!(Sampler::of(&Shape::Point(DVec2::NAN)), None);
        let huge = [DVec2::ZERO, DVec2::splat(f64::INFINITY), DVec2::X];
        for shape in [Shape::polygon(&huge), Shape::polyline(&huge)] {
            assert_eq!(shape.and_then(|shape| Sampler::of(&shape)), None);
        }
    }

    #[test]
    fn what_crosses_itself_too_often_is_refused() {
        let comb = |teeth: u32| -> Vec<DVec2> {
            let across = (0..teeth).map(|k| {
                let x = f64::from(k % 2);
                DVec2::new(x, f64::from(k) / f64::from(teeth))
            });
            let along = (0..teeth).map(|k| {
                let y = f64::from(k % 2);
                DVec2::new(f64::from(k) / f64::from(teeth), y)
            });
            across.chain(along).collect()
        };
        assert!(Sampler::of(&Shape::polygon(&comb(20)).unwrap()).is_some());
        assert_eq!(Sampler::of(&Shape::polygon(&comb(2000)).unwrap()), None);
    }
}
