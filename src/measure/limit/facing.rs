//! Extents of limit sets in a direction.

use crate::geometry::{Affine, Linear, Point};

use super::{LimitCopy, MAX_SWEEPS, ObjectLimit};

/// A copy as a direction sees it: the products of its points with the direction are those of the object's own points
/// with a vector, moved by a number.
struct Facing<P> {
    vector: P,
    moved: f64,
    object: usize,
}

impl<P: Point> Facing<P> {
    /// Returns a copy inside this one.
    fn compose<M: Affine<Point = P>>(&self, inner: &LimitCopy<M>) -> Self {
        Self {
            vector: inner.map.linear().transposed(self.vector),
            moved: self.moved + self.vector.dot(inner.map.translation()),
            object: inner.object,
        }
    }

    /// Returns the product of a point of the copy, and an upper bound of all its points' products.
    fn reach<M: Affine<Point = P>>(&self, objects: &[ObjectLimit<M>]) -> (f64, f64) {
        let part = &objects[self.object];
        let at = self.moved + self.vector.dot(part.point);
        (at, at + self.vector.length() * part.radius)
    }
}

/// Returns the extent of copies in a direction of length 1.
///
/// The copies whose discs may reach farthest are divided repeatedly. Of copies with equal vectors, the one that is
/// moved farthest is kept; of more than 256 others, those whose discs reach farthest.
pub(super) fn reach<M: Affine>(
    objects: &[ObjectLimit<M>],
    copies: &[LimitCopy<M>],
    direction: M::Point,
) -> f64 {
    const MAX_COPIES: usize = 256;
    const TOLERANCE: f64 = 1e-13;
    let whole = Facing {
        vector: direction,
        moved: 0.0,
        object: 0,
    };
    let mut copies: Vec<_> = copies.iter().map(|copy| whole.compose(copy)).collect();
    let reach = |copy: &Facing<M::Point>| copy.reach(objects);
    let sizes = copies.iter().map(|copy| reach(copy).1 - reach(copy).0);
    let tolerance = TOLERANCE * sizes.fold(0.0, f64::max);
    let mut certain = f64::NEG_INFINITY;
    for _ in 0..MAX_SWEEPS {
        certain = copies
            .iter()
            .map(|copy| reach(copy).0)
            .fold(certain, f64::max);
        copies.retain(|copy| reach(copy).1 > certain + tolerance);
        if copies.is_empty() {
            break;
        }
        keep_farthest(&mut copies);
        if copies.len() > MAX_COPIES {
            copies.sort_by(|a, b| reach(b).1.total_cmp(&reach(a).1));
            copies.truncate(MAX_COPIES);
        }
        let inner = copies.iter().flat_map(|copy| {
            let children = objects[copy.object].children.iter();
            children.map(|inner| copy.compose(inner))
        });
        copies = inner.collect();
    }
    certain
}

/// Keeps, of copies of one object with equal vectors, the one that is moved farthest.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the numbers are no larger than 1e13"
)]
fn keep_farthest<P: Point>(copies: &mut Vec<Facing<P>>) {
    /// Length, as a part of the longest vector, below which differences are rounding.
    const SAME: f64 = 1e-13;
    let longest = copies.iter().map(|copy| copy.vector.length());
    let unit = SAME * longest.fold(0.0, f64::max);
    let key = |copy: &Facing<P>| {
        let vector = copy.vector.coordinates();
        (copy.object, vector.map(|part| (part / unit).round() as i64))
    };
    copies.sort_by(|a, b| (key(a).cmp(&key(b))).then(b.moved.total_cmp(&a.moved)));
    copies.dedup_by_key(|copy| key(copy));
}
