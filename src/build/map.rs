//! Builder of affine maps.

use crate::document::node::Value;
use crate::geometry::DAffine2;

use super::written::{Entries, sequence};
use super::{NumberText, PointText};

/// An affine map of the plane.
#[derive(Clone, Debug)]
#[must_use]
pub struct MapBuilder {
    pub(super) entries: Entries,
    pub(super) name: Option<String>,
}

impl MapBuilder {
    fn new(key: &str, value: Value) -> Self {
        Self {
            entries: Entries::default().set(key, value),
            name: None,
        }
    }

    fn set(self, key: &str, value: Value) -> Self {
        Self {
            entries: self.entries.set(key, value),
            ..self
        }
    }

    /// Creates a linear map from the rows of its matrix: [x, y] is mapped to [a x + b y, c x + d y].
    pub fn matrix(rows: [impl Into<PointText>; 2]) -> Self {
        Self::new("matrix", sequence(rows.map(|row| row.into().0)))
    }

    /// Creates a scaling by a factor.
    pub fn scale(factor: impl Into<NumberText>) -> Self {
        Self::new("scale", factor.into().0)
    }

    /// Creates a scaling along x and y, by one factor each.
    pub fn scales(factors: impl Into<PointText>) -> Self {
        Self::new("scale", factors.into().0)
    }

    /// Creates a multiplication by a complex number, given by its real and imaginary part.
    pub fn times(factor: impl Into<PointText>) -> Self {
        Self::new("times", factor.into().0)
    }

    /// Applies complex conjugation before the multiplication of a map created by [`MapBuilder::times`].
    pub fn conjugate(self) -> Self {
        self.set("conjugate", Value::Bool(true))
    }

    /// Sets the rotation that follows the scaling, by an angle in degrees, counter-clockwise.
    pub fn rotate(self, angle: impl Into<NumberText>) -> Self {
        self.set("rotate", angle.into().0)
    }

    /// Sets the rotations of the images of the x axis and of the y axis, by one angle in degrees each.
    pub fn rotate_axes(self, angles: impl Into<PointText>) -> Self {
        self.set("rotate", angles.into().0)
    }

    /// Sets the translation that is added last.
    pub fn translate(self, translation: impl Into<PointText>) -> Self {
        self.set("translate", translation.into().0)
    }

    /// Sets the fixed point of the map, as an alternative to a translation.
    pub fn fixed(self, point: impl Into<PointText>) -> Self {
        self.set("fixed", point.into().0)
    }

    /// Sets the relative probability with which random iteration picks the map.
    pub fn weight(self, weight: impl Into<NumberText>) -> Self {
        self.set("weight", weight.into().0)
    }

    /// Sets the name. A map without a name is referred to by its number, from 1.
    pub fn name(self, name: impl Into<String>) -> Self {
        Self {
            name: Some(name.into()),
            ..self
        }
    }
}

impl From<DAffine2> for MapBuilder {
    fn from(map: DAffine2) -> Self {
        let rows = map.matrix2.transpose();
        Self::matrix([rows.x_axis, rows.y_axis]).translate(map.translation)
    }
}
