//! Plan of `kfrac grow`: the file that is written, decided once from the arguments. Options that exclude each
//! other are refused here.

use std::path::Path;

use crate::export;
use crate::render::{self, MeshFormat, Unit, ZoomTarget};
use crate::style::{ColorBy, DensityView, Iteration, Named};

use super::super::{Failure, format};
use super::Arguments;

/// File that is written.
pub(super) enum Plan {
    /// Table of the elements of a step.
    Table(export::TableFormat),
    /// Picture of elements.
    Picture {
        format: render::Format,
        shown: ShownPart,
        /// Whether the size is limited to one that browsers show at once: an SVG for which no depth is given.
        is_light: bool,
    },
    /// Points of random iteration: a PNG of their numbers, or a table of them.
    Chaos(Option<export::TableFormat>),
    /// Points of random iteration in space, as a PLY file.
    Cloud,
    /// Elements in space for other programs.
    Scene(SceneFormat),
}

/// Part of a set that a picture of elements shows.
pub(super) enum ShownPart {
    /// Elements in the window, or all of them.
    Window,
    /// All elements of a step, as nested instances.
    Nested,
    /// Neighbourhood of a point.
    Zoom(ZoomTarget),
}

/// Output format of `grow`: a picture, a table or a scene.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    Picture(render::Format),
    Table(export::TableFormat),
    Scene(SceneFormat),
}

/// Format of elements in space for other programs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum SceneFormat {
    /// Nested instances.
    Nested(render::SceneFormat),
    /// Mesh of the elements of a step.
    Mesh(MeshFormat),
}

impl SceneFormat {
    /// Returns whether the file holds a camera and a light.
    pub(super) fn has_camera(self) -> bool {
        self == Self::Nested(render::SceneFormat::Pov)
    }
}

impl Format {
    /// Polygon File Format: a mesh, or the points of random iteration.
    pub(super) const PLY: Self = Self::Scene(SceneFormat::Mesh(MeshFormat::Ply));
}

impl Named for Format {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("svg", Self::Picture(render::Format::Svg)),
        ("png", Self::Picture(render::Format::Png)),
        ("pdf", Self::Picture(render::Format::Pdf)),
        ("dxf", Self::Picture(render::Format::Dxf)),
        ("hpgl", Self::Picture(render::Format::Hpgl)),
        ("plt", Self::Picture(render::Format::Hpgl)),
        ("gcode", Self::Picture(render::Format::GCode)),
        ("nc", Self::Picture(render::Format::GCode)),
        ("csv", Self::Table(export::TableFormat::Csv)),
        ("json", Self::Table(export::TableFormat::JsonLines)),
        ("jsonl", Self::Table(export::TableFormat::JsonLines)),
        ("ndjson", Self::Table(export::TableFormat::JsonLines)),
        (
            "usda",
            Self::Scene(SceneFormat::Nested(render::SceneFormat::Usda)),
        ),
        (
            "3mf",
            Self::Scene(SceneFormat::Nested(render::SceneFormat::ThreeMf)),
        ),
        (
            "glb",
            Self::Scene(SceneFormat::Nested(render::SceneFormat::Glb)),
        ),
        (
            "pov",
            Self::Scene(SceneFormat::Nested(render::SceneFormat::Pov)),
        ),
        ("stl", Self::Scene(SceneFormat::Mesh(MeshFormat::Stl))),
        ("obj", Self::Scene(SceneFormat::Mesh(MeshFormat::Obj))),
        ("ply", Self::PLY),
    ];
}

/// Message for a zoom of random iteration in the plane.
pub(super) const NO_ZOOM_OF_POINTS: &str =
    "--zoom magnifies elements, and --method chaos draws points: --view shows a part of them";

/// Returns the arguments and the plan for the density of a file: random iteration, unless an option of elements is given, or
/// tones of elements. `None` if the file has no density, or if it does not apply to what is written.
pub(super) fn of_file(arguments: &Arguments, file: DensityView) -> Option<(Arguments, Plan)> {
    if file == DensityView::default() {
        return None;
    }
    let chaos = &arguments.chaos;
    let has_elements = arguments.steps.is_some()
        || arguments.between.is_some()
        || arguments.turn.is_some()
        || arguments.zoom.is_asked();
    let is_of_points = file.method == Some(Iteration::Chaos) && !chaos.is_asked();
    if is_of_points && (has_elements || chaos.method().is_some()) {
        return None;
    }
    let arguments = Arguments {
        chaos: chaos.or(file),
        ..arguments.clone()
    };
    let plan = Plan::of(&arguments).ok()?;
    let is_png = matches!(
        plan,
        Plan::Chaos(None)
            | Plan::Picture {
                format: render::Format::Png,
                ..
            }
    );
    (is_png || chaos.is_asked()).then_some((arguments, plan))
}

