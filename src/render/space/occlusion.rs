//! Ambient occlusion: what is enclosed by its surroundings is darker.

use crate::geometry::DVec3;

use super::buffer::SAMPLES;
use super::camera::{Placement, Projection};
use super::depth_map::DepthMap;

/// Columns and rows of the directions to one side of a pixel in which surroundings are looked at; those to the other side
/// are opposite. Multiples of them are pixels, so that what is seen of a plane lies on a line.
const DIRECTIONS: [[isize; 2]; 8] = [
    [1, 0],
    [2, 1],
    [1, 1],
    [1, 2],
    [0, 1],
    [-1, 2],
    [-1, 1],
    [-2, 1],
];

/// Share of the long side of the picture within which surroundings occlude a pixel.
const REACH: f64 = 1.0 / 8.0;

/// Ratio of the distances at which surroundings are looked at.
const RATIO: f64 = 1.7;

/// The pixels around each that are looked at.
pub(super) struct Occlusion<'a> {
    depths: &'a DepthMap,
    /// Columns and rows to pixels, from near to far, in every direction and then in the opposite one.
    rays: Vec<[Vec<[isize; 2]>; 2]>,
    /// Distance within which surroundings count, in view coordinates at distance 1 of a picture in perspective.
    reach: f64,
}

impl<'a> Occlusion<'a> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        reason = "pictures are small"
    )]
    pub(super) fn new(depths: &'a DepthMap) -> Self {
        let Placement {
            size: [width, height],
            projection,
            ..
        } = depths.placement();
        let pixels = (f64::from(*width.max(height)) * REACH).max(2.0);
        let ray = |direction: [isize; 2], side: isize| {
            let away = direction.map(|part| part as f64);
            let most = pixels / away[0].hypot(away[1]);
            let distances = std::iter::successors(Some(1.0), |away| Some(away * RATIO));
            let distances = distances.take_while(|away| *away <= most.max(1.0));
            let at = |away: f64| direction.map(|part| side * part * away.round() as isize);
            distances.map(at).collect::<Vec<_>>()
        };
        Self {
            depths,
            rays: DIRECTIONS
                .map(|direction| [1, -1].map(|side| ray(direction, side)))
                .to_vec(),
            reach: pixels * SAMPLES as f64
                / match projection {
                    Projection::Parallel => 1.0,
                    Projection::Central { focus, .. } => *focus,
                },
        }
    }

    /// Returns the share of the surroundings of a pixel that is open, from 0 to 1, by the horizons on both sides of it
    /// (Bavoil, Sainz & Dimitrov 2008).
    ///
    /// The two horizons on a line across a plane cancel, so that a plane is open from any direction of view.
    #[expect(clippy::cast_precision_loss, reason = "there are few rays")]
    pub(super) fn openness(&self, x: usize, y: usize) -> f64 {
        let Some(own) = self.depths.point(x, y) else {
            return 1.0;
        };
        let reach = match self.depths.placement().projection {
            Projection::Parallel => self.reach,
            Projection::Central { .. } => -own.z * self.reach,
        };
        let hidden = self.rays.iter().map(|[one, other]| {
            let sum =
                self.horizon(own, [x, y], reach, one) + self.horizon(own, [x, y], reach, other);
            (sum / 2.0).clamp(0.0, 1.0)
        });
        1.0 - hidden.sum::<f64>() / self.rays.len() as f64
    }

    /// Returns the sine of the greatest height of what is seen along a ray; what is far before the pixel does not count.
    fn horizon(&self, own: DVec3, [x, y]: [usize; 2], reach: f64, ray: &[[isize; 2]]) -> f64 {
        let mut highest: f64 = -1.0;
        for [right, down] in ray {
            let at = [x.wrapping_add_signed(*right), y.wrapping_add_signed(*down)];
            if let Some(there) = self.depths.point(at[0], at[1]) {
                let way = there - own;
                let square = way.length_squared();
                let weight = 1.0 - (square / (reach * reach)).powi(2);
                if weight > 0.0 {
                    highest = highest.max((way.z / square.sqrt() + 1.0) * weight - 1.0);
                }
            }
        }
        highest
    }
}
