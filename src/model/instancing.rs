//! Structures of objects as a kind of model.

use std::sync::Arc;

use crate::compile::growing;
use crate::geometry::{DAffine3, Homothety};
use crate::graph::{CompileError, Graph};
use crate::ifs::{Map, Shape};
use crate::instancing::{Instancing, Master};
use crate::metadata::Metadata;

use super::place::Extent;
use super::{CompiledInSpace, Model, OfKind};

impl OfKind for Arc<Instancing> {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn compile(&self, _steps: u32, _seed: u64, _most: u64) -> Result<Graph, CompileError> {
        Ok(growing::of_structure(self, Graph::of_structure(self)))
    }

    fn extent(&self) -> Option<Extent> {
        let maps = || {
            let objects = self
                .instances()
                .filter(|it| matches!(it.master, Master::Object(_)));
            objects.map(|it| Map::new(self.map_of(it)))
        };
        let shapes = self.instances().filter_map(|it| match &it.master {
            Master::Shape(shape) => shape.transformed(&it.map),
            Master::Object(_) => None,
        });
        let drawn = shapes.flat_map(|shape| shape.control_points());
        let initial = self.initial().map(Shape::control_points);
        let fixed = maps().filter(Map::contracts);
        let fixed = fixed.filter_map(|map| map.fixed_point());
        let points = drawn.chain(initial.into_iter().flatten()).chain(fixed);
        Extent::of(points, maps())
    }

    fn within(&self, place: &Homothety) -> Option<Model> {
        Instancing::within(self, place).map(Model::from)
    }

    fn has_plane_maps(&self) -> bool {
        true
    }

    fn ends(&self) -> Option<u32> {
        self.depth()
    }

    fn is_drawn_to_limit(&self, has_limit: &dyn Fn() -> bool) -> bool {
        self.depth().is_none() && has_limit()
    }
}

impl OfKind for Arc<Instancing<DAffine3>> {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn compile_in_space(&self, _steps: u32, _records_last: bool) -> Option<CompiledInSpace> {
        Some(Ok(growing::of_structure(self, Graph::of_structure(self))))
    }

    fn ends(&self) -> Option<u32> {
        self.depth()
    }

    fn is_drawn_to_limit(&self, has_limit: &dyn Fn() -> bool) -> bool {
        self.depth().is_none() && has_limit()
    }
}
