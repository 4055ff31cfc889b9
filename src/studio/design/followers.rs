//! Maps that may follow each map of a recurrent system, after a map is copied or removed.

use std::iter::once;

use crate::document::node::{self, Node, Value};
use crate::edit::{Edit, PathStep, find};

use super::act::below;
use super::source_text;

/// Change of the maps of a system, at a position in the file.
#[derive(Clone, Copy, Debug)]
enum Change<'a> {
    /// The copy stands behind the map in a list, and behind all maps, with a name, in a mapping.
    Copied(usize, &'a str),
    Removed(usize),
}

/// Maps of a system, as edges refer to them.
struct Maps<'a> {
    /// Names, in the order of the file; `None` in a list.
    names: Vec<Option<&'a str>>,
    change: Change<'a>,
}

/// Returns the name of a copy of a map: the first one that no map has.
pub(super) fn copy_of(root: &Node, list: &[PathStep], name: &str) -> String {
    let maps = find(root, list);
    let is_free = |name: &String| maps.is_none_or(|maps| maps.get(name).is_none());
    let numbered = (2_u64..).map(|number| format!("{name} copy {number}"));
    let mut names = once(format!("{name} copy")).chain(numbered);
    names.find(is_free).unwrap_or_default()
}

/// Returns the edits of the edges after the map at a place is copied, under a name. The copy follows the maps that the map
/// follows, and is followed by those that follow it.
pub(super) fn copied(root: &Node, at: &[PathStep], copy: &str) -> Vec<Edit> {
    changed(root, at, |position| Change::Copied(position, copy)).unwrap_or_default()
}

/// Returns the edits of the edges after the map at a place is removed.
pub(super) fn removed(root: &Node, at: &[PathStep]) -> Vec<Edit> {
    changed(root, at, Change::Removed).unwrap_or_default()
}

/// Returns the edits of the edges, if the system has some: of every row, and of their keys.
fn changed<'a>(
    root: &Node,
    at: &[PathStep],
    change: impl FnOnce(usize) -> Change<'a>,
) -> Option<Vec<Edit>> {
    let edges = root.get("edges")?;
    let Value::Mapping(rows) = &edges.value else {
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
    let position = match step {
        PathStep::Item(item) => *item,
        PathStep::Key(key) => names.iter().position(|name| *name == Some(key))?,
    };
    let maps = Maps {
        names,
        change: change(position),
    };
    let at = [PathStep::from("edges")];
    let rows = rows.iter().flat_map(|(key, followers)| {
        let at = below(&at, key.name.as_str());
        match &followers.value {
            Value::Sequence(_) => vec![Edit::set(at, maps.row(followers))],
            _ => maps.keys(&at, followers, &source_text),
        }
    });
    let keys = maps.keys(&at, edges, &|followers| maps.row(followers));
    Some(rows.chain(keys).collect())
}

impl Maps<'_> {
    /// Returns the text of the followers of a map.
    fn row(&self, followers: &Node) -> String {
        match &followers.value {
            Value::Sequence(items) => {
                let called = items.iter().filter_map(Node::written);
                let called = called.flat_map(|name| self.called(name));
                let called: Vec<_> = called.map(|name| node::key(&name)).collect();
                format!("[{}]", called.join(", "))
            }
            Value::Mapping(entries) => {
                let entries = entries.iter().flat_map(|(key, weight)| {
                    let weight = source_text(weight);
                    let names = self.called(&key.name).into_iter();
                    names.map(move |name| format!("{}: {weight}", node::key(&name)))
                });
                format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
            }
            _ => source_text(followers),
        }
    }

    /// Returns the edits of the keys of a mapping of maps; `copy` returns the text of the value of a copy.
    fn keys(&self, at: &[PathStep], node: &Node, copy: &dyn Fn(&Node) -> String) -> Vec<Edit> {
        let Value::Mapping(entries) = &node.value else {
            return Vec::new();
        };
        let (mut gone, mut renamed, mut added) = (Vec::new(), Vec::new(), Vec::new());
        for (key, value) in entries {
            let old = below(at, key.name.as_str());
            let mut names = self.called(&key.name).into_iter();
            let Some(name) = names.next() else {
                gone.push(Edit::remove(old));
                continue;
            };
            added.extend(names.next().map(|copied| Edit::Add {
                to: at.to_vec(),
                key: copied,
                value: copy(value),
                after: Some(name.clone()),
            }));
            if name != key.name {
                let number = name.parse::<usize>().unwrap_or_default();
                renamed.push((number, Edit::Rename { at: old, key: name }));
            }
        }
        // Every number is free before another one becomes it.
        renamed.sort_by_key(|(number, _)| *number);
        if let Change::Copied(..) = self.change {
            renamed.reverse();
        }
        let renamed = renamed.into_iter().map(|(_, edit)| edit);
        gone.into_iter().chain(renamed).chain(added).collect()
    }

    /// Returns the names or numbers of a map that is called by name or by number: none if it is removed, two if it is
    /// copied.
    fn called(&self, text: &str) -> Vec<String> {
        let named = self.names.iter().position(|name| *name == Some(text));
        let number = text.parse::<usize>().ok();
        let numbered = number.and_then(|number| number.checked_sub(1));
        let Some(position) = named.or(numbered) else {
            return vec![text.into()];
        };
        let has_names = self.names.iter().any(Option::is_some);
        let at = |position: usize| match named {
            Some(_) => text.into(),
            None => (position + 1).to_string(),
        };
        match self.change {
            Change::Removed(gone) if position == gone => Vec::new(),
            Change::Removed(gone) if position > gone => vec![at(position - 1)],
            Change::Copied(of, copy) if position == of => match has_names {
                true => vec![at(position), copy.into()],
                false => vec![at(position), at(position + 1)],
            },
            Change::Copied(of, _) if position > of && !has_names => vec![at(position + 1)],
            Change::Removed(_) | Change::Copied(..) => vec![at(position)],
        }
    }
}
