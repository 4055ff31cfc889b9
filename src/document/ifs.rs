//! Document of an iterated function system.
//!
//! A placeholder, [`unknown`](crate::expression::Expression::unknown), stands for every expression that
//! cannot be read and has been reported.

use crate::diagnostic::Place;

use super::read::{
    CuboidDocument, EllipseDocument, EllipsoidDocument, ShaftDocument, SphereDocument, TintDocument,
};
use super::{KindDocument, MetadataDocument, Written, WrittenNumber, WrittenPoint};

/// An iterated function system as written.
#[derive(Clone, Debug)]
pub struct IfsDocument {
    /// Metadata of the file.
    pub metadata: MetadataDocument,
    /// Whether the system lies in space.
    pub is_in_space: bool,
    /// Random variables, drawn for every image of the set, with their distributions.
    pub random: Vec<(Written<String>, WrittenNumber)>,
    /// The maps; `None` if they cannot be read.
    pub maps: Option<MapsDocument>,
    /// The condensation sets.
    pub condensation: Vec<CondensationDocument>,
    /// The initial set, which approximant 0 draws.
    pub initial: Option<ShapeDocument>,
    /// Edges of the digraph, with their source span.
    pub edges: Option<(Vec<EdgeDocument>, Place)>,
}

/// Notations for the maps of a system.
#[derive(Clone, Debug)]
pub enum MapsDocument {
    /// A list of maps.
    Listed(Vec<MapDocument>),
    /// Contractions towards vertices by a common factor.
    Vertices {
        /// The vertices.
        points: VerticesDocument,
        /// Contraction factor f of the maps x → f x + (1 − f) v.
        shrink: WrittenNumber,
    },
    /// The maps of fractal interpolation.
    Interpolated(InterpolationDocument),
    /// Maps of which some are drawn at random for every image of the set.
    AtRandom(Vec<AlternativeMapsDocument>),
}

/// An alternative of the maps of a system as written.
#[derive(Clone, Debug)]
pub struct AlternativeMapsDocument {
    /// The maps, none if nothing is drawn.
    pub maps: Vec<MapDocument>,
    /// Its weight, 1 if left out.
    pub weight: Option<WrittenNumber>,
}

impl IfsDocument {
    /// Returns whether the maps are drawn at random for every image of the set.
    #[must_use]
    pub fn is_random(&self) -> bool {
        !self.random.is_empty() || matches!(self.maps, Some(MapsDocument::AtRandom(_)))
    }
}

/// Vertices as written.
#[derive(Clone, Debug)]
pub enum VerticesDocument {
    /// A list of points, or the corners of a solid.
    Listed(Vec<WrittenPoint>),
    /// Points that are drawn at random.
    Scattered(Box<ScatterDocument>),
}

/// Points in an ellipsoid, or in an ellipse of the plane, as written.
#[derive(Clone, Debug)]
pub struct ScatterDocument {
    /// Half lengths of its axes, which are those of the coordinates.
    pub ellipsoid: WrittenPoint,
    /// Number of points.
    pub count: WrittenNumber,
    /// Seed of the random draws; 0 if `None`.
    pub seed: Option<WrittenNumber>,
}

/// Fractal interpolation as written.
#[derive(Clone, Debug)]
pub struct InterpolationDocument {
    /// Interpolation points, from left to right.
    pub points: Vec<WrittenPoint>,
    /// Vertical scaling factors.
    pub scale: Scales,
    /// Source span of the interpolation.
    pub place: Place,
}

/// Vertical scaling factors as written.
#[derive(Clone, Debug)]
pub enum Scales {
    /// One factor for all pieces.
    One(WrittenNumber),
    /// One factor for each piece.
    Each(Vec<WrittenNumber>),
    /// One factor for all pieces, by the box dimension of the curve.
    Dimension(WrittenNumber),
}

/// An affine map as written.
#[derive(Clone, Debug)]
pub struct MapDocument {
    /// Name of the map.
    pub name: Option<Written<String>>,
    /// Linear part; `None` if it cannot be read.
    pub linear: Option<LinearDocument>,
    /// Translation, which is added last.
    pub shift: Option<WrittenPoint>,
    /// Fixed point, as an alternative to the translation.
    pub fixed: Option<WrittenPoint>,
    /// Relative probability in random iteration.
    pub weight: Option<WrittenNumber>,
    /// Change of the colours of what the map draws.
    pub tint: Option<Box<TintDocument>>,
    /// Source span of the map.
    pub place: Place,
}

