//! Homotheties by powers of two.

use super::{Bounds, DAffine2, DMat2, DVec2, Point};

/// A homothety whose ratio is a power of two: x → 2ⁿ x + c.
///
/// Multiplying by a power of two is exact in doubles, and so is the difference of numbers that are near
/// each other: moving a distant model to the origin loses no digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homothety<P = DVec2> {
    exponent: i32,
    shift: P,
}

impl<P: Point> Homothety<P> {
    /// The identity.
    pub const IDENTITY: Self = Self {
        exponent: 0,
        shift: P::ZERO,
    };

    /// The largest absolute value of an exponent: ratios and their inverses are normal doubles.
    pub const MAX_EXPONENT: i32 = 1021;

    /// Creates the map x → 2ⁿ x + c; exponents are clamped to ± [`MAX_EXPONENT`](Self::MAX_EXPONENT).
    #[must_use]
    pub fn new(exponent: i32, shift: P) -> Self {
        Self {
            exponent: exponent.clamp(-Self::MAX_EXPONENT, Self::MAX_EXPONENT),
            shift,
        }
    }

    /// Returns `true` for the identity.
    #[must_use]
    pub fn is_identity(&self) -> bool {
        *self == Self::IDENTITY
    }

    /// Returns n, the exponent of the ratio.
    #[must_use]
    pub fn exponent(&self) -> i32 {
        self.exponent
    }

    /// Returns the ratio 2ⁿ: the factor from lengths to lengths of images.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        libm::ldexp(1.0, self.exponent)
    }

    /// Returns the image of a point.
    #[inline]
    #[must_use]
    pub fn point(&self, point: P) -> P {
        point * self.ratio() + self.shift
    }

    /// Returns the image of a box, which is empty if the box is.
    #[must_use]
    pub fn bounds(&self, bounds: &Bounds<P>) -> Bounds<P> {
        if bounds.is_empty() {
            return Bounds::EMPTY;
        }
        Bounds::new(self.point(bounds.min()), self.point(bounds.max()))
    }

    /// Returns the preimage of a point.
    #[must_use]
    pub fn origin_of(&self, point: P) -> P {
        // After the division the difference of the two cannot overflow, but before it can.
        (point - self.shift) / self.ratio()
    }
}

impl Homothety {
    /// Returns the image of a window: lower left corner, width and height.
    #[must_use]
    pub fn window(&self, [x, y, width, height]: [f64; 4]) -> [f64; 4] {
        let corner = self.point(DVec2::new(x, y));
        let size = DVec2::new(width, height) * self.ratio();
        [corner.x, corner.y, size.x, size.y]
    }

    /// Returns the preimage of a window: lower left corner, width and height.
    #[must_use]
    pub fn origin_of_window(&self, [x, y, width, height]: [f64; 4]) -> [f64; 4] {
        let corner = self.origin_of(DVec2::new(x, y));
        let size = DVec2::new(width, height) / self.ratio();
        [corner.x, corner.y, size.x, size.y]
    }

    /// Returns the inverse as an affine map.
    #[must_use]
    pub fn backwards(&self) -> DAffine2 {
        let ratio = self.ratio();
        DAffine2::from_mat2_translation(
            DMat2::from_diagonal(DVec2::splat(1.0 / ratio)),
            -self.shift / ratio,
        )
    }

    /// Returns the conjugate h f h⁻¹ of a map f, where h is this homothety.
    ///
    /// The translation is accumulated in twice the precision of a double, as in [`within`](Self::within).
    #[must_use]
    pub fn around(&self, map: &DAffine2) -> DAffine2 {
        let ratio = self.ratio();
        let shift = self.shift / ratio;
        let moved = moved(&map.matrix2, shift, -map.translation);
        DAffine2::from_mat2_translation(map.matrix2, -moved * ratio)
    }

    /// Returns the conjugate h⁻¹ f h of a map f, where h is this homothety.
    #[must_use]
    pub fn within(&self, map: &DAffine2) -> DAffine2 {
        let ratio = self.ratio();
        let (shift, translation) = (self.shift / ratio, map.translation / ratio);
        DAffine2::from_mat2_translation(map.matrix2, moved(&map.matrix2, shift, translation))
    }
}

/// Returns the exponent e of a positive number x: 2^e ≤ x < 2^(e+1).
pub(crate) fn exponent_of(size: f64) -> i32 {
    libm::frexp(size).1 - 1
}

/// Computes A c + b − c in twice the precision of a double, for its large terms cancel.
fn moved(linear: &DMat2, c: DVec2, b: DVec2) -> DVec2 {
    let rows = linear.transpose();
    let along = |row: DVec2, c_along: f64, b: f64| {
        let products = [(row.x, c.x), (row.y, c.y)];
        let terms = products.into_iter().flat_map(|(factor, c)| {
            let product = factor * c;
            [product, libm::fma(factor, c, -product)]
        });
        sum(terms.chain([b, -c_along]))
    };
    DVec2::new(along(rows.x_axis, c.x, b.x), along(rows.y_axis, c.y, b.y))
}

/// Sums numbers in twice the precision of a double (Neumaier 1974).
fn sum(terms: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0, 0.0);
    for term in terms {
        // Knuth's exact sum of two doubles (TwoSum).
        let next: f64 = sum + term;
        let rounded = next - sum;
        lost += (sum - (next - rounded)) + (term - rounded);
        sum = next;
    }
    sum + lost
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_mapped_comes_from_where_it_was() {
        let far = Homothety::new(-700, DVec2::new(3e-202, -7e-201));
        for point in [DVec2::new(0.25, 1.0), DVec2::new(-3.0, 0.0)] {
            assert!((far.origin_of(far.point(point)) - point).length() < 1e-6);
        }
        assert_eq!(Homothety::IDENTITY.point(DVec2::X), DVec2::X);
    }

    #[test]
    fn maps_about_a_far_point_are_maps_about_the_origin() {
        // A third is wrong by 1e-17 as a double, and its multiple by 10¹² by as much times 10¹².
        let at = DVec2::new(1e12, -3e11);
        for part in [0.5, 0.3, -0.7] {
            let linear = DMat2::from_cols(DVec2::new(part, 0.1), DVec2::new(-0.1, part));
            let far = DAffine2::from_mat2_translation(linear, at - linear * at + DVec2::X);
            let place = Homothety::new(3, at);
            let near = place.within(&far);
            assert!(
                (near.translation - DVec2::X / 8.0).length() < 1e-4,
                "{near}"
            );
            let back = place.around(&near).translation;
            assert!((back - far.translation).length() < 1e-3, "{back}");
        }
        let half = DAffine2::from_scale_angle_translation(DVec2::splat(0.5), 0.0, at / 2.0);
        let near = Homothety::new(0, at).within(&half);
        assert_eq!(near.translation, DVec2::ZERO);
    }
}
