//! Points and vectors of the plane or of space, for code that is generic over the dimension.

use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{DVec2, DVec3};

/// A point or a vector: [`DVec2`] in the plane, [`DVec3`] in space.
pub trait Point:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + 'static
{
    /// The origin.
    const ZERO: Self;
    /// The point whose coordinates are all +∞.
    const INFINITY: Self;
    /// The point whose coordinates are all −∞.
    const NEG_INFINITY: Self;
    /// The number of coordinates.
    const DIMENSION: usize;
    /// The unit vectors along the axes and against them: x, −x, y, −y and so on.
    const AXES: &'static [Self];

    /// Returns the point whose coordinates all have one value.
    #[must_use]
    fn splat(value: f64) -> Self;
    /// Creates the point with the first of three coordinates.
    #[must_use]
    fn of_coordinates(coordinates: [f64; 3]) -> Self;
    /// Returns the coordinates, completed by zeros.
    #[must_use]
    fn coordinates(self) -> [f64; 3];
    /// Returns the point with the smaller value of each coordinate.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// Returns the point with the larger value of each coordinate.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// Returns the point with the absolute values of the coordinates.
    #[must_use]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    /// Returns the largest coordinate.
    #[must_use]
    fn max_element(self) -> f64;
    /// Returns the point whose coordinates are the values of a function at those of this one.
    #[must_use]
    fn map(self, function: impl Fn(f64) -> f64) -> Self;
    /// Returns the vector of length 1 in the same direction; zero if there is none.
    #[must_use]
    fn normalize_or_zero(self) -> Self;
    /// Returns the scalar product.
    #[must_use]
    fn dot(self, other: Self) -> f64;
    /// Returns the length of the vector.
    #[must_use]
    fn length(self) -> f64 {
        self.dot(self).sqrt()
    }
    /// Returns `true` if no coordinate is infinite or NaN.
    #[must_use]
    fn is_finite(self) -> bool {
        self.coordinates().iter().all(|value| value.is_finite())
    }
    /// Returns the signed area of the triangle with the origin and another point; `None` in space, where a
    /// closed path encloses no area.
    #[must_use]
    fn triangle(self, other: Self) -> Option<f64>;
}

/// Implements [`WrittenPoint`] for a vector type with methods of the same names.
macro_rules! point {
    ($vector:ident, $dimension:literal, [$($axis:ident),*], $triangle:expr) => {
        impl Point for $vector {
            const ZERO: Self = Self::ZERO;
            const INFINITY: Self = Self::INFINITY;
            const NEG_INFINITY: Self = Self::NEG_INFINITY;
            const DIMENSION: usize = $dimension;
            const AXES: &'static [Self] = &[$(Self::$axis),*];

            #[inline]
            fn splat(value: f64) -> Self {
                Self::splat(value)
            }

            #[inline]
            fn of_coordinates(coordinates: [f64; 3]) -> Self {
                Self::from_slice(&coordinates)
            }

            #[inline]
            fn coordinates(self) -> [f64; 3] {
                let mut all = [0.0; 3];
                all[..$dimension].copy_from_slice(&self.to_array());
                all
            }

            forward! {
                min(self, other: Self) -> Self;
                max(self, other: Self) -> Self;
                max_element(self) -> f64;
                normalize_or_zero(self) -> Self;
                dot(self, other: Self) -> f64;
            }

            #[inline]
            fn map(self, function: impl Fn(f64) -> f64) -> Self {
                Self::from_array(self.to_array().map(function))
            }

            #[inline]
            fn triangle(self, other: Self) -> Option<f64> {
                let of: fn(Self, Self) -> Option<f64> = $triangle;
                of(self, other)
            }
        }
    };
}

point!(DVec2, 2, [X, NEG_X, Y, NEG_Y], |a, b| Some(
    a.perp_dot(b) / 2.0
));
point!(DVec3, 3, [X, NEG_X, Y, NEG_Y, Z, NEG_Z], |_, _| None);
