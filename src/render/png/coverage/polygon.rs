//! Small convex polygons, covered as intersections of tabulated half planes.

use std::sync::LazyLock;
use std::sync::atomic::Ordering::Relaxed;

#[cfg(doc)]
use super::has_room;
use super::{CoverageBuffer, FINE, MARGIN, Position, cover, index, mask};

/// Maximum number of vertices of such a polygon.
pub(super) const MAX_VERTICES: usize = 32;

/// Number of vertices that most polygons do not exceed.
const FEW_VERTICES: usize = 4;
/// Number of vertices that most other polygons do not exceed.
pub(super) const SOME_VERTICES: usize = 12;

/// Maximum width and height of such a polygon, in pixels.
pub(super) const MAX_PIXELS: i64 = 8;

/// Width, in hundredths of a pixel, up to which every sample of a polygon is decided by itself. Half planes
/// are off by some hundredths of a pixel, which adds up where many meet. Longer triangles and quadrilaterals
/// are exempt: they have at most two long sides, which neighbours share.
const TINIEST: i64 = 20;

/// Number of directions per octant for which half planes are tabulated.
const DIRECTIONS: usize = 8;

/// Number of distances of an edge per pixel for which half planes are tabulated.
const DISTANCES: f64 = 64.0;

/// Distance of an edge from the centre of a pixel, in `DISTANCES`, beyond which a half plane covers all of
/// the pixel or nothing.
const FARTHEST: usize = 48;

/// Half plane to the left of an edge, on a picture where y points down.
#[derive(Clone, Copy, Default)]
pub(super) struct HalfPlane {
    /// Change of the area from a pixel to the next one to the right.
    right: i64,
    /// Change of the area from a pixel to the next one below.
    down: i64,
    /// Twice the area of the triangle of the edge and the centre of the first pixel.
    area: i64,
    /// Factor that converts areas to distances.
    scale: f64,
    /// Offset of distances.
    from: f64,
    /// Index of the first mask of the direction in the table.
    masks: usize,
    /// All ones if the table holds the other side of the edge.
    other: u64,
}

/// Masks of half planes by direction, over two quarter turns from the x axis, and by distance.
static HALF_PLANES: LazyLock<Vec<u64>> = LazyLock::new(|| {
    let mut masks = Vec::new();
    for octant in 0..4 {
        for direction in 0..=DIRECTIONS {
            let slope = direction as f64 / DIRECTIONS as f64;
            let [x, y] = match octant {
                0 => [1.0, slope],
                1 => [slope, 1.0],
                2 => [-slope, 1.0],
                _ => [-1.0, slope],
            };
            let length = f64::sqrt(1.0 + slope * slope);
            for distance in 0..2 * FARTHEST {
                let distance = (distance as f64 - FARTHEST as f64 + 0.5) / DISTANCES;
                masks.push(mask(|[u, v]| {
                    distance + (x * (v - 0.5) - y * (u - 0.5)) / length > 0.0
                }));
            }
        }
    }
    masks
});

impl HalfPlane {
    /// Creates the half plane on one side of the edge through a point along a vector. `centre` is that of the
    /// first pixel.
    #[inline]
    pub(super) fn of(point: Position, [x, y]: [i64; 2], centre: Position) -> Self {
        let turned = y < 0 || (y == 0 && x < 0);
        // Every edge has one direction, so that its two sides are exact complements.
        let [x, y] = if turned { [-x, -y] } else { [x, y] };
        let area = x * (centre[1] - point[1]) - y * (centre[0] - point[0]);
        let (across, down) = (x.abs() as f64, y as f64);
        let octant = match (x >= 0, across >= down) {
            (true, true) => 0,
            (true, false) => 1,
            (false, false) => 2,
            (false, true) => 3,
        };
        let slope = across.min(down) / across.max(down);
        let direction = number(slope * DIRECTIONS as f64 + 0.5);
        Self {
            right: -y * FINE,
            down: x * FINE,
            area,
            scale: DISTANCES / FINE as f64 / (across * across + down * down).sqrt(),
            from: FARTHEST as f64,
            masks: (octant * (DIRECTIONS + 1) + direction) * 2 * FARTHEST,
            other: if turned { u64::MAX } else { 0 },
        }
    }

