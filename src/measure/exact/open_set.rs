//! The open set condition for systems that are not of finite type: the interior of the convex hulls as an
//! open set, and copies that are disjoint.
//!
//! If the hulls of copies overlap in their boundaries only, the open set condition holds for arbitrary ratios
//! and rotations (Moran 1946, Hutchinson 1981).

use glam::{DAffine3, DVec2, DVec3};

use super::Effort;
use super::balls::Balls;
use super::hull::Flat;
use super::system::ratio;
use crate::geometry::convex_hull;

/// Maximum number of rounds in which hulls grow, and of corners of a hull.
const MAX_ROUNDS: usize = 600;
const MAX_CORNERS: usize = 500;

/// Maximum number of points whose hulls are computed, in all rounds, and of corners that are compared with sides.
const MAX_POINTS: usize = 50_000_000;
const MAX_COMPARED: usize = 100_000_000;

/// Distance, in a system of size 1, up to which a point counts as on a side of the hull.
const STILL: f64 = 1e-13;

/// Least cost of the comparison of two hulls.
const LEAST: usize = 4;

/// Cost of a hull beside that of its points.
const OVERHEAD: usize = 64;

/// Overlap, in a system of size 1, up to which hulls count as touching.
const SLACK: f64 = 1e-10;

/// Returns `true` if the interior of the convex hulls is a feasible open set: the hulls of the copies in each
/// set overlap in sides only. Returns `false` otherwise, or if there are too many copies or corners.
pub(super) fn hulls_are_open_sets(flat: &Flat, effort: Effort) -> bool {
    if flat.dimension == 0 || flat.dimension > 2 {
        return false;
    }
    let most = effort.of(MAX_COMPARED);
    if pairs(flat) > most / LEAST {
        return false;
    }
    let Some(hulls) = hulls(flat, effort) else {
        return false;
    };
    let mut sets: Vec<Vec<Vec<DVec2>>> = vec![Vec::new(); flat.size];
    for copy in &flat.copies {
        sets[copy.from].push(moved(&copy.map, &hulls[copy.to]));
    }
    let mut compared = 0;
    let in_one_set = sets.iter().flat_map(|copies| {
        let numbered = copies.iter().enumerate();
        numbered.flat_map(|(number, a)| copies[..number].iter().map(move |b| (a, b)))
    });
    { in_one_set }.all(|(a, b)| {
        let corners = a.len() + b.len();
        compared += (corners * corners).max(LEAST);
        compared <= most && separated(a, b)
    })
}

/// Returns the number of pairs of copies in the same set.
fn pairs(flat: &Flat) -> usize {
    let mut copies = vec![0_usize; flat.size];
    flat.copies.iter().for_each(|copy| copies[copy.from] += 1);
    let pairs = copies
        .iter()
        .map(|count| count * count.saturating_sub(1) / 2);
    pairs.sum()
}

fn moved(map: &DAffine3, points: &[DVec2]) -> Vec<DVec2> {
    let image = |point: &DVec2| map.transform_point3(point.extend(0.0)).truncate();
    points.iter().map(image).collect()
}

/// Computes the corners of every set's convex hull, counter-clockwise.
fn hulls(flat: &Flat, effort: Effort) -> Option<Vec<Vec<DVec2>>> {
    let mut hulls = vec![vec![DVec2::ZERO]; flat.size];
    let mut left = effort.of(MAX_POINTS);
    for _ in 0..MAX_ROUNDS {
        let moved_points = flat.copies.iter().map(|copy| hulls[copy.to].len());
        left = left.checked_sub(moved_points.sum::<usize>() + OVERHEAD * flat.size)?;
        let mut points: Vec<Vec<DVec2>> = hulls.clone();
        for copy in &flat.copies {
            points[copy.from].extend(moved(&copy.map, &hulls[copy.to]));
        }
        let next: Vec<Vec<DVec2>> = points
            .into_iter()
            .map(|points| convex_hull(points, STILL))
            .collect();
        if next
            .iter()
            .any(|corners| corners.len() > effort.of(MAX_CORNERS))
        {
            return None;
        }
        let still = next.iter().zip(&hulls).all(|(next, hull)| {
            let near = |a: &DVec2| hull.iter().any(|b| a.distance(*b) < STILL);
            next.len() == hull.len() && next.iter().all(near)
        });
        hulls = next;
        if still {
            return Some(hulls);
        }
    }
    None
}

