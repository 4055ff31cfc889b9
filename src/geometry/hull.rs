//! Convex hulls of points, and distances to polygons and segments.

use glam::DVec2;

use crate::work;

/// [Work](work) of a point.
const POINT: usize = 8;

/// Computes the corners of the convex hull of points, counter-clockwise from the leftmost (Andrew's monotone
/// chain, 1979).
///
/// A point within `tolerance` of its predecessor in the order of x is dropped, and so is a corner within
/// `tolerance` of the line through its neighbours.
pub(crate) fn convex_hull(mut points: Vec<DVec2>, tolerance: f64) -> Vec<DVec2> {
    work::count(POINT * points.len());
    if points.len() >= MANY {
        drop_inner(&mut points, tolerance);
    }
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup_by(|a, b| a.distance(*b) <= tolerance);
    if points.len() < 3 {
        return points;
    }
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..] {
                let along = point - a;
                let beyond = (b - a).perp_dot(along);
                if beyond > 0.0 && beyond > tolerance * along.length() {
                    break;
                }
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut corners = half(&mut points.iter().copied());
    corners.extend(half(&mut points.iter().rev().copied()));
    corners
}

/// Vectors along the axes and the diagonals, counter-clockwise from the x axis.
pub(crate) const EIGHT_WAYS: [DVec2; 8] = [
    DVec2::new(1.0, 0.0),
    DVec2::new(1.0, 1.0),
    DVec2::new(0.0, 1.0),
    DVec2::new(-1.0, 1.0),
    DVec2::new(-1.0, 0.0),
    DVec2::new(-1.0, -1.0),
    DVec2::new(0.0, -1.0),
    DVec2::new(1.0, -1.0),
];

/// Number of points from which those that are well inside are dropped before the others are sorted.
const MANY: usize = 128;

/// Drops points inside an octagon of extreme points (Akl & Toussaint 1978), farther than `tolerance` from its sides.
fn drop_inner(points: &mut Vec<DVec2>, tolerance: f64) {
    /// Rounding error of distances, relative to the size.
    const ROUNDING: f64 = 1e-14;
    let extreme = EIGHT_WAYS.map(|direction| {
        let farther = |far: DVec2, point: &DVec2| {
            if point.dot(direction) > far.dot(direction) {
                *point
            } else {
                far
            }
        };
        points.iter().fold(points[0], farther)
    });
    let size = extreme.iter().map(|point| point.abs().max_element());
    let margin = tolerance + ROUNDING * size.fold(0.0, f64::max);
    let next = extreme.iter().cycle().skip(1);
    let sides = extreme.iter().zip(next).filter(|(from, to)| from != to);
    let sides = sides.map(|(from, to)| (*from, (to - from).normalize_or_zero()));
    let sides: Vec<_> = sides.collect();
    // Sides that are too long or too short for a direction do not close.
    if sides.iter().any(|(_, along)| *along == DVec2::ZERO) {
        return;
    }
    // An octagon without sides is a point, and has nothing inside. Coordinates that are not numbers are kept.
    let is_inner = |point: &DVec2| {
        let mut distances = (sides.iter()).map(|(from, along)| along.perp_dot(point - from));
        distances.all(|distance| distance > margin)
    };
    if !sides.is_empty() {
        points.retain(|point| !is_inner(point));
    }
}

/// Drops corners of a polygon that are no farther than `tolerance` from the sides that replace them.
pub(crate) fn thinned(corners: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let mut kept: Vec<DVec2> = Vec::with_capacity(corners.len());
    let mut first = 0;
    while first < corners.len() {
        kept.push(corners[first]);
        let start = corners[first];
        let skips = |next: &usize| {
            let end = corners[*next % corners.len()];
            let between = &corners[first + 1..*next];
            { between }
                .iter()
                .all(|corner| distance_to_segment(*corner, start, end) <= tolerance)
        };
        let next = (first + 2..=corners.len()).take_while(skips).last();
        first = next.unwrap_or(first + 1);
    }
    kept
}

/// Returns the number of the rightmost corner of a polygon.
pub(crate) fn rightmost(corners: &[DVec2]) -> usize {
    let order = |a: &usize, b: &usize| corners[*a].x.total_cmp(&corners[*b].x);
    (0..corners.len()).max_by(order).unwrap_or_default()
}

