//! `kfrac skeleton`: the skeleton of a picture, connected or by maximal disks.

mod listed;

use std::num::NonZero;
use std::path::PathBuf;

use anyhow::anyhow;
use clap::ValueHint;

use crate::figure::skeleton;
use crate::morphology::{DiskFamily, NoDistances, Skeleton, SkeletonOptions, SkeletonSubsets};
use crate::parallel::all_cores;
use crate::render::{self, Labels};
use crate::style::{Named, Style};

use self::listed::Listed;
use super::pixels::{PixelArguments, PixelSet};
use super::{Failure, format, growth, help, morph, output, picture, text};

/// Computes the skeleton of a picture: lines of centres of disks
///
/// The connected skeleton has lines one pixel wide, as many parts and holes as the picture, and the radius of the largest
/// disk in the picture about each of its pixels. It is a graph: branches between branch points and ends.
///
/// With --disk, the result is the morphological skeleton instead: the centres of the maximal disks of a family by their
/// size, the skeleton subsets. The union of the disks is the picture, exactly; the centres may be disconnected. Of euclid,
/// size is the square of the distance to the nearest pixel outside, and a disk holds the pixels that are nearer.
///
/// Coordinates are in pixels from the lower left corner of the picture, with y up; centres of pixels are at halves.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Picture (PNG, JPEG, PBM, PGM, PPM), or - for standard input
    #[arg(value_name = "PICTURE", value_hint = ValueHint::FilePath)]
    picture: PathBuf,
    /// Draws the skeleton over the picture (SVG, PNG, PDF), or lists it (CSV)
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Format of the file [default: from the extension of the file]
    #[arg(long, value_parser = picture::named::<Format>())]
    format: Option<Format>,
    /// Computes the centres of the maximal disks of a family
    #[arg(long, value_parser = morph::disk(), conflicts_with = "angle")]
    disk: Option<DiskFamily>,
    /// Least angle in degrees at which the nearest points outside are seen from the end of a branch; larger ones leave
    /// fewer branches
    #[arg(long, value_name = "DEGREES", default_value_t = 60.0, value_parser = angle)]
    angle: f64,
    /// Prints the skeleton as JSON
    ///
    /// picture has name, width, height and the number of its pixels. nodes have x, y, radius and the numbers of their
    /// branches (from 0); branches have from and to (numbers of nodes), length and points (x, y, radius). With --disk,
    /// there is disk and subsets instead, each with size, radius and centres (x, y).
    #[arg(long)]
    json: bool,
    /// Number of threads [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = growth::threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    #[command(flatten)]
    pixels: PixelArguments,
}

const MORE: &str = "\
Examples:
  kfrac skeleton leaf.png -o skeleton.svg
      Draws the connected skeleton over the picture
  kfrac skeleton leaf.png --json
      Lists branch points, ends and branches with their radii
  kfrac skeleton leaf.png --disk octagon -o disks.csv
      Lists the maximal octagons
";

/// Formats of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Picture(render::Format),
    Csv,
}

impl Named for Format {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("svg", Self::Picture(render::Format::Svg)),
        ("png", Self::Picture(render::Format::Png)),
        ("pdf", Self::Picture(render::Format::Pdf)),
        ("csv", Self::Csv),
    ];
}

fn angle(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(angle) if (0.0..=180.0).contains(&angle) => Ok(angle),
        _ => Err("expected an angle from 0 to 180".into()),
    }
}

/// A skeleton of one of the two kinds.
enum Found {
    Connected(Skeleton),
    Disks(SkeletonSubsets),
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let format = format::choose(arguments.format, arguments.output.as_deref())?;
    let set = arguments.pixels.read(&arguments.picture)?;
    let found = arguments.find(&set)?;
    let listed = Listed::of(&set, &found);
    if let Some(path) = &arguments.output {
        match format {
            Format::Csv => output::write_text(path, &listed.csv())?,
            Format::Picture(format) => {
                let options = options(&set, format);
                output::write(path, true, |out, _| {
                    let written = match &found {
                        Found::Connected(skeleton) => {
                            skeleton::write_connected(&set.bits, skeleton, &options, out)
                        }
                        Found::Disks(subsets) => {
                            skeleton::write_subsets(&set.bits, subsets, &options, out)
                        }
                    };
                    written.map_err(|error| output::explain(error, path))
                })?;
            }
        }
    }
    let is_printed = arguments.output.is_none() || arguments.json;
    if is_printed {
        output::print_as(arguments.json, &listed, || listed.described())?;
    }
    if let Some(warning) = &set.warning {
        text::print_message(&format!("warning: {warning}"));
    }
    Ok(())
}

fn options(set: &PixelSet, format: render::Format) -> render::Options {
    render::Options {
        format,
        style: Style::default(),
        labels: Labels {
            title: format!("Skeleton of {}", set.name),
            description: set.description.clone(),
            provenance: format!("# kfrac {}\n", env!("CARGO_PKG_VERSION")),
        },
        ..render::Options::default()
    }
}

impl Arguments {
    fn find(&self, set: &PixelSet) -> Result<Found, Failure> {
        let threads = self.threads.unwrap_or_else(all_cores);
        let explain = |error: NoDistances| anyhow!("{}: {error}", set.name);
        Ok(match self.disk {
            Some(disk) => {
                Found::Disks(SkeletonSubsets::of(&set.bits, disk, threads).map_err(explain)?)
            }
            None => {
                let options = SkeletonOptions {
                    angle: self.angle,
                    threads,
                };
                Found::Connected(Skeleton::of(&set.bits, &options).map_err(explain)?)
            }
        })
    }
}
