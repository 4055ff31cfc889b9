//! Convex hulls of points, and distances to polygons and segments.

use glam::DVec2;

/// Computes the corners of the convex hull of points, counter-clockwise from the leftmost (Andrew's monotone
/// chain, 1979).
///
/// A point within `tolerance` of its predecessor in the order of x is dropped, and so is a corner within
/// `tolerance` of the line through its neighbours.
pub(crate) fn convex_hull(mut points: Vec<DVec2>, tolerance: f64) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
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

/// Drops corners of a convex polygon that are no farther than `tolerance` from the sides that replace them.
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

/// Returns the distance of a point to a convex polygon given counter-clockwise: 0 inside.
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
