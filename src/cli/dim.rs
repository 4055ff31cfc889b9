//! `kfrac dim`: dimensions of a rule, a picture or a table of points, of the plane or of space.

mod drawn;
mod input;
mod kind;
mod report;
mod seeds;
mod series;

use std::num::NonZero;
use std::path::{Path, PathBuf};

use clap::ValueHint;

use crate::catalogue::Catalogue;
use crate::figure::dimension;
use crate::geometry::HalfSpace;
use crate::measure::{BoxCounting, Generalised, Lacunarity, exact};
use crate::parallel::all_cores;
use crate::render::{self, Labels};

use self::kind::InputKind;
pub(in crate::cli) use self::report::hausdorff;
use self::series::Series;
use super::exchanged::ExchangedComponents;
use super::family::{Assignment, Family, assignment};
use super::pixels::PixelArguments;
use super::rule::RuleArguments;
use super::{Failure, format, growth, help, number, output, space, steps, text};

/// Measures the dimension of a rule's limit set, a picture or a table of points
///
/// Boxes of many sizes are counted on shifted and rotated grids, and the smallest cover of each size is kept.
/// The dimension is the slope of the logarithms, reported with its standard error and all counts. If the
/// local slopes drift, a remark reports it, and the estimate extrapolates the drift. For a picture, the slope
/// is fitted to the mean counts over all grids, corrected for the width of the pen and for boxes at the rims.
/// For a rule, the limit set of the fertile elements is measured directly on its graph; where the boxes are
/// too many to count, their number is estimated from a sample. Exact results are listed as well: the
/// similarity dimension, the overlap of the copies, and the resulting dimensions of the set and of its
/// boundary.
///
/// Sets and points in space are covered by cubes. Cubes along the axes that are of finitely many kinds, by the
/// copies in them, are counted exactly, to any depth.
///
/// The spectrum of dimensions D_q is that of a measure on the limit set: the measure given by the weights of
/// a system, or else the natural measure, under which the mass of a copy follows from its size and coinciding
/// copies count once. Exact values are given where the copies are similar and do not overlap; measured values
/// come from the masses of boxes around points of the set, computed on the graph.
#[derive(clap::Args, Clone)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Rule (a file or a name in the library), picture (PNG, JPEG, PBM, PGM, PPM), points (CSV, PLY), or - for any of them on
    /// standard input
    #[arg(value_name = "RULE|IMAGE|POINTS")]
    rule: PathBuf,
    /// Sets a parameter of the rule; may be given several times
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    set: Vec<Assignment>,
    /// Omits maps of a system, by their numbers from 1: --omit 2,3
    #[arg(long, value_name = "MAPS", value_delimiter = ',', value_parser = number::whole("a map", 1..=u32::MAX))]
    omit: Vec<u32>,
    #[command(flatten)]
    components: ExchangedComponents,
    /// Number of values of a parameter that is set to a range: --set ratio=0.5..0.7
    ///
    /// For several values of a parameter, only the exact dimensions are listed and plotted.
    #[arg(long, value_name = "N", default_value_t = 21, value_parser = number::whole("a number of values", 2..=1000_u32))]
    samples: u32,
    /// Computes the exact dimensions of a rule alone, and measures nothing
    #[arg(long, conflicts_with_all = ["slice", "plot"])]
    exact: bool,
    /// Measures an approximant of the plane as it is drawn, with its strokes and fills, instead of the limit set
    ///
    /// The boxes are pixels and their multiples. By default, a pixel is as large as half of the fertile elements:
    /// smaller boxes would measure the elements themselves.
    #[arg(long, short, value_name = "N", value_parser = steps::parse, allow_negative_numbers = true)]
    #[arg(conflicts_with_all = ["exact", "slice"])]
    steps: Option<u32>,
    /// Long side of the drawing of --steps in pixels [default: from its elements, 64 to 4096]
    #[arg(long, value_name = "PX", requires = "steps", value_parser = number::whole("a number of pixels", 16..=16384_u32))]
    size: Option<u32>,
    /// Number of seeds from --seed on; lists the dimension of every draw, with mean and standard deviation
    #[arg(long, value_name = "N", value_parser = number::whole("a number of seeds", 2..=1000_u32))]
    #[arg(conflicts_with_all = ["exact", "slice", "plot"])]
    seeds: Option<u32>,
    /// Prints the result as JSON, with all counts
    #[arg(long)]
    json: bool,
    /// Measures the slice of a set in space by the plane n·x = value instead: --slice 0,0,1=0.5
    ///
    /// For every size, the cubes of the layer that the plane halves are counted. D_q and lacunarity are those of the
    /// squares of the plane that the slice meets, all of which have the same mass.
    #[arg(long, value_name = "X,Y,Z=VALUE", value_parser = space::plane, allow_hyphen_values = true)]
    slice: Option<HalfSpace>,
    /// Plots counts, fit and local slopes into a file (SVG or PNG)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    plot: Option<PathBuf>,
    /// Factor between the sizes of boxes [default: the least whole number that is a power of the ratio at
    /// which a rule repeats itself, or that fits a picture, or 2]; a whole number for pictures and points. For D_q of
    /// pictures, sizes are halved
    #[arg(long, value_name = "B", value_parser = base)]
    base: Option<f64>,
    /// Number of grids
    #[arg(long, value_name = "N", default_value = "8", value_parser = grids)]
    grids: NonZero<usize>,
    /// Orders q of the spectrum of dimensions D_q; 1 is the information dimension, 2 the correlation
    /// dimension
    #[arg(
        long,
        value_name = "Q,...",
        value_delimiter = ',',
        default_value = "0,1,2,3,4,5"
    )]
    #[arg(value_parser = order, allow_hyphen_values = true)]
    orders: Vec<f64>,
    /// Seed of the random draws of a rule
    #[arg(long, value_name = "S", default_value_t = 0)]
    #[arg(value_parser = number::whole("a seed", 0..=u64::MAX), allow_negative_numbers = true)]
    seed: u64,
    /// Number of threads [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = growth::threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    #[command(flatten)]
    pixels: PixelArguments,
    /// Columns of a table that hold the two or three coordinates, by name or number
    #[arg(long, value_name = "X,Y[,Z]", help_heading = "Tables", value_parser = columns)]
    columns: Option<Columns>,
}

