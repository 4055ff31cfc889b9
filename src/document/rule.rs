//! Document of a production rule.
//!
//! A placeholder, [`unknown`](crate::expression::Expression::unknown) or a missing name, stands for
//! every expression or name that cannot be read and has been reported.

use crate::diagnostic::Place;
use crate::rule::Placement;

use super::read::{BaseElementDocument, CaseDocument, InitiatorDocument, Listed, MoveDocument};
use super::{MetadataDocument, Written, WrittenNumber, WrittenPoint};

/// A production rule as written, with its components inlined.
#[derive(Clone, Debug)]
pub struct RuleDocument {
    /// Metadata of the file.
    pub metadata: MetadataDocument,
    /// Whether it lies in space.
    pub is_in_space: bool,
    /// Initiator.
    pub initiator: InitiatorDocument,
    /// Generators by name. A single `generator` has the name `generator`.
    pub generators: Vec<(Written<String>, GeneratorDocument)>,
    /// Selection of generators.
    pub select: Option<SelectDocument>,
    /// Base element of all elements without their own.
    pub base_element: Option<Box<BaseElementDocument>>,
}

/// A generator as written.
#[derive(Clone, Debug)]
pub struct GeneratorDocument {
    /// Random variables with their distributions.
    pub random: Vec<(Written<String>, WrittenNumber)>,
    /// Moves of its points, in the order of application.
    pub moves: Vec<MoveDocument>,
    /// Parts.
    pub parts: Vec<PartDocument>,
    /// Source span of the generator.
    pub place: Place,
}

/// A part of a generator as written.
#[derive(Clone, Debug)]
pub struct PartDocument {
    /// Placement: in the element's place, or as a seed.
    pub placement: Placement,
    /// Points and elements.
    pub entries: Vec<Entry>,
    /// Whether one more element connects the last point to the first.
    pub closed: bool,
    /// Whether elements join each other.
    pub connected: bool,
    /// Source span of the part.
    pub place: Place,
}

/// An entry of a list of elements.
#[derive(Clone, Debug)]
pub enum Entry {
    /// A point: the start of the list, or the end of an element without further attributes.
    Point(WrittenPoint),
    /// An element with attributes.
    Element(Box<Listed>),
}

/// The points to which a move applies.
#[derive(Clone, Debug)]
pub enum WhichPoints {
    /// All points but the first and the last one of what takes the element's place.
    Inner,
    /// All points.
    All,
    /// The points of these numbers, from 0 in the order of their first occurrence.
    Numbers(Vec<WrittenNumber>),
}

/// A selection of generators as written.
#[derive(Clone, Debug)]
pub enum SelectDocument {
    /// Conditions, which are tried in order, with generators. The last case has no condition.
    Cases(Vec<CaseDocument>, Place),
    /// By index of the element.
    ByIndex(Vec<Written<String>>, Place),
    /// At random, by weight.
    AtRandom(Vec<(Written<String>, WrittenNumber)>, Place),
}

/// A piece of a base element as written.
#[derive(Clone, Debug)]
pub enum PieceDocument {
    /// A straight line to a point.
    Line(WrittenPoint),
    /// A circular arc.
    Arc {
        /// End point.
        to: WrittenPoint,
        /// A point on the arc.
        through: WrittenPoint,
    },
    /// A Bézier curve.
    Curve {
        /// End point.
        to: WrittenPoint,
        /// Control points: one of a quadratic curve, two of a cubic one.
        control: Vec<WrittenPoint>,
    },
}

impl PieceDocument {
    /// Returns whether the piece is an arc or a curve.
    pub(crate) fn is_curved(&self) -> bool {
        !matches!(self, Self::Line(_))
    }

    /// Returns the end point.
    pub(crate) fn end(&self) -> &WrittenPoint {
        match self {
            Self::Line(to) | Self::Arc { to, .. } | Self::Curve { to, .. } => to,
        }
    }
}
