//! Propagation of labels to neighbouring cells.

use super::{Field, NoRoom, SIDE, WIDTH, bits, corner, tile_of, within};

impl Field {
    /// Adds the cells of another field of the same scale, each with the greatest label of the cells around
    /// it.
    pub(in crate::grow::cells) fn spread_to(&mut self, other: &Self) -> Result<(), NoRoom> {
        // Words with cells that have no label yet.
        let mut open = Vec::new();
        for row in other.low[1] * SIDE..(other.low[1] + other.room[1]) * SIDE {
            for column in other.low[0]..other.low[0] + other.room[0] {
                let left = other.word(column, row) & !self.word(column, row);
                open.extend((left != 0).then_some((column, row, left)));
            }
        }
        let mut found = Vec::new();
        loop {
            open.retain_mut(|(column, row, left)| {
                let reached = *left & self.reached(*column, *row);
                for bit in bits(reached) {
                    let cell = [*column * SIDE + bit, *row];
                    found.push((cell, self.greatest_around(cell)));
                }
                *left &= !reached;
                *left != 0
            });
            if found.is_empty() {
                return Ok(());
            }
            for (cell, label) in found.drain(..) {
                self.label((corner(cell) + 0.5) / self.scale, label)?;
            }
        }
    }

    /// Returns the cells of a word that hold points, or have a neighbour among eight that does.
    fn reached(&self, column: i64, row: i64) -> u64 {
        let [below, own, above] = [row - 1, row, row + 1].map(|row| {
            let word = self.word(column, row);
            let [left, right] = self.beside(column, row, word);
            word | left | right
        });
        below | own | above
    }

    /// Returns the greatest label of a cell and its eight neighbours; 0 if they have none.
    fn greatest_around(&self, cell: [i64; 2]) -> u16 {
        let within = within(cell);
        if within.iter().any(|at| [0, WIDTH - 1].contains(at)) {
            let around = (-1..=1).flat_map(|x| (-1..=1).map(move |y| [x, y]));
            let around = around.filter_map(|[x, y]| self.place([cell[0] + x, cell[1] + y]));
            return around.map(u16::from_le_bytes).max().unwrap_or(0);
        }
        let Some(tile) = self.tile(tile_of(cell)) else {
            return 0;
        };
        let [column, row] = within;
        let mut greatest = 0;
        for row in row - 1..=row + 1 {
            for column in column - 1..=column + 1 {
                if tile.rows[row] >> column & 1 == 1 {
                    let label = u16::from_le_bytes(tile.places[row * WIDTH + column]);
                    greatest = greatest.max(label);
                }
            }
        }
        greatest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DVec2;
    use std::collections::BTreeMap;

    fn middle(cell: [i64; 2]) -> DVec2 {
        corner(cell) + 0.5
    }

    /// Labels spread in rounds to all connected cells, across the borders of tiles, and no farther.
    #[test]
    fn labels_spread_by_rounds() {
        let mut other = Field::new(1.0);
        let band = (-70..70).flat_map(|x| (-3..3).map(move |y| [x, x + y]));
        let has_pit = |[x, y]: &[i64; 2]| (x * 7 + y * 3).rem_euclid(5) == 0;
        let band = band.filter(|cell| !has_pit(cell));
        let cells: Vec<[i64; 2]> = band.chain([[200, 0], [201, 1]]).collect();
        for &cell in &cells {
            other.add(middle(cell)).unwrap();
        }
        let mut field = Field::new(1.0);
        let mut expected = BTreeMap::new();
        for (&cell, label) in cells[..cells.len() - 2].iter().step_by(97).zip(1..) {
            field.label(middle(cell), label).unwrap();
            expected.insert(cell, label);
        }
        loop {
            let before = expected.clone();
            for &cell in &cells {
                let around =
                    (-1..=1).flat_map(|x| (-1..=1).map(move |y| [cell[0] + x, cell[1] + y]));
                let greatest = around.filter_map(|cell| before.get(&cell)).max();
                if let Some(&greatest) = greatest {
                    expected.entry(cell).or_insert(greatest);
                }
            }
            if expected.len() == before.len() {
                break;
            }
        }
        field.spread_to(&other).unwrap();
        assert!(expected.len() > 500 && expected.len() < cells.len());
        for x in -80..210 {
            for y in -80..80 {
                let label = field.label_of(middle([x, y]));
                assert_eq!(label, expected.get(&[x, y]).copied(), "{x} {y}");
            }
        }
    }
}
