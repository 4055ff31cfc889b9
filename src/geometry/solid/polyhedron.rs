//! Convex hulls of points that do not lie in a plane.

#[cfg(test)]
mod tests;

use glam::{DVec2, DVec3};

use super::super::convex_hull;
use super::{HalfSpace, MAX_HULL_POINTS, ROUNDING};

/// Difference of normals, and of distances from the origin, up to which planes are one face.
const SAME_FACE: f64 = 1e-7;

/// Limit of the number of triples of points that are tried for the planes of a hull.
const MAX_TRIED: usize = 10_000;

/// Number of units of whole coordinates in a length of 1.
const UNITS: f64 = (1_u64 << 53) as f64;

/// A point in whole units, of which differences, and volumes of tetrahedra, are exact.
type Whole = [i64; 3];

/// Hull of points in the unit box around the origin that do not lie in a plane.
pub(super) struct Polyhedron {
    /// Half-spaces whose intersection it is.
    pub(super) faces: Vec<HalfSpace>,
    /// Corners, in the order of the points.
    pub(super) corners: Vec<DVec3>,
    pub(super) surface: f64,
    pub(super) volume: f64,
}

impl Polyhedron {
    /// Returns the hull of up to [`MAX_HULL_POINTS`] points; `None` if they lie in a plane.
    ///
    /// Its faces are planes through three points with no point beyond them, to within rounding; of planes that differ by
    /// rounding alone, that through the first points. Their order is that of the points.
    pub(super) fn of(points: &[DVec3]) -> Option<Self> {
        let facets = facets(&points.iter().map(whole).collect::<Vec<_>>());
        if facets.is_empty() {
            return None;
        }
        // Pyramids over the facets, by the divergence theorem.
        let sixths = facets.iter().map(|facet| {
            let [a, b, c] = facet.corners.map(|corner| points[corner]);
            a.dot(b.cross(c))
        });
        let mut hull = Self {
            faces: Vec::new(),
            corners: Vec::new(),
            surface: 0.0,
            volume: sixths.sum::<f64>().abs() / 6.0,
        };
        for triple in first_triples(points, facets) {
            let Some(normal) = across(points, triple) else {
                continue;
            };
            for normal in [normal, -normal] {
                let distance = normal.dot(points[triple[0]]);
                let is_known = |face: &HalfSpace| {
                    (face.distance - distance).abs() <= SAME_FACE
                        && face.normal.distance_squared(normal) <= SAME_FACE * SAME_FACE
                };
                let face = HalfSpace { normal, distance };
                if !holds(&face, points) || hull.faces.iter().any(is_known) {
                    continue;
                }
                hull.faces.push(face);
                hull.surface += face_area(points, normal, distance);
            }
        }
        // Other points lie on the surface or inside, and change no support function.
        let is_corner = |point: &&DVec3| {
            let on = { hull.faces.iter() }.filter(|face| is_on(face, point));
            on.count() >= 3
        };
        hull.corners = points.iter().filter(is_corner).copied().collect();
        Some(hull)
    }
}

/// Returns the unit normal of the plane through three points; `None` if they lie on a line.
fn across(points: &[DVec3], triple: [usize; 3]) -> Option<DVec3> {
    let [first, second, third] = triple.map(|point| points[point]);
    let normal = (second - first).cross(third - first);
    (normal.length() > ROUNDING).then(|| normal.normalize())
}

/// Returns whether no point lies beyond a plane.
fn holds(face: &HalfSpace, points: &[DVec3]) -> bool {
    let beyond = |point: &DVec3| face.normal.dot(*point) > face.distance + ROUNDING;
    !points.iter().any(beyond)
}

/// Returns whether a point lies in a plane.
fn is_on(face: &HalfSpace, point: &DVec3) -> bool {
    (face.normal.dot(*point) - face.distance).abs() <= ROUNDING
}

