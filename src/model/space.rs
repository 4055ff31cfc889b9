//! Systems in space as a kind of model.

use std::sync::Arc;

use crate::geometry::DAffine3;
use crate::graph::{CompileError, Graph};
use crate::ifs::{System, Verdict};
use crate::metadata::Metadata;

use super::OfKind;

impl OfKind for Arc<System<DAffine3>> {
    fn metadata(&self) -> &Metadata {
        &self.heading
    }

    fn compile(&self, _steps: u32, _seed: u64, _most: u64) -> Result<Graph, CompileError> {
        Err(CompileError::InSpace)
    }

    fn is_drawn_to_limit(&self, _has_limit: &dyn Fn() -> bool) -> bool {
        self.contraction().verdict == Verdict::Contracts
    }
}
