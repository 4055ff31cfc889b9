//! Edits of texts: a change of a file that leaves every other byte as it is.
//!
//! An [`Edit`] names a value by its [`PathStep`]s from the top of the file, and [`edit`] returns the new text.
//! Comments, layout, line ends, quotes and the order of keys stay as they are outside of what is edited. A comment that
//! stands behind an entry of its own lines is removed with that entry, and with nothing else.
//!
//! The new text is read again, and must have exactly the values that the edit states: else the edit is refused, and
//! there is no new text. An alias and a merge key (`<<`) have their values elsewhere: they are not edited.
//!
//! ```
//! use kfrac::edit::{Edit, edit, steps};
//!
//! let text = "generator: # of Koch\n  - [0, 0]\n  - [1/3, 0]   # first third\n  - [1, 0]\n";
//! let new = edit(text, &[Edit::set(steps("generator/1/1"), "1/12")]).unwrap();
//! assert_eq!(new, text.replace("[1/3, 0]", "[1/3, 1/12]"));
//! ```

mod intended;
mod remove;
mod splice;

use std::fmt;
use std::sync::Arc;

use crate::diagnostic::{Diagnostics, Source};
use crate::document::node::{Node, Value};

/// A step from a value to a part of it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PathStep {
    /// Value of a key of a mapping.
    Key(String),
    /// Item of a list, from 0.
    Item(usize),
}

impl From<&str> for PathStep {
    fn from(key: &str) -> Self {
        Self::Key(key.to_owned())
    }
}

impl From<usize> for PathStep {
    fn from(item: usize) -> Self {
        Self::Item(item)
    }
}

impl fmt::Display for PathStep {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(key) => write!(f, "{key}"),
            Self::Item(item) => write!(f, "{item}"),
        }
    }
}

/// Returns the steps that a text such as `generator/1/to` names: parts that are whole numbers are items of lists.
#[must_use]
pub fn steps(path: &str) -> Vec<PathStep> {
    let parts = path.split('/').filter(|part| !part.is_empty());
    parts
        .map(|part| {
            part.parse()
                .map_or_else(|_| PathStep::from(part), PathStep::Item)
        })
        .collect()
}

/// A change of a file. Values are YAML: `1/3`, `[0, 0]`, `{to: [1, 0], direction: 2}`.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Edit {
    /// Replaces a value. Of a mapping or a list that stays one, only what differs is changed.
    Set {
        /// The value.
        at: Vec<PathStep>,
        /// New value.
        value: String,
    },
    /// Adds an item to a list.
    Insert {
        /// The list.
        into: Vec<PathStep>,
        /// Index of the new item, at most the number of items.
        index: usize,
        /// New item.
        value: String,
    },
    /// Adds an entry to a mapping.
    Add {
        /// The mapping.
        to: Vec<PathStep>,
        /// Key, which the mapping does not have.
        key: String,
        /// Its value.
        value: String,
        /// Key behind whose entry it stands; the last one if `None`.
        after: Option<String>,
    },
    /// Removes an item of a list or an entry of a mapping.
    Remove {
        /// Its value.
        at: Vec<PathStep>,
    },
    /// Puts a value into a mapping of one key, in its place: `a: 1` becomes `a: {key: 1}`, over lines as it was.
    Nest {
        /// The value of an entry.
        at: Vec<PathStep>,
        /// Its key in the new mapping.
        key: String,
    },
    /// Gives an entry of a mapping another key.
    Rename {
        /// Its value.
        at: Vec<PathStep>,
        /// New key, which the mapping does not have.
        key: String,
    },
}

impl Edit {
    /// Replaces a value.
    #[must_use]
    pub fn set(at: Vec<PathStep>, value: impl Into<String>) -> Self {
        let value = value.into();
        Self::Set { at, value }
    }

    /// Adds an item to a list.
    #[must_use]
    pub fn insert(into: Vec<PathStep>, index: usize, value: impl Into<String>) -> Self {
        let value = value.into();
        Self::Insert { into, index, value }
    }

    /// Adds an entry at the end of a mapping.
    #[must_use]
    pub fn add(to: Vec<PathStep>, key: impl Into<String>, value: impl Into<String>) -> Self {
        Self::Add {
            to,
            key: key.into(),
            value: value.into(),
            after: None,
        }
    }

    /// Removes a value, with its key if it has one.
    #[must_use]
    pub fn remove(at: Vec<PathStep>) -> Self {
        Self::Remove { at }
    }

