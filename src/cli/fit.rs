//! `kfrac fit`: finds a system of maps whose attractor is a picture.

mod report;

use std::num::NonZero;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

use anyhow::{Context, anyhow};
use clap::ValueHint;
use clap::builder::PossibleValue;

use crate::fit::{BranchPoints, FitError, FitOptions, FitProgress, Method, Silhouette};
use crate::geometry::DVec2;
use crate::saturating::real;

use self::report::Report;
use super::pixels::PixelArguments;
use super::{Failure, growth, help, number, output, progress, readable, stop, text};

/// Finds a system of maps whose attractor is a picture, and writes it as a file
///
/// The pixels that are dark, or opaque where the picture has transparent ones, are the shape. Smaller copies of the
/// shape that cover it are searched and refined on their attractor (Barnsley's collage), or placed at branch points of
/// its skeleton (Libeskind-Hadas & Maragos 1987), or found by the picture's moments. The file is of the kind ifs;
/// `kfrac grow` draws it in the place of the picture, and its parameter `bend` turns all copies.
///
/// Lines of a pen hide what is thinner: draw approximants without strokes, as `kfrac grow --method chaos` and
/// `--detail 1 --stroke none` do, or raise --threshold.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Picture (PNG, JPEG, PBM, PGM, PPM), or - for standard input
    #[arg(value_name = "PICTURE", value_hint = ValueHint::FilePath)]
    picture: PathBuf,
    /// File to write, or - for standard output [default: only the measures are printed]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Draws shape, skeleton, attractor, difference, copies and collage into a PNG file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    report: Option<PathBuf>,
    /// Number of maps, or a range of numbers of which the least description length chooses; by the skeleton, the largest
    #[arg(long, value_name = "N|LEAST..MOST", default_value = "2..8", value_parser = maps)]
    maps: RangeInclusive<usize>,
    /// How the system is found
    #[arg(long, value_name = "METHOD", default_value = "auto", value_parser = method())]
    method: Method,
    /// Central branch point of the skeleton, in pixels from the lower left corner, with y up: the largest copy's [default:
    /// the branch point with the largest radius]
    #[arg(long, value_name = "X,Y", value_parser = point, allow_hyphen_values = true)]
    centre: Option<DVec2>,
    /// Branch point of the skeleton that is the centre of a copy; may be given several times [default: those whose copies
    /// explain the boundary]
    #[arg(long, value_name = "X,Y", value_parser = point, allow_hyphen_values = true)]
    branch: Vec<DVec2>,
    /// Admits only similarities
    #[arg(long)]
    similar: bool,
    /// Number of condensation disks; by the skeleton, the largest number, and with 0 as many as are needed
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = number::whole("a number of disks", 0..=32_usize))]
    disks: usize,
    /// Fits the weights of the maps to the darkness or opacity of the pixels, for random iteration
    #[arg(long, conflicts_with = "disks")]
    density: bool,
    /// Number of systems that are evaluated for each number of maps, approximately; the skeleton's branch points decide
    /// how many are there
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = number::whole("a number of evaluations", 100..=100_000_000_usize))]
    effort: usize,
    /// Seed of random numbers
    #[arg(long, value_name = "S", default_value_t = 0)]
    #[arg(value_parser = number::whole("a seed", 0..=u64::MAX), allow_negative_numbers = true)]
    seed: u64,
    /// Number of threads [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = growth::threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    /// Keeps the best system so far when the search is interrupted by Ctrl-C; the second Ctrl-C ends the program
    #[arg(long)]
    keep_best: bool,
    /// Prints the measures as JSON
    ///
    /// Distances are in pixels. iou is intersection over union, boundary_iou that of the pixels within 2 pixels of the
    /// complement. collage is the distance of the shape from its collage, contraction the largest factor of a map, and
    /// bound the largest distance that they allow. bits is the number of bits of all numbers if each has so few that iou
    /// falls by at most 0.005. exact is true if the pictures are the same, but for pixels that the attractor only
    /// touches. description is the length by which methods are compared, in bits; others are the methods that lost, with
    /// theirs. dimension is that of the attractor, with an upper bound where it is not decided. density has the weights of
    /// the maps and the share of the mass that lies elsewhere.
    #[arg(long)]
    json: bool,
    /// Prints only errors
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    pixels: PixelArguments,
}

const MORE: &str = "\
Examples:
  kfrac fit leaf.png -o leaf.yaml
      Fits 2 to 8 maps to the dark pixels of a picture
  kfrac fit gasket.png --maps 3 --similar -o gasket.yaml
      Fits three similarities
  kfrac fit island.png --method skeleton --similar --report compare.png
      Places copies at branch points of the skeleton, and draws what was found
  kfrac fit island.png --centre 75,75 --branch 75,121 --branch 35,98 --branch 115,98
      Places copies at three branch points that are known
";

fn maps(text: &str) -> Result<RangeInclusive<usize>, String> {
    let (least, most) = text.split_once("..").unwrap_or((text, text));
    match (least.parse(), most.parse()) {
        (Ok(least), Ok(most)) if 2 <= least && least <= most && most <= 32 => Ok(least..=most),
        _ => Err("expected a number from 2 to 32, or a range such as 2..8".into()),
    }
}

