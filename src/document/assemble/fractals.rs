//! Puts the files of other fractals in the place of their names, where these are sets.

use std::sync::Arc;

use crate::diagnostic::Source;
use crate::document::merge::Entries;
use crate::document::node::{Node, Value};
use crate::document::yaml::Size;

use super::{Assembly, MOST_MISSING, assemble_within, is_same_file};

/// A fractal may be made of another one, that of a third, and so on, up to this many.
const MOST_DEEP: usize = 8;
/// All that is made of each other holds no more fractals than this.
const MOST_FRACTALS: usize = 1000;

impl Assembly<'_> {
    /// Puts in the fractals that sets of a file are.
    pub(super) fn inline_fractals(&mut self, entries: &mut Entries) {
        for (key, node) in entries {
            match (key.name.as_str(), &mut node.value) {
                // An object may have any name.
                ("objects", Value::Mapping(objects)) => {
                    for (_, object) in objects {
                        self.inline_fractals_in(object);
                    }
                }
                ("condensation" | "initial" | "scene", _) => self.inline_fractals_in(node),
                _ => {}
            }
        }
    }

    /// The same in a set, an instance, a list or a union of these.
    fn inline_fractals_in(&mut self, node: &mut Node) {
        match &mut node.value {
            Value::Sequence(items) => {
                for item in items {
                    self.inline_fractals_in(item);
                }
            }
            Value::Mapping(entries) => {
                for (key, node) in entries {
                    match (key.name.as_str(), &node.value) {
                        ("fractal", Value::Text(_) | Value::Mapping(_)) => {
                            self.inline_fractal(node)
                        }
                        ("union", _) => self.inline_fractals_in(node),
                        _ => {}
                    }
                }
            }
            _ => {}
        }
    }

    /// Puts in the place of a fractal's name all that its file says; where that is wrong, a text stays.
    fn inline_fractal(&mut self, node: &mut Node) {
        let found = if self.missing < MOST_MISSING {
            self.fractal(node)
        } else {
            None
        };
        if let Some(found) = found {
            *node = found;
        } else {
            self.missing += 1;
            self.complete = false;
            node.value = Value::Text(String::new());
        }
    }

    /// All that a fractal's file says, or what is written in its place.
    fn fractal(&mut self, node: &Node) -> Option<Node> {
        *self.fractals += 1;
        if *self.fractals > MOST_FRACTALS {
            let message =
                format!("all fractals together are made of more than {MOST_FRACTALS} others");
            self.error(&node.place, message, "let fewer sets be fractals");
            return None;
        }
        let mut around = self.around.to_vec();
        around.extend(self.chain.iter().cloned());
        let (source, content) = match &node.value {
            Value::Text(name) => {
                // Beside the file that names it.
                let mut beside = around.clone();
                beside.push(Arc::clone(node.place.source()));
                let found = self.catalogue.parent(name, &beside);
                let source = found
                    .map_err(|error| self.diagnostics.push(error.at(&node.place)))
                    .ok()?;
                self.check_is_new(name, &source, &around, node)?;
                let content = self.parse(&source)?;
                (source, content)
            }
            _ => (Arc::clone(node.place.source()), node.clone()),
        };
        let (found, _, complete) = assemble_within(
            &around,
            self.fractals,
            &source,
            content,
            self.catalogue,
            self.diagnostics,
        )?;
        if let Err(error) = self.budget.component(Size::of(&found), &node.place) {
            self.diagnostics.push(error);
            return None;
        }
        complete.then_some(found)
    }

    /// Refuses fractals that are made of themselves, or of too many.
    fn check_is_new(
        &mut self,
        name: &str,
        source: &Arc<Source>,
        around: &[Arc<Source>],
        node: &Node,
    ) -> Option<()> {
        if around.iter().any(|file| is_same_file(file, source)) {
            let names = around.iter().chain([source]).map(|source| source.name());
            let names: Vec<_> = names.collect();
            let hint = format!("each names the next: {}", names.join(", "));
            self.error(&node.place, format!("'{name}' is made of itself"), &hint);
            return None;
        }
        if self.around.len() >= MOST_DEEP {
            let message = format!("more than {MOST_DEEP} fractals are made of each other");
            self.error(&node.place, message, "write the sets out");
            return None;
        }
        Some(())
    }
}
