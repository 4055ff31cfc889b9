//! Pictures of sets in space, and tables of their elements and points.

use std::path::{Path, PathBuf};

use anyhow::anyhow;

use crate::grow::Progress;
use crate::model::for_pixels;
use crate::render::space::{SpacePicture, pixels_in_space, sight_in_space};
use crate::render::{self, Detail, Picture, Unit};
use crate::style::Named;

use super::super::chaos::SpaceGame;
use super::super::held::Survey;
use super::super::labels::labels;
use super::super::rule::Loaded;
use super::super::{Failure, output, readable, steps};
use super::Arguments;
use super::plan::Plan;

/// Draws a set in space, or lists its elements or points; returns the path, a summary and the number of bytes.
pub(super) fn draw(
    arguments: &Arguments,
    loaded: &Loaded,
    plan: &Plan,
) -> Result<(PathBuf, String, u64), Failure> {
    let extension = check(arguments, loaded, plan)?;
    let default = arguments.rule.file("", extension);
    let path = arguments.output.as_ref().unwrap_or(&default);
    let metadata = loaded.model.metadata();
    let style = arguments.picture.style(metadata);
    if let Plan::Table(format) = *plan {
        let graph = loaded.in_space(arguments.steps())?;
        let graph = graph.ok_or_else(|| anyhow!("{} lies in the plane", loaded.name))?;
        let steps = steps::choose_in_space(arguments.steps(), loaded, &graph);
        arguments.growth.check(steps, &graph, loaded)?;
        let (listed, bytes) = arguments.list_step(&graph, steps, loaded, format, path)?;
        let summary = format!("step {steps} of {}, {listed}", loaded.name);
        return Ok((path.clone(), summary, bytes));
    }
    let game = match plan {
        Plan::Chaos(_) | Plan::Cloud => Some(SpaceGame::in_space(arguments.game(), loaded)?),
        _ => None,
    };
    let steps =
        { &loaded.model }.drawn_steps_in_space(arguments.steps(), arguments.detail.is_some());
    let mut options = render::Options {
        format: render::Format::Png,
        style,
        view: arguments.picture.view(metadata),
        size: arguments.size.size,
        detail: arguments.detail.map(|pixels| Detail {
            pixels,
            decides_steps: steps.is_none(),
        }),
        threads: arguments.growth.threads(),
        png: arguments.growth.png_encoding(),
        labels: labels(
            loaded,
            &{ game.as_ref() }.map_or_else(|| described(arguments, steps), SpaceGame::described),
            "grow",
            options(arguments, game.as_ref()),
        ),
        ..render::Options::default()
    }
    .on_paper();
    let mut space = arguments.space.to_options(&loaded.model.space_view())?;
    space.camera.zoom = arguments.zoom.in_space();
    let space = space.keeps_depths(arguments.depth.is_some());
    let drawn = loaded.drawn_in_space(steps, for_pixels(options.style.color_by))?;
    drawn.colour(&mut options.style);
    let graph = drawn.graph;
    if let Some((held, survey)) = arguments.growth.survey() {
        held.done().provenance = Some(options.labels.provenance.clone());
        if survey == Survey::Provenance {
            return Ok((path.clone(), String::new(), 0));
        }
        // Whether anything is left of a set that is cut is known from its picture, and so is the place of points.
        if game.is_none() && space.is_whole() {
            let sight = sight_in_space(&graph, drawn.steps, &options, &space);
            held.note_sight(sight.map_err(|error| output::explain(error, path))?);
            return Ok((path.clone(), String::new(), 0));
        }
    }
    if let Some(game) = game {
        if let Plan::Chaos(Some(_)) | Plan::Cloud = plan {
            let (summary, bytes) = arguments.write_picture(path, |out, progress| match *plan {
                Plan::Chaos(Some(format)) => game.list(format, progress, out, path),
                _ => game.write_ply(&graph, &options.style, progress, out, path),
            })?;
            return Ok((path.clone(), summary, bytes));
        }
        let (picture, bytes) = write(arguments, path, &options, |progress| {
            game.draw(&graph, &options, &space, progress, path)
        })?;
        let [width, height] = picture.size;
        let points = game.listed(picture.elements);
        let summary = format!("{points}, {width} x {height} pixels");
        return Ok((path.clone(), summary, bytes));
    }
    let (picture, bytes) = write(arguments, path, &options, |_| {
        pixels_in_space(
            &graph,
            drawn.steps,
            &options,
            &space,
            arguments.growth.cancel(),
        )
        .map_err(|error| output::explain(error, path))
    })?;
    let reached = match steps {
        Some(steps) => format!("step {steps} of {}", loaded.name),
        None => format!(
            "{} to a detail of {}, {}",
            loaded.name,
            pixels(arguments.detail.unwrap_or(1.0)),
            readable::counted(&u64::from(picture.steps).into(), "step")
        ),
    };
    let [width, height] = picture.size;
    let elements = readable::counted(&picture.elements.into(), "element");
    let summary = format!("{reached}, {elements} drawn, {width} x {height} pixels");
    Ok((path.clone(), summary, bytes))
}