/// The linear part of a map as written.
#[derive(Clone, Debug)]
pub enum LinearDocument {
    /// Rows of a matrix.
    Matrix([WrittenPoint; 2]),
    /// Factors and angles of the two axes.
    Axes {
        /// Factors along x and y.
        scale: [WrittenNumber; 2],
        /// Angles of the images of the axes, in degrees; 0 if `None`.
        rotate: Option<[WrittenNumber; 2]>,
    },
    /// Rows of a matrix of space.
    MatrixInSpace([WrittenPoint; 3]),
    /// Factors of the three axes, then turns about axes in their order.
    AxesInSpace {
        /// Factors along x, y and z.
        scale: [WrittenNumber; 3],
        /// The turns, of which the first is done first.
        turns: Vec<TurnDocument>,
    },
    /// Multiplication by a complex number.
    Complex {
        /// The factor.
        times: WrittenPoint,
        /// Whether the conjugate is taken before the multiplication.
        conjugate: bool,
    },
}

/// A turn of space as written.
#[derive(Clone, Debug)]
pub struct TurnDocument {
    /// Vector along the axis.
    pub axis: WrittenPoint,
    /// Angle in degrees, by the right-hand rule.
    pub angle: WrittenNumber,
}

/// An edge of the digraph as written.
#[derive(Clone, Debug)]
pub struct EdgeDocument {
    /// The map that was applied last, by name or number.
    pub from: Written<String>,
    /// The map that may be applied next, by name or number.
    pub to: Written<String>,
    /// Relative probability of the edge.
    pub weight: Option<WrittenNumber>,
}

/// A condensation set as written.
#[derive(Clone, Debug)]
pub struct CondensationDocument {
    /// The set.
    pub shape: ShapeDocument,
    /// Relative probability of a restart of random iteration in the set.
    pub weight: Option<WrittenNumber>,
}

/// A shape as written.
#[derive(Clone, Debug)]
pub struct ShapeDocument {
    /// Geometry of the shape; `None` if it cannot be read.
    pub form: Option<FormDocument>,
    /// Source span of the shape.
    pub place: Place,
}

/// Geometry of a shape as written.
#[derive(Clone, Debug)]
pub enum FormDocument {
    /// A point.
    Point(WrittenPoint),
    /// A polyline or a polygon.
    Outline {
        /// The points.
        points: Vec<WrittenPoint>,
        /// Whether the outline is closed and includes its interior.
        closed: bool,
    },
    /// An ellipse or a disk.
    Ellipse(Box<EllipseDocument>),
    /// An approximant of another fractal.
    Fractal(Box<FractalDocument>),
    /// A solid in space.
    Solid(Box<SolidDocument>),
}

/// A solid as written.
#[derive(Clone, Debug)]
pub enum SolidDocument {
    /// A ball.
    Sphere(SphereDocument),
    /// An ellipsoid.
    Ellipsoid(EllipsoidDocument),
    /// A cylinder.
    Cylinder(ShaftDocument),
    /// A cone.
    Cone(ShaftDocument),
    /// A box along the axes.
    Cuboid(CuboidDocument),
    /// The convex hull of points.
    Hull(Vec<WrittenPoint>),
    /// A solid of a known name, about the origin.
    Named(Written<String>),
    /// A mesh.
    Mesh(MeshDocument),
}

/// A mesh as written.
#[derive(Clone, Debug)]
pub struct MeshDocument {
    /// The points.
    pub points: Vec<WrittenPoint>,
    /// Numbers of the points of every face, from 0.
    pub faces: Vec<Vec<WrittenNumber>>,
}

/// An approximant of another fractal, as written.
#[derive(Clone, Debug)]
pub struct FractalDocument {
    /// Content of the fractal's file.
    pub file: KindDocument,
    /// Whether no errors are known in the file: otherwise the fractal is not grown.
    pub is_sound: bool,
    /// Number of steps; that of the file if `None`.
    pub steps: Option<WrittenNumber>,
    /// Seed of the random draws; 0 if `None`.
    pub seed: Option<WrittenNumber>,
    /// Parameters that are set, with their values.
    pub set: Vec<(Written<String>, WrittenNumber)>,
    /// Map that places the fractal.
    pub map: Option<MapDocument>,
    /// Source span of the fractal's name.
    pub place: Place,
}
