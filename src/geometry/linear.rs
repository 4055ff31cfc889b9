//! Linear maps of the plane and of space: what is common to both.

use std::fmt::Debug;
use std::ops::{Mul, RangeInclusive};

use glam::{DMat2, DMat3, DVec2, DVec3};

use super::Point;
use super::frame2::stretch;

/// A linear map: [`DMat2`] of the plane, [`DMat3`] of space.
pub trait Linear:
    Copy + Debug + PartialEq + Send + Sync + Mul<Output = Self> + Mul<f64, Output = Self> + 'static
{
    /// The vectors that the map turns and lengthens.
    type Point: Point;

    /// The identity.
    const IDENTITY: Self;

    /// Returns the determinant.
    #[must_use]
    fn determinant(&self) -> f64;

    /// Returns the root of the absolute determinant, of degree two in the plane and three in space: the ratio, if the map is
    /// a similarity. Determinants below the range of doubles do no harm.
    #[must_use]
    fn mean_ratio(&self) -> f64;

    /// Returns the product of the transposed map with a vector: its products with other vectors are those of `vector`
    /// with their images.
    #[must_use]
    fn transposed(&self, vector: Self::Point) -> Self::Point;

    /// Returns the largest factor by which the map lengthens a vector: its largest singular value.
    #[must_use]
    fn stretch(&self) -> f64;

    /// Returns the spectral radius: the largest modulus of an eigenvalue.
    #[must_use]
    fn spectral_radius(&self) -> f64;

    /// Returns the singular values in falling order, completed by zeros.
    #[must_use]
    fn singular_values(&self) -> [f64; 3];
}

/// Determinants in whose computation nothing is below or beyond the range of doubles.
const EXACT: RangeInclusive<f64> = 1e-280..=1e280;

impl Linear for DMat2 {
    type Point = DVec2;

    const IDENTITY: Self = Self::IDENTITY;

    fn determinant(&self) -> f64 {
        self.determinant()
    }

    fn mean_ratio(&self) -> f64 {
        let area = self.determinant().abs();
        if EXACT.contains(&area) {
            return area.sqrt();
        }
        let largest = f64::max(
            self.x_axis.abs().max_element(),
            self.y_axis.abs().max_element(),
        );
        match largest.is_normal() {
            true => largest * (*self / largest).determinant().abs().sqrt(),
            false => largest,
        }
    }

    #[inline]
    fn transposed(&self, vector: DVec2) -> DVec2 {
        self.transpose() * vector
    }

    fn stretch(&self) -> f64 {
        stretch(self)
    }

    fn singular_values(&self) -> [f64; 3] {
        let larger = stretch(self);
        let ratio = self.mean_ratio();
        [larger, ratio / larger * ratio, 0.0]
    }

    fn spectral_radius(&self) -> f64 {
        let (a, c) = (self.x_axis.x, self.x_axis.y);
        let (b, d) = (self.y_axis.x, self.y_axis.y);
        let (middle, half) = (a / 2.0 + d / 2.0, a / 2.0 - d / 2.0);
        let is_exact = |square: f64, is_zero: bool| is_zero || EXACT.contains(&square.abs());
        let is_plain = is_exact(half * half, half == 0.0) && is_exact(b * c, b == 0.0 || c == 0.0);
        if is_plain || !self.is_finite() {
            return largest_root(middle, half, b * c);
        }
        // As for the map in coordinates in which the other two entries are equal but for their signs.
        let mean = b.abs().sqrt() * c.abs().sqrt();
        let size = mean.max(half.abs()).max(middle.abs());
        let product = (mean / size) * (mean / size) * b.signum() * c.signum();
        size * largest_root(middle / size, half / size, product)
    }
}

/// Returns the largest modulus of the eigenvalues of a 2 × 2 matrix from the half of its trace, the half of the
/// difference of its diagonal entries, and the product of the other two.
fn largest_root(middle: f64, half: f64, product: f64) -> f64 {
    let discriminant = half * half + product;
    if discriminant >= 0.0 {
        middle.abs() + discriminant.sqrt()
    } else {
        libm::hypot(middle, (-discriminant).sqrt())
    }
}

impl Linear for DMat3 {
    type Point = DVec3;

    const IDENTITY: Self = Self::IDENTITY;

    fn determinant(&self) -> f64 {
        self.determinant()
    }

