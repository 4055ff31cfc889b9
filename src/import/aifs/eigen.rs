//! Eigenvalues of a small matrix, and its left eigenvectors.

use crate::geometry::DVec2;

use super::affine::{Affine, times};

/// Relative distance below which eigenvalues count as equal.
const NEAR: f64 = 1e-6;

/// Largest number of iterations; simple roots take about ten.
const MAX_ITERATIONS: usize = 200;

/// A real eigenvalue, or one of a conjugate pair: that with the positive imaginary part.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cell {
    /// The eigenvalue λ as (real part, imaginary part).
    pub(super) value: DVec2,
    /// A left eigenvector u: u M = λ u. Its first coordinate is 1, unless that is 0.
    pub(super) vector: Vec<DVec2>,
}

/// Returns the cells of the real Jordan form of a matrix in the order of AIFS: decreasing moduli and, where these are
/// equal, decreasing real parts. Returns `None` if an eigenvalue is multiple, or if the iteration does not converge.
///
/// Characteristic polynomial and adjugate are computed by the algorithm of Faddeev and Le Verrier, the roots by that of
/// Aberth ("Iteration methods for finding all zeros of a polynomial simultaneously", 1973).
pub(super) fn cells(matrix: &[f64], dimension: usize) -> Option<Vec<Cell>> {
    let (polynomial, adjugates) = characteristic(matrix, dimension);
    let roots = roots(&polynomial)?;
    let scale = |root: &DVec2| NEAR * root.length().max(1.0);
    let is_double = |(at, root): (usize, &DVec2)| {
        let others = roots[at + 1..].iter();
        others
            .clone()
            .any(|other| root.distance(*other) < scale(root))
    };
    if roots.iter().enumerate().any(is_double) {
        return None;
    }
    let real = |root: DVec2| match root.y.abs() < scale(&root) {
        true => DVec2::new(root.x, 0.0),
        false => root,
    };
    let mut values: Vec<_> = roots.iter().map(|root| real(*root)).collect();
    values.retain(|root| root.y >= 0.0);
    values.sort_by(|a, b| b.length().total_cmp(&a.length()));
    let near = |a: &DVec2, b: &DVec2| a.length() - b.length() < scale(a);
    for equal in values.chunk_by_mut(near) {
        equal.sort_by(|a, b| b.x.total_cmp(&a.x));
    }
    let cell = |value: DVec2| Cell {
        value,
        vector: left_eigenvector(&adjugates, dimension, value),
    };
    Some(values.into_iter().map(cell).collect())
}

/// Returns the coefficients of det(x I − M), from that of 1 to that of xⁿ, and the matrices B with adj(x I − M) = B₁ xⁿ⁻¹ +
/// … + Bₙ.
fn characteristic(matrix: &[f64], dimension: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut polynomial = vec![0.0; dimension + 1];
    polynomial[dimension] = 1.0;
    let mut adjugates = vec![Affine::scaling(dimension, 1.0).matrix];
    for order in 1..=dimension {
        let mut product = times(matrix, &adjugates[order - 1], dimension);
        let trace: f64 = product.iter().step_by(dimension + 1).sum();
        #[expect(clippy::cast_precision_loss, reason = "the dimension is small")]
        let coefficient = -trace / order as f64;
        polynomial[dimension - order] = coefficient;
        if order < dimension {
            let diagonal = product.iter_mut().step_by(dimension + 1);
            diagonal.for_each(|entry| *entry += coefficient);
            adjugates.push(product);
        }
    }
    (polynomial, adjugates)
}

/// Returns the row of largest norm of adj(λ I − M), all of which are left eigenvectors.
fn left_eigenvector(adjugates: &[Vec<f64>], dimension: usize, value: DVec2) -> Vec<DVec2> {
    let mut adjugate = vec![DVec2::ZERO; dimension * dimension];
    for matrix in adjugates {
        for (entry, coefficient) in adjugate.iter_mut().zip(matrix) {
            *entry = entry.rotate(value) + DVec2::new(*coefficient, 0.0);
        }
    }
    let norm = |row: &&[DVec2]| row.iter().map(|it| it.length_squared()).sum::<f64>();
    let rows = adjugate.chunks(dimension);
    let row = rows
        .max_by(|a, b| norm(a).total_cmp(&norm(b)))
        .unwrap_or_default();
    let size = norm(&row).sqrt();
    let is_clear = |it: &&DVec2| it.length() > NEAR * size;
    let unit = row.iter().find(is_clear).copied().unwrap_or(DVec2::X);
    row.iter().map(|entry| quotient(*entry, unit)).collect()
}

