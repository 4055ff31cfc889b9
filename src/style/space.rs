//! Views of sets in space, as files and command lines give them.

use crate::geometry::{DVec3, HalfSpace};

use super::{Camera, Light, Shade, Slice};

/// The view of a set in space: what is given of the camera, the shading and the light, and the part that is shown.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SpaceView {
    /// Azimuth and elevation of the viewer, in degrees, as of [`Camera::from`].
    pub from: Option<[f64; 2]>,
    /// Vector that points upwards in the picture.
    pub up: Option<DVec3>,
    /// Point in the middle of the picture.
    pub look_at: Option<DVec3>,
    /// Angle of view in degrees; parallel without it.
    pub perspective: Option<f64>,
    /// Slab to which the picture is confined.
    pub slice: Option<Slice>,
    /// Half-spaces to which the picture is confined.
    pub cuts: Vec<HalfSpace>,
    /// Shading.
    pub shade: Option<Shade>,
    /// Azimuth and elevation of the light, in degrees.
    pub light: Option<[f64; 2]>,
    /// Intensity of what the light does not reach, from 0 to 1.
    pub ambient: Option<f64>,
    /// Whether what is enclosed by its surroundings is darker.
    pub occlusion: Option<bool>,
    /// Whether the set throws shadows on itself.
    pub shadows: Option<bool>,
}

impl SpaceView {
    /// Returns the view with what is not given taken from another one. A slice is seen along its own normal, unless the
    /// direction of view is given with it.
    #[must_use]
    pub fn or(self, other: &Self) -> Self {
        let from = match self.slice {
            Some(_) => self.from,
            None => self.from.or(other.from),
        };
        Self {
            from,
            up: self.up.or(other.up),
            look_at: self.look_at.or(other.look_at),
            perspective: self.perspective.or(other.perspective),
            slice: self.slice.or(other.slice),
            cuts: match self.cuts.is_empty() {
                true => other.cuts.clone(),
                false => self.cuts,
            },
            shade: self.shade.or(other.shade),
            light: self.light.or(other.light),
            ambient: self.ambient.or(other.ambient),
            occlusion: self.occlusion.or(other.occlusion),
            shadows: self.shadows.or(other.shadows),
        }
    }

    /// Returns the direction of view: the one given, that in which a slice is seen face-on, or the default.
    #[must_use]
    pub fn direction(&self) -> [f64; 2] {
        let face_on = self.slice.map(|slice| slice.from());
        let given = self.from.or(face_on);
        given.unwrap_or(Camera::default().from)
    }

    /// Returns the camera.
    #[must_use]
    pub fn camera(&self) -> Camera {
        Camera::default()
            .from(self.direction())
            .up(self.up)
            .look_at(self.look_at)
            .perspective(self.perspective)
    }

    /// Returns the light. Faces that are shaded by the cosine alone are black where it does not reach them, unless an ambient
    /// intensity is given.
    #[must_use]
    pub fn light(&self) -> Light {
        let light = match self.shade {
            // As in the paper.
            Some(Shade::Cosine) => Light::default().ambient(0.0),
            _ => Light::default(),
        };
        light
            .from(self.light.unwrap_or(light.from))
            .ambient(self.ambient.unwrap_or(light.ambient))
    }
}
