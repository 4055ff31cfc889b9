//! Moments of any order of distributions in the plane, and of invariant measures by linear equations.

use crate::geometry::{DAffine2, DVec2};
use crate::saturating::real;

use super::linear::Equations;

/// Raw moments M_ij = ∫ xⁱ yʲ dμ of a distribution μ of mass 1, for i + j up to an order.
#[derive(Clone, Debug, PartialEq)]
pub struct RawMoments {
    order: usize,
    /// M_ij by i + j, and of one order by j.
    values: Vec<f64>,
}

/// Returns the number of moments below an order, which is the index of the first one of the order.
fn first(order: usize) -> usize {
    order * (order + 1) / 2
}

impl RawMoments {
    /// Returns the moments up to an order of masses at points, which need not sum to 1.
    ///
    /// Returns `None` if the total mass is 0 or a number is not finite.
    #[must_use]
    pub fn of_points(points: impl IntoIterator<Item = (DVec2, f64)>, order: usize) -> Option<Self> {
        let mut values = vec![0.0; first(order + 1)];
        for (point, mass) in points {
            let mut power = mass;
            for degree in 0..=order {
                let mut term = power;
                for row in degree..=order {
                    let index = first(row) + row - degree;
                    values[index] += term;
                    term *= point.y;
                }
                power *= point.x;
            }
        }
        let total = values[0];
        let is_finite = values.iter().all(|value| value.is_finite());
        (total > 0.0 && is_finite).then(|| Self {
            order,
            values: values.into_iter().map(|value| value / total).collect(),
        })
    }

    /// Returns the moments up to an order of the invariant measure of maps with probabilities, μ = Σ p f(μ): for each
    /// order, linear equations of which those of lower orders are the constants (Demko, Hodges & Naylor 1985, section
    /// 3.1; Vrscay & Roehrig 1989).
    ///
    /// Precondition: the maps contract, and the probabilities sum to 1. Returns `None` if equations are singular.
    #[must_use]
    pub fn invariant(maps: &[(DAffine2, f64)], order: usize) -> Option<Self> {
        let size = first(order + 1);
        let mut sum = vec![0.0; size * size];
        let mut rows = vec![0.0; size * size];
        for (map, probability) in maps {
            fill(&mut rows, map, order);
            let pairs = sum.iter_mut().zip(&rows);
            pairs.for_each(|(sum, row)| *sum += probability * row);
        }
        let mut values = vec![0.0; size];
        values[0] = 1.0;
        for degree in 1..=order {
            let start = first(degree);
            let mut equations = Equations::new(degree + 1, 1);
            for row in 0..=degree {
                let coefficients = &sum[(start + row) * size..][..size];
                for column in 0..=degree {
                    let own = if row == column { 1.0 } else { 0.0 };
                    equations.add(row, column, own - coefficients[start + column]);
                }
                let lower = coefficients[..start].iter().zip(&values);
                equations.add_constant(row, 0, lower.map(|(a, b)| a * b).sum());
            }
            let solution = equations.solve()?.pop()?;
            values[start..=start + degree].copy_from_slice(&solution);
        }
        Some(Self { order, values })
    }

    /// Returns the largest order i + j.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// Returns M_ij; `None` beyond the order.
    #[must_use]
    pub fn get(&self, i: usize, j: usize) -> Option<f64> {
        let degree = i.checked_add(j).filter(|&degree| degree <= self.order)?;
        self.values.get(first(degree) + j).copied()
    }

    /// Returns the moments of one order, from M_n0 to M_0n.
    ///
    /// # Panics
    ///
    /// Panics if the order is larger than [`order`](Self::order).
    #[must_use]
    pub fn of_order(&self, order: usize) -> &[f64] {
        &self.values[first(order)..first(order + 1)]
    }

    /// Returns the moments of the image of the distribution under a map.
    #[must_use]
    pub fn transformed(&self, map: &DAffine2) -> Self {
        let size = self.values.len();
        let mut rows = vec![0.0; size * size];
        fill(&mut rows, map, self.order);
        let images = rows.chunks_exact(size).map(|row| {
            let products = row.iter().zip(&self.values).map(|(a, b)| a * b);
            products.sum()
        });
        Self {
            order: self.order,
            values: images.collect(),
        }
    }

