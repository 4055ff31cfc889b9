//! Affine maps of the plane and of space: what is common to both.

use std::fmt::Debug;
use std::ops::Mul;

use glam::{DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3};

use super::{Linear, Point};

/// An affine map: [`DAffine2`] of the plane, [`DAffine3`] of space.
pub trait Affine:
    Copy + Debug + Default + PartialEq + Send + Sync + Mul<Output = Self> + 'static
{
    /// The points that the map moves.
    type Point: Point;
    /// The linear part of the map.
    type Linear: Linear<Point = Self::Point>;

    /// The identity.
    const IDENTITY: Self;

    /// Creates a map from its linear part and the image of the origin.
    #[must_use]
    fn new(linear: Self::Linear, translation: Self::Point) -> Self;

    /// Returns the linear part.
    #[must_use]
    fn linear(&self) -> Self::Linear;

    /// Returns the image of the origin.
    #[must_use]
    fn translation(&self) -> Self::Point;

    /// Returns the image of a point.
    #[must_use]
    fn apply(&self, point: Self::Point) -> Self::Point;

    /// Returns the inverse; its numbers are not finite for a singular map.
    #[must_use]
    fn inverse(&self) -> Self;

    /// Returns whether all numbers are finite.
    #[must_use]
    fn is_finite(&self) -> bool;

    /// Returns whether the numbers of two maps differ by no more than a tolerance.
    #[must_use]
    fn is_near(&self, other: &Self, tolerance: f64) -> bool;

    /// Returns the map as one of space: of the plane z = 0, where the third direction is scaled as by a
    /// similarity.
    #[must_use]
    fn in_space(&self) -> DAffine3;

    /// Returns the restriction of a map of space that keeps the plane z = 0, where this is a map of the plane.
    #[must_use]
    fn of_space(map: &DAffine3) -> Self;
}

/// Implements what the maps of the `glam` crate have, by the names that depend on the dimension: of the linear part,
/// the constructor and the image of a point.
macro_rules! by_glam {
    ($linear:ident, $new:ident, $apply:ident) => {
        const IDENTITY: Self = Self::IDENTITY;

        #[inline]
        fn new(linear: Self::Linear, translation: Self::Point) -> Self {
            Self::$new(linear, translation)
        }

        #[inline]
        fn linear(&self) -> Self::Linear {
            self.$linear
        }

        #[inline]
        fn translation(&self) -> Self::Point {
            self.translation
        }

        #[inline]
        fn apply(&self, point: Self::Point) -> Self::Point {
            self.$apply(point)
        }

        fn inverse(&self) -> Self {
            Self::inverse(self)
        }

        fn is_finite(&self) -> bool {
            self.is_finite()
        }

        #[inline]
        fn is_near(&self, other: &Self, tolerance: f64) -> bool {
            self.abs_diff_eq(*other, tolerance)
        }
    };
}

impl Affine for DAffine2 {
    type Point = DVec2;
    type Linear = DMat2;

    by_glam!(matrix2, from_mat2_translation, transform_point2);

    fn in_space(&self) -> DAffine3 {
        let DMat2 { x_axis, y_axis } = self.matrix2;
        let across = self.matrix2.mean_ratio();
        DAffine3 {
            matrix3: DMat3::from_cols(x_axis.extend(0.0), y_axis.extend(0.0), DVec3::Z * across),
            translation: self.translation.extend(0.0),
        }
    }

    fn of_space(map: &DAffine3) -> Self {
        let linear = map.matrix3;
        Self {
            matrix2: DMat2::from_cols(linear.x_axis.truncate(), linear.y_axis.truncate()),
            translation: map.translation.truncate(),
        }
    }
}

impl Affine for DAffine3 {
    type Point = DVec3;
    type Linear = DMat3;

    by_glam!(matrix3, from_mat3_translation, transform_point3);

    fn in_space(&self) -> DAffine3 {
        *self
    }

    fn of_space(map: &DAffine3) -> Self {
        *map
    }
}
