//! Points of the plane, covered by boxes.

use std::num::NonZero;

use crate::geometry::{Bounds, DAffine2, DVec2};

use super::bits::Bits;
use super::cover::{Grid, Scale, least};

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
#[derive(Clone, Debug)]
pub struct Points {
    points: Vec<DVec2>,
    bounds: Bounds,
}

/// Boxes in a row that are still marked as bits (32 MiB); where there are more, keys are sorted.
const MOST_BITS: usize = 1 << 14;

/// Halvings of the extent beyond which doubles say little.
const MOST_LEVELS: u32 = 30;

/// So many points a box, at least, tell that a box without points is empty.
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
            _ if points.is_empty() => Err(NoExtent::None),
            size if !size.is_finite() || !bounds.is_finite() => Err(NoExtent::Infinite),
            0.0 => Err(NoExtent::One),
            _ => Ok(Self { points, bounds }),
        }
    }

    /// The box that holds them.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// The points.
    #[must_use]
    pub fn as_slice(&self) -> &[DVec2] {
        &self.points
    }

    /// How many there are, equal ones included.
    #[must_use]
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// There are always some.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        false
    }

    /// The count of boxes beyond which points are too few to tell.
    #[must_use]
    pub fn most_boxes(&self) -> u64 {
        self.points.len() as u64 / POINTS_A_BOX
    }

    /// How the points are covered by boxes whose sides are the extent divided by powers of two, down
    /// to where boxes are too many for the points.
    #[must_use]
    pub fn scales(&self, grids: &[Grid], threads: NonZero<usize>) -> Vec<Scale> {
        let extent = self.bounds.size().max_element() * (1.0 + 4e-9);
        let side = |level: u32| extent / libm::exp2(f64::from(level));
        let counts = |grid: &Grid, levels: u32| {
            let (map, boxes) = grid.map(&self.turned_bounds(grid), side(levels), side(1));
            let mut counts = counts(&self.points, &map, boxes, levels);
            counts.reverse();
            counts
        };
        let coarse = MOST_BITS.trailing_zeros();
        let first = counts(&Grid::ALONG, coarse);
        let enough = |&count: &u64| count > self.most_boxes();
        let levels = match first.iter().position(enough) {
            Some(level) => u32::try_from(level + 1).unwrap_or(coarse),
            None => {
                let deeper = counts(&Grid::ALONG, MOST_LEVELS);
                let level = deeper.iter().position(enough).unwrap_or(deeper.len() - 1);
                u32::try_from(level + 1).unwrap_or(MOST_LEVELS)
            }
        };
        let sizes: Vec<f64> = (1..=levels).map(side).collect();
        least(&sizes, grids, threads, |grid| counts(grid, levels))
    }

    fn turned_bounds(&self, grid: &Grid) -> Bounds {
        if grid.angle == 0.0 {
            return self.bounds;
        }
        let turn = grid.turn();
        let mut bounds = Bounds::EMPTY;
        self.points
            .iter()
            .for_each(|&point| bounds.add(turn * point));
        bounds
    }
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
