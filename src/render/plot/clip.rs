//! Clipping of lines to windows, and flattening of curves.

use crate::geometry::{DVec2, clip};
use crate::render::paint::Position;

/// Largest distance of a chord from its curve: 0.05 units of the picture.
const FLAT: f64 = 5.0;

/// Window in which lines are drawn, and the origin of positions in it, in positions of the picture.
#[derive(Clone, Copy)]
pub(super) struct ClipWindow {
    origin: Position,
    low: Position,
    high: Position,
}

impl ClipWindow {
    /// Returns the window of a whole picture.
    pub(super) fn of(size: [u32; 2]) -> Self {
        Self {
            origin: [0; 2],
            low: [0; 2],
            high: fine(size),
        }
    }

    /// Returns the window of a part with a corner and a size, in pixels of this window.
    pub(super) fn part(&self, corner: [u32; 2], size: [u32; 2]) -> Self {
        let (corner, size) = (fine(corner), fine(size));
        let origin = [0, 1].map(|axis| self.origin[axis] + corner[axis]);
        Self {
            origin,
            low: [0, 1].map(|axis| self.low[axis].max(origin[axis])),
            high: [0, 1].map(|axis| self.high[axis].min(origin[axis] + size[axis])),
        }
    }

    /// Returns the lower left and the upper right corner, in positions of the picture.
    pub(super) fn corners(&self) -> [Position; 2] {
        [self.low, self.high]
    }

    /// Converts a position of the window to one of the picture.
    #[inline]
    pub(super) fn place(&self, position: Position) -> Position {
        [0, 1].map(|axis| self.origin[axis].saturating_add(position[axis]))
    }

    /// Clips a line to the window; `None` if it lies outside. Ends inside the window are
    /// not changed.
    pub(super) fn clip(&self, [from, to]: [Position; 2]) -> Option<[Position; 2]> {
        let holds = |at: Position| {
            (0..2).all(|axis| (self.low[axis]..=self.high[axis]).contains(&at[axis]))
        };
        if holds(from) && holds(to) {
            return Some([from, to]);
        }
        let start = vector(from);
        let along = vector(to) - start;
        let [enter, leave] = clip(start, along, vector(self.low), vector(self.high))?;
        let at = |part: f64| {
            let inside = nearest(start + along * part);
            [0, 1].map(|axis| inside[axis].clamp(self.low[axis], self.high[axis]))
        };
        Some([
            if enter > 0.0 { at(enter) } else { from },
            if leave < 1.0 { at(leave) } else { to },
        ])
    }
}

/// Returns the vertices of a polyline along a cubic curve, without its start; they do not depend on the
/// direction of the curve.
pub(super) fn flattened(curve: [Position; 4]) -> Vec<Position> {
    let backwards = curve[0] > curve[3];
    let mut points = curve.map(vector);
    if backwards {
        points.reverse();
    }
    let [a, b, c, d] = points;
    let bend = (a - 2.0 * b + c).length().max((b - 2.0 * c + d).length());
    // The chord of 1/n of the parameter range is at most 6 bend / 8 n² away.
    let count = (0.75 * bend / FLAT).sqrt().ceil().clamp(1.0, 10_000.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "within these bounds"
    )]
    let inner = (1..count as u32).map(|number| {
        let t = f64::from(number) / count;
        let s = 1.0 - t;
        nearest(a * s * s * s + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * t * t * t)
    });
    let mut vertices: Vec<_> = inner.collect();
    if backwards {
        vertices.reverse();
    }
    vertices.push(curve[3]);
    vertices
}

#[expect(
    clippy::cast_precision_loss,
    reason = "what lies on a picture is exact"
)]
fn vector(position: Position) -> DVec2 {
    DVec2::new(position[0] as f64, position[1] as f64)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn nearest(point: DVec2) -> Position {
    [point.x.round() as i64, point.y.round() as i64]
}

fn fine(pixels: [u32; 2]) -> Position {
    pixels.map(|side| i64::from(side) * 100)
}

#[cfg(test)]
mod tests {
    use super::{ClipWindow, flattened};

    #[test]
    fn what_lies_outside_is_cut_off() {
        let window = ClipWindow::of([10, 10]).part([2, 2], [4, 20]);
        let cases = [
            ([[300, 300], [400, 900]], Some([[300, 300], [400, 900]])),
            ([[0, 500], [1000, 500]], Some([[200, 500], [600, 500]])),
            ([[300, 900], [300, 1100]], Some([[300, 900], [300, 1000]])),
            ([[0, 0], [400, 400]], Some([[200, 200], [400, 400]])),
            ([[0, 300], [100, 900]], None),
            ([[0, 900], [300, 1600]], None),
        ];
        for (line, expected) in cases {
            assert_eq!(window.clip(line), expected, "{line:?}");
        }
        assert_eq!(window.place([5, 7]), [205, 207]);
    }

    #[test]
    fn curves_have_the_same_vertices_from_either_end() {
        let curve = [[0, 0], [333, 1000], [701, -900], [1000, 117]];
        let mut there = vec![curve[0]];
        there.extend(flattened(curve));
        let [a, b, c, d] = curve;
        let mut back = vec![d];
        back.extend(flattened([d, c, b, a]));
        back.reverse();
        assert_eq!(there, back);
        assert!(there.len() > 10);
    }
}
