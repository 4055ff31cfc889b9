//! `kfrac fit`: finds a system of maps whose attractor is a picture.

use std::fmt::Write as _;
use std::io::Read as _;
use std::num::NonZero;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow};
use clap::ValueHint;
use clap::builder::PossibleValue;
use serde::Serialize;

use crate::Bits;
use crate::catalogue::open_file;
use crate::fit::{Fit, FitOptions, Method, Shape};
use crate::import::{Channel, Raster};

use super::{Failure, growth, help, input, number, output, text};

/// Finds a system of maps whose attractor is a picture, and writes it as a file
///
/// The pixels that are dark, or opaque where the picture has transparent ones, are the shape. Smaller copies of the
/// shape that cover it are searched (Barnsley's collage), and refined on their attractor. The file is of the kind ifs;
/// `kfrac grow` draws it in the place of the picture, and its parameter `bend` turns all copies.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Picture (PNG, JPEG, PBM, PGM, PPM), or - for standard input
    #[arg(value_name = "PICTURE", value_hint = ValueHint::FilePath)]
    picture: PathBuf,
    /// File to write, or - for standard output [default: only the measures are printed]
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Draws shape, attractor, difference and copies into a PNG file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    report: Option<PathBuf>,
    /// Number of maps, or a range of numbers of which the least description length chooses
    #[arg(long, value_name = "N|LEAST..MOST", default_value = "2..8", value_parser = maps)]
    maps: RangeInclusive<usize>,
    /// How the system is found
    #[arg(long, value_name = "METHOD", default_value = "auto", value_parser = method())]
    method: Method,
    /// Admits only similarities
    #[arg(long)]
    similar: bool,
    /// Number of condensation disks
    #[arg(long, value_name = "K", default_value_t = 0, value_parser = number::whole("a number of disks", 0..=32_usize))]
    disks: usize,
    /// Least darkness or opacity, from 1 to 255, of a pixel of the shape; or otsu, for the best separation of the pixels
    /// (Otsu 1979)
    #[arg(long, value_name = "T", default_value = "otsu", value_parser = threshold)]
    threshold: Threshold,
    /// Fits the light or transparent pixels instead
    #[arg(long)]
    invert: bool,
    /// Number of systems that are evaluated for each number of maps, approximately
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = number::whole("a number of evaluations", 100..=100_000_000_usize))]
    effort: usize,
    /// Seed of random numbers
    #[arg(long, value_name = "S", default_value_t = 0)]
    #[arg(value_parser = number::whole("a seed", 0..=u64::MAX), allow_negative_numbers = true)]
    seed: u64,
    /// Number of threads [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = growth::threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    /// Prints the measures as JSON
    ///
    /// Distances are in pixels. iou is intersection over union, boundary_iou that of the pixels within 2 pixels of the
    /// complement. collage is the distance of the shape from its collage, contraction the largest factor of a map, and
    /// bound the largest distance that they allow. bits is the number of bits of all numbers if each has so few that iou
    /// falls by at most 0.005. exact is true if the pictures are the same, but for pixels that the attractor only
    /// touches.
    #[arg(long)]
    json: bool,
    /// Prints only errors
    #[arg(long, short)]
    quiet: bool,
}

const MORE: &str = "\
Examples:
  kfrac fit leaf.png -o leaf.yaml
      Fits 2 to 8 maps to the dark pixels of a picture
  kfrac fit gasket.png --maps 3 --similar -o gasket.yaml
      Fits three similarities
  kfrac fit leaf.png --maps 4 --report compare.png --json
      Draws shape, attractor, difference and copies, and prints the measures
";

#[derive(Clone, Copy, Debug, PartialEq)]
enum Threshold {
    Otsu,
    Value(u8),
}

fn threshold(text: &str) -> Result<Threshold, String> {
    match text.parse() {
        _ if text == "otsu" => Ok(Threshold::Otsu),
        Ok(value @ 1..) => Ok(Threshold::Value(value)),
        _ => Err("expected otsu or a number from 1 to 255".into()),
    }
}

