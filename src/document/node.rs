//! A YAML value in which everything knows its place.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::yaml;
use crate::diagnostic::{Diagnostics, Place, Source};

/// A YAML value with its place.
///
/// The place of a plain scalar is exactly its text, that of a quoted one the text inside the
/// quotes, that of a block scalar (`|`, `>`) its lines without the first line's indentation; where
/// nothing is written it is empty. The place of a list or mapping runs from its first to its last
/// token. What an alias stands for has the places of what it refers to.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Where it is written.
    pub place: Place,
    /// What is written there.
    pub value: Value,
}

/// What a [`Node`] holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `null`, `~` or nothing at all.
    Null,
    /// `true` or `false`; `yes`, `on` and `True` are text.
    Bool(bool),
    /// A finite number; `1/3`, `.inf` and `1e999` are text.
    Number(f64),
    /// Everything else that is no collection.
    Text(String),
    /// A list.
    Sequence(Vec<Node>),
    /// A mapping in the order of the file, each key once.
    Mapping(Vec<(Key, Node)>),
}

/// The key of a mapping's entry. A number or word used as a key is the text it is written as.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// The key's text.
    pub name: String,
    /// Where it is written.
    pub place: Place,
}

impl Node {
    /// Reads the one YAML document that a source holds.
    ///
    /// Nothing is nested deeper than 64 levels and there are at most 250,000 values, aliases
    /// expanded and merge keys (`<<`) merged.
    ///
    /// # Errors
    ///
    /// All that is wrong: up to the first mistake of syntax, behind which nothing can be read.
    pub fn parse(source: &Arc<Source>) -> Result<Self, Diagnostics> {
        let mut found = Diagnostics::default();
        match Self::parse_with(source, &mut found) {
            Some(node) if !found.has_errors() => Ok(node),
            _ => Err(found),
        }
    }

    /// As [`Node::parse`], but adds the mistakes to `found` and returns what can be used in spite
    /// of them, so that mistakes in the meaning can be reported with those of syntax. Where a
    /// mistake has a likely meaning, such as a key that is there twice, the node has that meaning.
    pub fn parse_with(source: &Arc<Source>, found: &mut Diagnostics) -> Option<Self> {
        yaml::read(source, found)
    }

    /// What it is, for messages: "a number", "a list", …
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

    /// The value of a mapping's key; nothing where there is none or this is no mapping.
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

    /// A scalar as it is written, without quotes; nothing for a list or mapping.
    #[must_use]
    pub fn written(&self) -> Option<&str> {
        match self.value {
            Value::Sequence(_) | Value::Mapping(_) => None,
            _ => Some(self.place.text()),
        }
    }

    /// The place of the bytes `range` of its text, cut to it; its whole place if it is written
    /// otherwise than it reads, with escapes or on several lines.
    #[must_use]
    pub fn within(&self, range: Range<usize>) -> Place {
        match &self.value {
            Value::Text(text) if text != self.place.text() => self.place.clone(),
            _ => self.place.within(range),
        }
    }

    /// Whether both say the same, wherever they are written. The order of a mapping counts.
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

    /// Whether a place lies in it, or in a part of it that is written elsewhere.
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

    /// Adds the paths of the files that hold parts of it.
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

    /// YAML that reads as this value: block style outside, flow style for points and short
    /// mappings, text quoted only where it would read as something else.
    #[must_use]
    pub fn to_yaml(&self) -> String {
        yaml::write(self)
    }
}

impl From<Value> for Node {
    /// A value that was not read; its place is in a text of its own.
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
    /// A key that was not read; its place is in a text of its own.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        let name = name.into();
        Self {
            place: nowhere(&name),
            name,
        }
    }
}

fn nowhere(text: &str) -> Place {
    let source = Source::new("(made)", text);
    Place::new(&source, 0..source.text().len())
}

#[cfg(test)]
mod tests;
