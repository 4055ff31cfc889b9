//! Affine maps of an iterated function system, and constructors for common notations of them.

use super::{AffineMap, PointOf};
use crate::expression::{AffineOf, Arithmetic, Doubles};
use crate::geometry::{DAffine2, DMat2, DVec2, Linear};
use crate::instancing::Tint;

/// A map of a system.
#[derive(Clone, Debug, PartialEq)]
pub struct Map<M = DAffine2> {
    /// Name of the map, if it has one.
    pub name: Option<String>,
    /// The map of the plane or of space.
    pub affine: M,
    /// Weight of the map in random iteration, relative to the other maps: positive. Either all maps have one,
    /// or none.
    pub weight: Option<f64>,
    /// Tint of the images under the map, which applies again at every step.
    pub tint: Option<Tint>,
}

impl<M: AffineMap> Map<M> {
    /// Returns a map without name, weight and tint.
    #[must_use]
    pub fn new(affine: M) -> Self {
        Self {
            name: None,
            affine,
            weight: None,
            tint: None,
        }
    }

    /// Returns the map with a weight.
    #[must_use]
    pub fn weighing(self, weight: f64) -> Self {
        Self {
            weight: Some(weight),
            ..self
        }
    }

    /// Returns the fixed point of the map; `None` if there is none, or more than one.
    #[must_use]
    pub fn fixed_point(&self) -> Option<PointOf<M>> {
        self.affine.fixed_point()
    }

    /// Returns whether the map contracts when it is iterated: whether the spectral radius of its linear part
    /// is below 1.
    #[must_use]
    pub fn contracts(&self) -> bool {
        self.affine.linear().spectral_radius() < 1.0
    }
}

/// Returns the linear map that scales the x and the y axis, then rotates each by its own angle, in degrees
/// and counter-clockwise (Demko, Hodges & Naylor 1985, section 4.3).
///
/// The image of (1, 0) is s_x (cos α, sin α) and that of (0, 1) is s_y (−sin β, cos β), so that equal angles
/// rotate.
#[must_use]
pub fn axes(scale: DVec2, angles: DVec2) -> DMat2 {
    let turns = angles.to_array().map(|angle| Doubles.turn(&angle));
    let map = AffineOf::turned_axes(&mut Doubles, &scale.to_array(), turns.each_ref());
    DAffine2::from(map).matrix2
}

/// Returns the map x → c + L (x − c) with a linear part L and a fixed point c.
#[must_use]
pub fn about(linear: DMat2, centre: DVec2) -> DAffine2 {
    DAffine2::from_mat2_translation(linear, centre - linear * centre)
}

/// Returns the map z → s z + t of complex numbers.
#[must_use]
pub fn complex(s: DVec2, t: DVec2) -> DAffine2 {
    DAffine2::from_cols(s, s.perp(), t)
}

/// Returns the map z → s conj z + t of complex numbers.
#[must_use]
pub fn complex_conjugate(s: DVec2, t: DVec2) -> DAffine2 {
    DAffine2::from_cols(s, -s.perp(), t)
}

/// Returns the map x → f x + (1 − f) v, which moves points toward the vertex v (Jones & Campa 1992, algorithm
/// 3). The factor f is the part of the distance to v that remains: f = 1/2 goes half of the way, f = 1/3 two
/// thirds of it.
#[must_use]
pub fn toward(vertex: DVec2, factor: f64) -> DAffine2 {
    about(DMat2::from_diagonal(DVec2::splat(factor)), vertex)
}
