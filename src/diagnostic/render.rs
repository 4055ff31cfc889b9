//! Rendering of diagnostics as text by `annotate-snippets`, in the style of rustc.

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use super::{Diagnostic, Place, Range, Severity, Source};

/// Width of the text in columns, fixed so that outputs can be compared.
const WIDTH: usize = 100;
/// Maximum number of diagnostics that are shown in full.
const SHOWN: usize = 100;
/// Number of characters of a line before and after a span that are handed to the renderer, which trims
/// them to [`WIDTH`]. The renderer's time is linear in this length, for each diagnostic.
const CONTEXT: usize = 2 * WIDTH;

/// Renders the diagnostics, sorted by source and position.
pub(super) fn render(diagnostics: &[Diagnostic], color: bool) -> String {
    let renderer = if color {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    let renderer = renderer.term_width(WIDTH);
    let mut sorted = sorted(diagnostics);
    if sorted.len() > SHOWN {
        // A warning must not displace an error.
        sorted.sort_by_key(|diagnostic| diagnostic.severity == Severity::Warning);
    }
    let mut out = String::new();
    for diagnostic in sorted.iter().take(SHOWN) {
        out += &one(&renderer, diagnostic);
        out += "\n\n";
    }
    if sorted.len() > SHOWN {
        out += &["and ", &(sorted.len() - SHOWN).to_string(), " more"].concat();
    }
    out.truncate(out.trim_end().len());
    out
}

/// Returns the diagnostics sorted by source and position, without adjacent duplicates, which arise from
/// YAML aliases.
fn sorted(diagnostics: &[Diagnostic]) -> Vec<&Diagnostic> {
    let mut sources: Vec<&Source> = Vec::new();
    let mut keyed: Vec<_> = diagnostics
        .iter()
        .map(|diagnostic| {
            let key = diagnostic
                .place
                .as_ref()
                .map_or((usize::MAX, 0, 0), |place| {
                    let source: &Source = place.source();
                    let number = sources.iter().position(|known| known.is(source));
                    let number = number.unwrap_or_else(|| {
                        sources.push(source);
                        sources.len() - 1
                    });
                    (number, place.range().start, place.range().end)
                });
            (key, diagnostic)
        })
        .collect();
    keyed.sort_by_key(|(key, _)| *key);
    keyed.dedup_by(|a, b| a == b);
    keyed
        .into_iter()
        .map(|(_, diagnostic)| diagnostic)
        .collect()
}

fn one(renderer: &Renderer, diagnostic: &Diagnostic) -> String {
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

#[cfg(test)]
mod tests {
    use super::super::{Arc, Diagnostic, Diagnostics, Place, Range, Source};

    fn at(source: &Arc<Source>, range: Range<usize>) -> Diagnostic {
        Diagnostic::error("here").at(&Place::new(source, range))
    }

    #[test]
    fn mistakes_are_sorted_and_each_is_said_once() {
        let source = Source::new("koch.yaml", "title: Köch\r\ngenerator:\r\n  - [0, 0]\r\n");
        let place = |range| Place::new(&source, range);
        let all: Diagnostics = [
            Diagnostic::error("no place"),
            Diagnostic::warning("over lines")
                .at(&place(14..37))
                .hint("mend it"),
            Diagnostic::error("unknown title").at(&place(7..12)),
            at(&source, 99..99),
            Diagnostic::error("empty")
                .at(&place(6..6))
                .hint("two\nlines"),
            Diagnostic::error("unknown title").at(&place(7..12)),
            Diagnostic::error("a \u{1b}[31mlie").at(&place(12..12)),
        ]
        .into_iter()
        .collect();
        assert_eq!(
            all.to_string(),
            "\
error: empty
 --> koch.yaml:1:7
  |
1 | title: Köch
  |       ^
  |
  = help: two
          lines

error: unknown title
 --> koch.yaml:1:8
  |
1 | title: Köch
  |        ^^^^

error: a ␛[31mlie
 --> koch.yaml:1:12
  |
1 | title: Köch
  |            ^

warning: over lines
 --> koch.yaml:2:1
  |
2 | generator:
  | ^^^^^^^^^^
  |
  = help: mend it

error: here
 --> koch.yaml:4:1
  |
4 |
  | ^

error: no place"
        );
        assert!(all.render(true).contains("\u{1b}["));
        assert!(all.has_errors());
    }

    #[test]
    fn long_lines_are_trimmed_and_keep_their_columns() {
        let text = format!("a: b\n{}", "ä123456789".repeat(100_000));
        let source = Source::new("long.yaml", text);
        let all: Diagnostics = [
            at(&source, 5..8),
            at(&source, 550_005..550_008),
            at(&source, 5..800_000),
        ]
        .into_iter()
        .collect();
        assert_eq!(
            all.to_string(),
            "\
error: here
 --> long.yaml:2:1
  |
2 | ä123456789ä123456789ä123456789ä123456789ä123456789ä123456789ä123456789ä123456789ä123456789ä12...
  | ^^

error: here
 --> long.yaml:2:1
  |
2 | ä123456789ä123456789ä123456789ä1...89ä123456789ä123456789ä123456789ä12...
  | ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^...^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^

error: here
 --> long.yaml:2:500001
  |
2 | ...6789ä123456789ä123456789ä123456789ä123456789ä123456789ä123456789ä123456789ä123456789ä12345...
  |                                                ^^"
        );
    }

    #[test]
    fn what_is_too_much_is_counted() {
        let source = Source::new("a", "x\n".repeat(1000));
        let all: Diagnostics = (0..1000)
            .map(|line| at(&source, 2 * line..2 * line + 1))
            .collect();
        assert!(
            all.to_string()
                .ends_with("100 | x\n    | ^\n\nand 900 more")
        );
        assert_eq!(Diagnostics::default().to_string(), "");
    }
}
