//! Vectors with a separate exponent.

use crate::geometry::{DVec2, Point};

/// Vector of arbitrary length: 3ⁿ steps exceed the range of a double from n = 647 on.
///
/// Guarantee: the larger absolute coordinate of the mantissa is in [0.5, 1), or the vector is 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Far<P: Point = DVec2> {
    mantissa: P,
    exponent: i32,
}

/// Exponent difference, in powers of two, above which the smaller vector adds nothing.
const NEGLIGIBLE: i32 = 200;

impl<P: Point> Far<P> {
    pub(super) const ZERO: Self = Self {
        mantissa: P::ZERO,
        exponent: 0,
    };

    pub(super) fn new(vector: P) -> Self {
        Self {
            mantissa: vector,
            exponent: 0,
        }
        .normalised()
    }

    /// Returns a horizontal vector that represents a length.
    pub(super) fn of_length(length: f64) -> Self {
        Self::new(P::AXES[0] * length.abs())
    }

    fn normalised(self) -> Self {
        if self.is_zero() {
            return Self::ZERO;
        }
        let by = exponent(self.mantissa.abs().max_element());
        Self {
            mantissa: shifted(self.mantissa, -by),
            exponent: self.exponent.saturating_add(by),
        }
    }

    pub(super) fn is_zero(self) -> bool {
        self.mantissa == P::ZERO
    }

    pub(super) fn is_finite(self) -> bool {
        self.mantissa.is_finite()
    }

    /// Returns the sum of two vectors.
    pub(super) fn plus(self, other: Self) -> Self {
        if other.is_zero() || self.exponent < other.exponent && !self.is_zero() {
            return if other.is_zero() {
                self
            } else {
                other.plus(self)
            };
        }
        if self.is_zero() {
            return other;
        }
        let by = (other.exponent - self.exponent).max(-NEGLIGIBLE);
        Self {
            mantissa: self.mantissa + shifted(other.mantissa, by),
            ..self
        }
        .normalised()
    }

    /// Returns a multiple.
    pub(super) fn times(self, factor: f64) -> Self {
        // Normalising the factor first keeps the product of mantissas from underflow.
        let factor = Self::of_length(factor).signed(factor);
        Self {
            mantissa: self.mantissa * factor.mantissa.coordinates()[0],
            exponent: self.exponent.saturating_add(factor.exponent),
        }
        .normalised()
    }

    fn signed(self, like: f64) -> Self {
        Self {
            mantissa: self.mantissa * like.signum(),
            ..self
        }
    }

    /// Returns the image under an isometry.
    pub(super) fn turned(self, turn: impl FnOnce(P) -> P) -> Self {
        Self {
            mantissa: turn(self.mantissa),
            ..self
        }
        .normalised()
    }

    pub(super) fn length(self) -> Self {
        Self {
            mantissa: P::AXES[0] * self.mantissa.length(),
            ..self
        }
        .normalised()
    }

    /// Returns the greater of two lengths.
    pub(super) fn longer(self, other: Self) -> Self {
        let key = |far: Self| (!far.is_zero(), far.exponent, far.mantissa.coordinates()[0]);
        if key(self) < key(other) { other } else { self }
    }

    /// Returns the multiple by a power of two.
    pub(super) fn shifted(self, by: i32) -> Self {
        Self {
            exponent: self.exponent.saturating_add(by),
            ..self
        }
    }

    /// Returns the approximate number of bits by which a length exceeds another; 0 if either is 0.
    pub(super) fn bits_beyond(self, other: Self) -> i32 {
        let longer = !self.is_zero() && !other.is_zero();
        if longer {
            self.exponent.saturating_sub(other.exponent)
        } else {
            0
        }
    }

    /// Returns a length as a multiple of another.
    pub(super) fn ratio(self, unit: Self) -> f64 {
        self.over(unit).coordinates()[0]
    }

    /// Returns the vector as a multiple of a length.
    pub(super) fn over(self, unit: Self) -> P {
        let by = self.exponent.saturating_sub(unit.exponent);
        shifted(self.mantissa / unit.mantissa.coordinates()[0], by)
    }
}

/// Multiplies a vector by a power of two.
fn shifted<P: Point>(vector: P, by: i32) -> P {
    vector.map(|value| scaled(value, by))
}

/// Number of the bits of a double's mantissa that it stores.
const STORED: u32 = 52;

/// Returns the biased exponent of a double, if it is a normal number.
fn biased(value: f64) -> Option<i32> {
    let biased = (value.to_bits() >> STORED) & 0x7ff;
    i32::try_from(biased)
        .ok()
        .filter(|it| (1..0x7ff).contains(it))
}

/// Returns the exponent of a double as a multiple of a number in [0.5, 1): as `libm::frexp` does, but shortly for normal
/// numbers.
fn exponent(value: f64) -> i32 {
    biased(value).map_or_else(|| libm::frexp(value).1, |biased| biased - 1022)
}

/// Multiplies a double by a power of two: as `libm::ldexp` does, but shortly where the number and its multiple are normal.
fn scaled(value: f64, by: i32) -> f64 {
    let power = by.checked_add(1023).filter(|it| (1..0x7ff).contains(it));
    match (biased(value), power) {
        (Some(biased), Some(power)) if (1..0x7ff).contains(&(biased + by)) => {
            value * f64::from_bits(u64::from(power.unsigned_abs()) << STORED)
        }
        _ => libm::ldexp(value, by),
    }
}

#[cfg(test)]
mod tests {
    use super::{Far, exponent, scaled};
    use crate::geometry::DVec2;

    #[test]
    fn short_ways_agree_with_the_library() {
        let values = [
            0.0,
            -0.0,
            1.0,
            -0.75,
            5e-324,
            1e-310,
            2.3e-308,
            1.7e308,
            f64::INFINITY,
        ];
        for value in values {
            assert_eq!(exponent(value), libm::frexp(value).1, "{value}");
            for by in [
                0,
                1,
                -1,
                53,
                -200,
                1000,
                -1000,
                1023,
                -1022,
                1024,
                2100,
                -2100,
                i32::MAX,
                i32::MIN,
            ] {
                let known = libm::ldexp(value, by);
                assert_eq!(scaled(value, by).to_bits(), known.to_bits(), "{value} {by}");
            }
        }
    }

    #[test]
    fn what_is_beyond_doubles_keeps_its_ratios() {
        let step = Far::new(DVec2::new(3.0, -1.0));
        let mut far = step;
        for _ in 0..2000 {
            far = far.times(1e5).plus(step);
        }
        let near = |a: f64, b: f64| (a - b).abs() < 1e-15;
        assert!(near(far.over(far.length()).length(), 1.0));
        let turned = far.turned(DVec2::perp);
        let sum = turned.plus(far).length().over(far.length());
        assert!(near(sum.x / 2f64.sqrt(), 1.0));
        assert_eq!(step.over(far.length()), DVec2::ZERO);
        let rest = far
            .plus(turned)
            .plus(far.times(-1.0))
            .plus(turned.times(-1.0));
        assert!(rest.length().over(far.length()).x < 1e-15);
        assert_eq!(far.longer(step), far);
        assert_eq!(step.times(0.0), Far::ZERO);
        assert_eq!(Far::ZERO.plus(step), step);
        assert_eq!(
            Far::<DVec2>::of_length(-6.0).over(Far::of_length(1.5)),
            DVec2::new(4.0, 0.0)
        );
    }
}
