//! Slices: slabs to which pictures in space are confined.

use crate::geometry::{DVec3, HalfSpace};

/// A slab between two parallel planes, to which a picture is confined.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Slice {
    /// Vector across the slab, towards the viewer of [`from`](Self::from).
    pub normal: DVec3,
    /// Value of `normal` · x in its middle.
    pub offset: f64,
    /// Thickness in units; a section, one pixel thick, if `None`.
    pub thickness: Option<f64>,
}

impl Slice {
    /// Creates a section: the points x with `normal` · x = `offset`.
    #[must_use]
    pub fn new(normal: DVec3, offset: f64) -> Self {
        Self {
            normal,
            offset,
            thickness: None,
        }
    }

    /// Returns azimuth and elevation, in degrees, from which the slab is seen face-on.
    #[must_use]
    pub fn from(&self) -> [f64; 2] {
        let [x, y, z] = self.normal.to_array();
        [
            libm::atan2(x, z).to_degrees(),
            libm::atan2(y, libm::hypot(x, z)).to_degrees(),
        ]
    }

    /// Returns the half-spaces whose intersection is the slab of a thickness.
    pub(crate) fn half_spaces(&self, thickness: f64) -> [HalfSpace; 2] {
        let half = thickness / 2.0 * self.normal.length();
        [1.0, -1.0].map(|side| HalfSpace {
            normal: self.normal * side,
            distance: self.offset * side + half,
        })
    }
}

setters!(Slice {
    normal: DVec3,
    offset: f64,
    thickness: Option<f64>,
});
