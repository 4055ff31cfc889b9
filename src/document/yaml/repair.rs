//! Recovery from mistakes with a probable meaning: commas inside expressions, colours that YAML reads
//! as comments, duplicate keys, and merge keys without a mapping.

use std::collections::HashMap;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};
use crate::document::node::{Key, Node, Value};

/// An item of a list or an entry of a mapping.
pub(super) struct RepairItem {
    /// The key of an entry, and whether it is written without quotes.
    pub(super) key: Option<(Key, bool)>,
    pub(super) value: Node,
    /// Whether the value is written without quotes.
    pub(super) plain: bool,
}

impl RepairItem {
    /// Returns the text of this item if it can be the continuation of a value that was cut at a comma:
    /// a plain item of a list, or a plain key without a value.
    fn rest(&self) -> Option<&Place> {
        match &self.key {
            None => self.plain.then_some(&self.value.place),
            Some((key, true)) if self.value.place.text().is_empty() => Some(&key.place),
            Some(_) => None,
        }
    }
}

/// Maximum number of pieces that are joined.
const MAX_PIECES: usize = 16;

/// Joins the pieces of unquoted expressions in flow style such as `uniform(-20, 20)`, where YAML ends
/// the value at the comma, and reports each.
pub(super) fn join_at_commas(
    items: &mut Vec<RepairItem>,
    source: &Arc<Source>,
    found: &mut Diagnostics,
) {
    let mut joined = Vec::with_capacity(items.len());
    let mut rest = std::mem::take(items).into_iter();
    while let Some(mut item) = rest.next() {
        if let Some((pieces, end)) = cut_at_commas(&item, rest.as_slice()) {
            let place = Place::new(source, item.value.place.range().start..end);
            found.push(
                Diagnostic::error(format!("the comma splits '{}'", short(place.text())))
                    .at(&place)
                    .hint(
                        "in YAML's flow style a comma ends the value: put the expression in \
                         quotes, or on a line of its own",
                    ),
            );
            item.value = Node {
                value: Value::Text(place.text().to_owned()),
                place,
            };
            rest.by_ref().take(pieces).for_each(drop);
        }
        joined.push(item);
    }
    *items = joined;
}

/// Returns the number of following items that continue the value of this item up to balanced brackets,
/// and the byte offset of their end.
fn cut_at_commas(item: &RepairItem, following: &[RepairItem]) -> Option<(usize, usize)> {
    let Value::Text(text) = &item.value.value else {
        return None;
    };
    let mut open = open_brackets(text);
    if !item.plain || open <= 0 {
        return None;
    }
    for (index, piece) in following.iter().take(MAX_PIECES).enumerate() {
        let place = piece.rest()?;
        open += open_brackets(place.text());
        if open <= 0 {
            return (open == 0).then_some((index + 1, place.range().end));
        }
    }
    None
}

fn open_brackets(text: &str) -> isize {
    text.bytes().fold(0, |open, byte| match byte {
        b'(' => open + 1,
        b')' => open - 1,
        _ => open,
    })
}

/// Returns the text, cut after 40 characters, for a message of one line.
pub(super) fn short(text: &str) -> String {
    match text.char_indices().nth(40) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// Recovers a missing value that is a colour such as `#ff0000`, which YAML reads as a comment.
pub(super) fn color_read_as_comment(nothing: &Place) -> Option<(Diagnostic, Node)> {
    let source = nothing.source();
    let text = source.text();
    let at = nothing.range().start;
    let start = text[..at].rfind(['\n', '\r']).map_or(0, |end| end + 1);
    let line = text[start..].lines().next()?;
    // The parser locates a missing value before or after the comment.
    let place = color_in(&Place::new(source, start..start + line.len()))?;
    let value = Value::Text(place.text().to_owned());
    Some((color_is_comment(&place), Node { place, value }))
}

/// Returns the first colour that YAML reads as a comment in a span.
pub(super) fn color_in(stretch: &Place) -> Option<Place> {
    let text = stretch.text();
    let color = |(at, _): (usize, &str)| {
        let (before, comment) = (&text[..at], &text[at + " #".len()..]);
        let is_digit = |c: char| c.is_ascii_hexdigit();
        let digits = comment.find(|c| !is_digit(c)).unwrap_or(comment.len());
        let ends = !comment[digits..].starts_with(|c: char| c.is_alphanumeric());
        let is_value = before.trim_end().ends_with([':', '-', ',', '[']);
        let is_color = matches!(digits, 3 | 4 | 6 | 8) && ends && is_value;
        is_color.then_some(at + 1..at + " #".len() + digits)
    };
    let range = text.match_indices(" #").find_map(color)?;
    let start = stretch.range().start;
    let source = stretch.source();
    Some(Place::new(source, start + range.start..start + range.end))
}

/// Returns the error for a colour that YAML reads as a comment.
pub(super) fn color_is_comment(color: &Place) -> Diagnostic {
    let text = color.text();
    Diagnostic::error(format!("'{text}' is read as a comment"))
        .at(color)
        .hint(format!("write \"{text}\""))
}

/// Returns the entries of a mapping with unique keys, and with the mappings of merge keys (`<<`)
/// inserted in their places. The mapping's own keys take precedence over merged ones, and earlier
/// merged ones over later ones.
pub(super) fn entries(items: Vec<RepairItem>, found: &mut Diagnostics) -> Vec<(Key, Node)> {
    let mut lines: HashMap<String, usize> = HashMap::with_capacity(items.len());
    let mut own = Vec::with_capacity(items.len());
    for RepairItem { key, value, .. } in items {
        let Some((key, plain)) = key else { continue };
        if let Some(line) = lines.get(&key.name) {
            let message = format!("the key '{}' is already in line {line}", short(&key.name));
            found.push(
                Diagnostic::error(message)
                    .at(&key.place)
                    .hint("keep one of the two"),
            );
        } else {
            lines.insert(key.name.clone(), key.place.line());
            own.push((key, plain, value));
        }
    }
    let mut entries = Vec::with_capacity(own.len());
    for (key, plain, value) in own {
        if plain && key.name == "<<" {
            for (key, value) in merged(value, found) {
                if !lines.contains_key(&key.name) {
                    lines.insert(key.name.clone(), key.place.line());
                    entries.push((key, value));
                }
            }
        } else {
            entries.push((key, value));
        }
    }
    entries
}

fn merged(value: Node, found: &mut Diagnostics) -> Vec<(Key, Node)> {
    let mut refuse = |node: &Node| {
        found.push(
            Diagnostic::error(format!("'<<' merges mappings, and this is {}", node.kind()))
                .at(&node.place)
                .hint("write '<<: *name' for a mapping that is marked with '&name'"),
        );
        Vec::new()
    };
    match value.value {
        Value::Mapping(entries) => entries,
        Value::Sequence(nodes) => nodes
            .into_iter()
            .flat_map(|node| match node.value {
                Value::Mapping(entries) => entries,
                _ => refuse(&node),
            })
            .collect(),
        _ => refuse(&value),
    }
}
