//! Rendering of a diagnostic with the line of its file, by `annotate-snippets`, in the style of rustc.

use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use super::{Diagnostic, Place, Severity};

/// Width of the text in columns, fixed so that outputs can be compared.
const WIDTH: usize = 100;

/// Number of characters of a line before and after a span that are handed to the renderer, which trims
/// them to [`WIDTH`]. The renderer's time is linear in this length, for each diagnostic.
const CONTEXT: usize = 2 * WIDTH;

/// Returns the text of a diagnostic, with ANSI colours if `color` is set.
pub(super) fn one(diagnostic: &Diagnostic, color: bool) -> String {
    let renderer = if color {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    let renderer = renderer.term_width(WIDTH);
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let mut group = Group::with_title(level.primary_title(diagnostic.message.as_str()));
    let window = diagnostic.place.as_ref().map(Window::around);
    if let Some(window) = &window {
        group = group.element(
            Snippet::source(window.text)
                .path(window.name)
                .line_start(window.line)
                .annotation(AnnotationKind::Primary.span(window.underlined.clone())),
        );
    }
    if let Some(hint) = &diagnostic.hint {
        group = group.element(Level::HELP.message(hint.as_str()));
    }
    let text = renderer.render(&[group]);
    match window {
        Some(window) => window.correct_column(&text),
        None => text,
    }
}

/// The visible part of the first line of a span.
struct Window<'a> {
    name: &'a str,
    text: &'a str,
    /// Byte range of the span within `text`.
    underlined: Range<usize>,
    line: usize,
    column: usize,
}

impl<'a> Window<'a> {
    fn around(place: &'a Place) -> Self {
        let source = place.source();
        let text = source.text();
        let line = source.line_range(source.line_of(place.range().start));
        let start = place.range().start.min(line.end);
        let end = place.range().end.clamp(start, line.end);
        let shown_after = |from: usize, to: usize| {
            text[from..to]
                .char_indices()
                .nth(CONTEXT)
                .map_or(to, |(byte, _)| from + byte)
        };
        let end = shown_after(start, end);
        let before = text[line.start..start]
            .char_indices()
            .rev()
            .take(CONTEXT)
            .last();
        let first = before.map_or(start, |(byte, _)| line.start + byte);
        Self {
            name: source.name(),
            text: &text[first..shown_after(end, line.end)],
            underlined: start - first..end - first,
            line: place.line(),
            column: place.column(),
        }
    }

    /// Replaces the column in the rendered heading, which the renderer counts from the start of the
    /// window, by the column in the line.
    fn correct_column(&self, rendered: &str) -> String {
        let (name, line) = (self.name, self.line);
        let counted = self.text[..self.underlined.start].chars().count() + 1;
        let heading = |column| format!("{name}:{line}:{column}\n");
        rendered.replacen(&heading(counted), &heading(self.column), 1)
    }
}
