//! `kfrac morph`: erosion, dilation, opening and closing of pictures.

use std::io::Write;
use std::num::NonZero;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::ValueHint;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::Bits;
use crate::export::write_bits;
use crate::morphology::{DiskFamily, NotApplied, Sequence};
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
    disk: DiskFamily,
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
pub(super) fn disk() -> impl TypedValueParser<Value = DiskFamily> {
    let values = DiskFamily::ALL.map(|disk| {
        PossibleValue::new(disk.name()).help(match disk {
            DiskFamily::Plus => "A pixel and its four neighbours, added up: |x| + |y| <= size",
            DiskFamily::Square => "Squares of 2 size + 1 pixels",
            DiskFamily::Octagon => "Octagons of 4 size + 1 pixels, the sums of both",
            DiskFamily::Euclid => "Pixels at a distance of at most size, which may have a fraction",
        })
    });
    PossibleValuesParser::new(values).map(|name| {
        let found = DiskFamily::ALL.into_iter().find(|disk| disk.name() == name);
        found.unwrap_or_default()
    })
}

/// Returns the failure to apply a sequence.
fn failed(error: &NotApplied) -> Failure {
    match error {
        NotApplied::Fraction { .. } => Failure::Usage(error.to_string()),
        _ => anyhow::anyhow!("{error}").into(),
    }
}

/// Applies operations to a set of pixels, and writes the result as a PNG. Returns it.
pub(super) fn write(
    set: &Bits,
    operations: &Sequence,
    disk: DiskFamily,
    threads: NonZero<usize>,
    path: &Path,
    out: &mut impl Write,
) -> Result<Bits, Failure> {
    let result = operations.apply(set, disk, threads);
    let result = result.map_err(|error| failed(&error))?;
    let written = write_bits(&result, out);
    written.with_context(|| format!("{} cannot be written", output::called(path)))?;
    Ok(result)
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let set = arguments.pixels.read(&arguments.picture)?;
    let threads = arguments.threads.unwrap_or_else(all_cores);
    let path = &arguments.output;
    let (operations, disk) = (&arguments.operations, arguments.disk);
    let extension = path
        .extension()
        .filter(|_| path.as_path() != Path::new("-"));
    if let Some(other) = extension.filter(|it| !it.eq_ignore_ascii_case("png")) {
        let message = format!(
            "a .{} is not written here: the result is a .png",
            other.display()
        );
        return Err(Failure::Usage(message));
    }
    let (result, bytes) = output::write(path, true, |mut out, _| {
        write(&set.bits, operations, disk, threads, path, &mut out)
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
