//! Shading and light of pictures in space.

use crate::geometry::DVec3;

use super::Named;
use super::camera::direction;

/// Shading of sets in space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Shade {
    /// Depth cueing (Jones & Campa 1992): the intensity falls linearly from the nearest point of the set to its
    /// farthest.
    #[default]
    Depth,
    /// The cosine of the angle between the light and the normals of faces (Kaandorp 1987, section 2.4); the relief of a set
    /// that has no faces.
    Cosine,
    /// The cosine of the angle between the light and normals that are taken from neighbouring depths.
    Relief,
    /// Depth cueing, times the cosine.
    Both,
    /// None: colours alone.
    None,
}

impl Named for Shade {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("depth", Self::Depth),
        ("cosine", Self::Cosine),
        ("relief", Self::Relief),
        ("both", Self::Both),
        ("none", Self::None),
    ];
}

/// Light for cosine and relief.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Light {
    /// Azimuth and elevation of the light, in degrees; 20 and 50 by default.
    pub from: [f64; 2],
    /// Intensity of what the light does not reach, from 0 to 1; 0.15 by default.
    pub ambient: f64,
}

setters!(Light {
    from: [f64; 2],
    ambient: f64,
});

impl Default for Light {
    fn default() -> Self {
        Self {
            from: [20.0, 50.0],
            ambient: 0.15,
        }
    }
}

impl Light {
    /// Returns the unit vector towards the light.
    pub(crate) fn towards(&self) -> DVec3 {
        direction(self.from)
    }

    /// Returns the intensity on a surface: `cosine` is that of the angle between its normal and the light.
    #[inline]
    pub(crate) fn intensity(&self, cosine: f64) -> f64 {
        let ambient = self.ambient.clamp(0.0, 1.0);
        ambient + (1.0 - ambient) * cosine.max(0.0)
    }
}

impl Shade {
    /// Returns whether the picture has depth cues.
    pub(crate) fn cues_depth(self) -> bool {
        matches!(self, Self::Depth | Self::Both)
    }

    /// Returns whether faces that have normals are lit by them.
    pub(crate) fn lights_faces(self) -> bool {
        matches!(self, Self::Cosine | Self::Both)
    }

    /// Returns whether the picture takes normals from depths.
    pub(crate) fn has_relief(self, has_faces: bool) -> bool {
        match self {
            Self::Relief => true,
            Self::Cosine | Self::Both => !has_faces,
            Self::Depth | Self::None => false,
        }
    }
}
