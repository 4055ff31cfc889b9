//! What a file comes to: a validated model of one of the kinds of linear fractals.

use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::graph::{CompileError, Graph};
use crate::heading::Heading;
use crate::ifs::System;
use crate::instancing::Instancing;
use crate::rule::Rule;

/// A kind of files that can be grown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A production rule.
    #[default]
    Rule,
    /// An iterated function system.
    Ifs,
    /// A structure of objects that instance each other.
    Instancing,
}

impl Kind {
    /// All kinds, in the order in which they are listed and names are looked up.
    pub const ALL: [Self; 3] = [Self::Rule, Self::Ifs, Self::Instancing];

    /// What `kind:` says in its files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rule => "rule",
            Self::Ifs => "ifs",
            Self::Instancing => "instancing",
        }
    }
}

/// A validated model: immutable, without text that is still to be parsed.
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    /// A production rule.
    Rule(Arc<Rule>),
    /// An iterated function system.
    Ifs(Arc<System>),
    /// A structure of objects that instance each other.
    Instancing(Arc<Instancing>),
}

impl Model {
    /// Its kind.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Rule(_) => Kind::Rule,
            Self::Ifs(_) => Kind::Ifs,
            Self::Instancing(_) => Kind::Instancing,
        }
    }

    /// What files of all kinds say.
    #[must_use]
    pub fn heading(&self) -> &Heading {
        match self {
            Self::Rule(rule) => &rule.heading,
            Self::Ifs(system) => &system.heading,
            Self::Instancing(structure) => &structure.heading,
        }
    }

    /// The production rule, if it is one.
    #[must_use]
    pub fn rule(&self) -> Option<&Arc<Rule>> {
        match self {
            Self::Rule(rule) => Some(rule),
            Self::Ifs(_) | Self::Instancing(_) => None,
        }
    }

    /// The production rule, if it is one.
    #[must_use]
    pub fn into_rule(self) -> Option<Arc<Rule>> {
        match self {
            Self::Rule(rule) => Some(rule),
            Self::Ifs(_) | Self::Instancing(_) => None,
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
            Self::Ifs(system) => Ok(Graph::of_system(system)),
            Self::Instancing(structure) => Ok(Graph::of_structure(structure)),
        }
    }

    /// An error of [`Model::compile`], or of a walk, as a mistake in the model's file.
    #[must_use]
    pub fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        match self {
            Self::Rule(rule) => error.diagnostic(rule),
            Self::Ifs(_) | Self::Instancing(_) => Diagnostic::error(error.to_string()),
        }
    }
}
