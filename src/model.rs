//! Validated models of the four kinds of linear fractals, and their compilation to graphs.

mod place;

pub use place::OutOfRange;

use std::borrow::Cow;
use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::graph::{CompileError, Graph};
use crate::ifs::System;
use crate::instancing::Instancing;
use crate::lsystem::LSystem;
use crate::metadata::Metadata;
use crate::rule::Rule;

/// Kind of a model and of its file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// Production rule.
    #[default]
    Rule,
    /// Iterated function system.
    Ifs,
    /// Structure of objects that instance each other.
    Instancing,
    /// L-system.
    LSystem,
}

impl Kind {
    /// All kinds, in the order in which they are listed and in which names are looked up.
    pub const ALL: [Self; 4] = [Self::Rule, Self::Ifs, Self::Instancing, Self::LSystem];

    /// Returns the value of `kind:` in files of the kind.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Rule => "rule",
            Self::Ifs => "ifs",
            Self::Instancing => "instancing",
            Self::LSystem => "lsystem",
        }
    }
}

/// Validated model: immutable, without unparsed text.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Model {
    /// Production rule.
    Rule(Arc<Rule>),
    /// Iterated function system.
    Ifs(Arc<System>),
    /// Structure of objects that instance each other.
    Instancing(Arc<Instancing>),
    /// L-system.
    LSystem(Arc<LSystem>),
}

impl Model {
    /// Returns the kind of the model.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Rule(_) => Kind::Rule,
            Self::Ifs(_) => Kind::Ifs,
            Self::Instancing(_) => Kind::Instancing,
            Self::LSystem(_) => Kind::LSystem,
        }
    }

    /// Returns the metadata of the file.
    #[must_use]
    pub fn metadata(&self) -> &Metadata {
        match self {
            Self::Rule(rule) => &rule.heading,
            Self::Ifs(system) => &system.heading,
            Self::Instancing(structure) => &structure.heading,
            Self::LSystem(system) => &system.heading,
        }
    }

    /// Returns the production rule, or `None` for a model of another kind.
    #[must_use]
    pub fn rule(&self) -> Option<&Arc<Rule>> {
        match self {
            Self::Rule(rule) => Some(rule),
            Self::Ifs(_) | Self::Instancing(_) | Self::LSystem(_) => None,
        }
    }

    /// Converts the model to its production rule, or `None` for a model of another kind.
    #[must_use]
    pub fn into_rule(self) -> Option<Arc<Rule>> {
        match self {
            Self::Rule(rule) => Some(rule),
            Self::Ifs(_) | Self::Instancing(_) | Self::LSystem(_) => None,
        }
    }

    /// Compiles the model to a graph that is resolved for at least `steps` steps, with the seed 0 and the
    /// limit [`MOST_ELEMENTS`](Self::MOST_ELEMENTS) where these matter.
    ///
    /// # Errors
    ///
    /// As for [`Model::compile_for`].
    pub fn compile(&self, steps: u32) -> Result<Graph, CompileError> {
        self.compile_for(steps, 0, Self::MOST_ELEMENTS)
    }

    /// Default limit of the number of elements that are drawn.
    pub const MOST_ELEMENTS: u64 = 50_000_000;

    /// Compiles the model to a graph that is resolved for at least `steps` steps. For an L-system that is
    /// not compiled, its word is derived for exactly `steps` steps, with the draws of `seed`, if it draws
    /// at most `most_elements` elements.
    ///
    /// # Errors
    ///
    /// As for [`Graph::compile`] and [`Graph::of_lsystem`].
    pub fn compile_for(
        &self,
        steps: u32,
        seed: u64,
        most_elements: u64,
    ) -> Result<Graph, CompileError> {
        match self {
            Self::LSystem(system) => Graph::of_lsystem(system, steps, seed, most_elements),
            Self::Rule(rule) => Graph::compile(rule, steps),
            Self::Ifs(system) => Ok(Graph::of_system(system)),
            Self::Instancing(structure) => Ok(Graph::of_structure(structure)),
        }
    }

    /// Returns the model whose graph has the limit set: the model itself, except for an L-system that
    /// rewrites edges apart from widths and colours, which may differ from step to step without end. For
    /// the latter it returns the system [without them](LSystem::without_appearance).
    #[must_use]
    pub fn of_limit(&self) -> Cow<'_, Self> {
        if let Self::LSystem(system) = self
            && !Graph::rewrites_edges(system)
        {
            let plain = system.without_appearance();
            if plain != **system && Graph::rewrites_edges(&plain) {
                return Cow::Owned(Self::LSystem(plain.into()));
            }
        }
        Cow::Borrowed(self)
    }

    /// Converts an error of [`Model::compile`] or of a walk to a diagnostic of the model's file.
    #[must_use]
    pub fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        match self {
            Self::Rule(rule) => error.diagnostic(rule),
            Self::LSystem(system) => system.diagnostic(error),
            Self::Ifs(_) | Self::Instancing(_) => Diagnostic::error(error.to_string()),
        }
    }
}
