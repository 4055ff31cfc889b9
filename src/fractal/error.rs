//! Errors of the façade.

use std::convert::Infallible;
use std::io;

use crate::chaos::{GameError, SystemError};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::grow::WalkError;
use crate::measure::NoCover;
use crate::output_file::WriteError;
use crate::render::RenderError;
use crate::tween::TweenError;

use super::repetition::NoRepetition;

/// An error of [`Fractal`](super::Fractal).
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file, or a value that is set in it, is not valid.
    #[error("{0}")]
    Invalid(Diagnostics),
    /// The approximant cannot be walked.
    #[error(transparent)]
    Walk(WalkError<Infallible>),
    /// The picture cannot be drawn.
    #[error(transparent)]
    Render(RenderError),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// The set lies in space, and the result is of the plane.
    #[error("it lies in space: {0}")]
    InSpace(&'static str),
    /// The set lies in the plane, and the result is of space.
    #[error("it lies in the plane: {0}")]
    InPlane(&'static str),
    /// There is no tween between two fractals.
    #[error(transparent)]
    Tween(#[from] TweenError),
    /// The set is not repeated.
    #[error(transparent)]
    Repetition(#[from] NoRepetition),
    /// Points cannot be drawn from the system of maps at random.
    #[error(transparent)]
    System(#[from] SystemError),
    /// The points of random iteration cannot be counted.
    #[error(transparent)]
    Game(#[from] GameError),
    /// The set has no distance from another one.
    #[error("it cannot be compared: {0}")]
    Compare(NoCover),
    /// No dimension is decided or measured.
    #[error("it has no dimension: {0}")]
    NoDimension(String),
}

impl Error {
    /// Returns the mistakes in the file, each with its place and its remedy, if the file is not valid.
    #[must_use]
    pub fn diagnostics(&self) -> Option<&Diagnostics> {
        match self {
            Self::Invalid(diagnostics) => Some(diagnostics),
            _ => None,
        }
    }

    /// Returns whether the flag of [`Fractal::cancel`](super::Fractal::cancel) has ended it.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        matches!(
            self,
            Self::Walk(WalkError::Cancelled)
                | Self::Game(GameError::Cancelled)
                | Self::Render(RenderError::Walk(WalkError::Cancelled))
        )
    }
}

impl From<Diagnostics> for Error {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::Invalid(diagnostics)
    }
}

impl From<Diagnostic> for Error {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Invalid(diagnostic.into())
    }
}

impl From<WalkError<Infallible>> for Error {
    fn from(error: WalkError<Infallible>) -> Self {
        Self::Walk(error)
    }
}

impl From<RenderError> for Error {
    fn from(error: RenderError) -> Self {
        Self::Render(error)
    }
}

impl From<io::Error> for Error {
    fn from(error: io::Error) -> Self {
        Self::Render(error.into())
    }
}