    fn mean_ratio(&self) -> f64 {
        let volume = self.determinant().abs();
        if EXACT.contains(&volume) {
            return libm::cbrt(volume);
        }
        let columns = [self.x_axis, self.y_axis, self.z_axis];
        let largest = columns.map(|column| column.abs().max_element());
        let largest = largest.into_iter().fold(0.0, f64::max);
        match largest.is_normal() {
            true => largest * libm::cbrt((*self / largest).determinant().abs()),
            false => largest,
        }
    }

    #[inline]
    fn transposed(&self, vector: DVec3) -> DVec3 {
        self.transpose() * vector
    }

    fn stretch(&self) -> f64 {
        stretch3(self)
    }

    /// Computes the values by one-sided Jacobi rotations: columns are rotated in pairs until they are orthogonal
    /// (Hestenes 1958).
    fn singular_values(&self) -> [f64; 3] {
        let mut columns = [self.x_axis, self.y_axis, self.z_axis];
        for _ in 0..12 {
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                let (a, b) = (columns[p], columns[q]);
                let product = a.dot(b);
                if product == 0.0 {
                    continue;
                }
                let theta = (b.length_squared() - a.length_squared()) / (2.0 * product);
                let tangent = 1.0_f64.copysign(theta) / (theta.abs() + libm::hypot(theta, 1.0));
                let cosine = 1.0 / libm::hypot(tangent, 1.0);
                let sine = tangent * cosine;
                columns[p] = cosine * a - sine * b;
                columns[q] = sine * a + cosine * b;
            }
        }
        let mut values = columns.map(|column| column.length());
        values.sort_by(|a, b| b.total_cmp(a));
        values
    }

    fn spectral_radius(&self) -> f64 {
        let size = largest_entry(self);
        if !(size > 0.0 && size.is_finite()) {
            return size;
        }
        let scaled = *self / size;
        if let Some(ratio) = ratio(&scaled) {
            return ratio * size;
        }
        let is_exact = |entry: &f64| *entry == 0.0 || entry.abs() / size > LEAST;
        if self.to_cols_array().iter().all(is_exact) {
            return size * largest_eigenvalue(&scaled);
        }
        let balanced = balanced(*self);
        match largest_entry(&balanced) {
            0.0 => 0.0,
            size => size * largest_eigenvalue(&(balanced / size)),
        }
    }
}

/// Share of the largest entry above which no product of three entries is below the range of doubles.
const LEAST: f64 = 1e-90;

/// Returns the matrix of a map in coordinates in which the other entries of a row are about as large as those of its column:
/// its eigenvalues are those of the map. Entries that have no part in them become 0 (Osborne 1960; Parlett & Reinsch 1969).
fn balanced(matrix: DMat3) -> DMat3 {
    let mut rows = matrix.transpose().to_cols_array_2d();
    for _ in 0..100 {
        let mut is_done = true;
        for at in [0, 1, 2] {
            let others = || [0, 1, 2].into_iter().filter(move |other| *other != at);
            let row = others().map(|other| rows[at][other].abs());
            let column = others().map(|other| rows[other][at].abs());
            let (row, column) = (row.fold(0.0, f64::max), column.fold(0.0, f64::max));
            if row == 0.0 || column == 0.0 {
                for other in others() {
                    (rows[at][other], rows[other][at]) = (0.0, 0.0);
                }
                is_done &= row == column;
                continue;
            }
            // Powers of two take no digits.
            let exponent = (libm::ilogb(row) - libm::ilogb(column)) / 2;
            if exponent == 0 {
                continue;
            }
            is_done = false;
            for other in others() {
                rows[at][other] = libm::scalbn(rows[at][other], -exponent);
                rows[other][at] = libm::scalbn(rows[other][at], exponent);
            }
        }
        if is_done {
            break;
        }
    }
    DMat3::from_cols_array_2d(&rows).transpose()
}

fn largest_entry(matrix: &DMat3) -> f64 {
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let largest = columns.map(|column| column.abs().max_element());
    largest.into_iter().fold(0.0, f64::max)
}

/// Returns the ratio of a similarity, to within rounding; `None` if the map is not one.
fn ratio(matrix: &DMat3) -> Option<f64> {
    const ROUNDING: f64 = 1e-14;
    let square = matrix.transpose() * *matrix;
    let mean = (square.x_axis.x + square.y_axis.y + square.z_axis.z) / 3.0;
    let is_similarity = square.abs_diff_eq(DMat3::IDENTITY * mean, ROUNDING * mean);
    (is_similarity && mean > 0.0).then(|| mean.sqrt())
}

