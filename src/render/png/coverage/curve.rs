//! Flattening of curves to lines.

use super::Position;

/// Maximum deviation of the lines from the curve that they replace, in hundredths of a pixel.
const TOLERANCE: f64 = 1.0;

/// Maximum number of lines.
const MAX_LINES: f64 = 1e4;

/// Cubic Bézier curve.
type Curve = [[f64; 2]; 4];

/// Iterates over the ends of the lines that replace a curve.
pub(crate) fn flattened(curve: [Position; 4]) -> impl Iterator<Item = Position> {
    flattened_within(places(curve), TOLERANCE).map(rounded)
}

/// Iterates over the ends of the lines that replace a curve in any units, within a tolerance.
pub(crate) fn flattened_within(
    curve: Curve,
    tolerance: f64,
) -> impl ExactSizeIterator<Item = [f64; 2]> {
    lines(curve, min_lines(curve, tolerance), 1.0)
}

/// Iterates over the ends of the lines that replace a curve as a side of a polygon: they deviate equally to
/// both sides, and bound the same area. A picture may have millions of polygons, which would visibly lose
/// what chords cut off.
pub(crate) fn bounding(curve: [Position; 4]) -> impl ExactSizeIterator<Item = Position> {
    bounding_within(places(curve), TOLERANCE).map(rounded)
}

/// Iterates over the ends of the lines that bound the same area as a curve in any units, within a tolerance.
pub(crate) fn bounding_within(
    curve: Curve,
    tolerance: f64,
) -> impl ExactSizeIterator<Item = [f64; 2]> {
    let count = min_lines(curve, tolerance).max(2.0);
    // Evenly spaced chords of a parabola cut off the reciprocal of the square of their number.
    lines(curve, count, 1.0 / (1.0 - 1.0 / (count * count)))
}

fn places(curve: [Position; 4]) -> Curve {
    curve.map(|point| point.map(|place| place as f64))
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "curves lie between their controls"
)]
fn rounded(point: [f64; 2]) -> Position {
    point.map(|place| place.round() as i64)
}

/// Returns the number of lines that replace a curve.
fn min_lines([from, a, b, to]: Curve, tolerance: f64) -> f64 {
    let bend = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        let [x, y] = [0, 1].map(|axis| p[axis] - 2.0 * q[axis] + r[axis]);
        x * x + y * y
    };
    // Wang's bound of the distance between a curve and its chords (1984).
    let bend = bend(from, a, b).max(bend(a, b, to)).sqrt();
    let lines = (0.75 * bend / tolerance).sqrt().ceil();
    lines.clamp(1.0, MAX_LINES)
}

/// Iterates over the ends of `count` lines. Their distances from the line between the curve's ends are those
/// of the curve, multiplied by `swell`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small whole number"
)]
fn lines(curve: Curve, count: f64, swell: f64) -> impl ExactSizeIterator<Item = [f64; 2]> {
    let last = count as usize - 1;
    (0..last + 1).map(move |line| {
        if line == last {
            curve[3]
        } else {
            point(curve, (line + 1) as f64 / count, swell)
        }
    })
}

/// Returns a point of a curve, with its distance from the line between the ends multiplied by `swell`.
fn point([p, q, r, s]: Curve, t: f64, swell: f64) -> [f64; 2] {
    let u = 1.0 - t;
    [0, 1].map(|axis| {
        let [p, q, r, s] = [p, q, r, s].map(|control| control[axis]);
        let on_curve = u * u * (u * p + 3.0 * t * q) + t * t * (3.0 * u * r + t * s);
        let on_line = u * p + t * s;
        on_line + swell * (on_curve - on_line)
    })
}
