//! Mistakes in a text, at the places where an editor underlines them.

use std::sync::Arc;

use serde::Serialize;

use crate::diagnostic::{Diagnostic, Diagnostics, Severity, Source};

/// A mistake, as `kfrac check` reports it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Problem {
    /// First and last position in the text, in UTF-16 units; `None` if it lies in another file.
    pub(super) range: Option<[usize; 2]>,
    /// Name of the other file.
    pub(super) file: Option<String>,
    line: Option<usize>,
    column: Option<usize>,
    severity: &'static str,
    pub(super) message: String,
    hint: Option<String>,
}

impl Problem {
    /// Returns whether it is an error, and no warning.
    pub(super) fn is_error(&self) -> bool {
        self.severity == "error"
    }
}

/// Returns the mistakes in a source, in the order of their places.
pub(super) fn problems(
    diagnostics: &Diagnostics,
    source: &Arc<Source>,
    text: &str,
) -> Vec<Problem> {
    // The reader leaves out a byte order mark.
    let mark = text.len() - source.text().len();
    let mut problems: Vec<_> = diagnostics
        .iter()
        .map(|diagnostic| problem(diagnostic, source, text, mark))
        .collect();
    problems.sort_by_key(|problem| (problem.range.is_none(), problem.range));
    problems
}

fn problem(diagnostic: &Diagnostic, source: &Arc<Source>, text: &str, mark: usize) -> Problem {
    let place = diagnostic.place();
    let own = place.filter(|place| place.source().name() == source.name());
    let range = own.map(|place| {
        let range = place.range();
        let from = utf16(text, range.start + mark);
        [from, utf16(text, range.end + mark).max(from)]
    });
    let other = place.filter(|_| own.is_none());
    Problem {
        range,
        file: other.map(|place| place.source().name().to_owned()),
        line: place.map(crate::diagnostic::Place::line),
        column: place.map(crate::diagnostic::Place::column),
        severity: match diagnostic.severity() {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        message: diagnostic.message().to_owned(),
        hint: diagnostic.hint_text().map(str::to_owned),
    }
}

/// Returns the position in UTF-16 units, in which pages count, of a byte.
fn utf16(text: &str, byte: usize) -> usize {
    let before = text.get(..byte).unwrap_or(text);
    before.encode_utf16().count()
}

#[cfg(test)]
mod tests {
    use super::problems;
    use crate::catalogue::Catalogue;
    use crate::diagnostic::Source;
    use crate::document::Document;

    #[test]
    fn places_are_counted_as_pages_count_them() {
        let text = "\u{feff}title: 🌲🌲\ninitiator: segmet\n";
        let source = Source::new("tree.yaml", text);
        let read = Document::read(&source, &Catalogue::embedded());
        let found = problems(&read.unwrap_err(), &source, text);
        let wide: Vec<u16> = text.encode_utf16().collect();
        let places = found.iter().filter_map(|problem| problem.range);
        let marked: Vec<_> = places
            .map(|[from, to]| String::from_utf16_lossy(&wide[from..to]))
            .collect();
        assert!(marked.contains(&"segmet".to_owned()), "{marked:?}");
    }
}
