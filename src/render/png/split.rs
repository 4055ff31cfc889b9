//! Paths for bands: what tiny-skia draws of a picture must not depend on where bands begin.
//!
//! It cuts paths off at the edges of what it draws on, and rounds the ends that this makes. So all
//! lines get vertices where they cross certain rows, whichever band is drawn; bands begin in such
//! rows, and what is cut off there ends in a vertex.

use tiny_skia::{Path, PathBuilder, PathSegment, Point};

/// Lines have vertices in every so manieth row; bands begin in these.
pub(crate) const ROWS: u32 = 4;

/// Curves are drawn as lines that are no farther from them than this, in pixels.
const FLAT: f64 = 1.0 / 64.0;

/// A path of straight lines, with vertices in these rows as far as they are near a band, whose first
/// row comes to lie at 0.
pub(super) fn split(path: &Path, [top, bottom]: [u32; 2]) -> Option<Path> {
    let mut lines = Lines {
        path: PathBuilder::new(),
        top: f64::from(top),
        near: [f64::from(top) - f64::from(ROWS), f64::from(bottom + ROWS)],
        at: Point::zero(),
        is_held: false,
    };
    let mut start = Point::zero();
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(to) => {
                lines.end();
                (start, lines.at) = (to, to);
                lines.path.move_to(to.x, lines.moved(to.y));
            }
            PathSegment::LineTo(to) => lines.to(to),
            PathSegment::QuadTo(b, c) => {
                let [a, b, c] = [lines.at, b, c].map(double);
                let bend = distance(a, b, c);
                // A chord of 1/n of the parameter is no farther away than 2 bend / 8 n².
                lines.curve(0.25 * bend, c, |t| {
                    let s = 1.0 - t;
                    [0, 1].map(|i| s * s * a[i] + 2.0 * s * t * b[i] + t * t * c[i])
                });
            }
            PathSegment::CubicTo(b, c, d) => {
                let [a, b, c, d] = [lines.at, b, c, d].map(double);
                let bend = distance(a, b, c).max(distance(b, c, d));
                lines.curve(0.75 * bend, d, |t| {
                    let s = 1.0 - t;
                    [0, 1].map(|i| {
                        s * s * s * a[i] + 3.0 * s * t * (s * b[i] + t * c[i]) + t * t * t * d[i]
                    })
                });
            }
            PathSegment::Close => {
                lines.to(start);
                lines.end();
                lines.path.close();
            }
        }
    }
    lines.end();
    lines.path.finish()
}

struct Lines {
    path: PathBuilder,
    top: f64,
    /// Rows between which there are vertices.
    near: [f64; 2],
    at: Point,
    /// Whether that is still to be drawn: of lines that stay beyond these rows only the ends matter.
    is_held: bool,
}

impl Lines {
    /// A row in the band.
    #[expect(clippy::cast_possible_truncation, reason = "pixels are told in f32")]
    fn moved(&self, y: f32) -> f32 {
        (f64::from(y) - self.top) as f32
    }

    /// Draws what is held.
    fn end(&mut self) {
        if std::mem::take(&mut self.is_held) {
            self.path.line_to(self.at.x, self.moved(self.at.y));
        }
    }

    fn to(&mut self, to: Point) {
        let ([ax, ay], [bx, by]) = (double(self.at), double(to));
        if ay.max(by) < self.near[0] || ay.min(by) > self.near[1] {
            (self.at, self.is_held) = (to, true);
            return;
        }
        self.end();
        let step = f64::from(ROWS);
        let [low, high] = [ay.min(by).max(self.near[0]), ay.max(by).min(self.near[1])];
        let mut row = (low / step).ceil() * step;
        let mut rows = Vec::new();
        while row < high {
            rows.push(row);
            row += step;
        }
        if by < ay {
            rows.reverse();
        }
        for row in rows {
            let x = ax + (row - ay) / (by - ay) * (bx - ax);
            #[expect(clippy::cast_possible_truncation, reason = "pixels are told in f32")]
            self.path.line_to(x as f32, (row - self.top) as f32);
        }
        self.path.line_to(to.x, self.moved(to.y));
        self.at = to;
    }

    /// A curve that a single line would be so far away from.
    fn curve(&mut self, off: f64, end: [f64; 2], at: impl Fn(f64) -> [f64; 2]) {
        let count = (off / FLAT).sqrt().ceil().clamp(1.0, 1000.0);
        let mut number = 1.0;
        while number <= count {
            let [x, y] = if number == count {
                end
            } else {
                at(number / count)
            };
            #[expect(clippy::cast_possible_truncation, reason = "pixels are told in f32")]
            self.to(Point::from_xy(x as f32, y as f32));
            number += 1.0;
        }
    }
}

fn double(point: Point) -> [f64; 2] {
    [point.x.into(), point.y.into()]
}

/// How far three points are from evenly spaced ones on a line.
fn distance(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|i| a[i] - 2.0 * b[i] + c[i]);
    (x * x + y * y).sqrt()
}
