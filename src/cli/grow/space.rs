//! Pictures of sets in space: the camera, the shading, and the drawing.

use std::path::{Path, PathBuf};

use anyhow::anyhow;

use crate::geometry::DVec3;
use crate::render::space::{Camera, Light, Shade, SpaceOptions, write_space};
use crate::render::{self, Detail, Unit, write_usda};
use crate::style::{ColorBy, Named};

use super::super::labels::labels;
use super::super::picture::named;
use super::super::rule::Loaded;
use super::super::{Failure, format, output, readable};
use super::{Arguments, Format};

/// Options of sets in space.
#[derive(clap::Args)]
#[command(next_help_heading = "Space")]
pub(super) struct SpaceArguments {
    /// Direction from which a set in space is seen: azimuth and elevation in degrees, or front, side, top or iso
    ///
    /// Azimuth 0 is in front and 90 on the right; elevation 90 is above. [default: 30,25]
    #[arg(long, value_name = "AZ,EL", value_parser = from, allow_hyphen_values = true)]
    from: Option<[f64; 2]>,
    /// Vector that points upwards in the picture [default: the y axis]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    up: Option<DVec3>,
    /// Point in the middle of the picture [default: that of the set]
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    look_at: Option<DVec3>,
    /// Angle of view in degrees, for a picture in perspective [default: parallel]
    #[arg(long, value_name = "DEGREES", value_parser = angle, allow_hyphen_values = true)]
    perspective: Option<f64>,
    /// Shading: depth darkens what is far, relief lights surfaces that are taken from the depths
    #[arg(long, value_name = "HOW", value_parser = named::<Shade>())]
    shade: Option<Shade>,
    /// Direction of the light of relief: azimuth and elevation in degrees [default: 0,45]
    #[arg(long, value_name = "AZ,EL", value_parser = from, allow_hyphen_values = true)]
    light: Option<[f64; 2]>,
    /// Intensity of what the light of relief does not reach, from 0 to 1 [default: 0.15]
    #[arg(long, value_name = "SHARE", value_parser = share, allow_hyphen_values = true)]
    ambient: Option<f64>,
}

impl SpaceArguments {
    /// Returns the options that are given, with their values.
    fn options(&self) -> Vec<(&'static str, String)> {
        let vector = |vector: DVec3| vector.to_array().map(|it| it.to_string()).join(",");
        let angles = |angles: [f64; 2]| angles.map(|it| it.to_string()).join(",");
        let all = [
            ("from", self.from.map(angles)),
            ("up", self.up.map(vector)),
            ("look-at", self.look_at.map(vector)),
            ("perspective", self.perspective.map(|it| it.to_string())),
            ("shade", self.shade.map(|it| it.name().into())),
            ("light", self.light.map(angles)),
            ("ambient", self.ambient.map(|it| it.to_string())),
        ];
        let given = all
            .into_iter()
            .filter_map(|(name, value)| Some((name, value?)));
        given.collect()
    }

    /// Refuses the options for a set of the plane.
    pub(super) fn refuse_in_plane(&self, loaded: &Loaded) -> Result<(), Failure> {
        match self.options().first() {
            Some((option, _)) => Err(Failure::Usage(format!(
                "--{option} applies to sets in space, and {} lies in the plane",
                loaded.name
            ))),
            None => Ok(()),
        }
    }

    fn to_options(&self) -> SpaceOptions {
        let (camera, light) = (Camera::default(), Light::default());
        let camera = camera
            .from(self.from.unwrap_or(camera.from))
            .up(self.up)
            .look_at(self.look_at)
            .perspective(self.perspective);
        let light = light
            .from(self.light.unwrap_or(light.from))
            .ambient(self.ambient.unwrap_or(light.ambient));
        SpaceOptions::default()
            .camera(camera)
            .light(light)
            .shade(self.shade.unwrap_or_default())
    }
}

/// Draws a set in space; returns the path, a summary and the number of bytes.
pub(super) fn draw(
    arguments: &Arguments,
    loaded: &Loaded,
) -> Result<(PathBuf, String, u64), Failure> {
    let format = check(arguments, loaded)?;
    let default = arguments.rule.file("", format.name());
    let path = arguments.output.as_ref().unwrap_or(&default);
    let heading = loaded.model.metadata();
    let style = arguments.picture.style(heading);
    let steps = arguments
        .steps
        .or(heading.steps.filter(|_| arguments.detail.is_none()));
    let records_last = format == Format::Usda && style.color_by == ColorBy::LastMap;
    let graph = loaded.model.compile_in_space(records_last);
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
    if format == Format::Usda {
        let Some(steps) = steps else {
            let message = "nested instances have a number of steps: give --steps, of any size";
            return Err(Failure::Usage(message.into()));
        };
        let (scene, bytes) = output::write(path, quiet, |mut out, _| {
            write_usda(&graph, steps, &options, None, &mut out)
                .map_err(|error| output::explain(error, path))
        })?;
        let prims = readable::counted(&scene.symbols.into(), "object");
        let summary = format!(
            "step {steps} of {}, {prims} in nested instances",
            loaded.name
        );
        return Ok((path.clone(), summary, bytes));
    }
    let space = arguments.space.to_options();
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

/// Returns the format of the file, and refuses options and formats that sets in space do not have.
fn check(arguments: &Arguments, loaded: &Loaded) -> Result<Format, Failure> {
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
    if asked != png && asked != Format::Usda {
        let message = format!(
            "{name} lies in space, and is written as .png or .usda, not as .{}",
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
    arguments.picture.refuse_hits()?;
    Ok(asked)
}

/// Parses azimuth and elevation, or the name of a view.
fn from(text: &str) -> Result<[f64; 2], String> {
    if let Some((_, angles)) = Camera::NAMED.iter().find(|(name, _)| *name == text) {
        return Ok(*angles);
    }
    let wrong = || "write azimuth and elevation in degrees, as 30,25, or front, side, top or iso";
    let angles = numbers::<2>(text).ok_or_else(wrong)?;
    if angles.iter().any(|angle| angle.abs() > 1e6) {
        return Err(wrong().into());
    }
    Ok(angles)
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let numbers = text
        .split(',')
        .map(|number| number.trim().parse::<f64>().ok());
    let numbers: Vec<f64> = numbers.collect::<Option<_>>()?;
    let are_finite = numbers.iter().all(|number| number.is_finite());
    numbers.try_into().ok().filter(|_| are_finite)
}

fn point(text: &str) -> Result<DVec3, String> {
    let point = numbers::<3>(text).map(DVec3::from_array);
    point.ok_or_else(|| "a point in space is X,Y,Z".into())
}

fn vector(text: &str) -> Result<DVec3, String> {
    let vector = point(text).map_err(|_| "a vector in space is X,Y,Z")?;
    match vector.try_normalize() {
        Some(_) => Ok(vector),
        None => Err("a vector upwards has a length".into()),
    }
}

fn angle(text: &str) -> Result<f64, String> {
    let angle = text.parse::<f64>().ok();
    let angle = angle.filter(|angle| (1.0..=150.0).contains(angle));
    angle.ok_or_else(|| "an angle of view is a number of degrees from 1 to 150".into())
}

fn share(text: &str) -> Result<f64, String> {
    let share = text.parse::<f64>().ok();
    let share = share.filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| "expected a number from 0 to 1".into())
}
