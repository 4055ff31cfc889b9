//! Document of a production rule.
//!
//! A placeholder, [`unknown`](crate::expression::Expression::unknown) or a missing name, stands for
//! every expression or name that cannot be read and has been reported.

use crate::diagnostic::Place;
use crate::rule::Placement;

use super::{MetadataDocument, Written, WrittenNumber, WrittenPoint};

/// A production rule as written, with its components inlined.
#[derive(Clone, Debug)]
pub struct RuleDocument {
    /// Metadata of the file.
    pub heading: MetadataDocument,
    /// Initiator.
    pub initiator: InitiatorDocument,
    /// Generators by name. A single `generator` has the name `generator`.
    pub generators: Vec<(Written<String>, GeneratorDocument)>,
    /// Selection of generators.
    pub select: Option<SelectDocument>,
    /// Base element of all elements without their own.
    pub base_element: Option<BaseElementDocument>,
}

/// An initiator as written.
#[derive(Clone, Debug)]
pub struct InitiatorDocument {
    /// Points and elements.
    pub entries: Vec<Entry>,
    /// Whether one more element connects the last point to the first.
    pub closed: bool,
    /// Whether elements join each other.
    pub connected: bool,
    /// Source span of the initiator.
    pub place: Place,
}

impl InitiatorDocument {
    /// Returns a placeholder for an initiator that cannot be read.
    pub(super) fn missing(place: &Place) -> Self {
        Self {
            entries: Vec::new(),
            closed: false,
            connected: true,
            place: place.clone(),
        }
    }
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

/// An element as written.
#[derive(Clone, Debug)]
pub struct Listed {
    /// Start point; the end of the previous entry if `None`.
    pub from: Option<WrittenPoint>,
    /// End point.
    pub to: WrittenPoint,
    /// Direction, 1 to 4.
    pub direction: Option<WrittenNumber>,
    /// Whether the element is replaced.
    pub fertile: bool,
    /// Whether the element is drawn.
    pub visible: bool,
    /// Whether the element may join the previous one.
    pub connected: bool,
    /// Generator that replaces the element, if it names one.
    pub generator: Option<Written<String>>,
    /// The element's own base element.
    pub base_element: Option<BaseElementDocument>,
    /// Source span of the element.
    pub place: Place,
}

/// A move of points of a generator, as written.
#[derive(Clone, Debug)]
pub struct MoveDocument {
    /// Angle in degrees, counter-clockwise.
    pub rotate: Option<WrittenNumber>,
    /// Scaling factors along x and y.
    pub scale: Option<[WrittenNumber; 2]>,
    /// Translation, which is applied last.
    pub shift: Option<WrittenPoint>,
    /// Centre of scaling and rotation.
    pub about: Option<WrittenPoint>,
    /// Points that move.
    pub points: WhichPoints,
    /// Source span of the move.
    pub place: Place,
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
    Cases(Vec<(Option<WrittenNumber>, Option<Written<String>>)>, Place),
    /// By index of the element.
    ByIndex(Vec<Written<String>>, Place),
    /// At random, by weight.
    AtRandom(Vec<(Written<String>, WrittenNumber)>, Place),
}

/// A base element as written.
#[derive(Clone, Debug)]
pub struct BaseElementDocument {
    /// Pieces; the first is the first point.
    pub pieces: Vec<PieceDocument>,
    /// Whether the last point is connected to the first.
    pub closed: bool,
    /// Point of the outline that is mapped to (0, 0).
    pub from: Option<WrittenPoint>,
    /// Point of the outline that is mapped to (1, 0).
    pub to: Option<WrittenPoint>,
    /// Source span of the base element.
    pub place: Place,
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
    /// Returns the end point.
    pub(crate) fn end(&self) -> &WrittenPoint {
        match self {
            Self::Line(to) | Self::Arc { to, .. } | Self::Curve { to, .. } => to,
        }
    }
}
