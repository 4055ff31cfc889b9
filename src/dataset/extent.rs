//! Boxes of the attractors of a few maps, in microseconds.

use std::collections::BinaryHeap;

use crate::geometry::{Bounds, Linear, Point};
use crate::priority::Keyed;

use super::maps::Drawable;

/// Largest number of rows of maps that are examined for a side of the box.
const MAX_WORK: usize = 1 << 11;

/// Largest number of rounds in which the bounds of all directions are lowered.
const MAX_ROUNDS: usize = 256;

/// Largest distance by which a side lies outside, as a fraction of half of the longest side.
const TOLERANCE: f64 = 1e-5;

/// Rounding error of coordinates, relative to their size.
const ROUNDING: f64 = 1e-14;

/// Returns the bounding box of the attractor of affine maps, each of which contracts in the Euclidean norm; `None` if one
/// does not, or contracts so little that the search takes too long. The box lies in coordinates to which `seen` rotates.
///
/// Each side is found by branch and bound: the maximum of a linear functional over the attractor is that over its images, whose
/// maxima are bounded by [directions](Directions). All points of the attractor lie in the box, whose sides are exact to 10⁻⁵ of
/// half of the longest one.
pub(super) fn attractor_box<M: Drawable>(maps: &[M], seen: &M::Linear) -> Option<Bounds<M::Point>> {
    let directions = Directions::of(maps)?;
    let sides = M::Point::AXES.iter();
    let sides: Vec<M::Point> = sides.map(|axis| seen.transposed(*axis)).collect();
    let half = sides.chunks_exact(2).map(|opposite| {
        let [high, low] = [opposite[0], opposite[1]].map(|side| directions.least(side));
        f64::midpoint(high, low)
    });
    let half = half.fold(0.0, f64::max);
    let tolerance = TOLERANCE * half + ROUNDING * (directions.centre.length() + half);
    let mut corners = [M::Point::ZERO; 2];
    for (number, (axis, side)) in M::Point::AXES.iter().zip(sides).enumerate() {
        let farthest = farthest(maps, &directions, side, tolerance)?;
        let corner = &mut corners[(number + 1) % 2];
        *corner = *corner + *axis * farthest;
    }
    let [min, max] = corners;
    Some(Bounds::new(min, max))
}

/// Returns the maximum of a functional over the attractor, or more by no more than a tolerance.
fn farthest<M: Drawable>(
    maps: &[M],
    directions: &Directions<M::Point>,
    direction: M::Point,
    tolerance: f64,
) -> Option<f64> {
    let node = |vector: M::Point, offset: f64, outer: f64| Keyed {
        key: outer.min(offset + directions.most(vector)),
        item: (vector, offset),
    };
    let mut heap = BinaryHeap::from([node(direction, 0.0, f64::INFINITY)]);
    let mut found = f64::NEG_INFINITY;
    // Bound of the rows of maps that are not worth a further look.
    let mut left = f64::NEG_INFINITY;
    for _ in 0..MAX_WORK {
        let Some(Keyed {
            key,
            item: (vector, offset),
        }) = heap.pop()
        else {
            return Some(left);
        };
        found = found.max(offset + directions.least(vector));
        if key <= found + tolerance {
            return Some(key.max(left));
        }
        for map in maps {
            let inner = map.linear().transposed(vector);
            let node = node(inner, offset + vector.dot(map.translation()), key);
            if node.key > found + tolerance {
                heap.push(node);
            } else {
                left = left.max(node.key);
            }
        }
    }
    None
}

/// Number of vectors of space whose coordinates are −2, −1, 0, 1 or 2.
const VECTORS: usize = 125;

/// Number of the zero vector among them.
const ZERO: usize = VECTORS / 2;

/// Lengths of the coordinates of the vectors that are used, in falling order.
const USED: [[f64; 3]; 6] = [
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [1.0, 1.0, 1.0],
    [2.0, 1.0, 0.0],
    [2.0, 1.0, 1.0],
    [2.0, 2.0, 1.0],
];

/// Bounds of the maxima of functionals over an attractor: for 16 vectors of the plane or 98 of space, and for all others by the
/// parts of which they are sums.
struct Directions<P> {
    /// Middle and radius of a ball that contains the attractor.
    centre: P,
    radius: f64,
    /// Upper bounds for the vectors.
    most: [f64; VECTORS],
    /// Points of the attractor that reach far along the vectors.
    points: [P; VECTORS],
}

/// Contribution of a map to the maximum along a vector.
struct Step<M> {
    map: M,
    shift: f64,
    parts: [(usize, f64); 3],
    /// Bound by the ball around the attractor.
    most: f64,
}

