//! The file of an instancing structure as it is written.
//!
//! Where something could not be read, which has been reported then, an expression that is
//! [unknown](crate::expression::Expression::unknown) stands in for it.

use crate::diagnostic::Place;
use crate::style::Colour;

use super::{HeadingDocument, Number, Point, ShapeDocument, Written};

/// A structure of objects as written.
#[derive(Clone, Debug)]
pub struct InstancingDocument {
    /// What files of all kinds say.
    pub heading: HeadingDocument,
    /// The canonical objects, in the order of the file.
    pub objects: Vec<ObjectDocument>,
    /// The object that places the scene; `None` if it is missing.
    pub scene: Option<UnionDocument>,
    /// What stands for objects that have not been replaced yet.
    pub initial: Option<ShapeDocument>,
    /// Whether its style says what colours tell.
    pub tells_colours: bool,
}

/// A canonical object as written.
#[derive(Clone, Debug)]
pub struct ObjectDocument {
    /// Its name, without its level.
    pub name: Written<String>,
    /// Its level.
    pub level: Option<LevelDocument>,
    /// What it is made of.
    pub union: UnionDocument,
}

/// The level of an object as written.
#[derive(Clone, Debug)]
pub enum LevelDocument {
    /// Any, under a name: the `n` of `A(n)`.
    Any(Written<String>),
    /// One: the 0 of `A(0)`.
    One(Number),
}

/// A union of instances as written.
#[derive(Clone, Debug)]
pub struct UnionDocument {
    /// The instances.
    pub instances: Vec<InstanceDocument>,
    /// What is done to all of them, in this order.
    pub transforms: Vec<TransformDocument>,
    /// Where it was written.
    pub place: Place,
}

/// An instance as written.
#[derive(Clone, Debug)]
pub struct InstanceDocument {
    /// What it is one of; `None` if it could not be read.
    pub master: Option<MasterDocument>,
    /// What is done to it, in this order.
    pub transforms: Vec<TransformDocument>,
    /// What it is tinted with.
    pub tint: Option<TintDocument>,
    /// Where it was written.
    pub place: Place,
}

/// What an instance is one of, as written.
#[derive(Clone, Debug)]
pub enum MasterDocument {
    /// An object by name.
    Object {
        /// Its name.
        name: Written<String>,
        /// Its level.
        level: Option<Number>,
    },
    /// A shape.
    Shape(Box<ShapeDocument>),
}

/// A transform as written.
#[derive(Clone, Debug)]
pub enum TransformDocument {
    /// Factors along x and y.
    Scale([Number; 2]),
    /// An angle about (0, 0), in degrees, counter-clockwise.
    Rotate(Number),
    /// A shift.
    Translate(Point),
    /// The rows of a matrix.
    Matrix([Point; 2]),
}

/// A tint as written.
#[derive(Clone, Debug)]
pub struct TintDocument {
    /// The colour.
    pub colour: Option<Colour>,
    /// How much it covers; all if left out.
    pub alpha: Option<Number>,
}