/// Returns the number of the corner of a convex polygon, counter-clockwise from the leftmost, that is farthest along a vector;
/// `right` is the rightmost corner.
pub(crate) fn farthest(corners: &[DVec2], right: usize, vector: DVec2) -> Option<usize> {
    let first = corners.first()?;
    // Along the lower and along the upper half, the distance increases up to one corner, then decreases.
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

/// Returns the Hausdorff distance of two convex polygons, each given counter-clockwise from the leftmost corner, the
/// lower one of two: the largest difference of their extents along a direction. Infinite if one of them is empty.
pub(crate) fn hausdorff_distance(a: &[DVec2], b: &[DVec2]) -> f64 {
    match (a, b) {
        ([], []) => return 0.0,
        ([], _) | (_, []) => return f64::INFINITY,
        ([a], [b]) => return a.distance(*b),
        _ => {}
    }
    // Both sequences of sides turn from downwards to downwards.
    let mut sides = [sides(a).peekable(), sides(b).peekable()];
    let (mut at, mut since) = ([0, 0], DVec2::NEG_X);
    let mut farthest: f64 = 0.0;
    loop {
        // Along the directions up to the next side's, both polygons are farthest in the same corners.
        let [own, others] = &mut sides;
        let next = match (own.peek(), others.peek()) {
            (Some(own), Some(other)) => usize::from(turns_before(*other, *own)),
            (own, _) => usize::from(own.is_none()),
        };
        let side = sides[next].next();
        let until = side.map_or(DVec2::NEG_X, |side| -side.perp().normalize_or_zero());
        let apart = a[at[0] % a.len()] - b[at[1] % b.len()];
        let is_between =
            |along: DVec2| since.perp_dot(along) >= 0.0 && along.perp_dot(until) >= 0.0;
        let ends = [since, until].map(|direction| apart.dot(direction).abs());
        farthest = farthest.max(ends[0]).max(ends[1]);
        if is_between(apart) || is_between(-apart) {
            farthest = farthest.max(apart.length());
        }
        if side.is_none() {
            return farthest;
        }
        at[next] += 1;
        since = until;
    }
}

/// Iterates over the sides of a polygon, if it has any.
fn sides(corners: &[DVec2]) -> impl Iterator<Item = DVec2> {
    let count = if corners.len() > 1 { corners.len() } else { 0 };
    (0..count).map(move |from| corners[(from + 1) % count] - corners[from])
}

/// Returns whether a side comes before another one in a polygon that begins at its leftmost corner.
fn turns_before(side: DVec2, other: DVec2) -> bool {
    let is_late = |side: DVec2| side.x < 0.0 || side.x == 0.0 && side.y < 0.0;
    match (is_late(side), is_late(other)) {
        (false, true) => true,
        (true, false) => false,
        _ => side.perp_dot(other) > 0.0,
    }
}

/// Returns the distance of a point to a convex polygon given counter-clockwise: 0 inside.
#[cfg(test)]
pub(crate) fn distance_to_hull(point: DVec2, corners: &[DVec2]) -> f64 {
    let sides = corners.iter().zip(corners.iter().cycle().skip(1));
    let (mut nearest, mut is_inside) = (f64::INFINITY, corners.len() > 2);
    for (&from, &to) in sides {
        is_inside &= (to - from).perp_dot(point - from) >= 0.0;
        nearest = nearest.min(distance_to_segment(point, from, to));
    }
    if is_inside { 0.0 } else { nearest }
}

/// Returns the distance of a point to a segment.
pub(crate) fn distance_to_segment(point: DVec2, from: DVec2, to: DVec2) -> f64 {
    let along = to - from;
    let square = along.length_squared();
    let at = if square > 0.0 {
        ((point - from).dot(along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    point.distance(from + at * along)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn points() -> impl Strategy<Value = Vec<DVec2>> {
        let coordinate = || prop_oneof![-1.0..1.0, (-2..3).prop_map(f64::from)];
        let point = (coordinate(), coordinate()).prop_map(|(x, y)| DVec2::new(x, y));
        prop::collection::vec(point, 1..12)
    }

    proptest! {
        /// Distances are largest in corners.
        #[test]
        fn hausdorff_distances_are_those_of_corners(a in points(), b in points(), apart in -3.0..3.0) {
            let moved = b.iter().map(|point| *point + DVec2::new(apart, 0.0));
            let [a, b] = [a, moved.collect()].map(|points| convex_hull(points, 0.0));
            let there = a.iter().map(|point| distance_to_hull(*point, &b));
            let back = b.iter().map(|point| distance_to_hull(*point, &a));
            let expected = there.chain(back).fold(0.0, f64::max);
            let found = hausdorff_distance(&a, &b);
            prop_assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
        }
    }

    /// Few points are not sorted out before; the hull of hulls is that of all.
    #[test]
    fn hulls_of_many_points_are_those_of_their_parts() {
        let point = |number: u32| {
            let place = DVec2::new(0.754_877_666, 0.569_840_291) * f64::from(number);
            (place - place.floor()) * DVec2::new(3.0, 1.0) + 1000.0
        };
        for count in [200, 1000, 5000] {
            let points: Vec<DVec2> = (0..count).map(point).collect();
            let mut parts = Vec::new();
            for part in points.chunks(MANY / 2) {
                parts.extend(convex_hull(part.to_vec(), 0.0));
                parts = convex_hull(parts, 0.0);
                assert!(parts.len() < MANY / 2);
            }
            assert_eq!(convex_hull(points, 0.0), parts);
        }
    }
}
