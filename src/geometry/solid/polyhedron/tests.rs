//! Comparison of hulls with those of all triples of points, and with the laws of polyhedra.

use std::f64::consts::{PI, TAU};

use glam::DQuat;

use super::*;

/// Returns the faces of a hull by definition: all planes through three points with no point beyond them.
fn by_triples(points: &[DVec3]) -> Vec<HalfSpace> {
    let mut faces: Vec<HalfSpace> = Vec::new();
    for a in 0..points.len() {
        for b in a + 1..points.len() {
            for c in b + 1..points.len() {
                let Some(normal) = across(points, [a, b, c]) else {
                    continue;
                };
                for normal in [normal, -normal] {
                    let distance = normal.dot(points[a]);
                    let face = HalfSpace { normal, distance };
                    let is_known = |known: &HalfSpace| {
                        known.normal.distance(normal) <= 1e-7
                            && (known.distance - distance).abs() <= 1e-7
                    };
                    if holds(&face, points) && !faces.iter().any(is_known) {
                        faces.push(face);
                    }
                }
            }
        }
    }
    faces
}

/// Numbers that look random (Marsaglia 2003).
struct Random(u64);

impl Random {
    /// Returns a number from −1 to 1.
    fn signed(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 * 2f64.powi(-52) - 1.0
    }

    /// Returns a whole number below another.
    #[expect(clippy::cast_possible_truncation, reason = "the numbers are small")]
    fn below(&mut self, most: usize) -> usize {
        ((self.signed() + 1.0) / 2.0 * most as f64) as usize
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| self.signed()))
    }

    /// Returns about `count` points of a kind: at random or on a sphere, a grid, prisms, a moment curve, Platonic solids,
    /// faces and edges of a cube, and combinations of other points.
    fn points(&mut self, kind: usize, count: usize) -> Vec<DVec3> {
        let around = |at: usize, of: usize, height: f64| {
            let angle = TAU * at as f64 / of as f64;
            DVec3::new(libm::cos(angle), libm::sin(angle), height)
        };
        let sides = (count / 2).max(3);
        let all = 0..count;
        match kind {
            0 => all.map(|_| self.vector()).collect(),
            1 => all.map(|_| self.vector().normalize()).collect(),
            2 => all
                .map(|_| DVec3::from_array([3, 4, 3].map(|most| self.below(most) as f64)))
                .collect(),
            3 => (0..2 * sides)
                .map(|at| around(at / 2, sides, (at % 2) as f64))
                .collect(),
            4 => (0..2 * sides)
                .map(|at| around(at, 2 * sides, (at % 2) as f64))
                .collect(),
            5 => all
                .map(|at| at as f64 / count as f64)
                .map(|t| DVec3::new(t, t * t, t * t * t))
                .collect(),
            6 => {
                // An icosahedron and a dodecahedron, between the tips of each of which the other's lie.
                let phi = f64::midpoint(1.0, 5f64.sqrt());
                let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
                let rectangle = |a: f64, b: f64| {
                    signs.into_iter().flat_map(move |[s, t]| {
                        let (a, b) = (s * a, t * b);
                        [[0.0, a, b], [b, 0.0, a], [a, b, 0.0]].map(DVec3::from_array)
                    })
                };
                let cube = signs.map(|[s, t]| [DVec3::new(s, t, 1.0), DVec3::new(s, t, -1.0)]);
                let own = rectangle(1.0, phi).chain(rectangle(1.0 / phi, phi));
                own.chain(cube.concat()).collect()
            }
            7 => all
                .map(|at| {
                    let mut on = self.vector();
                    on[at % 3] = self.signed().signum();
                    on
                })
                .collect(),
            8 => all
                .map(|at| {
                    let mut on = self.vector().signum();
                    on[at % 3] = self.below(4) as f64 / 1.5 - 1.0;
                    on
                })
                .collect(),
            _ => {
                let mut points: Vec<DVec3> = (0..sides + 1).map(|_| self.vector()).collect();
                for _ in 0..sides {
                    let [a, b, c] = [(); 3].map(|()| points[self.below(sides + 1)]);
                    points.push(f64::midpoint(self.signed(), 1.0) * (a - b) + b);
                    points.push((a + b + c) / 3.0);
                }
                points
            }
        }
    }

    /// Returns points in the unit box around the origin: turned, stretched and shuffled, some of them twice.
    fn set(&mut self, kind: usize, count: usize) -> Vec<DVec3> {
        let mut points = self.points(kind, count);
        for _ in 0..self.below(3) {
            let again = points[self.below(points.len())];
            points.push(again);
        }
        if self.signed() < 0.3 {
            let axis = (self.vector() + DVec3::splat(1.1)).normalize();
            let turn = DQuat::from_axis_angle(axis, self.signed() * PI);
            let stretch = DVec3::new(1.0, 0.05 + self.signed().abs(), 5.0);
            let shift = self.vector() * 9.0;
            { points.iter_mut() }.for_each(|point| *point = turn * (*point * stretch) + shift);
        }
        if self.signed() < 0.0 {
            for at in (1..points.len()).rev() {
                points.swap(at, self.below(at + 1));
            }
        }
        points.truncate(MAX_HULL_POINTS as usize);
        let (min, max) = { points.iter() }
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(min, max), it| {
                (min.min(*it), max.max(*it))
            });
        let size = (max - min).max_element();
        let middle = min + (max - min) / 2.0;
        points.iter().map(|point| (point - middle) / size).collect()
    }
}

