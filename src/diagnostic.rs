//! Mistakes in a file, reported as compilers do: what is wrong, where, and what would be right.
//!
//! A [`Source`] is a text with its name, a [`Place`] a stretch of it, a [`Diagnostic`] one mistake
//! and [`Diagnostics`] all of them. What they print is the same on every machine and terminal.

use std::collections::HashSet;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

mod render;
mod source;
mod suggest;

pub use source::{Place, Source};
pub use suggest::did_you_mean;
pub(crate) use suggest::{listed, nearest};

/// How bad it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The file cannot be used.
    Error,
    /// The file can be used, but probably says something else than was meant.
    Warning,
}

/// One mistake: what is wrong, where, and how to mend it.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    severity: Severity,
    message: String,
    place: Option<Place>,
    hint: Option<String>,
}

impl Diagnostic {
    /// A mistake that makes the file unusable.
    pub fn error(message: impl Into<String>) -> Self {
        Self::new(Severity::Error, message.into())
    }

    /// A likely mistake in a file that can be used.
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

    /// The same mistake with the place it is at.
    #[must_use]
    pub fn at(mut self, place: &Place) -> Self {
        self.place = Some(place.clone());
        self
    }

    /// The same mistake with what would mend it.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(shortened(hint.into()));
        self
    }

    /// How bad it is.
    #[must_use]
    pub fn severity(&self) -> Severity {
        self.severity
    }

    /// What is wrong.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Where it is wrong.
    #[must_use]
    pub fn place(&self) -> Option<&Place> {
        self.place.as_ref()
    }

    /// What would be right.
    #[must_use]
    pub fn hint_text(&self) -> Option<&str> {
        self.hint.as_deref()
    }
}

/// Characters of a message or hint that are kept: names in it may be of any length.
const MOST_SAID: usize = 600;

/// The text, without its middle if it is too long.
fn shortened(text: String) -> String {
    if text.len() <= MOST_SAID {
        return text;
    }
    let start = source::char_boundary(&text, MOST_SAID / 2);
    let end = source::char_boundary(&text, text.len() - MOST_SAID / 2);
    format!("{} ... {}", &text[..start], &text[end..])
}

/// All that is wrong with a file. It displays as plain text, as [`Diagnostics::render`] without
/// colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnostics(Vec<Diagnostic>);

impl Diagnostics {
    /// Adds a mistake.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic);
    }

    /// Whether nothing is wrong, not even a warning.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether one of them is an error.
    #[must_use]
    pub fn has_errors(&self) -> bool {
        self.iter()
            .any(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// The mistakes in the order they were found.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.0.iter()
    }

    /// Each mistake once: what a file holds may be used, and looked at, several times.
    #[must_use]
    pub(crate) fn without_repeats(self) -> Self {
        let mut said = HashSet::new();
        let new = |diagnostic: &Diagnostic| {
            let place = diagnostic.place.as_ref();
            let place = place.map(|place| (place.source().name().to_owned(), place.range()));
            said.insert((place, diagnostic.message.clone()))
        };
        let mut all = self.0;
        all.retain(new);
        Self(all)
    }

    /// The text that a person reads: sorted by source (in the order the sources were first named)
    /// and place, what has no place at the end; each mistake once; the first
    /// 100 in full and the number of the others. Lines are 100 columns wide whatever the terminal.
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
