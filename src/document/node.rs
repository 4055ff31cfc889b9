//! YAML values with source spans.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::yaml;
use crate::diagnostic::{Diagnostics, Place, Source};

/// A YAML value with its source span.
///
/// The span of a plain scalar is exactly its text, that of a quoted scalar the text between the quotes,
/// and that of a block scalar (`|`, `>`) its lines without the indentation of the first line. The span
/// of an empty value is empty. The span of a list or mapping extends from its first to its last token.
/// An alias has the spans of its anchor's value.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Source span of the value.
    pub place: Place,
    /// The value.
    pub value: Value,
}

/// A YAML value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `null`, `~` or an empty value.
    Null,
    /// `true` or `false`; `yes`, `on` and `True` are text.
    Bool(bool),
    /// A finite number; `1/3`, `.inf` and `1e999` are text.
    Number(f64),
    /// Any other scalar.
    Text(String),
    /// A list.
    Sequence(Vec<Node>),
    /// A mapping in the order of the file, with unique keys.
    Mapping(Vec<(Key, Node)>),
}

/// The key of an entry of a mapping. Numbers and words as keys are text as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// Text of the key.
    pub name: String,
    /// Source span of the key.
    pub place: Place,
}

impl Node {
    /// Parses the only YAML document in a source.
    ///
    /// Nesting is limited to 64 levels, and values to 250,000, with aliases expanded and merge keys
    /// (`<<`) merged.
    ///
    /// # Errors
    ///
    /// Returns all mistakes, up to the first one of syntax, beyond which nothing can be read.
    pub fn parse(source: &Arc<Source>) -> Result<Self, Diagnostics> {
        let mut found = Diagnostics::default();
        match Self::parse_with(source, &mut found) {
            Some(node) if !found.has_errors() => Ok(node),
            _ => Err(found),
        }
    }

    /// Parses a source as [`Node::parse`] does, but adds the mistakes to `found` and returns the usable
    /// part, so that mistakes of meaning can be reported together with those of syntax. A mistake with
    /// a probable meaning, such as a duplicate key, is resolved to that meaning.
    pub fn parse_with(source: &Arc<Source>, found: &mut Diagnostics) -> Option<Self> {
        yaml::read(source, found)
    }

    /// Returns a noun for the type of the value, for messages: "a number", "a list", …
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match &self.value {
            Value::Null => "nothing",
            Value::Bool(_) => "true or false",
            Value::Number(_) => "a number",
            Value::Text(_) => "text",
            Value::Sequence(_) => "a list",
            Value::Mapping(_) => "a mapping",
        }
    }

    /// Returns the value of a key; `None` if the key is absent or the node is not a mapping.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<&Self> {
        let Value::Mapping(entries) = &self.value else {
            return None;
        };
        entries
            .iter()
            .find(|(known, _)| known.name == key)
            .map(|(_, node)| node)
    }

    /// Returns the value of a key, to change it.
    pub(super) fn get_mut(&mut self, key: &str) -> Option<&mut Self> {
        let Value::Mapping(entries) = &mut self.value else {
            return None;
        };
        let mut found = entries.iter_mut().filter(|(known, _)| known.name == key);
        found.next().map(|(_, node)| node)
    }

    /// Returns the content of a text that the program writes, all of it at one place.
    pub(super) fn made(text: &str, place: &Place) -> Self {
        let made = Self::parse(&Source::new("(made)", text));
        let mut made = made.unwrap_or_else(|_| Value::Null.into());
        made.set_place(place);
        made
    }

    fn set_place(&mut self, place: &Place) {
        self.place = place.clone();
        match &mut self.value {
            Value::Sequence(nodes) => nodes.iter_mut().for_each(|node| node.set_place(place)),
            Value::Mapping(entries) => {
                for (key, node) in entries {
                    key.place = place.clone();
                    node.set_place(place);
                }
            }
            _ => {}
        }
    }

    /// Returns a scalar as written, without quotes; `None` for a list or mapping.
    #[must_use]
    pub fn written(&self) -> Option<&str> {
        match self.value {
            Value::Sequence(_) | Value::Mapping(_) => None,
            _ => Some(self.place.text()),
        }
    }

    /// Returns the span of the bytes `range` of the text, clipped to it. Returns the span of the whole
    /// node if the text differs from its notation, as with escapes or several lines.
    #[must_use]
    pub fn within(&self, range: Range<usize>) -> Place {
        match &self.value {
            Value::Text(text) if text != self.place.text() => self.place.clone(),
            _ => self.place.within(range),
        }
    }

    /// Returns whether both nodes have equal values, regardless of spans. The order of mappings is
    /// significant.
    #[must_use]
    pub fn same_value(&self, other: &Self) -> bool {
        match (&self.value, &other.value) {
            (Value::Sequence(a), Value::Sequence(b)) => {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.same_value(b))
            }
            (Value::Mapping(a), Value::Mapping(b)) => {
                let same = |((a, x), (b, y)): (&(Key, Self), &(Key, Self))| {
                    a.name == b.name && x.same_value(y)
                };
                a.len() == b.len() && a.iter().zip(b).all(same)
            }
            (a, b) => a == b,
        }
    }

    /// Returns whether a span lies in the node, or in a part of it that is written elsewhere.
    pub(super) fn holds(&self, place: &Place) -> bool {
        let [own, other] = [&self.place, place].map(Place::range);
        if Arc::ptr_eq(self.place.source(), place.source())
            && own.start <= other.start
            && other.end <= own.end
        {
            return true;
        }
        match &self.value {
            Value::Sequence(nodes) => nodes.iter().any(|node| node.holds(place)),
            Value::Mapping(entries) => entries.iter().any(|(_, node)| node.holds(place)),
            _ => false,
        }
    }

    /// Adds the paths of the files that contain parts of the node.
    pub(super) fn add_paths<'n>(&'n self, paths: &mut BTreeSet<&'n Path>) {
        paths.insert(self.place.source().path());
        match &self.value {
            Value::Sequence(nodes) => nodes.iter().for_each(|node| node.add_paths(paths)),
            Value::Mapping(entries) => {
                for (key, node) in entries {
                    paths.insert(key.place.source().path());
                    node.add_paths(paths);
                }
            }
            _ => {}
        }
    }

    /// Returns YAML that parses to an equal value: block style for outer collections, flow style for
    /// points and short mappings, and quotes only where they are necessary.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        yaml::write(self)
    }
}

impl From<Value> for Node {
    /// Creates a node for a generated value, whose span lies in a source of its own.
    fn from(value: Value) -> Self {
        let place = match &value {
            Value::Text(text) => nowhere(text),
            Value::Sequence(_) | Value::Mapping(_) | Value::Null => nowhere(""),
            Value::Bool(yes) => nowhere(if *yes { "true" } else { "false" }),
            Value::Number(number) => nowhere(&yaml::number(*number)),
        };
        Self { place, value }
    }
}

impl Key {
    /// Creates a key for a generated mapping, whose span lies in a source of its own.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        let name = name.into();
        Self {
            place: nowhere(&name),
            name,
        }
    }
}

/// Writes a text as a scalar in flow style, with quotes where they are necessary.
pub(crate) fn scalar(text: &str) -> String {
    yaml::scalar_text(text, true)
}

/// Writes a text as a key in flow style, with quotes where they are necessary.
pub(crate) fn key(text: &str) -> String {
    yaml::scalar_key(text, true)
}

fn nowhere(text: &str) -> Place {
    let source = Source::new("(made)", text);
    Place::new(&source, 0..source.text().len())
}

#[cfg(test)]
mod tests;