fn point(text: &str) -> Result<DVec2, String> {
    let numbers = text.split_once(',').and_then(|(x, y)| {
        let [x, y] = [x, y].map(|it| it.trim().parse::<f64>().ok());
        Some(DVec2::new(x?, y?))
    });
    let finite = numbers.filter(|point| point.is_finite());
    finite.ok_or_else(|| "expected two numbers, as in 64,40.5".into())
}

fn method() -> impl clap::builder::TypedValueParser<Value = Method> {
    use clap::builder::{PossibleValuesParser, TypedValueParser};
    let values =
        Method::ALL.map(|method| PossibleValue::new(method.name()).help(method.described()));
    PossibleValuesParser::new(values).map(|name| {
        let named = Method::ALL.into_iter().find(|method| method.name() == name);
        named.unwrap_or_default()
    })
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let set = arguments.pixels.read(&arguments.picture)?;
    arguments.check([set.bits.width(), set.bits.height()])?;
    let explain = |error: FitError| anyhow!("{}: {error} ({})", set.name, set.description);
    let mut shape = Silhouette::new(set.bits.clone()).map_err(explain)?;
    if arguments.density {
        shape = shape.with_values(&set.values).map_err(explain)?;
    }
    let progress = Arc::new(FitProgress::default());
    let stop = arguments.keep_best.then(stop::kept);
    let options = { arguments.options() }
        .progress(Some(progress.clone()))
        .stop(stop.clone());
    let is_shown = !arguments.quiet;
    let fit = progress::watched_as(
        is_shown,
        || described(&progress),
        || crate::fit(&shape, &options),
    );
    let fit = fit.map_err(explain)?;
    if let Some(path) = &arguments.output {
        output::write_text(path, &fit.yaml(&shape, &title(&set.name)))?;
    }
    if let Some(path) = &arguments.report {
        output::write(path, true, |out, _| {
            let drawn = fit.report(&shape, out);
            Ok(drawn.with_context(|| output::called(path))?)
        })?;
    }
    let report = Report::new(&set, &shape, &fit, arguments.seed);
    let is_free = arguments.output.as_deref() != Some(Path::new("-"));
    if arguments.json {
        output::print_json(&report)?;
    } else if !arguments.quiet && is_free {
        output::print(&report.described(&set.description))?;
    }
    if arguments.quiet {
        return Ok(());
    }
    if let Some(path) = arguments
        .output
        .as_deref()
        .filter(|_| is_free && !arguments.json)
    {
        let (path, [width, height]) = (path.display(), shape.size());
        text::print_message(&format!(
            "{path}: {}; `kfrac grow {path} --size {width}x{height}` draws it",
            report.system()
        ));
    }
    if stop.is_some_and(|stop| stop.load(Ordering::Relaxed)) {
        text::print_message("interrupted: this is the best system so far");
    }
    if let Some(warning) = &set.warning {
        text::print_message(&format!("warning: {warning}"));
    }
    Ok(())
}

impl Arguments {
    /// Refuses branch points that have no effect, and those outside a picture of a size.
    fn check(&self, [width, height]: [usize; 2]) -> Result<(), Failure> {
        let centre = self.centre.map(|point| ("--centre", point));
        let branches = self.branch.iter().map(|&point| ("--branch", point));
        for (option, point) in centre.into_iter().chain(branches) {
            if !matches!(self.method, Method::Auto | Method::Skeleton) {
                let name = self.method.name();
                let message = format!("{option} is for --method skeleton, not {name}");
                return Err(Failure::Usage(message));
            }
            let size = DVec2::new(real(width), real(height));
            if point.clamp(DVec2::ZERO, size) != point {
                let message = format!(
                    "{option} {},{} lies outside of the picture of {width} x {height} pixels; it is counted from the lower left corner",
                    point.x, point.y
                );
                return Err(Failure::Usage(message));
            }
        }
        Ok(())
    }

    fn options(&self) -> FitOptions {
        let options = FitOptions::default()
            .method(self.method)
            .maps(self.maps.clone())
            .similar(self.similar)
            .disks(self.disks)
            .branch_points(BranchPoints {
                centre: self.centre,
                branches: self.branch.clone(),
            })
            .effort(self.effort)
            .seed(self.seed);
        match self.threads {
            Some(threads) => options.threads(threads),
            None => options,
        }
    }
}

/// Describes the best candidate so far.
fn described(progress: &FitProgress) -> String {
    let evaluated = readable::grouped(&progress.evaluated().into());
    match progress.best() {
        Some(best) => format!(
            "{evaluated} systems evaluated, best: {} maps by {}, overlap {:.4}",
            best.maps,
            best.method.name(),
            best.iou
        ),
        None => format!("{evaluated} systems evaluated"),
    }
}

/// Returns the name of a picture without its folder.
fn title(name: &str) -> String {
    let file = Path::new(name).file_name();
    file.map_or_else(|| name.into(), |file| file.to_string_lossy().into_owned())
}
