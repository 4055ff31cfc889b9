//! What `kfrac info` says of an instancing structure beside what it says of all files.

use serde::Serialize;

use crate::instancing::{Instancing, Master};
use crate::wording;

/// How large a structure is, and whether it ends.
#[derive(Serialize)]
pub(super) struct StructureInfo {
    /// The canonical objects, each level of one counted.
    objects: usize,
    /// The instances of objects, and those of shapes.
    instances: usize,
    shapes: usize,
    tints: bool,
    /// Whether an object leads back to itself.
    recursive: bool,
    /// The number of steps after which it has ended.
    ends: Option<u32>,
}

impl StructureInfo {
    pub(super) fn of(structure: &Instancing) -> Self {
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

    /// The same in lines, each with its label.
    pub(super) fn lines(&self) -> Vec<(&'static str, String)> {
        let counted = |count: usize, noun| wording::counted(&(count as u64).into(), noun);
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
