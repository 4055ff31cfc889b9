//! Filled shapes narrower than a pixel, drawn a pixel wide, so that a set stays visible however small its
//! pieces become.
//!
//! The sides of a convex shape of width w, the least distance between two parallel lines that enclose it, are
//! moved outwards by (1 − w) / 2 pixels; a slim shape no longer than a pixel becomes a line of equal area. Shapes of at least a pixel are drawn as they are; shrinking shapes
//! tend to a dot or a line of a round pen of one pixel.

use std::f64::consts::PI;
use std::sync::LazyLock;

use super::polygon::{HalfPlane, MAX_PIXELS, MAX_VERTICES, SOME_VERTICES};
use super::polygon::{bounds, orientation, rounded, sides};
use super::{CoverageBuffer, FINE, Position, RoundPen};

/// Minimum width of a filled shape, in hundredths of a pixel.
const NARROWEST: i64 = FINE;

/// Maximum length of shapes that are drawn as dots, in hundredths of a pixel.
const LONGEST_DOT: i64 = 25;

/// Width below which a shape has lost its sides by rounding, in hundredths of a pixel.
const LINE: f64 = 1.0;

/// Ratio of the width of a shape no longer than a pixel to its length below which a line replaces it, as
/// for the petals of a flower: many sides would be moved for the same pixels.
const SLIM: f64 = 0.5;

/// Pen for dots and lines.
static PEN: LazyLock<RoundPen> = LazyLock::new(|| RoundPen::new(NARROWEST as f64 / FINE as f64));

impl CoverageBuffer {
    /// Covers a polygon as [`CoverageBuffer::polygon`] does, but at least a pixel wide if it is convex or fits in a
    /// pixel.
    #[inline]
    pub(crate) fn shape(&mut self, vertices: &[Position]) -> bool {
        let [least, most] = bounds(vertices);
        let longest = (most[0] - least[0]).max(most[1] - least[1]);
        if is_broad(vertices, longest) {
            return self.polygon(vertices);
        }
        self.narrow_shape(vertices, longest)
    }

    fn narrow_shape(&mut self, vertices: &[Position], longest: i64) -> bool {
        if longest <= MAX_PIXELS * FINE && self.is_full_around(bounds(vertices)) {
            return true;
        }
        if longest <= LONGEST_DOT {
            if let Some(middle) = middle(vertices) {
                self.dot(&PEN, middle);
            }
            return true;
        }
        if longest <= NARROWEST
            && let Some(ends) = slim(vertices)
        {
            self.pen_line(ends);
            return true;
        }
        let mut hull = [[0; 2]; SOME_VERTICES];
        let is_convex = vertices.len() <= MAX_VERTICES
            && orientation(&sides::<MAX_VERTICES>(vertices)[..vertices.len()]).is_some();
        let convex = if is_convex {
            Some(vertices)
        } else {
            rounded(vertices, &mut hull)
        };
        match (convex, middle(vertices)) {
            (Some(convex), _) => self.narrow_convex(convex, longest),
            (None, Some(middle)) if longest <= NARROWEST => {
                self.dot(&PEN, middle);
                self.polygon(vertices)
            }
            _ => self.polygon(vertices),
        }
    }

    /// Returns whether a shape with these bounds covers nothing more: all its pixels are full, or outside.
    fn is_full_around(&self, bounds: [Position; 2]) -> bool {
        let pixels = self.pixels(around(bounds));
        pixels.is_none_or(|[columns, rows]| self.is_full(columns, rows))
    }

    /// Covers a convex polygon that may be narrower than a pixel.
    fn narrow_convex(&mut self, vertices: &[Position], longest: i64) -> bool {
        let width = width(vertices);
        let missing = NARROWEST as f64 - width;
        if missing <= 0.0 {
            return self.polygon(vertices);
        }
        let ends = farthest(vertices);
        if width >= LINE && longest <= MAX_PIXELS * FINE {
            self.moved(vertices, missing / 2.0, ends);
            return true;
        }
        self.pen_line(ends);
        width < LINE || self.polygon(vertices)
    }

