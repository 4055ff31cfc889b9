//! Components named on the command line, for commands that accept them in place of a rule.

use std::path::Path;
use std::sync::Arc;

use crate::build::written::{Entries, sequence};
use crate::catalogue::{Catalogue, LibraryFile, Shelf};
use crate::diagnostic::Source;
use crate::document::node::{Node, Value};

use super::Failure;

/// Component that the command line names.
pub(crate) struct Component {
    entry: LibraryFile,
    source: Arc<Source>,
}

impl Component {
    /// Returns the component that an argument names, or `None` if it names a rule or nothing.
    pub(super) fn find(argument: &Path, catalogue: &Catalogue) -> Result<Option<Self>, Failure> {
        let Some(entry) = catalogue.component_named(argument) else {
            return Ok(None);
        };
        let source = catalogue.open(&entry)?;
        Ok(Some(Self { entry, source }))
    }

    /// Returns the component of an entry that has been read.
    pub(crate) fn of(entry: LibraryFile, source: Arc<Source>) -> Self {
        Self { entry, source }
    }

    /// Returns the kind of the component.
    pub(super) fn shelf(&self) -> Shelf {
        self.entry.shelf
    }

    /// Returns the text of its file.
    pub(super) fn text(&self) -> &str {
        self.source.text()
    }

    /// Returns a minimal rule that uses the component, with its title, description and source: components are
    /// drawn and checked in a rule.
    pub(crate) fn in_a_rule(&self) -> Arc<Source> {
        let chain =
            |ends: &[f64]| sequence(ends.iter().map(|&x| sequence([x, 0.0].map(Value::Number))));
        let (line, halves) = (chain(&[0.0, 1.0]), chain(&[0.0, 0.5, 1.0]));
        let name = Value::Text(self.entry.name.clone());
        let own = Node::parse(&self.source).ok();
        let value_of = |key: &str| own.as_ref().and_then(|own| own.get(key));
        let value_of = |key: &str| value_of(key).map(|node| node.value.clone());
        let rule = Entries::default()
            .set_some("space", value_of("space"))
            .set_some("title", value_of("title"))
            .set_some("about", value_of("about"))
            .set_some("source", value_of("source"));
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
