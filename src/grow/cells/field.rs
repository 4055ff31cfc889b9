//! Cells of the plane that hold points of a set, and one such point of each.

use crate::geometry::{Bounds, DVec2};

/// Cells along a side of a tile.
const SIDE: i64 = 64;
const WIDTH: usize = 64;

/// Steps to a cell in which its point is kept.
const STEPS: f64 = 256.0;

/// No tile.
const NONE: u32 = u32::MAX;

/// Tiles that lie farther from the origin are not kept.
const FARTHEST: i64 = 1 << 40;

/// The most tiles that a directory has room for.
const MOST_ROOM: i64 = 1 << 27;

/// Square cells of which some hold a point.
///
/// Cells are kept in tiles, and a directory of those grows with the set: its box need not be known.
#[derive(Debug)]
pub(crate) struct Field {
    /// Cells to a unit of length.
    scale: f64,
    /// The lower left tile of the directory, and its columns and rows.
    low: [i64; 2],
    room: [i64; 2],
    directory: Vec<u32>,
    tiles: Vec<Tile>,
    bounds: Bounds,
}

/// 64 × 64 cells.
#[derive(Debug)]
struct Tile {
    /// Rows of cells, the first one in the lowest bit.
    rows: [u64; WIDTH],
    /// Where in its cell the point of each lies.
    places: Box<[[u8; 2]]>,
}

/// A point that is farther from the origin than cells are numbered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TooFar;

/// A row of cells: what [`Field::rows`] gives.
pub(crate) struct Row<'f> {
    field: &'f Field,
    number: i64,
}

impl Field {
    /// No cells, of which so many would come to a unit of length.
    pub(super) fn new(scale: f64) -> Self {
        Self {
            scale,
            low: [0; 2],
            room: [0; 2],
            directory: Vec::new(),
            tiles: Vec::new(),
            bounds: Bounds::EMPTY,
        }
    }

    /// Cells to a unit of length.
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// The box of the points.
    pub(crate) fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The number of a tile, if there may be one.
    #[inline]
    fn slot(&self, tile: [i64; 2]) -> Option<usize> {
        let [column, row] = [tile[0] - self.low[0], tile[1] - self.low[1]];
        let is_in = |at: i64, room: i64| (0..room).contains(&at);
        let is_known = is_in(column, self.room[0]) && is_in(row, self.room[1]);
        let slot = || usize::try_from(row * self.room[0] + column).ok();
        is_known.then(slot).flatten()
    }

    #[inline]
    fn tile(&self, tile: [i64; 2]) -> Option<&Tile> {
        let number = self.directory[self.slot(tile)?];
        self.tiles.get(number as usize)
    }

    /// Whether the cell of a point holds one already.
    #[inline]
    pub(super) fn holds(&self, point: DVec2) -> bool {
        let cell = cell_of(point * self.scale);
        let [column, row] = within(cell);
        self.tile(tile_of(cell))
            .is_some_and(|tile| tile.rows[row] >> column & 1 == 1)
    }

    /// Adds a point, unless its cell holds one already; whether it did not.
    #[inline]
    pub(super) fn add(&mut self, point: DVec2) -> Result<bool, TooFar> {
        let scaled = point * self.scale;
        let cell = cell_of(scaled);
        let tile = tile_of(cell);
        let slot = match self.slot(tile) {
            Some(slot) => slot,
            None => self.make_room(tile)?,
        };
        if self.directory[slot] == NONE {
            self.directory[slot] = u32::try_from(self.tiles.len()).map_err(|_| TooFar)?;
            self.tiles.push(Tile::default());
        }
        let [column, row] = within(cell);
        let tile = &mut self.tiles[self.directory[slot] as usize];
        if tile.rows[row] >> column & 1 == 1 {
            return Ok(false);
        }
        tile.rows[row] |= 1 << column;
        tile.places[row * WIDTH + column] = place(scaled - corner(cell));
        self.bounds.add(point);
        Ok(true)
    }