/// Returns triples of points in ascending order, among them the first one of every face. It is not that of a facet where
/// more than three points lie in the face's plane.
fn first_triples(points: &[DVec3], mut facets: Vec<Facet>) -> Vec<[usize; 3]> {
    const { assert!(MAX_HULL_POINTS <= u128::BITS) };
    // Large facets determine their planes best.
    let size = |facet: &Facet| facet.rounded.length_squared();
    facets.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let mut known: Vec<u128> = Vec::new();
    let mut triples: Vec<[usize; 3]> = Vec::new();
    let mut left = MAX_TRIED;
    for facet in &facets {
        let normal = facet.rounded.normalize();
        let plane = HalfSpace {
            normal,
            distance: normal.dot(points[facet.corners[0]]),
        };
        let is_in_plane = |at: &usize| facet.corners.contains(at) || is_on(&plane, &points[*at]);
        let on: Vec<usize> = (0..points.len()).filter(is_in_plane).collect();
        let set = on.iter().fold(0, |set, at| set | 1 << at);
        if known.contains(&set) {
            continue;
        }
        known.push(set);
        let is_alone = on.len() == 3;
        if is_alone || !add_first(points, &plane, &on, &mut left, &mut triples) {
            let mut own = facet.corners;
            own.sort_unstable();
            triples.push(own);
        }
    }
    triples.sort_unstable();
    triples.dedup();
    triples
}

/// Adds the first triple of some points whose plane is a given one and bounds all points, and those before it whose planes
/// bound all points too. `left` is the number of triples that may be tried. Returns whether there is one.
fn add_first(
    points: &[DVec3],
    plane: &HalfSpace,
    on: &[usize],
    left: &mut usize,
    triples: &mut Vec<[usize; 3]>,
) -> bool {
    for (number, &a) in on.iter().enumerate() {
        for (next, &b) in on.iter().enumerate().skip(number + 1) {
            for &c in &on[next + 1..] {
                if *left == 0 {
                    return false;
                }
                *left -= 1;
                let Some(normal) = across(points, [a, b, c]) else {
                    continue;
                };
                let normal = normal * normal.dot(plane.normal).signum();
                let distance = normal.dot(points[a]);
                if holds(&HalfSpace { normal, distance }, points) {
                    triples.push([a, b, c]);
                    if normal.distance(plane.normal) <= SAME_FACE {
                        return true;
                    }
                }
            }
        }
    }
    false
}

/// Returns a point of the unit box around the origin in whole units.
fn whole(point: &DVec3) -> Whole {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "coordinates are at most 1/2, and what is no number is 0"
    )]
    let whole = |value: f64| (value * UNITS).round() as i64;
    point.to_array().map(whole)
}

/// Triangle on the surface of a hull.
struct Facet {
    /// Numbers of its corners, counter-clockwise from outside.
    corners: [usize; 3],
    /// Vector across it, outwards, of twice its area.
    normal: [i128; 3],
    /// This vector, rounded.
    rounded: DVec3,
    /// Largest error of products with it.
    error: f64,
}

impl Facet {
    fn new(points: &[Whole], corners: [usize; 3]) -> Self {
        let [first, second, third] = corners.map(|corner| points[corner]);
        let normal = cross(away(second, first), away(third, first));
        let rounded = DVec3::from_array(normal.map(|value| value as f64));
        Self {
            corners,
            normal,
            rounded,
            // A sum of three products with differences of up to 2⁵³ has an error of about four units of 2⁻⁵³.
            error: 8.0 * rounded.abs().element_sum(),
        }
    }

    /// Returns 1 for a point in front of the facet, −1 for one behind it, and 0 for one in its plane.
    fn side(&self, points: &[Whole], point: usize) -> i32 {
        let away = away(points[point], points[self.corners[0]]);
        let rounded = self
            .rounded
            .dot(DVec3::from_array(away.map(|it| it as f64)));
        if rounded.abs() > self.error {
            return if rounded > 0.0 { 1 } else { -1 };
        }
        // The product may have 162 bits: sums of the lower and the upper halves fit in 128.
        const HALF: u32 = 64;
        let (mut low, mut high) = (0, 0);
        for (normal, away) in self.normal.iter().zip(away) {
            low += (normal & i128::from(u64::MAX)) * i128::from(away);
            high += (normal >> HALF) * i128::from(away);
        }
        let high: i128 = high + (low >> HALF);
        let rest: i128 = low & i128::from(u64::MAX);
        match high.signum() {
            0 => i32::from(rest > 0),
            1 => 1,
            _ => -1,
        }
    }

