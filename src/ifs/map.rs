use super::norm::spectral_radius;
use crate::expression::degrees::{cos, sin};
use crate::geometry::{DAffine2, DMat2, DVec2};

/// A map of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// What it is called.
    pub name: Option<String>,
    /// The map of the plane.
    pub affine: DAffine2,
    /// How often it is picked, relative to the other maps: a positive number, for all maps or none.
    pub weight: Option<f64>,
}

impl Map {
    /// A map without name and weight.
    #[must_use]
    pub fn new(affine: DAffine2) -> Self {
        Self {
            name: None,
            affine,
            weight: None,
        }
    }

    /// The same with a weight.
    #[must_use]
    pub fn weighing(self, weight: f64) -> Self {
        Self {
            weight: Some(weight),
            ..self
        }
    }

    /// The point that stays where it is; `None` if there is none, or more than one.
    #[must_use]
    pub fn fixed_point(&self) -> Option<DVec2> {
        fixed_point(&self.affine)
    }

    /// Whether all points come together when it is applied over and over.
    #[must_use]
    pub fn contracts(&self) -> bool {
        spectral_radius(self.affine.matrix2) < 1.0
    }
}

pub(super) fn fixed_point(affine: &DAffine2) -> Option<DVec2> {
    let moving = DMat2::IDENTITY - affine.matrix2;
    let (x, y) = (moving.x_axis, moving.y_axis);
    let area = x.perp_dot(y);
    // By Cramer's rule; the area is what rounding leaves of zero where the columns are parallel.
    if area.abs() <= 1e-15 * x.length() * y.length() {
        return None;
    }
    let shift = affine.translation;
    let point = DVec2::new(shift.perp_dot(y), x.perp_dot(shift)) / area;
    point.is_finite().then_some(point)
}

/// The linear map that scales the x and the y axis, then turns each by its own angle, in degrees and
/// counter-clockwise (Demko, Hodges & Naylor 1985, section 4.3).
///
/// (1, 0) goes to s_x (cos α, sin α) and (0, 1) to s_y (−sin β, cos β), so that equal angles rotate.
#[must_use]
pub fn axes(scale: DVec2, angles: DVec2) -> DMat2 {
    DMat2::from_cols(
        scale.x * DVec2::new(cos(angles.x), sin(angles.x)),
        scale.y * DVec2::new(-sin(angles.y), cos(angles.y)),
    )
}

/// A linear map about a point that stays where it is: x → c + L (x − c).
#[must_use]
pub fn about(linear: DMat2, centre: DVec2) -> DAffine2 {
    DAffine2::from_mat2_translation(linear, centre - linear * centre)
}

/// z → s z + t in complex numbers.
#[must_use]
pub fn complex(s: DVec2, t: DVec2) -> DAffine2 {
    DAffine2::from_cols(s, s.perp(), t)
}

/// z → s conj z + t in complex numbers.
#[must_use]
pub fn complex_conjugate(s: DVec2, t: DVec2) -> DAffine2 {
    DAffine2::from_cols(s, -s.perp(), t)
}

/// x → f x + (1 − f) v: what is left of the way to the vertex v is the shrink factor f (Jones & Campa
/// 1992, algorithm 3). f = 1/2 goes half the way, f = 1/3 two thirds of it.
#[must_use]
pub fn toward(vertex: DVec2, factor: f64) -> DAffine2 {
    about(DMat2::from_diagonal(DVec2::splat(factor)), vertex)
}
