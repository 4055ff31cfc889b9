//! The Hausdorff distance of two sets: how far a point of one can be from the other.

use crate::geometry::DVec2;

use super::cover::{NoCover, Subject};
use super::nearest::{Nearest, Open};

/// How exactly a distance is told, and for how much work.
#[derive(Clone, Copy, Debug)]
pub struct Precision {
    /// The error, as a multiple of the long side of a box that holds both sets.
    pub tolerance: f64,
    /// The most points that may stand for a set; where they do not suffice, the error is larger.
    pub most_points: usize,
}

impl Default for Precision {
    fn default() -> Self {
        Self {
            tolerance: 1e-3,
            most_points: 4_000_000,
        }
    }
}

/// The distance of two sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// The farthest that a point of the first set is from the second, to within the error.
    pub there: f64,
    /// The farthest that a point of the second set is from the first, to within the error.
    pub back: f64,
    /// No figure is off by more: a bound, not a guess.
    pub error: f64,
    /// The error that was asked for.
    pub wanted: f64,
    /// The points that stood for each set.
    pub points: [usize; 2],
}

impl Distance {
    /// The Hausdorff distance.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.there.max(self.back)
    }

    /// Whether the error is as small as was asked for: otherwise that would have taken more points than
    /// are allowed.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        self.error <= self.wanted
    }

    /// Whether the sets may be the same: the distance is not more than its error.
    #[must_use]
    pub fn may_be_same(&self) -> bool {
        self.value() <= self.error
    }
}

/// Covers are made finer by this factor.
const FINER: f64 = 2.0;

/// The first covers have discs of this radius, as a multiple of the size.
const COARSE: f64 = 1.0 / 16.0;

/// Rounding adds no more than this, as a multiple of the farthest coordinate.
const ROUNDING: f64 = 1e-12;

/// The Hausdorff distance of two sets.
///
/// Both sets are covered by discs of one radius ε about points, of which no point is farther from the
/// set than ε. So the distance of the points, which is found exactly, is that of the sets to within 2 ε.
/// Covers are made finer until that is as small as asked for, or takes too many points.
///
/// # Errors
///
/// If a set cannot be covered even by large discs: its number, 0 or 1, and why.
pub fn hausdorff(
    sets: [&Subject<'_>; 2],
    precision: &Precision,
) -> Result<Distance, (usize, NoCover)> {
    let mut bounds = *sets[0].bounds();
    bounds.add_all(sets[1].bounds());
    let size = bounds.size().max_element();
    let far = bounds.min().abs().max(bounds.max().abs()).max_element();
    let rounding = ROUNDING * far.max(f64::MIN_POSITIVE);
    // A single point has no size; any radius will do.
    let wanted = (precision.tolerance * size / 2.0).max(rounding);
    let covers = |radius: f64| -> Result<[Vec<DVec2>; 2], (usize, NoCover)> {
        let cover = |which: usize| {
            let points = sets[which].cover(radius, precision.most_points);
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
            Err((_, NoCover::TooMany(_))) => break,
            Err(error) => return Err(error),
        }
    }
    let points = [0, 1].map(|which| best[which].len());
    let [first, second] = best.map(Nearest::new);
    Ok(Distance {
        there: farthest(&first, &second),
        back: farthest(&second, &first),
        error: 2.0 * radius + rounding,
        wanted: 2.0 * wanted + rounding,
        points,
    })
}

/// The farthest that a point of one set is from the nearest of another.
fn farthest(from: &Nearest, to: &Nearest) -> f64 {
    let (mut farthest, mut near, mut open) = (0.0, 0, Open::new());
    for &point in from.points() {
        // A point that is near enough does not matter, so its nearest need not be found.
        let (place, square) = to.find(point, farthest, near, &mut open);
        near = place;
        farthest = f64::max(farthest, square);
    }
    farthest.sqrt()
}