    /// Gives an entry another key.
    #[must_use]
    pub fn rename(at: Vec<PathStep>, key: impl Into<String>) -> Self {
        let key = key.into();
        Self::Rename { at, key }
    }

    /// Returns the value as it is meant.
    fn meant(value: &str) -> Result<Node, EditError> {
        let source = Source::new("the new value", value);
        Node::parse(&source).map_err(EditError::Value)
    }
}

/// Reason why a text is not edited.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// The text has mistakes, so that its values have no places.
    #[error("the text has mistakes")]
    Text(Diagnostics),
    /// The new value has mistakes.
    #[error("the new value has mistakes: {0}")]
    Value(Diagnostics),
    /// There is no such value, or a new key exists.
    #[error("there is no '{0}' in the text that could be changed so")]
    Missing(String),
    /// The new text would have other values than the edit states: an alias, a merge key, or a layout that is not known.
    #[error("'{0}' cannot be changed without changing more: change the text by hand")]
    Unfaithful(String),
}

/// Edits a text, one edit after the other, and returns the new one.
///
/// # Errors
///
/// If the text or a value cannot be read, a value is not there, or the new text, when it is read, would not have exactly
/// the values that are intended.
pub fn edit(text: &str, edits: &[Edit]) -> Result<String, EditError> {
    let mut text = text.to_owned();
    for edit in edits {
        text = one(&text, edit)?;
    }
    Ok(text)
}

fn read(text: &str) -> Result<(Arc<Source>, Node), EditError> {
    let source = Source::new("the text", text);
    let node = Node::parse(&source).map_err(EditError::Text)?;
    Ok((source, node))
}

fn one(text: &str, edit: &Edit) -> Result<String, EditError> {
    let (source, node) = read(text)?;
    if let Edit::Set { at, value } = edit {
        let meant = Edit::meant(value)?;
        let old = find(&node, at).ok_or_else(|| missing(at))?;
        if old.same_value(&meant) {
            return Ok(text.to_owned());
        }
        if let Some(parts) = intended::differences(old, &meant, at) {
            let new = self::edit(text, &parts)?;
            let (_, read) = read(&new)?;
            let is_meant = find(&read, at).is_some_and(|new| intended::is_equal(new, &meant));
            return match is_meant {
                true => Ok(new),
                false => Err(EditError::Unfaithful(joined(at))),
            };
        }
    }
    let wanted = intended::intended(&node, edit)?;
    let at = edit.at();
    let splices = splice::splices(&source, &node, edit)?;
    // The reader leaves out a byte order mark.
    let mark = text.len() - source.text().len();
    splices
        .into_iter()
        .find_map(|splice| {
            let mut new = text.to_owned();
            for (range, text) in splice {
                new.replace_range(range.start + mark..range.end + mark, &text);
            }
            let (_, read) = read(&new).ok()?;
            read.same_value(&wanted).then_some(new)
        })
        .ok_or_else(|| EditError::Unfaithful(joined(at)))
}

impl Edit {
    /// Returns the steps to the value that is edited.
    #[must_use]
    pub fn at(&self) -> &[PathStep] {
        match self {
            Self::Set { at, .. } | Self::Remove { at } => at,
            Self::Rename { at, .. } | Self::Nest { at, .. } => at,
            Self::Insert { into: at, .. } | Self::Add { to: at, .. } => at,
        }
    }
}

/// Returns the value to which steps lead.
#[must_use]
pub fn find<'n>(node: &'n Node, at: &[PathStep]) -> Option<&'n Node> {
    at.iter().try_fold(node, |node, step| match step {
        PathStep::Key(key) => node.get(key),
        PathStep::Item(item) => match &node.value {
            Value::Sequence(nodes) => nodes.get(*item),
            // A key may be a number.
            Value::Mapping(_) => node.get(&item.to_string()),
            _ => None,
        },
    })
}

/// Writes a value in flow style on one line, with its numbers as they are written.
#[cfg(feature = "studio")]
pub(crate) fn flow(node: &Node) -> String {
    intended::flow(node, false)
}

fn joined(at: &[PathStep]) -> String {
    let all: Vec<_> = at.iter().map(PathStep::to_string).collect();
    all.join("/")
}

fn missing(at: &[PathStep]) -> EditError {
    EditError::Missing(joined(at))
}
