//! Diagnostics for mistakes of syntax: translations of the parser's errors, with help texts.

use std::ops::Range;
use std::sync::Arc;

use granit_parser::{ErrorKind, ScanError};

use super::limits::too_deep;
use crate::diagnostic::{Diagnostic, Place, Source};
use crate::document::node::{Node, Value};

/// Returns an error for a control character that YAML excludes, which most binary files contain.
pub(super) fn check_characters(source: &Arc<Source>) -> Result<(), Diagnostic> {
    let refused = |c: &(usize, char)| c.1.is_control() && !"\t\n\r\u{85}".contains(c.1);
    let Some((start, character)) = source.text().char_indices().find(refused) else {
        return Ok(());
    };
    let message = match character {
        '\0' => format!(
            "'{}' is not a text file: it holds a zero byte",
            source.name()
        ),
        _ => format!(
            "the control character U+{:04X} is not allowed",
            u32::from(character)
        ),
    };
    Err(Diagnostic::error(message).at(&Place::new(source, start..start + character.len_utf8())))
}

/// Returns the error for a file without a document.
pub(super) fn empty(source: &Arc<Source>) -> Diagnostic {
    let text = source.text();
    let message = if text.contains('#') {
        "the file holds only comments"
    } else {
        "the file is empty"
    };
    Diagnostic::error(message)
        .at(&Place::new(source, 0..0))
        .hint("a file holds 'key: value' lines, such as 'title: Koch curve'")
}

/// Returns the error for a second document.
pub(super) fn second_document(place: &Place) -> Diagnostic {
    Diagnostic::error("a second document starts here")
        .at(place)
        .hint("a file holds one document: remove the '---', or put the rest in a file of its own")
}

/// Returns the error for a tag.
pub(super) fn tag(tag: &str, place: &Place) -> Diagnostic {
    Diagnostic::error(format!(
        "tags such as '{}' are not used here",
        super::repair::short(tag)
    ))
    .at(place)
    .hint("leave it out, or put text that starts with '!' in quotes")
}

/// Returns the error for a condition that begins with '!'.
pub(super) fn negation(place: &Place) -> Diagnostic {
    let text = place.text();
    let condition = super::repair::short(text.strip_prefix('!').unwrap_or(text).trim_start());
    Diagnostic::error("YAML reads a '!' at the beginning as a tag")
        .at(place)
        .hint(format!(
            "write not {condition}, or quote it: \"!{condition}\""
        ))
}

/// Returns the error for an alias inside its own anchor's value.
pub(super) fn alias_inside_itself(place: &Place) -> Diagnostic {
    Diagnostic::error(format!(
        "'{}' stands inside of what it refers to",
        place.text()
    ))
    .at(place)
}

/// Returns the error for a key that is not text.
pub(super) fn no_key(key: &Node) -> Diagnostic {
    let message = match key.value {
        Value::Sequence(_) | Value::Mapping(_) => format!("{} cannot be a key", key.kind()),
        _ => "this entry has no key".to_owned(),
    };
    Diagnostic::error(message)
        .at(&key.place)
        .hint("a key is text, as in 'key: value'")
}

