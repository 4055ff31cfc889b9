//! Points of the plane or of space, and the boxes that they occupy.

use crate::geometry::{Bounds, DAffine2, Linear, Point};

use super::cover::Grid;
use super::space::Space;
use super::voxels::Voxels;
use crate::morton::{interleaved, separated};

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

/// Points of the plane or of space that lie at more than one place.
///
/// Points are kept on a lattice of 2³⁰ places a side (2²⁰ in space), in Morton order, which does not depend on the order of
/// the input. Grids are aligned with the principal axes of the points, and are laid in units of their extent
/// from the lower left corner of their box. However the points are moved, turned or scaled, and however far
/// from the origin they lie, the same boxes therefore hold the same points.
#[derive(Clone, Debug)]
pub struct Points<M: Space = DAffine2> {
    places: Vec<Place>,
    bounds: Bounds<M::Point>,
    /// Turn that takes the principal axes to the coordinate axes.
    turn: M::Turn,
    levels: u32,
}

/// A place of the lattice, with the number of points at it.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: [u32; 3],
    points: u32,
}

/// Mean number of points per occupied box below which no smaller sizes are listed.
const POINTS_A_BOX: u64 = 8;

impl<M: Space> Points<M> {
    /// Creates the set of points, of which two must differ.
    ///
    /// # Errors
    ///
    /// Returns an error if there are no points, if all are equal, or if their box is not finite.
    pub fn new(points: Vec<M::Point>) -> Result<Self, NoExtent> {
        let mut bounds = Bounds::EMPTY;
        points.iter().for_each(|&point| bounds.add(point));
        match bounds.size().max_element() {
            _ if points.is_empty() => return Err(NoExtent::None),
            size if !size.is_finite() || !bounds.is_finite() => return Err(NoExtent::Infinite),
            0.0 => return Err(NoExtent::One),
            _ => {}
        }
        let extent = bounds.size().max_element();
        let count = points.len() as u64;
        let mut parts = points;
        for point in &mut parts {
            *point = (*point - bounds.min()) / extent;
        }
        let box_of_parts = Bounds::new(M::Point::ZERO, bounds.size() / extent);
        let lattice = M::new(M::Linear::IDENTITY * lattice::<M>(), M::Point::ZERO);
        let mut keys: Vec<u64> = parts.iter().map(|&part| key(&lattice, part)).collect();
        drop(parts);
        keys.sort_unstable();
        let place = |same: &[u64]| Place {
            at: separated(M::Point::DIMENSION, same[0]),
            points: u32::try_from(same.len()).unwrap_or(u32::MAX),
        };
        let mut points = Self {
            places: keys.chunk_by(|a, b| a == b).map(place).collect(),
            bounds,
            turn: M::ALONG,
            levels: 0,
        };
        let places = points.places();
        let all = places.clone().map(|(at, _)| at);
        let levels = levels::<M>(all, count, &box_of_parts);
        let turn = M::principal(places.map(|(at, points)| (at, points.into())));
        (points.levels, points.turn) = (levels, turn);
        Ok(points)
    }

    /// Returns the bounding box of the points.
    #[must_use]
    pub fn bounds(&self) -> Bounds<M::Point> {
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
    pub(super) fn places(&self) -> impl Iterator<Item = (M::Point, u32)> + Clone {
        let places = self.places.iter();
        places.map(|place| {
            let part = M::Point::of_coordinates(place.at.map(f64::from)) / lattice::<M>();
            (part, place.points)
        })
    }

    /// Returns the grid that lies on the principal axes as `grid` lies on the coordinate axes, and the box
    /// of all [places](Self::places) turned against it.
    pub(super) fn own(&self, grid: &Grid<M>) -> (Grid<M>, Bounds<M::Point>) {
        let own = Grid {
            turn: M::after(&grid.turn, &self.turn),
            ..*grid
        };
        let turn = M::new(own.linear(), M::Point::ZERO);
        let mut bounds = Bounds::EMPTY;
        self.places().for_each(|(at, _)| bounds.add(turn.apply(at)));
        (own, bounds)
    }
}

/// Returns the number of places of the lattice in a row.
#[inline]
#[expect(clippy::cast_precision_loss, reason = "powers of 2 are exact")]
fn lattice<M: Space>() -> f64 {
    (1_u64 << M::LEVELS) as f64
}

/// Returns the key of the box of a grid that a point lies in.
fn key<M: Space>(map: &M, point: M::Point) -> u64 {
    interleaved(M::Point::DIMENSION, boxed(map, point))
}

/// Returns the number of halvings that lead to fewer points per box than [`POINTS_A_BOX`].
fn levels<M: Space>(
    places: impl Iterator<Item = M::Point> + Clone,
    points: u64,
    bounds: &Bounds<M::Point>,
) -> u32 {
    let most = points / POINTS_A_BOX;
    let extent = bounds.size().max_element() * (1.0 + 4e-9);
    let first = |levels: u32| {
        let size = extent / libm::exp2(f64::from(levels));
        let (map, boxes) = Grid::<M>::ALONG.map(bounds, size, extent / 2.0);
        let counts = counts(places.clone(), &map, boxes, levels);
        let enough = counts.iter().rev().position(|&count| count > most);
        enough.and_then(|level| u32::try_from(level + 1).ok())
    };
    first(M::FILLED_LEVELS)
        .or_else(|| first(M::FINEST_LEVELS))
        .unwrap_or(M::FINEST_LEVELS)
}

/// Counts the boxes that hold points, on a grid and on those of boxes 2, 4, 8 … times as large: `levels`
/// counts.
///
/// `map` leads from the plane or from space to the grid, whose boxes have side 1 and corners at whole numbers from
/// the origin to `boxes`; beyond the dimension there is one box.
#[must_use]
pub fn counts<M: Space>(
    points: impl Iterator<Item = M::Point>,
    map: &M,
    boxes: [usize; 3],
    levels: u32,
) -> Vec<u64> {
    // A grid begins before the set, and may be somewhat wider than it.
    let widest = boxes.into_iter().fold(1, usize::max);
    if widest > 3 << M::FILLED_LEVELS {
        return sorted_counts(points, map, levels);
    }
    let mut voxels = Voxels::new(boxes);
    for point in points {
        voxels.set(boxed(map, point));
    }
    let mut counts = Vec::new();
    for level in 0..levels {
        if level > 0 {
            voxels = voxels.folded();
        }
        counts.push(voxels.count());
    }
    counts
}

/// Counts boxes by sorting their keys (Morton 1966): keys of larger boxes are prefixes.
fn sorted_counts<M: Space>(
    points: impl Iterator<Item = M::Point>,
    map: &M,
    levels: u32,
) -> Vec<u64> {
    let mut keys: Vec<u64> = points.map(|point| key(map, point)).collect();
    keys.sort_unstable();
    let mut counts = Vec::new();
    for level in 0..levels {
        if level > 0 {
            keys.iter_mut().for_each(|key| *key >>= M::Point::DIMENSION);
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
fn boxed<M: Space>(map: &M, point: M::Point) -> [u32; 3] {
    map.apply(point).coordinates().map(|at| at as u32)
}
