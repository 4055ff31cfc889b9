//! Placements of space on pictures.

use crate::geometry::DAffine3;

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

impl Placement {
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
