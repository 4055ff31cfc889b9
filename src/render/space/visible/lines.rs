//! Visible parts of edges, for drawings with hidden lines removed.
//!
//! An edge is cut where a face lies before it (Appel 1967, by intervals along the edge instead of counts), and left
//! out where faces in one plane meet.

use crate::geometry::{Bounds, DVec2, DVec3};

use super::grid::Grid;
use super::polygon::Polygon;

/// Pixels by which a face hides more than itself: lines behind its outline.
const BEYOND: f64 = 0.01;

/// Pixels beyond an edge at which another face is looked for.
const ASIDE: f64 = 0.02;

/// Length in pixels of the shortest parts.
const SHORTEST: f64 = 0.03;

/// Calls `draw` for the visible parts of the edges of every face. `is_alike` compares the colours of two faces;
/// differences of nearness up to `tolerance` are none.
pub(super) fn each<E>(
    faces: &[&Polygon],
    tolerance: f64,
    is_alike: impl Fn(usize, usize) -> bool,
    mut draw: impl FnMut(usize, [DVec2; 2]) -> Result<(), E>,
) -> Result<(), E> {
    let grid = Grid::new(faces.iter().map(|face| *face.bounds()));
    let mut hidden = Vec::new();
    for (number, face) in faces.iter().enumerate() {
        for (edge, is_edge) in face.edges() {
            let [from, to] = edge.map(DVec3::truncate);
            let length = from.distance(to);
            if !is_edge || length < SHORTEST {
                continue;
            }
            // The inside lies where edge × (point − corner) is positive.
            let aside = (to - from).perp() * (-ASIDE / length);
            let mut around = Bounds::new(from, to);
            around.add(from + aside);
            around.add(to + aside);
            hidden.clear();
            grid.each_near(&around, |other| {
                if other == number {
                    return;
                }
                let before = faces[other];
                let is_level = { face.corners().iter() }.all(|corner| {
                    let away = before.plane().at(corner.at.truncate()) - corner.at.z;
                    away.abs() <= tolerance
                });
                if is_level {
                    if is_alike(number, other) {
                        hidden.extend(before.crossing([from + aside, to + aside], ASIDE / 2.0));
                    }
                } else if let Some([begin, end]) = before.crossing([from, to], BEYOND) {
                    hidden.extend(covered(before, edge, [begin, end], tolerance));
                }
            });
            hidden.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let mut seen = 0.0;
            let all = hidden.iter().copied().chain([[1.0, 1.0]]);
            for [begin, end] in all {
                if (begin - seen) * length > SHORTEST {
                    // Ends are those of the edge, where they are as near as rounding.
                    let begin = if (1.0 - begin) * length < SHORTEST {
                        1.0
                    } else {
                        begin
                    };
                    let start = if seen * length < SHORTEST { 0.0 } else { seen };
                    draw(number, [start, begin].map(|at| from.lerp(to, at)))?;
                }
                seen = f64::max(seen, end);
            }
        }
    }
    Ok(())
}

/// Returns the part of an edge, within another part, before which a face lies.
fn covered(
    face: &Polygon,
    [from, to]: [DVec3; 2],
    [begin, end]: [f64; 2],
    tolerance: f64,
) -> Option<[f64; 2]> {
    let away = |at: f64| {
        let point = from.lerp(to, at);
        face.plane().at(point.truncate()) - point.z - tolerance
    };
    let [first, last] = [away(begin), away(end)];
    let zero = || begin + (end - begin) * first / (first - last);
    match (first > 0.0, last > 0.0) {
        (true, true) => Some([begin, end]),
        (true, false) => Some([begin, zero()]),
        (false, true) => Some([zero(), end]),
        (false, false) => None,
    }
}
