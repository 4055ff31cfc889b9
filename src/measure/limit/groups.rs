//! Groups of copies: where a set is made of many copies, neighbours form sets of their own.
//!
//! Descents divide a copy into all copies that its set is made of. Among thousands of them, few are near a given box or
//! ball; with groups, those are found in logarithmic time and memory.

use crate::geometry::{Affine, Bounds, Point};
use crate::morton::interleaved;

use super::LimitCopy;

/// Maximum number of copies in all sets that are products of others.
const MAX_PRODUCTS: usize = 1 << 14;

/// Number of copies in a set from which they are grouped, and number of copies in a group.
const MANY: usize = 128;
const GROUP: usize = 16;

/// A copy, and its share in the mass of its set.
pub(super) type Shared<M> = (LimitCopy<M>, f64);

/// Groups the copies in every object's set, and those that the whole is made of, where they are many. Groups become
/// further objects, whose shares add up to 1.
pub(super) fn grouped<M: Affine>(
    mut children: Vec<Vec<Shared<M>>>,
    start: Vec<Shared<M>>,
) -> (Vec<Vec<Shared<M>>>, Vec<Shared<M>>) {
    for object in 0..children.len() {
        let copies = std::mem::take(&mut children[object]);
        children[object] = group(copies, &mut children);
    }
    let start = group(start, &mut children);
    (children, start)
}

/// Returns no more than [`MANY`] copies: of groups, which are added to the objects, if there are more.
fn group<M: Affine>(
    mut copies: Vec<Shared<M>>,
    objects: &mut Vec<Vec<Shared<M>>>,
) -> Vec<Shared<M>> {
    if copies.len() > MANY {
        let mut bounds = Bounds::EMPTY;
        for (copy, _) in &copies {
            bounds.add(copy.map.translation());
        }
        copies.sort_by_cached_key(|(copy, _)| place(copy.map.translation(), &bounds));
    }
    while copies.len() > MANY {
        let groups = copies.chunks(GROUP).map(|members| {
            let mass: f64 = members.iter().map(|(_, share)| share).sum();
            let members = members.iter().map(|(copy, share)| (*copy, share / mass));
            objects.push(members.collect());
            (LimitCopy::whole(objects.len() - 1), mass)
        });
        copies = groups.collect();
    }
    copies
}

/// Returns the position of a point along a Z-shaped curve through a box.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the numbers are from 0 to 2^20"
)]
fn place<P: Point>(point: P, bounds: &Bounds<P>) -> u64 {
    const CELLS: f64 = (1u64 << 20) as f64;
    let [low, size] = [bounds.min(), bounds.size()].map(Point::coordinates);
    let point = point.coordinates();
    let cell = |axis: usize| match size[axis] > 0.0 {
        true => ((point[axis] - low[axis]) / size[axis] * CELLS) as u32,
        false => 0,
    };
    interleaved(P::DIMENSION, [0, 1, 2].map(cell))
}

/// Replaces the copies in every object's set by the copies in their sets; `None` if these are too many.
pub(super) fn products<M: Affine>(children: &[Vec<Shared<M>>]) -> Option<Vec<Vec<Shared<M>>>> {
    let mut left = MAX_PRODUCTS;
    let of_object = |copies: &Vec<Shared<M>>| {
        let all = copies.iter().map(|(copy, _)| children[copy.object].len());
        left = left.checked_sub(all.sum())?;
        let inner = |(copy, share): &Shared<M>| {
            let (copy, share) = (*copy, *share);
            let inner = children[copy.object].iter();
            inner.map(move |(inner, part)| (copy.compose(inner), share * part))
        };
        Some(copies.iter().flat_map(inner).collect())
    };
    children.iter().map(of_object).collect()
}

/// Returns copies and their shares apart.
pub(super) fn unzipped<M>(copies: Vec<Shared<M>>) -> (Vec<LimitCopy<M>>, Vec<f64>) {
    copies.into_iter().unzip()
}
