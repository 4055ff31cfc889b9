//! `kfrac sheet`: approximants or members of a family, side by side.

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
use crate::style::{Named, Style, Width};

use super::growth::GrowthArguments;
use super::labels::labels;
use super::picture::{self, PictureArguments};
use super::rule::{Loaded, Member, RuleArguments};
use super::steps::Several;
use super::{Failure, format, help, length, light, number, output, steps, text};

/// Draws approximants side by side, or a family of fractals
///
/// All pictures have the same scale, each with its step and number of elements below. If --set gives a
/// parameter several values, as in angle=10,20,30 or angle=0..90, the sheet shows one step for each value.
/// Several parameters with the same number of values are varied together, beginning with the first value of
/// each.
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
    steps: Option<Several>,
    /// Output file, or - for standard output [default: NAME-sheet.svg]
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
}

const MORE: &str = "\
Examples:
  kfrac sheet koch --steps 0..5
      Draws the first approximants of the Koch curve, into koch-sheet.svg
  kfrac sheet pythagoras --set angle=20..70 --samples 6
      Draws the tree for six angles
  kfrac sheet complex-pair --set 's=[0.3,0.2]..[0.6,0.5]' --samples 8 --columns 4
      Draws a fractal for eight values of a complex parameter, both parts at once
  kfrac sheet pythagoras --steps 1,4,8 --columns 3 --size 400 -o trees.png
      Draws three larger pictures in a row, as a PNG
";

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let start = Instant::now();
    arguments.picture.refuse_hits()?;
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    let family =
        arguments
            .rule
            .load_family(catalogue, arguments.growth.quiet, arguments.samples)?;
    if !family.is_empty() {
        let grown = |(settings, loaded): Member| (settings, loaded.grown(&arguments.growth));
        let family: Vec<_> = family.into_iter().map(grown).collect();
        return arguments.draw_family(family, format, start);
    }
    let loaded = arguments.rule.load(catalogue, arguments.growth.quiet)?;
    let loaded = loaded.grown(&arguments.growth);
    let steps = match &arguments.steps {
        Some(steps) => steps.clone(),
        None => Several::up_to(steps::choose(None, &loaded)?.min(steps::MOST_CELLS - 1)),
    };
    let default = arguments.rule.file("-sheet", format.name());
    let path = arguments.output.as_ref().unwrap_or(&default);
    let stays_light = arguments.stays_light(format);
    let ((written, drawn), bytes) =
        output::write(path, arguments.growth.quiet, |out, progress| {
            let explain = |error| arguments.growth.explain(error, &loaded, path);
            if stays_light {
                let last = steps.largest();
                let fewer = last as usize + 1;
                let light = light::first_that_is_light(fewer, |fewer| {
                    let fewer = u32::try_from(fewer).unwrap_or(0);
                    let steps = Several::up_to(last - fewer);
                    let graph = arguments.compile(&loaded, steps.largest())?;
                    let most = Some(light::MOST_ELEMENTS);
                    let drafted = light::draft(|out| {
                        let options = arguments.of_steps(&loaded, &steps, format, graph.place());
                        let cells = arguments.cells(&graph, &steps, most, None);
                        let written = sheet::write(&cells, arguments.columns, &options, out)?;
                        Ok((written, written.elements))
                    });
                    Ok(drafted.map_err(explain)?.map(|drafted| (drafted, steps)))
                })?;
                if let Some(((written, draft), steps)) = light {
                    out.write_all(&draft.bytes)
                        .map_err(|error| output::failed(error, path))?;
                    return Ok((written, steps));
                }
            }
            let graph = arguments.compile(&loaded, steps.largest())?;
            for &step in steps.as_slice() {
                arguments.growth.check(step, &graph, &loaded, None)?;
            }
            let options = arguments.of_steps(&loaded, &steps, format, graph.place());
            let cells = arguments.cells(&graph, &steps, None, progress);
            let written = sheet::write(&cells, arguments.columns, &options, out);
            Ok((written.map_err(explain)?, steps.clone()))
        })?;
    if !arguments.growth.quiet && drawn != steps {
        light::tell(
            &format!("steps {drawn} are drawn instead of {steps}"),
            &format!("--steps {steps} draws them"),
        );
    }
    if !arguments.growth.quiet {
        let [width, height] = written.size;
        text::print_message(&format!(
            "{}: {} of {}, {}, {width} x {height} pixels, {}, {:.2} s",
            output::called(path),
            readable::counted(&drawn.as_slice().len().into(), "approximant"),
            loaded.name,
            readable::counted(&written.elements.into(), "element"),
            readable::bytes(bytes),
            start.elapsed().as_secs_f64(),
        ));
    }
    Ok(())
}

impl Arguments {
    /// Returns whether the sheet is limited to a size that browsers show at once: an SVG for which no depth
    /// of growth is given.
    fn stays_light(&self, format: render::Format) -> bool {
        let is_asked = self.steps.is_some() || self.growth.says_most_elements();
        format == render::Format::Svg && !is_asked
    }

    fn compile(&self, loaded: &Loaded, steps: u32) -> Result<Graph, Failure> {
        loaded.compile_for(steps, self.style(loaded).color_by)
    }

