//! Slices and cuts: half-spaces to which a picture is confined, and the extent of what they leave.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::geometry::{Bounds, DAffine3, DMat3, DVec3, HalfSpace};

use super::scene::{Child, Part};

/// Returns a half-space under a map.
pub(super) fn mapped(space: &HalfSpace, map: &DAffine3) -> HalfSpace {
    let normal = map.matrix3.inverse().transpose() * space.normal;
    HalfSpace {
        normal,
        distance: space.distance + normal.dot(map.translation),
    }
}

/// Size at which instances are not replaced in the search for an extent, relative to the set.
const FINEST: f64 = 1.0 / 4096.0;

/// Limit of the number of instances that are visited for one side of the extent. Where it is met, the side is that
/// of the boxes that were reached.
const MAX_VISITED: usize = 1 << 17;

/// Instance in the search for an extent.
struct Candidate {
    /// No point of it is farther.
    bound: f64,
    level: u32,
    map: DAffine3,
    object: usize,
    /// Largest half side of its box.
    size: f64,
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        // Of equal bounds, the deepest is the nearest to an end.
        let bounds = self.bound.total_cmp(&other.bound);
        bounds.then(self.level.cmp(&other.level))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Candidate {}

/// Search for the extent of the part of a set that lies in all of several half-spaces, by branch and bound on its
/// instances (Land & Doig 1960).
pub(super) struct Search<'a> {
    pub(super) parts: &'a [Part],
    pub(super) start: &'a [Child],
    pub(super) steps: Option<u32>,
}

impl Search<'_> {
    /// Returns the box of the part under a rotation; `None` if there is no such part.
    pub(super) fn extent(&self, rotation: DMat3, within: &[HalfSpace]) -> Option<Bounds<DVec3>> {
        let rotation = DAffine3::from_mat3(rotation);
        let within: Vec<HalfSpace> = within
            .iter()
            .map(|space| mapped(space, &rotation))
            .collect();
        let side = |axis: usize, side: f64| {
            self.reach(&rotation, &within, DVec3::AXES[axis] * side)
                .map(|reach| reach * side)
        };
        let max = DVec3::new(side(0, 1.0)?, side(1, 1.0)?, side(2, 1.0)?);
        let min = DVec3::new(side(0, -1.0)?, side(1, -1.0)?, side(2, -1.0)?);
        Some(Bounds::new(min.min(max), max))
    }

    /// Returns the greatest value of an axis on the part.
    fn reach(&self, rotation: &DAffine3, within: &[HalfSpace], axis: DVec3) -> Option<f64> {
        let candidate = |map: DAffine3, object: usize, level: u32| {
            let (middle, half) = self.parts[object].hull.image(&map.matrix3);
            Some(Candidate {
                bound: bound(middle + map.translation, half, within, axis)?,
                level,
                map,
                object,
                size: half.max_element(),
            })
        };
        let start = self.start.iter();
        let mut heap: BinaryHeap<Candidate> = start
            .filter_map(|child| candidate(*rotation * child.map, child.object, 0))
            .collect();
        let finest = FINEST * heap.iter().map(|start| start.size).fold(0.0, f64::max);
        let mut visited = 0;
        while let Some(found) = heap.pop() {
            let part = &self.parts[found.object];
            visited += 1;
            if !part.is_replaced || Some(found.level) == self.steps {
                if part.solid.is_some() {
                    return Some(found.bound);
                }
                continue;
            }
            if found.size <= finest || visited > MAX_VISITED {
                return Some(found.bound);
            }
            for child in &part.children {
                heap.extend(candidate(
                    found.map * child.map,
                    child.object,
                    found.level + 1,
                ));
            }
        }
        None
    }
}

/// Returns an upper bound of an axis on the part of a box in half-spaces, the exact one of each alone; `None` if
/// the box lies beyond one of them.
fn bound(middle: DVec3, half: DVec3, within: &[HalfSpace], axis: DVec3) -> Option<f64> {
    let mut least = axis.dot(middle) + axis.abs().dot(half);
    for space in within {
        let normal = space.normal;
        let nearest = normal.dot(middle) - normal.abs().dot(half);
        if nearest > space.distance + 1e-12 * (normal.abs().dot(half) + space.distance.abs()) {
            return None;
        }
        // By duality: axis · x ≤ multiple · distance + (axis − multiple · normal) · x.
        let multiple = axis.dot(axis) / normal.dot(axis);
        if multiple.is_finite() && multiple > 0.0 {
            let rest = axis - normal * multiple;
            // The component along the axis vanishes.
            let rest = rest - axis * rest.dot(axis);
            let dual = multiple * space.distance + rest.dot(middle) + rest.abs().dot(half);
            least = least.min(dual);
        }
    }
    Some(least)
}
