//! `kfrac grow`: draws a rule as a picture or lists its elements as a table.

mod pictured;

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueHint;

use super::readable;
use crate::catalogue::Catalogue;
use crate::export;
use crate::geometry::Homothety;
use crate::graph::{Graph, Object};
use crate::render::{self, Canvas, RenderError, Size, Unit};
use crate::style::{ColorBy, Named, Style};
use crate::zoom;

use super::chaos::ChaosArguments;
use super::growth::{self, GrowthArguments};
use super::labels::labels;
use super::length::{self, Paper};
use super::picture::{self, PictureArguments};
use super::plot::PlotArguments;
use super::rule::{Loaded, RuleArguments};
use super::svg::{self, SvgArguments};
use super::zoom::ZoomArguments;
use super::{Failure, chaos, format, help, output, steps, text};
use crate::fractal::Goal;
use pictured::{Pictured, Wrote};

/// Grows a rule and draws it, or lists its elements
///
/// Replaces the fertile elements for a number of steps and writes the result, the approximant, as a picture
/// or a table. The output file appears complete or not at all.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// Number of steps: how often fertile elements are replaced [default: from the rule]
    ///
    /// If the rule gives no number, the default is the deepest step up to 12 with no more than 20,000
    /// elements. Without --steps, --detail and --max-elements, an SVG is limited to 50,000 elements and 2 MB:
    /// beyond that, it is drawn with fewer steps or a coarser detail, and a note reports it.
    #[arg(long, short, value_name = "N", value_parser = steps::parse, allow_negative_numbers = true)]
    steps: Option<u32>,
    /// Stops replacing elements that are smaller than this number of pixels
    ///
    /// Without --steps, growth continues until all elements are smaller. L-systems that start anew at every
    /// step are the exception: they are grown by the number of steps in their file. Applies to pictures only.
    #[arg(long, value_name = "PX", value_parser = picture::pixels, allow_negative_numbers = true)]
    detail: Option<f64>,
    /// Output file, or - for standard output [default: NAME.svg]
    ///
    /// An existing file is replaced.
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Output format [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<Format>())]
    format: Option<Format>,
    #[command(flatten)]
    growth: GrowthArguments,
    /// Long side of the picture in pixels or millimetres, or WIDTHxHEIGHT
    ///
    /// The other side follows from the shape. If both sides are given, the shape is fitted into them. A PNG
    /// of more than 17 million pixels is drawn in bands, in less than 300 MB of memory. 200mm and 210mmx297mm
    /// are sizes in millimetres, which PNG does not support. With such a size, and in PDF and DXF always, a
    /// pixel is 1/96 inch.
    #[arg(long, value_name = "SIZE", default_value = "1024", value_parser = length::paper)]
    #[arg(help_heading = "Picture")]
    size: Paper,
    #[command(flatten)]
    plot: PlotArguments,
    #[command(flatten)]
    svg: SvgArguments,
    #[command(flatten)]
    zoom: ZoomArguments,
    #[command(flatten)]
    picture: PictureArguments,
    #[command(flatten)]
    chaos: ChaosArguments,
}

