//! Values that an edit is to lead to.

use crate::document::node::{Key, Node, Value};

use super::{Edit, EditError, PathStep, missing};

/// Returns the values after an edit.
pub(super) fn intended(node: &Node, edit: &Edit) -> Result<Node, EditError> {
    let mut new = node.clone();
    let failed = || missing(edit.at());
    match edit {
        Edit::Set { at, value } => {
            let place = find_mut(&mut new, at).ok_or_else(failed)?;
            place.value = Edit::meant(value)?.value;
        }
        Edit::Insert { into, index, value } => {
            let list = find_mut(&mut new, into).ok_or_else(failed)?;
            match &mut list.value {
                Value::Sequence(items) if *index <= items.len() => {
                    items.insert(*index, Edit::meant(value)?);
                }
                _ => return Err(failed()),
            }
        }
        Edit::Add {
            to,
            key,
            value,
            after,
        } => {
            let mapping = find_mut(&mut new, to).ok_or_else(failed)?;
            let is_new = mapping.get(key).is_none();
            let Value::Mapping(entries) = &mut mapping.value else {
                return Err(failed());
            };
            let index = match after {
                None => Some(entries.len()),
                Some(after) => position(entries, after).map(|before| before + 1),
            };
            match index {
                Some(index) if is_new => {
                    entries.insert(index, (Key::new(key.clone()), Edit::meant(value)?));
                }
                _ => return Err(failed()),
            }
        }
        Edit::Nest { at, key } => {
            let place = find_mut(&mut new, at).ok_or_else(failed)?;
            let inner = place.clone();
            place.value = Value::Mapping(vec![(Key::new(key.clone()), inner)]);
        }
        Edit::Remove { at } => {
            let (last, parent) = at.split_last().ok_or_else(failed)?;
            let parent = find_mut(&mut new, parent).ok_or_else(failed)?;
            match (&mut parent.value, last) {
                (Value::Sequence(items), PathStep::Item(item)) if *item < items.len() => {
                    items.remove(*item);
                }
                (Value::Mapping(entries), step) => {
                    let index = position(entries, &step.to_string()).ok_or_else(failed)?;
                    entries.remove(index);
                }
                _ => return Err(failed()),
            }
        }
        Edit::Rename { at, key } => {
            let (last, parent) = at.split_last().ok_or_else(failed)?;
            let parent = find_mut(&mut new, parent).ok_or_else(failed)?;
            let is_new = parent.get(key).is_none();
            let Value::Mapping(entries) = &mut parent.value else {
                return Err(failed());
            };
            let index = position(entries, &last.to_string()).filter(|_| is_new);
            entries[index.ok_or_else(failed)?].0 = Key::new(key.clone());
        }
    }
    Ok(new)
}

fn position(entries: &[(Key, Node)], key: &str) -> Option<usize> {
    entries.iter().position(|(known, _)| known.name == key)
}

fn find_mut<'n>(node: &'n mut Node, at: &[PathStep]) -> Option<&'n mut Node> {
    at.iter()
        .try_fold(node, |node, step| match (&mut node.value, step) {
            (Value::Sequence(items), PathStep::Item(item)) => items.get_mut(*item),
            (Value::Mapping(entries), step) => {
                let index = position(entries, &step.to_string())?;
                entries.get_mut(index).map(|(_, node)| node)
            }
            _ => None,
        })
}

/// Returns whether two values are equal, with keys in any order.
pub(super) fn is_equal(a: &Node, b: &Node) -> bool {
    match (&a.value, &b.value) {
        (Value::Mapping(one), Value::Mapping(other)) => {
            let has =
                |(key, node): &(Key, Node)| a.get(&key.name).is_some_and(|own| is_equal(own, node));
            one.len() == other.len() && other.iter().all(has)
        }
        (Value::Sequence(one), Value::Sequence(other)) => {
            one.len() == other.len() && one.iter().zip(other).all(|(a, b)| is_equal(a, b))
        }
        _ => a.same_value(b),
    }
}

/// Returns the edits of the parts in which a collection differs from another one of its type; `None` if they have
/// different types, or one of them is empty.
pub(super) fn differences(old: &Node, new: &Node, at: &[PathStep]) -> Option<Vec<Edit>> {
    let below = |step: PathStep| -> Vec<PathStep> { at.iter().cloned().chain([step]).collect() };
    let mut edits = Vec::new();
    match (&old.value, &new.value) {
        (Value::Sequence(a), Value::Sequence(b)) if !a.is_empty() && !b.is_empty() => {
            let differ = a.iter().zip(b).enumerate();
            let differ = differ.filter(|(_, (a, b))| !a.same_value(b));
            edits
                .extend(differ.map(|(item, (_, b))| Edit::set(below(item.into()), flow(b, false))));
            let removed = (b.len()..a.len()).rev();
            edits.extend(removed.map(|item| Edit::remove(below(item.into()))));
            let added = b.iter().enumerate().skip(a.len());
            edits.extend(added.map(|(item, b)| Edit::insert(at.to_vec(), item, flow(b, false))));
        }
        (Value::Mapping(a), Value::Mapping(b)) if !a.is_empty() && !b.is_empty() => {
            for (key, node) in b {
                let value = flow(node, false);
                match old.get(&key.name) {
                    None => edits.push(Edit::add(at.to_vec(), key.name.clone(), value)),
                    Some(own) if own.same_value(node) => {}
                    Some(_) => edits.push(Edit::set(below(PathStep::Key(key.name.clone())), value)),
                }
            }
            let is_gone = |key: &Key| new.get(&key.name).is_none();
            let removed = a.iter().map(|(key, _)| key).filter(|key| is_gone(key));
            edits.extend(removed.map(|key| Edit::remove(below(PathStep::Key(key.name.clone())))));
        }
        _ => return None,
    }
    Some(edits)
}

/// Writes a value in flow style on one line, or as JSON.
pub(super) fn flow(node: &Node, is_json: bool) -> String {
    let text = |text: &str| match is_json {
        true => json(text),
        false => crate::document::node::scalar(text),
    };
    match &node.value {
        Value::Text(own) => text(own),
        Value::Sequence(items) => {
            let items: Vec<_> = items.iter().map(|item| flow(item, is_json)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Mapping(entries) => {
            let entries: Vec<_> = entries
                .iter()
                .map(|(own, node)| format!("{}: {}", key(&own.name, is_json), flow(node, is_json)))
                .collect();
            format!("{{{}}}", entries.join(", "))
        }
        Value::Null => "null".to_owned(),
        Value::Bool(_) | Value::Number(_) => match node.written() {
            Some(written) if !is_json && !written.is_empty() => written.to_owned(),
            _ => node.to_yaml().trim_end().to_owned(),
        },
    }
}

/// Writes a key in flow style, or as JSON.
pub(super) fn key(text: &str, is_json: bool) -> String {
    match is_json {
        true => json(text),
        false => crate::document::node::key(text),
    }
}

/// Writes a text as JSON.
fn json(text: &str) -> String {
    let mut out = String::from('"');
    for letter in text.chars() {
        match letter {
            '"' | '\\' => out.extend(['\\', letter]),
            letter if letter.is_control() => out += &format!("\\u{:04x}", u32::from(letter)),
            letter => out.push(letter),
        }
    }
    out.push('"');
    out
}
