//! Files of nested instances in space for other programs.

use std::io::Write;
use std::sync::atomic::AtomicBool;

use crate::geometry::Frame3;
use crate::graph::Graph;
use crate::style::Named;

use super::super::error::RenderError;
use super::super::options::Options;
use super::super::picture::Instanced;
use super::super::space::{Eye, SpaceOptions};
use super::nested::Nested;
#[cfg(feature = "threemf")]
use super::threemf;
use super::{glb, pov, usda};

/// Format of nested instances in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SceneFormat {
    /// Universal Scene Description, as text: the graph itself, of any depth. y points up.
    Usda,
    /// 3D Manufacturing Format: objects of components. z points up, and lengths are millimetres: the long side is that
    /// of the options' size if their [unit](super::super::Unit) has a length, and 100 mm otherwise.
    #[cfg(feature = "threemf")]
    ThreeMf,
    /// Scene of POV-Ray, as text, with the camera and the light of a picture. y points up.
    Pov,
    /// Binary glTF: a tree of nodes, of which the last levels are meshes that nodes share. y points up.
    Glb,
}

impl Named for SceneFormat {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("usda", Self::Usda),
        #[cfg(feature = "threemf")]
        ("3mf", Self::ThreeMf),
        ("glb", Self::Glb),
        ("pov", Self::Pov),
    ];
}

impl SceneFormat {
    /// Returns whether readers keep the elements of a scene as nested instances, rather than expand them.
    #[must_use]
    pub fn stays_nested(self) -> bool {
        self == Self::Usda
    }
}

/// Writes approximant `steps` of a set in space as nested instances. Of the options, the style's colours, the labels
/// and a size in millimetres apply; camera and light of a picture apply to [`SceneFormat::Pov`] only.
///
/// # Errors
///
/// If instances cannot represent the approximant or its colours, if the format holds faces and no element has any, if
/// meshes are too large, if it is cancelled, or if `out` fails.
pub fn write_scene(
    graph: &Graph<Frame3>,
    steps: u32,
    options: &Options,
    space: &SpaceOptions,
    format: SceneFormat,
    cancel: Option<&AtomicBool>,
    out: &mut impl Write,
) -> Result<Instanced, RenderError> {
    let nested = Nested::of(graph, steps, &options.style, cancel)?;
    match format {
        SceneFormat::Usda => usda::write(&nested, &options.labels, out)?,
        #[cfg(feature = "threemf")]
        SceneFormat::ThreeMf => {
            let bounds = graph.bounds(steps);
            threemf::write(&nested.with_faces()?, bounds.as_ref(), options, out)?;
        }
        SceneFormat::Pov => {
            let eye = Eye::of(graph, steps, options, space)?;
            pov::write(
                &nested.with_faces()?,
                &eye,
                space.light.ambient,
                options,
                out,
            )?;
        }
        SceneFormat::Glb => glb::write(&nested.with_faces()?, &options.labels, out)?,
    }
    Ok(Instanced {
        symbols: nested.nests.len() as u64 - 1,
        expanded: nested
            .nests
            .last()
            .map_or(0.0, |whole| whole.expanded - 1.0),
    })
}
