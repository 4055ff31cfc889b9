//! Production rules as a kind of model.

use std::sync::Arc;

use crate::diagnostic::Diagnostic;
use crate::geometry::Frame3;
use crate::graph::{CompileError, Graph};
use crate::metadata::Metadata;
use crate::rule::Rule;

use super::place::Extent;
use super::{CompiledInSpace, OfKind};

impl OfKind for Arc<Rule> {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn compile(&self, steps: u32, _seed: u64, _most: u64) -> Result<Graph, CompileError> {
        Graph::compile(self, steps)
    }

    fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        error.diagnostic(self)
    }

    fn extent(&self) -> Option<Extent> {
        Extent::of(self.initiator_points().iter().copied(), std::iter::empty())
    }

    fn normalised(&self, graph: Graph, steps: u32) -> Option<Graph> {
        graph.in_units_of(steps)
    }
}

impl OfKind for Arc<Rule<Frame3>> {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn compile_in_space(&self, steps: u32, _records_last: bool) -> Option<CompiledInSpace> {
        Some(Graph::compile(self, steps))
    }

    fn diagnostic(&self, error: &CompileError) -> Diagnostic {
        error.diagnostic(self)
    }
}
