//! Surfaces that the words of an L-system name, and its file does not list: components of the library.

use crate::document::merge::Entries;
use crate::document::node::{Key, Node, Value};

/// Adds the surfaces that words name as `~(NAME)`, and that are not listed under `surfaces`, as names of components.
/// Only systems in space have them.
pub(super) fn add(entries: &mut Entries) {
    let is_in_space =
        |(key, node): &(Key, Node)| key.name == "space" && matches!(node.value, Value::Number(3.0));
    if !entries.iter().any(is_in_space) {
        return;
    }
    let mut named: Vec<(Key, Node)> = Vec::new();
    for (key, node) in entries.iter() {
        if key.name == "axiom" || key.name == "productions" {
            find(node, &mut named);
        }
    }
    let listed = entries.iter_mut().find(|(key, _)| key.name == "surfaces");
    match listed {
        Some((
            _,
            Node {
                value: Value::Mapping(listed),
                ..
            },
        )) => {
            named.retain(|(name, _)| listed.iter().all(|(key, _)| key.name != name.name));
            listed.extend(named);
        }
        // Another value is reported when it is read.
        Some(_) => {}
        None => {
            if let Some((first, _)) = named.first() {
                let place = first.place.clone();
                let name = "surfaces".to_owned();
                let value = Value::Mapping(named);
                let key = Key {
                    name,
                    place: place.clone(),
                };
                entries.push((key, Node { place, value }));
            }
        }
    }
}

/// Adds the names of surfaces in all texts of a node, each once.
fn find(node: &Node, named: &mut Vec<(Key, Node)>) {
    match &node.value {
        Value::Text(text) => {
            let mut at = 0;
            while let Some(start) = text[at..].find("~(").map(|found| at + found + 2) {
                let rest = &text[start..];
                let end = rest.find([',', ')']).unwrap_or(rest.len());
                let name = rest[..end].trim();
                at = start;
                let is_name = name.starts_with(|c: char| c.is_ascii_alphabetic())
                    && name
                        .chars()
                        .all(|c| c.is_ascii_alphanumeric() || "-_".contains(c));
                if !is_name || named.iter().any(|(known, _)| known.name == name) {
                    continue;
                }
                let place = match node.place.text() == text {
                    true => node.place.within(start..start + end),
                    false => node.place.clone(),
                };
                let key = Key {
                    name: name.to_owned(),
                    place: place.clone(),
                };
                let value = Value::Text(name.to_owned());
                named.push((key, Node { place, value }));
            }
        }
        Value::Sequence(entries) => entries.iter().for_each(|node| find(node, named)),
        Value::Mapping(entries) => entries.iter().for_each(|(_, node)| find(node, named)),
        _ => {}
    }
}
