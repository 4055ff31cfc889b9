//! Puts a rule's parents and components into it, so that one file says everything.

use std::sync::Arc;

use crate::catalogue::{Catalogue, Shelf};
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source};

use super::node::{Key, Node, Value};
use super::rule::describes;

/// A parent may have a parent, and so on, up to this many.
const MOST_PARENTS: usize = 32;

type Entries = Vec<(Key, Node)>;

/// The rule in a source with everything in it that it names; `None` if it is no mapping.
pub(super) fn assemble(
    source: &Arc<Source>,
    catalogue: &Catalogue,
    diagnostics: &mut Diagnostics,
) -> Option<Node> {
    let mut assembly = Assembly {
        catalogue,
        diagnostics,
        components: Vec::new(),
    };
    let mut node = assembly.extended(source, &mut vec![Arc::clone(source)])?;
    let Value::Mapping(entries) = &mut node.value else {
        return Some(node);
    };
    assembly.inline(entries);
    assembly.hoist_parameters(entries);
    Some(node)
}

struct Assembly<'a> {
    catalogue: &'a Catalogue,
    diagnostics: &'a mut Diagnostics,
    /// The parameters of the components that have been put in, with the file they come from.
    components: Vec<(Arc<Source>, Entries)>,
}

impl Assembly<'_> {
    fn parse(&mut self, source: &Arc<Source>) -> Option<Node> {
        Node::parse_with(source, self.diagnostics)
    }

    /// A rule with its parents' keys where it names none of its own.
    fn extended(&mut self, source: &Arc<Source>, chain: &mut Vec<Arc<Source>>) -> Option<Node> {
        let mut node = self.parse(source)?;
        let Value::Mapping(entries) = &mut node.value else {
            return Some(node);
        };
        let Some(index) = entries.iter().position(|(key, _)| key.name == "extends") else {
            return Some(node);
        };
        let (key, parent) = entries.remove(index);
        let Value::Text(name) = &parent.value else {
            let message = format!(
                "the name of a rule is needed here, this is {}",
                parent.kind()
            );
            self.diagnostics.push(
                Diagnostic::error(message)
                    .at(&parent.place)
                    .hint("extends: koch"),
            );
            return Some(node);
        };
        let found = match self.catalogue.rule(name) {
            Ok(found) => found,
            Err(error) => {
                self.diagnostics.push(error.at(&parent.place));
                return None;
            }
        };
        let in_chain = chain
            .iter()
            .any(|source| source.name() == found.name() && source.text() == found.text());
        if in_chain || chain.len() > MOST_PARENTS {
            let message = if in_chain {
                format!("'{name}' extends itself")
            } else {
                format!("more than {MOST_PARENTS} rules extend each other")
            };
            self.diagnostics
                .push(Diagnostic::error(message).at(&key.place));
            return None;
        }
        chain.push(Arc::clone(&found));
        let base = self.extended(&found, chain)?;
        if let (Value::Mapping(own), Value::Mapping(parents)) = (&mut node.value, base.value) {
            merge(own, parents);
        }
        Some(node)
    }

    /// Replaces the names of components by what they stand for.
    fn inline(&mut self, entries: &mut Entries) {
        for (key, node) in entries {
            match key.name.as_str() {
                "initiator" => {
                    self.component(node, Shelf::Initiators);
                    self.inline_base_elements(node);
                }
                "generator" => self.generator(node),
                "generators" => {
                    if let Value::Mapping(generators) = &mut node.value {
                        generators
                            .iter_mut()
                            .for_each(|(_, node)| self.generator(node));
                    }
                }
                "base_element" => self.component(node, Shelf::BaseElements),
                _ => {}
            }
        }
    }

    fn generator(&mut self, node: &mut Node) {
        self.component(node, Shelf::Generators);
        let parts = match &mut node.value {
            Value::Mapping(entries) => entries.iter_mut().find(|(key, _)| key.name == "parts"),
            _ => None,
        };
        match parts.map(|(_, parts)| &mut parts.value) {
            Some(Value::Sequence(parts)) => {
                parts
                    .iter_mut()
                    .for_each(|part| self.inline_base_elements(part));
            }
            _ => self.inline_base_elements(node),
        }
    }

    /// The base elements of single elements, in a list or in a mapping with `elements`.
    fn inline_base_elements(&mut self, node: &mut Node) {
        let list = match &mut node.value {
            Value::Sequence(list) => list,
            Value::Mapping(entries) => {
                match entries.iter_mut().find(|(key, _)| key.name == "elements") {
                    Some((
                        _,
                        Node {
                            value: Value::Sequence(list),
                            ..
                        },
                    )) => list,
                    _ => return,
                }
            }
            _ => return,
        };
        for element in list {
            if let Value::Mapping(entries) = &mut element.value {
                for (_, node) in entries
                    .iter_mut()
                    .filter(|(key, _)| key.name == "base_element")
                {
                    self.component(node, Shelf::BaseElements);
                }
            }
        }
    }

    /// Puts a component in the place of its name.
    fn component(&mut self, node: &mut Node, shelf: Shelf) {
        let Value::Text(name) = &node.value else {
            return;
        };
        let source = match self.catalogue.component(shelf, name) {
            Ok(source) => source,
            Err(error) => {
                self.diagnostics.push(error.at(&node.place));
                *node = harmless(shelf, &node.place);
                return;
            }
        };
        let Some(mut component) = self.parse(&source) else {
            *node = harmless(shelf, &node.place);
            return;
        };
        if let Value::Mapping(entries) = &mut component.value {
            if let Some(index) = entries.iter().position(|(key, _)| key.name == "params")
                && let Value::Mapping(params) = entries.remove(index).1.value
            {
                self.components.push((source, params));
            }
            entries.retain(|(key, _)| !describes(&key.name));
        }
        *node = component;
    }

    /// Lets the components' parameters join the rule's.
    fn hoist_parameters(&mut self, entries: &mut Entries) {
        let mut joined: Vec<(Option<Arc<Source>>, Key, Node)> = Vec::new();
        for (source, params) in std::mem::take(&mut self.components) {
            for (key, node) in params {
                match joined.iter().find(|(_, known, _)| known.name == key.name) {
                    // A component that is used twice has its parameters once.
                    Some((Some(known), ..)) if known.name() == source.name() => {}
                    Some(_) => self.collision(&key),
                    None => joined.push((Some(Arc::clone(&source)), key, node)),
                }
            }
        }
        if joined.is_empty() {
            return;
        }
        let index = entries.iter().position(|(key, _)| key.name == "params");
        let params = match index {
            Some(index) => &mut entries[index].1,
            None => {
                // Where a person would look for them: before what uses them.
                let before = entries.iter().position(|(key, _)| key.name == "initiator");
                let place = joined[0].1.place.clone();
                let key = Key {
                    name: "params".into(),
                    place: place.clone(),
                };
                let at = before.unwrap_or(entries.len());
                entries.insert(
                    at,
                    (
                        key,
                        Node {
                            place,
                            value: Value::Mapping(Vec::new()),
                        },
                    ),
                );
                &mut entries[at].1
            }
        };
        let Value::Mapping(own) = &mut params.value else {
            return;
        };
        for (_, key, node) in joined {
            if own.iter().any(|(known, _)| known.name == key.name) {
                self.collision(&key);
            } else {
                own.push((key, node));
            }
        }
    }

    fn collision(&mut self, key: &Key) {
        let message = format!("the rule has two parameters named '{}'", key.name);
        let hint = "a component's parameters join the rule's: rename one of them";
        self.diagnostics
            .push(Diagnostic::error(message).at(&key.place).hint(hint));
    }
}