/// Translates an error of the parser. `last` is the range of the preceding scalar, and `flow` the start
/// of the innermost open collection in flow style.
pub(super) fn translate(
    error: &ScanError,
    source: &Arc<Source>,
    last: &Range<usize>,
    flow: Option<usize>,
) -> Diagnostic {
    let text = source.text();
    let at = error
        .marker()
        .byte_offset()
        .unwrap_or(text.len())
        .min(text.len());
    let rest = text.get(at..).unwrap_or_default();
    let char_len = rest
        .chars()
        .next()
        .filter(|c| !"\r\n".contains(*c))
        .map_or(0, char::len_utf8);
    let place = Place::new(source, at..at + char_len);
    // A colour read as a comment swallows the closing bracket, and the parser reports the lines below.
    let unclosed = matches!(
        error.kind(),
        ErrorKind::UnclosedFlowCollection { .. }
            | ErrorKind::ExpectedFlowMappingSeparator
            | ErrorKind::ExpectedFlowSequenceSeparator
            | ErrorKind::InvalidFlowScalarIndent
            | ErrorKind::InvalidIndentation
            | ErrorKind::MappingValueNotAllowed
            | ErrorKind::InvalidColonPlacement
            | ErrorKind::MismatchedFlowCollectionEnd { .. }
    );
    // The parser's look-ahead may fail before it has reported the opening bracket.
    let flow = flow.or_else(|| match error.kind() {
        ErrorKind::BlockEntryInFlowCollection => open_bracket(text.get(..at)?),
        _ => None,
    });
    // A key or an entry below that is not indented further does not belong to the open collection.
    let open = flow.filter(|start| {
        let [above, here] = [*start, at].map(|at| source.line_column(line_start(source, at)));
        let is_below = here.0 > above.0 && here.1 <= above.1;
        let is_other = match error.kind() {
            ErrorKind::InvalidColonPlacement | ErrorKind::BlockEntryInFlowCollection => true,
            ErrorKind::ExpectedFlowMappingSeparator | ErrorKind::ExpectedFlowSequenceSeparator => {
                rest.starts_with(':')
            }
            _ => false,
        };
        is_other && is_below
    });
    let flow = match flow {
        Some(start) if start < at => start..at,
        // The error is located at the bracket itself.
        _ => at..text.len(),
    };
    let color = super::repair::color_in(&Place::new(source, flow)).filter(|_| unclosed);
    if let Some(color) = color {
        return super::repair::color_is_comment(&color);
    }
    if let Some(open) = open {
        let bracket = Place::new(source, open..open + 1);
        let close = if bracket.text() == "[" { "]" } else { "}" };
        return Diagnostic::error(format!("this '{}' is never closed", bracket.text()))
            .at(&bracket)
            .hint(format!("close it with '{close}'"));
    }
    let (message, hint) = match error.kind() {
        ErrorKind::RecursionLimitExceeded => return too_deep(&place),
        ErrorKind::UnknownAnchor | ErrorKind::MissingAnchorOrAliasName => {
            let word = rest
                .split([' ', ',', ']', '}', '\r', '\n'])
                .next()
                .unwrap_or_default();
            return Diagnostic::error(format!("nothing is marked for '{word}' to refer to"))
                .at(&Place::new(source, at..at + word.len()))
                .hint("put text that starts with '*' or '&' in quotes");
        }
        ErrorKind::UndeclaredTagHandle => {
            let word = rest.split_whitespace().next().unwrap_or_default();
            return tag(word, &Place::new(source, at..at + word.len()));
        }
        ErrorKind::UnclosedFlowCollection { open } => {
            let hint = match open {
                _ if comment_in_line(rest) => COMMENT_HINT,
                '[' => "close it with ']'",
                _ => "close it with '}'",
            };
            (format!("this '{open}' is never closed"), hint)
        }
        ErrorKind::MismatchedFlowCollectionEnd { open, close } => (
            format!("this '{open}' is closed by a '{close}'"),
            "'[' goes with ']' and '{' with '}'",
        ),
        ErrorKind::MisplacedFlowCollectionEnd => (
            format!("this '{}' closes nothing", place.text()),
            "remove it, or put the text that holds it in quotes",
        ),
        ErrorKind::ExpectedFlowMappingSeparator => separator('}', last, source),
        ErrorKind::ExpectedFlowSequenceSeparator => separator(']', last, source),
        ErrorKind::UnclosedQuotedScalar
        | ErrorKind::InvalidQuotedScalarIndent
        | ErrorKind::DocumentIndicatorInQuotedScalar => return open_quote(&place, last),
        ErrorKind::InvalidBlockScalarHeader => (
            "YAML reads a '|' or '>' at the beginning as that of a text of several lines".into(),
            "put text that begins with it in quotes",
        ),
        ErrorKind::InvalidTrailingSingleQuotedScalar
        | ErrorKind::InvalidTrailingDoubleQuotedScalar => (
            "something follows the closing quote".into(),
            "put all of the text inside the quotes",
        ),
        ErrorKind::TabInBlockIndentation
        | ErrorKind::TabInIndentation
        | ErrorKind::TabNotAllowed
        | ErrorKind::TabAtBlockScalarStart
        | ErrorKind::InvalidBlockEntryWhitespace
        | ErrorKind::TabInPlainScalar => return tab(source, at),
        ErrorKind::MappingValueNotAllowed => return colon(source, at, last),
        ErrorKind::ExpectedBlockSequenceEntry => (
            "an entry of the list is expected here".into(),
            "the entries of a list start with '- ' in the same column",
        ),
        ErrorKind::ExpectedBlockMappingKey => (
            "a key is expected here".into(),
            "the keys of a mapping start in the same column; text with brackets or quotes in it \
             needs quotes around it",
        ),
        ErrorKind::InvalidIndentation | ErrorKind::InvalidFlowScalarIndent => (
            "the indentation is wrong here".into(),
            "indent with two spaces for each level",
        ),
        ErrorKind::BlockSequenceEntryNotAllowed => (
            "a list cannot start here".into(),
            "start it on the next line, or write it as [a, b]; text that starts with '- ' needs \
             quotes",
        ),
        ErrorKind::UnexpectedCharacter { character } => {
            if let Some(condition) = cut_negation(source, at) {
                return negation(&condition);
            }
            (
                format!("text cannot start with '{character}'"),
                "put the text in quotes",
            )
        }
        ErrorKind::SimpleKeyExpected | ErrorKind::InvalidSimpleKey => (
            "this line has no ':'".into(),
            "a key ends with ': ' on its own line",
        ),
        ErrorKind::InvalidColonPlacement => (
            format!("a '{}' is not expected here", place.text()),
            "is a bracket before it open?",
        ),
        ErrorKind::UnknownQuotedScalarEscape
        | ErrorKind::InvalidQuotedScalarHexEscape
        | ErrorKind::InvalidUnicodeEscape => (
            "the text in quotes holds a '\\' that means nothing".into(),
            "write '\\\\' for a backslash, or use single quotes",
        ),
        ErrorKind::CommentNotSeparated => (
            "a comment starts right behind a value".into(),
            "put a space before the '#'",
        ),
        ErrorKind::CommentInterceptedScalar => {
            ("a comment stands inside of a text".into(), COMMENT_HINT)
        }
        kind => (
            format!("this is not YAML: {kind}"),
            "is a quote or bracket missing?",
        ),
    };
    Diagnostic::error(message).at(&place).hint(hint)
}