/// Writes a picture, and its depths if they are asked for: both files, or none.
fn write(
    arguments: &Arguments,
    path: &Path,
    options: &render::Options,
    draw: impl FnOnce(Option<&Progress>) -> Result<SpacePicture, Failure>,
) -> Result<(Picture, u64), Failure> {
    let write = || {
        let ((picture, depths), bytes) = arguments.write_picture(path, |out, progress| {
            let SpacePicture {
                pixels,
                depths,
                picture,
                sight,
                ..
            } = draw(progress)?;
            if let Some(held) = &arguments.growth.held {
                held.note_picture(&picture, None);
                held.note_sight(sight);
            }
            let written = pixels.write(options, out);
            written.map_err(|error| output::explain(error, path))?;
            Ok((picture, depths))
        })?;
        Ok((depths, (picture, bytes)))
    };
    let Some(depth_path) = &arguments.depth else {
        return write().map(|(_, written)| written);
    };
    if depth_path == path {
        let message = "the picture and its depths are two files: name another one for --depth";
        return Err(Failure::Usage(message.into()));
    }
    let (written, _) = output::write(depth_path, true, |mut out, _| {
        let (depths, written) = write()?;
        if let Some(depths) = depths {
            let written = depths.write(&mut out);
            written.map_err(|error| output::failed(error, depth_path))?;
        }
        Ok(written)
    })?;
    Ok(written)
}

fn pixels(number: f64) -> String {
    format!("{number} pixel{}", if number == 1.0 { "" } else { "s" })
}

fn described(arguments: &Arguments, steps: Option<u32>) -> String {
    match (steps, arguments.detail) {
        (Some(steps), None) => format!("Step {steps}"),
        (Some(steps), Some(detail)) => format!("Step {steps}, detail down to {},", pixels(detail)),
        (None, detail) => format!("Detail down to {}", pixels(detail.unwrap_or(1.0))),
    }
}

/// Returns the options of the picture, with their values.
fn options(arguments: &Arguments, game: Option<&SpaceGame<'_>>) -> Vec<(&'static str, String)> {
    let mut options: Vec<(&'static str, String)> = Vec::new();
    match game {
        Some(game) => options.extend(game.options()),
        None => options.extend(arguments.steps().map(|steps| ("steps", steps.to_string()))),
    }
    options.extend(
        arguments
            .detail
            .map(|detail| ("detail", detail.to_string())),
    );
    options.push(("size", arguments.size.to_string()));
    options.extend(arguments.own_options());
    options.extend(arguments.zoom.options());
    options.extend(arguments.picture.options());
    options.extend(arguments.space.options());
    let depth = arguments.depth.iter();
    options.extend(depth.map(|path| ("depth", path.display().to_string())));
    options
}

/// Returns the extension of the file, and refuses options and formats that sets in space do not have.
fn check(arguments: &Arguments, loaded: &Loaded, plan: &Plan) -> Result<&'static str, Failure> {
    let name = &loaded.name;
    let extension = match plan {
        // Without a file or a format, it is a PNG here.
        Plan::Picture { .. } if arguments.format.is_none() && !arguments.names_file() => {
            render::Format::Png.name()
        }
        plan => plan.extension(),
    };
    let refused = [
        ("--svg instanced", arguments.svg.is_instanced()),
        ("--at", arguments.zoom.has_centre()),
        ("--turn", arguments.turn.is_some()),
        ("--drawn", arguments.drawn.is_some()),
        ("--view", arguments.picture.has_view()),
        (
            "--tone without --method chaos",
            arguments.chaos.tone_of_elements().is_some(),
        ),
        ("sizes in millimetres", arguments.size.unit != Unit::Pixel),
    ];
    let lines = arguments.picture.of_lines();
    for (option, is_asked) in refused.into_iter().chain(lines) {
        if is_asked {
            let message = format!("{name} lies in space, and {option} is for the plane");
            return Err(Failure::Usage(message));
        }
    }
    Ok(extension)
}
