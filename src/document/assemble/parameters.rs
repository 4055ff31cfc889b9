//! Parameters of components, which are merged into those of the rule.

use crate::diagnostic::Place;
use crate::document::merge::{Entries, merge_entries};
use crate::document::node::{Key, Node, Value};

use super::Assembly;

impl Assembly<'_> {
    /// Merges the parameters of the components into those of the rule, and reports duplicate names.
    pub(super) fn hoist_parameters(&mut self, entries: &mut Entries) {
        let mut joined = Entries::new();
        for component in std::mem::take(&mut self.components) {
            for (key, node) in component.parameters {
                match joined.iter().find(|(known, _)| known.name == key.name) {
                    // A component that is used twice contributes its parameters once.
                    Some((known, _)) if known.place == key.place => {}
                    Some((other, _)) => self.collision(&component.place, &key, Some(other)),
                    None if self.is_free(&key, component.generation, &component.place) => {
                        joined.push((key, node));
                    }
                    None => {}
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
                // Placed where a person expects them, before their first use.
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
        merge_entries(own, joined, true);
    }

    /// Returns whether a component's parameter collides with no parameter of a rule's own; otherwise,
    /// reports the collision.
    ///
    /// A rule may set the parameters that its parents inherit from their components. The rule that
    /// names the component and the parents of that rule must not have a parameter of the same name.
    fn is_free(&mut self, key: &Key, generation: usize, named: &Place) -> bool {
        let other = self
            .parameters
            .iter()
            .find(|(of, other)| *of >= generation && other.name == key.name);
        let Some((of, other)) = other.cloned() else {
            return true;
        };
        if of == generation {
            self.collision(&other.place, key, None);
        } else {
            self.collision(named, key, Some(&other));
        }
        false
    }

    /// Reports a duplicate parameter, of a component and either of the rule at `place` (`other` is
    /// `None`) or of another file.
    fn collision(&mut self, place: &Place, key: &Key, other: Option<&Key>) {
        let at = |key: &Key| format!("{}, line {}", key.place.source().name(), key.place.line());
        let hint = match other {
            None => format!("the other is in {}: rename one of them", at(key)),
            Some(other) => format!("in {}, and in {}: rename one of them", at(other), at(key)),
        };
        let message = format!("the rule has two parameters named '{}'", key.name);
        self.error(place, message, &hint);
    }
}
