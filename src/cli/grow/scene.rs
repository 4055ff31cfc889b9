//! Sets in space as files for other programs: nested instances and meshes.

use std::path::PathBuf;

use crate::render::{self, MeshOptions, Size, Unit, write_mesh, write_scene};
use crate::style::Named;

use super::super::labels::labels;
use super::super::picture::named;
use super::super::rule::Loaded;
use super::super::{Failure, output, readable};
use super::Arguments;
use super::plan::{Format, SceneFormat};

/// Options of meshes.
#[derive(clap::Args, Clone)]
#[command(next_help_heading = "Space")]
pub(super) struct SceneArguments {
    /// Faces of a mesh: those of all elements, or the shell that remains where faces that cancel are left out
    #[arg(long, value_name = "FACES", value_parser = named::<Faces>())]
    mesh: Option<Faces>,
}

/// Faces of a mesh.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Faces {
    Elements,
    Shell,
}

impl Named for Faces {
    const NAMES: &'static [(&'static str, Self)] =
        &[("elements", Self::Elements), ("shell", Self::Shell)];
}

impl SceneArguments {
    /// Returns whether an option of meshes is given.
    pub(super) fn is_asked(&self) -> bool {
        self.mesh.is_some()
    }
}

/// Returns the error of an option of meshes for another file.
pub(super) fn mesh_of_none() -> Failure {
    Failure::Usage("--mesh applies to meshes: write a .stl, .obj or .ply".into())
}

/// Writes a step of a set in space; returns the path, a summary and the number of bytes.
pub(super) fn write(
    arguments: &Arguments,
    loaded: &Loaded,
    format: SceneFormat,
) -> Result<(PathBuf, String, u64), Failure> {
    let Arguments {
        growth, picture, ..
    } = arguments;
    let name = &loaded.name;
    let extension = Format::Scene(format).name();
    let metadata = loaded.model.metadata();
    if picture.has_view() {
        let message = format!("{name} lies in space, and --view is for the plane");
        return Err(Failure::Usage(message));
    }
    let Some(steps) = loaded.model.drawn_steps_in_space(arguments.steps(), false) else {
        let message = format!("a .{extension} holds the elements of a step: give --steps");
        return Err(Failure::Usage(message));
    };
    let mut style = picture.style(metadata);
    let drawn = loaded.drawn_in_space(Some(steps), style.color_by)?;
    drawn.colour(&mut style);
    let graph = drawn.graph;
    let levels = drawn.steps.unwrap_or(steps);
    let own = [("steps", steps.to_string())];
    let all = own.into_iter().chain(picture.options());
    let options = render::Options {
        style,
        view: picture.view(metadata),
        size: arguments.size.size,
        unit: arguments.size.unit,
        threads: growth.threads(),
        labels: labels(loaded, &format!("Step {steps}"), "grow", all),
        ..render::Options::default()
    }
    .on_paper();
    let takes_length = format == SceneFormat::Nested(render::SceneFormat::ThreeMf)
        && matches!(arguments.size.size, Size::Long(_));
    if arguments.size.unit != Unit::Pixel && !takes_length {
        let message = "only a .3mf has a size in millimetres, that of its long side: --size 80mm";
        return Err(Failure::Usage(message.into()));
    }
    let default = arguments.rule.file("", extension);
    let path = arguments.output.as_ref().unwrap_or(&default);
    let step = format!("step {steps} of {name}");
    let (summary, bytes) = match format {
        SceneFormat::Nested(format) => {
            if arguments.scene.is_asked() {
                return Err(mesh_of_none());
            }
            if !format.stays_nested() {
                let otherwise = format!(
                    "; programs that read a .{extension} expand it, and a .usda stays nested"
                );
                growth.check_or(levels, &graph, loaded, &otherwise)?;
            }
            let space = arguments.space.to_options(&loaded.model.space_view())?;
            let (scene, bytes) = growth.write(path, |mut out, _| {
                write_scene(
                    &graph,
                    levels,
                    &options,
                    &space,
                    format,
                    growth.cancel(),
                    &mut out,
                )
                .map_err(|error| output::explain(error, path))
            })?;
            let objects = readable::counted(&scene.symbols.into(), "object");
            (format!("{step}, {objects} in nested instances"), bytes)
        }
        SceneFormat::Mesh(format) => {
            growth.check(levels, &graph, loaded)?;
            let mesh = MeshOptions::default()
                .format(format)
                .shell(arguments.scene.mesh == Some(Faces::Shell));
            let (mesh, bytes) = growth.write(path, |mut out, progress| {
                let growth = growth.to(levels, progress);
                write_mesh(&graph, &growth, &options, mesh, &mut out)
                    .map_err(|error| output::explain(error, path))
            })?;
            let elements = readable::counted(&mesh.elements.into(), "element");
            let faces = readable::counted(&mesh.faces.into(), "face");
            (format!("{step}, {elements}, {faces}"), bytes)
        }
    };
    Ok((path.clone(), summary, bytes))
}
