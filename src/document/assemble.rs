//! Puts a rule's parents and components into it, so that one file says everything.

use std::sync::Arc;

use crate::catalogue::{Catalogue, Shelf};
use crate::diagnostic::{Diagnostic, Diagnostics, Place, Source, nearest};

use super::merge::{Entries, merge};
use super::node::{Key, Node, Value};
use super::read::{DESCRIPTION, RULE};

/// A parent may have a parent, and so on, up to this many.
const MOST_PARENTS: usize = 32;

/// The rule in a source with everything in it that it names, and whether all of that was found;
/// `None` if it is no rule.
pub(super) fn assemble(
    source: &Arc<Source>,
    catalogue: &Catalogue,
    diagnostics: &mut Diagnostics,
) -> Option<(Node, bool)> {
    let mut assembly = Assembly {
        catalogue,
        diagnostics,
        components: Vec::new(),
        known: Vec::new(),
        complete: true,
    };
    let (place, mut entries) = assembly.extended(source, &mut vec![Arc::clone(source)])?;
    assembly.inline(&mut entries);
    assembly.hoist_parameters(&mut entries);
    let complete = assembly.complete;
    let value = Value::Mapping(entries);
    Some((Node { place, value }, complete))
}

struct Assembly<'a> {
    catalogue: &'a Catalogue,
    diagnostics: &'a mut Diagnostics,
    /// The parameters of the components that have been put in, with the file they come from.
    components: Vec<(Arc<Source>, Entries)>,
    /// The components that have been looked for.
    known: Vec<(Shelf, String, Option<Node>)>,
    /// Whether everything that is named has been found.
    complete: bool,
}

