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

/// Faces that hide what lies behind them.
pub(super) struct Hiding<'a> {
    faces: Vec<&'a Polygon>,
    grid: Grid,
    /// Largest difference of nearness that is a rounding error.
    tolerance: f64,
    /// Hidden parts of the line at hand, from 0 to 1 along it.
    hidden: Vec<[f64; 2]>,
}

impl<'a> Hiding<'a> {
    pub(super) fn of(faces: Vec<&'a Polygon>, tolerance: f64) -> Self {
        Self {
            grid: Grid::new(faces.iter().map(|face| *face.bounds())),
            faces,
            tolerance,
            hidden: Vec::new(),
        }
    }

    /// Calls `draw` for the visible parts of the edges of every face. `is_alike` compares the colours of two faces.
    pub(super) fn edges<E>(
        &mut self,
        is_alike: impl Fn(usize, usize) -> bool,
        mut draw: impl FnMut(usize, [DVec2; 2]) -> Result<(), E>,
    ) -> Result<(), E> {
        for number in 0..self.faces.len() {
            let face = self.faces[number];
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
                let (faces, hidden, tolerance) = (&self.faces, &mut self.hidden, self.tolerance);
                self.grid.each_near(&around, |other| {
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
                    } else {
                        hidden.extend(covered(before, edge, tolerance));
                    }
                });
                self.draw([from, to], |ends| draw(number, ends))?;
            }
        }
        Ok(())
    }

    /// Calls `draw` for the visible parts of a line that belongs to no face.
    pub(super) fn line<E>(
        &mut self,
        ends: [DVec3; 2],
        draw: impl FnMut([DVec2; 2]) -> Result<(), E>,
    ) -> Result<(), E> {
        let [from, to] = ends.map(DVec3::truncate);
        let (faces, hidden, tolerance) = (&self.faces, &mut self.hidden, self.tolerance);
        self.grid.each_near(&Bounds::new(from, to), |face| {
            hidden.extend(covered(faces[face], ends, tolerance));
        });
        self.draw([from, to], draw)
    }

    /// Calls `draw` for the parts of a line that are not hidden, and forgets those that are.
    fn draw<E>(
        &mut self,
        [from, to]: [DVec2; 2],
        mut draw: impl FnMut([DVec2; 2]) -> Result<(), E>,
    ) -> Result<(), E> {
        let length = from.distance(to);
        self.hidden.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut seen = 0.0;
        for [begin, end] in self.hidden.drain(..).chain([[1.0, 1.0]]) {
            if (begin - seen) * length > SHORTEST {
                // Ends are those of the line, where they are as near as rounding.
                let begin = if (1.0 - begin) * length < SHORTEST {
                    1.0
                } else {
                    begin
                };
                let start = if seen * length < SHORTEST { 0.0 } else { seen };
                draw([start, begin].map(|at| from.lerp(to, at)))?;
            }
            seen = f64::max(seen, end);
        }
        Ok(())
    }
}

/// Returns the part of a line before which a face lies.
fn covered(face: &Polygon, [from, to]: [DVec3; 2], tolerance: f64) -> Option<[f64; 2]> {
    let [begin, end] = face.crossing([from.truncate(), to.truncate()], BEYOND)?;
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
