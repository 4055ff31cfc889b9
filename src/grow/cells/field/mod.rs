//! Fields of square cells, with one point of a set for each cell that holds any.

mod around;
mod rows;
mod spread;

use crate::geometry::{Bounds, DVec2};
use crate::saturating::ones;

/// Number of cells along a side of a tile.
const SIDE: i64 = 64;
const WIDTH: usize = 64;

/// Steps per cell in which the position of its point is stored.
const STEPS: f64 = 256.0;

/// Index of no tile.
const NONE: u32 = u32::MAX;

/// Maximum distance of tiles from the origin, in tiles.
const FARTHEST: i64 = 1 << 40;

/// Maximum number of tiles in a directory.
const MAX_ROOM: i64 = 1 << 25;

/// Maximum number of tiles of a field, about 570 MB.
const MAX_TILES: usize = 1 << 16;

/// Square cells, some of which hold a point.
///
/// Cells are stored in tiles. The directory of tiles grows with the set, whose bounding box need not be
/// known.
#[derive(Debug)]
pub(crate) struct Field {
    /// Number of cells per unit of length.
    scale: f64,
    /// Lower left tile of the directory.
    low: [i64; 2],
    /// Numbers of columns and rows of the directory.
    room: [i64; 2],
    directory: Vec<u32>,
    tiles: Vec<Tile>,
    bounds: Bounds,
}

/// Tile of 64 × 64 cells.
#[derive(Debug)]
struct Tile {
    /// Rows of cells, with the first cell in the lowest bit.
    rows: [u64; WIDTH],
    /// Position in the cell of each point, or label of the cell.
    places: Box<[[u8; 2]]>,
}

/// Error that a field has no room for a point: it is too far from the origin, or needs one tile too many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NoRoom;

impl Field {
    /// Creates a field without points, with `scale` cells per unit of length.
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

    /// Returns the number of cells per unit of length.
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns the bounding box of the points.
    pub(crate) fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns the index of a tile in the directory, if the directory has room for it.
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

    /// Returns whether the cell of a point holds one already.
    #[inline]
    pub(super) fn holds(&self, point: DVec2) -> bool {
        let cell = cell_of(point * self.scale);
        let [column, row] = within(cell);
        self.tile(tile_of(cell))
            .is_some_and(|tile| tile.rows[row] >> column & 1 == 1)
    }

    /// Adds a point, unless its cell holds one already. Returns whether it was added.
    #[inline]
    pub(super) fn add(&mut self, point: DVec2) -> Result<bool, NoRoom> {
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

    /// Adds a point with a label for its cell, unless the cell has a greater label.
    #[inline]
    pub(super) fn label(&mut self, point: DVec2, label: u16) -> Result<(), NoRoom> {
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

    /// Returns a tile, which is created if it does not exist yet.
    #[inline]
    fn make_tile(&mut self, tile: [i64; 2]) -> Result<&mut Tile, NoRoom> {
        let slot = match self.slot(tile) {
            Some(slot) => slot,
            None => self.make_room(tile)?,
        };
        if self.directory[slot] == NONE {
            let number = Some(self.tiles.len()).filter(|&number| number < MAX_TILES);
            self.directory[slot] = number.and_then(|it| it.try_into().ok()).ok_or(NoRoom)?;
            self.tiles.push(Tile::default());
        }
        Ok(&mut self.tiles[self.directory[slot] as usize])
    }

    /// Returns the label of the cell of a point, if it has one.
    pub(super) fn label_of(&self, point: DVec2) -> Option<u16> {
        self.place(cell_of(point * self.scale))
            .map(u16::from_le_bytes)
    }

    /// Returns the index of the share that contains a point, if the tiles are divided into `count` shares.
    #[inline]
    pub(super) fn share_of(&self, point: DVec2, count: usize) -> usize {
        let [column, row] = tile_of(cell_of(point * self.scale));
        let along = column.wrapping_add(row).cast_unsigned();
        #[expect(clippy::cast_possible_truncation, reason = "it is below `count`")]
        {
            (along % count as u64) as usize
        }
    }

    /// Moves the tiles of another field of the same scale to this one, which has none of them.
    pub(super) fn take_over(&mut self, other: Self) -> Result<(), NoRoom> {
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

    /// Removes all points.
    pub(super) fn clear(&mut self) {
        if !self.bounds.is_empty() {
            for tile in &mut self.tiles {
                tile.rows = [0; WIDTH];
            }
            self.bounds = Bounds::EMPTY;
        }
    }

    /// Enlarges the directory by more than a tile requires, and returns the index of the tile.
    fn make_room(&mut self, tile: [i64; 2]) -> Result<usize, NoRoom> {
        if tile.iter().any(|at| at.abs() > FARTHEST) {
            return Err(NoRoom);
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
        if room[0].saturating_mul(room[1]) > MAX_ROOM {
            return Err(NoRoom);
        }
        let mut larger = Self {
            low,
            room,
            directory: vec![NONE; usize::try_from(room[0] * room[1]).map_err(|_| NoRoom)?],
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
        self.slot(tile).ok_or(NoRoom)
    }

    /// Returns the points of all cells, except of those in which another field of the same scale holds one.
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

    /// Returns the number of cells that hold a point, except of those in which another field of the same
    /// scale does.
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

    /// Returns the column of a tile of the directory, and its first row of cells.
    fn corner_of(&self, slot: usize) -> [i64; 2] {
        let slot = i64::try_from(slot).unwrap_or(0);
        [
            self.low[0] + slot % self.room[0],
            (self.low[1] + slot / self.room[0]) * SIDE,
        ]
    }

    /// Returns the cells of a row of a tile, as bits.
    fn word(&self, column: i64, row: i64) -> u64 {
        let tile = self.tile([column, row.div_euclid(SIDE)]);
        let row = usize::try_from(row.rem_euclid(SIDE)).unwrap_or(0);
        tile.map_or(0, |tile| tile.rows[row])
    }

    /// Returns the two bytes of a cell that holds a point: the position of the point, or a label.
    fn place(&self, cell: [i64; 2]) -> Option<[u8; 2]> {
        let [column, row] = within(cell);
        let tile = self.tile(tile_of(cell))?;
        (tile.rows[row] >> column & 1 == 1).then(|| tile.places[row * WIDTH + column])
    }

    /// Returns the point of a cell that holds one.
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

/// Iterates over the indices of the set bits of a word.
fn bits(word: u64) -> impl Iterator<Item = i64> {
    ones(word).map(i64::from)
}

/// Returns the cell of a point that is given in units of cells.
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

/// Returns the position of a point in its cell, in steps.
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

/// Returns column and row of a cell in its tile.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "they are below 64")]
fn within(cell: [i64; 2]) -> [usize; 2] {
    cell.map(|at| (at & (SIDE - 1)).cast_unsigned() as usize)
}
