//! The rule file as it is written.
//!
//! Where something could not be read, which has been reported then, an expression that is
//! [unknown](crate::expression::Expression::unknown) or a name that is missing stands in for it.

use crate::diagnostic::Place;
use crate::rule::Placement;

use super::{HeadingDocument, Number, Point, Written};

/// A production rule as written, with its components in it.
#[derive(Clone, Debug)]
pub struct RuleDocument {
    /// What files of all kinds say.
    pub heading: HeadingDocument,
    /// The initiator.
    pub initiator: InitiatorDocument,
    /// The generators by name; `generator` is one without a name.
    pub generators: Vec<(Written<String>, GeneratorDocument)>,
    /// The selection.
    pub select: Option<SelectDocument>,
    /// The base element of all elements that have none of their own.
    pub base_element: Option<BaseElementDocument>,
}

/// An initiator as written.
#[derive(Clone, Debug)]
pub struct InitiatorDocument {
    /// Points and elements.
    pub entries: Vec<Entry>,
    /// Whether one more element runs from the last point to the first.
    pub closed: bool,
    /// Whether elements join at all.
    pub connected: bool,
    /// Where it was written.
    pub place: Place,
}

impl InitiatorDocument {
    /// Stands in for an initiator that could not be read.
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
    /// Drawn variables with their distributions.
    pub random: Vec<(Written<String>, Number)>,
    /// What moves its points.
    pub moves: Vec<MoveDocument>,
    /// Its parts.
    pub parts: Vec<PartDocument>,
    /// Where it was written.
    pub place: Place,
}

/// A part of a generator as written.
#[derive(Clone, Debug)]
pub struct PartDocument {
    /// Where its elements go.
    pub placement: Placement,
    /// Points and elements.
    pub entries: Vec<Entry>,
    /// Whether one more element runs from the last point to the first.
    pub closed: bool,
    /// Whether elements join at all.
    pub connected: bool,
    /// Where it was written.
    pub place: Place,
}

/// An entry of a list of elements.
#[derive(Clone, Debug)]
pub enum Entry {
    /// A point: where a chain starts, or an element to it with no more to say.
    Point(Point),
    /// An element.
    Element(Box<Listed>),
}

/// An element as written.
#[derive(Clone, Debug)]
pub struct Listed {
    /// Where it runs from, if that is written.
    pub from: Option<Point>,
    /// Where it runs to.
    pub to: Point,
    /// Its direction, 1 to 4.
    pub direction: Option<Number>,
    /// Whether it is replaced.
    pub fertile: bool,
    /// Whether it is drawn.
    pub visible: bool,
    /// Whether it may join the element before it.
    pub connected: bool,
    /// The generator that it names.
    pub generator: Option<Written<String>>,
    /// A base element of its own.
    pub base_element: Option<BaseElementDocument>,
    /// Where it was written.
    pub place: Place,
}

/// What moves the points of a generator, as written.
#[derive(Clone, Debug)]
pub struct MoveDocument {
    /// The angle, in degrees.
    pub rotate: Option<Number>,
    /// The factors along x and y.
    pub scale: Option<[Number; 2]>,
    /// The shift.
    pub shift: Option<Point>,
    /// The centre of turning and scaling.
    pub about: Option<Point>,
    /// The points that move.
    pub points: WhichPoints,
    /// Where it was written.
    pub place: Place,
}

/// The points that a move moves.
#[derive(Clone, Debug)]
pub enum WhichPoints {
    /// All but the two ends of what takes the element's place.
    Inner,
    /// All.
    All,
    /// Those with these numbers, from 0 in the order in which they are first written.
    Numbers(Vec<Number>),
}

/// A selection as written.
#[derive(Clone, Debug)]
pub enum SelectDocument {
    /// Conditions, tried in order, and generators.
    Cases(Vec<(Option<Number>, Option<Written<String>>)>, Place),
    /// By index.
    ByIndex(Vec<Written<String>>, Place),
    /// At random, by weight.
    AtRandom(Vec<(Written<String>, Number)>, Place),
}

/// A base element as written.
#[derive(Clone, Debug)]
pub struct BaseElementDocument {
    /// Its pieces; the first is its first point.
    pub pieces: Vec<PieceDocument>,
    /// Whether its last point is joined to its first.
    pub closed: bool,
    /// What comes to lie on (0, 0).
    pub from: Option<Point>,
    /// What comes to lie on (1, 0).
    pub to: Option<Point>,
    /// Where it was written.
    pub place: Place,
}

/// A piece of a base element as written.
#[derive(Clone, Debug)]
pub enum PieceDocument {
    /// A straight line to a point.
    Line(Point),
    /// A circular arc through a point to a point.
    Arc {
        /// Where it ends.
        to: Point,
        /// A point on it.
        through: Point,
    },
    /// A Bézier curve with one control point or two.
    Curve {
        /// Where it ends.
        to: Point,
        /// The control points.
        control: Vec<Point>,
    },
}

impl PieceDocument {
    /// Where it ends.
    pub(crate) fn end(&self) -> &Point {
        match self {
            Self::Line(to) | Self::Arc { to, .. } | Self::Curve { to, .. } => to,
        }
    }
}