    fn pen_line(&mut self, [from, to]: [Position; 2]) {
        self.dot(&PEN, from);
        self.line(&PEN, from, to);
    }

    /// Covers a small convex polygon with its sides moved outwards by `by` hundredths of a pixel, and
    /// extended at its ends by as much.
    fn moved(&mut self, vertices: &[Position], by: f64, ends: [Position; 2]) {
        let [least, most] = bounds(vertices);
        let Some([columns, rows]) = self.pixels(around([least, most])) else {
            return;
        };
        let sides = sides::<MAX_VERTICES>(vertices);
        let sides = &sides[..vertices.len()];
        let Some(orientation) = orientation(sides) else {
            return;
        };
        let centre = [columns[0], rows[0]].map(|pixel| pixel * FINE + FINE / 2);
        let mut edges = [HalfPlane::default(); MAX_VERTICES + 6];
        let mut count = 0;
        let mut add = |point: Position, vector: [i64; 2]| {
            edges[count] = HalfPlane::of(point, vector, centre).moved(by);
            count += 1;
        };
        for (&side, &to) in sides.iter().zip(vertices) {
            if side != [0, 0] {
                add(to, side.map(|along| along * orientation));
            }
        }
        // Acute corners would extend far.
        let [from, to] = ends;
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        add(from, [y, -x]);
        add(to, [-y, x]);
        add(least, [0, -1]);
        add(least, [1, 0]);
        add(most, [0, 1]);
        add(most, [-1, 0]);
        self.intersection(&mut edges[..count], columns, rows);
        self.touched.add(columns, rows);
    }
}

/// Returns the bounds of a shape that is broadened.
fn around([least, most]: [Position; 2]) -> [Position; 2] {
    let reach = NARROWEST / 2;
    [least.map(|low| low - reach), most.map(|high| high + reach)]
}

/// Returns whether a polygon is certainly as wide as a pixel, or too long and with too many vertices to be
/// examined.
#[inline]
fn is_broad(vertices: &[Position], longest: i64) -> bool {
    if longest > NARROWEST && vertices.len() > MAX_VERTICES {
        return true;
    }
    let Some(&from) = vertices.first() else {
        return true;
    };
    let mut twice = 0;
    let mut before = from;
    for &vertex in vertices {
        twice += (before[0] - from[0]) * (vertex[1] - from[1])
            - (before[1] - from[1]) * (vertex[0] - from[0]);
        before = vertex;
    }
    // The area of a convex shape is at most its width times its diameter, which is less than 3/2 of the
    // longer side of its bounding box.
    twice.abs() > 3 * NARROWEST * longest
}

/// Returns the centre of the bounding box of vertices, if there are any.
fn middle(vertices: &[Position]) -> Option<Position> {
    let [least, most] = bounds(vertices);
    let middle = [0, 1].map(|axis| i64::midpoint(least[axis], most[axis]));
    (!vertices.is_empty()).then_some(middle)
}

/// Returns the least distance between two parallel lines that enclose a convex polygon; 0 if it has no area.
///
/// One of the lines holds a side. The vertex farthest from it moves on with the side (rotating calipers,
/// Shamos 1978).
fn width(vertices: &[Position]) -> f64 {
    let count = vertices.len();
    let next = |number: usize| if number + 1 == count { 0 } else { number + 1 };
    // The least distance as a fraction of squares.
    let (mut square, mut of) = (f64::INFINITY, 1.0);
    let mut opposite = 0;
    for (number, &from) in vertices.iter().enumerate() {
        let to = vertices[next(number)];
        let [x, y] = [to[0] - from[0], to[1] - from[1]];
        if [x, y] == [0, 0] {
            continue;
        }
        let twice_area = |vertex: Position| {
            let [across, up] = [vertex[0] - from[0], vertex[1] - from[1]];
            (x * up - y * across).abs()
        };
        let mut farthest = twice_area(vertices[opposite]);
        for _ in 0..count {
            let behind = next(opposite);
            let area = twice_area(vertices[behind]);
            if area < farthest {
                break;
            }
            (opposite, farthest) = (behind, area);
        }
        let (farthest, length) = (farthest as f64, (x * x + y * y) as f64);
        if farthest * farthest * of < square * length {
            (square, of) = (farthest * farthest, length);
        }
    }
    if square.is_finite() {
        (square / of).sqrt()
    } else {
        0.0
    }
}