const KINDS: usize = 10;

#[test]
fn hulls_are_those_of_all_triples() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut solids = [0; KINDS];
    for number in 0..4000 {
        let kind = number % KINDS;
        let count = 4 + random.below(if number % 20 < KINDS { 10 } else { 30 });
        let mut points = random.set(kind, count);
        if number % 3 == 0 {
            let noise = [1e-16, 1e-13, 1e-12][number / 3 % 3];
            { points.iter_mut() }.for_each(|point| *point += random.vector() * noise);
        }
        let Some(hull) = Polyhedron::of(&points) else {
            continue;
        };
        solids[kind] += 1;
        assert_eq!(hull.faces, by_triples(&points), "{kind}: {points:?}");
    }
    assert!(solids.iter().all(|count| *count > 300), "{solids:?}");
}

#[test]
fn hulls_of_many_points_are_polyhedra() {
    let mut random = Random(0xD1B5_4A32_D192_ED03);
    for number in 0..30 * KINDS {
        let count = 40 + random.below(61);
        let points = random.set(number % KINDS, count);
        let hull = Polyhedron::of(&points).unwrap();
        let mut corners: Vec<DVec3> = Vec::new();
        // Points that are listed twice are both corners.
        for corner in &hull.corners {
            if corners.iter().all(|known| known.distance(*corner) > 1e-9) {
                corners.push(*corner);
            }
        }
        let mut sides = 0;
        let mut volume = 0.0;
        for plane in &hull.faces {
            assert!(holds(plane, &points));
            let around = face(&corners, plane.normal, plane.distance);
            assert!(around.len() >= 3, "{number}: {around:?}");
            sides += around.len();
            volume += face_area(&corners, plane.normal, plane.distance) * plane.distance / 3.0;
        }
        assert_eq!(
            2 * (corners.len() + hull.faces.len()),
            sides + 4,
            "{number}"
        );
        assert!((hull.volume - volume).abs() < 1e-9, "{number}");
    }
}

/// All points are corners, so that there are as many facets as there can be.
#[test]
fn hulls_of_a_hundred_points_take_little() {
    let on_curve = |at: u32| f64::from(at) / 100.0 - 0.5;
    let points: Vec<DVec3> = { (0..100).map(on_curve) }
        .map(|t| DVec3::new(t, 2.0 * t * t, 4.0 * t * t * t))
        .collect();
    let started = std::time::Instant::now();
    for _ in 0..100 {
        let hull = Polyhedron::of(&points).unwrap();
        assert_eq!((hull.faces.len(), hull.corners.len()), (196, 100));
    }
    let taken = started.elapsed().as_secs_f64();
    assert!(taken < 2.0, "{taken} s");
}

#[test]
fn points_in_a_plane_have_no_polyhedron() {
    let flat: Vec<DVec3> = { (0..20_i32).map(f64::from) }
        .map(|at| DVec3::new(at / 40.0, at * at / 1000.0, 0.25))
        .collect();
    assert!(Polyhedron::of(&flat).is_none());
    assert!(Polyhedron::of(&[DVec3::ZERO; 4]).is_none());
}
