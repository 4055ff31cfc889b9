//! Shadows: a second descent, from the light, whose depths say what it reaches (Williams 1978).

use crate::geometry::{DAffine3, DVec3};

use super::buffer::SAMPLES;
use super::camera::Projection;
use super::depth_map::DepthMap;

/// Depths of a set as the light sees it.
pub(super) struct Shadows {
    seen: DepthMap,
    /// Map from the points of the picture, in view coordinates, to those of the light.
    to_light: DAffine3,
    /// Size of a pixel of the picture, relative to one of the light.
    coarse: f64,
    is_parallel: bool,
}

/// Greatest slope of a surface against the light for which its own depths are not shadows.
const STEEPEST: f64 = 8.0;

impl Shadows {
    /// Creates shadows in a picture. `seen` are the depths from the light, in a parallel view.
    pub(super) fn new(seen: DepthMap, picture: &DepthMap) -> Self {
        let placement = picture.placement();
        // View coordinates run upwards, those of pictures downwards.
        let flip = DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
        let is_parallel = matches!(placement.projection, Projection::Parallel);
        Self {
            to_light: flip * seen.placement().map * placement.map.inverse() * flip,
            coarse: seen.placement().scale() / placement.scale(),
            seen,
            is_parallel,
        }
    }

    /// Returns the share of the light that reaches a point of the picture, given in view coordinates, from 0 to 1. `cosine`
    /// is that of the angle between the light and the surface.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "pictures are small"
    )]
    pub(super) fn reach(&self, point: DVec3, cosine: f64) -> f64 {
        let at = self.to_light.transform_point3(point);
        let slope = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine.max(1e-3);
        let size = SAMPLES as f64 * (1.0 + if self.is_parallel { self.coarse } else { 1.0 });
        let least = at.z + size * (1.0 + slope.min(STEEPEST));
        let pixel = [at.x, -at.y].map(|at| (at / SAMPLES as f64).floor() as isize);
        let mut reached = 0;
        for down in -1..=1 {
            for right in -1..=1 {
                let near = [pixel[0] + right, pixel[1] + down];
                let [x, y] = near.map(|at| usize::try_from(at).unwrap_or(usize::MAX));
                let before = self.seen.point(x, y).is_some_and(|seen| seen.z > least);
                reached += u32::from(!before);
            }
        }
        f64::from(reached) / 9.0
    }
}