/// Returns `true` if a line along a side of one of two convex polygons separates them.
fn separated(a: &[DVec2], b: &[DVec2]) -> bool {
    let sides = |corners: &[DVec2]| -> Vec<DVec2> {
        let next = corners.iter().cycle().skip(1);
        let sides = corners.iter().zip(next);
        sides
            .map(|(from, to)| (to - from).normalize_or_zero())
            .collect()
    };
    let apart = |axis: DVec2| {
        let range = |corners: &[DVec2]| {
            let along = corners.iter().map(|corner| corner.dot(axis));
            along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
                (low.min(at), high.max(at))
            })
        };
        let ((a_low, a_high), (b_low, b_high)) = (range(a), range(b));
        a_high <= b_low + SLACK || b_high <= a_low + SLACK
    };
    let sides: Vec<DVec2> = sides(a).into_iter().chain(sides(b)).collect();
    let flat = sides
        .iter()
        .all(|side| side.perp_dot(sides[0]).abs() < SLACK);
    // Intervals of a line are separated along it, or touch.
    if flat {
        return apart(sides[0]);
    }
    sides.into_iter().any(|side| apart(side.perp()))
}

/// Maximum number of pairs that are divided, and of pairs whose balls are compared.
const MAX_PAIRS: usize = 30_000;
const MAX_BALLS: usize = 20_000_000;

/// Size, in a system of size 1, from which pieces that are not separated are taken to touch.
const TOUCH: f64 = 1e-7;

/// A piece of a set, in a ball.
#[derive(Clone, Copy)]
struct Piece {
    set: usize,
    map: DAffine3,
    centre: DVec3,
    radius: f64,
}

impl Piece {
    /// Returns the distance of the balls of two pieces; negative where they meet.
    fn gap(&self, other: &Self) -> f64 {
        self.centre.distance(other.centre) - (self.radius + other.radius) * (1.0 + 1e-9)
    }
}

/// Returns `true` if no two copies in a set have a point in common: the larger piece of a pair is divided
/// until the balls around pieces are disjoint. Returns `false` where pieces are closer than numbers resolve,
/// or where the search is given up.
pub(super) fn copies_are_apart(flat: &Flat, effort: Effort) -> bool {
    let mut balls_left = effort.of(MAX_BALLS);
    match balls_left.checked_sub(pairs(flat)) {
        Some(left) => balls_left = left,
        None => return false,
    }
    let mut copies = vec![Vec::new(); flat.size];
    for copy in &flat.copies {
        copies[copy.from].push((copy.to, copy.map));
    }
    let balls = Balls::of(copies.clone());
    let piece = |set: usize, map: DAffine3| Piece {
        set,
        map,
        centre: map.transform_point3(balls.centres[set]),
        radius: ratio(map.matrix3) * balls.radii[set],
    };
    let mut open = Vec::new();
    for copies in &copies {
        let pieces: Vec<Piece> = copies.iter().map(|(set, map)| piece(*set, *map)).collect();
        for (number, a) in pieces.iter().enumerate() {
            let pairs = pieces[..number].iter().map(|b| (*a, *b));
            open.extend(pairs.filter(|(a, b)| a.gap(b) <= 0.0));
            // All of them would be examined.
            if open.len() > effort.of(MAX_PAIRS) {
                return false;
            }
        }
    }
    let mut seen = 0;
    while let Some((a, b)) = open.pop() {
        seen += 1;
        let (larger, smaller) = if a.radius >= b.radius { (a, b) } else { (b, a) };
        let inner = &copies[larger.set];
        if seen > effort.of(MAX_PAIRS) || larger.radius < TOUCH || balls_left < inner.len() {
            return false;
        }
        balls_left -= inner.len();
        let pairs = inner
            .iter()
            .map(|(to, map)| (piece(*to, larger.map * *map), smaller));
        let mut pairs: Vec<_> = pairs.filter(|(a, b)| a.gap(b) <= 0.0).collect();
        // The nearest pair is examined first.
        pairs.sort_by(|(a, b), (c, d)| c.gap(d).total_cmp(&a.gap(b)));
        open.extend(pairs);
    }
    true
}
