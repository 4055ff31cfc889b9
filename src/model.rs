//! What a file comes to: a validated model of one of the kinds of linear fractals.

use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::graph::{CompileError, Graph};
use crate::heading::Heading;
use crate::rule::Rule;

/// A kind of files that can be grown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A production rule.
    #[default]
    Rule,
}

impl Kind {
    /// All kinds, in the order in which they are listed and names are looked up.
    pub const ALL: [Self; 1] = [Self::Rule];

    /// What `kind:` says in its files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rule => "rule",
        }
    }
}

/// A validated model: immutable, without text that is still to be parsed.
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    /// A production rule.
    Rule(Arc<Rule>),
}

impl Model {
    /// Its kind.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Rule(_) => Kind::Rule,
        }
    }

    /// What files of all kinds say.
    #[must_use]
    pub fn heading(&self) -> &Heading {
        match self {
            Self::Rule(rule) => &rule.heading,
        }
    }

    /// The production rule, if it is one.
    #[must_use]
    pub fn rule(&self) -> Option<&Arc<Rule>> {
        match self {
            Self::Rule(rule) => Some(rule),
        }
    }

    /// The production rule, if it is one.
    #[must_use]
    pub fn into_rule(self) -> Option<Arc<Rule>> {
        match self {
            Self::Rule(rule) => Some(rule),
        }
    }

    /// The model's graph, resolved for at least `steps` steps.
    ///
    /// # Errors
    ///
    /// As for [`Graph::compile`].
    pub fn compile(&self, steps: u32) -> Result<Graph, CompileError> {
        match self {
            Self::Rule(rule) => Graph::compile(rule, steps),
        }
    }

    /// An error of [`Model::compile`], or of a walk, as a mistake in the model's file.
    #[must_use]
    pub fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        match self {
            Self::Rule(rule) => error.diagnostic(rule),
        }
    }
}