impl Assembly<'_> {
    fn parse(&mut self, source: &Arc<Source>) -> Option<Node> {
        Node::parse_with(source, self.diagnostics)
    }

    fn error(&mut self, place: &Place, message: String, hint: &str) {
        self.diagnostics
            .push(Diagnostic::error(message).at(place).hint(hint));
    }

    /// The entries of a rule alone, under the keys that are meant.
    fn entries(&mut self, source: &Arc<Source>) -> Option<(Place, Entries)> {
        let node = self.parse(source)?;
        let Value::Mapping(entries) = node.value else {
            let message = format!("a rule is needed here, this is {}", node.kind());
            self.error(&node.place, message, RULE.hint);
            return None;
        };
        let kind = entries.iter().find(|(key, _)| key.name == "kind");
        if let Some((_, kind)) = kind
            && !matches!(&kind.value, Value::Text(kind) if kind == "rule")
        {
            let message = format!("kind '{}' is not known", kind.place.text());
            self.error(&kind.place, message, "kind: rule, which may be left out");
            // The keys of another kind are not a rule's, so there is no use in looking at them.
            nearest(kind.place.text(), ["rule"])?;
        }
        let keys = entries.iter().map(|(key, _)| key);
        let meant = RULE.meant(keys, |diagnostic| self.diagnostics.push(diagnostic));
        let mut known = Vec::new();
        for (name, (mut key, value)) in meant.into_iter().zip(entries) {
            if let Some(name) = name {
                key.name = name.into();
                known.push((key, value));
            } else if matches!(value.value, Value::Mapping(_)) {
                self.complete = false;
            }
        }
        Some((node.place, known))
    }

    /// A rule with its parents' keys where it names none of its own.
    fn extended(
        &mut self,
        source: &Arc<Source>,
        chain: &mut Vec<Arc<Source>>,
    ) -> Option<(Place, Entries)> {
        let (place, mut entries) = self.entries(source)?;
        let Some(index) = entries.iter().position(|(key, _)| key.name == "extends") else {
            return Some((place, entries));
        };
        let (_, parent) = entries.remove(index);
        let parents = self.parent(&parent, chain).unwrap_or_else(|| {
            self.complete = false;
            harmless_parent(&parent.place)
        });
        merge(&mut entries, parents);
        Some((place, entries))
    }

    /// The entries of the rule that a node names.
    fn parent(&mut self, parent: &Node, chain: &mut Vec<Arc<Source>>) -> Option<Entries> {
        let Value::Text(name) = &parent.value else {
            let message = format!(
                "the name of a rule is needed here, this is {}",
                parent.kind()
            );
            self.error(&parent.place, message, "extends: koch");
            return None;
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
        if in_chain {
            let names = chain.iter().map(|source| source.name());
            let names: Vec<_> = names.chain([found.name()]).collect();
            let hint = format!("each extends the next: {}", names.join(", "));
            self.error(&parent.place, format!("'{name}' extends itself"), &hint);
            return None;
        }
        if chain.len() > MOST_PARENTS {
            let message = format!("more than {MOST_PARENTS} rules extend each other");
            self.error(&parent.place, message, "write the rule out");
            return None;
        }
        chain.push(Arc::clone(&found));
        Some(self.extended(&found, chain)?.1)
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
        let known = self
            .known
            .iter()
            .find(|(at, known, _)| *at == shelf && known == name);
        let component = match known {
            Some((.., component)) => component.clone(),
            None => {
                let component = self.find(name, shelf, &node.place);
                self.known.push((shelf, name.clone(), component.clone()));
                component
            }
        };
        *node = component.unwrap_or_else(|| {
            self.complete = false;
            harmless(shelf, &node.place)
        });
    }

    /// A component by name, without its description and its parameters.
    fn find(&mut self, name: &str, shelf: Shelf, place: &Place) -> Option<Node> {
        let source = match self.catalogue.component(shelf, name) {
            Ok(source) => source,
            Err(error) => {
                self.diagnostics.push(error.at(place));
                return None;
            }
        };
        let mut component = self.parse(&source)?;
        match &mut component.value {
            Value::Mapping(entries) => {
                if let Some(index) = entries.iter().position(|(key, _)| key.name == "params") {
                    self.take_parameters(source, entries.remove(index).1);
                }
                entries.retain(|(key, _)| !DESCRIPTION.contains(&key.name.as_str()));
            }
            Value::Sequence(_) => {}
            _ => {
                let message = format!("this is no {} but {}", shelf.noun(), component.kind());
                let hint = "`kfrac list` shows what the library has";
                self.error(&component.place, message, hint);
                return None;
            }
        }
        Some(component)
    }

    fn take_parameters(&mut self, source: Arc<Source>, params: Node) {
        let kind = params.kind();
        if let Value::Mapping(params) = params.value {
            self.components.push((source, params));
        } else {
            self.complete = false;
            let message = format!("a mapping of parameters is needed here, this is {kind}");
            self.error(&params.place, message, "params: {angle: 45}");
        }
    }

    /// Lets the components' parameters join the rule's.
    fn hoist_parameters(&mut self, entries: &mut Entries) {
        let mut joined: Vec<(Arc<Source>, Key, Node)> = Vec::new();
        for (source, params) in std::mem::take(&mut self.components) {
            for (key, node) in params {
                match joined.iter().find(|(_, known, _)| known.name == key.name) {
                    // A component that is used twice has its parameters once.
                    Some((known, ..)) if known.name() == source.name() => {}
                    Some((_, other, _)) => self.collision(&key, &other.place),
                    None => joined.push((Arc::clone(&source), key, node)),
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
            match own.iter().find(|(known, _)| known.name == key.name) {
                Some((known, _)) => self.collision(known, &key.place),
                None => own.push((key, node)),
            }
        }
    }

    fn collision(&mut self, key: &Key, other: &Place) {
        let message = format!("the rule has two parameters named '{}'", key.name);
        let (name, line) = (other.source().name(), other.line());
        let hint = format!("the other is in {name}, line {line}: rename one of them");
        self.error(&key.place, message, &hint);
    }
}

/// Stands in for the parent of a rule that was not found.
fn harmless_parent(place: &Place) -> Entries {
    [
        ("initiator", Shelf::Initiators),
        ("generator", Shelf::Generators),
    ]
    .map(|(name, shelf)| {
        let key = Key {
            name: name.into(),
            place: place.clone(),
        };
        (key, harmless(shelf, place))
    })
    .into()
}

/// Stands in for a component that was not found, so that no second error is reported for it.
fn harmless(shelf: Shelf, place: &Place) -> Node {
    let node = |value| Node {
        place: place.clone(),
        value,
    };
    let number = |value| node(Value::Number(value));
    // Shorter than what it replaces, so that there is no warning either.
    let line = [0.0, 0.5].map(|x| node(Value::Sequence(vec![number(x), number(0.0)])));
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
