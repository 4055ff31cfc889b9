//! Files of sets in space for other programs: meshes and nested instances.

use std::path::Path;

use crate::grow::WalkError;
use crate::render::{Format, MeshFormat, MeshOptions, SceneFormat, write_mesh, write_scene};
use crate::style::Named;

use super::results::written;
use super::{Error, Fractal};

/// Format of a file of a set in space.
enum Scene {
    /// The visible elements, each with faces of its own.
    Mesh(MeshFormat),
    /// Instances of objects in each other.
    Nested(SceneFormat),
}

impl Fractal {
    /// Writes the approximant of a set in space as a mesh or as nested instances; returns `None` if the extension is that of no
    /// such file.
    pub(super) fn write_in_space(&self, path: &Path, extension: &str) -> Option<Result<(), Error>> {
        let mesh = MeshFormat::from_name(extension).map(Scene::Mesh);
        let nested = || SceneFormat::from_name(extension).map(Scene::Nested);
        Some(self.write_as(path, &mesh.or_else(nested)?))
    }

    fn write_as(&self, path: &Path, scene: &Scene) -> Result<(), Error> {
        self.check_cancelled()?;
        let set = self.drawn_in_space("meshes are those of sets in space")?;
        let steps = { set.steps }.unwrap_or_else(|| self.steps_in_space(&set.graph));
        let mut options = self.options(Format::Svg, self.size)?;
        set.colour(&mut options.style);
        let growth = self.growth(steps);
        if !matches!(scene, Scene::Nested(format) if format.stays_nested()) {
            let limit = self.max_elements;
            let checked = set.graph.check_size(steps, limit);
            checked.map_err(|_| Error::Walk(WalkError::TooManyElements { limit }))?;
        }
        written(path, |out| {
            match scene {
                Scene::Mesh(format) => {
                    let mesh = MeshOptions::default().format(*format);
                    write_mesh(&set.graph, &growth, &options, mesh, out)?;
                }
                Scene::Nested(format) => {
                    let (space, cancel) = (self.space_options(), self.cancel.as_deref());
                    write_scene(&set.graph, steps, &options, &space, *format, cancel, out)?;
                }
            }
            Ok(())
        })
    }
}