    /// Moves the edge outwards by a distance in hundredths of a pixel.
    pub(super) fn moved(self, by: f64) -> Self {
        let by = by * DISTANCES / FINE as f64;
        let from = self.from + if self.other == 0 { by } else { -by };
        Self { from, ..self }
    }

    /// Returns the mask of a pixel, for its area.
    #[inline]
    fn mask(&self, table: &[u64], area: i64) -> u64 {
        const MOST: f64 = 2.0 * FARTHEST as f64 - 1.0;
        let distance = (area as f64 * self.scale + self.from).clamp(0.0, MOST);
        table[self.masks + number(distance)] ^ self.other
    }
}

#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "small numbers that are not negative"
)]
fn number(value: f64) -> usize {
    value as i32 as usize
}

/// Returns the bounding box of vertices: minimum and maximum.
#[inline]
pub(super) fn bounds(vertices: &[Position]) -> [Position; 2] {
    let none = [[i64::MAX; 2], [i64::MIN; 2]];
    vertices.iter().fold(none, |[least, most], vertex| {
        [
            [0, 1].map(|axis| least[axis].min(vertex[axis])),
            [0, 1].map(|axis| most[axis].max(vertex[axis])),
        ]
    })
}

/// Returns whether a bounding box is that of a small polygon.
#[inline]
fn is_small([least, most]: &[Position; 2]) -> bool {
    (0..2).all(|axis| most[axis].saturating_sub(least[axis]) <= MAX_PIXELS * FINE)
}

/// Returns the sides of a polygon, first the side to its first vertex.
#[inline]
pub(super) fn sides<const MOST: usize>(vertices: &[Position]) -> [[i64; 2]; MOST] {
    let mut sides = [[0; 2]; MOST];
    let mut before = vertices.last().copied().unwrap_or_default();
    for (side, &vertex) in sides.iter_mut().zip(vertices) {
        *side = [vertex[0] - before[0], vertex[1] - before[1]];
        before = vertex;
    }
    sides
}

impl CoverageBuffer {
    /// Covers a polygon, under the nonzero rule, if it is small and convex or [within the limits](has_room).
    /// Otherwise covers nothing and returns `false`.
    #[inline]
    pub(crate) fn polygon(&mut self, vertices: &[Position]) -> bool {
        let mut hull = [[0; 2]; SOME_VERTICES];
        self.convex(vertices)
            || rounded(vertices, &mut hull).is_some_and(|hull| self.convex(hull))
            || self.area(vertices)
    }

    /// Covers a polygon if it is small and convex. Otherwise covers nothing and returns `false`.
    #[inline]
    fn convex(&mut self, vertices: &[Position]) -> bool {
        let count = vertices.len();
        if count <= FEW_VERTICES {
            self.polygon_of::<FEW_VERTICES>(vertices)
        } else if count <= SOME_VERTICES {
            self.polygon_of::<SOME_VERTICES>(vertices)
        } else {
            self.polygon_of::<MAX_VERTICES>(vertices)
        }
    }

    pub(super) fn polygon_of<const MOST: usize>(&mut self, vertices: &[Position]) -> bool {
        let bounds = bounds(vertices);
        if !(1..=MOST).contains(&vertices.len()) || !is_small(&bounds) {
            return false;
        }
        let Some([columns, rows]) = self.pixels(bounds) else {
            return true;
        };
        if self.is_full(columns, rows) {
            return true;
        }
        let extent = [0, 1].map(|axis| bounds[1][axis] - bounds[0][axis]);
        let longest = extent[0].max(extent[1]);
        if MOST == FEW_VERTICES && longest > TINIEST && is_rectangle(vertices) {
            self.right_angled(bounds, columns, rows);
            return true;
        }
        let sides = sides::<MOST>(vertices);
        let orientation = match orientation(&sides[..vertices.len()]) {
            None => return false,
            Some(0) => return true,
            Some(orientation) => orientation,
        };
        if longest <= TINIEST || (MOST > FEW_VERTICES && is_narrow(vertices, longest)) {
            if columns[0] + 1 < columns[1] || rows[0] + 1 < rows[1] {
                return self.area(vertices);
            }
            self.tiny(vertices, columns, rows);
            return true;
        }
        let centre = [columns[0], rows[0]].map(|pixel| pixel * FINE + FINE / 2);
        let mut edges = [HalfPlane::default(); MOST];
        let mut count = 0;
        for (&side, &to) in sides.iter().zip(vertices) {
            if side != [0, 0] {
                let [x, y] = side.map(|along| along * orientation);
                edges[count] = HalfPlane::of(to, [x, y], centre);
                count += 1;
            }
        }
        self.intersection(&mut edges[..count], columns, rows);
        self.touched.add(columns, rows);
        true
    }

