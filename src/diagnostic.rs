//! Diagnostics: messages about mistakes in a file, each with a source span and a help text, printed in
//! the style of rustc.
//!
//! A [`Source`] is a text with a name, a [`Place`] is a span of a source, a [`Diagnostic`] is one
//! mistake, and [`Diagnostics`] collects all mistakes of a file. The rendered text does not depend on
//! the machine or the terminal.

use std::collections::HashSet;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

mod render;
#[cfg(feature = "snippets")]
mod snippet;
mod source;
mod suggest;

pub use source::{Place, Source};
pub use suggest::did_you_mean;
pub(crate) use suggest::{MAX_CANDIDATES, listed, nearest};

/// Severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// A mistake that makes the file unusable.
    Error,
    /// A probable mistake in a file that can be used.
    Warning,
}

/// A message with an optional source span and an optional help text.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    severity: Severity,
    message: String,
    place: Option<Place>,
    hint: Option<String>,
}

impl Diagnostic {
    /// Creates an error: a mistake that makes the file unusable.
    pub fn error(message: impl Into<String>) -> Self {
        Self::new(Severity::Error, message.into())
    }

    /// Creates a warning: a probable mistake in a file that can be used.
    pub fn warning(message: impl Into<String>) -> Self {
        Self::new(Severity::Warning, message.into())
    }

    fn new(severity: Severity, message: String) -> Self {
        Self {
            severity,
            message: shortened(message),
            place: None,
            hint: None,
        }
    }

    /// Sets the source span.
    #[must_use]
    pub fn at(mut self, place: &Place) -> Self {
        self.place = Some(place.clone());
        self
    }

    /// Sets the help text, which describes a remedy. A text of more than 600 bytes is cut in the
    /// middle.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(shortened(hint.into()));
        self
    }

    /// Returns the severity.
    #[must_use]
    pub fn severity(&self) -> Severity {
        self.severity
    }

    /// Returns the message.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Returns the source span, if there is one.
    #[must_use]
    pub fn place(&self) -> Option<&Place> {
        self.place.as_ref()
    }

    /// Returns the help text, if there is one.
    #[must_use]
    pub fn hint_text(&self) -> Option<&str> {
        self.hint.as_deref()
    }
}

/// Displays the message without its place and remedy; [`Diagnostics`] display all.
impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Diagnostic {}

/// Length in bytes beyond which messages and help texts are cut: names in them may have any length.
const MAX_LENGTH: usize = 600;

/// Returns the text, with its middle replaced by ` ... ` if it is longer than [`MAX_LENGTH`].
fn shortened(text: String) -> String {
    if text.len() <= MAX_LENGTH {
        return text;
    }
    let start = source::char_boundary(&text, MAX_LENGTH / 2);
    let end = source::char_boundary(&text, text.len() - MAX_LENGTH / 2);
    format!("{} ... {}", &text[..start], &text[end..])
}

/// All diagnostics of a file. `Display` writes plain text, as [`Diagnostics::render`] does without
/// colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnostics(Vec<Diagnostic>);

impl Diagnostics {
    /// Appends a diagnostic.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic);
    }

    /// Returns whether there are no diagnostics, neither errors nor warnings.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the number of diagnostics.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns whether at least one diagnostic is an error.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.iter()
            .any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// Iterates over the diagnostics in the order in which they were added.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.0.iter()
    }

    /// Removes duplicates, which have equal messages and equal spans in sources of the same name: one
    /// part of a file may be checked several times.
    #[must_use]
    pub(crate) fn without_repeats(self) -> Self {
        let mut seen = HashSet::new();
        let new = |diagnostic: &Diagnostic| {
            let place = diagnostic.place.as_ref();
            let place = place.map(|place| (place.source().name().to_owned(), place.range()));
            seen.insert((place, diagnostic.message.clone()))
        };
        let mut all = self.0;
        all.retain(new);
        Self(all)
    }

    /// Renders the diagnostics as text for a person, with ANSI colours if `color` is set. Without the feature `snippets`,
    /// there are no colours, and places are named without the lines of the file.
    ///
    /// Diagnostics are sorted by source (in order of first occurrence) and position; diagnostics
    /// without a span come last. Adjacent duplicates are omitted. The first 100 diagnostics are shown
    /// in full, errors before warnings if there are more, and the others are counted. Lines are 100
    /// columns wide on every terminal.
    #[must_use]
    pub fn render(&self, color: bool) -> String {
        render::render(&self.0, color)
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Diagnostics {}

impl From<Diagnostic> for Diagnostics {
    fn from(diagnostic: Diagnostic) -> Self {
        Self(vec![diagnostic])
    }
}

impl FromIterator<Diagnostic> for Diagnostics {
    fn from_iter<I: IntoIterator<Item = Diagnostic>>(diagnostics: I) -> Self {
        Self(diagnostics.into_iter().collect())
    }
}

impl Extend<Diagnostic> for Diagnostics {
    fn extend<I: IntoIterator<Item = Diagnostic>>(&mut self, diagnostics: I) {
        self.0.extend(diagnostics);
    }
}

impl IntoIterator for Diagnostics {
    type Item = Diagnostic;
    type IntoIter = std::vec::IntoIter<Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}
