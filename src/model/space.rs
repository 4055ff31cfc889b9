//! Models in space: systems and structures.

use std::sync::Arc;

use crate::geometry::{DAffine3, Frame3};
use crate::graph::{CompileError, Graph};
use crate::ifs::{System, Verdict};
use crate::instancing::Instancing;
use crate::metadata::Metadata;

use super::{Model, OfKind};

impl OfKind for Arc<System<DAffine3>> {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn compile(&self, _steps: u32, _seed: u64, _most: u64) -> Result<Graph, CompileError> {
        Err(CompileError::InSpace)
    }

    fn is_drawn_to_limit(&self, _has_limit: &dyn Fn() -> bool) -> bool {
        self.contraction().verdict == Verdict::Contracts
    }
}

impl OfKind for Arc<Instancing<DAffine3>> {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn compile(&self, _steps: u32, _seed: u64, _most: u64) -> Result<Graph, CompileError> {
        Err(CompileError::InSpace)
    }

    fn ends(&self) -> Option<u32> {
        self.depth()
    }

    fn is_drawn_to_limit(&self, has_limit: &dyn Fn() -> bool) -> bool {
        self.depth().is_none() && has_limit()
    }
}

impl Model {
    /// Returns whether the model lies in space; [`compile_in_space`](Self::compile_in_space) compiles it then.
    #[must_use]
    pub fn is_in_space(&self) -> bool {
        matches!(
            self,
            Self::RuleInSpace(_) | Self::IfsInSpace(_) | Self::InstancingInSpace(_)
        )
    }

    /// Compiles a model in space to the graph of its elements, which is resolved for at least `steps` steps; `None` for
    /// a model of the plane.
    ///
    /// # Errors
    ///
    /// If a generator yields points that are not finite within these steps.
    pub fn graph_in_space(&self, steps: u32) -> Option<Result<Graph<Frame3>, CompileError>> {
        match self {
            Self::RuleInSpace(rule) => Some(Graph::compile(rule, steps)),
            _ => self.compile_in_space(false).map(Ok),
        }
    }

    /// Compiles a system or a structure in space to its graph; `None` for other models. Objects of a system record the map
    /// that is applied last if `records_last`, unless there are too many for it.
    #[must_use]
    pub fn compile_in_space(&self, records_last: bool) -> Option<Graph<Frame3>> {
        match self {
            Self::IfsInSpace(system) => {
                let recorded = records_last.then(|| Graph::with_last_maps(system));
                let recorded = recorded.flatten();
                Some(recorded.unwrap_or_else(|| Graph::of_system(system)))
            }
            Self::InstancingInSpace(structure) => Some(Graph::of_structure(structure)),
            _ => None,
        }
    }
}
