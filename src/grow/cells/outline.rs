//! Points of outlines, of which neighbours are at most a cell apart.

use crate::geometry::{DAffine2, DVec2};
use crate::rule::BaseElement;

/// Number of lines that replace a curve.
const LINES: u32 = 64;

/// Visits points of an outline in the image of a map, and of the area of a closed outline, until `visit`
/// returns `false`. Returns whether all points were visited.
///
/// The visited points lie on the image. On a grid of `scale` cells per unit, no point of the image is farther
/// than a cell from one of them. Areas are those of the nonzero rule.
pub(super) fn visit(
    base_element: &BaseElement,
    map: &DAffine2,
    scale: f64,
    visit: &mut impl FnMut(DVec2) -> bool,
) -> bool {
    let corners = base_element.corners(map, LINES);
    let mut lines = corners.windows(2);
    lines.all(|ends| line(ends[0], ends[1], scale, visit))
        && (!base_element.is_closed() || fill(&corners, scale, visit))
}

/// Visits points of a line, including both ends.
fn line(from: DVec2, to: DVec2, scale: f64, visit: &mut impl FnMut(DVec2) -> bool) -> bool {
    let steps = ((to - from).abs().max_element() * scale).ceil().max(1.0);
    let mut step = 0.0;
    while step <= steps {
        if !visit(from.lerp(to, step / steps)) {
            return false;
        }
        step += 1.0;
    }
    true
}

/// Visits a point of every cell whose centre lies inside.
fn fill(corners: &[DVec2], scale: f64, visit: &mut impl FnMut(DVec2) -> bool) -> bool {
    let rows = corners.iter().map(|corner| corner.y * scale);
    let low = rows.clone().fold(f64::INFINITY, f64::min).floor();
    let high = rows.fold(f64::NEG_INFINITY, f64::max).ceil();
    let mut crossings: Vec<(f64, i32)> = Vec::new();
    let mut row = low;
    while row < high {
        let y = (row + 0.5) / scale;
        crossings.clear();
        for ends in corners.windows(2) {
            let turn = i32::from(ends[1].y > y) - i32::from(ends[0].y > y);
            if turn != 0 {
                let along = (y - ends[0].y) / (ends[1].y - ends[0].y);
                crossings.push((ends[0].lerp(ends[1], along).x, turn));
            }
        }
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut winding = 0;
        for pair in crossings.windows(2) {
            winding += pair[0].1;
            if winding != 0 {
                let mut column = (pair[0].0 * scale - 0.5).ceil();
                while column + 0.5 <= pair[1].0 * scale {
                    if !visit(DVec2::new((column + 0.5) / scale, y)) {
                        return false;
                    }
                    column += 1.0;
                }
            }
        }
        row += 1.0;
    }
    true
}
