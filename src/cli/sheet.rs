//! `kfrac sheet`: approximants or members of a family, side by side.

mod chaos;
mod contents;
mod space;

use std::cell::Cell;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueHint;

use super::readable;
use crate::catalogue::Catalogue;
use crate::figure::sheet::{self, Arrangement, CellView};
use crate::fractal::Goal;
use crate::graph::Graph;
use crate::grow::{Growth, Progress};
use crate::render::{self, RenderError, Size};
use crate::style::{Named, Style, View, Width};

use contents::{Contents, Individual};

use super::camera::SpaceArguments;
use super::chaos::ChaosArguments;
use super::growth::GrowthArguments;
use super::labels::labels_of_rules;
use super::picture::{self, PictureArguments};
use super::rule::{Loaded, RuleArguments};
use super::steps::Several;
use super::{Failure, format, help, length, light, number, output, steps, text};

/// Draws approximants, individuals, rules or a family of fractals side by side
///
/// All pictures have the same scale, each with its step and number of elements below. If --set gives a
/// parameter several values, as in angle=10,20,30 or angle=0..90, the sheet shows one step for each value; if
/// --seed gives several seeds, as in 1..12, one individual of a random rule for each; and for several rules, one
/// picture of each. Several parameters with the same number of values are varied together, beginning with the first
/// value of each, unless --grid is given. If more than one of rules, values, seeds and --steps are several, each row has
/// the pictures of the last of them. A set in space is shown from every direction of --from, as a PNG.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// Further rules, whose pictures follow
    ///
    /// --set, --omit and exchanged components apply to every rule.
    #[arg(value_name = "RULES")]
    further: Vec<PathBuf>,
    /// Steps to draw, as 0..6 or 0,2,4 [default: 0 to the number of the rule, at most 12 steps]
    ///
    /// Without --steps and --max-elements, an SVG is limited to 50,000 elements and 2 MB: beyond that, it
    /// shows fewer steps, and a note reports it.
    #[arg(long, short, value_name = "STEPS", value_parser = steps::parse_several, allow_hyphen_values = true)]
    steps: Option<Several>,
    /// Stops replacing elements that are smaller than this number of pixels
    ///
    /// Without --steps, every picture is grown until all its elements are smaller; L-systems that start anew at every step are
    /// grown by the number of steps in their file.
    #[arg(long, value_name = "PX", value_parser = picture::pixels, allow_negative_numbers = true)]
    detail: Option<f64>,
    /// Output file, or - for standard output [default: NAME-sheet.svg, sheet.svg for several rules, or .png in space]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Output format [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<render::Format>())]
    format: Option<render::Format>,
    /// Number of pictures in a row [default: that of a grid, or for an aspect ratio of about 4 to 3]
    #[arg(long, value_name = "N", value_parser = number::whole("a number of columns", 1..=u32::MAX))]
    columns: Option<u32>,
    /// Number of values in a range --set NAME=FROM..TO
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = number::whole("a number of values", 2..=1000_u32))]
    samples: u32,
    /// Varies parameters with several values independently: a column for each value of the first, a row for each value
    /// of the second
    #[arg(long)]
    grid: bool,
    /// Part of the plane that is shown: what all pictures need, or each picture its own [default: all; each for several
    /// rules]
    #[arg(long, value_parser = picture::named::<CellView>())]
    fit: Option<CellView>,
    #[command(flatten)]
    growth: GrowthArguments,
    /// Long side of every single picture in pixels, or WIDTHxHEIGHT
    #[arg(long, value_name = "SIZE", default_value = "256", value_parser = length::size)]
    #[arg(help_heading = "Picture")]
    size: Size,
    #[command(flatten)]
    picture: PictureArguments,
    #[command(flatten)]
    space: SpaceArguments,
    #[command(flatten)]
    chaos: ChaosArguments,
}

