//! Answers to requests that fail.

use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde_json::json;

use crate::cli::Failure;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::output_file::WriteError;

/// Answer to a request that fails: status and message.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Refusal {
    pub(super) status: StatusCode,
    pub(super) message: String,
}

impl Refusal {
    pub(super) fn new(status: StatusCode, message: impl Into<String>) -> Self {
        let message = message.into();
        Self { status, message }
    }

    /// Refuses a request that asks for what cannot be.
    pub(super) fn wrong(message: impl Into<String>) -> Self {
        Self::new(StatusCode::UNPROCESSABLE_ENTITY, message)
    }

    /// Refuses a file outside the folders that may be written to.
    pub(super) fn forbidden(message: impl Into<String>) -> Self {
        Self::new(StatusCode::FORBIDDEN, message)
    }

    /// Refuses a change that is based on a state that has passed.
    pub(super) fn conflict(message: impl Into<String>) -> Self {
        Self::new(StatusCode::CONFLICT, message)
    }

    /// Refuses a change of a text that has changed since the page showed it.
    pub(super) fn changed() -> Self {
        Self::conflict("the text has changed in the meantime")
    }

    /// Answers a request that a newer one has replaced.
    pub(super) fn replaced() -> Self {
        Self::new(StatusCode::GONE, "a newer request has replaced this one")
    }
}

impl From<Failure> for Refusal {
    fn from(failure: Failure) -> Self {
        Self::wrong(failure.message())
    }
}

impl From<Diagnostics> for Refusal {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::from(Failure::File(diagnostics))
    }
}

impl From<Diagnostic> for Refusal {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::from(Diagnostics::from(diagnostic))
    }
}

impl From<WriteError> for Refusal {
    fn from(error: WriteError) -> Self {
        Self::wrong(error.to_string())
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (self.status, Json(json!({ "error": self.message }))).into_response()
    }
}
