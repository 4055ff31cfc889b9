//! Levels and tiles of a Deep Zoom pyramid: their numbers, their sizes, and the parts of the plane that they show.

use crate::render::{Canvas, Size};
use crate::style::View;

use super::super::super::shard::Shard;

/// Pyramid of levels, each of which is half as large as the next one. The first one is a single pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pyramid {
    /// Picture at the deepest level.
    canvas: Canvas,
    /// Side of a tile in pixels, without what overlaps.
    side: u32,
    /// Number of pixels by which a tile reaches into its neighbours.
    overlap: u32,
}

/// Tile of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Tile {
    pub(super) level: u32,
    pub(super) column: u32,
    pub(super) row: u32,
}

impl Pyramid {
    pub(super) fn new(canvas: Canvas, side: u32, overlap: u32) -> Self {
        Self {
            canvas,
            side,
            overlap,
        }
    }

    /// Returns the side of a tile in pixels, without what overlaps.
    pub(super) fn side(&self) -> u32 {
        self.side
    }

    /// Returns the number of pixels by which a tile reaches into its neighbours.
    pub(super) fn overlap(&self) -> u32 {
        self.overlap
    }

    /// Returns the number of the deepest level.
    pub(super) fn deepest(&self) -> u32 {
        let [width, height] = self.canvas.size();
        width.max(height).next_power_of_two().trailing_zeros()
    }

    /// Returns the width and height of a level in pixels.
    pub(super) fn size(&self, level: u32) -> [u32; 2] {
        let ratio = self.ratio(level);
        self.canvas.size().map(|side| side.div_ceil(ratio))
    }

    /// Returns the number of columns and rows of a level.
    pub(super) fn tiles(&self, level: u32) -> [u32; 2] {
        self.size(level).map(|side| side.div_ceil(self.side))
    }

    /// Returns the number of tiles of some levels.
    pub(super) fn count(&self, levels: impl IntoIterator<Item = u32>) -> u64 {
        let counts = levels.into_iter().map(|level| {
            let [columns, rows] = self.tiles(level).map(u64::from);
            columns * rows
        });
        counts.sum()
    }

    /// Returns the number of tiles of a part of a level.
    pub(super) fn count_of_part(&self, level: u32, shard: Shard) -> u64 {
        (self.count([level]) + u64::from(shard.count - shard.number)) / u64::from(shard.count)
    }

    /// Returns a tile of a part of a level, whose tiles are as many places apart as there are parts.
    pub(super) fn tile_of_part(&self, level: u32, shard: Shard, number: u64) -> Tile {
        let place = u64::from(shard.number - 1) + number * u64::from(shard.count);
        let columns = u64::from(self.tiles(level)[0]);
        let whole = |number: u64| u32::try_from(number).unwrap_or(u32::MAX);
        Tile {
            level,
            column: whole(place % columns),
            row: whole(place / columns),
        }
    }

    /// Returns the part of the plane that a tile shows, and its size.
    pub(super) fn place(&self, tile: Tile) -> (View, Size) {
        let ratio = f64::from(self.ratio(tile.level));
        let [left, right] = self.span(tile.column, self.size(tile.level)[0]);
        let [top, bottom] = self.span(tile.row, self.size(tile.level)[1]);
        let [x, y, _, height] = self.canvas.window();
        let units = |pixels: u32| f64::from(pixels) * ratio / self.canvas.scale();
        let window = [
            x + units(left),
            y + height - units(bottom),
            units(right - left),
            units(bottom - top),
        ];
        let view = View {
            window: Some(window),
            margin: Some(0.0),
        };
        (view, Size::Exactly(right - left, bottom - top))
    }

    /// Returns the first pixel of a tile and the one after its last, along one axis of a level.
    fn span(&self, number: u32, length: u32) -> [u32; 2] {
        let start = number * self.side;
        let end = (start + self.side + self.overlap).min(length);
        [start.saturating_sub(self.overlap), end]
    }

    /// Returns the number of pixels of the deepest level along one of this level.
    fn ratio(&self, level: u32) -> u32 {
        1 << (self.deepest() - level)
    }
}

#[cfg(test)]
mod tests {
    use super::{Pyramid, Shard, Tile};
    use crate::render::{Canvas, Size};
    use crate::style::View;

    fn pyramid(width: u32, height: u32, overlap: u32) -> Pyramid {
        let window = [-1.0, 2.0, f64::from(width) / 8.0, f64::from(height) / 8.0];
        let size = Size::Exactly(width, height);
        let canvas = Canvas::of_window(window, &View::default(), size).unwrap();
        Pyramid::new(canvas, 256, overlap)
    }

    #[test]
    fn levels_are_halved_up_to_a_pixel() {
        let pyramid = pyramid(1000, 300, 0);
        assert_eq!(pyramid.deepest(), 10);
        assert_eq!(pyramid.size(10), [1000, 300]);
        assert_eq!(pyramid.size(9), [500, 150]);
        assert_eq!(pyramid.size(3), [8, 3]);
        assert_eq!(pyramid.size(0), [1, 1]);
        assert_eq!(pyramid.tiles(10), [4, 2]);
        assert_eq!(pyramid.count(0..=10), 8 + 2 + 9);
        assert_eq!(self::pyramid(1024, 1, 0).deepest(), 10);
        assert_eq!(self::pyramid(1025, 1, 0).deepest(), 11);
        assert_eq!(self::pyramid(1, 1, 0).deepest(), 0);
    }

    #[test]
    fn tiles_cover_a_level_once_but_for_the_overlap() {
        for overlap in [0, 1] {
            let pyramid = pyramid(1000, 300, overlap);
            let tile = |column, row| {
                let tile = Tile {
                    level: 10,
                    column,
                    row,
                };
                let (view, size) = pyramid.place(tile);
                (view.window.unwrap(), size)
            };
            let more = f64::from(overlap) / 8.0;
            let (window, size) = tile(1, 0);
            let [left, right] = [31.0 - more, 63.0 + more];
            let [top, bottom] = [39.5, 7.5 - more];
            assert_eq!(window, [left, bottom, right - left, top - bottom]);
            assert_eq!(size, Size::Exactly(256 + 2 * overlap, 256 + overlap));
            let (window, size) = tile(3, 1);
            assert_eq!(window, [95.0 - more, 2.0, 29.0 + more, 5.5 + more]);
            assert_eq!(size, Size::Exactly(232 + overlap, 44 + overlap));
        }
    }

    #[test]
    fn parts_share_the_tiles() {
        let pyramid = pyramid(1000, 300, 0);
        let tiles = |level, number, count| {
            let shard = Shard { number, count };
            let own = 0..pyramid.count_of_part(level, shard);
            own.map(move |tile| pyramid.tile_of_part(level, shard, tile))
        };
        let mut all: Vec<_> = (1..=3).flat_map(|part| tiles(10, part, 3)).collect();
        assert_eq!(all.len(), 8);
        all.sort_by_key(|tile| (tile.row, tile.column));
        let whole: Vec<_> = tiles(10, 1, 1).collect();
        assert_eq!(all, whole);
        assert_eq!(tiles(10, 8, 8).count(), 1);
        assert_eq!(tiles(10, 9, 9).count(), 0);
        assert_eq!(tiles(3, 3, 3).count(), 0);
    }
}