    /// Returns the root of the mean square of the differences of moments, each divided by the largest of its order in this
    /// distribution.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        let order = self.order.min(other.order);
        let mut sum = 0.0;
        for degree in 1..=order {
            let (own, others) = (self.of_order(degree), other.of_order(degree));
            let largest = own
                .iter()
                .fold(1e-3f64, |most, value| most.max(value.abs()));
            let squares = own
                .iter()
                .zip(others)
                .map(|(a, b)| ((a - b) / largest).powi(2));
            sum += squares.sum::<f64>() / real(degree + 1);
        }
        (sum / real(order.max(1))).sqrt()
    }
}

/// Fills the rows of the matrix that transforms moments: the coefficients of the polynomials uⁱ vʲ, where u and v are the
/// coordinates of the image of (x, y).
fn fill(rows: &mut [f64], map: &DAffine2, order: usize) {
    let size = first(order + 1);
    let DAffine2 {
        matrix2: linear,
        translation,
    } = *map;
    rows.fill(0.0);
    rows[0] = 1.0;
    for degree in 1..=order {
        for j in 0..=degree {
            // u^i v^j is the product of u with u^(i-1) v^j, or of v with v^(j-1).
            let (before, row) = if j < degree {
                (first(degree - 1) + j, 0)
            } else {
                (first(degree - 1) + j - 1, 1)
            };
            let factor = [linear.x_axis[row], linear.y_axis[row], translation[row]];
            let (known, new) = rows.split_at_mut((first(degree) + j) * size);
            let known = &known[before * size..][..size];
            for lower in 0..degree {
                for column in 0..=lower {
                    let value = known[first(lower) + column];
                    new[first(lower + 1) + column] += factor[0] * value;
                    new[first(lower + 1) + column + 1] += factor[1] * value;
                    new[first(lower) + column] += factor[2] * value;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::{DAffine2, DMat2, DVec2};

    use super::RawMoments;

    fn maps() -> Vec<(DAffine2, f64)> {
        let map = |angle: f64, ratio: f64, x: f64, y: f64| {
            DAffine2::from_mat2_translation(DMat2::from_angle(angle) * ratio, DVec2::new(x, y))
        };
        vec![
            (map(0.4, 0.6, 0.3, -0.2), 0.5),
            (map(-1.0, 0.4, -0.5, 0.1), 0.3),
            (map(2.0, 0.3, 0.2, 0.7), 0.2),
        ]
    }

    /// Four quarters of a square: the invariant measure is the area, ∫ xⁱ yʲ = 1/((i + 1)(j + 1)).
    #[test]
    fn moments_of_a_square_are_known() {
        let half = DMat2::IDENTITY * 0.5;
        let corners = [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5], [0.5, 0.5]];
        let maps = corners.map(|corner| {
            (
                DAffine2::from_mat2_translation(half, DVec2::from(corner)),
                0.25,
            )
        });
        let moments = RawMoments::invariant(&maps, 6).unwrap();
        for i in 0..=6usize {
            for j in 0..=6 - i {
                let exact = 1.0 / ((i + 1) * (j + 1)) as f64;
                assert!((moments.get(i, j).unwrap() - exact).abs() < 1e-12);
            }
        }
        assert_eq!(moments.get(4, 3), None);
    }

    /// The equation that defines the measure, μ = Σ p f(μ), by transforming moments.
    #[test]
    fn invariant_moments_are_invariant() {
        let moments = RawMoments::invariant(&maps(), 6).unwrap();
        let maps = maps();
        let images: Vec<_> = { maps.iter() }
            .map(|(map, probability)| (moments.transformed(map), *probability))
            .collect();
        for i in 0..=6usize {
            for j in 0..=6 - i {
                let parts = images.iter().map(|(it, p)| p * it.get(i, j).unwrap());
                let sum: f64 = parts.sum();
                assert!((sum - moments.get(i, j).unwrap()).abs() < 1e-12);
            }
        }
    }

    /// Moments of images are those of the moved points.
    #[test]
    fn moments_are_transformed() {
        let points = [[0.3, 1.0], [-0.7, 0.2], [0.5, -0.4]].map(DVec2::from);
        let masses = [1.0, 2.0, 0.5];
        let map = maps()[0].0;
        let of = |points: [DVec2; 3]| RawMoments::of_points(points.into_iter().zip(masses), 6);
        let there = of(points.map(|point| map.transform_point2(point))).unwrap();
        assert!(there.distance(&of(points).unwrap().transformed(&map)) < 1e-12);
    }
}
