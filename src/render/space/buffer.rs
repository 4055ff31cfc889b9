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
/// Depth of the far end.
pub(super) const LAST_DEPTH: i32 = (1 << 22) - 2;
/// Number of steps of depth between the near and the far end.
pub(super) const STEPS: f64 = LAST_DEPTH as f64;
/// Key of a sample that shows nothing.
pub(super) const EMPTY: u32 = u32::MAX;

/// Exponents of the sides of blocks, in samples, from fine to coarse.
const BLOCKS: [u32; 4] = [2, 4, 6, 8];

/// Side of the smallest blocks, in samples.
pub(super) const BLOCK: usize = 1 << BLOCKS[0];

/// Number of the smallest blocks along a side of a tile.
pub(super) const BLOCKS_ALONG: usize = SIDE / BLOCK;

/// Number of keys that are compared together.
const PIECE: usize = 8;

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

    /// Returns the keys in the rows of samples of a row of pixels.
    pub(super) fn rows_of_pixels(&self, y: usize) -> [&[u32]; SAMPLES] {
        std::array::from_fn(|row| self.row(y * SAMPLES + row))
    }

    /// Returns the keys of the samples in a row of the tile, to be changed. [`refresh`](Self::refresh) has to
    /// follow.
    pub(super) fn row_mut(&mut self, y: usize) -> &mut [u32] {
        &mut self.keys[place(y)..place(y) + SIDE]
    }

    /// Returns the largest keys of the smallest blocks in a row of blocks.
    pub(super) fn blocks(&self, row: usize) -> &[u32; BLOCKS_ALONG] {
        &self.pyramid[0].as_chunks().0[row]
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
    pub(super) fn open(&self, rectangle: [usize; 4], depth: u32) -> Option<[usize; 4]> {
        let least = depth << CLASS_BITS;
        let [left, top, right, bottom] = self.open_rows(rectangle, least)?;
        if right - left <= PIECE {
            return self.open_of_narrow([left, top, right, bottom], least);
        }
        // Only what lies beside the columns that are known to be open matters.
        let [mut first, mut last] = [right, left];
        let mut upper = None;
        for y in top..bottom {
            let row = self.row(y);
            if let Some(at) = first_open(&row[left..first], least) {
                first = left + at;
                upper.get_or_insert(y);
            }
            if let Some(at) = last_open(&row[last.max(first)..right], least) {
                last = last.max(first) + at + 1;
            }
        }
        let is_open = |y: &usize| first_open(&self.row(*y)[first..last], least).is_some();
        let lower = (upper?..bottom).rev().find(is_open)?;
        Some([first, upper?, last, lower + 1])
    }

    /// Leaves out the rows above and below the blocks that have a key of at least `least`; `None` if there are none.
    fn open_rows(&self, [left, top, right, bottom]: [usize; 4], least: u32) -> Option<[usize; 4]> {
        let columns = left / BLOCK..right.div_ceil(BLOCK);
        let is_open = |row: &usize| {
            let blocks = &self.blocks(*row)[columns.clone()];
            blocks.iter().any(|key| *key >= least)
        };
        let mut rows = top / BLOCK..bottom.div_ceil(BLOCK);
        let first = rows.clone().find(is_open)?;
        let last = rows.rfind(is_open)?;
        Some([
            left,
            top.max(first * BLOCK),
            right,
            bottom.min((last + 1) * BLOCK),
        ])
    }

    /// Returns the least rectangle within one of at most [`PIECE`] columns that contains its keys of at least `least`.
    fn open_of_narrow(
        &self,
        [left, top, right, bottom]: [usize; 4],
        least: u32,
    ) -> Option<[usize; 4]> {
        let (mut columns, mut upper, mut lower) = (0_u32, bottom, top);
        for y in top..bottom {
            let keys = self.row(y)[left..right].iter().zip(0..);
            let open = keys.fold(0, |open, (key, x)| open | u32::from(*key >= least) << x);
            if open > 0 {
                upper = upper.min(y);
                lower = y + 1;
            }
            columns |= open;
        }
        let first = left + columns.trailing_zeros() as usize;
        let last = left + (u32::BITS - columns.leading_zeros()) as usize;
        (columns > 0).then_some([first, upper, last, lower])
    }

    /// Updates the pyramid after samples of a rectangle have been changed, which may reach into the margin: it is
    /// counted from the corner of that.
    pub(super) fn refresh_with_margin(&mut self, rectangle: [usize; 4]) {
        if let Some(rectangle) = within(rectangle) {
            self.refresh(rectangle);
        }
    }

    /// Returns whether a rectangle, counted from the corner of the margin, has a sample of the tile that is not strictly nearer
    /// than a depth, as far as [`hides`](Self::hides) knows.
    pub(super) fn shows_with_margin(&self, rectangle: [usize; 4], depth: u32) -> bool {
        within(rectangle).is_some_and(|rectangle| !self.hides(rectangle, depth))
    }

    /// Updates the pyramid after samples of a rectangle have been changed.
    pub(super) fn refresh(&mut self, [left, top, right, bottom]: [usize; 4]) {
        let mut range = [left, top, right - 1, bottom - 1].map(|end| end >> BLOCKS[0]);
        let mut changes = false;
        for row in range[1]..=range[3] {
            let columns = range[0]..range[2] + 1;
            let lines = std::array::from_fn(|line| {
                let start = place(row * BLOCK + line);
                &self.keys[start..][columns.start * BLOCK..columns.end * BLOCK]
            });
            let start = row * BLOCKS_ALONG;
            let known = &mut self.pyramid[0][start..][columns];
            changes |= set_largest(lines, known);
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

/// Returns the part within the tile of a rectangle that is counted from the corner of the margin; `None` if it is empty.
fn within(rectangle: [usize; 4]) -> Option<[usize; 4]> {
    let [left, top, right, bottom] = rectangle.map(|at| at.saturating_sub(MARGIN).min(SIDE));
    (left < right && top < bottom).then_some([left, top, right, bottom])
}

/// Returns the place of the first of some keys that is at least `least`.
fn first_open(keys: &[u32], least: u32) -> Option<usize> {
    let mut pieces = keys.chunks(PIECE);
    let piece = pieces.position(|piece| has_open(piece, least))?;
    let at = { keys[piece * PIECE..].iter() }.position(|key| *key >= least)?;
    Some(piece * PIECE + at)
}

/// Returns the place of the last of some keys that is at least `least`.
fn last_open(keys: &[u32], least: u32) -> Option<usize> {
    let mut end = keys.len();
    for piece in keys.rchunks(PIECE) {
        if has_open(piece, least) {
            return keys[..end].iter().rposition(|key| *key >= least);
        }
        end -= piece.len();
    }
    None
}

/// Returns whether one of some keys is at least `least`, without a branch for each.
fn has_open(keys: &[u32], least: u32) -> bool {
    keys.iter().fold(false, |open, key| open | (*key >= least))
}

/// Sets the largest keys of the blocks along some lines; returns whether one has changed.
#[cfg_attr(feature = "simd", multiversion::multiversion(targets = "simd"))]
fn set_largest(lines: [&[u32]; BLOCK], largest: &mut [u32]) -> bool {
    let mut changes = 0;
    let [a, b, c, d] = lines.map(|line| line.as_chunks::<BLOCK>().0);
    for ((((known, a), b), c), d) in largest.iter_mut().zip(a).zip(b).zip(c).zip(d) {
        let down: [u32; BLOCK] = std::array::from_fn(|x| a[x].max(b[x]).max(c[x].max(d[x])));
        let most = down[0].max(down[1]).max(down[2].max(down[3]));
        changes |= *known ^ most;
        *known = most;
    }
    changes != 0
}

/// Returns the place of the first sample of a row.
fn place(y: usize) -> usize {
    (y + MARGIN) * STRIDE + MARGIN
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// Returns a rectangle of a tile that is not empty.
    fn rectangle() -> impl Strategy<Value = [usize; 4]> {
        let span = || (0..SIDE, 1..40_usize).prop_map(|(at, size)| [at, (at + size).min(SIDE)]);
        (span(), span()).prop_map(|([left, right], [top, bottom])| [left, top, right, bottom])
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(256))]

        #[test]
        fn open_samples_and_blocks_are_found(
            drawn in proptest::collection::vec((rectangle(), 0..20_u32), 0..12),
            within in rectangle(),
            depth in 0..20_u32,
        ) {
            let mut buffer = Buffer::new();
            for (area @ [left, top, right, bottom], depth) in drawn {
                for y in top..bottom {
                    buffer.row_mut(y)[left..right].fill(depth << CLASS_BITS | 7);
                }
                buffer.refresh(area);
            }
            let [left, top, right, bottom] = within;
            let mut expected: Option<[usize; 4]> = None;
            for y in top..bottom {
                for x in left..right {
                    if buffer.row(y)[x] >= depth << CLASS_BITS {
                        let [a, b, c, d] = expected.unwrap_or([x, y, x, y]);
                        expected = Some([a.min(x), b.min(y), c.max(x + 1), d.max(y + 1)]);
                    }
                }
            }
            prop_assert_eq!(buffer.open(within, depth), expected);
            for row in 0..BLOCKS_ALONG {
                for (column, known) in buffer.blocks(row).iter().enumerate() {
                    let lines = (row * BLOCK..(row + 1) * BLOCK).map(|y| buffer.row(y));
                    let keys = lines.flat_map(|line| &line[column * BLOCK..(column + 1) * BLOCK]);
                    prop_assert_eq!(keys.max(), Some(known));
                }
            }
        }
    }

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
