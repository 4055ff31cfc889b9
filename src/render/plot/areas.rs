//! Filled areas of a plot, and their place in the order of strokes.

use crate::geometry::DVec2;
use crate::render::paint::Position;

use super::points::vector;

/// Area under the nonzero rule: closed contours in positions of the picture.
#[derive(Clone, Copy)]
pub(super) struct Area<'a> {
    /// Vertices of all contours, one after another.
    vertices: &'a [[i32; 2]],
    /// End of each contour in the list of all vertices of the plot, and the start of the first.
    start: usize,
    ends: &'a [usize],
    pub(super) paint: AreaPaint,
}

/// Paint of an area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AreaPaint {
    /// Whether the area hides what lies under it.
    pub(super) hides: bool,
    /// Layer in which the area is hatched; `None` if it is not.
    pub(super) hatched: Option<usize>,
}

impl<'a> Area<'a> {
    /// Iterates over the contours.
    pub(super) fn contours(&self) -> impl Iterator<Item = &'a [[i32; 2]]> + use<'a> {
        let (vertices, first) = (self.vertices, self.start);
        let mut start = first;
        self.ends.iter().map(move |&end| {
            let contour = &vertices[start - first..end - first];
            start = end;
            contour
        })
    }

    /// Iterates over the edges.
    pub(super) fn edges(&self) -> impl Iterator<Item = [DVec2; 2]> + use<'a> {
        self.contours().flat_map(|contour| {
            let next = contour.iter().cycle().skip(1);
            let edges = contour.iter().zip(next);
            edges.map(|(&from, &to)| [vector(from), vector(to)])
        })
    }
}

/// Turn in the order of a plot: an area, and the strokes that lie above it and below the next area.
#[derive(Clone, Copy)]
pub(super) struct Turn {
    /// Layer of the strokes.
    pub(super) layer: usize,
    /// Number of strokes.
    pub(super) strokes: usize,
    /// Number of the area.
    pub(super) area: Option<usize>,
}

/// Areas of a plot.
#[derive(Default)]
pub(super) struct Areas {
    vertices: Vec<[i32; 2]>,
    ends: Vec<usize>,
    /// End of the contours of each area, and its paint.
    areas: Vec<(usize, AreaPaint)>,
    turns: Vec<Turn>,
}

impl Areas {
    /// Adds a contour, clipped to a box, to the area that [`Areas::finish`] ends.
    pub(super) fn add(&mut self, contour: &[Position], [low, high]: [Position; 2]) {
        let contour = clipped(contour, low, high);
        if contour.len() > 2 {
            self.vertices.extend(contour);
            self.ends.push(self.vertices.len());
        }
    }

    /// Ends an area; returns its number, or `None` if it has no contours.
    pub(super) fn finish(&mut self, paint: AreaPaint) -> Option<usize> {
        let before = self.areas.last().map_or(0, |area| area.0);
        (self.ends.len() > before).then(|| {
            self.areas.push((self.ends.len(), paint));
            self.areas.len() - 1
        })
    }

    /// Adds a turn to the order.
    pub(super) fn follow(&mut self, turn: Turn) {
        match self.turns.last_mut() {
            Some(last) if turn.area.is_none() && last.layer == turn.layer => {
                last.strokes += turn.strokes;
            }
            _ if turn.area.is_none() && turn.strokes == 0 => {}
            _ => self.turns.push(turn),
        }
    }

    /// Returns whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.areas.is_empty()
    }

    /// Returns the turns, in the order in which they are drawn.
    pub(super) fn turns(&self) -> &[Turn] {
        &self.turns
    }

    /// Returns an area.
    pub(super) fn get(&self, number: usize) -> Area<'_> {
        let first = number.checked_sub(1).map_or(0, |last| self.areas[last].0);
        let (end, paint) = self.areas[number];
        let start = first.checked_sub(1).map_or(0, |last| self.ends[last]);
        let ends = &self.ends[first..end];
        Area {
            vertices: &self.vertices[start..ends.last().copied().unwrap_or(start)],
            start,
            ends,
            paint,
        }
    }
}