const MORE: &str = "\
Examples:
  kfrac grow pythagoras --steps 8
      Draws the Pythagoras tree after eight steps, into pythagoras.svg
  kfrac grow pythagoras --set angle=30 -o oblique.svg
      Sets a parameter of the rule (kfrac info pythagoras lists them) and names the file
  kfrac grow mine.yaml --stroke teal --stroke-width 2 --background white
      Draws a rule from a file in the given colours
  kfrac grow koch --steps 7 --size 3000 -o koch.png
      Writes a PNG, 3000 pixels wide
  kfrac grow dragon --color-by index --palette sunset
      Colours the elements along the curve
  kfrac grow koch --view 0,0,0.4,0.2 --size 800x400
      Draws a window of the plane
  kfrac grow koch-snowflake --detail 0.5 -o koch.png
      Replaces elements until they are smaller than half a pixel
  kfrac grow koch-snowflake --detail 1 --size 60000 -o wall.png
      Draws a picture that is larger than the memory
  kfrac grow koch --view 0.499999,0.288673,2e-6,2e-6 --detail 1
      Draws a small window; elements outside of it are not grown
  kfrac grow koch --zoom 1e1000 --at '0.1.(2)' -o deep.png
      Magnifies the neighbourhood of a point by a factor of 1e1000; the address of the point is
      a position in the initiator, then positions in the generator, those in brackets repeated
      without end
  kfrac grow random-tree --seed 7
      Draws another random tree of the same rule
  kfrac grow levy --steps 10 --plot --size 200mm --stroke-width 0.3mm
      Draws single strokes for a pen plotter, 200 mm wide, with no line drawn twice
  kfrac grow koch-snowflake --size 100mm -o flake.dxf
      Writes outlines for a cutter; for paper, write a .pdf
  kfrac grow koch --steps 200 --svg instanced -o koch.svg
      Writes 4^200 elements as a small file of nested instances
  kfrac grow koch --steps 4 --format csv -o - | head
      Lists the first elements as CSV
  kfrac grow barnsley-fern --method chaos --points 1M --color-by hits
      Draws an iterated function system by random iteration, into barnsley-fern.png
";

/// Seconds that one core of 2026 takes to draw a pixel in a band, within a factor of about 3.
const SECONDS_A_PIXEL: f64 = 1.3e-8;

/// Output format of `grow`: a picture or a table.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Picture(render::Format),
    Table(export::Format),
}

impl Named for Format {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("svg", Self::Picture(render::Format::Svg)),
        ("png", Self::Picture(render::Format::Png)),
        ("pdf", Self::Picture(render::Format::Pdf)),
        ("dxf", Self::Picture(render::Format::Dxf)),
        ("csv", Self::Table(export::Format::Csv)),
        ("json", Self::Table(export::Format::JsonLines)),
        ("jsonl", Self::Table(export::Format::JsonLines)),
        ("ndjson", Self::Table(export::Format::JsonLines)),
    ];
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let start = Instant::now();
    if arguments.chaos.is_asked() {
        return arguments.play(catalogue, start);
    }
    arguments.chaos.refuse_alone()?;
    arguments.picture.refuse_hits()?;
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    if arguments.detail.is_some() && !matches!(format, Format::Picture(_)) {
        let message = "--detail is a size in pixels, and only pictures have pixels";
        return Err(Failure::Usage(message.into()));
    }
    arguments.refuse_paper(format)?;
    arguments.refuse_instances(format)?;
    let look = arguments.zoom.look(arguments.picture.has_view())?;
    if look.is_some() && !matches!(format, Format::Picture(_)) {
        let message = "--zoom applies to pictures only: write a .png, .svg, .pdf or .dxf";
        return Err(Failure::Usage(message.into()));
    }
    let loaded = arguments.rule.load(catalogue, arguments.growth.quiet)?;
    let loaded = loaded.grown(&arguments.growth);
    let loaded = match look {
        Some(_) => {
            zoom::check_model(&loaded.model).map_err(anyhow::Error::from)?;
            // The zoom finds windows of any size in numbers of sufficient precision, in the coordinates of
            // the file.
            loaded.within(Homothety::IDENTITY)
        }
        None => loaded,
    };
    let goal = match look {
        None if arguments.svg.is_instanced() => Goal::whole(arguments.steps, &loaded)?,
        None => Goal::asked(arguments.steps, arguments.detail, &loaded)?,
        Some(_) => Goal::zoomed(arguments.steps, arguments.detail),
    };
    let color_by = arguments.style(&loaded).color_by;
    let graph = loaded.compile_for(goal.steps(), color_by)?;
    let stays_light = arguments.stays_light(format);
    if !stays_light {
        arguments.check(goal, format, &graph, &loaded)?;
    }
    let default = arguments.rule.file("", format.name());
    let path = arguments.output.as_ref().unwrap_or(&default);
    if look.is_some()
        && !arguments.growth.quiet
        && arguments.is_of_numbers(&arguments.picture.style(loaded.model.metadata()))
    {
        text::print_message(
            "note: drawn in one colour, because elements far from the window are not counted",
        );
    }
    arguments.note_bands(&loaded, goal, format, &graph);
    arguments.note_no_lines(&loaded, format, &graph);
    let ((wrote, drawn), bytes) = output::write(path, arguments.growth.quiet, |out, progress| {
        let wrote = match format {
            Format::Picture(format) => {
                let pictured = Pictured {
                    arguments,
                    loaded: &loaded,
                    format,
                    look: look.as_ref(),
                    path,
                };
                if stays_light {
                    return pictured.draw_light(goal, graph, progress, out);
                }
                pictured.draw(goal, graph, None, progress, out)
            }
            Format::Table(format) => {
                let growth = arguments.growth.to(goal.steps(), progress);
                let threads = arguments.growth.threads();
                export::write(&graph, &growth, format, threads, out)
                    .map(|walked| Wrote::table(walked, growth.steps))
                    .map_err(RenderError::from)
            }
        };
        let wrote = wrote.map_err(|error| arguments.growth.explain(error, &loaded, path))?;
        Ok((wrote, goal))
    })?;
    if !arguments.growth.quiet {
        if let Some(instanced) = &wrote.instanced {
            svg::warn(instanced);
        }
        if let Some(plotted) = &wrote.plotted {
            arguments.plot.note_pens(plotted);
        }
        if let Some(empty) = &wrote.empty {
            text::print_message(&super::zoom::nothing(&loaded.name, empty));
        }
        if drawn != goal {
            goal.note_lighter(drawn);
        }
        text::print_message(&format!(
            "{}: {}, {}, {}, {:.2} s",
            output::called(path),
            drawn.reached(&loaded.name, wrote.steps),
            wrote.summary(arguments.size.unit),
            readable::bytes(bytes),
            start.elapsed().as_secs_f64(),
        ));
    }
    Ok(())
}

