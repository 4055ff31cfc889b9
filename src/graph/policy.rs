//! Policy iteration on convex polygons about what becomes of objects: their corners, followed to their end at
//! once.

use crate::geometry::{DAffine2, DMat2, DVec2};

/// Where a corner comes from.
#[derive(Clone, Copy)]
enum Origin {
    /// A point that is no image.
    Point(DVec2),
    /// A map's image of another corner, by number.
    Image(DAffine2, usize),
}

/// Evaluates the present policy: returns the points that corners converge to if each is mapped, again and
/// again, from the origin of the farthest point along its direction.
///
/// This is Howard's policy iteration ("Dynamic Programming and Markov Processes", 1960): support
/// functions solve h(u) = max (h(Lᵀu) + t·u) over maps x → Lx + t, a choice of a map for every
/// direction leads back to a direction that was there before, and what it comes to there is the fixed
/// point of a product of maps. Rounds of images alone come as near in a step as the maps contract,
/// which may be very little.
///
/// Every kind has a polygon, points of its own, and images of kinds by number. Corners are
/// counter-clockwise from the one that is farthest to the left.
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
    let rightmost: Vec<usize> = polygons.iter().map(|corners| rightmost(corners)).collect();
    let origin = |kind: usize, direction: DVec2| {
        let mut best = (f64::NEG_INFINITY, None);
        for &point in &points[kind] {
            let far = point.dot(direction);
            if far > best.0 {
                best = (far, Some(Origin::Point(point)));
            }
        }
        for &(map, inner) in &images[kind] {
            let corners = &polygons[inner];
            let along = map.matrix2.transpose() * direction;
            if let Some(number) = farthest(corners, rightmost[inner], along) {
                let far = corners[number].dot(along) + map.translation.dot(direction);
                if far > best.0 {
                    best = (far, Some(Origin::Image(map, firsts[inner] + number)));
                }
            }
        }
        best.1
    };
    let kinds = polygons.iter().enumerate();
    let origins: Vec<Option<Origin>> = kinds
        .flat_map(|(kind, corners)| directions(corners).map(move |direction| (kind, direction)))
        .map(|(kind, direction)| origin(kind, direction))
        .collect();
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

/// The progress of following a corner.
#[derive(Clone, Copy)]
enum Followed {
    Not,
    /// It is on the way, at this place.
    Now(usize),
    /// To what it becomes; NaN where that is not known.
    Fully(DVec2),
}

struct Ends<'o> {
    origins: &'o [Option<Origin>],
    states: Vec<Followed>,
}

impl Ends<'_> {
    /// What a corner becomes: all that it comes from is followed.
    fn of(&mut self, corner: usize) -> DVec2 {
        let mut way: Vec<(usize, DAffine2)> = Vec::new();
        let mut at = corner;
        let mut end = loop {
            match (self.states[at], self.origins[at]) {
                (Followed::Fully(end), _) => break end,
                (Followed::Now(first), _) => {
                    // It has come back: the fixed point of the maps since then.
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

/// The point that a map leaves where it is.
fn fixed_point(map: &DAffine2) -> DVec2 {
    (DMat2::IDENTITY - map.matrix2).inverse() * map.translation
}

/// Directions along which the corners of a polygon are farthest.
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

/// The corner that is farthest to the right.
pub(super) fn rightmost(corners: &[DVec2]) -> usize {
    let order = |a: &usize, b: &usize| corners[*a].x.total_cmp(&corners[*b].x);
    (0..corners.len()).max_by(order).unwrap_or_default()
}

/// The corner that is farthest along a vector, where one is known that is farthest to the right.
pub(super) fn farthest(corners: &[DVec2], right: usize, vector: DVec2) -> Option<usize> {
    let first = corners.first()?;
    // Along the lower and along the upper half, corners reach farther and farther, then less.
    let half = if vector.y < 0.0 {
        0..right
    } else {
        right..corners.len()
    };
    let (mut low, mut high) = (half.start, half.end);
    while low < high {
        let middle = usize::midpoint(low, high);
        let next = corners.get(middle + 1).unwrap_or(first);
        if (*next - corners[middle]).dot(vector) > 0.0 {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    Some(if low < corners.len() { low } else { 0 })
}
