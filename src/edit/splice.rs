//! Places in a text where an edit changes it, and what is written there.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostic::Source;
use crate::document::node::{Key, Node, Value};

use super::intended::{self, flow};
use super::{Edit, EditError, PathStep, find, joined, missing, remove};

/// Changes of a text, from its end to its start.
pub(super) type Splice = Vec<(Range<usize>, String)>;

/// A text with its values.
pub(super) struct Text<'a> {
    source: &'a Arc<Source>,
    pub(super) text: &'a str,
    root: &'a Node,
}

/// Returns ways to write an edit, the best first.
pub(super) fn splices(
    source: &Arc<Source>,
    root: &Node,
    edit: &Edit,
) -> Result<Vec<Splice>, EditError> {
    let text = Text {
        source,
        text: source.text(),
        root,
    };
    match edit {
        Edit::Set { at, value } => {
            let node = text.own(at)?;
            let meant = Edit::meant(value)?;
            Ok(text.replaced(node, value, &meant))
        }
        Edit::Insert { into, index, value } => {
            let list = text.own(into)?;
            let meant = Edit::meant(value)?;
            let written = text.written(value, &meant);
            Ok(text.inserted(list, *index, &written, &meant))
        }
        Edit::Add {
            to,
            key,
            value,
            after,
        } => {
            let mapping = text.own(to)?;
            let meant = Edit::meant(value)?;
            let written = text.written(value, &meant);
            text.added(mapping, key, &written, &meant, after.as_deref())
                .ok_or_else(|| missing(to))
        }
        Edit::Nest { at, key } => {
            let node = text.own(at)?;
            Ok(text.nested(node, key))
        }
        Edit::Remove { at } => {
            let (last, parent) = at.split_last().ok_or_else(|| missing(at))?;
            text.own(at)?;
            remove::removed(&text, text.own(parent)?, last).ok_or_else(|| missing(at))
        }
        Edit::Rename { at, key } => {
            let (last, parent) = at.split_last().ok_or_else(|| missing(at))?;
            let name = last.to_string();
            let entry = text.own(parent)?;
            let Value::Mapping(entries) = &entry.value else {
                return Err(missing(at));
            };
            let found = entries.iter().find(|(known, _)| known.name == name);
            let (known, _) = found.ok_or_else(|| missing(at))?;
            if !text.is_own(&known.place) {
                return Err(EditError::Unfaithful(joined(at)));
            }
            let name = intended::key(key, text.is_json());
            Ok(vec![vec![(text.quoted(known.place.range()), name)]])
        }
    }
}

