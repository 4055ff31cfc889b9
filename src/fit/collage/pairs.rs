//! Collages by pairs of nearest points: the maps are fitted to the pairs that they make, alternately.

use crate::geometry::{DAffine2, DMat2, DVec2, Linear};

use super::super::Candidate;
use super::super::candidate::is_similar;
use super::ground::Ground;

/// Form of the maps that are fitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::fit) enum Form {
    /// Similarities.
    Similar,
    /// Affine maps.
    Affine,
}

impl Form {
    /// Returns the form of a candidate's maps.
    pub(in crate::fit) fn of(candidate: &Candidate) -> Self {
        let are_similar = candidate.maps.iter().all(|map| is_similar(&map.matrix2));
        if are_similar {
            Self::Similar
        } else {
            Self::Affine
        }
    }
}

/// Largest factor by which a map of a collage stretches.
pub(in crate::fit) const MOST_STRETCH: f64 = 0.95;
/// Weight of the pairs that keep copies inside the shape, relative to those that cover it.
const INSIDE: f64 = 0.7;

/// Sums of weighted pairs of points, for least squares.
#[derive(Clone, Copy, Default)]
struct Sums {
    weight: f64,
    from: DVec2,
    to: DVec2,
    /// Columns: sums of from.x · from and from.y · from.
    square: DMat2,
    /// Columns: sums of from.x · to and from.y · to.
    cross: DMat2,
}

impl Sums {
    const NONE: Self = Self {
        weight: 0.0,
        from: DVec2::ZERO,
        to: DVec2::ZERO,
        square: DMat2::ZERO,
        cross: DMat2::ZERO,
    };

    #[inline]
    fn add(&mut self, from: DVec2, to: DVec2, weight: f64) {
        self.weight += weight;
        self.from += weight * from;
        self.to += weight * to;
        self.square += DMat2::from_cols(from * from.x, from * from.y) * weight;
        self.cross += DMat2::from_cols(to * from.x, to * from.y) * weight;
    }

    /// Returns the map that minimises the weighted squares; `None` for too few pairs.
    fn solved(&self, form: Form, flips: bool) -> Option<DAffine2> {
        if self.weight < 1e-9 {
            return None;
        }
        let [from, to] = [self.from, self.to].map(|sum| sum / self.weight);
        let square =
            self.square * (1.0 / self.weight) - DMat2::from_cols(from * from.x, from * from.y);
        let cross = self.cross * (1.0 / self.weight) - DMat2::from_cols(to * from.x, to * from.y);
        let matrix = match form {
            Form::Affine => {
                // A ridge keeps the problem solvable where all points lie on a line.
                let ridge = 1e-6 * (square.x_axis.x + square.y_axis.y) + 1e-9;
                cross * (square + DMat2::IDENTITY * ridge).inverse()
            }
            Form::Similar => {
                let spread = square.x_axis.x + square.y_axis.y;
                if spread < 1e-9 {
                    return None;
                }
                let flip = if flips { -1.0 } else { 1.0 };
                let axis = DVec2::new(
                    cross.x_axis.x + flip * cross.y_axis.y,
                    cross.x_axis.y - flip * cross.y_axis.x,
                ) / spread;
                DMat2::from_cols(axis, flip * axis.perp())
            }
        };
        let matrix = clamped(matrix);
        Some(DAffine2::from_mat2_translation(matrix, to - matrix * from))
    }
}

/// Returns a matrix whose largest singular value is at most [`MOST_STRETCH`].
pub(in crate::fit) fn clamped(matrix: DMat2) -> DMat2 {
    let stretch = matrix.stretch();
    if stretch > MOST_STRETCH {
        matrix * (MOST_STRETCH / stretch)
    } else {
        matrix
    }
}

/// Improves the maps of a collage, given in cells, by `rounds` of least squares, and returns the mean squared distance
/// of the last pairs.
///
/// A point q of the shape belongs to the map f whose image of the point a of the shape that is nearest to f⁻¹(q) is
/// nearest to q, one of `points`, which are those that no disk covers. f is fitted to its pairs (a, q), which cover the shape, and to pairs of points p of the shape with the
/// points nearest to f(p), which keep it inside.
pub(in crate::fit) fn improve(
    ground: &Ground,
    points: &[DVec2],
    maps: &mut [DAffine2],
    form: Form,
    rounds: usize,
) -> f64 {
    let mut error = f64::INFINITY;
    for _ in 0..rounds {
        let mut sums = vec![Sums::NONE; maps.len()];
        let backs: Vec<Option<DAffine2>> = maps.iter().map(back).collect();
        let mut total = 0.0;
        let mut worst = (0.0, DVec2::ZERO);
        for &point in points {
            let mut best = (f64::INFINITY, 0, DVec2::ZERO);
            for (number, (map, back)) in maps.iter().zip(&backs).enumerate() {
                let source = match back {
                    Some(back) => ground.nearest(back.transform_point2(point)),
                    None => ground.nearest(flat_source(map, point, ground.middle())),
                };
                let away = map.transform_point2(source).distance_squared(point);
                if away < best.0 {
                    best = (away, number, source);
                }
            }
            let (away, number, source) = best;
            total += away;
            if away > worst.0 {
                worst = (away, point);
            }
            // Far points must not rule the fit.
            sums[number].add(source, point, 1.0 / (1.0 + away / 64.0));
        }
        for (map, sums) in maps.iter().zip(&mut sums) {
            let share = INSIDE * (sums.weight / points.len() as f64).max(0.02);
            for &point in ground.points().iter().step_by(2) {
                let image = map.transform_point2(point);
                let inside = ground.nearest(image);
                let away = image.distance_squared(inside);
                total += share * away;
                sums.add(point, inside, 2.0 * share / (1.0 + away / 64.0));
            }
        }
        error = total / points.len() as f64;
        for (map, sums) in maps.iter_mut().zip(&sums) {
            let covers = sums.weight > 0.03 * points.len() as f64;
            let flips = map.matrix2.determinant() < 0.0;
            match sums.solved(form, flips) {
                Some(solved) if covers => *map = solved,
                // A map that covers next to nothing begins anew where the cover is worst.
                _ if worst.0 > 4.0 => {
                    let matrix = map.matrix2 * 0.7;
                    let shift = worst.1 - matrix * ground.middle();
                    *map = DAffine2::from_mat2_translation(matrix, shift);
                    worst.0 = 0.0;
                }
                Some(solved) => *map = solved,
                None => {}
            }
        }
    }
    error
}

/// Returns the inverse of a map; `None` if it is nearly flat.
fn back(map: &DAffine2) -> Option<DAffine2> {
    let stretch = map.matrix2.stretch();
    (map.matrix2.determinant().abs() > 1e-3 * stretch * stretch && stretch > 1e-4)
        .then(|| map.inverse())
}

/// Returns a point whose image under a map that is nearly flat is nearest to a point: the one on the line through
/// `middle` along which the map stretches most.
fn flat_source(map: &DAffine2, point: DVec2, middle: DVec2) -> DVec2 {
    let rows = map.matrix2.transpose();
    let [x, y] = [rows.x_axis, rows.y_axis];
    let along = if x.length_squared() > y.length_squared() {
        x
    } else {
        y
    };
    let along = along.normalize_or_zero();
    let image = map.matrix2 * along;
    if image.length_squared() < 1e-12 {
        return middle;
    }
    let away = point - map.transform_point2(middle);
    middle + along * (away.dot(image) / image.length_squared())
}
