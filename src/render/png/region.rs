//! Areas of outlines with any number of vertices, covered in blocks of rows by any thread.

use std::ops::Range;

use crate::render::paint::Position;

use super::coverage::CoverageBuffer;

/// Number of rows of a block. Blocks begin at multiples of it, independently of bands.
const ROWS: u16 = 16;

/// Maximum number of vertices of a stretch.
const MANY: usize = 128;

/// Numbers of vertices and of rows that are worth a thread.
const WORTH: [usize; 2] = [1 << 14, 1 << 9];

/// Units of positions per pixel.
const FINE: i64 = 100;

/// Outlines whose area is to be covered together, under the nonzero rule.
///
/// Stretches outside the visible rows or to the right are dropped; of those to the left one side is kept.
#[derive(Default)]
pub(super) struct Region {
    /// Right border of the visible part, as a position.
    right: i64,
    /// Upper and lower border of the visible part, as positions.
    seen: [i64; 2],
    stretches: Vec<Stretch>,
    /// Vertices of all stretches, relative to the first vertex of each.
    offsets: Vec<[i16; 2]>,
    /// Current stretch.
    open: Stretch,
    /// First position of the current subpath.
    start: Position,
    /// Current position.
    at: Position,
}

/// Consecutive sides.
#[derive(Default)]
struct Stretch {
    from: Position,
    /// Indices of the offsets of its vertices after `from`.
    between: Range<usize>,
    to: Position,
    /// Bounding box: minimum and maximum, by axis.
    bounds: [[i64; 2]; 2],
}

impl Region {
    /// Sets the visible part: some rows of a picture `width` pixels wide.
    pub(super) fn begin(&mut self, width: u32, rows: Range<u32>) {
        let fine = |pixels: u32| i64::from(pixels) * FINE;
        self.right = fine(width);
        self.seen = [fine(rows.start), fine(rows.end)];
    }

    /// Returns all outlines and removes them from the region.
    pub(super) fn take(&mut self) -> Self {
        let empty = Self {
            right: self.right,
            seen: self.seen,
            ..Self::default()
        };
        std::mem::replace(self, empty)
    }

    pub(super) fn is_empty(&self) -> bool {
        self.stretches.is_empty()
    }

    /// Returns the number of vertices that are kept.
    pub(super) fn vertices(&self) -> usize {
        self.offsets.len() + self.stretches.len()
    }

    /// Begins an outline, and closes the one before.
    pub(super) fn move_to(&mut self, to: Position) {
        self.close();
        (self.start, self.at) = (to, to);
        self.begin_stretch();
    }

    #[inline]
    pub(super) fn line_to(&mut self, to: Position) {
        let offset = |self_: &Self| {
            let from = self_.open.from;
            let [x, y] = [0, 1].map(|axis| to[axis].checked_sub(from[axis]));
            Some([i16::try_from(x?).ok()?, i16::try_from(y?).ok()?])
        };
        let mut near = offset(self);
        if near.is_none() || self.offsets.len() - self.open.between.start >= MANY {
            self.end_stretch();
            near = offset(self);
        }
        for (bounds, place) in self.open.bounds.iter_mut().zip(to) {
            *bounds = [bounds[0].min(place), bounds[1].max(place)];
        }
        self.at = to;
        match near {
            Some(offset) => self.offsets.push(offset),
            None => self.end_stretch(),
        }
    }

    /// Closes an outline.
    pub(super) fn close(&mut self) {
        self.line_to(self.start);
        self.end_stretch();
    }

    fn begin_stretch(&mut self) {
        self.open = Stretch {
            from: self.at,
            between: self.offsets.len()..self.offsets.len(),
            to: self.at,
            bounds: self.at.map(|place| [place; 2]),
        };
    }

    /// Ends the current stretch, keeps it as far as it contributes, and begins the next.
    fn end_stretch(&mut self) {
        let stretch = &mut self.open;
        let [[left, right], [top, bottom]] = stretch.bounds;
        stretch.to = self.at;
        let is_seen =
            top < bottom && top < self.seen[1] && bottom > self.seen[0] && left < self.right;
        // To the left of the picture, only the rows between both ends matter.
        if !is_seen || right < 0 {
            self.offsets.truncate(stretch.between.start);
        }
        stretch.between.end = self.offsets.len();
        if is_seen {
            self.stretches.push(std::mem::take(stretch));
        }
        self.begin_stretch();
    }

    /// Iterates over the first and last rows of pieces that are enough work for a thread, where there is any
    /// area.
    pub(super) fn pieces(&self) -> impl Iterator<Item = [i64; 2]> + use<> {
        let rows = self.stretches.iter().map(|stretch| stretch.bounds[1]);
        let met = rows.fold([i64::MAX, i64::MIN], |[top, bottom], [low, high]| {
            [top.min(low), bottom.max(high)]
        });
        let [top, bottom] = [met[0].max(self.seen[0]), met[1].min(self.seen[1])];
        let height = i64::from(ROWS);
        let first = top.div_euclid(height * FINE);
        let end = bottom.div_euclid(height * FINE) + 1;
        let blocks = usize::try_from(end - first).unwrap_or(0);
        let rows = blocks * usize::from(ROWS);
        let threads = (self.vertices() / WORTH[0]).max(rows / WORTH[1]).max(1);
        let step = blocks.div_ceil(threads).max(1);
        (first..end).step_by(step).map(move |block| {
            let next = block.saturating_add_unsigned(step as u64).min(end);
            [block * height, next * height - 1]
        })
    }

