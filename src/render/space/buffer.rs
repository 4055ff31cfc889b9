//! Depth buffer of a tile of the picture, with a pyramid of the farthest depths of blocks.
//!
//! A sample holds a *key*: the depth in multiples of 2⁻²² of the range, 0 the nearest, and in the low bits the
//! class of its colour. The least key wins, so that a tie goes to the first class and the order of drawing does
//! not show.

/// Samples along a side of a pixel.
pub(super) const SAMPLES: usize = 4;
/// Pixels along a side of a tile.
pub(super) const TILE: usize = 64;
/// Samples along a side of a tile.
pub(super) const SIDE: usize = TILE * SAMPLES;

/// Number of bits of a key below the depth.
pub(super) const CLASS_BITS: u32 = 10;
/// Largest class.
pub(super) const MAX_CLASS: u16 = (1 << CLASS_BITS) - 1;
/// Number of steps of depth between the near and the far end.
pub(super) const STEPS: f64 = ((1u32 << 22) - 2) as f64;
/// Key of a sample that shows nothing.
pub(super) const EMPTY: u32 = u32::MAX;

/// Exponents of the sides of blocks, in samples, from fine to coarse.
const BLOCKS: [u32; 4] = [2, 4, 6, 8];

/// Samples of a tile.
pub(super) struct Buffer {
    keys: Vec<u32>,
    /// Largest keys of blocks of 4 × 4, 16 × 16, 64 × 64 and 256 × 256 samples.
    pyramid: [Vec<u32>; 4],
}

impl Buffer {
    /// Creates a buffer that shows nothing.
    pub(super) fn new() -> Self {
        Self {
            keys: vec![EMPTY; SIDE * SIDE],
            pyramid: BLOCKS.map(|exponent| {
                let side = SIDE >> exponent;
                vec![EMPTY; side * side]
            }),
        }
    }

    /// Clears the buffer.
    pub(super) fn clear(&mut self) {
        self.keys.fill(EMPTY);
        self.pyramid.iter_mut().for_each(|level| level.fill(EMPTY));
    }

    /// Returns the keys of the samples in a row of the tile.
    pub(super) fn row(&self, y: usize) -> &[u32] {
        &self.keys[y * SIDE..(y + 1) * SIDE]
    }

    /// Returns the keys of the samples in a row of the tile, to be changed. [`refresh`](Self::refresh) has to
    /// follow.
    pub(super) fn row_mut(&mut self, y: usize) -> &mut [u32] {
        &mut self.keys[y * SIDE..(y + 1) * SIDE]
    }

    /// Returns whether all samples of a rectangle, without its last column and row, are strictly nearer than a
    /// depth.
    pub(super) fn hides(&self, [left, top, right, bottom]: [usize; 4], depth: u32) -> bool {
        let least = depth << CLASS_BITS;
        let extent = (right - left).max(bottom - top);
        // Blocks of which few cover the rectangle, then finer ones.
        let coarse = BLOCKS.iter().position(|exponent| extent <= 2 << exponent);
        let coarse = coarse.unwrap_or(BLOCKS.len() - 1);
        let hidden = |level: usize| {
            let exponent = BLOCKS[level];
            let side = SIDE >> exponent;
            let columns = left >> exponent..=(right - 1) >> exponent;
            let mut rows = top >> exponent..=(bottom - 1) >> exponent;
            rows.all(|row| {
                let row = &self.pyramid[level][row * side..(row + 1) * side];
                row[columns.clone()].iter().all(|key| *key < least)
            })
        };
        hidden(coarse) || (coarse > 0 && hidden(coarse - 1))
    }

    /// Updates the pyramid after samples of a rectangle have been changed.
    pub(super) fn refresh(&mut self, rectangle: [usize; 4]) {
        let [mut left, mut top, mut right, mut bottom] = rectangle;
        for level in 0..BLOCKS.len() {
            let step = if level == 0 {
                2
            } else {
                BLOCKS[level] - BLOCKS[level - 1]
            };
            let side = SIDE >> BLOCKS[level];
            let wide = side << step;
            (left, top) = (left >> step, top >> step);
            (right, bottom) = (((right - 1) >> step) + 1, ((bottom - 1) >> step) + 1);
            let mut changes = false;
            for row in top..bottom {
                for column in left..right {
                    let below: &[u32] = match level {
                        0 => &self.keys,
                        _ => &self.pyramid[level - 1],
                    };
                    let start = (row << step) * wide + (column << step);
                    let mut most = 0;
                    for line in 0..1usize << step {
                        let start = start + line * wide;
                        for key in &below[start..start + (1 << step)] {
                            most = most.max(*key);
                        }
                    }
                    let known = &mut self.pyramid[level][row * side + column];
                    changes |= *known != most;
                    *known = most;
                }
            }
            if !changes {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_rectangle_hides_what_is_strictly_behind() {
        let mut buffer = Buffer::new();
        let near = 100 << CLASS_BITS | 7;
        for y in 16..48 {
            buffer.row_mut(y)[16..64].fill(near);
        }
        buffer.refresh([16, 16, 64, 48]);
        assert!(buffer.hides([16, 16, 64, 48], 101));
        assert!(!buffer.hides([16, 16, 64, 48], 100));
        assert!(buffer.hides([21, 17, 30, 30], 101));
        assert!(!buffer.hides([12, 16, 64, 48], 101));
        buffer.clear();
        assert!(!buffer.hides([16, 16, 17, 17], 101));
    }
}
