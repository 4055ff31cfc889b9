//! Points of the plane, covered by boxes.

use crate::geometry::{Bounds, DAffine2, DMat2, DVec2};

use super::bits::Bits;
use super::cover::Grid;

/// Why points cannot be measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoExtent {
    /// There are none.
    #[error("there are no points")]
    None,
    /// They lie at one place.
    #[error(
        "all points are equal: a single point has no sizes to be measured at, and the dimension 0"
    )]
    One,
    /// They lie too far from each other for a double.
    #[error("the points lie farther apart than numbers can tell")]
    Infinite,
}

/// Points of the plane that lie at more than one place.
///
/// They are kept on a lattice of 2³⁰ places a side, in the order of Morton, so that the order in which
/// they came is forgotten. Grids lie on them along their own principal axes, and are laid in units of
/// their extent from the lower left corner of their box: however the points are moved, turned or
/// scaled, and however far from the origin they lie, the same boxes hold the same points.
#[derive(Clone, Debug)]
pub struct Points {
    places: Vec<Place>,
    bounds: Bounds,
    /// The direction of the longest principal axis, in radians.
    angle: f64,
    levels: u32,
}

/// A place of the lattice, and how many points lie at it.
#[derive(Clone, Copy, Debug)]
struct Place {
    column: u32,
    row: u32,
    points: u32,
}

/// Boxes in a row that are still marked as bits (32 MiB); where there are more, keys are sorted.
const MOST_BITS: usize = 1 << 14;

/// Halvings of the extent beyond which doubles say little.
const MOST_LEVELS: u32 = 30;

/// Sizes are listed down to where there are no more points a box than so many.
const POINTS_A_BOX: u64 = 8;

impl Points {
    /// Points, if there are two that differ.
    ///
    /// # Errors
    ///
    /// If there are not, or if their box is not finite.
    pub fn new(points: Vec<DVec2>) -> Result<Self, NoExtent> {
        let mut bounds = Bounds::EMPTY;
        points.iter().for_each(|&point| bounds.add(point));
        match bounds.size().max_element() {
            _ if points.is_empty() => return Err(NoExtent::None),
            size if !size.is_finite() || !bounds.is_finite() => return Err(NoExtent::Infinite),
            0.0 => return Err(NoExtent::One),
            _ => {}
        }
        let extent = bounds.size().max_element();
        let mut parts = points;
        for point in &mut parts {
            *point = (*point - bounds.min()) / extent;
        }
        let levels = levels(&parts, &Bounds::new(DVec2::ZERO, bounds.size() / extent));
        let mut keys: Vec<u64> = parts.iter().map(|&part| key(part)).collect();
        drop(parts);
        keys.sort_unstable();
        let place = |same: &[u64]| Place {
            column: gathered(same[0]),
            row: gathered(same[0] >> 1),
            points: u32::try_from(same.len()).unwrap_or(u32::MAX),
        };
        let mut points = Self {
            places: keys.chunk_by(|a, b| a == b).map(place).collect(),
            bounds,
            angle: 0.0,
            levels,
        };
        points.angle = points.principal_axis();
        Ok(points)
    }

    /// The box that holds them.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The longer side of that box.
    pub(super) fn extent(&self) -> f64 {
        self.bounds.size().max_element()
    }

    /// How many halvings of the extent lead to boxes that are too many for the points.
    pub(super) fn levels(&self) -> u32 {
        self.levels
    }

    /// Where points lie in their box, in parts of its longer side, and how many at each place.
    pub(super) fn places(&self) -> impl Iterator<Item = (DVec2, u32)> {
        let places = self.places.iter();
        places.map(|place| {
            let part = DVec2::new(place.column.into(), place.row.into()) / LATTICE;
            (part, place.points)
        })
    }

    /// A grid that lies on the principal axes as the given one lies on the axes of the plane, and the
    /// box of all [places](Self::places) turned against it.
    pub(super) fn own(&self, grid: &Grid) -> (Grid, Bounds) {
        let own = Grid {
            angle: grid.angle - self.angle,
            ..*grid
        };
        let turn = own.turn();
        let mut bounds = Bounds::EMPTY;
        self.places().for_each(|(at, _)| bounds.add(turn * at));
        (own, bounds)
    }

    /// The direction in which points are spread the most, and farther out on its positive side; 0 if
    /// there is no such direction.
    fn principal_axis(&self) -> f64 {
        const ROUND: f64 = 1e-9;
        let mean = |of: &dyn Fn(DVec2) -> f64| {
            let (mut sum, mut all) = (0.0, 0.0);
            for (at, points) in self.places() {
                let weight = f64::from(points);
                sum += weight * of(at);
                all += weight;
            }
            sum / all
        };
        let middle = DVec2::new(mean(&|at| at.x), mean(&|at| at.y));
        let xx = mean(&|at| (at.x - middle.x) * (at.x - middle.x));
        let xy = mean(&|at| (at.x - middle.x) * (at.y - middle.y));
        let yy = mean(&|at| (at.y - middle.y) * (at.y - middle.y));
        if libm::hypot(xx - yy, 2.0 * xy) <= ROUND * (xx + yy) {
            return 0.0;
        }
        let angle = libm::atan2(2.0 * xy, xx - yy) / 2.0;
        let (sin, cos) = libm::sincos(angle);
        let skewness = mean(&|at| libm::pow((at - middle).dot(DVec2::new(cos, sin)), 3.0));
        if skewness < 0.0 {
            angle + std::f64::consts::PI
        } else {
            angle
        }
    }
}

