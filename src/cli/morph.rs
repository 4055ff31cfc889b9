//! `kfrac morph`: erosion, dilation, opening and closing of pictures.

use std::num::NonZero;
use std::path::PathBuf;

use anyhow::Context;
use clap::ValueHint;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::export::write_bits;
use crate::morphology::{Disk, NotApplied, Sequence};
use crate::parallel::all_cores;

use super::pixels::PixelArguments;
use super::{Failure, growth, help, output, readable, text};

/// Erodes, dilates, opens and closes a picture
///
/// The operations are applied in order, each with the size of its disk: open:3 erodes by a disk of size 3 and dilates by
/// it again, which removes what is narrower; close:2 fills what is narrower between parts. The result is black on white,
/// a bit a pixel. Pixels outside the picture are not in the set.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Picture (PNG, JPEG, PBM, PGM, PPM), or - for standard input
    #[arg(value_name = "PICTURE", value_hint = ValueHint::FilePath)]
    picture: PathBuf,
    /// Operations: erode, dilate, open and close, each with a size, as in "open:3, close:2"
    #[arg(value_name = "OPERATIONS")]
    operations: Sequence,
    /// Family of disks
    #[arg(long, default_value = "euclid", value_parser = disk())]
    disk: Disk,
    /// File of the result, a PNG, or - for standard output
    #[arg(long, short, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: PathBuf,
    /// Number of threads [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = growth::threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    /// Prints only errors
    #[arg(long, short)]
    quiet: bool,
    #[command(flatten)]
    pixels: PixelArguments,
}

const MORE: &str = "\
Examples:
  kfrac morph leaf.png open:3,close:2 -o smooth.png
      Removes what is narrower than seven pixels, and fills gaps
  kfrac morph leaf.png erode:1 --disk plus -o thin.png
      Removes the pixels at the edge
";

/// Parses the name of a family of disks.
pub(super) fn disk() -> impl TypedValueParser<Value = Disk> {
    let values = Disk::ALL.map(|disk| {
        PossibleValue::new(disk.name()).help(match disk {
            Disk::Plus => "A pixel and its four neighbours, added up: |x| + |y| <= size",
            Disk::Square => "Squares of 2 size + 1 pixels",
            Disk::Octagon => "Octagons of 4 size + 1 pixels, the sums of both",
            Disk::Euclid => "Pixels at a distance of at most size, which may have a fraction",
        })
    });
    PossibleValuesParser::new(values).map(|name| {
        let found = Disk::ALL.into_iter().find(|disk| disk.name() == name);
        found.unwrap_or_default()
    })
}

/// Returns the failure to apply a sequence.
pub(super) fn failed(error: &NotApplied) -> Failure {
    match error {
        NotApplied::Fraction { .. } => Failure::Usage(error.to_string()),
        _ => anyhow::anyhow!("{error}").into(),
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let set = arguments.pixels.read(&arguments.picture)?;
    let threads = arguments.threads.unwrap_or_else(all_cores);
    let result = arguments
        .operations
        .apply(&set.bits, arguments.disk, threads);
    let result = result.map_err(|error| failed(&error))?;
    let path = &arguments.output;
    let (_, bytes) = output::write(path, true, |out, _| {
        let written = write_bits(&result, out);
        Ok(written.with_context(|| format!("{} cannot be written", output::called(path)))?)
    })?;
    if !arguments.quiet {
        if let Some(warning) = set.warning {
            text::print_message(&format!("warning: {warning}"));
        }
        text::print_message(&format!(
            "{}: {} pixels set of {}, {} ({})",
            output::called(path),
            readable::grouped(&result.count().into()),
            set.description,
            arguments.operations,
            readable::bytes(bytes),
        ));
    }
    Ok(())
}
