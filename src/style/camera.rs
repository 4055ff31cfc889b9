//! Cameras: directions of view, and rotations of space to view coordinates.

use crate::expression::degrees;
use crate::geometry::{DMat3, DVec3};

/// Direction of view, and the kind of projection.
///
/// The viewer looks at the set from a direction given by azimuth and elevation in degrees: azimuth 0 is in
/// front, on the side of positive z, and 90 on the right, on the side of positive x; elevation 90 is above, on
/// the side of positive y.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Camera {
    /// Azimuth and elevation of the viewer, in degrees; 30 and 25 by default.
    pub from: [f64; 2],
    /// Vector that points upwards in the picture; y by default.
    pub up: Option<DVec3>,
    /// Point in the middle of the picture; that of the projected box by default.
    pub look_at: Option<DVec3>,
    /// Angle of view across the sphere around the set, in degrees, from 1 to 150; a parallel projection if `None`.
    pub perspective: Option<f64>,
    /// Magnification relative to the picture of the whole set, about the point in the middle, from 1e-3 to 1e5; `None` shows
    /// the whole set.
    pub zoom: Option<f64>,
}

setters!(Camera {
    from: [f64; 2],
    up: Option<DVec3>,
    look_at: Option<DVec3>,
    perspective: Option<f64>,
    zoom: Option<f64>,
});

impl Default for Camera {
    fn default() -> Self {
        Self {
            from: [30.0, 25.0],
            up: None,
            look_at: None,
            perspective: None,
            zoom: None,
        }
    }
}

/// Error of a camera.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CameraError {
    /// The upward vector is parallel to the direction of view.
    #[error(
        "the upward vector points to the viewer, so nothing is up in the picture: another vector, or another \
         direction of view, is right"
    )]
    UpIsAhead,
    /// A number is not finite, or the angle of view is not between 1 and 150 degrees.
    #[error("an angle of view is a number of degrees from 1 to 150")]
    Angle,
    /// A magnification is beyond what the depths of pixels resolve.
    #[error("a zoom in space is a number from 1e-3 to 1e5")]
    Zoom,
}

impl Camera {
    /// Azimuth and elevation of views that have a name.
    pub const NAMED: [(&'static str, [f64; 2]); 4] = [
        ("front", [0.0, 0.0]),
        ("side", [90.0, 0.0]),
        ("top", [0.0, 90.0]),
        // The elevation is asin(1/√3).
        ("iso", [45.0, 35.264_389_682_754_654]),
    ];

    /// Returns the unit vector towards the viewer.
    #[must_use]
    pub fn towards(&self) -> DVec3 {
        direction(self.from)
    }

    /// Returns the rotation from space to view coordinates: x to the right, y upwards in the picture, z towards
    /// the viewer.
    pub(crate) fn rotation(&self) -> Result<DMat3, CameraError> {
        let ahead = self.towards();
        let [azimuth, elevation] = self.from;
        let (right, up) = match self.up {
            None => {
                // The limit at the poles: the azimuth keeps its meaning there.
                let (sine, cosine) = (degrees::sin(azimuth), degrees::cos(azimuth));
                let right = DVec3::new(cosine, 0.0, -sine);
                let high = degrees::sin(elevation);
                let up = DVec3::new(-sine * high, degrees::cos(elevation), -cosine * high);
                (right, up)
            }
            Some(up) => {
                let right = up.cross(ahead);
                if right.length() <= 1e-9 * up.length() || !right.is_finite() {
                    return Err(CameraError::UpIsAhead);
                }
                let right = right.normalize();
                (right, ahead.cross(right))
            }
        };
        // The inverse of a rotation is its transpose.
        Ok(DMat3::from_cols(right, up, ahead).transpose())
    }

    /// Checks the angle of view and the magnification.
    pub(crate) fn check(&self) -> Result<(), CameraError> {
        match (self.perspective, self.zoom) {
            (Some(angle), _) if !(1.0..=150.0).contains(&angle) => Err(CameraError::Angle),
            (_, Some(zoom)) if !(1e-3..=1e5).contains(&zoom) => Err(CameraError::Zoom),
            _ => Ok(()),
        }
    }
}

/// Returns the unit vector of an azimuth and an elevation in degrees.
pub(crate) fn direction([azimuth, elevation]: [f64; 2]) -> DVec3 {
    let level = degrees::cos(elevation);
    DVec3::new(
        degrees::sin(azimuth) * level,
        degrees::sin(elevation),
        degrees::cos(azimuth) * level,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn named_views_have_exact_axes() {
        let seen = |name: &str| {
            let named = Camera::NAMED.iter().find(|(known, _)| *known == name);
            let camera = Camera::default().from(named.unwrap().1);
            camera.rotation().unwrap()
        };
        assert_eq!(seen("front"), DMat3::IDENTITY);
        let side = seen("side");
        assert_eq!([side * DVec3::X, side * DVec3::Y], [DVec3::Z, DVec3::Y]);
        assert_eq!(side * DVec3::Z, DVec3::NEG_X);
        let top = seen("top");
        assert_eq!([top * DVec3::X, top * DVec3::Y], [DVec3::X, DVec3::Z]);
        assert_eq!(top * DVec3::Z, DVec3::NEG_Y);
        let diagonal = seen("iso") * DVec3::ONE;
        assert!(diagonal.abs_diff_eq(DVec3::Z * 3f64.sqrt(), 1e-14));
    }

    #[test]
    fn an_upward_vector_ahead_is_an_error() {
        let camera = Camera::default().from([0.0, 90.0]).up(Some(DVec3::Y));
        assert_eq!(camera.rotation(), Err(CameraError::UpIsAhead));
        let turned = camera.up(Some(DVec3::X)).rotation().unwrap();
        assert!((turned * DVec3::X).abs_diff_eq(DVec3::Y, 1e-15));
    }
}
