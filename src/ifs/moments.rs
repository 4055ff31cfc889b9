use crate::geometry::{DAffine2, DMat2, DVec2};

/// Mean and covariance of a distribution of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// The mean.
    pub mean: DVec2,
    /// The covariance matrix: variances of x and y, and their covariance twice.
    pub covariance: DMat2,
}

impl Moments {
    /// All at one point.
    #[must_use]
    pub fn point(mean: DVec2) -> Self {
        Self {
            mean,
            covariance: DMat2::ZERO,
        }
    }

    /// Those of the image under a map.
    #[must_use]
    pub fn transformed(&self, map: &DAffine2) -> Self {
        let linear = map.matrix2;
        Self {
            mean: map.transform_point2(self.mean),
            covariance: linear * self.covariance * linear.transpose(),
        }
    }
}

/// The matrix v vᵀ.
pub(super) fn square(v: DVec2) -> DMat2 {
    DMat2::from_cols(v * v.x, v * v.y)
}
