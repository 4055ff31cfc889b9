//! Document of an instancing structure (Hart 1992).
//!
//! A placeholder, [`unknown`](crate::expression::Expression::unknown), stands for every expression that
//! cannot be read and has been reported.

use crate::diagnostic::Place;

use super::read::TintDocument;
use super::{
    LinearDocument, MetadataDocument, ShapeDocument, TurnDocument, Written, WrittenNumber,
    WrittenPoint,
};

/// An instancing structure as written.
#[derive(Clone, Debug)]
pub struct InstancingDocument {
    /// Metadata of the file.
    pub metadata: MetadataDocument,
    /// Whether the structure lies in space.
    pub is_in_space: bool,
    /// Random variables, drawn whenever an object is replaced, with their distributions.
    pub random: Vec<(Written<String>, WrittenNumber)>,
    /// The objects, in the order of the file.
    pub objects: Vec<ObjectDocument>,
    /// The scene: the union that is drawn; `None` if it is missing.
    pub scene: Option<UnionDocument>,
    /// The set that is drawn in place of objects that are not replaced yet.
    pub initial: Option<ShapeDocument>,
}

/// An object as written.
#[derive(Clone, Debug)]
pub struct ObjectDocument {
    /// Name without the level.
    pub name: Written<String>,
    /// Level.
    pub level: Option<LevelDocument>,
    /// Content of the object.
    pub union: UnionDocument,
}

/// The level of an object as written.
#[derive(Clone, Debug)]
pub enum LevelDocument {
    /// All levels, under the name of a variable: the `n` of `A(n)`.
    Any(Written<String>),
    /// One level: the 0 of `A(0)`.
    One(WrittenNumber),
}

/// A union of instances as written.
#[derive(Clone, Debug)]
pub struct UnionDocument {
    /// The instances; empty if there are alternatives.
    pub instances: Vec<InstanceDocument>,
    /// Unions of which one is drawn at random for every instance.
    pub alternatives: Vec<AlternativeDocument>,
    /// Transforms of the whole union, in the order of application.
    pub transforms: Vec<TransformDocument>,
    /// Source span of the union.
    pub place: Place,
}

/// An alternative of an object as written.
#[derive(Clone, Debug)]
pub struct AlternativeDocument {
    /// The instances, none if it draws nothing.
    pub instances: Vec<InstanceDocument>,
    /// Transforms of all of them, in the order of application.
    pub transforms: Vec<TransformDocument>,
    /// Its weight, 1 if left out.
    pub weight: Option<WrittenNumber>,
}

/// An instance as written.
#[derive(Clone, Debug)]
pub struct InstanceDocument {
    /// The object or shape that is instanced; `None` if it cannot be read.
    pub master: Option<MasterDocument>,
    /// Transforms, in the order of application.
    pub transforms: Vec<TransformDocument>,
    /// Tint.
    pub tint: Option<Box<TintDocument>>,
    /// Source span of the instance.
    pub place: Place,
}

/// The object or shape that is instanced, as written.
#[derive(Clone, Debug)]
pub enum MasterDocument {
    /// An object by name.
    Object {
        /// Name without the level.
        name: Written<String>,
        /// Level.
        level: Option<WrittenNumber>,
    },
    /// A shape.
    Shape(Box<ShapeDocument>),
}

/// A transform as written.
#[derive(Clone, Debug)]
pub enum TransformDocument {
    /// Scaling about (0, 0) by factors along x and y.
    Scale([WrittenNumber; 2]),
    /// Rotation about (0, 0) by an angle in degrees, counter-clockwise.
    Rotate(WrittenNumber),
    /// Translation.
    Translate(WrittenPoint),
    /// Linear map by the rows of its matrix.
    Matrix([WrittenPoint; 2]),
    /// Scaling of space about the origin by factors along x, y and z.
    ScaleInSpace([WrittenNumber; 3]),
    /// Turns of space about axes through the origin, of which the first is done first.
    Turns(Vec<TurnDocument>),
    /// Linear map of space by the rows of its matrix.
    MatrixInSpace([WrittenPoint; 3]),
    /// Translation by the opposite of a vector.
    TranslateBack(WrittenPoint),
    /// Linear part of a map of a system.
    Linear(Box<LinearDocument>),
}