    /// Covers a rectangle of horizontal and vertical sides as [`CoverageBuffer::polygon`] does, if it is small and not
    /// too narrow. Otherwise covers nothing and returns `false`.
    #[inline]
    pub(crate) fn rectangle(&mut self, least: Position, most: Position) -> bool {
        let bounds = [least, most];
        let [x, y] = [0, 1].map(|axis| most[axis].saturating_sub(least[axis]));
        if x.max(y) <= TINIEST || !is_small(&bounds) {
            return false;
        }
        if let Some([columns, rows]) = self.pixels(bounds)
            && !self.is_full(columns, rows)
        {
            self.right_angled(bounds, columns, rows);
        }
        true
    }

    /// Covers a small rectangle: the intersection of its four half planes.
    #[inline]
    fn right_angled(&mut self, [least, most]: [Position; 2], columns: [i64; 2], rows: [i64; 2]) {
        const MOST: usize = 10;
        const { assert!(MAX_PIXELS < MOST as i64 && DISTANCES == 64.0) };
        let (below, left) = HALF_PLANES
            .as_slice()
            .split_at((DIRECTIONS + 1) * 2 * FARTHEST);
        let mut across = [0; MOST];
        let width = index(columns[1] - columns[0] + 1);
        for (mask, column) in across[..width].iter_mut().zip(columns[0]..) {
            let centre = column * FINE + FINE / 2;
            *mask = left[slot(most[0] - centre)] & !left[slot(least[0] - centre)];
        }
        for row in rows[0]..=rows[1] {
            let centre = row * FINE + FINE / 2;
            let down = below[slot(centre - least[1])] & !below[slot(centre - most[1])];
            let start = self.cell([columns[0], row]);
            for (cell, mask) in self.cells[start..start + width].iter().zip(across) {
                cover(cell, mask & down);
            }
        }
        self.touched.add(columns, rows);
    }

    /// Returns the columns and rows that a bounding box meets, including those of margins; `None` if it meets
    /// none.
    #[inline]
    pub(super) fn pixels(&self, [least, most]: [Position; 2]) -> Option<[[i64; 2]; 2]> {
        let met = [0, 1].map(|axis| {
            let origin = [0, self.top][axis];
            let first = least[axis].div_euclid(FINE).max(origin - MARGIN);
            let last = most[axis].div_euclid(FINE);
            [first, last.min(origin + self.size[axis] + MARGIN - 1)]
        });
        met.iter().all(|[first, last]| first <= last).then_some(met)
    }

    /// Returns the index of the cell of a pixel.
    #[inline]
    pub(super) fn cell(&self, [column, row]: [i64; 2]) -> usize {
        index(row - self.top + MARGIN) * self.stride + index(column + MARGIN)
    }

    /// Returns whether a rectangle is covered completely, which is frequent where polygons overlap.
    #[inline]
    pub(super) fn is_full(&self, columns: [i64; 2], rows: [i64; 2]) -> bool {
        let width = index(columns[1] - columns[0] + 1);
        (rows[0]..=rows[1]).all(|row| {
            let start = self.cell([columns[0], row]);
            let mut cells = self.cells[start..start + width].iter();
            cells.all(|cell| cell.load(Relaxed) == u64::MAX)
        })
    }

    /// Covers the intersection of half planes in a rectangle of pixels.
    pub(super) fn intersection(
        &mut self,
        edges: &mut [HalfPlane],
        columns: [i64; 2],
        rows: [i64; 2],
    ) {
        let table = HALF_PLANES.as_slice();
        let width = index(columns[1] - columns[0] + 1);
        for row in rows[0]..=rows[1] {
            let start = self.cell([columns[0], row]);
            for (cell, column) in self.cells[start..start + width].iter().zip(0..) {
                let masks = edges
                    .iter()
                    .map(|edge| edge.mask(table, edge.area + column * edge.right));
                cover(cell, masks.fold(u64::MAX, |all, mask| all & mask));
            }
            for edge in &mut *edges {
                edge.area += edge.down;
            }
        }
    }
}