impl Arguments {
    /// Returns an error if the format does not support an option: plots, or sizes in millimetres.
    fn refuse_paper(&self, format: Format) -> Result<(), Failure> {
        self.plot.refuse(match format {
            Format::Picture(picture) => Some(picture),
            Format::Table(_) => None,
        })?;
        let message = match format {
            Format::Picture(picture) if self.size.unit != Unit::Pixel && !picture.has_lengths() => {
                "a PNG is sized in pixels, not in millimetres: --size 2000 is 2000 pixels; SVG, PDF \
                 and DXF support both"
            }
            _ => return Ok(()),
        };
        Err(Failure::Usage(message.into()))
    }

    /// Returns the style of the picture. A zoom counts no elements: a rule that colours by index or fractal
    /// is drawn in one colour, unless the command line asks for that `color_by`.
    fn style(&self, loaded: &Loaded) -> Style {
        let style = self
            .picture
            .style_in(loaded.model.metadata(), self.size.unit);
        if self.zoom.is_asked() && self.is_of_numbers(&style) {
            return style.in_one_colour();
        }
        style
    }

    /// Returns whether the file colours by index or fractal, which requires counting elements, and the
    /// command line does not ask for a `color_by`.
    fn is_of_numbers(&self, style: &Style) -> bool {
        let numbers = matches!(style.color_by, ColorBy::Index | ColorBy::Fractal);
        numbers && self.picture.asked_color_by().is_none()
    }

    /// Returns whether the picture is limited to a size that browsers show at once: an SVG for which no depth
    /// of growth is given.
    fn stays_light(&self, format: Format) -> bool {
        let is_asked =
            self.steps.is_some() || self.detail.is_some() || self.growth.says_most_elements();
        format == Format::Picture(render::Format::Svg) && !is_asked && !self.svg.is_instanced()
    }

