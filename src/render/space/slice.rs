//! Slices and cuts: half-spaces to which a picture is confined, and the extent of what they leave.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::geometry::{Bounds, DAffine3, DMat3, DVec3, HalfSpace, Outline as _, Solid};

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

/// Number of rounds over all half-spaces in which the bound of a solid is lowered.
const ROUNDS: usize = 8;

/// Number of steps in which the multiple of a half-space's normal is enclosed, and then narrowed.
const STEPS: usize = 40;

/// Instance in the search for an extent.
struct Candidate {
    /// No point of it is farther.
    bound: f64,
    /// Whether the bound is that of a solid, not of a box about it.
    is_of_solid: bool,
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
                is_of_solid: false,
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
                let Some(solid) = &part.solid else { continue };
                if found.is_of_solid {
                    return Some(found.bound);
                }
                heap.extend(
                    bound_of_solid(solid, &found.map, within, axis).map(|bound| Candidate {
                        bound: bound.min(found.bound),
                        is_of_solid: true,
                        ..found
                    }),
                );
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

/// Returns an upper bound of an axis on the part of a convex solid in half-spaces, exact for a single one and for a
/// slab; `None` if nothing is left of the solid.
///
/// By duality, the greatest axis · x is the least value of h(axis − Σ λᵢ nᵢ) + Σ λᵢ dᵢ for multiples λᵢ ≥ 0, where h
/// is the support function of the solid (Rockafellar 1970, § 28).
fn bound_of_solid(solid: &Solid, map: &DAffine3, within: &[HalfSpace], axis: DVec3) -> Option<f64> {
    let inverse = map.matrix3.transpose();
    let support =
        |direction: DVec3| map.translation.dot(direction) + solid.support(inverse * direction);
    let mut cutting = Vec::new();
    for space in within {
        let nearest = -support(-space.normal);
        let farthest = support(space.normal);
        let tolerance = 1e-12 * (farthest - nearest + space.distance.abs());
        if nearest > space.distance + tolerance {
            return None;
        }
        if farthest > space.distance {
            cutting.push((space, 0.0));
        }
    }
    let mut least = support(axis);
    let mut rest = axis;
    let mut paid = 0.0;
    for _ in 0..ROUNDS {
        let before = least;
        for (space, multiple) in &mut cutting {
            let HalfSpace { normal, distance } = **space;
            rest += normal * *multiple;
            paid -= distance * *multiple;
            let value =
                |multiple: f64| paid + multiple * distance + support(rest - normal * multiple);
            (*multiple, least) = lowest(value, rest, normal);
            rest -= normal * *multiple;
            paid += distance * *multiple;
        }
        if before - least <= 1e-12 * before.abs() {
            break;
        }
    }
    // Lower than the solid, if the half-spaces together leave nothing of it.
    let lowest = -support(-axis);
    (least >= lowest - 1e-9 * (support(axis) - lowest)).then_some(least)
}

/// Returns the multiple of a normal, from 0 on, at which a convex function is lowest, and its value there.
fn lowest(value: impl Fn(f64) -> f64, axis: DVec3, normal: DVec3) -> (f64, f64) {
    let mut best = (0.0, value(0.0));
    let mut at = |multiple: f64| {
        let found = value(multiple);
        if found < best.1 {
            best = (multiple, found);
        }
        found
    };
    // Here nothing of the axis is left along the normal: the exact place where both are parallel.
    let along = (axis.dot(normal) / normal.length_squared()).max(0.0);
    at(along);
    let mut high = along.max(axis.length() / normal.length());
    for _ in 0..STEPS {
        if at(2.0 * high) >= at(high) {
            break;
        }
        high *= 2.0;
    }
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let (mut low, mut high) = (0.0, 2.0 * high);
    for _ in 0..STEPS {
        let [left, right] = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
        match at(left) <= at(right) {
            true => high = right,
            false => low = left,
        }
    }
    best
}
