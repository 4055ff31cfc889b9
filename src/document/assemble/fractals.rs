//! Inlining of other fractals that serve as sets.

use std::sync::Arc;

use crate::diagnostic::Source;
use crate::document::node::{Node, Value};
use crate::document::yaml::Size;

use super::{Assembly, MAX_MISSING, assemble_within, is_same_file};

/// Maximum nesting depth of fractals in fractals.
const MAX_DEEP: usize = 8;
/// Maximum number of fractals that are inlined into one file, nested ones included.
const MAX_FRACTALS: usize = 1000;

impl Assembly<'_> {
    /// Replaces the name of a fractal by the content of its file, or by an empty text if that is not
    /// possible.
    pub(super) fn inline_fractal(&mut self, node: &mut Node) {
        let found = if self.missing < MAX_MISSING {
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

    /// Returns the assembled content of a fractal's file, or of the mapping that is written in place of
    /// its name.
    fn fractal(&mut self, node: &Node) -> Option<Node> {
        *self.fractals += 1;
        if *self.fractals > MAX_FRACTALS {
            let message =
                format!("all fractals together are made of more than {MAX_FRACTALS} others");
            self.error(&node.place, message, "let fewer sets be fractals");
            return None;
        }
        let mut around = self.around.to_vec();
        around.extend(self.chain.iter().cloned());
        let (source, content) = match &node.value {
            Value::Text(name) => {
                // Paths are relative to the file that names the fractal.
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

    /// Reports a fractal that contains itself, or that is nested too deeply.
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
        if self.around.len() >= MAX_DEEP {
            let message = format!("more than {MAX_DEEP} fractals are made of each other");
            self.error(&node.place, message, "write the sets out");
            return None;
        }
        Some(())
    }
}
