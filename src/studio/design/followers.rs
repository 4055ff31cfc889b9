//! Maps that may follow each map of a recurrent system, after a map is copied or removed.

use crate::document::node::{Node, Value, scalar};
use crate::edit::{Edit, PathStep, find};

use super::source_text;

/// Change of the maps of a system, at a position in the file.
#[derive(Clone, Copy, Debug)]
enum Change {
    /// The copy stands behind the map in a list, and behind all maps in a mapping.
    Copied(usize),
    Removed(usize),
}

/// Maps of a system, as edges refer to them.
struct Maps<'a> {
    /// Names, in the order of the file; `None` in a list.
    names: Vec<Option<&'a str>>,
    change: Change,
    /// Name of the copy, if maps have names.
    copy: String,
}

/// Returns the name of the copy of a map.
pub(super) fn copy_of(name: &str) -> String {
    format!("{name} copy")
}

/// Returns the edit of the edges after the map at a place is copied. The copy follows the maps that the map follows, and is
/// followed by those that follow it.
pub(super) fn copied(root: &Node, at: &[PathStep]) -> Option<Edit> {
    changed(root, at, Change::Copied)
}

/// Returns the edit of the edges after the map at a place is removed.
pub(super) fn removed(root: &Node, at: &[PathStep]) -> Option<Edit> {
    changed(root, at, Change::Removed)
}

/// Returns the edit of the edges, if the system has some.
fn changed(root: &Node, at: &[PathStep], change: fn(usize) -> Change) -> Option<Edit> {
    let Value::Mapping(edges) = &root.get("edges")?.value else {
        return None;
    };
    let (step, list) = at.split_last()?;
    let names: Vec<Option<&str>> = match &find(root, list)?.value {
        Value::Sequence(items) => vec![None; items.len()],
        Value::Mapping(entries) => {
            let names = entries.iter().map(|(key, _)| Some(key.name.as_str()));
            names.collect()
        }
        _ => return None,
    };
    let (position, copy) = match step {
        PathStep::Item(item) => (*item, String::new()),
        PathStep::Key(key) => {
            let position = names.iter().position(|name| *name == Some(key))?;
            (position, copy_of(key))
        }
    };
    let maps = Maps {
        names,
        change: change(position),
        copy,
    };
    let rows = edges.iter().flat_map(|(key, followers)| {
        let row = maps.row(followers);
        let names = maps.called(&key.name).into_iter();
        names.map(move |name| format!("{name}: {row}"))
    });
    let text = format!("{{{}}}", rows.collect::<Vec<_>>().join(", "));
    Some(Edit::set(vec!["edges".into()], text))
}

impl Maps<'_> {
    /// Returns the text of the followers of a map.
    fn row(&self, followers: &Node) -> String {
        match &followers.value {
            Value::Sequence(items) => {
                let called = items.iter().filter_map(Node::written);
                let called: Vec<_> = called.flat_map(|name| self.called(name)).collect();
                format!("[{}]", called.join(", "))
            }
            Value::Mapping(entries) => {
                let entries = entries.iter().flat_map(|(key, weight)| {
                    let weight = source_text(weight);
                    let names = self.called(&key.name).into_iter();
                    names.map(move |name| format!("{name}: {weight}"))
                });
                format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
            }
            _ => source_text(followers),
        }
    }

    /// Returns the texts for a map that is called by name or by number: none if it is removed, two if it is copied.
    fn called(&self, text: &str) -> Vec<String> {
        let named = self.names.iter().position(|name| *name == Some(text));
        let number = text.parse::<usize>().ok();
        let numbered = number.and_then(|number| number.checked_sub(1));
        let Some(position) = named.or(numbered) else {
            return vec![scalar(text)];
        };
        let has_names = self.names.iter().any(Option::is_some);
        let at = |position: usize| match named {
            Some(_) => scalar(text),
            None => (position + 1).to_string(),
        };
        match self.change {
            Change::Removed(gone) if position == gone => Vec::new(),
            Change::Removed(gone) if position > gone => vec![at(position - 1)],
            Change::Copied(of) if position == of => {
                let copy = match (named, has_names) {
                    (Some(_), _) => scalar(&self.copy),
                    (None, true) => at(self.names.len()),
                    (None, false) => at(position + 1),
                };
                vec![at(position), copy]
            }
            Change::Copied(of) if position > of && !has_names => vec![at(position + 1)],
            Change::Removed(_) | Change::Copied(_) => vec![at(position)],
        }
    }
}
