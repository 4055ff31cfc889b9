//! Inheritance: the merging of a rule with the rule that it extends.

use std::collections::HashMap;

use super::node::{Key, Node, Value};

/// Entries of a mapping.
pub(super) type Entries = Vec<(Key, Node)>;

/// Published properties of a rule, which are not valid for rules that extend it.
const NOT_INHERITED: [&str; 2] = ["dimension", "hausdorff_dimension"];

/// Alternative keys for the maps of a system: one of them replaces the others.
const MAPS: [&str; 3] = ["maps", "vertices", "interpolate"];

/// Merges the entries of a parent into those of the file that extends it.
pub(super) fn merge(own: &mut Entries, parents: Entries) {
    let has = |own: &Entries, name: &str| own.iter().any(|(key, _)| key.name == name);
    let one = has(own, "generator");
    let several = has(own, "generators");
    let maps = MAPS.iter().any(|way| has(own, way));
    for (key, inherited) in parents {
        let name = key.name.as_str();
        let replaced = match name {
            "generator" => several,
            "generators" | "select" => one,
            _ if MAPS.contains(&name) => maps,
            _ => NOT_INHERITED.contains(&name),
        };
        if replaced {
            continue;
        }
        let Some((_, node)) = own.iter_mut().find(|(known, _)| known.name == key.name) else {
            own.push((key, inherited));
            continue;
        };
        if !["params", "style", "view"].contains(&name) {
            continue;
        }
        if let (Value::Mapping(own), Value::Mapping(parents)) = (&mut node.value, inherited.value) {
            merge_entries(own, parents, name == "params");
        }
    }
}

/// Merges mappings entry by entry. With `params`, a bare value in `own` replaces the parent's value and
/// keeps its limits.
pub(super) fn merge_entries(own: &mut Entries, parents: Entries, params: bool) {
    let names = own.iter().map(|(key, _)| key.name.clone());
    let numbers: HashMap<String, usize> = names.zip(0..).collect();
    for (key, inherited) in parents {
        match numbers.get(&key.name).map(|&number| &mut own[number]) {
            None => own.push((key, inherited)),
            Some((own_key, node)) if params => {
                if !matches!(node.value, Value::Mapping(_)) {
                    let key = Key {
                        name: "value".into(),
                        place: own_key.place.clone(),
                    };
                    let place = node.place.clone();
                    let value = std::mem::replace(&mut node.value, Value::Null);
                    let value = Node { place, value };
                    node.value = Value::Mapping(vec![(key, value)]);
                }
                let Value::Mapping(entries) = &mut node.value else {
                    continue;
                };
                match inherited.value {
                    Value::Mapping(inherited) => merge_entries(entries, inherited, false),
                    value => {
                        let key = Key {
                            name: "value".into(),
                            place: inherited.place.clone(),
                        };
                        let node = Node {
                            place: inherited.place,
                            value,
                        };
                        merge_entries(entries, vec![(key, node)], false);
                    }
                }
            }
            Some(_) => {}
        }
    }
}
