//! `kfrac sheet`: approximants or members of a family, side by side.

mod space;

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use clap::ValueHint;

use super::readable;
use crate::catalogue::Catalogue;
use crate::document::Setting;
use crate::figure::sheet;
use crate::geometry::Homothety;
use crate::graph::Graph;
use crate::grow::{Growth, Progress};
use crate::render::{self, Size};
use crate::style::{Named, Style, View, Width};

use super::camera::SpaceArguments;
use super::growth::GrowthArguments;
use super::labels::labels;
use super::picture::{self, PictureArguments};
use super::rule::{Loaded, Member, RuleArguments};
use super::several::Several;
use super::{Failure, format, help, length, light, number, output, steps, text};

/// Draws approximants side by side, or a family of fractals
///
/// All pictures have the same scale, each with its step and number of elements below. If --set gives a
/// parameter several values, as in angle=10,20,30 or angle=0..90, the sheet shows one step for each value.
/// Several parameters with the same number of values are varied together, beginning with the first value of
/// each. A set in space is shown from every direction of --from, as a PNG.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// Steps to draw, as 0..6 or 0,2,4 [default: 0 to the number of the rule, at most 12 steps]
    ///
    /// Without --steps and --max-elements, an SVG is limited to 50,000 elements and 2 MB: beyond that, it
    /// shows fewer steps, and a note reports it.
    #[arg(long, short, value_name = "STEPS", value_parser = steps::parse_several, allow_hyphen_values = true)]
    steps: Option<Several<u32>>,
    /// Output file, or - for standard output [default: NAME-sheet.svg, or .png in space]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Output format [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<render::Format>())]
    format: Option<render::Format>,
    /// Number of pictures in a row [default: for an aspect ratio of about 4 to 3]
    #[arg(long, value_name = "N", value_parser = number::whole("a number of columns", 1..=u32::MAX))]
    columns: Option<u32>,
    /// Number of values in a range --set NAME=FROM..TO
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = number::whole("a number of values", 2..=1000_u32))]
    samples: u32,
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
}

const MORE: &str = "\
Examples:
  kfrac sheet koch --steps 0..5
      Draws the first approximants of the Koch curve, into koch-sheet.svg
  kfrac sheet pythagoras --set angle=20..70 --samples 6
      Draws the tree for six angles
  kfrac sheet complex-pair --set 's=[0.3,0.2]..[0.6,0.5]' --samples 8 --columns 4
      Draws a fractal for eight values of a complex parameter, both parts at once
  kfrac sheet menger --from front,side,top,iso --steps 4
      Draws a set in space from four directions, into menger-sheet.png
  kfrac sheet pythagoras --steps 1,4,8 --columns 3 --size 400 -o trees.png
      Draws three larger pictures in a row, as a PNG
";

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let start = Instant::now();
    arguments.picture.refuse_hits()?;
    let (growth, rule) = (&arguments.growth, &arguments.rule);
    growth.refuse_seeds()?;
    let family = rule.load_family(catalogue, growth.quiet, arguments.samples)?;
    let grown = |(settings, loaded): Member| (settings, loaded.grown(growth));
    let family: Vec<_> = family.into_iter().map(grown).collect();
    if family
        .first()
        .is_some_and(|(_, first)| first.model.is_in_space())
    {
        return arguments.draw_in_space(&family, start);
    }
    if let Some((_, first)) = family.first() {
        arguments.space.refuse_in_plane(first)?;
        let format = format::choose(arguments.format, arguments.output.as_deref())?;
        return arguments.draw_family(family, format, start);
    }
    let loaded = rule.load(catalogue, growth.quiet)?.grown(growth);
    if loaded.model.is_in_space() {
        return arguments.draw_in_space(&[(Vec::new(), loaded)], start);
    }
    arguments.space.refuse_in_plane(&loaded)?;
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    let steps = match &arguments.steps {
        Some(steps) => steps.clone(),
        None => Several::up_to(steps::choose(None, &loaded)?.min(steps::MAX_CELLS - 1)),
    };
    let last = steps.largest();
    let sheet_to = |step: u32| {
        let fewer = Several::up_to(step);
        let steps = if step < last { &fewer } else { &steps };
        let graph = arguments.compile(&loaded, step)?;
        let which = vec![("steps", steps.to_string())];
        let shown = format!("Steps {steps}");
        let options = arguments.options(&loaded, &shown, which, format, graph.place());
        let cells = steps.as_slice().iter();
        Ok(Sheet {
            graphs: vec![graph],
            cells: cells
                .map(|&step| (format!("step {step}"), 0, step))
                .collect(),
            options,
        })
    };
    let drawn = arguments.draw(&loaded, last, format, sheet_to)?;
    if drawn.step != last && !growth.quiet {
        text::print_message(&light::note(
            &format!(
                "steps {} are drawn instead of {steps}",
                Several::up_to(drawn.step)
            ),
            &format!("--steps {steps} draws them"),
        ));
    }
    let count = readable::counted(&drawn.cells.into(), "approximant");
    arguments.report(&drawn, &format!("{count} of {}", loaded.name), start);
    Ok(())
}

