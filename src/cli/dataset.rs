//! `kfrac dataset`: writes data sets of pictures for the training of networks.

mod archive;
mod folder;
mod manifest;

use std::num::NonZero;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use anyhow::anyhow;
use clap::ValueHint;

use crate::catalogue::Catalogue;
use crate::dataset::{Dataset, DatasetError};
use crate::parallel::all_cores;

use self::manifest::Manifest;
use super::shard::Shard;
use super::{Failure, growth, help, number, output, progress, readable, rule, text};

/// Writes a data set of pictures with labels, for the training of networks
///
/// The file describes categories, variations and drawing. A picture is a pure function of the file, the category and the
/// instance: parts of the work can be done on any machine and in any order, and begun again where they were interrupted, to
/// the same bytes.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// File of the kind `dataset`, or - for standard input
    #[arg(value_name = "SPEC", value_hint = ValueHint::FilePath)]
    spec: PathBuf,
    /// Folder with a folder for each category, or archives: set/%06d.tar, set/%06d.parquet
    ///
    /// A folder has the file CATEGORY/INSTANCE.png for each picture, as torchvision's ImageFolder reads it, and
    /// labels.jsonl. Archives in tar are those of WebDataset: KEY.png, KEY.cls (the number of the category) and KEY.json (the
    /// label). Tables in Parquet have the columns image (bytes, a PNG, and path), category, name and label (JSON), as
    /// Hugging Face's library datasets reads them. Beside them lie dataset.yaml, the data set itself, and manifest.json. Files
    /// that exist are not written again.
    #[arg(long, short, value_name = "OUT", value_hint = ValueHint::AnyPath)]
    output: PathBuf,
    /// Part of the work, such as 3/64: the third of 64 parts
    #[arg(long, value_name = "K/N", value_parser = Shard::parse)]
    shard: Option<Shard>,
    /// Number of pictures of an archive
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = number::whole("a number of pictures", 1..=10_000_000_u64))]
    archive: u64,
    /// Draws every picture again and compares it with what has been written, in place of writing
    #[arg(long)]
    check: bool,
    /// Number of threads [default: the number of cores]
    #[arg(long, value_name = "N", value_parser = growth::threads, allow_negative_numbers = true)]
    threads: Option<NonZero<usize>>,
    /// Prints the manifest as JSON
    ///
    /// pictures is the number of pictures of this part, from index `from` to before `to`; bytes is their size as PNG, and
    /// sha256 the hash of the concatenated hashes of the PNGs, in order. categories have number, name, maps (rows a, b, c, d,
    /// e, f and weight; in space the matrix, the image of the origin and the weight), parameters, attempts (the number of systems
    /// that were drawn until one was accepted) and dimension (null where it is not decided). wrong has the pictures or archives
    /// that --check found missing or different.
    #[arg(long)]
    json: bool,
    /// Prints only errors
    #[arg(long, short)]
    quiet: bool,
}

const MORE: &str = "\
Examples:
  kfrac dataset set.yaml -o pictures
      Writes a folder that ImageFolder reads
  kfrac dataset set.yaml -o archives/%06d.tar --shard 3/64
      Writes the third of 64 parts, as archives for WebDataset
  kfrac dataset set.yaml -o tables/%06d.parquet
      Writes tables in Parquet, as Hugging Face's datasets reads them
  kfrac dataset set.yaml -o pictures --check
      Draws all pictures again, and reports those that differ
";

/// Number of pictures that are drawn before their results are put in order.
const BLOCK: u64 = 512;

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let source = rule::open_as_written(&arguments.spec)?;
    let set = Dataset::read(&source, catalogue)?;
    let place = folder::place(&arguments.output)?;
    let threads = arguments.threads.unwrap_or_else(all_cores).get();
    let shard = arguments.shard.unwrap_or(Shard::ALL);
    place.keep_spec(&set, arguments.check)?;
    let done = AtomicU64::new(0);
    let wanted = !arguments.quiet && !arguments.json;
    let describe = || {
        let count = done.load(Ordering::Relaxed);
        readable::counted(&count.into(), "picture")
    };
    let job = Job {
        set: &set,
        threads,
        checks: arguments.check,
        done: &done,
    };
    let (range, tally) = progress::watched_as(wanted, describe, || match &place.archive {
        Some(name) => archive::write(&job, name, arguments.archive, shard),
        None => {
            let range = set.shard(shard.number, shard.count);
            let tally = folder::write(&job, &place.folder, range.clone(), shard)?;
            Ok((range, tally))
        }
    })?;
    let manifest = Manifest::new(&set, arguments.shard, range, tally)?;
    if !arguments.check {
        manifest.write(&place.folder)?;
    }
    let is_wrong = !manifest.wrong.is_empty();
    if arguments.json {
        output::print_json(&manifest)?;
    } else if !arguments.quiet || is_wrong {
        text::print_message(&manifest.described(&arguments.output, arguments.check));
    }
    if is_wrong {
        Err(Failure::Reported)
    } else {
        Ok(())
    }
}

impl From<DatasetError> for Failure {
    fn from(error: DatasetError) -> Self {
        match error {
            DatasetError::Invalid(diagnostics) => diagnostics.into(),
            error => anyhow!(error).into(),
        }
    }
}

/// Work on the pictures of a data set.
struct Job<'a> {
    set: &'a Dataset,
    threads: usize,
    checks: bool,
    done: &'a AtomicU64,
}

impl Job<'_> {
    /// Works on pictures on all threads, and takes the results in order.
    fn each<T: Send>(
        &self,
        range: Range<u64>,
        work: impl Fn(u64) -> Result<T, Failure> + Sync,
        mut take: impl FnMut(u64, T) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let mut from = range.start;
        while from < range.end {
            let to = (from + BLOCK).min(range.end);
            let indices: Vec<u64> = (from..to).collect();
            let results = crate::parallel::map(&indices, self.threads, |_, &index| {
                let result = work(index);
                self.done.fetch_add(1, Ordering::Relaxed);
                result
            });
            for (index, result) in indices.into_iter().zip(results) {
                take(index, result?)?;
            }
            from = to;
        }
        Ok(())
    }
}