/// Stands in for a component that was not found, so that no second error is reported for it.
fn harmless(shelf: Shelf, place: &Place) -> Node {
    let node = |value| Node {
        place: place.clone(),
        value,
    };
    let number = |value| node(Value::Number(value));
    let line = [0.0, 1.0].map(|x| node(Value::Sequence(vec![number(x), number(0.0)])));
    let key = if shelf == Shelf::BaseElements {
        "points"
    } else {
        "elements"
    };
    let key = Key {
        name: key.into(),
        place: place.clone(),
    };
    node(Value::Mapping(vec![(
        key,
        node(Value::Sequence(line.to_vec())),
    )]))
}

/// Keys that are true of the parent alone.
const NOT_INHERITED: [&str; 2] = ["dimension", "hausdorff_dimension"];

/// Adds a parent's entries to those of a rule that extends it.
fn merge(own: &mut Entries, parents: Entries) {
    let has = |own: &Entries, name: &str| own.iter().any(|(key, _)| key.name == name);
    let one = has(own, "generator");
    let several = has(own, "generators");
    for (key, inherited) in parents {
        let name = key.name.as_str();
        let replaced = match name {
            "generator" => several,
            "generators" | "select" => one,
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

/// Merges entry by entry; a parameter's value replaces the parent's and keeps its limits.
fn merge_entries(own: &mut Entries, parents: Entries, params: bool) {
    for (key, inherited) in parents {
        match own.iter_mut().find(|(known, _)| known.name == key.name) {
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