/// Returns the ends of the line of [`PEN`] that replaces a shape no longer than a pixel, if the shape is slim.
/// The line covers the area of the shape once it is a pixel wide.
#[expect(clippy::cast_possible_truncation, reason = "ends of a small shape")]
fn slim(vertices: &[Position]) -> Option<[Position; 2]> {
    let farthest = |from: &Position| {
        let distance = |to: &&Position| (to[0] - from[0]).pow(2) + (to[1] - from[1]).pow(2);
        vertices.iter().max_by_key(distance).copied()
    };
    // One of the longest diagonals, or nearly so, of a slim shape.
    let from = farthest(vertices.first()?)?;
    let to = farthest(&from)?;
    let way = [to[0] - from[0], to[1] - from[1]];
    let across = vertices
        .iter()
        .map(|at| way[0] * (at[1] - from[1]) - way[1] * (at[0] - from[0]));
    let (least, most) = across.fold((0, 0), |(least, most), at| (least.min(at), most.max(at)));
    let square = (way[0] * way[0] + way[1] * way[1]) as f64;
    // Width and length, times the length.
    let width = (most - least) as f64;
    if width > SLIM * square || square == 0.0 {
        return None;
    }
    // A cap is a half disc instead of a half square.
    let lost = (1.0 - PI / 4.0) * NARROWEST as f64;
    let by = (width - lost * square.sqrt()) / (2.0 * square);
    let step = way.map(|along| (along as f64 * by).round() as i64);
    Some([
        [from[0] + step[0], from[1] + step[1]],
        [to[0] - step[0], to[1] - step[1]],
    ])
}

