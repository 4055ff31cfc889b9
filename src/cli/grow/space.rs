//! Pictures of sets in space.

use std::path::{Path, PathBuf};

use anyhow::anyhow;

use crate::render::space::write_space;
use crate::render::{self, Detail, Unit};
use crate::style::Named;

use super::super::labels::labels;
use super::super::rule::Loaded;
use super::super::{Failure, format, output, readable};
use super::{Arguments, Format};

/// Draws a set in space; returns the path, a summary and the number of bytes.
pub(super) fn draw(
    arguments: &Arguments,
    loaded: &Loaded,
) -> Result<(PathBuf, String, u64), Failure> {
    check(arguments, loaded)?;
    let default = arguments.rule.file("", "png");
    let path = arguments.output.as_ref().unwrap_or(&default);
    let heading = loaded.model.metadata();
    let style = arguments.picture.style(heading);
    let steps = arguments
        .steps
        .or(heading.steps.filter(|_| arguments.detail.is_none()));
    let graph = loaded.model.compile_in_space(false);
    let graph = graph.ok_or_else(|| anyhow!("{} lies in the plane", loaded.name))?;
    let options = render::Options {
        format: render::Format::Png,
        style,
        view: arguments.picture.view(heading),
        size: arguments.size.size,
        detail: arguments.detail.map(|pixels| Detail {
            pixels,
            decides_steps: steps.is_none(),
        }),
        threads: arguments.growth.threads(),
        labels: labels(
            loaded,
            &described(arguments, steps),
            "grow",
            told(arguments),
        ),
        ..render::Options::default()
    };
    let quiet = arguments.growth.quiet;
    let space = arguments.space.to_options()?;
    let (picture, bytes) = output::write(path, quiet, |mut out, _| {
        write_space(&graph, steps, &options, &space, None, &mut out)
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
fn told(arguments: &Arguments) -> Vec<(&'static str, String)> {
    let mut options: Vec<(&'static str, String)> = Vec::new();
    options.extend(arguments.steps.map(|steps| ("steps", steps.to_string())));
    options.extend(
        arguments
            .detail
            .map(|detail| ("detail", detail.to_string())),
    );
    options.push(("size", arguments.size.to_string()));
    options.extend(arguments.picture.options());
    options.extend(arguments.space.options());
    options
}

/// Refuses options and formats that pictures of sets in space do not have.
fn check(arguments: &Arguments, loaded: &Loaded) -> Result<(), Failure> {
    let path = arguments
        .output
        .as_deref()
        .filter(|path| *path != Path::new("-"));
    let png = Format::Picture(render::Format::Png);
    let asked = match (arguments.format, path) {
        (None, None) => png,
        (asked, path) => format::choose(asked, path)?,
    };
    let name = &loaded.name;
    if asked != png {
        let message = format!(
            "{name} lies in space, and is drawn as .png, not as .{}",
            asked.name()
        );
        return Err(Failure::Usage(message));
    }
    let refused = [
        ("--plot", arguments.plot.is_asked()),
        ("--svg instanced", arguments.svg.is_instanced()),
        ("--zoom", arguments.zoom.is_asked()),
        ("--view", arguments.picture.has_view()),
        ("--method chaos", arguments.chaos.is_asked()),
        ("sizes in millimetres", arguments.size.unit != Unit::Pixel),
    ];
    let lines = arguments.picture.of_lines();
    for (option, is_asked) in refused.into_iter().chain(lines) {
        if is_asked {
            let message = format!("{name} lies in space, and {option} is for the plane");
            return Err(Failure::Usage(message));
        }
    }
    arguments.picture.refuse_hits()
}
