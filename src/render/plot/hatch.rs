//! Hatching: lines in place of fills.

use crate::geometry::DVec2;

use super::areas::Area;

/// Hatching of the filled areas of a plot.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Hatch {
    /// Pattern of the lines.
    pub pattern: HatchPattern,
    /// Distance of neighbouring lines, in units of the picture, from [`Hatch::LEAST_SPACING`].
    pub spacing: f64,
}

/// Pattern of the lines of a hatching.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum HatchPattern {
    /// Parallel lines in each of these directions, in degrees counter-clockwise from the x axis. Lines of neighbouring areas
    /// continue each other.
    Lines(Vec<f64>),
    /// Lines at equal distances from the outline, inside each area.
    #[cfg(feature = "contours")]
    Contour,
}

impl Hatch {
    /// Least distance of lines, in units of the picture.
    pub const LEAST_SPACING: f64 = 0.1;

    /// Returns a hatching; a spacing below [`Hatch::LEAST_SPACING`] is raised to it.
    #[must_use]
    pub fn new(pattern: HatchPattern, spacing: f64) -> Self {
        Self {
            pattern,
            spacing: spacing.max(Self::LEAST_SPACING),
        }
    }
}

/// Point where an edge crosses a line of a hatching.
#[derive(Clone, Copy)]
struct Crossing {
    /// Number of the line.
    line: i64,
    /// Position along the line.
    along: f64,
    /// Change of the winding number.
    turn: i32,
}

/// Calls `draw` for the parallel lines of an area, in a direction in degrees counter-clockwise and at a spacing in
/// positions.
pub(super) fn parallels(
    area: &Area<'_>,
    degrees: f64,
    spacing: f64,
    mut draw: impl FnMut([DVec2; 2]),
) {
    let (sine, cosine) = libm::sincos(degrees.to_radians());
    // Pictures have y down.
    let (along, across) = (DVec2::new(cosine, -sine), DVec2::new(sine, cosine));
    // Lines lie between multiples of the spacing, so that they do not coincide with edges at such places.
    let row = |point: DVec2| point.dot(across) / spacing - 0.5;
    let mut crossings = Vec::new();
    for [from, to] in area.edges() {
        let rows = [row(from), row(to)];
        let turn = if rows[0] < rows[1] { 1 } else { -1 };
        let [low, high] = [rows[0].min(rows[1]), rows[0].max(rows[1])].map(first_from);
        for line in low..high {
            #[expect(clippy::cast_precision_loss, reason = "lines of a picture are few")]
            let share = (line as f64 - rows[0]) / (rows[1] - rows[0]);
            crossings.push(Crossing {
                line,
                along: (from + (to - from) * share).dot(along),
                turn,
            });
        }
    }
    crossings.sort_unstable_by(|a, b| {
        let order = a.line.cmp(&b.line).then(a.along.total_cmp(&b.along));
        order.then(a.turn.cmp(&b.turn))
    });
    let mut winding = 0;
    let mut start = 0.0;
    for crossing in crossings {
        let before = winding;
        winding += crossing.turn;
        if before == 0 {
            start = crossing.along;
        } else if winding == 0 {
            #[expect(clippy::cast_precision_loss, reason = "lines of a picture are few")]
            let off = across * ((crossing.line as f64 + 0.5) * spacing);
            draw([start, crossing.along].map(|at| off + along * at));
        }
    }
}

