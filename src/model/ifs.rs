//! Iterated function systems as a kind of model.

use std::sync::Arc;

use crate::compile::growing;
use crate::geometry::{DAffine3, Homothety};
use crate::graph::{CompileError, Graph};
use crate::ifs::{System, Verdict};
use crate::metadata::Metadata;

use super::place::Extent;
use super::{CompiledInSpace, Model, OfKind};

impl OfKind for Arc<System> {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn compile(&self, _steps: u32, _seed: u64, _most: u64) -> Result<Graph, CompileError> {
        Ok(growing::of_system(self, Graph::of_system(self)))
    }

    fn extent(&self) -> Option<Extent> {
        let ifs = self.ifs();
        let sets = ifs.condensation().iter().map(|set| &set.shape);
        let fixed = ifs.fixed_points().into_iter().flatten();
        let drawn = sets.flat_map(|set| set.control_points());
        Extent::of(fixed.chain(drawn), ifs.maps().iter().cloned())
    }

    fn within(&self, place: &Homothety) -> Option<Model> {
        System::within(self, place).map(Model::from)
    }

    fn has_plane_maps(&self) -> bool {
        true
    }

    fn is_drawn_to_limit(&self, _has_limit: &dyn Fn() -> bool) -> bool {
        self.contraction().verdict == Verdict::Contracts
    }
}

impl OfKind for Arc<System<DAffine3>> {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn compile_in_space(&self, _steps: u32, records_last: bool) -> Option<CompiledInSpace> {
        let recorded = records_last.then(|| Graph::with_last_maps(self));
        let graph = recorded.flatten();
        let graph = graph.unwrap_or_else(|| Graph::of_system(self));
        Some(Ok(growing::of_system(self, graph)))
    }

    fn is_drawn_to_limit(&self, _has_limit: &dyn Fn() -> bool) -> bool {
        self.contraction().verdict == Verdict::Contracts
    }
}
