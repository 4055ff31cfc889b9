//! Pictures of approximants.
//!
//! A picture is made in two walks or more: a survey that learns what there is to draw and how
//! large it is, and one walk for every class of colour, so that nothing is held in memory.

mod canvas;
mod classes;
mod path;
mod survey;
pub mod svg;

pub use canvas::{Canvas, NoRoom, Size};
pub use classes::Classes;
pub use survey::Survey;

use std::io;

use crate::grow::WalkError;

/// Widths of strokes that are relative to their elements are rounded to so many steps an octave.
const WIDTHS_AN_OCTAVE: f64 = 8.0;

/// Why a picture is not made.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The walk ended early.
    #[error(transparent)]
    Walk(WalkError<std::convert::Infallible>),
    /// The picture has no room for what is to be drawn.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// The picture cannot be written.
    #[error(transparent)]
    Io(#[from] io::Error),
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

impl From<WalkError<std::convert::Infallible>> for RenderError {
    fn from(error: WalkError<std::convert::Infallible>) -> Self {
        Self::Walk(error)
    }
}