impl Plan {
    /// Returns the plan of the arguments; an error if they exclude each other.
    pub(super) fn of(arguments: &Arguments) -> Result<Self, Failure> {
        let plan = Self::chosen(arguments)?;
        arguments.morphed.refuse_beside(&plan)?;
        Ok(plan)
    }

    fn chosen(arguments: &Arguments) -> Result<Self, Failure> {
        let Arguments {
            chaos,
            plot,
            svg,
            zoom,
            picture,
            ..
        } = arguments;
        let (is_chaos, has_detail) = (arguments.draws_points(), arguments.detail.is_some());
        if is_chaos {
            let message = "--detail applies to elements, and --method chaos draws points";
            refuse(has_detail, message)?;
            refuse(zoom.has_centre(), NO_ZOOM_OF_POINTS)?;
            let lines = [
                ("--plot", plot.is_asked()),
                ("--drawn", arguments.drawn.is_some()),
                ("--svg instanced", svg.is_instanced()),
            ];
            let lines = picture.of_lines().into_iter().chain(lines);
            for (option, is_asked) in lines {
                let message = format!("{option} applies to lines, and --method chaos draws points");
                refuse(is_asked, message)?;
            }
        }
        let has_tone = !is_chaos && chaos.tone_of_elements().is_some();
        refuse_beside_tiles(arguments, is_chaos)?;
        let path = arguments
            .output
            .as_deref()
            .filter(|path| *path != Path::new("-"));
        let draws_png = is_chaos || has_tone || arguments.pyramid.is_asked();
        let format = match arguments.format {
            None if draws_png && path.is_none() => Format::Picture(render::Format::Png),
            asked => format::choose(asked, path)?,
        };
        let drawn = match format {
            Format::Picture(format) => Some(format),
            Format::Table(_) | Format::Scene(_) => None,
        };
        let is_table = drawn.is_none();
        let always_plots = drawn.is_some_and(render::Format::is_plot);
        if is_chaos
            && let Some(format) = drawn
            && format != render::Format::Png
        {
            let a = if format == render::Format::Svg {
                "an"
            } else {
                "a"
            };
            return Err(Failure::Usage(format!(
                "--method chaos draws points, too many for {a} {}: write a .png, or a .csv of the points",
                format.name().to_uppercase()
            )));
        }
        if has_tone {
            let one = "--tone shows how many elements cover a pixel: write a .png, without";
            refuse(
                drawn != Some(render::Format::Png),
                "--tone shows how many elements cover a pixel: write a .png",
            )?;
            for (option, is_asked) in [
                ("--plot", plot.is_asked()),
                ("--tiles", arguments.pyramid.is_asked()),
                ("--drawn", arguments.drawn.is_some()),
            ] {
                refuse(is_asked, format!("{one} {option}"))?;
            }
            let by_others = matches!(picture.asked_color_by(), Some(by) if !matches!(by, ColorBy::Hits | ColorBy::None));
            refuse(
                by_others,
                "--tone has one ink, or the palette by hits: --color-by hits",
            )?;
        }
        refuse(
            has_detail && is_table,
            "--detail is a size in pixels, and only pictures have pixels",
        )?;
        refuse(
            plot.is_asked() && is_table,
            "--plot applies to pictures, not to tables and scenes",
        )?;
        for (option, is_asked) in plot.of_plots() {
            let message =
                format!("{option} applies to plots: add --plot, or write a .dxf, .hpgl or .gcode");
            refuse(is_asked && !plot.is_asked() && !always_plots, &message)?;
        }
        refuse(
            plot.lacks_hatch(),
            "--hatch-spacing is the distance of the lines of --hatch: add --hatch 45deg",
        )?;
        for (option, is_asked) in plot.of_machines() {
            let message =
                format!("{option} is a command of machines that read G-code: write a .gcode");
            refuse(is_asked && drawn != Some(render::Format::GCode), &message)?;
        }
        refuse(
            arguments.size.unit != Unit::Pixel && drawn.is_some_and(|format| !format.has_lengths()),
            "a PNG is sized in pixels, not in lengths: --size 2000 is 2000 pixels; other formats support both",
        )?;
        refuse(
            arguments.depth.is_some() && is_table,
            "--depth writes the depths of the pixels of a picture, not of tables and scenes",
        )?;
        if is_chaos {
            refuse(
                matches!(format, Format::Scene(_)) && format != Format::PLY,
                "--method chaos draws points, not elements: write a .png, or a .csv or .ply of the points",
            )?;
            return Ok(match format {
                Format::Table(format) => Self::Chaos(Some(format)),
                Format::Scene(_) => Self::Cloud,
                Format::Picture(_) => Self::Chaos(None),
            });
        }
        let is_nested = svg.is_instanced();
        refuse(
            is_nested && drawn != Some(render::Format::Svg),
            "--svg instanced applies to SVG only: write a .svg",
        )?;
        refuse(
            is_nested && plot.is_asked(),
            "--plot draws every single line, and --svg instanced draws none by itself: give only one of them",
        )?;
        refuse(
            is_nested && has_detail,
            "--detail leaves out small elements, and --svg instanced draws all elements of a step without a \
             larger file: give --steps instead",
        )?;
        refuse(
            is_nested && zoom.is_asked(),
            "--zoom draws the neighbourhood of a point, and --svg instanced a whole step: give only one of them",
        )?;
        refuse(
            arguments.drawn.is_some() && (is_table || is_nested || always_plots),
            "--drawn draws a part of all lines: write a .png, .svg or .pdf of single lines",
        )?;
        refuse(
            zoom.is_asked() && picture.has_view(),
            "--zoom and --at cannot be combined with --view: each selects what is shown",
        )?;
        refuse(
            zoom.is_asked() && arguments.tile.is_asked(),
            "--zoom draws the neighbourhood of a point, and --tile copies of the whole: give only one of them",
        )?;
        refuse(
            picture.has_view()
                && matches!(format, Format::Table(_))
                && !is_chaos
                && !arguments.tile.is_asked(),
            "--view applies to pictures: a table holds all elements of a step",
        )?;
        refuse(
            picture.has_view() && arguments.tile.has_periods(),
            "--repeat and --view each select how much is shown: give only one of them",
        )?;
        refuse(
            zoom.is_asked() && is_table,
            "--zoom applies to pictures only: write a .png, .svg, .pdf or .dxf",
        )?;
        let gives_depth = arguments.steps().is_some()
            || has_detail
            || arguments.growth.given_max_elements().is_some();
        Ok(match format {
            Format::Table(format) => Self::Table(format),
            Format::Scene(format) => Self::Scene(format),
            Format::Picture(format) => Self::Picture {
                format,
                is_light: format == render::Format::Svg && !gives_depth && !is_nested,
                shown: match zoom.target(arguments.turn) {
                    Some(target) => ShownPart::Zoom(target),
                    None if is_nested => ShownPart::Nested,
                    None => ShownPart::Window,
                },
            },
        })
    }

