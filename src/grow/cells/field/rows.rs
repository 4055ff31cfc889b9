//! Iteration over the cells of a field, row by row, for drawing.

use super::{Field, SIDE, bits, corner};
use crate::geometry::DVec2;

/// Row of cells of a [`Field`].
pub(crate) struct CellRow<'f> {
    field: &'f Field,
    number: i64,
}

impl Field {
    /// Iterates over all rows of cells that may hold points, from the lowest.
    pub(crate) fn rows(&self) -> impl Iterator<Item = CellRow<'_>> {
        let from = self.low[1] * SIDE;
        let to = (self.low[1] + self.room[1]) * SIDE;
        (from..to).map(|number| CellRow {
            field: self,
            number,
        })
    }
}

impl CellRow<'_> {
    /// Returns the number of the row.
    pub(crate) fn number(&self) -> i64 {
        self.number
    }

    /// Visits the cells of the row that hold points, from left to right, as runs given by the centres of
    /// their end cells.
    pub(crate) fn visit_runs(&self, visit: impl FnMut([DVec2; 2])) {
        self.visit(|word, _| [word, word], visit);
    }

    /// Visits the cells as [`CellRow::visit_runs`] does, except that cells with at most two of four neighbours
    /// are given by their points, and cells with all four are visited only if `needs_inner` is set.
    pub(crate) fn visit_points(&self, needs_inner: bool, visit: impl FnMut([DVec2; 2])) {
        let Self { field, number } = *self;
        let sort = |word: u64, column: i64| {
            let [three, all] = field.neighbours(column, number);
            let visited = if needs_inner { word } else { word & !all };
            [visited, word & three]
        };
        self.visit(sort, visit);
    }

    /// Visits runs of cells with equal labels, given by the centres of their end cells.
    pub(crate) fn visit_labels(&self, mut visit: impl FnMut(u16, [DVec2; 2])) {
        let Self { field, number } = *self;
        let middle = |cell: i64| (corner([cell, number]) + 0.5) / field.scale;
        let mut run: Option<(u16, [i64; 2])> = None;
        for column in field.low[0]..field.low[0] + field.room[0] {
            for bit in bits(field.word(column, number)) {
                let cell = column * SIDE + bit;
                let label = u16::from_le_bytes(field.place([cell, number]).unwrap_or_default());
                match &mut run {
                    Some((of, [_, last])) if *of == label && *last + 1 == cell => *last = cell,
                    _ => {
                        if let Some((label, ends)) = run.replace((label, [cell; 2])) {
                            visit(label, ends.map(middle));
                        }
                    }
                }
            }
        }
        if let Some((label, ends)) = run {
            visit(label, ends.map(middle));
        }
    }

    /// Visits the cells of each word that `sort` returns first: those that it also returns second as runs,
    /// others by their points.
    fn visit(&self, sort: impl Fn(u64, i64) -> [u64; 2], mut visit: impl FnMut([DVec2; 2])) {
        let Self { field, number } = *self;
        let columns = field.low[0]..field.low[0] + field.room[0];
        let mut run: Option<[i64; 2]> = None;
        let middle = |cell: i64| (corner([cell, number]) + 0.5) / field.scale;
        for column in columns {
            let word = field.word(column, number);
            if word == 0 {
                continue;
            }
            let [visited, in_runs] = sort(word, column);
            for bit in bits(visited) {
                let cell = column * SIDE + bit;
                if in_runs >> bit & 1 == 0 {
                    visit([field.point([cell, number]); 2]);
                    continue;
                }
                match &mut run {
                    Some([_, last]) if *last + 1 == cell => *last = cell,
                    _ => {
                        if let Some(ends) = run.replace([cell; 2]) {
                            visit(ends.map(middle));
                        }
                    }
                }
            }
        }
        if let Some(ends) = run {
            visit(ends.map(middle));
        }
    }
}