/// Returns the place of a condition such as `!(i % 2 == 0)`, where the text after the supposed tag is
/// not valid YAML either.
fn cut_negation(source: &Arc<Source>, at: usize) -> Option<Place> {
    let before = source.text().get(..at)?;
    let line = before.rfind(['\n', '\r']).map_or(0, |end| end + 1);
    let start = line + before[line..].rfind("when: !")? + "when: ".len();
    let rest = source.text()[start..].lines().next()?;
    let end = rest.find([',', '}']).unwrap_or(rest.len());
    Some(Place::new(
        source,
        start..start + rest[..end].trim_end().len(),
    ))
}

const COMMENT_HINT: &str =
    "a '#' behind a space starts a comment: put text that holds one in quotes";

fn comment_in_line(rest: &str) -> bool {
    rest.lines().next().is_some_and(|line| line.contains(" #"))
}

fn separator(close: char, last: &Range<usize>, source: &Arc<Source>) -> (String, &'static str) {
    let message = format!("a ',' or '{close}' is expected here");
    if spans_lines(source, last) {
        return (
            message,
            "a bracket before it may be open: close it where the list or mapping ends",
        );
    }
    (
        message,
        "commas stand between the entries; text that holds ': ' or brackets needs quotes",
    )
}

/// Returns the error for an unclosed quote. The parser reports the place where it gave up. The quote
/// itself is the first one after the last scalar, unless other text stands between.
fn open_quote(gave_up: &Place, last: &Range<usize>) -> Diagnostic {
    let source = gave_up.source();
    let behind = source
        .text()
        .get(last.end..gave_up.range().start)
        .unwrap_or_default();
    let quote = behind.find(['"', '\'']).filter(|&quote| {
        behind[..quote]
            .chars()
            .all(|c| c.is_whitespace() || ":,-[]{}".contains(c))
    });
    let hint = "close it where the text ends";
    match quote.map(|quote| last.end + quote) {
        Some(start) => Diagnostic::error("this quote is never closed")
            .at(&Place::new(source, start..start + 1))
            .hint(hint),
        None => Diagnostic::error("a quote that is opened above is still open here")
            .at(gave_up)
            .hint(hint),
    }
}

fn tab(source: &Arc<Source>, at: usize) -> Diagnostic {
    let bytes = source.text().as_bytes();
    let is_tab = |offset: usize| bytes.get(offset) == Some(&b'\t');
    let start = if !is_tab(at) && at > 0 && is_tab(at - 1) {
        at - 1
    } else {
        at
    };
    Diagnostic::error("a tab is used as indentation")
        .at(&Place::new(source, start..start + 1))
        .hint("YAML is indented with spaces: use two for each level")
}

/// Returns the error for a misplaced ':': the second one in a line, or one in a line that continues the
/// previous line's text.
fn colon(source: &Arc<Source>, at: usize, last: &Range<usize>) -> Diagnostic {
    /// Number of characters within which the ':' of a key comes (YAML 1.2.2, section 7.4.2).
    const LONGEST_KEY: usize = 1024;
    if spans_lines(source, last) && last.end == at {
        let (line, _) = source.line_column(last.start);
        return Diagnostic::error(format!("this line continues the text of line {line}"))
            .at(&Place::new(source, line_start(source, at)..at))
            .hint("check its indentation, and that the line before has a ': ' with the space");
    }
    let text = source.text().get(last.clone()).unwrap_or_default();
    if last.end == at && text.chars().count() > LONGEST_KEY {
        return Diagnostic::error("a key has at most 1,024 characters")
            .at(&Place::new(source, last.clone()))
            .hint("write a shorter one");
    }
    Diagnostic::error("a second ':' in a line")
        .at(&Place::new(source, at..at + 1))
        .hint("put text that holds ': ' in quotes")
}

fn spans_lines(source: &Arc<Source>, range: &Range<usize>) -> bool {
    source
        .text()
        .get(range.clone())
        .is_some_and(|text| text.contains(['\n', '\r']))
}

/// Returns the offset of the last bracket that is not closed in the text.
fn open_bracket(text: &str) -> Option<usize> {
    let mut closed = 0;
    let mut brackets = text.rmatch_indices(['[', ']', '{', '}']);
    let open = brackets.find(|(_, bracket)| match (*bracket, closed) {
        ("]" | "}", _) => {
            closed += 1;
            false
        }
        (_, 0) => true,
        _ => {
            closed -= 1;
            false
        }
    });
    open.map(|(start, _)| start)
}

/// Returns the offset of the first character after the indentation of the line.
fn line_start(source: &Arc<Source>, at: usize) -> usize {
    let before = source.text().get(..at).unwrap_or_default();
    let line = before.rsplit(['\n', '\r']).next().unwrap_or_default();
    at - line.trim_start().len()
}
