//! Conversion of parser events to nodes, with an explicit stack in place of recursion.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use granit_parser::{Event, Parser, ScalarStyle, Span, StructureStyle, options};

use super::limits::{Budget, MAX_DEPTH, Size, check_depth};
use super::repair::{self, RepairItem};
use super::{scalar, trouble};
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};
use crate::document::node::{Key, Node, Value};

/// Reads the only document of a source. Mistakes are added to `found`.
pub(in crate::document) fn read(source: &Arc<Source>, found: &mut Diagnostics) -> Option<Node> {
    if let Err(diagnostic) = source
        .check_size()
        .and_then(|()| trouble::check_characters(source))
    {
        found.push(diagnostic);
        return None;
    }
    let mut reader = Reader {
        source,
        found,
        open: Vec::new(),
        root: None,
        anchors: HashMap::new(),
        budget: Budget::default(),
        documents: 0,
        last_scalar: 0..0,
    };
    match reader.run() {
        Ok(()) => reader.finish(),
        Err(diagnostic) => {
            reader.found.push(diagnostic);
            None
        }
    }
}

struct Reader<'a> {
    source: &'a Arc<Source>,
    found: &'a mut Diagnostics,
    /// The open lists and mappings, the innermost last.
    open: Vec<Collection>,
    root: Option<Node>,
    anchors: HashMap<usize, (Node, Size)>,
    budget: Budget,
    documents: usize,
    /// Byte range of the last scalar, from which most mistakes of syntax arise.
    last_scalar: Range<usize>,
}

/// An open list or mapping.
struct Collection {
    mapping: bool,
    flow: bool,
    anchor: usize,
    /// Bytes from the start of the collection to the end of its last item.
    range: Range<usize>,
    items: Vec<RepairItem>,
    /// The key whose value follows; `Unusable` if the key was a mistake.
    key: Pending,
}

enum Pending {
    None,
    Key { key: Key, plain: bool },
    Unusable,
}

