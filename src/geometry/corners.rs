//! Corners of outlines in the plane, mapped together.

use super::{Bounds, Corners, DVec2, Frame2};

/// Corners of outlines, stored by coordinate for vector instructions.
#[derive(Debug, Default)]
pub struct Corners2 {
    xs: Vec<f64>,
    ys: Vec<f64>,
}

/// Number of corners that are mapped at once: their boxes fit into the vector registers.
const LANES: usize = 4;

impl Corners<Frame2> for Corners2 {
    fn add(&mut self, corner: DVec2) {
        // A line that continues from the last corner adds no new start.
        if self.xs.last() != Some(&corner.x) || self.ys.last() != Some(&corner.y) {
            self.xs.push(corner.x);
            self.ys.push(corner.y);
        }
    }

    fn add_to(&self, bounds: &mut Bounds, frame: &Frame2) {
        let map = frame.map();
        let [x, y] = [map.matrix2.row(0), map.matrix2.row(1)];
        let mut wide = [[f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]];
        let mut high = wide;
        let (xs, ys) = (self.xs.as_chunks(), self.ys.as_chunks());
        for (xs, ys) in xs.0.iter().zip(ys.0) {
            stretch(&mut wide, xs, ys, x);
            stretch(&mut high, xs, ys, y);
        }
        let lanes = if xs.0.is_empty() { 0 } else { LANES };
        for lane in 0..lanes {
            for [x, y] in [0, 1].map(|end| [wide[end][lane], high[end][lane]]) {
                bounds.add(map.translation + DVec2::new(x, y));
            }
        }
        for (&x, &y) in xs.1.iter().zip(ys.1) {
            bounds.add(map.transform_point2(DVec2::new(x, y)));
        }
    }
}

/// Extends a range by one coordinate of mapped corners.
#[inline]
fn stretch(range: &mut [[f64; LANES]; 2], xs: &[f64; LANES], ys: &[f64; LANES], row: DVec2) {
    let [low, high] = range;
    for lane in 0..LANES {
        let value = row.x * xs[lane] + row.y * ys[lane];
        // Each comparison of this form compiles to a single instruction.
        low[lane] = if value < low[lane] { value } else { low[lane] };
        high[lane] = if value > high[lane] {
            value
        } else {
            high[lane]
        };
    }
}