    /// Adds a point that tells something of its cell, in the place of what is told before.
    pub(super) fn label(&mut self, point: DVec2, label: u8) -> Result<(), TooFar> {
        self.add(point)?;
        let cell = cell_of(point * self.scale);
        let [column, row] = within(cell);
        if let Some(slot) = self.slot(tile_of(cell)) {
            let tile = &mut self.tiles[self.directory[slot] as usize];
            tile.places[row * WIDTH + column] = [label; 2];
        }
        Ok(())
    }

    /// Whether the cell of a point tells a label.
    pub(super) fn has_label(&self, point: DVec2, label: u8) -> bool {
        self.place(cell_of(point * self.scale)) == Some([label; 2])
    }

    /// Forgets all points.
    pub(super) fn clear(&mut self) {
        for tile in &mut self.tiles {
            tile.rows = [0; WIDTH];
        }
    }

    /// Makes the directory larger, by more than it takes.
    fn make_room(&mut self, tile: [i64; 2]) -> Result<usize, TooFar> {
        if tile.iter().any(|at| at.abs() > FARTHEST) {
            return Err(TooFar);
        }
        let (mut low, mut room) = (self.low, self.room);
        for axis in 0..2 {
            let high = low[axis] + room[axis];
            let spare = 2 + room[axis] / 2;
            let is_new = room[axis] == 0;
            let from = if is_new || tile[axis] < low[axis] {
                tile[axis] - spare
            } else {
                low[axis]
            };
            let to = if is_new || tile[axis] >= high {
                tile[axis] + 1 + spare
            } else {
                high
            };
            (low[axis], room[axis]) = (from, to - from);
        }
        if room[0].saturating_mul(room[1]) > MOST_ROOM {
            return Err(TooFar);
        }
        let mut larger = Self {
            low,
            room,
            directory: vec![NONE; usize::try_from(room[0] * room[1]).map_err(|_| TooFar)?],
            ..Self::new(self.scale)
        };
        let columns = self.room[0].max(1);
        for (at, &number) in (0..).zip(&self.directory) {
            let known = [self.low[0] + at % columns, self.low[1] + at / columns];
            if let (true, Some(slot)) = (number != NONE, larger.slot(known)) {
                larger.directory[slot] = number;
            }
        }
        (self.low, self.room, self.directory) = (low, room, larger.directory);
        self.slot(tile).ok_or(TooFar)
    }

    /// Fills cells with no fewer than three neighbours of four that hold points: where the set has an area,
    /// a point of every cell leads to a point of most cells, not of all.
    pub(super) fn fill_pits(&mut self) {
        let mut filled = Vec::new();
        for (slot, &number) in (0..).zip(&self.directory) {
            if number == NONE {
                continue;
            }
            let [column, first] = [
                self.low[0] + slot % self.room[0],
                (self.low[1] + slot / self.room[0]) * SIDE,
            ];
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

    /// Which cells of a word have neighbours that hold points: three of four, and all.
    fn neighbours(&self, column: i64, row: i64) -> [u64; 2] {
        let word = self.word(column, row);
        let left = word << 1 | self.word(column - 1, row) >> 63;
        let right = word >> 1 | self.word(column + 1, row) << 63;
        let [below, above] = [row - 1, row + 1].map(|row| self.word(column, row));
        let (either, both) = (left | right, left & right);
        [
            both & (below | above) | either & (below & above),
            both & below & above,
        ]
    }

    /// All rows of cells that may hold points, from the lowest on.
    pub(crate) fn rows(&self) -> impl Iterator<Item = Row<'_>> {
        let from = self.low[1] * SIDE;
        let to = (self.low[1] + self.room[1]) * SIDE;
        (from..to).map(|number| Row {
            field: self,
            number,
        })
    }

    /// The cells of a row of a tile, as bits.
    fn word(&self, column: i64, row: i64) -> u64 {
        let tile = self.tile([column, row.div_euclid(SIDE)]);
        let row = usize::try_from(row.rem_euclid(SIDE)).unwrap_or(0);
        tile.map_or(0, |tile| tile.rows[row])
    }

    /// What is kept of a cell that holds a point: the place of that, or a label.
    fn place(&self, cell: [i64; 2]) -> Option<[u8; 2]> {
        let [column, row] = within(cell);
        let tile = self.tile(tile_of(cell))?;
        (tile.rows[row] >> column & 1 == 1).then(|| tile.places[row * WIDTH + column])
    }

    /// The point of a cell that holds one.
    fn point(&self, cell: [i64; 2]) -> DVec2 {
        let [x, y] = self.place(cell).unwrap_or_default();
        let place = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / STEPS;
        (corner(cell) + place) / self.scale
    }
}

impl Default for Tile {
    fn default() -> Self {
        Self {
            rows: [0; WIDTH],
            places: vec![[0; 2]; WIDTH * WIDTH].into(),
        }
    }
}

impl Row<'_> {
    /// The number of the row.
    pub(crate) fn number(&self) -> i64 {
        self.number
    }

