//! Policy iteration on the convex polygons of subtrees: follows corners to their limits at once.

use crate::geometry::{DAffine2, DMat2, DVec2};

use super::sectors::MANY;
use super::union::{Farthest, Landmarks, Union};

/// Origin of a corner.
#[derive(Clone, Copy)]
enum Origin {
    /// Point that is not an image.
    Point(DVec2),
    /// Image of another corner, by number, under a map.
    Image(DAffine2, usize),
}

/// Evaluates the current policy: returns the limits of the corners if each is mapped repeatedly from the
/// origin of the farthest point along its direction.
///
/// This is Howard's policy iteration ("Dynamic Programming and Markov Processes", 1960). Support
/// functions solve h(u) = max (h(Lᵀu) + t·u) over maps x → Lx + t. With a map chosen for every direction,
/// directions recur, and the limit at a recurring direction is the fixed point of a product of maps.
/// Iterating images alone converges at the rate at which the maps contract, which may be slow.
///
/// Every kind has a polygon, points of its own, and images of kinds by number. Corners are
/// counter-clockwise from the leftmost.
pub(super) fn followed(
    polygons: &[Vec<DVec2>],
    images: &[Vec<(DAffine2, usize)>],
    points: &[Vec<DVec2>],
) -> Vec<Vec<DVec2>> {
    let all: Vec<DVec2> = polygons.iter().flatten().copied().collect();
    let mut firsts = Vec::with_capacity(polygons.len());
    let mut count = 0;
    for corners in polygons {
        firsts.push(count);
        count += corners.len();
    }
    // Directions turn, and so do their images: the farthest corner is near the one before.
    let mut nearby: Vec<Vec<usize>> = images.iter().map(|images| vec![0; images.len()]).collect();
    let mut origin = |kind: usize, direction: DVec2| {
        let mut best = (f64::NEG_INFINITY, None);
        for &point in &points[kind] {
            let far = point.dot(direction);
            if far > best.0 {
                best = (far, Some(Origin::Point(point)));
            }
        }
        for (&(map, inner), near) in images[kind].iter().zip(&mut nearby[kind]) {
            let corners = &polygons[inner];
            let along = map.matrix2.transpose() * direction;
            if let Some(number) = farthest_near(corners, *near, along) {
                *near = number;
                let far = corners[number].dot(along) + map.translation.dot(direction);
                if far > best.0 {
                    best = (far, Some(Origin::Image(map, firsts[inner] + number)));
                }
            }
        }
        best.1
    };
    let landmarks = Landmarks::of_all(polygons);
    let mut origins: Vec<Option<Origin>> = Vec::with_capacity(all.len());
    for (kind, corners) in polygons.iter().enumerate() {
        if images[kind].len() < MANY {
            origins.extend(directions(corners).map(|direction| origin(kind, direction)));
            continue;
        }
        let union = Union {
            points: &points[kind],
            images: &images[kind],
            polygons,
            landmarks: &landmarks,
        };
        let farthest = Farthest::of(&union);
        origins.extend(directions(corners).map(|direction| {
            let reached = farthest.along(direction)?;
            Some(match reached.from {
                None => Origin::Point(reached.point),
                Some((number, corner)) => {
                    let (map, inner) = images[kind][number as usize];
                    Origin::Image(map, firsts[inner] + corner)
                }
            })
        }));
    }
    let mut ends = Ends {
        origins: &origins,
        states: vec![Followed::Not; all.len()],
    };
    let mut ends = all.iter().enumerate().map(|(number, corner)| {
        let end = ends.of(number);
        if end.is_finite() { end } else { *corner }
    });
    let ends_of = |corners: &Vec<DVec2>| ends.by_ref().take(corners.len()).collect();
    polygons.iter().map(ends_of).collect()
}

/// Progress of following a corner.
#[derive(Clone, Copy)]
enum Followed {
    Not,
    /// The corner is on the current path, at this place.
    Now(usize),
    /// Limit of the corner; NaN if unknown.
    Fully(DVec2),
}

struct Ends<'o> {
    origins: &'o [Option<Origin>],
    states: Vec<Followed>,
}

impl Ends<'_> {
    /// Returns the limit of a corner, following its chain of origins.
    fn of(&mut self, corner: usize) -> DVec2 {
        let mut way: Vec<(usize, DAffine2)> = Vec::new();
        let mut at = corner;
        let mut end = loop {
            match (self.states[at], self.origins[at]) {
                (Followed::Fully(end), _) => break end,
                (Followed::Now(first), _) => {
                    // The chain has closed: the limit is the fixed point of the maps around the cycle.
                    let maps = way[first..].iter().map(|(_, map)| *map);
                    break fixed_point(&maps.fold(DAffine2::IDENTITY, |all, map| all * map));
                }
                (Followed::Not, Some(Origin::Image(map, from))) => {
                    self.states[at] = Followed::Now(way.len());
                    way.push((at, map));
                    at = from;
                }
                (Followed::Not, Some(Origin::Point(point))) => {
                    self.states[at] = Followed::Fully(point);
                    break point;
                }
                (Followed::Not, None) => {
                    self.states[at] = Followed::Fully(DVec2::NAN);
                    break DVec2::NAN;
                }
            }
        };
        for (corner, map) in way.into_iter().rev() {
            end = map.transform_point2(end);
            self.states[corner] = Followed::Fully(end);
        }
        end
    }
}

/// Returns the fixed point of a map.
fn fixed_point(map: &DAffine2) -> DVec2 {
    (DMat2::IDENTITY - map.matrix2).inverse() * map.translation
}

/// Iterates over directions along which the corners of a polygon are farthest.
fn directions(corners: &[DVec2]) -> impl Iterator<Item = DVec2> {
    let count = corners.len();
    (0..count).map(move |number| {
        let [before, at, after] = [count + number - 1, number, number + 1];
        let [before, at, after] = [before, at, after].map(|number| corners[number % count]);
        let [into, on] = [at - before, after - at].map(DVec2::normalize_or_zero);
        let outward = -(into + on).perp();
        if count > 2 { outward } else { into - on }
    })
}

/// Returns the number of the corner that is farthest along a vector, found from another one.
fn farthest_near(corners: &[DVec2], near: usize, vector: DVec2) -> Option<usize> {
    let count = corners.len();
    let mut at = near;
    for step in [1, count.checked_sub(1)?] {
        // Around a polygon, the distance has one maximum. No corner comes twice.
        for _ in 0..count {
            let next = (at + step) % count;
            if (corners[next] - corners[at]).dot(vector) <= 0.0 {
                break;
            }
            at = next;
        }
    }
    Some(at)
}