/// Returns the roots of a polynomial whose leading coefficient is 1.
fn roots(polynomial: &[f64]) -> Option<Vec<DVec2>> {
    let degree = polynomial.len() - 1;
    // All roots lie within this distance of 0 (Cauchy 1829).
    let bound = polynomial[..degree]
        .iter()
        .fold(0.0_f64, |most, it| most.max(it.abs()))
        + 1.0;
    #[expect(clippy::cast_precision_loss, reason = "the degree is small")]
    let start = |at: usize| {
        let angle = 0.4 + std::f64::consts::TAU * at as f64 / degree as f64;
        DVec2::new(libm::cos(angle), libm::sin(angle)) * bound / 2.0
    };
    let mut roots: Vec<DVec2> = (0..degree).map(start).collect();
    for _ in 0..MAX_ITERATIONS {
        let mut moved = 0.0_f64;
        for at in 0..degree {
            let root = roots[at];
            let (value, slope) = evaluated(polynomial, root);
            if value == DVec2::ZERO {
                continue;
            }
            let newton = quotient(value, slope);
            let others = roots.iter().enumerate().filter(|(other, _)| *other != at);
            let others = others.map(|(_, other)| quotient(DVec2::X, root - *other));
            let repulsion: DVec2 = others.sum();
            let step = quotient(newton, DVec2::X - newton.rotate(repulsion));
            roots[at] = root - step;
            moved = moved.max(step.length() / root.length().max(1.0));
        }
        if !moved.is_finite() {
            return None;
        }
        if moved < 1e-15 {
            return Some(roots);
        }
    }
    // Rounding errors move the roots on, at most by this much.
    let is_root = |root: &DVec2| evaluated(polynomial, *root).0.length() < 1e-9 * bound;
    roots.iter().all(is_root).then_some(roots)
}

/// Returns a polynomial and its derivative at a number (Horner).
fn evaluated(polynomial: &[f64], at: DVec2) -> (DVec2, DVec2) {
    let mut value = DVec2::ZERO;
    let mut slope = DVec2::ZERO;
    for coefficient in polynomial.iter().rev() {
        slope = slope.rotate(at) + value;
        value = value.rotate(at) + DVec2::new(*coefficient, 0.0);
    }
    (value, slope)
}

fn quotient(a: DVec2, b: DVec2) -> DVec2 {
    a.rotate(DVec2::new(b.x, -b.y)) / b.length_squared()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::{cells, times};
    use crate::geometry::DVec2;

    #[test]
    fn cells_are_in_their_order() {
        // x⁴ − x³ + x² − x + 1: tenth roots of unity, of equal moduli.
        let pentagon = [
            0., 0., 0., -1., 1., 0., 0., 1., 0., 1., 0., -1., 0., 0., 1., 1.,
        ];
        let found = cells(&pentagon, 4).unwrap();
        let angles: Vec<_> = found
            .iter()
            .map(|it| it.value.to_angle().to_degrees())
            .collect();
        assert!(
            (angles[0] - 36.0).abs() < 1e-9 && (angles[1] - 108.0).abs() < 1e-9,
            "{angles:?}"
        );
        // x³ + x² + x − 1: the pair has the larger modulus.
        let tribonacci = [0., 0., 1., 1., 0., -1., 0., 1., -1.];
        let found = cells(&tribonacci, 3).unwrap();
        assert!(
            found[0].value.y > 0.0 && (found[0].value.length() - 1.356_203_065_626).abs() < 1e-9
        );
        assert!((found[1].value - DVec2::new(0.543_689_012_692, 0.0)).length() < 1e-9);
    }

    #[test]
    fn vectors_are_eigenvectors() {
        let matrix = [
            3., 1., 0., 2., -1., 2., 5., 0., 0.5, 0., 1., -2., 7., 0., 1., 4.,
        ];
        for cell in cells(&matrix, 4).unwrap() {
            assert_eq!(cell.vector[0], DVec2::X);
            let parts = [|it: &DVec2| it.x, |it: &DVec2| it.y].map(|part| {
                let row: Vec<f64> = cell.vector.iter().map(part).collect();
                times(&row, &matrix, 4)
            });
            for (column, entry) in cell.vector.iter().enumerate() {
                let image = DVec2::new(parts[0][column], parts[1][column]);
                assert!(
                    (image - entry.rotate(cell.value)).length() < 1e-9,
                    "{cell:?}"
                );
            }
        }
    }

    #[test]
    fn multiple_eigenvalues_are_refused() {
        assert_eq!(cells(&[2., 0., 0., 2.], 2), None);
        assert_eq!(cells(&[2., 1., 0., 2.], 2), None);
    }
}
