//! Rendering of diagnostics as text.

#[cfg(feature = "snippets")]
use super::snippet::one;
use super::{Diagnostic, Severity, Source};

/// Maximum number of diagnostics that are shown in full.
const SHOWN: usize = 100;

/// Renders the diagnostics, sorted by source and position.
pub(super) fn render(diagnostics: &[Diagnostic], color: bool) -> String {
    let mut sorted = sorted(diagnostics);
    if sorted.len() > SHOWN {
        // A warning must not displace an error.
        sorted.sort_by_key(|diagnostic| diagnostic.severity == Severity::Warning);
    }
    let mut out = String::new();
    for diagnostic in sorted.iter().take(SHOWN) {
        out += &one(diagnostic, color);
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

/// Returns the message of a diagnostic, its place and its remedy, without the line of the file.
#[cfg(not(feature = "snippets"))]
fn one(diagnostic: &Diagnostic, _: bool) -> String {
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let mut text = format!("{severity}: {}", diagnostic.message);
    if let Some(place) = &diagnostic.place {
        let [name, line, column] = [
            place.source().name(),
            &place.line().to_string(),
            &place.column().to_string(),
        ];
        text += &format!("\n --> {name}:{line}:{column}");
    }
    if let Some(hint) = &diagnostic.hint {
        text += &format!("\n  = help: {hint}");
    }
    text
}

#[cfg(all(test, feature = "snippets"))]
mod tests {
    use std::ops::Range;
    use std::sync::Arc;

    use super::super::{Diagnostic, Diagnostics, Place, Source};

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
