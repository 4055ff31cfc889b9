//! Reasons why a fractal has no equivalent of another kind.

use crate::extent::NoLimit;
use crate::kind::Kind;

/// Reason why a kind cannot express a fractal. Maps and elements are numbered from 1 in messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// The fractal is of that kind already.
    #[error("it is of the kind '{}' already", .0.name())]
    SameKind(Kind),
    /// Kept elements have other shapes than lines.
    #[error(
        "its infertile elements are not all lines, and with others the limit set of an L-system is not known"
    )]
    NoLines,
    /// Instances have tints.
    #[error("its instances have tints, and a turtle draws in colours of a palette")]
    Tint,
    /// There are more symbols than letters.
    #[error("it has more than {0} kinds of elements, and each needs a letter")]
    TooManySymbols(usize),
    /// There is no limit set.
    #[error(transparent)]
    NoLimit(#[from] NoLimit),
    /// No object is replaced by copies of itself.
    #[error("nothing in it is replaced by copies of itself: a system needs a map")]
    NoMaps,
    /// A map that would have to be inverted is singular.
    #[error("{0} flattens the plane, so what stands in it cannot be described from outside")]
    Flat(String),
    /// A map is not a similarity.
    #[error(
        "{what} is no similarity: it stretches by {longest:.6} one way and by {shortest:.6} another, and what stands in a rule or an L-system keeps its shape"
    )]
    Shear {
        /// Name of the map.
        what: String,
        /// Largest stretch of the map.
        longest: f64,
        /// Least stretch of the map.
        shortest: f64,
    },
    /// A map has rank 0.
    #[error("{0} shrinks everything to a point, and an element of a rule has a length")]
    Point(String),
    /// A kept shape does not follow every map, as a condensation set does.
    #[error(
        "its infertile elements do not stand in all parts alike, and every map of a system follows a condensation set"
    )]
    ShapesInPart,
    /// A curved shape is not an ellipse.
    #[error(
        "a base element in it is round, and sets of this kind have straight sides or are ellipses"
    )]
    Round,
    /// A solid is not written as a set of space.
    #[error(
        "a solid in it is neither round and upright, nor a box along the axes, nor a polygon, and sets in space are"
    )]
    Solid,
    /// The model lies in space, and conversions to the other kind are those of the plane.
    #[error("it lies in space, and conversions to the kind '{}' are those of the plane", .0.name())]
    InSpace(Kind),
    /// A closed outline crosses itself so that its area is 0.
    #[error(
        "a closed outline in it crosses itself so that its area is 0, and that of a polygon must not be"
    )]
    NoArea,
    /// The system would have too many maps.
    #[error("it would have more than {0} maps")]
    TooManyMaps(usize),
    /// The approximants would differ.
    #[error("its approximants cannot be kept: {0}")]
    Steps(&'static str),
}
