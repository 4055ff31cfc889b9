//! Reasons why approximants of an L-system approach no limit set.

use super::NoGraph;

/// Reason why the words of an L-system, drawn smaller from step to step, approach no one set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoGrowth {
    /// Productions or arguments are drawn at random.
    #[error("productions or numbers are drawn at random, so it has no one limit set")]
    Draws,
    /// Productions have contexts.
    #[error("productions have contexts, so that no map determines the pictures of its modules")]
    Contexts,
    /// The arguments of modules take values without end.
    #[error("the arguments of its modules change without end, and their pictures with them")]
    Arguments,
    /// The turtle has actions that do not follow from those of its parts.
    #[error(
        "its turtle fills polygons, places stamps, cuts off branches, or exchanges headings, which maps of its modules do not \
         determine"
    )]
    Actions,
    /// The turtle moves in space as its words determine only one after the other.
    #[error("{0}, so that no map determines the pictures of its modules")]
    Walked(NoGraph),
    /// Directions of modules do not recur.
    #[error("the turns of its turtle do not recur, so that every step draws other directions")]
    Turns,
    /// Displacements do not recur in direction.
    #[error(
        "it has no limit set: its largest displacements grow alike, and their directions do not recur"
    )]
    Directions,
    /// Displacements do not grow by a factor.
    #[error("it has no limit set: its displacements do not grow by a factor with each step")]
    Slow,
    /// Approximants approach several sets in turn.
    #[error("it has no one limit set: its steps approach {0} different sets in turn")]
    Alternates(u32),
    /// Nothing is drawn in the limit.
    #[error("nothing of it is drawn in the limit")]
    Empty,
    /// Drawings shrink to points.
    #[error(
        "all that it draws grows less than the turtle moves, and shrinks to points in the limit"
    )]
    Points,
    /// Growth is not decided, because the system is too large.
    #[error("its growth is not decided: too many modules and directions recur at too many steps")]
    Size,
}
