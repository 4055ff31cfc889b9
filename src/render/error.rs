//! Errors of drawing, with the changes that help.

use std::convert::Infallible;
use std::io;

use crate::grow::WalkError;
use crate::kind::Kind;
use crate::zoom::ZoomError;

use super::canvas::NoRoom;
use super::density::MAX_SPREAD;
use super::instanced::NotInstanced;
#[cfg(doc)]
use super::options::Options;
use super::png::TooManyPixels;
use super::space::SpaceError;

/// Error of drawing.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The walk ended early.
    #[error(transparent)]
    Walk(WalkError<Infallible>),
    /// The picture has no room for the drawing.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// The detail cannot be reached.
    #[error(transparent)]
    NoDetail(#[from] NoDetail),
    /// There is nothing to zoom into.
    #[error(transparent)]
    Zoom(#[from] ZoomError),
    /// The colours are unknown at this magnification.
    #[error(transparent)]
    NoZoom(#[from] NoZoom),
    /// The picture cannot be made of nested instances.
    #[error(transparent)]
    NotInstanced(#[from] NotInstanced),
    /// The picture is too large for memory.
    #[error(transparent)]
    TooManyPixels(#[from] TooManyPixels),
    /// A density has too many bins for its kernel.
    #[error("{bins} bins of hits are too many to be spread by a kernel; {most} are the most", most = MAX_SPREAD)]
    TooManyToSpread {
        /// Number of bins of all classes.
        bins: usize,
    },
    /// A set in space cannot be drawn.
    #[error(transparent)]
    Space(#[from] SpaceError),
    /// A figure was asked for of a model whose document is of another kind.
    #[error("the document of the {} is of another kind", .0.noun())]
    NoFigure(Kind),
    /// The picture cannot be written.
    #[error(transparent)]
    Io(#[from] io::Error),
}

/// Reason why a picture cannot be drawn to a detail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoDetail {
    /// Indices are counted by the walk.
    #[error("what replaces an element depends on the number of all those before it")]
    CountsIndex,
    /// Elements do not shrink below every length.
    #[error("its elements do not get smaller than any length")]
    DoesNotShrink,
    /// The graph is time-indexed: every number of steps has its own initiator.
    #[error("every step of it starts anew, so that the detail does not determine their number")]
    StartsAnew,
    /// The bounding box shrinks with the elements, which fill the picture at every step.
    #[error("all that is drawn gets as small as its elements")]
    Vanishes,
    /// The limit of steps is reached before the detail.
    #[error("{steps} steps are not enough")]
    TooFewSteps {
        /// Limit of steps.
        steps: u32,
    },
}

/// Reason why a picture cannot be zoomed, in addition to those for all pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoZoom {
    /// Elements far from the window are not counted, so that ranks and fractal numbers are unknown.
    #[error(
        "elements and fractals far from the window are not counted, so that colours cannot show their \
         numbers; a single colour draws them"
    )]
    Numbers,
    /// A range of lengths or coordinates is in the units of the whole, and a zoom is drawn in pixels.
    #[error(
        "lengths and coordinates of a zoom have no range in the units of the whole; without the range, colours are those of \
         the picture"
    )]
    Range,
}

/// Change of [`Options`] or of the growth with which a picture can be drawn after all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Remedy {
    /// Colours by a property that does not distinguish elements by number, or a single colour.
    OtherColours,
    /// No fill.
    NoFill,
    /// Round caps and round joins.
    RoundEnds,
    /// Stroke width in pixels.
    PixelWidth,
    /// Window of a step, in place of a zoom.
    Window,
}

impl RenderError {
    /// Returns whether the reason is that no element is visible.
    #[must_use]
    pub fn draws_nothing(&self) -> bool {
        matches!(
            self,
            Self::NoRoom(NoRoom::Nothing) | Self::Space(SpaceError::NoRoom(NoRoom::Nothing))
        )
    }

    /// Returns the change of options with which the picture can be drawn, where there is one.
    #[must_use]
    pub fn remedy(&self) -> Option<Remedy> {
        Some(match self {
            Self::NotInstanced(NotInstanced::Colours { .. }) | Self::NoZoom(_) => {
                Remedy::OtherColours
            }
            Self::NotInstanced(NotInstanced::Areas) => Remedy::NoFill,
            Self::NotInstanced(NotInstanced::Corners) => Remedy::RoundEnds,
            Self::NotInstanced(NotInstanced::Flattened) | Self::Zoom(ZoomError::WideStroke) => {
                Remedy::PixelWidth
            }
            Self::Zoom(
                ZoomError::NoLimit(_)
                | ZoomError::CountsIndex
                | ZoomError::StartsAnew
                | ZoomError::NoReach,
            ) => Remedy::Window,
            _ => return None,
        })
    }
}

impl From<WalkError<io::Error>> for RenderError {
    fn from(error: WalkError<io::Error>) -> Self {
        match error {
            WalkError::Visitor(error) => Self::Io(error),
            WalkError::TooManyElements { limit } => {
                Self::Walk(WalkError::TooManyElements { limit })
            }
            WalkError::TooLong { limit } => Self::Walk(WalkError::TooLong { limit }),
            WalkError::NotFinite(error) => Self::Walk(WalkError::NotFinite(error)),
            WalkError::Cancelled => Self::Walk(WalkError::Cancelled),
        }
    }
}

impl From<WalkError<Infallible>> for RenderError {
    fn from(error: WalkError<Infallible>) -> Self {
        Self::Walk(error)
    }
}