const MORE: &str = "\
Examples:
  kfrac dim koch
      Measures the Koch curve
  kfrac dim twindragon-ifs --exact
      Computes the exact dimensions alone, in a moment
  kfrac dim random-tree --steps 10 --seeds 20
      Measures a tree as it is drawn after 10 steps, for 20 random draws
  kfrac dim koch --plot koch-dimension.svg
      Also plots the counts, the fit and the local slopes
  kfrac dim cesaro --set angle=60..89 --samples 7
      Computes the dimension as a function of a parameter
  kfrac grow koch --steps 6 --format csv -o - | kfrac dim - --columns x0,y0 --json
      Measures the points of an approximant, with JSON output
  kfrac dim menger --slice 1,1,1=1.5
      Measures the slice through the middle of a cube, across its diagonal
  kfrac grow dragon --size 2048 --format png -o - | kfrac dim -
      Measures a picture
";

/// Result of a measurement of any kind.
#[derive(Default)]
struct Measured {
    /// Name in messages.
    name: String,
    title: String,
    /// Description of the set that was measured.
    set: String,
    unit: Option<&'static str>,
    /// Whether only exact results are asked for.
    is_exact: bool,
    /// Exact results for a rule.
    exact: Option<exact::GraphDimensions>,
    counting: BoxCounting,
    spectrum: Vec<Generalised>,
    /// Exact spectrum.
    spectrum_known: Option<exact::Spectrum>,
    /// Measure on the limit set to which the spectrum belongs.
    measure: Option<&'static str>,
    lacunarity: Vec<Lacunarity>,
    warnings: Vec<String>,
}

