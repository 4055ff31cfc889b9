//! The moments of the P-balanced measure.

use crate::geometry::{DMat2, DVec2};

use super::system::{Map, System};

/// The mean and the covariance of a measure of total mass 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// The mean.
    pub mean: DVec2,
    /// The covariance, a symmetric matrix.
    pub covariance: DMat2,
}

/// Rounds of the iteration before it is given up.
const MOST_ROUNDS: u32 = 1_000_000;

/// The moments about the origin of a measure of some mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Raw {
    pub(super) mass: f64,
    pub(super) first: DVec2,
    pub(super) second: DMat2,
}

impl Raw {
    const NONE: Self = Self {
        mass: 0.0,
        first: DVec2::ZERO,
        second: DMat2::ZERO,
    };

    /// A mass in one point.
    pub(super) fn point(point: DVec2, mass: f64) -> Self {
        Self::NONE.plus(
            Self {
                mass: 1.0,
                first: point,
                second: outer(point, point),
            },
            mass,
        )
    }

    /// The sum with a multiple of another measure.
    pub(super) fn plus(self, other: Self, factor: f64) -> Self {
        Self {
            mass: self.mass + factor * other.mass,
            first: self.first + factor * other.first,
            second: self.second + factor * other.second,
        }
    }

    /// The measure after a map.
    fn after(self, map: &Map) -> Self {
        match map {
            Map::Affine(map) => {
                let (a, t) = (map.matrix2, map.translation);
                let moved = a * self.first;
                Self {
                    mass: self.mass,
                    first: moved + self.mass * t,
                    second: a * self.second * a.transpose()
                        + outer(moved, t)
                        + outer(t, moved)
                        + self.mass * outer(t, t),
                }
            }
            Map::Condensation(shape) => Self::NONE.plus(shape.moments(), self.mass),
        }
    }

    /// Whether another measure differs by no more than rounding, seen from the origin.
    fn is_near(self, other: Self) -> bool {
        const ROUNDING: f64 = 1e-15;
        let square = self.second.x_axis.x + self.second.y_axis.y;
        let length = (square * self.mass).sqrt();
        (self.mass - other.mass).abs() <= ROUNDING * self.mass
            && (self.first - other.first).length() <= ROUNDING * length
            && self.second.abs_diff_eq(other.second, ROUNDING * square)
    }
}

/// The matrix a bᵀ.
pub(super) fn outer(a: DVec2, b: DVec2) -> DMat2 {
    DMat2::from_cols(a * b.x, a * b.y)
}

impl System {
    /// The mean and the covariance of the P-balanced measure, which satisfy Σ p_i (A_i m + t_i) = m
    /// and likewise for the second moments; of a recurrent system, of the sum of the measures that
    /// belong to its maps, with the masses that the walk gives them. The
    /// equations are iterated until rounding is all that changes.
    ///
    /// `None` where the second moments do not come to rest.
    #[must_use]
    pub fn moments(&self) -> Option<Moments> {
        let maps = self.maps();
        let count = maps.len();
        let rows: Vec<Vec<f64>> = (0..count)
            .map(|from| {
                let row = self.weights_after(from);
                let total: f64 = row.iter().sum();
                row.iter().map(|weight| weight / total).collect()
            })
            .collect();
        let even = 1.0 / count as f64;
        let mut measures = vec![Raw::point(self.start().point, even); count];
        for _ in 0..MOST_ROUNDS {
            let next: Vec<Raw> = (0..count)
                .map(|to| {
                    let before = measures.iter().zip(&rows);
                    let before = before.fold(Raw::NONE, |sum, (raw, row)| sum.plus(*raw, row[to]));
                    // Half of what was: where maps come in turns, the masses would only change places.
                    let half = Raw::NONE.plus(measures[to], 0.5);
                    half.plus(before.after(&maps[to]), 0.5)
                })
                .collect();
            let mut pairs = next.iter().zip(&measures);
            let is_done = pairs.all(|(next, last)| next.is_near(*last));
            measures = next;
            if is_done {
                let all = measures.iter();
                let all = all.fold(Raw::NONE, |sum, raw| sum.plus(*raw, 1.0));
                let mean = all.first / all.mass;
                let covariance = all.second * (1.0 / all.mass) - outer(mean, mean);
                return Some(Moments { mean, covariance });
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chaos::Shape;
    use crate::geometry::DAffine2;

    fn third(shift: f64) -> Map {
        let shift = DVec2::new(shift, 0.0);
        Map::Affine(DAffine2::from_scale_angle_translation(
            DVec2::splat(1.0 / 3.0),
            0.0,
            shift,
        ))
    }

    /// Demko et al. 1985, section 3.2: with weights 0.1 and 0.9 nine tenths of the time is spent on
    /// the right.
    #[test]
    fn the_cantor_set_has_known_moments() {
        let cantor = |p: f64| System::new(vec![(third(0.0), 1.0 - p), (third(2.0 / 3.0), p)]);
        let even = cantor(0.5).unwrap().moments().unwrap();
        assert!((even.mean - DVec2::new(0.5, 0.0)).length() < 1e-14);
        assert!((even.covariance.x_axis - DVec2::new(0.125, 0.0)).length() < 1e-14);
        assert_eq!(even.covariance.y_axis, DVec2::ZERO);
        let skewed = cantor(0.9).unwrap().moments().unwrap();
        assert!((skewed.mean.x - 0.9).abs() < 1e-14);
    }

    /// In turns only two points are left: 1/4 and 3/4.
    #[test]
    fn maps_may_come_in_turns() {
        let maps = vec![(third(0.0), 1.0), (third(2.0 / 3.0), 1.0)];
        let turns = vec![vec![0.0, 1.0], vec![1.0, 0.0]];
        let moments = System::recurrent(maps, turns).unwrap().moments().unwrap();
        assert!((moments.mean.x - 0.5).abs() < 1e-14);
        assert!((moments.covariance.x_axis.x - 0.0625).abs() < 1e-14);
    }

    #[test]
    fn shapes_have_their_moments() {
        let only = |shape: Shape| {
            let system = System::new(vec![(Map::Condensation(shape), 1.0)]).unwrap();
            system.moments().unwrap()
        };
        let corners = [DVec2::ZERO, DVec2::X * 2.0, DVec2::new(2.0, 1.0), DVec2::Y];
        let box_ = only(Shape::polygon(&corners).unwrap());
        assert!((box_.mean - DVec2::new(1.0, 0.5)).length() < 1e-14);
        let expected = DMat2::from_diagonal(DVec2::new(4.0, 1.0) / 12.0);
        assert!(box_.covariance.abs_diff_eq(expected, 1e-14));
        let line = only(Shape::polyline(&[DVec2::ZERO, DVec2::new(2.0, 1.0)]).unwrap());
        assert!((line.mean - DVec2::new(1.0, 0.5)).length() < 1e-14);
        let direction = DVec2::new(2.0, 1.0);
        assert!(
            line.covariance
                .abs_diff_eq(outer(direction, direction) * (1.0 / 12.0), 1e-14)
        );
        let map = DAffine2::from_cols_array(&[2.0, 0.0, 1.0, 3.0, 5.0, 6.0]);
        let disk = only(Shape::ellipse(map).unwrap());
        assert!((disk.mean - DVec2::new(5.0, 6.0)).length() < 1e-13);
        let expected = map.matrix2 * map.matrix2.transpose() * 0.25;
        assert!(disk.covariance.abs_diff_eq(expected, 1e-13));
    }
}
