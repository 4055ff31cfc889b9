//! Reasons for which a fractal has no equivalent of another kind.

use crate::graph::NoLimit;
use crate::model::Kind;

/// Why a kind has no way to write a fractal. Maps and elements are numbered from 1 in messages.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// It is of that kind already.
    #[error("it is of the kind '{}' already: `kfrac cat --inline` shows all of it", .0.name())]
    SameKind(Kind),
    /// What stays has other shapes than lines.
    #[error(
        "its infertile elements are not all lines, and of others the limit set of an L-system is not told"
    )]
    NoLines,
    /// It has tints.
    #[error("its instances have tints, and a turtle draws in colours of a palette")]
    Tint,
    /// There are not as many letters.
    #[error("it has more than {0} kinds of elements, and each needs a letter")]
    TooManySymbols(usize),
    /// There is no limit set.
    #[error(transparent)]
    NoLimit(#[from] NoLimit),
    /// There is nothing that could become a map.
    #[error("nothing in it is replaced by copies of itself: a system needs a map")]
    NoMaps,
    /// A map cannot be undone that would have to be.
    #[error("{0} flattens the plane, so what stands in it cannot be described from outside")]
    Flat(String),
    /// A map that changes shapes.
    #[error(
        "{what} is no similarity: it stretches by {longest:.6} one way and by {shortest:.6} another, and what stands in a rule or an L-system keeps its shape"
    )]
    Shear {
        /// The map.
        what: String,
        /// By how much it stretches, at most and at least.
        longest: f64,
        /// At least.
        shortest: f64,
    },
    /// A map that leaves nothing.
    #[error("{0} shrinks everything to a point, and an element of a rule has a length")]
    Point(String),
    /// Shapes that do not follow every map.
    #[error(
        "its infertile elements do not stand in all parts alike, and every map of a system follows a condensation set"
    )]
    ShapesInPart,
    /// A round shape that is no ellipse.
    #[error(
        "a base element in it is round, and sets of this kind have straight sides or are ellipses"
    )]
    Round,
    /// An outline crosses itself so that it encloses nothing.
    #[error(
        "a closed outline in it crosses itself so that its area is 0, and that of a polygon must not be"
    )]
    NoArea,
    /// It would be too long.
    #[error("it would have more than {0} maps")]
    TooManyMaps(usize),
    /// Its steps would be others.
    #[error("its approximants cannot be kept: {0}")]
    Steps(&'static str),
}