impl Measured {
    /// Adds a warning with the reason for which nothing could be measured.
    fn without(mut self, reason: &dyn std::error::Error) -> Self {
        self.warnings.push(format!("nothing is measured: {reason}"));
        self
    }
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let plot = arguments.plot.as_deref();
    let plot = plot.map(|path| Ok::<_, Failure>((path, format::choose(None, Some(path))?)));
    let plot = plot.transpose()?;
    let family = Family::of(&arguments.set, arguments.samples, false)?;
    if !family.is_single() {
        let family = arguments.rules().load_family(&family, catalogue, true)?;
        let series = Series::of(&family)?;
        if let Some((path, format)) = plot {
            series.draw(path, format)?;
        }
        return output::print_as(arguments.json, &series.json(), || series.described());
    }
    if let Some(count) = arguments.seeds {
        let draws = seeds::measure(arguments, catalogue, count)?;
        return output::print_as(arguments.json, &draws.json(), || draws.described());
    }
    let mut measured = input::measure(arguments, catalogue)?;
    report::warn(&mut measured);
    if let Some((path, format)) = plot {
        draw(&measured, path, format)?;
    }
    output::print_as(arguments.json, &report::json(&measured), || {
        report::described(&measured)
    })?;
    for warning in &measured.warnings {
        text::print_message(&format!("warning: {warning}"));
    }
    Ok(())
}

fn draw(measured: &Measured, path: &Path, format: render::Format) -> Result<(), Failure> {
    let options = dimension::DimensionFigureOptions {
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
        written.map_err(|error| output::explain(error, path))
    })?;
    Ok(())
}

impl Arguments {
    fn rules(&self) -> RuleArguments {
        RuleArguments {
            rule: self.rule.clone(),
            set: self.set.clone(),
            omit: self.omit.clone(),
            components: self.components.clone(),
        }
    }

    /// Returns the reason for which an option that is given has no meaning for a kind of input.
    fn without_meaning(&self, kind: InputKind) -> Option<String> {
        let is_rule = kind == InputKind::Rule;
        let of_rules = [
            ("--exact", self.exact),
            ("--steps", self.steps.is_some()),
            ("--seeds", self.seeds.is_some()),
        ];
        let of_rules = of_rules
            .into_iter()
            .find(|(_, is_given)| *is_given && !is_rule);
        if let Some((option, _)) = of_rules {
            return Some(format!(
                "{option} is for rules: pictures and points are measured as they are"
            ));
        }
        let has_pixels = kind == InputKind::Picture || self.steps.is_some();
        if let Some(option) = self.pixels.given().filter(|_| !has_pixels) {
            return Some(match is_rule {
                true => format!("{option} is for pictures, and for rules with --steps"),
                false => format!("{option} is for pictures: all points are measured"),
            });
        }
        let has_columns = kind == InputKind::Table || self.columns.is_none();
        (!has_columns).then(|| "--columns is for tables in CSV".into())
    }

    fn threads(&self) -> NonZero<usize> {
        self.threads.unwrap_or_else(all_cores)
    }
}

fn base(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(base) if (1.1..=16.0).contains(&base) => Ok(base),
        _ => Err("expected a number from 1.1 to 16".into()),
    }
}

fn order(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(order) if order.abs() <= 50.0 => Ok(order),
        _ => Err("an order is a number from -50 to 50".into()),
    }
}

fn grids(text: &str) -> Result<NonZero<usize>, String> {
    let grids = number::whole("a number of grids", 1..=1000_usize)(text)?;
    NonZero::new(grids).ok_or_else(|| "there is one grid at least".into())
}

/// Names or numbers of the columns of coordinates.
#[derive(Clone)]
struct Columns(Vec<String>);

fn columns(text: &str) -> Result<Columns, String> {
    let columns: Vec<String> = text.split(',').map(|name| name.trim().into()).collect();
    let is_twice = |at: usize| columns[..at].contains(&columns[at]);
    match columns.len() {
        count if (0..count).any(is_twice) => Err("a column is given twice".into()),
        2 | 3 => Ok(Columns(columns)),
        _ => Err("write the names or numbers of two or three columns: X,Y or X,Y,Z".into()),
    }
}