/// Returns the first line at or after a row.
#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn first_from(row: f64) -> i64 {
    row.ceil() as i64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::paint::Position;
    use crate::render::plot::areas::{AreaPaint, Areas};

    /// Returns an area of contours, and its size.
    fn area(contours: &[&[Position]]) -> Areas {
        let mut areas = Areas::default();
        for contour in contours {
            areas.add(contour, [[0, 0], [1 << 20, 1 << 20]]);
        }
        areas.finish(AreaPaint {
            hides: true,
            hatched: Some(0),
        });
        areas
    }

    const SQUARE: &[Position] = &[[1000, 1000], [5000, 1000], [5000, 5000], [1000, 5000]];
    const HOLE: &[Position] = &[[2000, 2000], [2000, 4000], [4000, 4000], [4000, 2000]];
    const STAR: &[Position] = &[
        [3000, 500],
        [4470, 5023],
        [622, 2227],
        [5378, 2227],
        [1530, 5023],
    ];

    /// Area of the star: of a pentagram under the nonzero rule, with a circumscribed circle of radius 2500.
    fn star() -> f64 {
        let golden = (1.0 + 5.0f64.sqrt()) / 2.0;
        // Ten triangles with the centre, an outer and an inner vertex each.
        let inner = 2500.0 / (golden * golden);
        10.0 * 0.5 * 2500.0 * inner * libm::sin(std::f64::consts::PI / 5.0)
    }

    #[test]
    fn hatching_covers_areas_evenly() {
        let cases: [(&[&[Position]], f64); 3] = [
            (&[SQUARE], 16e6),
            (&[SQUARE, HOLE], 12e6),
            (&[STAR], star()),
        ];
        for (contours, size) in cases {
            let areas = area(contours);
            for degrees in [0.0, 30.0, 45.0, 90.0, 211.0] {
                let mut drawn = 0.0;
                parallels(&areas.get(0), degrees, 10.0, |[from, to]| {
                    drawn += from.distance(to);
                    let along = (to - from).normalize_or_zero();
                    let (sine, cosine) = libm::sincos(degrees.to_radians());
                    assert!(along.distance(DVec2::new(cosine, -sine)) < 1e-6);
                });
                let covered = drawn * 10.0;
                assert!(
                    (covered / size - 1.0).abs() < 2e-3,
                    "{degrees}: {covered} of {size}"
                );
            }
        }
    }

    #[test]
    fn lines_of_neighbours_continue_each_other() {
        let left = area(&[&[[0, 0], [1000, 0], [1000, 1000], [0, 1000]]]);
        let right = area(&[&[[1000, 0], [2000, 0], [2000, 1000], [1000, 1000]]]);
        let lines = |areas: &Areas| {
            let mut lines = Vec::new();
            parallels(&areas.get(0), 30.0, 70.0, |line| lines.push(line));
            lines
        };
        let ends: Vec<_> = lines(&left)
            .iter()
            .map(|line| line[1])
            .filter(|end| end.x > 999.0)
            .collect();
        let starts: Vec<_> = lines(&right)
            .iter()
            .map(|line| line[0])
            .filter(|end| end.x < 1001.0)
            .collect();
        assert!(ends.len() > 10);
        assert_eq!(ends.len(), starts.len());
        for (end, start) in ends.iter().zip(&starts) {
            assert!(end.distance(*start) < 1e-6);
        }
    }

    #[cfg(feature = "contours")]
    #[test]
    fn contours_lie_at_multiples_of_the_spacing() {
        use crate::geometry::distance_to_segment;
        for contours in [&[SQUARE, HOLE][..], &[STAR]] {
            let areas = area(contours);
            let area = areas.get(0);
            let mut drawn = 0.0;
            let mut count = 0;
            super::super::contours::contours(&area, 100.0, |line| {
                assert_eq!(line.first(), line.last());
                count += 1;
                for edge in line.windows(2) {
                    drawn += edge[0].distance(edge[1]);
                    let middle = edge[0].midpoint(edge[1]);
                    let distance = |[a, b]: [DVec2; 2]| distance_to_segment(middle, a, b);
                    let distance = area.edges().map(distance).fold(f64::INFINITY, f64::min);
                    let off = (distance / 100.0 - (distance / 100.0).round()).abs();
                    // The star has edges inside.
                    assert!(off < 0.02 || contours.len() == 1, "{distance}");
                }
            });
            let size = if contours.len() == 2 { 12e6 } else { star() };
            assert!(count > 5);
            // Lines at half the spacing would cover the area; these begin one spacing inside.
            let covered = drawn * 100.0 / size;
            assert!((0.75..0.99).contains(&covered), "{covered}");
        }
    }
}
