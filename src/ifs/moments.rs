//! Mean and covariance of distributions of points in the plane.

use crate::geometry::{DAffine2, DMat2, DVec2};

/// Mean and covariance of a distribution of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// The mean.
    pub mean: DVec2,
    /// The covariance matrix, symmetric: the variances of x and y on its diagonal, their covariance beside
    /// it.
    pub covariance: DMat2,
}

impl Moments {
    /// Returns the moments of a distribution that is concentrated at one point.
    #[must_use]
    pub fn point(mean: DVec2) -> Self {
        Self {
            mean,
            covariance: DMat2::ZERO,
        }
    }

    /// Returns the moments of the distribution's image under a map.
    #[must_use]
    pub fn transformed(&self, map: &DAffine2) -> Self {
        let linear = map.matrix2;
        Self {
            mean: map.transform_point2(self.mean),
            covariance: linear * self.covariance * linear.transpose(),
        }
    }
}

/// Returns the matrix v vᵀ.
pub(super) fn square(v: DVec2) -> DMat2 {
    DMat2::from_cols(v * v.x, v * v.y)
}