impl<P: Point> Directions<P> {
    /// Lowers bounds from a ball that all maps take into itself: the maximum along a vector is that over the images.
    fn of<M: Drawable<Point = P>>(maps: &[M]) -> Option<Self> {
        let factors = || maps.iter().map(M::largest_factor);
        if !factors().all(|factor| factor < 1.0) {
            return None;
        }
        #[expect(clippy::cast_precision_loss, reason = "there are few maps")]
        let count = maps.len() as f64;
        let fixed = maps.iter().map(M::fixed);
        let centre = fixed.fold(P::ZERO, |sum, point| sum + point) / count;
        let reaches = maps.iter().zip(factors());
        let reaches =
            reaches.map(|(map, factor)| (map.apply(centre) - centre).length() / (1.0 - factor));
        let radius = reaches.fold(0.0, f64::max);
        if !radius.is_finite() {
            return None;
        }
        let mut found = Self {
            centre,
            radius,
            most: [0.0; VECTORS],
            points: [maps.first()?.fixed(); VECTORS],
        };
        let vectors = (0..VECTORS).map(|number| (number, coordinates(number)));
        let vectors = vectors.filter(|(_, it)| is_used(*it, P::DIMENSION));
        let vectors: Vec<_> = vectors
            .map(|(number, it)| (number, P::of_coordinates(it)))
            .collect();
        for (number, vector) in &vectors {
            found.most[*number] = found.in_ball(*vector);
        }
        let steps = vectors.iter().map(|(_, vector)| {
            let steps = maps.iter().map(|map| {
                let inner = map.linear().transposed(*vector);
                let shift = vector.dot(map.translation());
                Step {
                    map: *map,
                    shift,
                    parts: parts(inner),
                    most: shift + found.in_ball(inner),
                }
            });
            steps.collect()
        });
        let steps: Vec<Vec<Step<M>>> = steps.collect();
        for _ in 0..MAX_ROUNDS {
            let (mut change, mut size): (f64, f64) = (0.0, 0.0);
            for ((number, vector), steps) in vectors.iter().zip(&steps) {
                change = change.max(found.lower(*number, *vector, steps));
                size = size.max(found.most[*number] - vector.dot(centre));
            }
            if change <= TOLERANCE * size {
                break;
            }
        }
        Some(found)
    }

    /// Lowers the bound of a vector; returns the difference.
    fn lower<M: Drawable<Point = P>>(
        &mut self,
        number: usize,
        vector: P,
        steps: &[Step<M>],
    ) -> f64 {
        let before = self.most[number];
        let mut highest = f64::NEG_INFINITY;
        let mut least = vector.dot(self.points[number]);
        for Step {
            map,
            shift,
            parts,
            most,
        } in steps
        {
            let inner = parts.iter().map(|(part, weight)| weight * self.most[*part]);
            highest = highest.max(most.min(shift + inner.sum::<f64>()));
            for (part, _) in parts.iter().filter(|(_, weight)| *weight > 0.0) {
                let point = map.apply(self.points[*part]);
                if vector.dot(point) > least {
                    (self.points[number], least) = (point, vector.dot(point));
                }
            }
        }
        self.most[number] = before.min(highest);
        before - self.most[number]
    }

    /// Returns the maximum along a vector over the ball around the attractor.
    fn in_ball(&self, vector: P) -> f64 {
        vector.dot(self.centre) + vector.length() * self.radius
    }

    /// Returns an upper bound of the maximum along a vector: no more than the sum of those of its parts.
    fn most(&self, vector: P) -> f64 {
        let parts = parts(vector).into_iter();
        let sum: f64 = parts.map(|(part, weight)| weight * self.most[part]).sum();
        sum.min(self.in_ball(vector))
    }

