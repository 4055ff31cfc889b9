//! Sequences of polylines.

use super::points::Point;

/// Sequence of strokes, each of two or more points; a stroke that ends where it begins is closed.
#[derive(Clone, Default)]
pub(super) struct Strokes {
    points: Vec<Point>,
    /// End of each stroke in the list of points.
    ends: Vec<usize>,
}

impl Strokes {
    /// Begins a stroke, and ends the one before.
    pub(super) fn begin(&mut self, at: Point) {
        self.end();
        self.points.push(at);
    }

    /// Extends the stroke to a point; has no effect if it is there already.
    pub(super) fn go_on(&mut self, to: Point) {
        if self.points.last() != Some(&to) {
            self.points.push(to);
        }
    }

    /// Ends the stroke; a stroke of one point is removed.
    pub(super) fn end(&mut self) {
        let start = self.ends.last().copied().unwrap_or(0);
        match self.points.len() - start {
            0 => {}
            1 => self.points.truncate(start),
            _ => self.ends.push(self.points.len()),
        }
    }

    /// Returns the current position, for [`go_back`](Self::go_back).
    pub(super) fn mark(&self) -> usize {
        self.points.len()
    }

    /// Returns to an earlier position within the current stroke.
    pub(super) fn go_back(&mut self, mark: usize) {
        self.points.truncate(mark);
    }

    /// Appends a stroke of two or more points, successive ones of which differ.
    pub(super) fn push(&mut self, stroke: &[Point]) {
        self.end();
        self.points.extend_from_slice(stroke);
        self.end();
    }

    /// Appends other strokes.
    pub(super) fn append(&mut self, other: Self) {
        let before = self.points.len();
        self.points.extend(other.points);
        self.ends.extend(other.ends.iter().map(|end| before + end));
    }

    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(super) fn get(&self, number: usize) -> &[Point] {
        let start = number.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.points[start..self.ends[number]]
    }

    pub(super) fn iter(&self) -> impl DoubleEndedIterator<Item = &[Point]> {
        (0..self.len()).map(|number| self.get(number))
    }
}

/// Returns whether a stroke ends where it begins.
pub(super) fn is_closed(stroke: &[Point]) -> bool {
    stroke.first() == stroke.last()
}
