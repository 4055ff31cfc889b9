//! Data sets as archives: of WebDataset, or tables in Parquet.

mod parquet;
mod tar;

use std::fs;
use std::ops::Range;
use std::path::Path;

use anyhow::Context;

use super::super::{Failure, output};
use super::folder::{ArchiveName, write_file};
use super::manifest::{LabelRow, Tally};
use super::{Job, Shard};

/// Format of archives.
#[derive(Clone, Copy, Debug)]
pub(super) enum Format {
    /// Files of WebDataset: KEY.png, KEY.cls and KEY.json.
    Tar,
    /// A table with a row for each picture.
    Parquet,
}

/// Picture in an archive.
struct Entry {
    category: u32,
    instance: u32,
    name: String,
    png: Vec<u8>,
    /// Label as JSON.
    label: String,
}

/// Archive that is made in memory.
trait Archive {
    fn add(&mut self, entry: Entry) -> anyhow::Result<()>;

    /// Returns the bytes of the archive.
    fn finish(self: Box<Self>) -> anyhow::Result<Vec<u8>>;
}

impl Format {
    /// Returns the format that the extension of a file names.
    pub(super) fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()? {
            "tar" => Some(Self::Tar),
            "parquet" => Some(Self::Parquet),
            _ => None,
        }
    }

    fn begin(self) -> anyhow::Result<Box<dyn Archive>> {
        Ok(match self {
            Self::Tar => Box::new(tar::Files::new()),
            Self::Parquet => Box::new(parquet::Table::new()?),
        })
    }

    /// Returns the pictures of an archive.
    fn pictures(self, path: &Path) -> anyhow::Result<Vec<Vec<u8>>> {
        match self {
            Self::Tar => tar::pictures(path),
            Self::Parquet => parquet::pictures(path),
        }
    }
}

/// Writes the archives of a part of the work, or compares them; returns the range of their pictures. Archive n has the pictures
/// from n · `size` on, whatever the part.
pub(super) fn write(
    job: &Job<'_>,
    name: &ArchiveName,
    size: u64,
    shard: Shard,
) -> Result<(Range<u64>, Tally), Failure> {
    let len = job.set.len();
    let archives = len.div_ceil(size);
    let end = |number: u32| {
        let end = u128::from(archives) * u128::from(number) / u128::from(shard.count);
        u64::try_from(end).unwrap_or(u64::MAX)
    };
    let own = end(shard.number - 1)..end(shard.number);
    let mut tally = Tally::default();
    for archive in own.clone() {
        let pictures = archive * size..((archive + 1) * size).min(len);
        let path = name.path(archive);
        if !job.checks && path.is_file() {
            let written = name.format.pictures(&path);
            for png in written.with_context(|| output::called(&path))? {
                tally.add(&png);
            }
            continue;
        }
        let bytes = made(job, name.format, pictures, &mut tally)?;
        if !job.checks {
            write_file(&path, &bytes)?;
        } else if fs::read(&path).map_or(true, |written| written != bytes) {
            tally.wrong.push(path.display().to_string());
        }
    }
    Ok((
        (own.start * size).min(len)..(own.end * size).min(len),
        tally,
    ))
}

/// Returns the bytes of an archive.
fn made(
    job: &Job<'_>,
    format: Format,
    pictures: Range<u64>,
    tally: &mut Tally,
) -> Result<Vec<u8>, Failure> {
    let set = job.set;
    let mut archive = format.begin()?;
    job.each(
        pictures,
        |index| {
            let example = set.example(index)?;
            Ok(Entry {
                category: example.category,
                instance: example.instance,
                name: set.category(example.category)?.name().to_owned(),
                label: LabelRow::new(set, index, &example.label)?.json()?,
                png: example.picture.into_png(),
            })
        },
        |_, entry| {
            tally.add(&entry.png);
            Ok(archive.add(entry)?)
        },
    )?;
    Ok(archive.finish()?)
}