/// Returns two vertices at the largest distance from each other.
fn farthest(vertices: &[Position]) -> [Position; 2] {
    let first = vertices.first().copied().unwrap_or_default();
    let mut farthest = (0, [first; 2]);
    for (number, &a) in vertices.iter().enumerate() {
        for &b in &vertices[number + 1..] {
            let [x, y] = [b[0] - a[0], b[1] - a[1]];
            let apart = x * x + y * y;
            if apart > farthest.0 {
                farthest = (apart, [a, b]);
            }
        }
    }
    farthest.1
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{CoverageBuffer, WHOLE};
    use super::width;

    /// Returns the area that a shape covers, in pixels.
    fn ink(vertices: &[[i64; 2]]) -> f64 {
        let mut plane = CoverageBuffer::new([30, 30]);
        assert!(plane.shape(vertices));
        let ink = plane.drained().iter().sum::<u32>();
        f64::from(ink) / f64::from(WHOLE)
    }

    #[test]
    fn shapes_shrink_to_dots() {
        let mut before = f64::INFINITY;
        for side in (0..=300).rev().step_by(3) {
            let square = [
                [1013, 1027],
                [1013 + side, 1027],
                [1013 + side, 1027 + side],
                [1013, 1027 + side],
            ];
            let ink = ink(&square);
            let exact = (side as f64 / 100.0).powi(2);
            assert!(ink > 0.7 && ink > exact - 0.1, "{side}: {ink}");
            assert!(
                ink < before + 0.1 && ink < exact.max(1.0) + 0.15,
                "{side}: {ink}"
            );
            before = ink;
        }
    }

    #[test]
    fn slivers_are_a_pixel_wide() {
        for [x, y] in [[1000, 0], [0, 1000], [600, 800], [-960, 280], [300, -400]] {
            let [a, b] = [[1500, 1500], [1500 + x, 1500 + y]];
            let long = ((x * x + y * y) as f64).sqrt() / 100.0;
            for width in [0, 1, 20, 60] {
                let across = [y, -x].map(|along| along * width / 1000);
                let [c, d] = [b, a].map(|[x, y]| [x + across[0], y + across[1]]);
                let ink = ink(&[a, b, c, d]);
                assert!(
                    (long..1.25 * (long + 1.0)).contains(&ink),
                    "{x}, {y}, {width}: {ink} of {long}"
                );
            }
        }
    }

    /// The pen stands on a grid of sixteenths of a pixel, hence the tolerance of a single petal.
    #[test]
    fn petals_cover_their_broadened_area() {
        let petal = [
            [-1.0, 0.0],
            [-0.5, -1.0],
            [0.5, -1.0],
            [1.0, 0.0],
            [0.5, 1.0],
            [-0.5, 1.0],
        ];
        for (long, ratio) in [(40.0, 0.4), (45.0, 0.1), (60.0, 0.3), (90.0, 0.45)] {
            let wide: f64 = long * ratio;
            let expected = 1.0 + (long - wide) / 100.0;
            let errors = (0..200).map(|number| {
                let (sine, cosine) = (f64::from(number) * 0.3).sin_cos();
                let vertices = petal.map(|[x, y]| {
                    let (x, y) = (x * long / 2.0, y * wide / 2.0);
                    let turned = [x * cosine - y * sine, x * sine + y * cosine];
                    #[expect(clippy::cast_possible_truncation, reason = "a small shape")]
                    turned.map(|at| (1000.0 + f64::from(number) * 7.3 + at).round() as i64)
                });
                let error = ink(&vertices) - expected;
                assert!(error.abs() < 0.25, "{long}, {ratio}, {number}: {error}");
                error
            });
            let mean = errors.sum::<f64>() / 200.0;
            assert!(mean.abs() < 0.05, "{long}, {ratio}: {mean} in the mean");
        }
    }

    /// Rounds to a grid so fine that convex polygons stay convex.
    #[expect(clippy::cast_possible_truncation, reason = "coordinates are small")]
    fn rounded(at: f64) -> i64 {
        (at * 1e4).round() as i64
    }

    /// Returns the least over all sides of the distance to the farthest vertex.
    fn width_by_all(vertices: &[[i64; 2]]) -> f64 {
        let next = vertices.iter().cycle().skip(1);
        let sides = vertices.iter().zip(next).filter(|(from, to)| from != to);
        let distances = sides.map(|(from, to)| {
            let [x, y] = [to[0] - from[0], to[1] - from[1]];
            let area = |it: &[i64; 2]| (x * (it[1] - from[1]) - y * (it[0] - from[0])).abs();
            let farthest = vertices.iter().map(area).max().unwrap_or_default();
            farthest as f64 / ((x * x + y * y) as f64).sqrt()
        });
        distances.fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// Polygons in an ellipse, with equal and collinear vertices, and both senses of rotation.
        #[test]
        fn calipers_find_the_width(
            mut turns in proptest::collection::vec(0_u32..360, 3..16),
            [long, short] in [1.0..500.0, 1.0..500.0],
            tilt in 0.0..3.0,
            is_reversed: bool,
        ) {
            turns.sort_unstable();
            let mut vertices: Vec<[i64; 2]> = turns
                .iter()
                .map(|&turn| {
                    let (sine, cosine) = f64::from(turn).to_radians().sin_cos();
                    let (x, y) = (long * cosine, short * sine);
                    let (sine, cosine) = f64::sin_cos(tilt);
                    [x * cosine - y * sine, x * sine + y * cosine].map(rounded)
                })
                .collect();
            if is_reversed {
                vertices.reverse();
            }
            prop_assume!(vertices.iter().any(|it| *it != vertices[0]));
            let expected = width_by_all(&vertices);
            let found = width(&vertices);
            prop_assert!((found - expected).abs() <= 1e-6 * expected.max(1.0), "{found}, {expected}");
        }
    }
}