    /// Returns the sides, from corner to corner.
    fn sides(&self) -> [[usize; 2]; 3] {
        let [a, b, c] = self.corners;
        [[a, b], [b, c], [c, a]]
    }
}

fn away(point: Whole, from: Whole) -> Whole {
    std::array::from_fn(|axis| point[axis] - from[axis])
}

fn cross(a: Whole, b: Whole) -> [i128; 3] {
    let [[ax, ay, az], [bx, by, bz]] = [a, b].map(|it| it.map(i128::from));
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

/// Returns triangles that make up the surface of the convex hull of points, which is enlarged by one point after the other
/// (Clarkson & Shor 1989). A point that lies in the plane of a triangle does not see it. Empty if all points lie in a plane.
fn facets(points: &[Whole]) -> Vec<Facet> {
    let Some(mut facets) = tetrahedron(points) else {
        return Vec::new();
    };
    // The last point that saw the facet at a side.
    let mut seen_by = vec![usize::MAX; points.len() * points.len()];
    let side_of = |[from, to]: [usize; 2]| from * points.len() + to;
    let mut horizon = Vec::new();
    // In their order along a curve, each point would take the place of many facets: multiples of a prime are scattered.
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by_key(|point| point * 37 % 101);
    for point in order {
        let mut seen: Vec<Facet> = Vec::new();
        seen.extend(facets.extract_if(.., |facet| facet.side(points, point) > 0));
        for side in seen.iter().flat_map(Facet::sides) {
            seen_by[side_of(side)] = point;
        }
        let sides = seen.iter().flat_map(Facet::sides);
        // Beyond it lies a facet that the point does not see.
        horizon.extend(sides.filter(|&[from, to]| seen_by[side_of([to, from])] != point));
        let new = { horizon.drain(..) }.map(|[from, to]| Facet::new(points, [from, to, point]));
        facets.extend(new);
    }
    facets
}

/// Returns the faces of a tetrahedron between points; `None` if all lie in a plane.
fn tetrahedron(points: &[Whole]) -> Option<Vec<Facet>> {
    let numbers = || 0..points.len();
    let second = numbers().find(|&it| points[it] != points[0])?;
    let third = numbers().find(|&it| Facet::new(points, [0, second, it]).normal != [0; 3])?;
    let base = Facet::new(points, [0, second, third]);
    let top = numbers().find(|&it| base.side(points, it) != 0)?;
    let [a, b, c] = match base.side(points, top) {
        1 => [0, third, second],
        _ => [0, second, third],
    };
    let faces = [[a, b, c], [b, a, top], [c, b, top], [a, c, top]];
    Some(faces.map(|face| Facet::new(points, face)).into())
}

/// Returns the corners of a face of the convex hull of points: their indices, counter-clockwise from outside.
pub(super) fn face(points: &[DVec3], normal: DVec3, distance: f64) -> Vec<usize> {
    let (right, up) = normal.any_orthonormal_pair();
    let flat = |index: &usize| DVec2::new(points[*index].dot(right), points[*index].dot(up));
    let on =
        (0..points.len()).filter(|&index| (normal.dot(points[index]) - distance).abs() <= ROUNDING);
    let on: Vec<usize> = on.collect();
    let around = convex_hull(on.iter().map(flat).collect(), 0.0);
    let index = |corner: &DVec2| on.iter().copied().find(|index| flat(index) == *corner);
    around.iter().filter_map(index).collect()
}

/// Returns the area of a face of the convex hull of points.
fn face_area(points: &[DVec3], normal: DVec3, distance: f64) -> f64 {
    let around = face(points, normal, distance);
    let turned = around.iter().skip(1).chain(around.first());
    let twice = around
        .iter()
        .zip(turned)
        .map(|(&from, &to)| points[from].cross(points[to]).dot(normal));
    twice.sum::<f64>().abs() / 2.0
}