/// Returns the index in the table of a distance in hundredths of a pixel, as [`HalfPlane::mask`] does.
#[inline]
fn slot(distance: i64) -> usize {
    // Factor `DISTANCES` / 100.
    let slot = (distance * 16).div_euclid(25) + FARTHEST as i64;
    index(slot.clamp(0, 2 * FARTHEST as i64 - 1))
}

/// Returns whether a polygon is a rectangle with horizontal and vertical sides.
#[inline]
fn is_rectangle(vertices: &[Position]) -> bool {
    let [a, b, c, d] = *vertices else {
        return false;
    };
    (0..2).any(|axis| {
        a[axis] == b[axis]
            && b[1 - axis] == c[1 - axis]
            && c[axis] == d[axis]
            && d[1 - axis] == a[1 - axis]
    })
}

/// Returns whether the mean width of a convex polygon is at most `TINIEST`. `longest` is the longer side of
/// its bounding box.
#[inline]
fn is_narrow(vertices: &[Position], longest: i64) -> bool {
    let from = vertices[0];
    let sides = vertices.windows(2).map(|side| {
        let [a, b] = [0, 1].map(|end| [0, 1].map(|axis| side[end][axis] - from[axis]));
        a[0] * b[1] - a[1] * b[0]
    });
    sides.sum::<i64>().abs() <= 2 * TINIEST * longest
}

/// Returns the orientation of a convex polygon with these sides: 1 if its inside lies to the left on a
/// picture where y points down, -1 if to the right, 0 if it has none. `None` if it is not convex.
#[inline]
pub(super) fn orientation(sides: &[[i64; 2]]) -> Option<i64> {
    let (mut lefts, mut rights) = (false, false);
    // Number of reversals along each axis.
    let (mut backs, mut signs) = ([0; 2], [0; 2]);
    let mut before = *sides.last()?;
    for &side in sides {
        let turn = before[0] * side[1] - before[1] * side[0];
        lefts |= turn > 0;
        rights |= turn < 0;
        before = side;
        for axis in 0..2 {
            let sign = side[axis].signum();
            backs[axis] += i32::from(sign * signs[axis] < 0);
            signs[axis] = if sign == 0 { signs[axis] } else { sign };
        }
    }
    // Stars also turn in one direction, but more than once.
    let turns_once = backs.iter().all(|&backs| backs <= 2);
    (turns_once && !(lefts && rights)).then_some(i64::from(lefts) - i64::from(rights))
}

/// Returns the hull of a small polygon that exceeds its area by no more than rounding, as for a polygon that
/// would be convex without rounding. If sides cross, the hull may enclose another polygon.
pub(super) fn rounded<'h>(
    vertices: &[Position],
    hull: &'h mut [Position; SOME_VERTICES],
) -> Option<&'h [Position]> {
    let count = vertices.len();
    if !(1..=SOME_VERTICES).contains(&count) || !is_small(&bounds(vertices)) {
        return None;
    }
    let turn = |a: Position, b: Position, c: Position| {
        (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
    };
    // Twice the area, and the total extent of the sides along both axes: half a unit at either end of each
    // side changes the area by at most a quarter of that.
    let from = vertices[0];
    let (mut area, mut ways) = (0, 0);
    let mut before = vertices[count - 1];
    for &vertex in vertices {
        area += turn(from, before, vertex);
        ways += (vertex[0] - before[0]).abs() + (vertex[1] - before[1]).abs();
        before = vertex;
    }
    // The first vertex belongs to the hull.
    let (first, _) = (0..).zip(vertices).min_by_key(|(_, vertex)| **vertex)?;
    let (mut corners, mut lost) = (0, 0);
    for number in first..=first + count {
        let vertex = vertices[number % count];
        while corners > 1 {
            let turned = turn(hull[corners - 2], hull[corners - 1], vertex) * area.signum();
            if turned > 0 {
                break;
            }
            lost -= turned;
            corners -= 1;
        }
        if number < first + count {
            hull[corners] = vertex;
            corners += 1;
        }
    }
    (2 * lost <= ways).then_some(&hull[..corners])
}
