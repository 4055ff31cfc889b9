//! Placements of space on pictures.

use crate::geometry::{DAffine3, DVec3};

use super::buffer::SAMPLES;

/// Map of view coordinates to samples of the picture.
#[derive(Clone, Copy, Debug)]
pub(super) enum Projection {
    /// z is measured in samples too; y runs down.
    Parallel,
    /// Coordinates are relative to the viewer: x to the right, y down, z against the direction of view, in units
    /// of the model. A point is seen at `middle` + `focus` · (x, y) / −z.
    Central {
        /// Samples a unit at distance 1.
        focus: f64,
        /// Position of the axis of view, in samples.
        middle: [f64; 2],
    },
}

/// Placement of space on a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    /// Map of space to the coordinates of the projection.
    pub(super) map: DAffine3,
    pub(super) projection: Projection,
    /// Least and greatest z of what is shown: the far and the near end.
    pub(super) range: [f64; 2],
    /// Width and height in pixels.
    pub(super) size: [u32; 2],
}

/// The middle of a picture, and the directions in which it moves.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(
    not(feature = "cli"),
    expect(dead_code, reason = "the studio moves pictures by it")
)]
pub(crate) struct Sight {
    /// Point in the middle: that at which the camera looks, or else one halfway between the near and the far end.
    pub(crate) middle: DVec3,
    /// Vectors to the right and upwards through that point, as long as the picture is wide there.
    pub(crate) across: [DVec3; 2],
}

impl Placement {
    /// Returns what lies in the middle of the picture, at the distance of a point if one is given.
    pub(super) fn sight(&self, look_at: Option<DVec3>) -> Sight {
        #[expect(clippy::cast_precision_loss, reason = "there are few samples a pixel")]
        let [width, height] = self.size.map(|side| f64::from(side) * SAMPLES as f64);
        let inverse = self.map.inverse();
        let z = look_at.map(|point| self.map.transform_point3(point).z);
        let z = z.unwrap_or(f64::midpoint(self.range[0], self.range[1]));
        let (middle, across) = match self.projection {
            Projection::Parallel => (DVec3::new(width / 2.0, height / 2.0, z), width),
            Projection::Central { focus, middle } => {
                let unit = -z / focus;
                let [x, y] = [width / 2.0 - middle[0], height / 2.0 - middle[1]];
                (DVec3::new(x * unit, y * unit, z), width * unit)
            }
        };
        Sight {
            middle: inverse.transform_point3(middle),
            across: [DVec3::X, DVec3::NEG_Y].map(|axis| inverse.matrix3 * (axis * across)),
        }
    }

    /// Returns the number of samples a unit, in perspective at the middle of what is shown.
    pub(super) fn scale(&self) -> f64 {
        match self.projection {
            Projection::Parallel => self.map.matrix3.row(2).length(),
            Projection::Central { focus, .. } => {
                focus / -f64::midpoint(self.range[0], self.range[1])
            }
        }
    }
}
