//! Operations on the cells of a field by their neighbours.

use super::{Field, NONE, SIDE, Tile, WIDTH, bits, within};

impl Field {
    /// Fills cells of which at least three of the four neighbours hold points. If a set has an area, the
    /// images of one point per cell reach most of its cells, but not all.
    pub(in crate::grow::cells) fn fill_pits(&mut self) {
        let mut filled = Vec::new();
        for (slot, &number) in self.directory.iter().enumerate() {
            if number == NONE {
                continue;
            }
            let [column, first] = self.corner_of(slot);
            for row in first..first + SIDE {
                let [three, _] = self.neighbours(column, row);
                let pits = three & !self.word(column, row);
                for bit in bits(pits) {
                    let cell = [column * SIDE + bit, row];
                    let beside = [[cell[0] - 1, row], [cell[0] + 1, row]];
                    let beside = beside.into_iter().find_map(|cell| self.place(cell));
                    filled.push((number as usize, within(cell), beside.unwrap_or_default()));
                }
            }
        }
        for (number, [column, row], place) in filled {
            let tile = &mut self.tiles[number];
            tile.rows[row] |= 1 << column;
            tile.places[row * WIDTH + column] = place;
        }
    }

    /// Returns the cells that hold points and whose eight neighbours all do.
    pub(in crate::grow::cells) fn inner(&self) -> Self {
        let mut inner = Self {
            low: self.low,
            room: self.room,
            directory: vec![NONE; self.directory.len()],
            ..Self::new(self.scale)
        };
        let between = |column: i64, row: i64| {
            let word = self.word(column, row);
            let [left, right] = self.beside(column, row, word);
            word & left & right
        };
        for (slot, number) in self.directory.iter().enumerate() {
            if *number == NONE {
                continue;
            }
            let [column, first] = self.corner_of(slot);
            let mut tile = Tile::default();
            let mut words = [first - 1, first].map(|row| between(column, row));
            for (row, inner) in (first..).zip(&mut tile.rows) {
                let above = between(column, row + 1);
                *inner = words[0] & words[1] & above;
                words = [words[1], above];
            }
            if tile.rows != [0; WIDTH] {
                inner.directory[slot] = u32::try_from(inner.tiles.len()).unwrap_or(NONE);
                inner.tiles.push(tile);
            }
        }
        inner
    }

    /// Returns whether the left and the right neighbours of the cells of a word hold points.
    pub(super) fn beside(&self, column: i64, row: i64, word: u64) -> [u64; 2] {
        [
            word << 1 | self.word(column - 1, row) >> 63,
            word >> 1 | self.word(column + 1, row) << 63,
        ]
    }

    /// Returns the cells of a word with at least three of four neighbours that hold points, and those with
    /// four.
    pub(super) fn neighbours(&self, column: i64, row: i64) -> [u64; 2] {
        let [left, right] = self.beside(column, row, self.word(column, row));
        let [below, above] = [row - 1, row + 1].map(|row| self.word(column, row));
        let (either, both) = (left | right, left & right);
        [
            both & (below | above) | either & (below & above),
            both & below & above,
        ]
    }
}