    /// Covers the area in the rows from `first` to `last`.
    pub(super) fn cover(&self, plane: &mut CoverageBuffer, [first, last]: [i64; 2]) {
        for top in (first..=last).step_by(usize::from(ROWS)) {
            let rows = [top, top + i64::from(ROWS) - 1];
            let near = self.stretches.iter().filter(|stretch| {
                let [least, most] = stretch.bounds[1];
                least < (rows[1] + 1) * FINE && most > rows[0] * FINE
            });
            plane.wound_around(rows, near.flat_map(|stretch| self.sides(stretch)));
        }
    }

    fn sides(&self, stretch: &Stretch) -> impl Iterator<Item = [Position; 2]> + '_ {
        let (mut before, from, to) = (stretch.from, stretch.from, stretch.to);
        let between = self.offsets[stretch.between.clone()].iter();
        let between = between.map(move |&[x, y]| [from[0] + i64::from(x), from[1] + i64::from(y)]);
        between.chain([to]).map(move |vertex| {
            let side = [before, vertex];
            before = vertex;
            side
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

    use super::{MANY, Region};
    use crate::render::paint::Position;
    use crate::render::png::coverage::CoverageBuffer;

    const SIZE: [u32; 2] = [70, 50];

    /// Returns a star of `count` vertices that winds around its centre seven times.
    fn star(count: i64, far: f64) -> Vec<Position> {
        let corner = |number: i64| {
            let turn = number as f64 * 7.0 / count as f64 * std::f64::consts::TAU;
            let radius = far * (1.0 + 0.4 * libm::sin(31.0 * turn));
            #[expect(clippy::cast_possible_truncation, reason = "a small picture")]
            [
                3500 + (radius * libm::cos(turn)) as i64,
                2500 + (radius * libm::sin(turn)) as i64,
            ]
        };
        (0..count).map(corner).collect()
    }

    fn of(outlines: &[Vec<Position>]) -> Region {
        let mut region = Region::default();
        region.begin(SIZE[0], 0..SIZE[1]);
        for outline in outlines {
            region.move_to(outline[0]);
            outline[1..].iter().for_each(|&to| region.line_to(to));
        }
        region.close();
        region
    }

    #[test]
    fn regions_cover_what_polygons_do() {
        for (count, far) in [(5, 900.0), (300, 1500.0), (4000, 2400.0), (9, 40_000.0)] {
            let outline = star(count, far);
            let mut expected = CoverageBuffer::new(SIZE);
            let has_room = expected.polygon(&outline);
            let region = of(&[outline]);
            let mut whole = CoverageBuffer::new(SIZE);
            region
                .pieces()
                .for_each(|rows| region.cover(&mut whole, rows));
            let whole = whole.drained();
            assert!(whole.iter().any(|&part| part > 0));
            if has_room {
                assert!(whole == expected.drained(), "{count} corners");
            }
            // Bands are drawn on buffers of their own.
            let mut in_bands = Vec::new();
            for top in [0, 4, 20, 32] {
                let bottom = [0, 4, 20, 32, SIZE[1]].into_iter().find(|end| *end > top);
                let mut band = CoverageBuffer::of_rows(SIZE, top..bottom.unwrap());
                region
                    .pieces()
                    .for_each(|rows| region.cover(&mut band, rows));
                in_bands.extend(band.drained());
            }
            assert!(in_bands == whole, "{count} corners in bands");
        }
    }

    /// The case is a square with a square hole.
    #[test]
    fn outlines_of_a_region_count_together() {
        let square = |from: i64, to: i64| vec![[from, from], [to, from], [to, to], [from, to]];
        let mut hole = square(1500, 2500);
        hole.reverse();
        let region = of(&[square(500, 4500), hole]);
        let mut plane = CoverageBuffer::new(SIZE);
        region
            .pieces()
            .for_each(|rows| region.cover(&mut plane, rows));
        let covered = plane.drained().into_iter().filter(|&part| part > 0);
        assert_eq!(covered.count(), 40 * 40 - 10 * 10);
    }

    #[test]
    fn a_vertex_takes_few_bytes_and_what_is_not_seen_none() {
        let vertices: i64 = 100_000;
        let count = usize::try_from(vertices).unwrap();
        let region = of(&[star(vertices, 2000.0)]);
        let stretches = region.stretches.len() * size_of::<super::Stretch>();
        let bytes = region.offsets.len() * size_of::<[i16; 2]>() + stretches;
        assert!(bytes < 5 * count, "{bytes} bytes");
        assert!(region.vertices() <= count + count / MANY + 2);
        // One side remains for each stretch to the left, nothing elsewhere.
        for (shift, most) in [([0, 100_000], 0), ([100_000, 0], 0), ([-100_000, 0], 900)] {
            let moved = star(vertices, 2000.0)
                .into_iter()
                .map(|at| [0, 1].map(|axis| at[axis] + shift[axis]));
            let region = of(&[moved.collect()]);
            assert!(region.vertices() <= most, "{}", region.vertices());
            assert!(region.offsets.is_empty());
        }
        // Positions far beyond any picture.
        let far = [[i64::MIN, -5000], [i64::MAX, 2500], [i64::MIN, i64::MAX]];
        let region = of(&[far.to_vec()]);
        let mut plane = CoverageBuffer::new(SIZE);
        region
            .pieces()
            .for_each(|rows| region.cover(&mut plane, rows));
        assert!(plane.drained().iter().any(|&part| part > 0));
    }
}