const MORE: &str = "\
Examples:
  kfrac sheet koch --steps 0..5
      Draws the first approximants of the Koch curve, into koch-sheet.svg
  kfrac sheet pythagoras --set angle=20..70 --samples 6
      Draws the tree for six angles
  kfrac sheet stochastic-plant --seed 1..12
      Draws twelve individuals of a random plant
  kfrac sheet koch dragon pythagoras
      Draws three rules, each fitted to its picture, into sheet.svg
  kfrac sheet binary-tree --set ratio=0.5..0.7 --detail 1 -o trees.png
      Draws eight trees, each down to a pixel
  kfrac sheet binary-tree --set angle=20..80 --set ratio=0.4..0.7 --samples 4 --grid
      Draws a grid of two parameters
  kfrac sheet complex-pair --set 's=[0.3,0.2]..[0.6,0.5]' --samples 8 --columns 4
      Draws a fractal for eight values of a complex parameter, both parts at once
  kfrac sheet barnsley-fern maple-leaf-chaos --method chaos --points 1M
      Draws two systems by random iteration, as a PNG
  kfrac sheet menger --from front,side,top,iso --steps 4
      Draws a set in space from four directions, into menger-sheet.png
  kfrac sheet pythagoras --steps 1,4,8 --columns 3 --size 400 -o trees.png
      Draws three larger pictures in a row, as a PNG
";

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let start = Instant::now();
    arguments.chaos.check(&arguments.picture, false)?;
    let contents = Contents::load(arguments, catalogue)?;
    if arguments.chaos.is_asked() {
        return arguments.draw_points(&contents, start);
    }
    if contents.first().model.is_in_space() {
        return arguments.draw_in_space(contents, start);
    }
    arguments.space.refuse_in_plane(contents.first())?;
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    let contents = contents.in_plane(arguments)?;
    let drawn = arguments.draw(&contents, format)?;
    if !arguments.growth.quiet {
        let note = contents.note_of_lighter(drawn.step);
        note.iter().for_each(|note| text::print_message(note));
    }
    arguments.report_drawn(&drawn, &contents.counted(&drawn), start);
    Ok(())
}

/// Picture of a sheet that is ready to be drawn.
struct SheetCell {
    name: String,
    /// Number of the individual.
    number: usize,
    goal: Goal,
    /// Number of steps, or the limit of those that a detail takes.
    steps: u32,
}

/// Individual with its graph, style and view.
type DrawnIndividual<'a> = (&'a Individual, Graph, Style, View);

/// Sheet that is ready to be drawn.
struct Sheet<'a> {
    drawn: Vec<DrawnIndividual<'a>>,
    cells: Vec<SheetCell>,
    options: render::Options,
}

impl Sheet<'_> {
    /// Returns the pictures. `most` replaces the limit on the number of elements.
    fn cells<'a>(
        &'a self,
        growth: &'a GrowthArguments,
        most: Option<u64>,
        progress: Option<&'a Progress>,
    ) -> Vec<sheet::Cell<'a>> {
        let cells = self.cells.iter().map(|cell| {
            let growth = growth.to(cell.steps, progress);
            let (individual, graph, style, view) = &self.drawn[cell.number];
            sheet::Cell {
                name: cell.name.clone(),
                graph,
                growth: Growth {
                    seed: individual.seed,
                    max_elements: most.unwrap_or(growth.max_elements),
                    ..growth
                },
                style,
                view: *view,
                detail: cell.goal.detail(),
            }
        });
        cells.collect()
    }
}

/// Sheet that has been drawn.
struct DrawnSheet {
    written: sheet::SheetSummary,
    cells: usize,
    /// Largest step.
    step: u32,
    path: PathBuf,
    bytes: u64,
}

impl Arguments {
    /// Returns all rules, each with the settings that apply to all.
    fn rules(&self) -> Vec<RuleArguments> {
        let further = self.further.iter().map(|rule| RuleArguments {
            rule: rule.clone(),
            ..self.rule.clone()
        });
        [self.rule.clone()].into_iter().chain(further).collect()
    }

    /// Returns the format of a sheet of pixels: PNG, unless another is asked for.
    fn format_of_pixels(&self) -> Result<render::Format, Failure> {
        let path = self.output.as_deref();
        match (self.format, path.filter(|path| *path != Path::new("-"))) {
            (None, None) => Ok(render::Format::Png),
            (asked, path) => format::choose(asked, path),
        }
    }

    /// Returns the output file.
    fn path(&self, extension: &str) -> PathBuf {
        let default = || match self.further.is_empty() {
            true => self.rule.file("-sheet", extension),
            false => Path::new("sheet").with_extension(extension),
        };
        self.output.clone().unwrap_or_else(default)
    }

