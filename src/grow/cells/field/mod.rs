//! Cells of the plane that hold points of a set, and one such point of each.

mod around;
mod rows;
mod spread;

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

impl Field {
    /// Returns a field without points, of a number of cells to a unit of length.
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

    /// Returns the number of a tile in the directory, if that has room for it.
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
        let [column, row] = within(cell);
        let tile = self.make_tile(tile_of(cell))?;
        if tile.rows[row] >> column & 1 == 1 {
            return Ok(false);
        }
        tile.rows[row] |= 1 << column;
        tile.places[row * WIDTH + column] = place(scaled - corner(cell));
        self.bounds.add(point);
        Ok(true)
    }

    /// Adds a point with a label for its cell, unless that has a greater one.
    #[inline]
    pub(super) fn label(&mut self, point: DVec2, label: u16) -> Result<(), TooFar> {
        let cell = cell_of(point * self.scale);
        let [column, row] = within(cell);
        let tile = self.make_tile(tile_of(cell))?;
        let place = &mut tile.places[row * WIDTH + column];
        let is_new = tile.rows[row] >> column & 1 == 0;
        if is_new || u16::from_le_bytes(*place) < label {
            *place = label.to_le_bytes();
        }
        if is_new {
            tile.rows[row] |= 1 << column;
            self.bounds.add(point);
        }
        Ok(())
    }

    /// A tile, with room for it.
    #[inline]
    fn make_tile(&mut self, tile: [i64; 2]) -> Result<&mut Tile, TooFar> {
        let slot = match self.slot(tile) {
            Some(slot) => slot,
            None => self.make_room(tile)?,
        };
        if self.directory[slot] == NONE {
            self.directory[slot] = u32::try_from(self.tiles.len()).map_err(|_| TooFar)?;
            self.tiles.push(Tile::default());
        }
        Ok(&mut self.tiles[self.directory[slot] as usize])
    }

    /// The label of the cell of a point, if it has one.
    pub(super) fn label_of(&self, point: DVec2) -> Option<u16> {
        self.place(cell_of(point * self.scale))
            .map(u16::from_le_bytes)
    }

    /// The number of the share that a point is of, of so many into which the tiles are divided.
    #[inline]
    pub(super) fn share_of(&self, point: DVec2, count: usize) -> usize {
        let [column, row] = tile_of(cell_of(point * self.scale));
        let along = column.wrapping_add(row).cast_unsigned();
        #[expect(clippy::cast_possible_truncation, reason = "it is below `count`")]
        {
            (along % count as u64) as usize
        }
    }

    /// Takes the tiles of another field of this scale, of which this one has none.
    pub(super) fn take_over(&mut self, other: Self) -> Result<(), TooFar> {
        let corners: Vec<[i64; 2]> = (0..other.directory.len())
            .map(|slot| other.corner_of(slot))
            .collect();
        let mut tiles: Vec<Option<Tile>> = other.tiles.into_iter().map(Some).collect();
        for (number, [column, row]) in other.directory.into_iter().zip(corners) {
            if let Some(tile) = tiles.get_mut(number as usize).and_then(Option::take) {
                *self.make_tile([column, row.div_euclid(SIDE)])? = tile;
            }
        }
        self.bounds.add_all(&other.bounds);
        Ok(())
    }

    /// Forgets all points.
    pub(super) fn clear(&mut self) {
        if !self.bounds.is_empty() {
            for tile in &mut self.tiles {
                tile.rows = [0; WIDTH];
            }
            self.bounds = Bounds::EMPTY;
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

    /// The points of all cells, but of those that another field of this scale holds.
    pub(super) fn points_without(&self, other: &Self) -> Vec<DVec2> {
        let mut points = Vec::new();
        for row in self.low[1] * SIDE..(self.low[1] + self.room[1]) * SIDE {
            for column in self.low[0]..self.low[0] + self.room[0] {
                let left = self.word(column, row) & !other.word(column, row);
                points.extend(bits(left).map(|bit| self.point([column * SIDE + bit, row])));
            }
        }
        points
    }

    /// The number of cells that hold a point, but of those that another field of this scale holds.
    pub(super) fn count_without(&self, other: &Self) -> usize {
        let mut count = 0;
        for row in self.low[1] * SIDE..(self.low[1] + self.room[1]) * SIDE {
            for column in self.low[0]..self.low[0] + self.room[0] {
                let left = self.word(column, row) & !other.word(column, row);
                count += left.count_ones() as usize;
            }
        }
        count
    }

    /// The column of a tile of the directory, and its first row of cells.
    fn corner_of(&self, slot: usize) -> [i64; 2] {
        let slot = i64::try_from(slot).unwrap_or(0);
        [
            self.low[0] + slot % self.room[0],
            (self.low[1] + slot / self.room[0]) * SIDE,
        ]
    }

    /// The cells of a row of a tile, as bits.
    fn word(&self, column: i64, row: i64) -> u64 {
        let tile = self.tile([column, row.div_euclid(SIDE)]);
        let row = usize::try_from(row.rem_euclid(SIDE)).unwrap_or(0);
        tile.map_or(0, |tile| tile.rows[row])
    }

    /// The two bytes kept for a cell that holds a point: the place of the point, or a label.
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
