//! The Hausdorff distance of two sets: the maximum distance of a point of one from the other.

use crate::geometry::Point;

use super::cover::{NoCover, Subject};
use super::covering::Covering;
use super::nearest::{KdTree, Open};

/// Precision of a distance, and the effort allowed for it.
#[derive(Clone, Copy, Debug)]
pub struct Precision {
    /// Error, as a multiple of the long side of a box that holds both sets.
    pub tolerance: f64,
    /// Maximum number of points by which a set is covered; where they do not suffice, the error is larger.
    pub max_points: usize,
}

impl Default for Precision {
    fn default() -> Self {
        Self {
            tolerance: 1e-3,
            max_points: 4_000_000,
        }
    }
}

/// Distance of two sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Maximum distance of a point of the first set from the second, to within the error.
    pub there: f64,
    /// Maximum distance of a point of the second set from the first, to within the error.
    pub back: f64,
    /// Upper bound of the error of both distances.
    pub error: f64,
    /// Error that was asked for.
    pub wanted: f64,
    /// Number of points that cover each set.
    pub points: [usize; 2],
}

impl Distance {
    /// Returns the Hausdorff distance, the larger of the two.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.there.max(self.back)
    }

    /// Returns `true` if the error is as small as was asked for. Otherwise that would have taken more points
    /// than are allowed.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        self.error <= self.wanted
    }

    /// Returns `true` if the sets may be equal: the distance is not larger than its error.
    #[must_use]
    pub fn may_be_same(&self) -> bool {
        self.value() <= self.error
    }
}

/// Factor by which each cover is finer than the previous one.
const FINER: f64 = 2.0;

/// Radius of the discs of the first covers, as a multiple of the size of both sets.
const COARSE: f64 = 1.0 / 16.0;

/// Upper bound of the error by rounding, as a multiple of the largest coordinate.
const ROUNDING: f64 = 1e-12;

/// Computes the Hausdorff distance of two sets.
///
/// Both sets are covered by discs, or balls in space, of one radius ε about points, each of which is no farther than ε from the
/// set. The distance of the points, which is computed exactly, is therefore that of the sets to within 2 ε.
/// Covers are refined until 2 ε is as small as asked for, or until the next one takes too many points.
///
/// # Errors
///
/// Returns an error if a set cannot be covered even by large discs: the number of the set, 0 or 1, and the
/// reason.
pub fn hausdorff<F: Covering>(
    sets: [&Subject<'_, F>; 2],
    precision: &Precision,
) -> Result<Distance, (usize, NoCover)> {
    let mut bounds = *sets[0].bounds();
    bounds.add_all(sets[1].bounds());
    let size = bounds.size().max_element();
    let far = bounds.min().abs().max(bounds.max().abs()).max_element();
    let rounding = ROUNDING * far.max(f64::MIN_POSITIVE);
    // A single point has no size; any radius will do.
    let wanted = (precision.tolerance * size / 2.0).max(rounding);
    let covers = |radius: f64| -> Result<[Vec<F::Point>; 2], (usize, NoCover)> {
        let cover = |which: usize| {
            let points = sets[which].cover(radius, precision.max_points);
            points.map_err(|error| (which, error))
        };
        Ok([cover(0)?, cover(1)?])
    };
    let mut radius = (COARSE * size).max(wanted);
    let mut best = covers(radius)?;
    while radius > wanted {
        let finer = (radius / FINER).max(wanted);
        match covers(finer) {
            Ok(points) => (radius, best) = (finer, points),
            Err((_, NoCover::TooMany(_) | NoCover::TooManyOpen)) => break,
            Err(error) => return Err(error),
        }
    }
    let points = [0, 1].map(|which| best[which].len());
    let [first, second] = best.map(KdTree::new);
    Ok(Distance {
        there: farthest(&first, &second),
        back: farthest(&second, &first),
        error: 2.0 * radius + rounding,
        wanted: 2.0 * wanted + rounding,
        points,
    })
}

/// Returns the maximum distance of a point of one set from the nearest of another.
fn farthest<P: Point>(from: &KdTree<P>, to: &KdTree<P>) -> f64 {
    let (mut farthest, mut near, mut open) = (0.0, 0, Open::new());
    for &point in from.points() {
        // A point that is nearer than the maximum does not matter, and its nearest need not be found.
        let (place, square) = to.find(point, farthest, near, &mut open);
        near = place;
        farthest = f64::max(farthest, square);
    }
    farthest.sqrt()
}
