//! What a file comes to: a validated model of one of the kinds of linear fractals.

mod place;

pub use place::OutOfRange;

use std::borrow::Cow;
use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::graph::{CompileError, Graph};
use crate::heading::Heading;
use crate::ifs::System;
use crate::instancing::Instancing;
use crate::lsystem::LSystem;
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
    /// An L-system.
    LSystem,
}

impl Kind {
    /// All kinds, in the order in which they are listed and names are looked up.
    pub const ALL: [Self; 4] = [Self::Rule, Self::Ifs, Self::Instancing, Self::LSystem];

    /// What `kind:` says in its files.
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

/// A validated model: immutable, without text that is still to be parsed.
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    /// A production rule.
    Rule(Arc<Rule>),
    /// An iterated function system.
    Ifs(Arc<System>),
    /// A structure of objects that instance each other.
    Instancing(Arc<Instancing>),
    /// An L-system.
    LSystem(Arc<LSystem>),
}

impl Model {
    /// Its kind.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Rule(_) => Kind::Rule,
            Self::Ifs(_) => Kind::Ifs,
            Self::Instancing(_) => Kind::Instancing,
            Self::LSystem(_) => Kind::LSystem,
        }
    }

    /// What files of all kinds say.
    #[must_use]
    pub fn heading(&self) -> &Heading {
        match self {
            Self::Rule(rule) => &rule.heading,
            Self::Ifs(system) => &system.heading,
            Self::Instancing(structure) => &structure.heading,
            Self::LSystem(system) => &system.heading,
        }
    }

    /// The production rule, if it is one.
    #[must_use]
    pub fn rule(&self) -> Option<&Arc<Rule>> {
        match self {
            Self::Rule(rule) => Some(rule),
            Self::Ifs(_) | Self::Instancing(_) | Self::LSystem(_) => None,
        }
    }

    /// The production rule, if it is one.
    #[must_use]
    pub fn into_rule(self) -> Option<Arc<Rule>> {
        match self {
            Self::Rule(rule) => Some(rule),
            Self::Ifs(_) | Self::Instancing(_) | Self::LSystem(_) => None,
        }
    }

    /// The model's graph, resolved for at least `steps` steps; for the seed 0 and
    /// [`MOST_ELEMENTS`](Self::MOST_ELEMENTS), where that matters.
    ///
    /// # Errors
    ///
    /// As for [`Model::compile_for`].
    pub fn compile(&self, steps: u32) -> Result<Graph, CompileError> {
        self.compile_for(steps, 0, Self::MOST_ELEMENTS)
    }

    /// So many elements are drawn unless somebody allows more.
    pub const MOST_ELEMENTS: u64 = 50_000_000;

    /// The model's graph, resolved for at least `steps` steps. Where an L-system is not compiled, its words are
    /// written for exactly as many, by the draws of a seed, if they draw no more elements than are allowed.
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

    /// The model whose graph has the limit set. That is the model itself, unless an L-system rewrites edges but
    /// for widths and colours, which may differ from step to step without end: then it is the same system
    /// [without them](LSystem::without_looks).
    #[must_use]
    pub fn of_limit(&self) -> Cow<'_, Self> {
        if let Self::LSystem(system) = self
            && !Graph::rewrites_edges(system)
        {
            let plain = system.without_looks();
            if plain != **system && Graph::rewrites_edges(&plain) {
                return Cow::Owned(Self::LSystem(plain.into()));
            }
        }
        Cow::Borrowed(self)
    }

    /// An error of [`Model::compile`], or of a walk, as a mistake in the model's file.
    #[must_use]
    pub fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        match self {
            Self::Rule(rule) => error.diagnostic(rule),
            Self::LSystem(system) => system.diagnostic(error),
            Self::Ifs(_) | Self::Instancing(_) => Diagnostic::error(error.to_string()),
        }
    }
}