/// Places of the lattice in a row.
const LATTICE: f64 = (1u64 << MOST_LEVELS) as f64;

/// The key of the place at some parts of the extent.
fn key(part: DVec2) -> u64 {
    let [column, row] = boxed(
        &DAffine2::from_mat2(DMat2::from_diagonal(DVec2::splat(LATTICE))),
        part,
    );
    spread(column) | spread(row) << 1
}

/// How many halvings lead to fewer points a box than are listed.
fn levels(points: &[DVec2], bounds: &Bounds) -> u32 {
    let most = points.len() as u64 / POINTS_A_BOX;
    let extent = bounds.size().max_element() * (1.0 + 4e-9);
    let first = |levels: u32| {
        let size = extent / libm::exp2(f64::from(levels));
        let (map, boxes) = Grid::ALONG.map(bounds, size, extent / 2.0);
        let counts = counts(points, &map, boxes, levels);
        let enough = counts.iter().rev().position(|&count| count > most);
        enough.and_then(|level| u32::try_from(level + 1).ok())
    };
    let coarse = MOST_BITS.trailing_zeros();
    first(coarse)
        .or_else(|| first(MOST_LEVELS))
        .unwrap_or(MOST_LEVELS)
}

/// The numbers of boxes that hold points: on a grid, and on those of boxes 2, 4, 8 … times as large,
/// `levels` of them.
///
/// `map` leads from the plane to the grid, whose boxes have side 1 and corners at whole numbers from
/// (0, 0) to `boxes`.
#[must_use]
pub fn counts(points: &[DVec2], map: &DAffine2, boxes: [usize; 2], levels: u32) -> Vec<u64> {
    // A grid begins beyond the set, so it may be some wider than it is deep.
    if boxes[0].max(boxes[1]) > 3 * MOST_BITS {
        return sorted_counts(points, map, levels);
    }
    let mut bits = Bits::new(boxes[0], boxes[1]);
    for &point in points {
        let [column, row] = boxed(map, point);
        bits.set(column as usize, row as usize);
    }
    let mut counts = Vec::new();
    for level in 0..levels {
        if level > 0 {
            bits = bits.folded([false; 2]);
        }
        counts.push(bits.count());
    }
    counts
}

/// The same by sorting the keys of boxes (Morton 1966): those of larger boxes are their beginnings.
fn sorted_counts(points: &[DVec2], map: &DAffine2, levels: u32) -> Vec<u64> {
    let key = |&point: &DVec2| {
        let [column, row] = boxed(map, point);
        spread(column) | spread(row) << 1
    };
    let mut keys: Vec<u64> = points.iter().map(key).collect();
    keys.sort_unstable();
    let mut counts = Vec::new();
    for level in 0..levels {
        if level > 0 {
            keys.iter_mut().for_each(|key| *key >>= 2);
        }
        keys.dedup();
        counts.push(keys.len() as u64);
    }
    counts
}

#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "points lie on the grid, and casts from floats saturate"
)]
fn boxed(map: &DAffine2, point: DVec2) -> [u32; 2] {
    let at = map.transform_point2(point);
    [at.x as u32, at.y as u32]
}

/// The bits of a number, with a free one above each.
#[inline]
fn spread(number: u32) -> u64 {
    let mut bits = u64::from(number);
    bits = (bits | bits << 16) & 0x0000_ffff_0000_ffff;
    bits = (bits | bits << 8) & 0x00ff_00ff_00ff_00ff;
    bits = (bits | bits << 4) & 0x0f0f_0f0f_0f0f_0f0f;
    bits = (bits | bits << 2) & 0x3333_3333_3333_3333;
    (bits | bits << 1) & 0x5555_5555_5555_5555
}

/// Every other bit of a key, as a number.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "32 bits are left")]
fn gathered(key: u64) -> u32 {
    let mut bits = key & 0x5555_5555_5555_5555;
    for (step, mask) in GATHERED.iter().enumerate() {
        bits = (bits | bits >> (1 << step)) & mask;
    }
    bits as u32
}

/// Where bits lie after each step of gathering.
const GATHERED: [u64; 5] = [
    0x3333_3333_3333_3333,
    0x0f0f_0f0f_0f0f_0f0f,
    0x00ff_00ff_00ff_00ff,
    0x0000_ffff_0000_ffff,
    0x0000_0000_ffff_ffff,
];