/// Clips a contour to a box (Sutherland and Hodgman 1974). Winding numbers inside the box stay; the contour may run
/// along the sides of the box.
fn clipped(contour: &[Position], low: Position, high: Position) -> Vec<[i32; 2]> {
    let mut vertices = contour.to_vec();
    for axis in 0..2 {
        for (edge, side) in [(low[axis], 1), (high[axis], -1)] {
            let over = |at: &Position| at[axis].saturating_sub(edge).saturating_mul(side);
            if vertices.iter().all(|at| over(at) >= 0) {
                continue;
            }
            let given = std::mem::take(&mut vertices);
            let Some(mut from) = given.last() else { break };
            for to in &given {
                let [before, after] = [over(from), over(to)];
                if (before < 0) != (after < 0) {
                    vertices.push(at_edge([from, to], [before, after], axis, edge));
                }
                if after >= 0 {
                    vertices.push(*to);
                }
                from = to;
            }
        }
    }
    let mut vertices: Vec<_> = vertices.iter().map(place).collect();
    vertices.dedup();
    if vertices.first() == vertices.last() {
        vertices.pop();
    }
    vertices
}

/// Returns the point of a line on an edge, from the distances of its ends from the edge.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "between two positions"
)]
fn at_edge(line: [&Position; 2], over: [i64; 2], axis: usize, edge: i64) -> Position {
    let [before, after] = over.map(|it| it as f64);
    let share = before / (before - after);
    let other = line.map(|at| at[1 - axis] as f64);
    let mut at = [(other[0] + (other[1] - other[0]) * share).round() as i64; 2];
    at[axis] = edge;
    at
}

/// Returns a position in a box of a picture.
fn place(position: &Position) -> [i32; 2] {
    position.map(|value| i32::try_from(value).unwrap_or(i32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contours_are_clipped_to_windows() {
        let window = [[0, 0], [100, 100]];
        let cases: [(&[Position], &[[i32; 2]]); 4] = [
            (
                &[[10, 10], [20, 10], [20, 20]],
                &[[10, 10], [20, 10], [20, 20]],
            ),
            (
                &[[-50, 10], [50, 10], [50, 20], [-50, 20]],
                &[[0, 10], [50, 10], [50, 20], [0, 20]],
            ),
            // A huge square covers the window.
            (
                &[
                    [-(1 << 40), -5],
                    [1 << 40, -5],
                    [1 << 40, 200],
                    [-(1 << 40), 200],
                ],
                &[[0, 0], [100, 0], [100, 100], [0, 100]],
            ),
            (&[[-50, -50], [-10, -50], [-10, -10]], &[]),
        ];
        for (contour, expected) in cases {
            let clipped = clipped(contour, window[0], window[1]);
            let rotated = (0..expected.len().max(1)).any(|by| {
                let mut expected = expected.to_vec();
                expected.rotate_left(by);
                clipped == expected
            });
            assert!(rotated, "{contour:?}: {clipped:?}");
        }
    }

    #[test]
    fn areas_keep_their_contours() {
        let window = [[0, 0], [100, 100]];
        let paint = AreaPaint {
            hides: true,
            hatched: None,
        };
        let square = |x: i64| [[x, 0], [x + 9, 0], [x + 9, 9], [x, 9]];
        let mut areas = Areas::default();
        areas.add(&square(0), window);
        areas.add(&square(20), window);
        assert_eq!(areas.finish(paint), Some(0));
        assert_eq!(areas.finish(paint), None);
        areas.add(&square(40), window);
        assert_eq!(areas.finish(paint), Some(1));
        let firsts = |number| -> Vec<_> {
            let area = areas.get(number);
            area.contours()
                .map(|contour| (contour[0][0], contour.len()))
                .collect()
        };
        assert_eq!(firsts(0), [(0, 4), (20, 4)]);
        assert_eq!(firsts(1), [(40, 4)]);
        let first = areas.get(1).edges().next();
        assert_eq!(first, Some([DVec2::new(40.0, 0.0), DVec2::new(49.0, 0.0)]));
        assert_eq!(areas.get(1).edges().count(), 4);
    }
}