impl Text<'_> {
    fn is_own(&self, place: &crate::diagnostic::Place) -> bool {
        Arc::ptr_eq(place.source(), self.source)
    }

    /// Returns a value that is written where its steps lead; an error if it is written elsewhere, as the value of an
    /// alias is.
    fn own(&self, at: &[PathStep]) -> Result<&Node, EditError> {
        let node = find(self.root, at).ok_or_else(|| missing(at))?;
        for depth in 0..=at.len() {
            let outer = find(self.root, &at[..depth]).ok_or_else(|| missing(at))?;
            let [own, inner] = [outer, node].map(|node| node.place.range());
            let holds = own.start <= inner.start && inner.end <= own.end;
            if !holds || !self.is_own(&outer.place) {
                return Err(EditError::Unfaithful(joined(at)));
            }
        }
        Ok(node)
    }

    /// Returns whether the file is JSON: its values have quotes where JSON needs them.
    pub(super) fn is_json(&self) -> bool {
        let Value::Mapping(entries) = &self.root.value else {
            return false;
        };
        let is_quoted = |key: &Key| {
            let start = key.place.range().start;
            start > 0 && self.text.as_bytes()[start - 1] == b'"'
        };
        self.is_flow(self.root) && entries.iter().all(|(key, _)| is_quoted(key))
    }

    /// Returns whether a collection is in flow style.
    pub(super) fn is_flow(&self, node: &Node) -> bool {
        self.text[node.place.range()].starts_with(['[', '{'])
    }

    /// Returns the end of lines.
    fn line_end(&self) -> &'static str {
        match self.text.contains("\r\n") {
            true => "\r\n",
            false => "\n",
        }
    }

    /// Returns the range of a scalar with its quotes.
    pub(super) fn quoted(&self, range: Range<usize>) -> Range<usize> {
        let bytes = self.text.as_bytes();
        let before = range.start.checked_sub(1).map(|at| bytes[at]);
        let after = bytes.get(range.end).copied();
        match (before, after) {
            (Some(b'"'), Some(b'"')) | (Some(b'\''), Some(b'\'')) => range.start - 1..range.end + 1,
            _ => range,
        }
    }

    /// Returns the range of a value, with its quotes.
    pub(super) fn range(&self, node: &Node) -> Range<usize> {
        match &node.value {
            Value::Text(_) => self.quoted(node.place.range()),
            _ => node.place.range(),
        }
    }

    /// Returns the start of the line on which a byte stands.
    pub(super) fn line_start(&self, at: usize) -> usize {
        self.text[..at].rfind('\n').map_or(0, |end| end + 1)
    }

    /// Returns the start of the line below that on which a byte stands, or the end of the text.
    pub(super) fn next_line(&self, at: usize) -> usize {
        self.text[at..]
            .find('\n')
            .map_or(self.text.len(), |end| at + end + 1)
    }

    /// Returns the column of a byte, in bytes.
    fn column(&self, at: usize) -> usize {
        at - self.line_start(at)
    }

    /// Returns the place of the dash of an item of a list in block style.
    pub(super) fn dash(&self, item: &Node) -> Option<usize> {
        let start = self.header(item).unwrap_or(self.range(item).start);
        let before = self.text[..start].trim_end();
        before.ends_with('-').then(|| before.len() - 1)
    }

    /// Returns a value on one line as it is given, or as the file needs it.
    fn written(&self, value: &str, meant: &Node) -> String {
        // Without a comment behind it.
        let all = meant.place.source().text();
        let own = Text {
            source: meant.place.source(),
            text: all,
            root: meant,
        };
        let range = own.range(meant);
        let value = if range.is_empty() {
            value.trim()
        } else {
            &all[range]
        };
        match self.is_json() {
            true => flow(meant, true),
            false if value.contains('\n') => flow(meant, false),
            false => value.to_owned(),
        }
    }

    /// Returns the start of a text over several lines: its `|` or `>`.
    fn header(&self, node: &Node) -> Option<usize> {
        let start = node.place.range().start;
        let before = self.text[..self.line_start(start)].trim_end();
        let mark =
            before.trim_end_matches(|it: char| it == '-' || it == '+' || it.is_ascii_digit());
        let is_first = self.text[self.line_start(start)..start].trim().is_empty();
        let is_text = matches!(node.value, Value::Text(_)) && is_first && !before.is_empty();
        let is_header = [" |", " >"].iter().any(|end| mark.ends_with(end));
        (is_text && is_header).then(|| mark.len() - 1)
    }

    /// Returns ways to replace a value.
    fn replaced(&self, node: &Node, value: &str, meant: &Node) -> Vec<Splice> {
        let range = self.range(node);
        let header = self.header(node);
        let range = header.unwrap_or(range.start)..range.end;
        let written = self.written(value, meant);
        let quoted = flow(meant, true);
        let mut ways = Vec::new();
        // Quotes stay where a text had some.
        if range != node.place.range() && matches!(meant.value, Value::Text(_)) {
            let quote = &self.text[range.start..=range.start];
            ways.push(format!("{quote}{}{quote}", meant.place.text()));
        }
        ways.extend([written, flow(meant, false), quoted]);
        let is_block =
            matches!(node.value, Value::Sequence(_) | Value::Mapping(_)) && !self.is_flow(node);
        let gap = self.text[..range.start].trim_end().len();
        ways.into_iter()
            .map(|text| match (range.is_empty(), is_block) {
                (true, _) => vec![(gap..gap, format!(" {text}"))],
                (_, true) => vec![(gap..range.end, format!(" {text}"))],
                _ => vec![(range.clone(), text)],
            })
            .collect()
    }

    /// Returns ways to put a value into a mapping: with its lines further in, or in braces.
    fn nested(&self, node: &Node, key: &str) -> Vec<Splice> {
        let name = intended::key(key, self.is_json());
        let range = self.range(node);
        let braces = vec![
            (range.end..range.end, "}".to_owned()),
            (range.start..range.start, format!("{{{name}: ")),
        ];
        let is_block =
            matches!(node.value, Value::Sequence(_) | Value::Mapping(_)) && !self.is_flow(node);
        let line = self.line_start(range.start);
        let own = &self.text[line..range.start];
        let end = self.line_end();
        if !is_block {
            // On a line of its own below the key, which stands where the entry begins.
            let indent = " ".repeat(own.len() - own.trim_start().len() + 2);
            let start = self.text[..range.start].trim_end().len();
            let below = vec![(start..range.start, format!("{end}{indent}{name}: "))];
            return vec![below, braces];
        }
        if !own.trim().is_empty() {
            return Vec::new();
        }
        // From the line behind the key on, with comments that stand before the value.
        let colon = self.text[..line].rfind(':').unwrap_or(line);
        let start = self.next_line(colon).min(line);
        let mut lines = vec![(
            start..start,
            format!("{}{name}:{end}", &own.replace('-', " ")),
        )];
        let mut at = start;
        while at < range.end {
            let next = self.next_line(at);
            let is_empty = self.text[at..next].trim().is_empty();
            if !is_empty {
                lines.push((at..at, "  ".to_owned()));
            }
            at = next;
        }
        // A list may stand as far out as its key.
        if own.is_empty() {
            lines[0].1.insert_str(0, "  ");
            for (_, text) in &mut lines[1..] {
                text.push_str("  ");
            }
        }
        lines.reverse();
        vec![lines]
    }

    fn inserted(&self, list: &Node, index: usize, value: &str, meant: &Node) -> Vec<Splice> {
        let Value::Sequence(items) = &list.value else {
            return Vec::new();
        };
        let ranges: Vec<_> = items.iter().map(|item| self.range(item)).collect();
        let values = [value.to_owned(), flow(meant, self.is_json())];
        if self.is_flow(list) {
            return values
                .iter()
                .map(|value| vec![self.beside(&ranges, index, list, value)])
                .collect();
        }
        let at_dash = |item: usize| self.dash(&items[item]);
        let (Some(place), Some(dash)) = (
            match index {
                0 => at_dash(0).map(|dash| self.line_start(dash)),
                _ => Some(self.next_line(ranges[index - 1].end)),
            },
            at_dash(0),
        ) else {
            return Vec::new();
        };
        let indent = " ".repeat(self.column(dash));
        values
            .iter()
            .map(|value| vec![self.line(place, &format!("{indent}- {value}"))])
            .collect()
    }

    /// Returns the place and text of a whole line.
    fn line(&self, place: usize, line: &str) -> (Range<usize>, String) {
        let end = self.line_end();
        let is_open = place == self.text.len() && !self.text.ends_with('\n');
        let text = match is_open {
            true => format!("{end}{line}"),
            false => format!("{line}{end}"),
        };
        (place..place, text)
    }

    /// Returns the place and text of an item of a collection in flow style.
    fn beside(
        &self,
        ranges: &[Range<usize>],
        index: usize,
        collection: &Node,
        value: &str,
    ) -> (Range<usize>, String) {
        let Some(last) = ranges.len().checked_sub(1) else {
            let start = collection.place.range().start + 1;
            return (start..start, value.to_owned());
        };
        // Items on lines of their own have their commas at the ends of lines.
        let near = index.clamp(1, last.max(1)).min(last);
        let gap = match near {
            0 => ", ",
            near => &self.text[ranges[near - 1].end..ranges[near].start],
        };
        let is_plain = gap.trim() == "," && gap.starts_with(',');
        let gap = if is_plain { gap } else { ", " };
        match index <= last {
            true => {
                let start = ranges[index].start;
                (start..start, format!("{value}{gap}"))
            }
            false => {
                let end = ranges[last].end;
                (end..end, format!("{gap}{value}"))
            }
        }
    }

    fn added(
        &self,
        mapping: &Node,
        key: &str,
        value: &str,
        meant: &Node,
        after: Option<&str>,
    ) -> Option<Vec<Splice>> {
        let Value::Mapping(entries) = &mapping.value else {
            return None;
        };
        let before = match after {
            None => entries.len(),
            Some(after) => entries.iter().position(|(known, _)| known.name == after)? + 1,
        };
        let name = intended::key(key, self.is_json());
        let values = [value.to_owned(), flow(meant, self.is_json())];
        if self.is_flow(mapping) {
            let ranges: Vec<_> = entries
                .iter()
                .map(|(key, node)| self.quoted(key.place.range()).start..self.range(node).end)
                .collect();
            let ways = values.iter().map(|value| {
                vec![self.beside(&ranges, before, mapping, &format!("{name}: {value}"))]
            });
            return Some(ways.collect());
        }
        let (first, _) = entries.first()?;
        let (last, node) = entries.get(before.checked_sub(1)?)?;
        let column = self.column(self.quoted(first.place.range()).start);
        let indent = " ".repeat(column);
        let end = self.range(node).end.max(last.place.range().end);
        let place = self.next_line(end);
        // As a person writes it, over several lines where it is long.
        let entry = Node::from(Value::Mapping(vec![(Key::new(key), as_written(meant))]));
        let block = entry.to_yaml();
        let lines: Vec<_> = block
            .trim_end()
            .lines()
            .map(|line| match line.is_empty() {
                true => String::new(),
                false => format!("{indent}{line}"),
            })
            .collect();
        let mut ways = vec![vec![self.line(place, &lines.join(self.line_end()))]];
        if value.len() < 60 {
            ways.insert(
                0,
                vec![self.line(place, &format!("{indent}{name}: {value}"))],
            );
        }
        Some(ways)
    }
}

/// Returns a value whose numbers are those that were written.
fn as_written(node: &Node) -> Node {
    let value = match &node.value {
        Value::Sequence(items) => Value::Sequence(items.iter().map(as_written).collect()),
        Value::Mapping(entries) => {
            let entries = entries.iter();
            Value::Mapping(
                entries
                    .map(|(key, node)| (key.clone(), as_written(node)))
                    .collect(),
            )
        }
        value => value.clone(),
    };
    Node {
        place: node.place.clone(),
        value,
    }
}
