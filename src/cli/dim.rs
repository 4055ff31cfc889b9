//! `kfrac dim`: the dimension of a rule, a picture or a table of points.

mod input;
mod report;
mod series;

use std::num::NonZero;
use std::path::{Path, PathBuf};

use clap::ValueHint;
use clap::builder::PossibleValue;

use crate::catalogue::Catalogue;
use crate::figure::dimension;
use crate::measure::{BoxCounting, Generalised, Grid, Lacunarity, exact};
use crate::parallel::all_cores;
use crate::render::{self, Labels, RenderError};

pub(in crate::cli) use self::report::hausdorff;
use self::series::Series;
use super::family::{Assignment, assignment};
use super::rule::RuleArguments;
use super::{Failure, format, growth, help, number, output, text};

/// Measures the dimension of a rule's limit set, a picture or a table of points
///
/// Boxes are counted at many sizes, on grids that are moved and turned, and the least cover is kept.
/// The dimension is the slope of the logarithms, with its standard error and its evidence; where local
/// slopes drift, this is said, and the estimate goes on with them. Of a picture, the mean counts over all
/// grids tell the slope, with the width of a pen and the boxes of rims allowed for. Of a rule,
/// the limit set of what stays fertile is measured, straight from the rule: boxes that are too many to
/// be counted are told by a sample of them. Beside it stands what is
/// exact: its similarity dimension, how its copies lie, the dimension that follows for the set itself
/// and for its boundary.
///
/// The spectrum of dimensions D_q is that of a measure on the limit set: the one that the weights of a
/// system give, or else the natural one, under which copies have the masses that their sizes call for, and
/// copies that coincide count once. It is exact where copies are similar and do not overlap, and measured
/// by the masses of boxes about points of the set, which the graph tells.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// A rule (a file or a name in the library), a picture (PNG, JPEG), a table of points (CSV), or -
    /// for any of them on standard input
    #[arg(value_name = "RULE|IMAGE|POINTS")]
    rule: PathBuf,
    /// Sets a parameter of the rule; it may be given several times
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<Assignment>,
    /// Leaves maps of a system out, by their numbers from 1: --omit 2,3
    #[arg(long, value_name = "MAPS", value_delimiter = ',', value_parser = number::whole("a map", 1..=u32::MAX))]
    omit: Vec<u32>,
    /// So many values of a parameter that is set to a range: --set ratio=0.5..0.7
    ///
    /// Of several values of a parameter, the exact dimensions are told, and drawn.
    #[arg(long, value_name = "N", default_value_t = 21, value_parser = number::whole("a number of values", 2..=1000_u32))]
    samples: u32,
    /// As JSON, with every count
    #[arg(long)]
    json: bool,
    /// Draws counts, fit and local slopes into a file (SVG or PNG)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    plot: Option<PathBuf>,
    /// By what number boxes get smaller [default: the least whole number that is a power of the ratio
    /// that a rule repeats itself by, or that fits a picture, or 2; a whole number for pictures and
    /// points]
    #[arg(long, value_name = "B", value_parser = base)]
    base: Option<f64>,
    /// How many grids are tried
    #[arg(long, value_name = "N", default_value = "8")]
    grids: NonZero<usize>,
    /// The orders q of the spectrum of dimensions D_q; 1 is the information dimension, 2 the
    /// correlation dimension
    #[arg(
        long,
        value_name = "Q,...",
        value_delimiter = ',',
        default_value = "0,1,2,3,4,5"
    )]
    #[arg(value_parser = order, allow_hyphen_values = true)]
    orders: Vec<f64>,
    /// What random draws of a rule depend on: another seed makes another individual
    #[arg(long, value_name = "S", default_value_t = 0)]
    #[arg(value_parser = number::whole("a seed", 0..=u64::MAX), allow_negative_numbers = true)]
    seed: u64,
    /// The number of threads [default: as many as the machine has cores]
    #[arg(long, value_name = "N", value_parser = growth::threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    /// What of a pixel tells whether it belongs to the set [default: its opacity, if any pixel is
    /// transparent, or else its darkness]
    #[arg(long, help_heading = "Pictures", value_parser = channel())]
    channel: Option<crate::import::Channel>,
    /// From which darkness or opacity on a pixel belongs to the set, from 1 to 255 [default: what
    /// parts the pixels best (Otsu 1979)]
    #[arg(long, value_name = "T", help_heading = "Pictures")]
    #[arg(value_parser = clap::value_parser!(u8).range(1..))]
    threshold: Option<u8>,
    /// Measures what is light, or transparent
    #[arg(long, help_heading = "Pictures")]
    invert: bool,
    /// The two columns of a table that are coordinates, by name or number
    #[arg(long, value_name = "X,Y", help_heading = "Tables", value_parser = columns)]
    columns: Option<[String; 2]>,
}

