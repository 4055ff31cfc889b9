//! `kfrac sheet`: approximants side by side.

use std::path::PathBuf;
use std::time::Instant;

use clap::ValueHint;

use crate::catalogue::Catalogue;
use crate::figure::sheet;
use crate::render::{self, Size};
use crate::style::{Named, Style, Width};
use crate::wording;

use super::growth::GrowthArguments;
use super::labels::labels;
use super::picture::{self, PictureArguments};
use super::rule::{Loaded, RuleArguments};
use super::steps::Several;
use super::{Failure, format, help, output, steps, text};

/// Draws approximants side by side
///
/// All are drawn to one scale, each with its step and its number of elements under it.
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
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    columns: Option<u32>,
    #[command(flatten)]
    growth: GrowthArguments,
    /// The long side of every single picture in pixels, or WIDTHxHEIGHT
    #[arg(long, value_name = "SIZE", default_value = "256", value_parser = picture::size)]
    #[arg(help_heading = "Picture")]
    size: Size,
    #[command(flatten)]
    picture: PictureArguments,
}

const MORE: &str = "\
Examples:
  kfrac sheet koch --steps 0..5
      Draws the first approximants of the Koch curve, into koch-sheet.svg
  kfrac sheet pythagoras --steps 1,4,8 --columns 3 --size 400 -o trees.png
      Draws three of them in a row, larger, as pixels
";

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let start = Instant::now();
    arguments.picture.refuse_hits()?;
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    let loaded = arguments.rule.load(catalogue, arguments.growth.quiet)?;
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
    let options = arguments.options(&loaded, &steps, format);
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

    fn options(&self, loaded: &Loaded, steps: &Several, format: render::Format) -> render::Options {
        let mut options = vec![("steps", steps.to_string())];
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
            detail: None,
            labels: labels(loaded, &format!("Steps {steps}"), "sheet", options),
        }
    }
}
