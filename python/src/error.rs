//! `KfracError`, and the failures that become one.

use kfrac::diagnostic::{Diagnostic, Diagnostics, Severity};
use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::results::named;

create_exception!(
    kfrac,
    KfracError,
    PyValueError,
    "Mistake in a file or an argument. `diagnostics` lists the mistakes in a file, each with its place."
);

/// Failure of work.
pub(crate) enum Failure {
    /// Mistakes in a file, with their places.
    Diagnostics(Diagnostics),
    /// Any other message.
    Message(String),
}

impl From<kfrac::Error> for Failure {
    fn from(error: kfrac::Error) -> Self {
        match error {
            kfrac::Error::Invalid(diagnostics) => Self::Diagnostics(diagnostics),
            error => Self::Message(error.to_string()),
        }
    }
}

impl From<Diagnostic> for Failure {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Diagnostics(diagnostic.into())
    }
}

impl Failure {
    /// Makes a failure of any error.
    pub(crate) fn of(error: impl std::fmt::Display) -> Self {
        Self::Message(error.to_string())
    }

    /// Converts to a `KfracError`.
    pub(crate) fn into_exception(self, py: Python<'_>) -> PyErr {
        let (message, diagnostics) = match self {
            Self::Diagnostics(diagnostics) => {
                let text = diagnostics.to_string();
                (text.trim_end().to_owned(), diagnostics)
            }
            Self::Message(message) => (message, Diagnostics::default()),
        };
        let error = KfracError::new_err(message);
        let listed = listed(py, &diagnostics);
        match listed.and_then(|listed| error.value(py).setattr("diagnostics", listed)) {
            Ok(()) => error,
            Err(other) => other,
        }
    }
}

/// Returns diagnostics as named tuples.
pub(crate) fn listed<'py>(
    py: Python<'py>,
    diagnostics: &Diagnostics,
) -> PyResult<Vec<Bound<'py, PyAny>>> {
    let one = |found: &Diagnostic| {
        let place = found.place();
        let severity = match found.severity() {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        named(
            py,
            "Diagnostic",
            (
                place.map(|place| place.source().name()),
                place.map(|place| place.line()),
                place.map(|place| place.column()),
                severity,
                found.message(),
                found.hint_text(),
            ),
        )
    };
    diagnostics.iter().map(one).collect()
}