/// Returns the largest modulus of an eigenvalue of a matrix whose entries are at most 1.
///
/// The characteristic polynomial λ³ − t λ² + m λ − d has a real root, found by Newton's method from beyond all
/// roots or by bisection; the other two are those of the quadratic that remains.
fn largest_eigenvalue(matrix: &DMat3) -> f64 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let trace = x.x + y.y + z.z;
    let minors = x.x * y.y - y.x * x.y + x.x * z.z - z.x * x.z + y.y * z.z - z.y * y.z;
    let determinant = matrix.determinant();
    let value = |at: f64| ((at - trace) * at + minors) * at - determinant;
    // All eigenvalues lie within the largest sum of a row.
    let (mut low, mut high) = (-4.0, 4.0);
    for _ in 0..200 {
        let middle = f64::midpoint(low, high);
        if value(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    let real = f64::midpoint(low, high);
    let middle = (trace - real) / 2.0;
    // λ² − 2 middle λ + rest
    let rest = minors - real * (trace - real);
    real.abs()
        .max(largest_root(middle, 0.0, middle * middle - rest))
}

/// Returns the largest singular value of a matrix of space.
pub(crate) fn stretch3(matrix: &DMat3) -> f64 {
    let size = largest_entry(matrix);
    if !(size > 0.0 && size.is_finite()) {
        return size;
    }
    let scaled = *matrix / size;
    // A homothety stretches by its ratio exactly.
    if is_diagonal(&scaled) {
        return size;
    }
    let square = scaled.transpose() * scaled;
    size * largest_of_symmetric(&square).sqrt()
}

/// Returns the largest eigenvalue of a symmetric matrix of space, by the trigonometric solution of its characteristic
/// equation (Smith 1961).
fn largest_of_symmetric(matrix: &DMat3) -> f64 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let mean = (x.x + y.y + z.z) / 3.0;
    let apart = *matrix - DMat3::from_diagonal(DVec3::splat(mean));
    let [x, y, z] = [apart.x_axis, apart.y_axis, apart.z_axis];
    let radius = ((x.dot(x) + y.dot(y) + z.dot(z)) / 6.0).sqrt();
    if radius == 0.0 {
        return mean;
    }
    let half = (apart * (1.0 / radius)).determinant() / 2.0;
    let angle = libm::acos(half.clamp(-1.0, 1.0)) / 3.0;
    mean + 2.0 * radius * libm::cos(angle)
}

fn is_diagonal(matrix: &DMat3) -> bool {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    [x.y, x.z, y.x, y.z, z.x, z.y].iter().all(|it| *it == 0.0)
}

/// Returns eigenvalues and eigenvectors, as columns, of a symmetric matrix, by Jacobi's rotations.
pub(crate) fn eigen(matrix: &DMat3) -> (DVec3, DMat3) {
    const SWEEPS: u32 = 12;
    const NEGLIGIBLE: f64 = 1e-20;
    let mut a = matrix.to_cols_array_2d();
    let mut vectors = DMat3::IDENTITY.to_cols_array_2d();
    for _ in 0..SWEEPS {
        // The rotations converge quadratically: mostly after four sweeps, nothing is left.
        let beside = [a[0][1], a[0][2], a[1][2]].map(f64::abs);
        let along = [a[0][0], a[1][1], a[2][2]].map(f64::abs);
        let [beside, along] = [beside, along].map(|all| all.into_iter().fold(0.0, f64::max));
        if beside <= NEGLIGIBLE * along {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let root = (theta * theta + 1.0).sqrt();
            let t = theta.signum() / (theta.abs() + root);
            let t = if t.is_finite() { t } else { 0.0 };
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for row in &mut a {
                let (of_p, of_q) = (row[p], row[q]);
                row[p] = c * of_p - s * of_q;
                row[q] = s * of_p + c * of_q;
            }
            for k in 0..3 {
                let (of_p, of_q) = (a[p][k], a[q][k]);
                a[p][k] = c * of_p - s * of_q;
                a[q][k] = s * of_p + c * of_q;
                let (of_p, of_q) = (vectors[p][k], vectors[q][k]);
                vectors[p][k] = c * of_p - s * of_q;
                vectors[q][k] = s * of_p + c * of_q;
            }
        }
    }
    let values = DVec3::new(a[0][0], a[1][1], a[2][2]);
    (values, DMat3::from_cols_array_2d(&vectors))
}

