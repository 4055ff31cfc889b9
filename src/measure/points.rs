//! Points of the plane, and the boxes that they occupy.

use crate::geometry::{Bounds, DAffine2, DVec2};

use super::bits::Bits;
use super::cover::Grid;
use super::statistics::weighted_mean;

/// Reason why points cannot be measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoExtent {
    /// The set of points is empty.
    #[error("there are no points")]
    None,
    /// All points are equal.
    #[error(
        "all points are equal: a single point has no sizes to be measured at, and the dimension 0"
    )]
    One,
    /// The extent of the points exceeds the range of a double.
    #[error("the points lie farther apart than numbers can tell")]
    Infinite,
}

/// Points of the plane that lie at more than one place.
///
/// Points are kept on a lattice of 2³⁰ places a side, in Morton order, which does not depend on the order of
/// the input. Grids are aligned with the principal axes of the points, and are laid in units of their extent
/// from the lower left corner of their box. However the points are moved, turned or scaled, and however far
/// from the origin they lie, the same boxes therefore hold the same points.
#[derive(Clone, Debug)]
pub struct Points {
    places: Vec<Place>,
    bounds: Bounds,
    /// Direction of the longest principal axis, in radians.
    angle: f64,
    levels: u32,
}

/// A place of the lattice, with the number of points at it.
#[derive(Clone, Copy, Debug)]
struct Place {
    column: u32,
    row: u32,
    points: u32,
}

/// Maximum number of boxes in a row that are marked as bits (32 MiB); where there are more, keys are sorted.
const MAX_BITS: usize = 1 << 14;

/// Number of halvings of the extent beyond which the precision of doubles is exhausted.
const MAX_LEVELS: u32 = 30;

/// Mean number of points per occupied box below which no smaller sizes are listed.
const POINTS_A_BOX: u64 = 8;

impl Points {
    /// Creates the set of points, of which two must differ.
    ///
    /// # Errors
    ///
    /// Returns an error if there are no points, if all are equal, or if their box is not finite.
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
        let lattice = DAffine2::from_scale(DVec2::splat(LATTICE));
        let mut keys: Vec<u64> = parts.iter().map(|&part| key(&lattice, part)).collect();
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

    /// Returns the bounding box of the points.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Returns the longer side of the bounding box.
    pub(super) fn extent(&self) -> f64 {
        self.bounds.size().max_element()
    }

    /// Returns the number of halvings of the extent that lead to boxes too many for the points.
    pub(super) fn levels(&self) -> u32 {
        self.levels
    }

    /// Iterates over the places of the points in their box, as fractions of its longer side, and the number
    /// of points at each.
    pub(super) fn places(&self) -> impl Iterator<Item = (DVec2, u32)> {
        let places = self.places.iter();
        places.map(|place| {
            let part = DVec2::new(place.column.into(), place.row.into()) / LATTICE;
            (part, place.points)
        })
    }

    /// Returns the grid that lies on the principal axes as `grid` lies on the axes of the plane, and the box
    /// of all [places](Self::places) turned against it.
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

    /// Returns the direction of largest variance, oriented towards positive skewness, in radians; 0 if there
    /// is no such direction.
    fn principal_axis(&self) -> f64 {
        const ROUND: f64 = 1e-9;
        let mean = |of: &dyn Fn(DVec2) -> f64| {
            weighted_mean(self.places().map(|(at, points)| (of(at), points.into())))
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

/// Number of places of the lattice in a row.
const LATTICE: f64 = (1u64 << MAX_LEVELS) as f64;

/// Returns the key of the box of a grid that a point lies in, which interleaves the bits of its column and row.
fn key(map: &DAffine2, point: DVec2) -> u64 {
    let [column, row] = boxed(map, point);
    spread(column) | spread(row) << 1
}

/// Returns the number of halvings that lead to fewer points per box than [`POINTS_A_BOX`].
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
    let coarse = MAX_BITS.trailing_zeros();
    first(coarse)
        .or_else(|| first(MAX_LEVELS))
        .unwrap_or(MAX_LEVELS)
}

/// Counts the boxes that hold points, on a grid and on those of boxes 2, 4, 8 … times as large: `levels`
/// counts.
///
/// `map` leads from the plane to the grid, whose boxes have side 1 and corners at whole numbers from (0, 0)
/// to `boxes`.
#[must_use]
pub fn counts(points: &[DVec2], map: &DAffine2, boxes: [usize; 2], levels: u32) -> Vec<u64> {
    // A grid begins before the set, and may be somewhat wider than it.
    if boxes[0].max(boxes[1]) > 3 * MAX_BITS {
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

/// Counts boxes by sorting their keys (Morton 1966): keys of larger boxes are prefixes.
fn sorted_counts(points: &[DVec2], map: &DAffine2, levels: u32) -> Vec<u64> {
    let mut keys: Vec<u64> = points.iter().map(|&point| key(map, point)).collect();
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

/// Spreads the bits of a number to the even positions.
#[inline]
fn spread(number: u32) -> u64 {
    let mut bits = u64::from(number);
    bits = (bits | bits << 16) & 0x0000_ffff_0000_ffff;
    bits = (bits | bits << 8) & 0x00ff_00ff_00ff_00ff;
    bits = (bits | bits << 4) & 0x0f0f_0f0f_0f0f_0f0f;
    bits = (bits | bits << 2) & 0x3333_3333_3333_3333;
    (bits | bits << 1) & 0x5555_5555_5555_5555
}

/// Gathers the bits at even positions of a key.
#[inline]
#[expect(clippy::cast_possible_truncation, reason = "32 bits are left")]
pub(super) fn gathered(key: u64) -> u32 {
    let mut bits = key & 0x5555_5555_5555_5555;
    for (step, mask) in GATHERED.iter().enumerate() {
        bits = (bits | bits >> (1 << step)) & mask;
    }
    bits as u32
}

/// Masks of the bits after each step of gathering.
const GATHERED: [u64; 5] = [
    0x3333_3333_3333_3333,
    0x0f0f_0f0f_0f0f_0f0f,
    0x00ff_00ff_00ff_00ff,
    0x0000_ffff_0000_ffff,
    0x0000_0000_ffff_ffff,
];
