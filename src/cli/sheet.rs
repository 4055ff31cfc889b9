//! `kfrac sheet`: approximants side by side.

use std::path::PathBuf;
use std::time::Instant;

use clap::ValueHint;

use crate::catalogue::Catalogue;
use crate::document::Setting;
use crate::figure::sheet;
use crate::render::{self, Size};
use crate::style::{Named, Style, Width};
use crate::wording;

use super::growth::GrowthArguments;
use super::labels::labels;
use super::picture::{self, PictureArguments};
use super::rule::{Loaded, Member, RuleArguments};
use super::steps::Several;
use super::{Failure, format, help, length, number, output, steps, text};

/// Draws approximants side by side, or a family of fractals
///
/// All are drawn to one scale, each with its step and its number of elements under it. Where --set
/// gives a parameter several values, as angle=10,20,30 or angle=0..90, it is one step for each of them.
/// Several parameters that are swept go together, the first values first, and have as many values.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    #[command(flatten)]
    rule: RuleArguments,
    /// Which steps, as 0..6 or 0,2,4 [default: 0 to what the rule says, no more than 12]
    #[arg(long, short, value_name = "STEPS", value_parser = steps::parse_several, allow_hyphen_values = true)]
    steps: Option<Several>,
    /// The file to write, or - for standard output [default: NAME-sheet.svg]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// The format [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<render::Format>())]
    format: Option<render::Format>,
    /// How many pictures stand in a row [default: as many as make the sheet 4 to 3]
    #[arg(long, value_name = "N", value_parser = number::whole("a number of columns", 1..=u32::MAX))]
    columns: Option<u32>,
    /// How many values of a range --set NAME=FROM..TO takes
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = number::whole("a number of values", 2..=1000_u32))]
    samples: u32,
    #[command(flatten)]
    growth: GrowthArguments,
    /// The long side of every single picture in pixels, or WIDTHxHEIGHT
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
      Draws a fractal for eight values of a complex number: both of its parts at once
  kfrac sheet pythagoras --steps 1,4,8 --columns 3 --size 400 -o trees.png
      Draws three of them in a row, larger, as pixels
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
        return arguments.draw_family(&family, format, start);
    }
    let loaded = arguments.rule.load(catalogue, arguments.growth.quiet)?;
    let loaded = loaded.grown(&arguments.growth);
    let steps = match &arguments.steps {
        Some(steps) => steps.clone(),
        None => Several::up_to(steps::choose(None, &loaded)?.min(steps::MOST_CELLS - 1)),
    };
    let graph = loaded.compile_for(steps.largest(), arguments.style(&loaded).color_by)?;
    for &step in steps.as_slice() {
        arguments.growth.check(step, &graph, &loaded, None)?;
    }
    let default = arguments.rule.file("-sheet", format.name());
    let path = arguments.output.as_ref().unwrap_or(&default);
    let shown = format!("Steps {steps}");
    let options = arguments.options(&loaded, &shown, vec![("steps", steps.to_string())], format);
    let (written, bytes) = output::write(path, arguments.growth.quiet, |out, progress| {
        let cells = steps.as_slice().iter().map(|&step| sheet::Cell {
            name: format!("step {step}"),
            graph: &graph,
            growth: arguments.growth.to(step, progress),
        });
        let cells: Vec<_> = cells.collect();
        sheet::write(&cells, arguments.columns, &options, out)
            .map_err(|error| arguments.growth.explain(error, &loaded, path))
    })?;
    if !arguments.growth.quiet {
        let [width, height] = written.size;
        text::say(&format!(
            "{}: {} of {}, {}, {width} x {height} pixels, {}, {:.2} s",
            output::called(path),
            wording::counted(&steps.as_slice().len().into(), "approximant"),
            loaded.name,
            wording::counted(&written.elements.into(), "element"),
            wording::bytes(bytes),
            start.elapsed().as_secs_f64(),
        ));
    }
    Ok(())
}

impl Arguments {
    /// The rule's style, with strokes that suit small pictures unless their width is asked for.
    fn style(&self, loaded: &Loaded) -> Style {
        let mut style = self.picture.style(loaded.model.heading());
        if let (Width::Pixels(width), None) = (&mut style.width, self.picture.stroke_width) {
            let (Size::Long(side) | Size::Exactly(side, _)) = self.size;
            *width *= (f64::from(side) / 1024.0).clamp(0.5, 1.0);
        }
        style
    }

    /// Draws one step for every value of a parameter, or of some together.
    fn draw_family(
        &self,
        family: &[Member],
        format: render::Format,
        start: Instant,
    ) -> Result<(), Failure> {
        let (swept, loaded) = &family[0];
        let step = match self.steps.as_ref().map(Several::as_slice) {
            None => steps::choose(None, loaded)?,
            Some([step]) => *step,
            Some(_) => {
                let message = "a sheet shows several steps or several values, not both";
                return Err(Failure::Usage(message.into()));
            }
        };
        let color_by = self.style(loaded).color_by;
        let mut graphs = Vec::new();
        for (_, member) in family {
            let graph = member.compile_for(step, color_by)?;
            self.growth.check(step, &graph, member, None)?;
            graphs.push(graph);
        }
        let default = self.rule.file("-sheet", format.name());
        let path = self.output.as_ref().unwrap_or(&default);
        let sweep = |(number, first): (usize, &Setting)| {
            let values = family.iter().map(|(all, _)| all[number].value.to_string());
            let values: Vec<_> = values.collect();
            ("set", format!("{}={}", first.name, values.join(",")))
        };
        let mut which: Vec<_> = swept.iter().enumerate().map(sweep).collect();
        which.push(("steps", step.to_string()));
        let names: Vec<_> = swept.iter().map(|setting| setting.name.as_str()).collect();
        let names = names.join(" and ");
        let shown = format!("Step {step} for values of {names}");
        let options = self.options(loaded, &shown, which, format);
        let (written, bytes) = output::write(path, self.growth.quiet, |out, progress| {
            let cells = family
                .iter()
                .zip(&graphs)
                .map(|((settings, _), graph)| sheet::Cell {
                    name: caption(settings),
                    graph,
                    growth: self.growth.to(step, progress),
                });
            let cells: Vec<_> = cells.collect();
            sheet::write(&cells, self.columns, &options, out)
                .map_err(|error| self.growth.explain(error, loaded, path))
        })?;
        if !self.growth.quiet {
            let [width, height] = written.size;
            text::say(&format!(
                "{}: {} of {} at step {step}, {}, {width} x {height} pixels, {}, {:.2} s",
                output::called(path),
                wording::counted(&family.len().into(), "value"),
                names,
                wording::counted(&written.elements.into(), "element"),
                wording::bytes(bytes),
                start.elapsed().as_secs_f64(),
            ));
        }
        Ok(())
    }

    fn options(
        &self,
        loaded: &Loaded,
        shown: &str,
        which: Vec<(&'static str, String)>,
        format: render::Format,
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
            view: self.picture.view(loaded.model.heading()),
            size: self.size,
            threads: self.growth.threads(),
            labels: labels(loaded, shown, "sheet", options),
            ..render::Options::default()
        }
    }
}

/// What is under a member of a family.
fn caption(settings: &[Setting]) -> String {
    let all = settings.iter();
    let all = all.map(|setting| format!("{} = {}", setting.name, rounded(setting.value)));
    all.collect::<Vec<_>>().join(", ")
}

/// A value as a caption has it, to six digits.
fn rounded(value: f64) -> String {
    let text = format!("{value:.6}");
    text.trim_end_matches('0').trim_end_matches('.').into()
}
