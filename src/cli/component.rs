//! Components by themselves, for commands that know what to do with one.

use std::path::Path;
use std::sync::Arc;

use crate::build::written::{Entries, sequence};
use crate::catalogue::{Catalogue, Entry, Shelf};
use crate::diagnostic::Source;
use crate::document::node::{Node, Value};

use super::Failure;

/// A component that the command line names.
pub(super) struct Component {
    entry: Entry,
    source: Arc<Source>,
}

impl Component {
    /// The component that an argument stands for, if it stands for one and not for a rule.
    pub(super) fn find(argument: &Path, catalogue: &Catalogue) -> Result<Option<Self>, Failure> {
        let Some(entry) = catalogue.component_named(argument) else {
            return Ok(None);
        };
        let source = catalogue.open(&entry)?;
        Ok(Some(Self { entry, source }))
    }

    /// What it is.
    pub(super) fn shelf(&self) -> Shelf {
        self.entry.shelf
    }

    /// The text of its file.
    pub(super) fn text(&self) -> &str {
        self.source.text()
    }

    /// The shortest rule that uses it, with its title and source: what is to be known of a component
    /// shows in a rule.
    pub(super) fn in_a_rule(&self) -> Arc<Source> {
        let chain =
            |ends: &[f64]| sequence(ends.iter().map(|&x| sequence([x, 0.0].map(Value::Number))));
        let (line, halves) = (chain(&[0.0, 1.0]), chain(&[0.0, 0.5, 1.0]));
        let name = Value::Text(self.entry.name.clone());
        let own = Node::parse(&self.source).ok();
        let said = |key: &str| own.as_ref().and_then(|own| own.get(key));
        let said = |key: &str| said(key).map(|node| node.value.clone());
        let rule = Entries::default()
            .set_some("title", said("title"))
            .set_some("about", said("about"))
            .set_some("source", said("source"));
        let rule = match self.entry.shelf {
            Shelf::Initiators => rule.set("initiator", name).set("generator", halves),
            Shelf::Generators => rule.set("initiator", line).set("generator", name),
            _ => rule
                .set("initiator", line)
                .set("generator", halves)
                .set("base_element", name),
        };
        Source::new(self.source.name(), Node::from(rule.value()).to_yaml())
    }
}
