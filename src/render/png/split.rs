//! Division of paths at rows, so that the output of tiny-skia does not depend on where bands begin. tiny-skia
//! clips paths at the edges of its pixmap and rounds the ends that result. All lines therefore get vertices
//! where they cross certain rows, whichever band is drawn; bands begin in these rows, and clipped lines end
//! in a vertex.

use tiny_skia::{Path, PathBuilder, PathSegment, Point};

/// Distance between the rows in which lines have vertices; bands begin in these.
pub(crate) const ROWS: u32 = 4;

/// Maximum deviation of lines from the curves that they replace, in pixels.
const FLAT: f64 = 1.0 / 64.0;

/// Returns a path of straight lines, with vertices in these rows near a band. The first row of the band
/// becomes row 0.
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
                // A chord over 1/n of the parameter deviates by at most 2 bend / 8 n².
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
    /// Rows between which lines get vertices.
    near: [f64; 2],
    at: Point,
    /// Whether the line to that point is pending: of lines that stay beyond these rows, only the ends matter.
    is_held: bool,
}

impl Lines {
    /// Converts a row of the picture to a row of the band.
    #[expect(clippy::cast_possible_truncation, reason = "pixels are given in f32")]
    fn moved(&self, y: f32) -> f32 {
        (f64::from(y) - self.top) as f32
    }

    /// Draws the pending line.
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
            #[expect(clippy::cast_possible_truncation, reason = "pixels are given in f32")]
            self.path.line_to(x as f32, (row - self.top) as f32);
        }
        self.path.line_to(to.x, self.moved(to.y));
        self.at = to;
    }

    /// Draws a curve from which a single chord would deviate by `off`.
    fn curve(&mut self, off: f64, end: [f64; 2], at: impl Fn(f64) -> [f64; 2]) {
        let count = (off / FLAT).sqrt().ceil().clamp(1.0, 1000.0);
        let mut number = 1.0;
        while number <= count {
            let [x, y] = if number == count {
                end
            } else {
                at(number / count)
            };
            #[expect(clippy::cast_possible_truncation, reason = "pixels are given in f32")]
            self.to(Point::from_xy(x as f32, y as f32));
            number += 1.0;
        }
    }
}

fn double(point: Point) -> [f64; 2] {
    [point.x.into(), point.y.into()]
}

/// Returns the length of the second difference of three points; 0 if they are evenly spaced on a line.
fn distance(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let [x, y] = [0, 1].map(|i| a[i] - 2.0 * b[i] + c[i]);
    (x * x + y * y).sqrt()
}