const MORE: &str = "\
Examples:
  kfrac dim koch
      Measures the Koch curve
  kfrac dim koch --plot koch-dimension.svg
      Draws the counts, the fit and the local slopes as well
  kfrac dim cesaro --set angle=60..89 --samples 7
      Tells the dimension as a function of a parameter
  kfrac grow koch --steps 6 --format csv -o - | kfrac dim - --columns x0,y0 --json
      Measures points of an approximant, for another program
  kfrac grow dragon --size 2048 --format png -o - | kfrac dim -
      Measures a picture
";

/// What has been measured, of whatever kind.
struct Measured {
    /// What messages call it.
    name: String,
    title: String,
    /// What exactly was measured.
    set: String,
    unit: Option<&'static str>,
    /// What is known without measuring, of a rule.
    exact: Option<exact::Grown>,
    counting: BoxCounting,
    spectrum: Vec<Generalised>,
    /// The spectrum that is known without measuring.
    spectrum_known: Option<exact::Spectrum>,
    /// The measure on the limit set whose spectrum is given.
    measure: Option<&'static str>,
    lacunarity: Vec<Lacunarity>,
    warnings: Vec<String>,
}

impl Measured {
    /// With the reason why there is nothing to be told.
    fn without(mut self, reason: &dyn std::error::Error) -> Self {
        self.warnings.push(format!("nothing is measured: {reason}"));
        self
    }
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let plot = arguments.plot.as_deref();
    let plot = plot.map(|path| Ok::<_, Failure>((path, format::choose(None, Some(path))?)));
    let plot = plot.transpose()?;
    let family = arguments
        .rules()
        .load_family(catalogue, true, arguments.samples)?;
    if !family.is_empty() {
        let series = Series::of(&family)?;
        if let Some((path, format)) = plot {
            series.draw(path, format)?;
        }
        let said = if arguments.json {
            series.json()?
        } else {
            series.described()
        };
        return Ok(output::print(&said)?);
    }
    let mut measured = input::measure(arguments, catalogue)?;
    report::warn(&mut measured);
    if let Some((path, format)) = plot {
        draw(&measured, path, format)?;
    }
    let said = if arguments.json {
        report::json(&measured)?
    } else {
        report::described(&measured)
    };
    output::print(&said)?;
    for warning in &measured.warnings {
        text::say(&format!("warning: {warning}"));
    }
    Ok(())
}

fn draw(measured: &Measured, path: &Path, format: render::Format) -> Result<(), Failure> {
    let options = dimension::Options {
        format,
        unit: measured.unit,
        labels: Labels {
            title: measured.title.clone(),
            description: report::sentence(measured),
            provenance: format!("# kfrac {}\n", env!("CARGO_PKG_VERSION")),
        },
    };
    output::write(path, true, |out, _| {
        let written = dimension::write(&measured.counting, &options, out);
        written.map_err(|error| match error {
            RenderError::Io(error) => output::failed(error, path),
            other => anyhow::Error::new(other).into(),
        })
    })?;
    Ok(())
}

impl Arguments {
    fn rules(&self) -> RuleArguments {
        RuleArguments {
            rule: self.rule.clone(),
            set: self.set.clone(),
            omit: self.omit.clone(),
        }
    }

    fn grids(&self) -> Vec<Grid> {
        Grid::spread(self.grids)
    }

    fn threads(&self) -> NonZero<usize> {
        self.threads.unwrap_or_else(all_cores)
    }
}

fn base(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(base) if (1.1..=16.0).contains(&base) => Ok(base),
        _ => Err("this is a number from 1.1 to 16".into()),
    }
}

fn order(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(order) if order.abs() <= 50.0 => Ok(order),
        _ => Err("an order is a number from -50 to 50".into()),
    }
}

fn columns(text: &str) -> Result<[String; 2], String> {
    match text.split_once(',') {
        Some((x, y)) if !y.contains(',') => Ok([x.trim().into(), y.trim().into()]),
        _ => Err("write the names or numbers of two columns: X,Y".into()),
    }
}

fn channel() -> impl clap::builder::TypedValueParser<Value = crate::import::Channel> {
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    let values = [
        PossibleValue::new("darkness").help("How dark it is, on white"),
        PossibleValue::new("alpha").help("How opaque it is"),
    ];
    PossibleValuesParser::new(values).map(|name| match name.as_str() {
        "alpha" => crate::import::Channel::Alpha,
        _ => crate::import::Channel::Darkness,
    })
}
