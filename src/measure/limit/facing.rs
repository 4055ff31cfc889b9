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

/// Returns the extent of copies in a direction of length 1, to a part of their size.
///
/// The copies whose discs may reach farthest are divided repeatedly. Of copies with equal vectors, the one that is
/// moved farthest is kept; of more than 64 others, those whose discs reach farthest. The search ends after about `most_work`
/// copies.
pub(super) fn reach<M: Affine>(
    objects: &[ObjectLimit<M>],
    copies: &[LimitCopy<M>],
    direction: M::Point,
    tolerance: f64,
    most_work: usize,
) -> f64 {
    const MAX_COPIES: usize = 64;
    let whole = Facing {
        vector: direction,
        moved: 0.0,
        object: 0,
    };
    let mut copies: Vec<_> = copies.iter().map(|copy| whole.compose(copy)).collect();
    let sizes = copies.iter().map(|copy| copy.reach(objects));
    let tolerance = tolerance * sizes.map(|(at, most)| most - at).fold(0.0, f64::max);
    let mut certain = f64::NEG_INFINITY;
    let mut reaching = Vec::new();
    let mut work = 0;
    for _ in 0..MAX_SWEEPS {
        reaching.clear();
        work += copies.len();
        for copy in copies.drain(..) {
            let (at, most) = copy.reach(objects);
            certain = certain.max(at);
            reaching.push((most, copy));
        }
        reaching.retain(|(most, _)| *most > certain + tolerance);
        if reaching.is_empty() || work > most_work {
            break;
        }
        keep_farthest(&mut reaching);
        if reaching.len() > MAX_COPIES {
            reaching.select_nth_unstable_by(MAX_COPIES, |(a, _), (b, _)| b.total_cmp(a));
            reaching.truncate(MAX_COPIES);
        }
        let inner = reaching.iter().flat_map(|(_, copy)| {
            let children = objects[copy.object].children.iter();
            children.map(|inner| copy.compose(inner))
        });
        copies.extend(inner);
    }
    certain
}

/// Keeps, of copies of one object with equal vectors, the one that is moved farthest. Copies come with upper bounds of
/// their products.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the numbers are no larger than 1e13"
)]
fn keep_farthest<P: Point>(copies: &mut Vec<(f64, Facing<P>)>) {
    /// Length, as a part of the longest vector, below which differences are rounding.
    const SAME: f64 = 1e-13;
    let longest = copies.iter().map(|(_, copy)| copy.vector.length());
    let unit = SAME * longest.fold(0.0, f64::max);
    let keyed = copies.drain(..).map(|it| {
        let vector = it.1.vector.coordinates();
        let key = (it.1.object, vector.map(|part| (part / unit).round() as i64));
        (key, it)
    });
    let mut keyed: Vec<_> = keyed.collect();
    keyed.sort_by(|(key, (_, copy)), (other, (_, than))| {
        (key.cmp(other)).then(than.moved.total_cmp(&copy.moved))
    });
    keyed.dedup_by_key(|(key, _)| *key);
    copies.extend(keyed.into_iter().map(|(_, it)| it));
}