    /// Visits the cells of the row that hold points, from left to right: as runs, by the middles of
    /// their ends.
    pub(crate) fn visit_runs(&self, visit: impl FnMut([DVec2; 2])) {
        self.visit(|word, _| [word, word], visit);
    }

    /// The same, but cells with no more than two neighbours of four by their points, and without those
    /// that have all four if they need not be visited.
    pub(crate) fn visit_points(&self, needs_inner: bool, visit: impl FnMut([DVec2; 2])) {
        let Self { field, number } = *self;
        let sort = |word: u64, column: i64| {
            let [three, all] = field.neighbours(column, number);
            let visited = if needs_inner { word } else { word & !all };
            [visited, word & three]
        };
        self.visit(sort, visit);
    }

    /// The same by runs of cells that have one label.
    pub(crate) fn visit_labels(&self, mut visit: impl FnMut(u8, [DVec2; 2])) {
        let Self { field, number } = *self;
        let middle = |cell: i64| (corner([cell, number]) + 0.5) / field.scale;
        let mut run: Option<(u8, [i64; 2])> = None;
        for column in field.low[0]..field.low[0] + field.room[0] {
            for bit in bits(field.word(column, number)) {
                let cell = column * SIDE + bit;
                let [label, _] = field.place([cell, number]).unwrap_or_default();
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

    /// Visits those cells of each word and column that come first of what `sort` makes of them: those
    /// that come second as runs, others by their points.
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

/// The numbers of the bits of a word that are set.
fn bits(mut word: u64) -> impl Iterator<Item = i64> {
    std::iter::from_fn(move || {
        let bit = word.trailing_zeros();
        word &= word.wrapping_sub(1);
        (bit < u64::BITS).then_some(bit.into())
    })
}

/// The cell of a point that is given in cells.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "casts from floats saturate, and what is far away is refused"
)]
fn cell_of(point: DVec2) -> [i64; 2] {
    [point.x, point.y].map(|at| {
        let towards_zero = at as i64;
        towards_zero - i64::from(at < towards_zero as f64)
    })
}

/// The place of a point in its cell.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
fn place(point: DVec2) -> [u8; 2] {
    [point.x, point.y].map(|at| (at * STEPS) as u8)
}

#[inline]
#[expect(
    clippy::cast_precision_loss,
    reason = "cells are fewer than 2^53 from the origin"
)]
fn corner(cell: [i64; 2]) -> DVec2 {
    DVec2::new(cell[0] as f64, cell[1] as f64)
}

#[inline]
fn tile_of(cell: [i64; 2]) -> [i64; 2] {
    cell.map(|at| at.div_euclid(SIDE))
}

/// Column and row of a cell in its tile.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "they are below 64")]
fn within(cell: [i64; 2]) -> [usize; 2] {
    cell.map(|at| (at & (SIDE - 1)).cast_unsigned() as usize)
}
