//! The file of an iterated function system as it is written.
//!
//! Where something could not be read, which has been reported then, an expression that is
//! [unknown](crate::expression::Expression::unknown) stands in for it.

use crate::diagnostic::Place;

use super::{HeadingDocument, KindDocument, Number, Point, Written};

/// An iterated function system as written.
#[derive(Clone, Debug)]
pub struct IfsDocument {
    /// What files of all kinds say.
    pub heading: HeadingDocument,
    /// The maps; `None` if they could not be read.
    pub maps: Option<MapsDocument>,
    /// The condensation sets.
    pub condensation: Vec<CondensationDocument>,
    /// What approximant 0 draws.
    pub initial: Option<ShapeDocument>,
    /// Which map may follow which, and where that is written.
    pub edges: Option<(Vec<EdgeDocument>, Place)>,
}

/// The ways to write the maps of a system.
#[derive(Clone, Debug)]
pub enum MapsDocument {
    /// One after another.
    Listed(Vec<MapDocument>),
    /// Towards vertices, by a factor.
    Vertices {
        /// The vertices.
        points: Vec<Point>,
        /// What is left of the way.
        shrink: Number,
    },
    /// The curve through points.
    Interpolated(InterpolationDocument),
}

/// Fractal interpolation as written.
#[derive(Clone, Debug)]
pub struct InterpolationDocument {
    /// The points, from left to right.
    pub points: Vec<Point>,
    /// The vertical factors.
    pub scale: Option<Scales>,
    /// The dimension of the curve.
    pub dimension: Option<Number>,
    /// Where it was written.
    pub place: Place,
}

/// Vertical factors as written.
#[derive(Clone, Debug)]
pub enum Scales {
    /// One for all pieces.
    One(Number),
    /// One for each piece.
    Each(Vec<Number>),
}

/// A map as written.
#[derive(Clone, Debug)]
pub struct MapDocument {
    /// What it is called.
    pub name: Option<Written<String>>,
    /// Its linear part; `None` if it could not be read.
    pub linear: Option<LinearDocument>,
    /// What is added last.
    pub shift: Option<Point>,
    /// The point that stays where it is.
    pub fixed: Option<Point>,
    /// How often it is picked.
    pub weight: Option<Number>,
    /// Where it was written.
    pub place: Place,
}

/// The linear part of a map as written.
#[derive(Clone, Debug)]
pub enum LinearDocument {
    /// By the rows of its matrix.
    Matrix([Point; 2]),
    /// By factors and angles of the two axes.
    Axes {
        /// The factors.
        scale: [Number; 2],
        /// The angles, in degrees; 0 if left out.
        rotate: Option<[Number; 2]>,
    },
    /// By a complex factor.
    Complex {
        /// The factor.
        times: Point,
        /// Whether the conjugate is taken first.
        conjugate: bool,
    },
}

/// An edge of the digraph as written.
#[derive(Clone, Debug)]
pub struct EdgeDocument {
    /// The map that was applied last, by name or number.
    pub from: Written<String>,
    /// The map that may follow, by name or number.
    pub to: Written<String>,
    /// How likely it is.
    pub weight: Option<Number>,
}

/// A condensation set as written.
#[derive(Clone, Debug)]
pub struct CondensationDocument {
    /// The set.
    pub shape: ShapeDocument,
    /// How often a point is drawn anew from it.
    pub weight: Option<Number>,
}

/// A shape as written.
#[derive(Clone, Debug)]
pub struct ShapeDocument {
    /// What it is; `None` if it could not be read.
    pub form: Option<FormDocument>,
    /// Where it was written.
    pub place: Place,
}

/// What a shape is, as written.
#[derive(Clone, Debug)]
pub enum FormDocument {
    /// A point.
    Point(Point),
    /// A line through points.
    Outline {
        /// The points.
        points: Vec<Point>,
        /// Whether it goes back to the first, and is meant with what it encloses.
        closed: bool,
    },
    /// An ellipse.
    Ellipse(Box<EllipseDocument>),
    /// An approximant of another fractal.
    Fractal(Box<FractalDocument>),
}

/// An approximant of another fractal, as written.
#[derive(Clone, Debug)]
pub struct FractalDocument {
    /// What the fractal's file says.
    pub file: KindDocument,
    /// Whether nothing is known to be wrong with it: only then can it be grown.
    pub is_sound: bool,
    /// The number of steps; the file's own if left out.
    pub steps: Option<Number>,
    /// What its random draws depend on; 0 if left out.
    pub seed: Option<Number>,
    /// Its parameters that are set, with their values.
    pub set: Vec<(Written<String>, Number)>,
    /// Where it stands.
    pub map: Option<MapDocument>,
    /// Where it was named.
    pub place: Place,
}

/// An ellipse as written.
#[derive(Clone, Debug)]
pub struct EllipseDocument {
    /// Its centre.
    pub centre: Point,
    /// Its half axes.
    pub axes: [Number; 2],
    /// The angle of the first of them.
    pub rotate: Option<Number>,
}