/// Sheet that is ready to be drawn.
struct Sheet {
    graphs: Vec<Graph>,
    /// Name, number of the graph, and step of each picture.
    cells: Vec<(String, usize, u32)>,
    options: render::Options,
}

impl Sheet {
    /// Returns the pictures. `most` replaces the limit on the number of elements of each.
    fn cells<'a>(
        &'a self,
        growth: &'a GrowthArguments,
        most: Option<u64>,
        progress: Option<&'a Progress>,
    ) -> Vec<sheet::Cell<'a>> {
        let cells = self.cells.iter().map(|(name, graph, step)| {
            let growth = growth.to(*step, progress);
            sheet::Cell {
                name: name.clone(),
                graph: &self.graphs[*graph],
                growth: Growth {
                    max_elements: most.unwrap_or(growth.max_elements),
                    ..growth
                },
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
    /// Draws the sheet up to step `last`; an SVG for which no depth of growth is given up to the deepest step
    /// with which browsers show it at once.
    fn draw(
        &self,
        loaded: &Loaded,
        last: u32,
        format: render::Format,
        sheet_to: impl Fn(u32) -> Result<Sheet, Failure>,
    ) -> Result<DrawnSheet, Failure> {
        let Self {
            growth, columns, ..
        } = self;
        let default = self.rule.file("-sheet", format.name());
        let path = self.output.as_ref().unwrap_or(&default);
        let gives_depth = self.steps.is_some() || growth.given_max_elements().is_some();
        let stays_light = format == render::Format::Svg && !gives_depth;
        let ((written, cells, step), bytes) =
            output::write(path, growth.quiet, |out, progress| {
                let explain = |error| growth.explain(error, loaded, path);
                if stays_light {
                    let light = light::first_that_is_light(last as usize + 1, |fewer| {
                        let step = last - u32::try_from(fewer).unwrap_or(0);
                        let sheet = sheet_to(step)?;
                        let drafted = light::draft(|out| {
                            let cells = sheet.cells(growth, Some(light::MAX_ELEMENTS), None);
                            let written = sheet::write(&cells, *columns, &sheet.options, out)?;
                            Ok(((written, cells.len()), written.elements))
                        });
                        Ok(drafted.map_err(explain)?.map(|drafted| (drafted, step)))
                    })?;
                    if let Some((((written, cells), draft), step)) = light {
                        out.write_all(&draft.bytes)
                            .map_err(|error| output::failed(error, path))?;
                        return Ok((written, cells, step));
                    }
                }
                let sheet = sheet_to(last)?;
                for (_, graph, step) in &sheet.cells {
                    growth.check(*step, &sheet.graphs[*graph], loaded)?;
                }
                let cells = sheet.cells(growth, None, progress);
                let written = sheet::write(&cells, *columns, &sheet.options, out);
                Ok((written.map_err(explain)?, cells.len(), last))
            })?;
        Ok(DrawnSheet {
            written,
            cells,
            step,
            path: path.clone(),
            bytes,
        })
    }

    fn report(&self, drawn: &DrawnSheet, content: &str, start: Instant) {
        if !self.growth.quiet {
            let [width, height] = drawn.written.size;
            text::print_message(&format!(
                "{}: {content}, {}, {width} x {height} pixels, {}, {:.2} s",
                output::called(&drawn.path),
                readable::counted(&drawn.written.elements.into(), "element"),
                readable::bytes(drawn.bytes),
                start.elapsed().as_secs_f64(),
            ));
        }
    }

    fn compile(&self, loaded: &Loaded, steps: u32) -> Result<Graph, Failure> {
        loaded.compile_for(steps, self.style(loaded).color_by)
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

    /// Draws one step for every member of a family.
    fn draw_family(
        &self,
        family: Vec<Member>,
        format: render::Format,
        start: Instant,
    ) -> Result<(), Failure> {
        // All pictures have the same scale.
        let place = family[0].1.place()?;
        let within = |(settings, loaded): Member| (settings, loaded.within(place));
        let family: Vec<_> = family.into_iter().map(within).collect();
        let (swept, loaded) = &family[0];
        let last = match self.steps.as_ref().map(Several::as_slice) {
            None => steps::choose(None, loaded)?,
            Some([step]) => *step,
            Some(_) => {
                let message = "a sheet shows several steps or several values, not both";
                return Err(Failure::Usage(message.into()));
            }
        };
        let sweep = |(number, first): (usize, &Setting)| {
            let values = family.iter().map(|(all, _)| all[number].value.to_string());
            let values: Vec<_> = values.collect();
            ("set", format!("{}={}", first.name, values.join(",")))
        };
        let sets: Vec<_> = swept.iter().enumerate().map(sweep).collect();
        let names: Vec<_> = swept.iter().map(|setting| setting.name.as_str()).collect();
        let names = names.join(" and ");
        let sheet_to = |step: u32| {
            let mut which = sets.clone();
            which.push(("steps", step.to_string()));
            let shown = format!("Step {step} for values of {names}");
            let members = family.iter();
            let graphs = members.map(|(_, member)| self.compile(member, step));
            let captions = family.iter().map(|(settings, _)| caption(settings));
            Ok(Sheet {
                graphs: graphs.collect::<Result<_, Failure>>()?,
                cells: captions
                    .zip(0..)
                    .map(|(name, graph)| (name, graph, step))
                    .collect(),
                options: self.options(loaded, &shown, which, format, &place),
            })
        };
        let drawn = self.draw(loaded, last, format, sheet_to)?;
        let step = drawn.step;
        if step != last && !self.growth.quiet {
            text::print_message(&light::note(
                &format!("step {step} is drawn instead of {last}"),
                &format!("--steps {last} draws it"),
            ));
        }
        let count = readable::counted(&drawn.cells.into(), "value");
        self.report(&drawn, &format!("{count} of {names} at step {step}"), start);
        Ok(())
    }

    fn options(
        &self,
        loaded: &Loaded,
        shown: &str,
        which: Vec<(&'static str, String)>,
        format: render::Format,
        place: &Homothety,
    ) -> render::Options {
        let mut options = which;
        options.extend(self.growth.options());
        if format != render::Format::Svg {
            options.push(("format", format.name().into()));
        }
        options.push(("size", self.size.to_string()));
        options.extend(self.columns.map(|columns| ("columns", columns.to_string())));
        options.extend(self.picture.options());
        let view = self.picture.view(loaded.model.metadata()).within(place);
        render::Options {
            format,
            style: self.style(loaded),
            // There are gaps between the pictures of a sheet.
            view: View {
                margin: Some(view.pad()),
                ..view
            },
            size: self.size,
            threads: self.growth.threads(),
            labels: labels(loaded, shown, "sheet", options),
            ..render::Options::default()
        }
        .on_paper()
    }
}

/// Returns the caption of a member of a family.
fn caption(settings: &[Setting]) -> String {
    let all = settings.iter();
    let all = all.map(|setting| format!("{} = {}", setting.name, rounded(setting.value)));
    all.collect::<Vec<_>>().join(", ")
}

/// Formats a value for a caption, to six digits.
fn rounded(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').into()
}