fn maps(text: &str) -> Result<RangeInclusive<usize>, String> {
    let (least, most) = text.split_once("..").unwrap_or((text, text));
    match (least.parse(), most.parse()) {
        (Ok(least), Ok(most)) if 2 <= least && least <= most && most <= 32 => Ok(least..=most),
        _ => Err("expected a number from 2 to 32, or a range such as 2..8".into()),
    }
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

#[derive(Serialize)]
struct Report<'a> {
    picture: &'a str,
    width: usize,
    height: usize,
    threshold: u8,
    pixels: u64,
    method: &'static str,
    maps: usize,
    disks: usize,
    exact: bool,
    iou: f64,
    boundary_iou: f64,
    hausdorff: f64,
    hausdorff95: f64,
    mean_distance: f64,
    coverage: f64,
    collage: f64,
    contraction: f64,
    bound: f64,
    bits: u64,
    bits_per_pixel: f64,
    evaluations: usize,
    seed: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (name, raster) = read(&arguments.picture)?;
    let raster = if arguments.invert {
        raster.inverted()
    } else {
        raster
    };
    let threshold = match arguments.threshold {
        Threshold::Otsu => raster.otsu(),
        Threshold::Value(value) => value,
    };
    let bits = Bits::of_bytes(&raster.values, raster.width, raster.height, threshold);
    let quality = match raster.channel {
        Channel::Darkness => "dark",
        Channel::Alpha => "opaque",
    };
    let shape = Shape::new(bits).map_err(|error| {
        anyhow!(
            "{name}: {error} ({quality} pixels, threshold {threshold}); try --threshold or --invert"
        )
    })?;
    let options = FitOptions::default()
        .method(arguments.method)
        .maps(arguments.maps.clone())
        .similar(arguments.similar)
        .disks(arguments.disks)
        .effort(arguments.effort)
        .seed(arguments.seed);
    let options = match arguments.threads {
        Some(threads) => options.threads(threads),
        None => options,
    };
    let fit = crate::fit(&shape, &options).with_context(|| name.clone())?;
    if let Some(path) = &arguments.output {
        output::write_text(path, &fit.yaml(&shape, &title(&name)))?;
    }
    if let Some(path) = &arguments.report {
        output::write(path, true, |out, _| {
            let drawn = fit.report(&shape, out);
            Ok(drawn.with_context(|| output::called(path))?)
        })?;
    }
    let report = Report::new(&name, &shape, threshold, &fit, arguments.seed);
    if arguments.json {
        output::print_json(&report)?;
    } else if !arguments.quiet {
        let is_free = arguments.output.as_deref() != Some(Path::new("-"));
        if is_free {
            output::print(&report.described(quality))?;
        }
        if let Some(path) = arguments.output.as_deref().filter(|_| is_free) {
            let (path, [width, height]) = (path.display(), shape.size());
            text::print_message(&format!(
                "{path}: {} maps; `kfrac grow {path} --size {width}x{height}` draws them",
                report.maps
            ));
        }
    }
    Ok(())
}

/// Returns the name and the values of a picture.
fn read(path: &Path) -> Result<(String, Raster), Failure> {
    const MAX_BYTES: u64 = 1 << 31;
    let is_standard = path == Path::new("-");
    let name = if is_standard {
        "standard input".into()
    } else {
        path.display().to_string()
    };
    input::note(path);
    let mut bytes = Vec::new();
    let read = if is_standard {
        std::io::stdin()
            .lock()
            .take(MAX_BYTES)
            .read_to_end(&mut bytes)
    } else {
        open_file(path)?.take(MAX_BYTES).read_to_end(&mut bytes)
    };
    read.with_context(|| format!("{name} cannot be read"))?;
    let raster = Raster::read(&bytes, None).with_context(|| name.clone())?;
    Ok((name, raster))
}

/// Returns the name of a picture without its folder.
fn title(name: &str) -> String {
    let file = Path::new(name).file_name();
    file.map_or_else(|| name.into(), |file| file.to_string_lossy().into_owned())
}

impl<'a> Report<'a> {
    fn new(name: &'a str, shape: &Shape, threshold: u8, fit: &Fit, seed: u64) -> Self {
        let [width, height] = shape.size();
        let score = &fit.score;
        Self {
            picture: name,
            width,
            height,
            threshold,
            pixels: shape.bits().count(),
            method: fit.method.name(),
            maps: fit.candidate.maps.len(),
            disks: fit.candidate.disks.len(),
            exact: fit.exact,
            iou: score.iou,
            boundary_iou: score.boundary_iou,
            hausdorff: score.hausdorff,
            hausdorff95: score.hausdorff95,
            mean_distance: score.mean_distance,
            coverage: score.coverage,
            collage: fit.certificate.collage,
            contraction: fit.certificate.contraction,
            bound: fit.certificate.bound,
            bits: fit.bits,
            bits_per_pixel: fit.bits_per_pixel(shape),
            evaluations: fit.evaluations,
            seed,
        }
    }

    /// Describes the fit in text.
    fn described(&self, quality: &str) -> String {
        let mut text = String::new();
        let mut line = |label: &str, value: &str| {
            // Writing to a string does not fail.
            let _ = writeln!(text, "{label:<14}{value}");
        };
        let Self {
            width,
            height,
            pixels,
            threshold,
            ..
        } = self;
        line(
            "shape",
            &format!("{pixels} {quality} pixels of {width} x {height} (threshold {threshold})"),
        );
        let disks = match self.disks {
            0 => String::new(),
            count => format!(" and {count} disks"),
        };
        line(
            "system",
            &format!("{} maps{disks}, by {}", self.maps, self.method),
        );
        let exact = if self.exact { ": the same picture" } else { "" };
        line(
            "overlap",
            &format!(
                "{:.4} of the union, {:.4} along the boundaries{exact}",
                self.iou, self.boundary_iou
            ),
        );
        line(
            "distance",
            &format!(
                "{:.2} pixels at most, {:.2} for 95 %, {:.3} in the mean",
                self.hausdorff, self.hausdorff95, self.mean_distance
            ),
        );
        line(
            "collage",
            &format!(
                "{:.2} pixels, contraction {:.4}: at most {:.2} pixels by the collage theorem",
                self.collage, self.contraction, self.bound
            ),
        );
        line(
            "size",
            &format!("{} bits, {:.4} a pixel", self.bits, self.bits_per_pixel),
        );
        line("evaluations", &self.evaluations.to_string());
        text
    }
}
