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

/// Samples around a tile into which stamps may be drawn, and that are not seen.
pub(super) const MARGIN: usize = 32;
/// Samples along a side of a tile and its margin.
pub(super) const STRIDE: usize = SIDE + 2 * MARGIN;

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
    /// Keys of the samples and of the margin.
    keys: Vec<u32>,
    /// Largest keys of blocks of 4 × 4, 16 × 16, 64 × 64 and 256 × 256 samples.
    pyramid: [Vec<u32>; 4],
}

impl Buffer {
    /// Creates a buffer that shows nothing.
    pub(super) fn new() -> Self {
        Self {
            keys: vec![EMPTY; STRIDE * STRIDE],
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
        &self.keys[place(y)..place(y) + SIDE]
    }

    /// Returns the keys of the samples in a row of the tile, to be changed. [`refresh`](Self::refresh) has to
    /// follow.
    pub(super) fn row_mut(&mut self, y: usize) -> &mut [u32] {
        &mut self.keys[place(y)..place(y) + SIDE]
    }

    /// Returns the keys of the samples and of the margin, in rows, to be changed. [`refresh`](Self::refresh) has to
    /// follow.
    pub(super) fn with_margin(&mut self) -> &mut [u32] {
        &mut self.keys
    }

    /// Returns whether all samples of a rectangle, without its last column and row, are strictly nearer than a
    /// depth.
    #[inline]
    pub(super) fn hides(&self, [left, top, right, bottom]: [usize; 4], depth: u32) -> bool {
        let least = depth << CLASS_BITS;
        let extent = (right - left).max(bottom - top);
        // Blocks of which few cover the rectangle, then finer ones.
        let mut coarse = 0;
        while coarse + 1 < BLOCKS.len() && extent > 2 << BLOCKS[coarse] {
            coarse += 1;
        }
        self.is_hidden(coarse, [left, top, right, bottom], least)
            || (coarse > 0 && self.is_hidden(coarse - 1, [left, top, right, bottom], least))
    }

    /// Returns whether all blocks of a level that a rectangle meets are nearer than a key.
    #[inline(always)]
    fn is_hidden(&self, level: usize, [left, top, right, bottom]: [usize; 4], least: u32) -> bool {
        let exponent = BLOCKS[level];
        let side = SIDE >> exponent;
        let (first, last) = (left >> exponent, (right - 1) >> exponent);
        let blocks = &self.pyramid[level];
        for row in top >> exponent..=(bottom - 1) >> exponent {
            for key in &blocks[row * side + first..=row * side + last] {
                if *key >= least {
                    return false;
                }
            }
        }
        true
    }

    /// Returns the least rectangle within one that contains its samples which are not strictly nearer than a depth;
    /// `None` if there are none.
    pub(super) fn open(
        &self,
        [left, top, right, bottom]: [usize; 4],
        depth: u32,
    ) -> Option<[usize; 4]> {
        let least = depth << CLASS_BITS;
        let is_open = |key: &u32| *key >= least;
        let [mut first, mut last] = [right, left];
        let [mut upper, mut lower] = [bottom, top];
        for y in top..bottom {
            let row = &self.row(y)[left..right];
            if let Some(at) = row.iter().position(is_open) {
                first = first.min(left + at);
                last = last.max(right - row.iter().rev().position(is_open).unwrap_or(0));
                upper = upper.min(y);
                lower = y + 1;
            }
        }
        (upper < lower).then_some([first, upper, last, lower])
    }

    /// Updates the pyramid after samples of a rectangle have been changed, which may reach into the margin: it is
    /// counted from the corner of that.
    pub(super) fn refresh_with_margin(&mut self, [left, top, right, bottom]: [usize; 4]) {
        let [left, top, right, bottom] =
            [left, top, right, bottom].map(|at| at.saturating_sub(MARGIN).min(SIDE));
        if left < right && top < bottom {
            self.refresh([left, top, right, bottom]);
        }
    }

    /// Updates the pyramid after samples of a rectangle have been changed.
    pub(super) fn refresh(&mut self, [left, top, right, bottom]: [usize; 4]) {
        const BLOCK: usize = 1 << BLOCKS[0];
        let mut range = [left, top, right - 1, bottom - 1].map(|end| end >> BLOCKS[0]);
        let mut changes = false;
        for row in range[1]..=range[3] {
            for column in range[0]..=range[2] {
                let start = place(row * BLOCK) + column * BLOCK;
                let lines: [&[u32]; BLOCK] = std::array::from_fn(|line| {
                    let start = start + line * STRIDE;
                    &self.keys[start..start + BLOCK]
                });
                let most = lines.into_iter().flatten().fold(0, |a, b| a.max(*b));
                let known = &mut self.pyramid[0][row * (SIDE >> BLOCKS[0]) + column];
                changes |= *known != most;
                *known = most;
            }
        }
        for level in 1..BLOCKS.len() {
            if !changes {
                return;
            }
            let step = BLOCKS[level] - BLOCKS[level - 1];
            let side = SIDE >> BLOCKS[level];
            let (fine, coarse) = self.pyramid.split_at_mut(level);
            let fine = &fine[level - 1];
            range = range.map(|end| end >> step);
            changes = false;
            for row in range[1]..=range[3] {
                for column in range[0]..=range[2] {
                    let mut most = 0;
                    for line in row << step..(row + 1) << step {
                        let start = (line * side + column) << step;
                        for key in &fine[start..start + (1 << step)] {
                            most = most.max(*key);
                        }
                    }
                    let known = &mut coarse[0][row * side + column];
                    changes |= *known != most;
                    *known = most;
                }
            }
        }
    }
}

/// Returns the place of the first sample of a row.
fn place(y: usize) -> usize {
    (y + MARGIN) * STRIDE + MARGIN
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