    /// Draws the sheet; an SVG for which no depth of growth is given up to the deepest step with which browsers show
    /// it at once.
    fn draw(&self, contents: &Contents, format: render::Format) -> Result<DrawnSheet, Failure> {
        let growth = &self.growth;
        let path = self.path(format.name());
        let gives_depth =
            self.steps.is_some() || self.detail.is_some() || growth.given_max_elements().is_some();
        let stays_light = format == render::Format::Svg && !gives_depth;
        let last = contents.last_step();
        let arrangement = Arrangement {
            columns: self.columns.or(contents.columns(1)),
            fit: contents.fit,
        };
        let ((written, cells, step), bytes) =
            output::write(&path, growth.quiet, |out, progress| {
                // Number of the picture that cannot be drawn.
                let wrong = Cell::new(None);
                let explain = |sheet: &Sheet<'_>, error: RenderError| {
                    let number = sheet.cells[wrong.get().unwrap_or(0)].number;
                    growth.explain(error, &sheet.drawn[number].0.loaded, &path)
                };
                let write =
                    |cells: &[sheet::Cell<'_>], options: &render::Options, out: &mut dyn Write| {
                        sheet::write(cells, arrangement, options, &mut { out }).map_err(|error| {
                            wrong.set(error.cell);
                            error.error
                        })
                    };
                if stays_light {
                    let light = light::first_that_is_light(last as usize + 1, |fewer| {
                        let step = last - u32::try_from(fewer).unwrap_or(0);
                        let Some(sheet) = self.sheet(contents, step, format, true)? else {
                            return Ok(None);
                        };
                        let drafted = light::draft(|out| {
                            let cells = sheet.cells(growth, Some(light::MAX_ELEMENTS), None);
                            let written = write(&cells, &sheet.options, out)?;
                            Ok(((written, cells.len()), written.elements))
                        });
                        let drafted = drafted.map_err(|error| explain(&sheet, error))?;
                        Ok(drafted.map(|drafted| (drafted, step)))
                    })?;
                    if let Some((((written, cells), draft), step)) = light {
                        out.write_all(&draft.bytes)
                            .map_err(|error| output::failed(error, &path))?;
                        return Ok((written, cells, step));
                    }
                }
                let Some(sheet) = self.sheet(contents, last, format, false)? else {
                    unreachable!("a sheet that need not be light has no other limit");
                };
                let cells = sheet.cells(growth, None, progress);
                let written = write(&cells, &sheet.options, out);
                let written = written.map_err(|error| explain(&sheet, error))?;
                Ok((written, cells.len(), last))
            })?;
        Ok(DrawnSheet {
            written,
            cells,
            step,
            path,
            bytes,
        })
    }

    /// Returns the sheet up to a step; `None` if it is certain not to be light, where it must be. An error is returned if
    /// the pictures have too many elements together, as far as their numbers are known in advance.
    fn sheet<'a>(
        &self,
        contents: &'a Contents,
        last: u32,
        format: render::Format,
        is_light: bool,
    ) -> Result<Option<Sheet<'a>>, Failure> {
        let most = match is_light {
            true => light::MAX_ELEMENTS,
            false => self.growth.max_elements(),
        };
        let (mut drawn, mut cells, mut elements) = (Vec::new(), Vec::new(), 0_u64);
        for (number, individual) in contents.individuals.iter().enumerate() {
            let loaded = &individual.loaded;
            let style = self.style(loaded);
            let goals = individual.goals_up_to(last, self.detail);
            let steps = goals.iter().map(|goal| goal.steps()).max().unwrap_or(0);
            let mut graph = loaded.compile_for(steps, style.color_by)?;
            let view = self.view(loaded).within(graph.place());
            let style = style.within(graph.place());
            for goal in goals {
                let cell = |steps| SheetCell {
                    name: contents.caption(individual, goal),
                    number,
                    goal,
                    steps,
                };
                let Goal::Steps(step, detail) = goal else {
                    let common = drawn
                        .first()
                        .map_or(view, |first: &DrawnIndividual<'_>| first.3);
                    let steps = self.steps_to(
                        goal,
                        individual,
                        &style,
                        match contents.fit {
                            CellView::All => common,
                            _ => view,
                        },
                    )?;
                    graph = loaded.compile_for(steps, style.color_by)?;
                    cells.push(cell(steps));
                    continue;
                };
                if detail.is_none() {
                    let checked = graph.check_size(step, most - elements);
                    if checked.is_err() && is_light {
                        return Ok(None);
                    }
                    self.growth.check(step, &graph, loaded)?;
                    let checked = checked.map_err(|_| {
                        let most = readable::counted(&most.into(), "element");
                        anyhow::anyhow!(
                            "the pictures have more than {most} together; --max-elements allows more, and smaller \
                             --steps need fewer"
                        )
                    })?;
                    elements += checked.unwrap_or(0);
                }
                cells.push(cell(step));
            }
            drawn.push((individual, graph, style, view));
        }
        let options = self.options(contents, last, format, &drawn);
        Ok(Some(Sheet {
            drawn,
            cells,
            options,
        }))
    }

    /// Returns the number of steps with which a picture reaches a detail in a view, or more.
    fn steps_to(
        &self,
        goal: Goal,
        individual: &Individual,
        style: &Style,
        view: View,
    ) -> Result<u32, Failure> {
        let options = render::Options {
            style: style.clone(),
            view,
            size: self.size,
            detail: goal.detail(),
            threads: self.growth.threads(),
            ..render::Options::default()
        };
        let loaded = &individual.loaded;
        let reached = goal.reach(
            loaded.compile_for(goal.steps(), style.color_by)?,
            |steps| loaded.graph(steps),
            |graph, steps| {
                let growth = Growth {
                    seed: individual.seed,
                    ..self.growth.to(steps, None)
                };
                render::survey(graph, &growth, &options).map(|_| steps)
            },
        );
        reached.map_err(|error| self.growth.explain(error, loaded, &self.path("svg")))
    }

    fn report_drawn(&self, drawn: &DrawnSheet, content: &str, start: Instant) {
        let elements = readable::counted(&drawn.written.elements.into(), "element");
        let (content, size) = (format!("{content}, {elements}"), drawn.written.size);
        self.report(&drawn.path, &content, size, drawn.bytes, start);
    }

    /// Prints what has been written, unless messages are suppressed.
    fn report(
        &self,
        path: &Path,
        content: &str,
        [width, height]: [u32; 2],
        bytes: u64,
        start: Instant,
    ) {
        if !self.growth.quiet {
            text::print_message(&format!(
                "{}: {content}, {width} x {height} pixels, {}, {:.2} s",
                output::called(path),
                readable::bytes(bytes),
                start.elapsed().as_secs_f64(),
            ));
        }
    }

    /// Returns the style of the rule, with strokes that suit small pictures unless their width is given.
    fn style(&self, loaded: &Loaded) -> Style {
        let mut style = self.picture.style(loaded.model.metadata());
        if let (Width::Pixels(width), None) = (&mut style.width, self.picture.stroke_width) {
            let (Size::Long(side) | Size::Exactly(side, _)) = self.size;
            *width *= (f64::from(side) / 1024.0).clamp(0.5, 1.0);
        }
        style
    }

    /// Returns the view of the rule. There are gaps between the pictures of a sheet.
    fn view(&self, loaded: &Loaded) -> View {
        let view = self.picture.view(loaded.model.metadata());
        View {
            margin: Some(view.pad()),
            ..view
        }
    }

    /// Returns the options of the whole sheet, in which the first rule has its style but for backgrounds that differ.
    fn options(
        &self,
        contents: &Contents,
        last: u32,
        format: render::Format,
        drawn: &[DrawnIndividual<'_>],
    ) -> render::Options {
        let mut options = contents.options(contents.steps_up_to(last).as_ref());
        options.extend(self.growth.options());
        if format != render::Format::Svg {
            options.push(("format", format.name().into()));
        }
        options.extend(self.options_of_sheet());
        let (_, _, first, view) = &drawn[0];
        let mut style = first.clone();
        if drawn
            .iter()
            .any(|(_, _, it, _)| it.background != style.background)
        {
            style.background = None;
        }
        render::Options {
            format,
            style,
            view: *view,
            size: self.size,
            threads: self.growth.threads(),
            labels: labels_of_rules(&contents.rules(), &contents.shown(last), "sheet", options),
            ..render::Options::default()
        }
        .on_paper()
    }

    /// Returns the options of the arrangement and of pictures that are given, with their values.
    fn options_of_sheet(&self) -> Vec<(&'static str, String)> {
        let mut options = vec![("size", self.size.to_string())];
        options.extend(self.detail.map(|detail| ("detail", detail.to_string())));
        options.extend(self.columns.map(|columns| ("columns", columns.to_string())));
        options.extend(self.grid.then(|| ("grid", String::new())));
        options.extend(self.fit.map(|fit| ("fit", fit.name().into())));
        options.extend(self.picture.options());
        options
    }
}
