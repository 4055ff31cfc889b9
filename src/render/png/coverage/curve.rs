use super::Position;

/// The most hundredths of a pixel that a curve is away from the lines which it is drawn as,
const TOLERANCE: f64 = 1.0;

/// and the most lines.
const MOST_LINES: f64 = 1e4;

/// Where the lines end which a cubic Bézier curve is drawn as.
pub(crate) fn flattened([from, a, b, to]: [Position; 4]) -> impl Iterator<Item = Position> {
    let bend = |p: Position, q: Position, r: Position| {
        let [x, y] = [0, 1].map(|axis| (p[axis] - 2 * q[axis] + r[axis]) as f64);
        x * x + y * y
    };
    // Wang's bound of the distance between a curve and its chords (1984).
    let bend = bend(from, a, b).max(bend(a, b, to)).sqrt();
    let lines = (0.75 * bend / TOLERANCE)
        .sqrt()
        .ceil()
        .clamp(1.0, MOST_LINES);
    let mut line = 0.0;
    std::iter::from_fn(move || {
        line += 1.0;
        match line {
            line if line < lines => Some(point([from, a, b, to], line / lines)),
            line if line > lines => None,
            _ => Some(to),
        }
    })
}

/// A point of a curve.
#[expect(
    clippy::cast_possible_truncation,
    reason = "curves lie between their controls"
)]
fn point([p, q, r, s]: [Position; 4], t: f64) -> Position {
    let u = 1.0 - t;
    [0, 1].map(|axis| {
        let [p, q, r, s] = [p, q, r, s].map(|control| control[axis] as f64);
        (u * u * (u * p + 3.0 * t * q) + t * t * (3.0 * u * r + t * s)).round() as i64
    })
}
