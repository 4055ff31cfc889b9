//! Information of `kfrac info` that only instancing structures have.

use serde::Serialize;

use super::readable;
use crate::ifs::AffineMap;
use crate::instancing::{Instancing, Master};
use crate::model::Model;

/// Size of a structure, and whether it ends.
#[derive(Serialize)]
pub(super) struct StructureInfo {
    /// Number of canonical objects; each level of an object counts.
    objects: usize,
    /// Number of instances of objects.
    instances: usize,
    /// Number of instances of shapes.
    shapes: usize,
    tints: bool,
    /// Whether an object instances itself, directly or through others.
    recursive: bool,
    /// Number of steps after which the structure has ended.
    ends: Option<u32>,
}

impl StructureInfo {
    /// Collects the information of a structure.
    pub(super) fn of(model: &Model) -> Option<Self> {
        match model {
            Model::Instancing(structure) => Some(Self::of_structure(structure)),
            Model::InstancingInSpace(structure) => Some(Self::of_structure(structure)),
            _ => None,
        }
    }

    fn of_structure<M: AffineMap>(structure: &Instancing<M>) -> Self {
        let shapes = structure
            .instances()
            .filter(|instance| matches!(instance.master, Master::Shape(_)))
            .count();
        let ends = structure.depth();
        Self {
            objects: structure.objects().len(),
            instances: structure.instances().count() - shapes,
            shapes,
            tints: structure
                .instances()
                .any(|instance| instance.tint.is_some()),
            recursive: ends.is_none(),
            ends,
        }
    }

    /// Formats the information in lines, each with its label.
    pub(super) fn lines(&self) -> Vec<(&'static str, String)> {
        let counted = |count: usize, noun| readable::counted(&(count as u64).into(), noun);
        vec![
            (
                "objects",
                format!(
                    "{}, {} of objects, {} of shapes{}",
                    counted(self.objects, "object"),
                    counted(self.instances, "instance"),
                    self.shapes,
                    if self.tints { ", tinted" } else { "" },
                ),
            ),
            (
                "recursive",
                match self.ends {
                    None => "yes".into(),
                    Some(steps) => format!("no: it ends after step {steps}"),
                },
            ),
        ]
    }
}