    /// Returns a lower bound of the maximum along a vector.
    fn least(&self, vector: P) -> f64 {
        let points = parts(vector).map(|(part, _)| vector.dot(self.points[part]));
        points.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Factors of the digits of the numbers of vectors.
const PLACES: [usize; 3] = [1, 5, 25];

/// Returns the vector of a number, whose digits to base 5 are its coordinates plus 2.
fn coordinates(number: usize) -> [f64; 3] {
    const DIGITS: [f64; 5] = [-2.0, -1.0, 0.0, 1.0, 2.0];
    PLACES.map(|place| DIGITS[number / place % 5])
}

/// Returns whether a vector is one of those with bounds.
fn is_used(vector: [f64; 3], dimension: usize) -> bool {
    let mut lengths = vector.map(f64::abs);
    lengths.sort_by(|a, b| b.total_cmp(a));
    USED.contains(&lengths) && (dimension == 3 || vector[2] == 0.0)
}

/// Divides a vector into multiples of three vectors with bounds: returns their numbers, with the factors, which are not
/// negative.
///
/// With the axes in the order of the coordinates' lengths and with their signs, it is a sum of multiples of (1, 0, 0), (1, 1, 0)
/// and (1, 1, 1), and closer to it, of two of their sums and one of them, or of their three sums.
fn parts(vector: impl Point) -> [(usize, f64); 3] {
    let coordinates = vector.coordinates();
    let mut axes = [0, 1, 2].map(|axis| (coordinates[axis].abs(), axis));
    for [a, b] in [[0, 1], [1, 2], [0, 1]] {
        if axes[a].0 < axes[b].0 {
            axes.swap(a, b);
        }
    }
    let lengths = axes.map(|(length, _)| length);
    let [a, b, c] = [lengths[0] - lengths[1], lengths[1] - lengths[2], lengths[2]];
    // Numbers count the zero vector as their origin.
    let number = |multiples: [usize; 3]| {
        axes.iter()
            .zip(multiples)
            .fold(ZERO, |number, ((_, axis), multiple)| {
                if coordinates[*axis] < 0.0 {
                    number - multiple * PLACES[*axis]
                } else {
                    number + multiple * PLACES[*axis]
                }
            })
    };
    let (ab, ac, bc) = ([2, 1, 0], [2, 1, 1], [2, 2, 1]);
    let parts = if a >= b + c {
        [([1, 0, 0], a - b - c), (ab, b), (ac, c)]
    } else if b >= a + c {
        [([1, 1, 0], b - a - c), (ab, a), (bc, c)]
    } else if c >= a + b {
        [([1, 1, 1], c - a - b), (ac, a), (bc, b)]
    } else {
        let half = |both: f64, other: f64| (both - other) / 2.0;
        [
            (ab, half(a + b, c)),
            (ac, half(a + c, b)),
            (bc, half(b + c, a)),
        ]
    };
    parts.map(|(multiples, factor)| (number(multiples), factor))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fractal;
    use crate::dataset::random::{anderson, below};
    use crate::geometry::{DAffine2, DAffine3, DMat2, DMat3, DVec3};
    use crate::random::Pcg;

    #[test]
    fn boxes_are_those_of_the_graph() {
        let mut random = Pcg::new(5, 6);
        let mut found = 0;
        for round in 0..62 {
            // The graph divides directions into sectors where it has many maps.
            let count = if round < 60 { 2 + round % 6 } else { 80 };
            let maps = anderson(&mut random, count);
            let Some(own) = attractor_box(&maps, &DMat2::IDENTITY) else {
                continue;
            };
            found += 1;
            let entry = |map: &DAffine2| {
                let [a, c, b, d, e, f] = map.to_cols_array();
                format!("\n  - {{matrix: [[{a}, {b}], [{c}, {d}]], shift: [{e}, {f}]}}")
            };
            let text: String = maps.iter().map(entry).collect();
            let system = Fractal::parse(&format!("kind: ifs\nmaps:{text}")).unwrap();
            let [min, max] = system.info().unwrap().limit_bounds.unwrap();
            let size = own.size().max_element();
            let apart = [own.min().x - min[0], own.min().y - min[1]];
            let sides = apart
                .into_iter()
                .chain([own.max().x - max[0], own.max().y - max[1]]);
            for side in sides {
                assert!(side.abs() < 1e-5 * size, "{own:?} {min:?} {max:?}");
            }
        }
        assert!(found >= 45, "{found}");
    }

    #[test]
    fn vectors_are_sums_of_their_parts() {
        let mut random = Pcg::new(1, 2);
        for round in 0..100 {
            let mut coordinate = || f64::from(below(&mut random, 7)) - 3.0;
            let z = if round % 2 == 0 { 0.0 } else { coordinate() };
            let whole = DVec3::new(coordinate(), coordinate(), z);
            let parts = parts(whole);
            assert!(parts.iter().all(|(_, factor)| *factor >= 0.0));
            for (number, _) in parts.iter().filter(|(_, factor)| *factor > 0.0) {
                assert!(is_used(coordinates(*number), 3));
            }
            let sum = parts.map(|(number, factor)| DVec3::from_array(coordinates(number)) * factor);
            assert_eq!(sum.into_iter().sum::<DVec3>(), whole);
        }
    }

    /// A set of the plane that moves along z has its own box, and along z that of a Cantor set.
    #[test]
    fn boxes_of_space_are_those_of_their_planes() {
        let mut random = Pcg::new(3, 4);
        let mut found = 0;
        for round in 0..30 {
            let maps = anderson(&mut random, 2 + round % 4);
            let Some(plane) = attractor_box(&maps, &DMat2::IDENTITY) else {
                continue;
            };
            let lifted = maps.iter().zip(1_u32..).map(|(map, number)| {
                let [x, y] = [map.matrix2.x_axis, map.matrix2.y_axis].map(|it| it.extend(0.0));
                DAffine3 {
                    matrix3: DMat3::from_cols(x, y, DVec3::Z / 2.0),
                    translation: map.translation.extend(f64::from(number)),
                }
            });
            let lifted: Vec<DAffine3> = lifted.collect();
            let Some(space) = attractor_box(&lifted, &DMat3::IDENTITY) else {
                continue;
            };
            found += 1;
            let high = 2.0 * f64::from(2 + round % 4);
            let size = plane.size().max_element().max(high);
            let expected = [plane.min().extend(2.0), plane.max().extend(high)];
            for (corner, expected) in [space.min(), space.max()].into_iter().zip(expected) {
                let apart = (corner - expected).abs().max_element();
                assert!(apart < 2e-5 * size, "{space:?} {plane:?}");
            }
        }
        assert!(found >= 10, "{found}");
    }

    #[test]
    fn maps_that_do_not_contract_have_no_box() {
        let shear = DAffine2::from_cols_array(&[0.5, 0.0, 3.0, 0.5, 0.0, 0.0]);
        assert_eq!(attractor_box(&[shear], &DMat2::IDENTITY), None);
    }
}