    /// Returns an error if an option cannot be combined with nested instances.
    fn refuse_instances(&self, format: Format) -> Result<(), Failure> {
        if !self.svg.is_instanced() {
            return Ok(());
        }
        let message = if format != Format::Picture(render::Format::Svg) {
            "--svg instanced applies to SVG only: write a .svg"
        } else if self.plot.is_asked() {
            "--plot draws every single line, and --svg instanced draws none by itself: give only one of them"
        } else if self.detail.is_some() {
            "--detail leaves out small elements, and --svg instanced draws all elements of a step \
             without a larger file: give --steps instead"
        } else if self.zoom.is_asked() {
            "--zoom draws the neighbourhood of a point, and --svg instanced a whole step: give only one of them"
        } else {
            return Ok(());
        };
        Err(Failure::Usage(message.into()))
    }

    /// Returns an error if the step has more elements than are allowed, where the number is known in advance.
    /// With a window, a zoom or a detail, only the visible elements are grown, and the number is not known.
    fn check(
        &self,
        goal: Goal,
        format: Format,
        graph: &Graph,
        loaded: &Loaded,
    ) -> Result<(), Failure> {
        let picture = match format {
            Format::Picture(format) => Some(self.options(loaded, goal, format, graph.place())),
            Format::Table(_) => None,
        };
        let shows_a_part = picture
            .as_ref()
            .is_some_and(|picture| picture.view.window.is_some());
        match goal {
            Goal::Steps(steps, None)
                if !shows_a_part && !self.zoom.is_asked() && !self.svg.is_instanced() =>
            {
                self.growth.check(steps, graph, loaded, picture.as_ref())
            }
            _ => Ok(()),
        }
    }

    /// Prints a note if options for lines are given but no lines are drawn.
    fn note_no_lines(&self, loaded: &Loaded, format: Format, graph: &Graph) {
        let is_filled = |object: &Object| graph.base_elements()[object.base_element].is_closed();
        let mut drawn = graph.objects().iter().filter(|object| object.visible);
        let has_lines = self.plot.is_asked()
            || format == Format::Picture(render::Format::Dxf)
            || self.style(loaded).outlines_polygons()
            || drawn.any(|object| !is_filled(object));
        if self.growth.quiet || !self.picture.asks_lines() || has_lines {
            return;
        }
        text::print_message(&format!(
            "note: {} is drawn as filled shapes, and --stroke-width, --cap and --join apply to lines only; \
             --stroke and --fill together outline the shapes",
            loaded.name
        ));
    }

    /// Prints a note with the estimated time and file size of a picture that is drawn in bands.
    fn note_bands(&self, loaded: &Loaded, goal: Goal, format: Format, graph: &Graph) {
        let Format::Picture(render::Format::Png) = format else {
            return;
        };
        let options = self.options(loaded, goal, render::Format::Png, graph.place());
        let most = match options.size {
            Size::Long(side) => u64::from(side).pow(2),
            Size::Exactly(width, height) => u64::from(width) * u64::from(height),
        };
        if self.growth.quiet || self.plot.is_asked() || most <= options.in_one_piece {
            return;
        }
        let view = &options.view;
        let canvas = match view.window {
            Some(window) => Canvas::of_window(window, view, options.size).ok(),
            None => growth::rough_bounds(graph, goal.steps())
                .and_then(|bounds| Canvas::fit(&bounds, options.size, view.margin).ok()),
        };
        let Some([width, height]) = canvas.map(|canvas| canvas.size()) else {
            return;
        };
        let pixels = f64::from(width) * f64::from(height);
        if u64::from(width) * u64::from(height) > options.in_one_piece {
            let bytes = growth::png_bytes(graph, goal, &options)
                .map_or_else(String::new, |bytes| {
                    format!(", to about {}", readable::rough_bytes(bytes))
                });
            text::print_message(&format!(
                "note: {width} x {height} pixels are drawn in bands, in about {}{bytes}",
                readable::duration(pixels * SECONDS_A_PIXEL)
            ));
        }
    }

