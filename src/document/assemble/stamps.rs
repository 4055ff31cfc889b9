//! Stamps that an L-system names, and its file does not list: components of the library.

use crate::diagnostic::Place;
use crate::document::merge::Entries;
use crate::document::node::{Key, Node, Value};

/// Adds the stamps that words name as `~(NAME)` and actions as `stamp: NAME`, and that are not listed under `stamps`, as
/// names of components.
pub(super) fn add(entries: &mut Entries) {
    let mut named: Vec<(Key, Node)> = Vec::new();
    let symbols = entries.iter().find(|(key, _)| key.name == "symbols");
    let symbols = symbols.map(|(_, node)| node);
    let has_own = match symbols.map(|node| &node.value) {
        Some(Value::Mapping(symbols)) => symbols.iter().any(|(key, _)| key.name.starts_with('~')),
        _ => false,
    };
    for (key, node) in entries.iter() {
        if !has_own && (key.name == "axiom" || key.name == "productions") {
            find_in_words(node, &mut named);
        }
    }
    if let Some(symbols) = symbols {
        find_in_actions(symbols, &mut named);
    }
    let listed = entries.iter_mut().find(|(key, _)| key.name == "stamps");
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
                let name = "stamps".to_owned();
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

/// Adds a name, once.
fn add_name(name: &str, place: Place, named: &mut Vec<(Key, Node)>) {
    if named.iter().any(|(known, _)| known.name == name) {
        return;
    }
    let key = Key {
        name: name.to_owned(),
        place: place.clone(),
    };
    let value = Value::Text(name.to_owned());
    named.push((key, Node { place, value }));
}

/// Adds the names of stamps in the actions of symbols.
fn find_in_actions(node: &Node, named: &mut Vec<(Key, Node)>) {
    match &node.value {
        Value::Sequence(entries) => entries.iter().for_each(|node| find_in_actions(node, named)),
        Value::Mapping(entries) => {
            for (key, node) in entries {
                match &node.value {
                    Value::Text(name) if key.name == "stamp" => {
                        add_name(name, node.place.clone(), named);
                    }
                    _ => find_in_actions(node, named),
                }
            }
        }
        _ => {}
    }
}

/// Adds the names of stamps in all words of a node.
fn find_in_words(node: &Node, named: &mut Vec<(Key, Node)>) {
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
                if is_name {
                    let place = match node.place.text() == text {
                        true => node.place.within(start..start + end),
                        false => node.place.clone(),
                    };
                    add_name(name, place, named);
                }
            }
        }
        Value::Sequence(entries) => entries.iter().for_each(|node| find_in_words(node, named)),
        Value::Mapping(entries) => {
            { entries.iter() }.for_each(|(_, node)| find_in_words(node, named));
        }
        _ => {}
    }
}
