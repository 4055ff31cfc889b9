//! L-systems as a kind of model.

use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::extent::NoLimit;
use crate::graph::{CompileError, Graph};
use crate::lsystem::{LSystem, LSystemInSpace};
use crate::metadata::Metadata;

use super::{Model, OfKind};

impl OfKind for Arc<LSystem> {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn compile(&self, steps: u32, seed: u64, max_elements: u64) -> Result<Graph, CompileError> {
        Graph::of_lsystem(self, steps, seed, max_elements)
    }

    fn too_deep(&self, steps: u32, max_elements: u64) -> Option<CompileError> {
        let error = LSystem::too_deep(self, steps, max_elements)?;
        (!Graph::rewrites_edges(self)).then_some(error)
    }

    fn soon_compiled(&self, steps: u32) -> u32 {
        LSystem::soon_compiled(self, steps)
    }

    fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        LSystem::diagnostic(self, error)
    }

    fn of_limit(&self) -> Option<Model> {
        if Graph::rewrites_edges(self) {
            return None;
        }
        let plain = self.without_appearance();
        if plain != **self && Graph::rewrites_edges(&plain) {
            return Some(plain.into());
        }
        (self.is_deterministic() && !self.in_limit).then(|| LSystem::in_limit(self).into())
    }

    fn no_limit(&self) -> Option<NoLimit> {
        let reason = { self.in_limit }.then(|| self.check_growth().err());
        reason.flatten().map(NoLimit::from)
    }

    fn starts_anew(&self) -> bool {
        match self.in_limit {
            true => self.no_limit().is_some(),
            false => !Graph::rewrites_edges(self),
        }
    }

    fn deepest(&self, max_steps: u32, max_elements: u64) -> Option<u32> {
        let images = { self.metadata.symmetry.as_ref() }.map_or(1, |group| group.order().into());
        Some(LSystem::deepest(self, max_steps, max_elements / images))
    }
}

impl OfKind for Arc<LSystemInSpace> {
    fn metadata(&self) -> &Metadata {
        &self.words.metadata
    }

    fn too_deep(&self, steps: u32, max_elements: u64) -> Option<CompileError> {
        self.words.too_deep(steps, max_elements)
    }

    fn soon_compiled(&self, steps: u32) -> u32 {
        self.words.soon_compiled(steps)
    }

    fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        self.words.diagnostic(error)
    }

    fn of_limit(&self) -> Option<Model> {
        let words = &self.words;
        (words.is_deterministic() && !words.in_limit).then(|| LSystemInSpace::in_limit(self).into())
    }

    fn no_limit(&self) -> Option<NoLimit> {
        let reason = { self.words.in_limit }.then(|| self.check_growth().err());
        reason.flatten().map(NoLimit::from)
    }

    fn starts_anew(&self) -> bool {
        !self.words.in_limit || self.no_limit().is_some()
    }

    fn deepest(&self, most_steps: u32, max_elements: u64) -> Option<u32> {
        Some(self.words.deepest(most_steps, max_elements))
    }
}
