//! Grids of boxes on a picture, to find those that meet.

use crate::geometry::{Bounds, DVec2};

/// Largest number of cells along an axis.
const MAX_CELLS: f64 = 512.0;

/// Boxes in the cells that they meet.
pub(super) struct Grid {
    boxes: Vec<Bounds>,
    corner: DVec2,
    /// Cells a pixel.
    scale: DVec2,
    /// Numbers of cells along the axes.
    cells: [usize; 2],
    /// For each cell, in rows, the position of its first entry; and the number of entries.
    starts: Vec<usize>,
    entries: Vec<usize>,
}

impl Grid {
    pub(super) fn new(boxes: impl Iterator<Item = Bounds>) -> Self {
        let boxes: Vec<Bounds> = boxes.collect();
        let mut all = Bounds::EMPTY;
        let mut sides = DVec2::ZERO;
        for bounds in &boxes {
            all.add_all(bounds);
            sides += bounds.size();
        }
        let (corner, size) = match boxes.is_empty() {
            true => (DVec2::ZERO, DVec2::ZERO),
            false => (all.min(), all.size()),
        };
        #[expect(clippy::cast_precision_loss, reason = "a scale need not be exact")]
        let mean = sides / (boxes.len().max(1) as f64);
        // Cells as large as the boxes on average.
        let cells = (size / mean.max(size / MAX_CELLS)).max(DVec2::ONE);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the numbers are small"
        )]
        let cells = cells
            .to_array()
            .map(|it| if it.is_finite() { it as usize } else { 1 });
        #[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
        let scale = DVec2::new(cells[0] as f64, cells[1] as f64) / size;
        let mut grid = Self {
            boxes,
            corner,
            scale,
            cells,
            starts: vec![0; cells[0] * cells[1] + 1],
            entries: Vec::new(),
        };
        for number in 0..grid.boxes.len() {
            for cell in grid.cells_of(&grid.boxes[number]) {
                grid.starts[cell + 1] += 1;
            }
        }
        for cell in 1..grid.starts.len() {
            grid.starts[cell] += grid.starts[cell - 1];
        }
        let mut next = grid.starts.clone();
        grid.entries = vec![0; *grid.starts.last().unwrap_or(&0)];
        for number in 0..grid.boxes.len() {
            for cell in grid.cells_of(&grid.boxes[number]) {
                grid.entries[next[cell]] = number;
                next[cell] += 1;
            }
        }
        grid
    }

    /// Returns column and row of the cell of a point.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "casts saturate"
    )]
    fn cell(&self, point: DVec2) -> [usize; 2] {
        let at = (point - self.corner) * self.scale;
        let at = at.to_array().map(|it| it as usize);
        [at[0].min(self.cells[0] - 1), at[1].min(self.cells[1] - 1)]
    }

    fn cells_of(&self, bounds: &Bounds) -> impl Iterator<Item = usize> + use<> {
        let [[left, top], [right, bottom]] = [self.cell(bounds.min()), self.cell(bounds.max())];
        let columns = self.cells[0];
        (top..=bottom).flat_map(move |row| (left..=right).map(move |column| row * columns + column))
    }

    /// Calls `meet` for the numbers of all boxes that meet a box, once each.
    pub(super) fn each_near(&self, bounds: &Bounds, mut meet: impl FnMut(usize)) {
        for cell in self.cells_of(bounds) {
            self.each_in(cell, bounds, 0, &mut meet);
        }
    }

    /// Calls `meet` for the numbers of all pairs of boxes that meet, once each, the smaller number first.
    pub(super) fn each_pair(&self, mut meet: impl FnMut([usize; 2])) {
        for cell in 0..self.starts.len() - 1 {
            for at in self.starts[cell]..self.starts[cell + 1] {
                let first = self.entries[at];
                let skipped = at + 1 - self.starts[cell];
                self.each_in(cell, &self.boxes[first], skipped, &mut |second| {
                    meet([first, second]);
                });
            }
        }
    }

    /// Calls `meet` for the entries of a cell after the first ones whose boxes meet a box, if the cell is the one in
    /// which the common part begins.
    fn each_in(&self, cell: usize, bounds: &Bounds, skipped: usize, meet: &mut impl FnMut(usize)) {
        for &number in &self.entries[self.starts[cell] + skipped..self.starts[cell + 1]] {
            let other = &self.boxes[number];
            if other.meets(bounds) {
                let [column, row] = self.cell(other.min().max(bounds.min()));
                if row * self.cells[0] + column == cell {
                    meet(number);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Pcg;

    #[test]
    fn all_pairs_are_found_once() {
        let mut random = Pcg::new(1, 2);
        let mut number = || random.unit();
        let boxes: Vec<Bounds> = (0..300)
            .map(|_| {
                let corner = DVec2::new(number(), number()) * 100.0;
                Bounds::new(corner, corner + DVec2::new(number(), number()) * 20.0)
            })
            .collect();
        let mut expected = Vec::new();
        for (a, first) in boxes.iter().enumerate() {
            for (b, second) in boxes.iter().enumerate().skip(a + 1) {
                if first.meets(second) {
                    expected.push([a, b]);
                }
            }
        }
        let mut found = Vec::new();
        Grid::new(boxes.iter().copied()).each_pair(|pair| found.push(pair));
        found.sort_unstable();
        assert!(expected.len() > 300);
        assert_eq!(found, expected);
    }
}