impl Reader<'_> {
    fn run(&mut self) -> Result<(), Diagnostic> {
        let options = options! {
            emit_comments: false,
            flow_nesting_limit: MAX_DEPTH,
            block_nesting_limit: MAX_DEPTH,
        };
        // The parser borrows the text, and the reader stays mutable.
        let source = Arc::clone(self.source);
        for event in Parser::new_from_str_with_options(source.text(), options) {
            match event {
                Ok((event, span)) => self.event(event, &span)?,
                Err(error) => {
                    let flow = self.open.iter().rfind(|collection| collection.flow);
                    let flow = flow.map(|collection| collection.range.start);
                    return Err(trouble::translate(
                        &error,
                        self.source,
                        &self.last_scalar,
                        flow,
                    ));
                }
            }
        }
        Ok(())
    }

    fn finish(self) -> Option<Node> {
        // A document of "---" alone is empty.
        let root = self
            .root
            .filter(|root| root.value != Value::Null || !root.place.text().is_empty());
        if root.is_none() {
            self.found.push(trouble::empty(self.source));
        }
        root
    }

    fn event(&mut self, event: Event<'_>, span: &Span) -> Result<(), Diagnostic> {
        let range = span.byte_range().unwrap_or_default();
        if let (Some(tag), Some(token)) = (event.tag(), span.tag_span()) {
            let token = token.byte_range().unwrap_or_else(|| range.clone());
            if matches!(event, Event::Scalar(_, ScalarStyle::Plain, ..)) && self.awaits_condition()
            {
                let end = range.end.max(token.end);
                let place = self.place(self.without_trailing_space(token.start..end));
                return self.negation(place);
            }
            let place = self.place(token);
            self.found.push(trouble::tag(&tag.original(), &place));
        }
        match event {
            Event::DocumentStart(..) => {
                self.documents += 1;
                if self.documents > 1 {
                    return Err(trouble::second_document(&self.place(range)));
                }
            }
            Event::Scalar(text, style, anchor, _) => self.scalar(&text, style, anchor, range)?,
            Event::SequenceStart(style, anchor, _) => self.start(false, style, anchor, range)?,
            Event::MappingStart(style, anchor, _) => self.start(true, style, anchor, range)?,
            Event::SequenceEnd | Event::MappingEnd => self.end(range)?,
            Event::Alias(anchor) => self.alias(anchor, range)?,
            _ => {}
        }
        Ok(())
    }

    fn scalar(
        &mut self,
        text: &str,
        style: ScalarStyle,
        anchor: usize,
        range: Range<usize>,
    ) -> Result<(), Diagnostic> {
        self.last_scalar = range.clone();
        let plain = style == ScalarStyle::Plain;
        let absent = plain && range.is_empty();
        let place = match style {
            ScalarStyle::SingleQuoted | ScalarStyle::DoubleQuoted => {
                self.place(range.start + 1..range.end.saturating_sub(1))
            }
            _ => self.place(self.without_trailing_space(range)),
        };
        let value = match style {
            _ if absent => Value::Null,
            ScalarStyle::Plain => scalar::resolve(text),
            _ => Value::Text(text.to_owned()),
        };
        let mut node = Node { place, value };
        if self.awaits_key() {
            let key = Key {
                name: text.to_owned(),
                place: node.place.clone(),
            };
            self.anchor(anchor, &node)?;
            return self.key((!absent).then_some(key), plain, &node);
        }
        // In flow style a comment swallows the closing bracket as well.
        let in_flow = self.open.last().is_some_and(|collection| collection.flow);
        if absent
            && !in_flow
            && let Some((diagnostic, mended)) = repair::color_read_as_comment(&node.place)
        {
            self.found.push(diagnostic);
            node = mended;
        }
        self.anchor(anchor, &node)?;
        self.value(node, plain)
    }

    /// Reads a condition such as `!odd(i)`, whose '!' introduces a tag in YAML.
    fn negation(&mut self, place: Place) -> Result<(), Diagnostic> {
        self.last_scalar = place.range();
        self.found.push(trouble::negation(&place));
        let value = Value::Text(place.text().to_owned());
        self.value(Node { place, value }, true)
    }

    fn start(
        &mut self,
        mapping: bool,
        style: StructureStyle,
        anchor: usize,
        mut range: Range<usize>,
    ) -> Result<(), Diagnostic> {
        // For a list that is not indented, the parser's range starts after the first '-'.
        if !mapping && style == StructureStyle::Block {
            let before = self
                .source
                .text()
                .get(..range.start)
                .unwrap_or_default()
                .trim_end();
            let at_dash = self.source.text()[range.start..].starts_with('-');
            if !at_dash && before.ends_with('-') {
                range.start = before.len() - 1;
            }
        }
        check_depth(self.open.len() + 1, &self.place(range.clone()))?;
        let flow = style == StructureStyle::Flow;
        self.open.push(Collection {
            mapping,
            flow,
            anchor,
            range,
            items: Vec::new(),
            key: Pending::None,
        });
        Ok(())
    }

    fn end(&mut self, range: Range<usize>) -> Result<(), Diagnostic> {
        let Some(mut collection) = self.open.pop() else {
            return Ok(());
        };
        if collection.flow {
            // A pair in a flow list is a mapping without braces, which ends with an empty range.
            collection.range.end = collection.range.end.max(range.end);
            repair::join_at_commas(&mut collection.items, self.source, self.found);
        }
        let place = self.place(self.without_trailing_space(collection.range));
        let value = if collection.mapping {
            Value::Mapping(repair::entries(collection.items, self.found))
        } else {
            let items = collection.items.into_iter().map(|item| item.value);
            let mut items: Vec<Node> = items.collect();
            // The list takes over the memory of larger items.
            items.shrink_to_fit();
            Value::Sequence(items)
        };
        let node = Node { place, value };
        self.anchor(collection.anchor, &node)?;
        if self.awaits_key() {
            self.key(None, false, &node)
        } else {
            self.value(node, false)
        }
    }

    fn alias(&mut self, anchor: usize, range: Range<usize>) -> Result<(), Diagnostic> {
        let place = self.place(range.clone());
        let Some((node, size)) = self.anchors.get(&anchor) else {
            return Err(trouble::alias_inside_itself(&place));
        };
        self.budget.copy(*size, self.open.len(), &place)?;
        let node = node.clone();
        // The anchor precedes the alias: the span of the collection ends with the alias itself.
        if let Some(collection) = self.open.last_mut() {
            collection.range.end = range.end;
        }
        if self.awaits_key() {
            let name = match &node.value {
                Value::Text(text) => Some(text.clone()),
                _ => node.written().map(str::to_owned),
            };
            return self.key(name.map(|name| Key { name, place }), false, &node);
        }
        self.value(node, false)
    }

    fn awaits_key(&self) -> bool {
        self.open
            .last()
            .is_some_and(|collection| collection.mapping && matches!(collection.key, Pending::None))
    }

    fn awaits_condition(&self) -> bool {
        let key = self.open.last().map(|collection| &collection.key);
        matches!(key, Some(Pending::Key { key, .. }) if key.name == "when")
    }

    /// Stores the key of the next entry, or reports a node that cannot be a key.
    fn key(&mut self, key: Option<Key>, plain: bool, node: &Node) -> Result<(), Diagnostic> {
        self.budget.value(&node.place)?;
        if key.is_none() {
            self.found.push(trouble::no_key(node));
        }
        if let Some(collection) = self.open.last_mut() {
            collection.range.end = collection.range.end.max(node.place.range().end);
            collection.key = key.map_or(Pending::Unusable, |key| Pending::Key { key, plain });
        }
        Ok(())
    }

    /// Adds a complete value to the innermost open collection, or stores it as the root.
    fn value(&mut self, value: Node, plain: bool) -> Result<(), Diagnostic> {
        self.budget.value(&value.place)?;
        let Some(collection) = self.open.last_mut() else {
            self.root = Some(value);
            return Ok(());
        };
        let end = value.place.range().end;
        collection.range.end = collection.range.end.max(end);
        match std::mem::replace(&mut collection.key, Pending::None) {
            Pending::Unusable => {}
            Pending::Key {
                key,
                plain: plain_key,
            } => {
                collection.items.push(RepairItem {
                    key: Some((key, plain_key)),
                    value,
                    plain,
                });
            }
            Pending::None => collection.items.push(RepairItem {
                key: None,
                value,
                plain,
            }),
        }
        Ok(())
    }

    fn anchor(&mut self, anchor: usize, node: &Node) -> Result<(), Diagnostic> {
        if anchor != 0 {
            let size = Size::of(node);
            self.budget.copy(size, self.open.len(), &node.place)?;
            self.anchors.insert(anchor, (node.clone(), size));
        }
        Ok(())
    }

    fn place(&self, range: Range<usize>) -> Place {
        Place::new(self.source, range)
    }

    fn without_trailing_space(&self, range: Range<usize>) -> Range<usize> {
        let text = self.source.text().get(range.clone()).unwrap_or_default();
        range.start..range.start + text.trim_end().len()
    }
}
