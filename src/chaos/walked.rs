//! Affine maps that a walk applies, in the plane and in space.

use std::fmt::Debug;

use crate::geometry::{DAffine2, DAffine3, DMat3, DVec2, DVec3};
use crate::ifs::{AffineMap, PointOf};

use super::random::Scalar;
use super::sampler::Sampler;
use super::solids::SolidSampler;

/// Affine map of a chaos game: [`DAffine2`] of the plane, [`DAffine3`] of space.
pub trait ChaosMap: AffineMap {
    /// Sampler of points of condensation sets.
    type Sampler: SetSampler<Self>;

    /// Bound of the roundings of a coordinate of an image, in units of its terms: a coefficient, a product, and
    /// the sums.
    const ROUNDINGS: f64;

    /// Returns the image of a vector.
    #[must_use]
    fn apply_vector(&self, vector: PointOf<Self>) -> PointOf<Self>;

    /// Returns the map whose entries are the absolute values of those of this one.
    #[must_use]
    fn abs(&self) -> Self;

    /// Returns the inverse, whose entries are not finite if the map has none.
    #[must_use]
    fn inverted(&self) -> Self;
}

/// Uniform sampling of the points of a set.
pub trait SetSampler<M: AffineMap>: Clone + Debug + PartialEq + Send + Sync + Sized {
    /// Creates the sampler of a set; `None` if points cannot be drawn from it.
    #[must_use]
    fn of_set(set: &M::Set) -> Option<Self>;

    /// Draws a point.
    #[must_use]
    fn sample(&self, random: &mut Scalar) -> PointOf<M>;
}

impl ChaosMap for DAffine2 {
    type Sampler = Sampler;

    const ROUNDINGS: f64 = 4.0;

    fn apply_vector(&self, vector: DVec2) -> DVec2 {
        self.matrix2 * vector
    }

    fn abs(&self) -> Self {
        Self::from_mat2_translation(self.matrix2.abs(), self.translation.abs())
    }

    fn inverted(&self) -> Self {
        self.inverse()
    }
}

impl ChaosMap for DAffine3 {
    type Sampler = SolidSampler;

    const ROUNDINGS: f64 = 5.0;

    fn apply_vector(&self, vector: DVec3) -> DVec3 {
        self.matrix3 * vector
    }

    fn abs(&self) -> Self {
        let linear = &self.matrix3;
        let linear = [linear.x_axis, linear.y_axis, linear.z_axis].map(DVec3::abs);
        let linear = DMat3::from_cols(linear[0], linear[1], linear[2]);
        Self::from_mat3_translation(linear, self.translation.abs())
    }

    fn inverted(&self) -> Self {
        self.inverse()
    }
}
