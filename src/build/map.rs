//! Maps of systems.

use crate::document::node::Value;
use crate::geometry::DAffine2;

use super::written::{Entries, sequence};
use super::{Number, Point};

/// An affine map of the plane.
#[derive(Clone, Debug)]
#[must_use]
pub struct Map {
    pub(super) entries: Entries,
    pub(super) name: Option<String>,
}

impl Map {
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

    /// By the rows of a matrix: [x, y] goes to [a x + b y, c x + d y].
    pub fn matrix(rows: [impl Into<Point>; 2]) -> Self {
        Self::new("matrix", sequence(rows.map(|row| row.into().0)))
    }

    /// Everything is scaled by a factor.
    pub fn scale(factor: impl Into<Number>) -> Self {
        Self::new("scale", factor.into().0)
    }

    /// The x axis and the y axis are scaled, each by its factor.
    pub fn scales(factors: impl Into<Point>) -> Self {
        Self::new("scale", factors.into().0)
    }

    /// The plane is taken times a complex number: its real and its imaginary part.
    pub fn times(factor: impl Into<Point>) -> Self {
        Self::new("times", factor.into().0)
    }

    /// The conjugate is taken first, of a map that [takes times](Map::times).
    pub fn conjugate(self) -> Self {
        self.set("conjugate", Value::Bool(true))
    }

    /// Both axes are turned after they have been scaled, by an angle in degrees, counter-clockwise.
    pub fn rotate(self, angle: impl Into<Number>) -> Self {
        self.set("rotate", angle.into().0)
    }

    /// The x axis and the y axis are turned, each by its angle.
    pub fn rotate_axes(self, angles: impl Into<Point>) -> Self {
        self.set("rotate", angles.into().0)
    }

    /// What is added last.
    pub fn shift(self, shift: impl Into<Point>) -> Self {
        self.set("shift", shift.into().0)
    }

    /// The point that stays where it is, in place of a shift.
    pub fn fixed(self, point: impl Into<Point>) -> Self {
        self.set("fixed", point.into().0)
    }

    /// How often random iteration picks the map, relative to the others.
    pub fn weight(self, weight: impl Into<Number>) -> Self {
        self.set("weight", weight.into().0)
    }

    /// A name; a map without one is called by its number, from 1.
    pub fn name(self, name: impl Into<String>) -> Self {
        Self {
            name: Some(name.into()),
            ..self
        }
    }
}

impl From<DAffine2> for Map {
    fn from(map: DAffine2) -> Self {
        let rows = map.matrix2.transpose();
        Self::matrix([rows.x_axis, rows.y_axis]).shift(map.translation)
    }
}