    /// Returns the options of the picture, with the labels that describe it in its file. `place` maps the
    /// coordinates of the graph to those of the rule.
    fn options(
        &self,
        loaded: &Loaded,
        goal: Goal,
        format: render::Format,
        place: &Homothety,
    ) -> render::Options {
        let mut options = goal.options();
        options.extend(self.growth.options());
        if format != render::Format::Svg {
            options.push(("format", format.name().into()));
        }
        options.extend(self.plot.options());
        options.extend(self.svg.options());
        options.push(("size", self.size.to_string()));
        options.extend(self.zoom.options());
        options.extend(self.picture.options());
        let Paper { size, unit } = self.size;
        let heading = loaded.model.metadata();
        render::Options {
            format,
            style: self.style(loaded),
            view: self.picture.view_in(heading, unit).within(place),
            size,
            unit,
            plot: self.plot.is_asked(),
            pens: self.plot.pens(&self.picture),
            instanced: self.svg.is_instanced(),
            threads: self.growth.threads(),
            detail: goal.detail_in(unit),
            labels: labels(loaded, &goal.described(), "grow", options),
            ..render::Options::default()
        }
    }
}

impl Arguments {
    /// Draws or lists the points of random iteration.
    fn play(&self, catalogue: &Catalogue, start: Instant) -> Result<(), Failure> {
        if self.detail.is_some() {
            let message = "--detail applies to elements, and --method chaos draws points";
            return Err(Failure::Usage(message.into()));
        }
        self.picture.refuse_lines()?;
        let format = match (self.format, &self.output) {
            (None, None) => Format::Picture(render::Format::Png),
            (asked, output) => match (asked, output.as_deref()) {
                (None, Some(path)) if path == Path::new("-") => {
                    Format::Picture(render::Format::Png)
                }
                (asked, output) => format::choose(asked, output)?,
            },
        };
        if let Format::Picture(picture) = format
            && picture != render::Format::Png
        {
            return Err(Failure::Usage(format!(
                "--method chaos draws points, too many for {} {}: write a .png, or a .csv of the \
                 points",
                if picture == render::Format::Svg {
                    "an"
                } else {
                    "a"
                },
                picture.name().to_uppercase()
            )));
        }
        if self.plot.is_asked() {
            let message = "--plot applies to lines, and --method chaos draws points";
            return Err(Failure::Usage(message.into()));
        }
        if self.svg.is_instanced() {
            let message = "--svg instanced applies to lines, and --method chaos draws points";
            return Err(Failure::Usage(message.into()));
        }
        self.refuse_paper(format)?;
        let loaded = self.rule.load(catalogue, self.growth.quiet)?;
        let game = self.chaos.game(&loaded, self.steps, &self.picture)?;
        let default = self.rule.file("", format.name());
        let path = self.output.as_ref().unwrap_or(&default);
        let size = self.size.size;
        let (summary, bytes) = output::write(path, self.growth.quiet, |out, progress| {
            match format {
                Format::Table(format) => game.list(format, &self.growth, progress, out),
                Format::Picture(_) => game.draw(size, &self.growth, &self.picture, progress, out),
            }
            .map_err(|failure| match failure {
                chaos::Stopped::Failed(failure) => failure,
                chaos::Stopped::Render(error) => self.growth.explain(error, &loaded, path),
            })
        })?;
        if !self.growth.quiet {
            text::print_message(&format!(
                "{}: {summary}, {}, {:.2} s",
                output::called(path),
                readable::bytes(bytes),
                start.elapsed().as_secs_f64(),
            ));
        }
        Ok(())
    }
}