    /// Returns the extension of the file.
    pub(super) fn extension(&self) -> &'static str {
        match self {
            Self::Table(format) | Self::Chaos(Some(format)) => Format::Table(*format).name(),
            Self::Picture { format, .. } => format.name(),
            Self::Chaos(None) => render::Format::Png.name(),
            Self::Scene(format) => Format::Scene(*format).name(),
            Self::Cloud => Format::PLY.name(),
        }
    }
}

/// Refuses options that do not apply to pyramids of tiles, if one is asked for, and sizes that need one otherwise.
fn refuse_beside_tiles(arguments: &Arguments, is_chaos: bool) -> Result<(), Failure> {
    let pyramid = &arguments.pyramid;
    if !pyramid.is_asked() {
        return arguments.size.check_single().map_err(Failure::Usage);
    }
    refuse(
        arguments.growth.held.is_some(),
        "--tiles writes a folder, and not one picture",
    )?;
    refuse(
        is_chaos,
        "--tiles draws elements, and --method chaos draws points",
    )?;
    refuse(
        arguments.output.is_some(),
        "--tiles names the folder of the tiles, and --output a single file: give only one of them",
    )?;
    let png = Format::Picture(render::Format::Png);
    refuse(
        arguments.format.is_some_and(|format| format != png),
        "--tiles writes PNGs: leave out --format",
    )?;
    refuse(
        arguments.open && pyramid.is_part(),
        "--open shows the page of all tiles, and --level and --shard draw some of them",
    )?;
    for (option, is_asked) in [
        ("--plot", arguments.plot.is_asked()),
        ("--svg instanced", arguments.svg.is_instanced()),
        ("--zoom", arguments.zoom.is_asked()),
        ("--drawn", arguments.drawn.is_some()),
        ("--depth", arguments.depth.is_some()),
        ("--watch", arguments.watch),
    ] {
        refuse(
            is_asked,
            format!("{option} applies to single pictures, and not to --tiles"),
        )?;
    }
    Ok(())
}

fn refuse(is_wrong: bool, message: impl Into<String>) -> Result<(), Failure> {
    match is_wrong {
        true => Err(Failure::Usage(message.into())),
        false => Ok(()),
    }
}