    /// Returns the pictures of some steps. `most` replaces the limit on the number of elements of each.
    fn cells<'a>(
        &self,
        graph: &'a Graph,
        steps: &Several,
        most: Option<u64>,
        progress: Option<&'a Progress>,
    ) -> Vec<sheet::Cell<'a>> {
        let cells = steps.as_slice().iter().map(|&step| {
            let growth = self.growth.to(step, progress);
            sheet::Cell {
                name: format!("step {step}"),
                graph,
                growth: Growth {
                    most_elements: most.unwrap_or(growth.most_elements),
                    ..growth
                },
            }
        });
        cells.collect()
    }

    /// Returns the options of a sheet of steps.
    fn of_steps(
        &self,
        loaded: &Loaded,
        steps: &Several,
        format: render::Format,
        place: &Homothety,
    ) -> render::Options {
        let which = vec![("steps", steps.to_string())];
        self.options(loaded, &format!("Steps {steps}"), which, format, place)
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
        let step = match self.steps.as_ref().map(Several::as_slice) {
            None => steps::choose(None, loaded)?,
            Some([step]) => *step,
            Some(_) => {
                let message = "a sheet shows several steps or several values, not both";
                return Err(Failure::Usage(message.into()));
            }
        };
        let default = self.rule.file("-sheet", format.name());
        let path = self.output.as_ref().unwrap_or(&default);
        let sweep = |(number, first): (usize, &Setting)| {
            let values = family.iter().map(|(all, _)| all[number].value.to_string());
            let values: Vec<_> = values.collect();
            ("set", format!("{}={}", first.name, values.join(",")))
        };
        let sets: Vec<_> = swept.iter().enumerate().map(sweep).collect();
        let names: Vec<_> = swept.iter().map(|setting| setting.name.as_str()).collect();
        let names = names.join(" and ");
        let options = |step: u32| {
            let mut which = sets.clone();
            which.push(("steps", step.to_string()));
            let shown = format!("Step {step} for values of {names}");
            self.options(loaded, &shown, which, format, &place)
        };
        let compile = |step: u32| -> Result<Vec<Graph>, Failure> {
            let members = family.iter();
            let graphs = members.map(|(_, member)| self.compile(member, step));
            graphs.collect()
        };
        let ((written, drawn), bytes) = output::write(path, self.growth.quiet, |out, progress| {
            let explain = |error| self.growth.explain(error, loaded, path);
            if self.stays_light(format) {
                let light = light::first_that_is_light(step as usize + 1, |fewer| {
                    let step = step - u32::try_from(fewer).unwrap_or(0);
                    let graphs = compile(step)?;
                    let most = Some(light::MOST_ELEMENTS);
                    let drafted = light::draft(|out| {
                        let cells = self.members(&family, &graphs, step, most, None);
                        let written = sheet::write(&cells, self.columns, &options(step), out)?;
                        Ok((written, written.elements))
                    });
                    Ok(drafted.map_err(explain)?.map(|drafted| (drafted, step)))
                })?;
                if let Some(((written, draft), step)) = light {
                    out.write_all(&draft.bytes)
                        .map_err(|error| output::failed(error, path))?;
                    return Ok((written, step));
                }
            }
            let graphs = compile(step)?;
            for ((_, member), graph) in family.iter().zip(&graphs) {
                self.growth.check(step, graph, member, None)?;
            }
            let cells = self.members(&family, &graphs, step, None, progress);
            let written = sheet::write(&cells, self.columns, &options(step), out);
            Ok((written.map_err(explain)?, step))
        })?;
        if !self.growth.quiet && drawn != step {
            light::tell(
                &format!("step {drawn} is drawn instead of {step}"),
                &format!("--steps {step} draws it"),
            );
        }
        if !self.growth.quiet {
            let [width, height] = written.size;
            text::print_message(&format!(
                "{}: {} of {} at step {drawn}, {}, {width} x {height} pixels, {}, {:.2} s",
                output::called(path),
                readable::counted(&family.len().into(), "value"),
                names,
                readable::counted(&written.elements.into(), "element"),
                readable::bytes(bytes),
                start.elapsed().as_secs_f64(),
            ));
        }
        Ok(())
    }

    /// Returns the pictures of the members of a family. `most` replaces the limit on the number of elements
    /// of each.
    fn members<'a>(
        &self,
        family: &[Member],
        graphs: &'a [Graph],
        step: u32,
        most: Option<u64>,
        progress: Option<&'a Progress>,
    ) -> Vec<sheet::Cell<'a>> {
        let members = family.iter().zip(graphs).map(|((settings, _), graph)| {
            let growth = self.growth.to(step, progress);
            sheet::Cell {
                name: caption(settings),
                graph,
                growth: Growth {
                    most_elements: most.unwrap_or(growth.most_elements),
                    ..growth
                },
            }
        });
        members.collect()
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
        render::Options {
            format,
            style: self.style(loaded),
            view: self.picture.view(loaded.model.metadata()).within(place),
            size: self.size,
            threads: self.growth.threads(),
            labels: labels(loaded, shown, "sheet", options),
            ..render::Options::default()
        }
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