/// Returns the rotation about an axis by an angle, of which it takes the cosine and the sine, by the right-hand
/// rule (Rodrigues 1840).
#[must_use]
pub fn rotation(axis: DVec3, cosine: f64, sine: f64) -> DMat3 {
    let axis = axis.normalize();
    let columns = [DVec3::X, DVec3::Y, DVec3::Z];
    let [x, y, z] = columns.map(|unit| {
        unit * cosine + axis.cross(unit) * sine + axis * (axis.dot(unit) * (1.0 - cosine))
    });
    DMat3::from_cols(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn largest_singular_values_and_eigenvalues() {
        let turned = rotation(DVec3::new(1.0, 2.0, -0.5), 0.6, 0.8);
        assert!((turned.determinant() - 1.0).abs() < 1e-15);
        for (map, stretch, radius) in [
            (turned * 0.5, 0.5, 0.5),
            (DMat3::from_diagonal(DVec3::new(-0.9, 0.2, 0.0)), 0.9, 0.9),
            (
                turned * DMat3::from_diagonal(DVec3::new(3.0, 1.0, 1e-9)),
                3.0,
                f64::NAN,
            ),
        ] {
            assert!((stretch3(&map) - stretch).abs() < 1e-14, "{map}");
            let found = map.spectral_radius();
            assert!(
                radius.is_nan() || (found - radius).abs() < 1e-13,
                "{map}: {found}"
            );
        }
        // A Jordan block stretches, but does not expand when it is iterated.
        let shear = DMat3::from_cols(DVec3::X * 0.5, DVec3::new(7.0, 0.5, 0.0), DVec3::Z * 0.1);
        assert!(stretch3(&shear) > 7.0);
        assert!((shear.spectral_radius() - 0.5).abs() < 1e-5);
    }

    /// Products of entries are below or beyond the range of doubles.
    #[test]
    fn eigenvalues_of_entries_of_any_size() {
        let is_near = |found: f64, radius: f64| (found / radius - 1.0).abs() < 1e-12;
        // Double roots of a characteristic polynomial have half of the digits.
        let is_about = |found: f64, radius: f64| (found / radius - 1.0).abs() < 1e-7;
        for ([a, b, c, d], radius) in [
            ([0.5, 1e300, 0.0, 1.0], 1.0),
            ([0.5e-200, 1.0, 0.0, -1e-200], 1e-200),
            ([0.0, 1e300, 1e-300, 0.0], 1.0),
            ([0.0, 1e300, -4e-300, 0.0], 2.0),
            ([1e200, 1e200, 1e200, 1e200], 2e200),
            ([3e-170, 2e-170, 2e-170, 3e-170], 5e-170),
            ([0.5, 1e-310, 1e-310, 0.5], 0.5),
            ([1e150, 1e-200, 1e-200, 1e150], 1e150),
        ] {
            let plane = DMat2::from_cols(DVec2::new(a, c), DVec2::new(b, d));
            let found = plane.spectral_radius();
            assert!(is_near(found, radius), "{plane}: {found}");
            for third in [0.0, radius / 4.0] {
                let rows = [[third, 1.0, 0.0], [0.0, a, b], [0.0, c, d]];
                let space = DMat3::from_cols_array_2d(&rows).transpose();
                let found = space.spectral_radius();
                assert!(is_about(found, radius), "{space}: {found}");
            }
        }
        let cycle = [[0.0, 1e200, 0.0], [0.0, 0.0, 8.0], [1e-200, 0.0, 0.0]];
        let found = DMat3::from_cols_array_2d(&cycle).spectral_radius();
        assert!(is_near(found, 2.0), "{found}");
    }

    #[test]
    fn rotations_follow_the_right_hand_rule() {
        let quarter = rotation(DVec3::Z, 0.0, 1.0);
        assert!((quarter * DVec3::X - DVec3::Y).length() < 1e-15);
        let quarter = rotation(DVec3::X * 3.0, 0.0, 1.0);
        assert!((quarter * DVec3::Y - DVec3::Z).length() < 1e-15);
    }

    #[test]
    fn plane_maps_agree_with_maps_of_space() {
        let plane = DMat2::from_cols(DVec2::new(0.3, -0.8), DVec2::new(0.5, 0.2));
        let space = DMat3::from_cols(
            plane.x_axis.extend(0.0),
            plane.y_axis.extend(0.0),
            DVec3::ZERO,
        );
        assert!((stretch(&plane) - stretch3(&space)).abs() < 1e-15);
        assert!((plane.spectral_radius() - space.spectral_radius()).abs() < 1e-14);
    }
}
