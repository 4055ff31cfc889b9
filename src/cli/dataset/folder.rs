//! Data sets as folders: a folder for each category.

use std::fs;
use std::io::Write as _;
use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::anyhow;

use crate::dataset::Dataset;
use crate::output_file::OutputFile;

use super::super::template::NumberedName;
use super::super::{Failure, output};
use super::archive::Format;
use super::manifest::{LabelRow, Tally};
use super::{Job, Shard};

/// Place where a data set is written.
pub(super) struct Place {
    pub(super) folder: PathBuf,
    /// Name of archives, if it is written into archives.
    pub(super) archive: Option<ArchiveName>,
}

/// Name of archives, with their numbers, in a folder.
pub(super) struct ArchiveName {
    name: NumberedName,
    folder: PathBuf,
    pub(super) format: Format,
}

impl ArchiveName {
    pub(super) fn path(&self, number: u64) -> PathBuf {
        self.folder.join(self.name.with(number))
    }
}

/// Returns the place that an output names.
pub(super) fn place(output: &Path) -> Result<Place, Failure> {
    let Some(format) = Format::of(output) else {
        return Ok(Place {
            folder: output.into(),
            archive: None,
        });
    };
    let name = output
        .file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let Some(numbered) = NumberedName::parse(&name) else {
        let extension = output.extension().unwrap_or_default().display();
        let message = format!(
            "'{name}' has no place for the number of an archive: %06d.{extension}, for example"
        );
        return Err(Failure::Usage(message));
    };
    let folder = output.parent().filter(|it| !it.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new(".")).to_owned();
    Ok(Place {
        folder: folder.clone(),
        archive: Some(ArchiveName {
            name: numbered,
            folder,
            format,
        }),
    })
}

impl Place {
    /// Keeps the text of the data set in its folder. A folder that holds another data set is refused.
    pub(super) fn keep_spec(&self, set: &Dataset, checks: bool) -> Result<(), Failure> {
        let path = self.folder.join("dataset.yaml");
        match fs::read(&path) {
            Ok(text) if text == set.text().as_bytes() => Ok(()),
            Ok(_) => {
                let message = format!("{} holds another data set", output::called(&self.folder));
                Err(anyhow!("{message}: {} differs from the file", output::called(&path)).into())
            }
            Err(_) if checks => {
                Err(anyhow!("{} holds no data set", output::called(&self.folder)).into())
            }
            Err(_) => {
                output::make_folder(&self.folder)?;
                write_file(&path, set.text().as_bytes())
            }
        }
    }
}

/// Writes a file that appears whole.
pub(super) fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let mut file = OutputFile::create(path)?;
    file.write_all(bytes)
        .map_err(|error| output::failed(error, path))?;
    Ok(file.finish()?)
}

/// Name of a file of a part of the work.
pub(super) fn part_name(name: &str, extension: &str, shard: Shard) -> String {
    match shard {
        Shard { count: 1, .. } => format!("{name}.{extension}"),
        Shard { number, count } => format!("{name}-{number}-of-{count}.{extension}"),
    }
}

/// Writes the pictures of a range, or compares them.
pub(super) fn write(
    job: &Job<'_>,
    folder: &Path,
    range: Range<u64>,
    shard: Shard,
) -> Result<Tally, Failure> {
    let set = job.set;
    if !job.checks && range.start < range.end {
        let [first, last] = [set.place(range.start)?, set.place(range.end - 1)?];
        for category in first.0..=last.0 {
            output::make_folder(&folder.join(set.category(category)?.name()))?;
        }
    }
    let path_of = |index: u64| -> Result<PathBuf, Failure> {
        let (category, instance) = set.place(index)?;
        let name = set.category(category)?.name();
        Ok(folder.join(name).join(format!("{instance:06}.png")))
    };
    let mut tally = Tally::default();
    let mut labels = String::new();
    job.each(
        range,
        |index| {
            let path = path_of(index)?;
            let written = fs::read(&path).ok().filter(|bytes| !bytes.is_empty());
            if job.checks {
                let png = set.example(index)?.picture.into_png();
                let is_wrong = written.is_none_or(|written| written != png);
                return Ok((png, String::new(), is_wrong.then_some(path)));
            }
            let (png, label) = match written {
                Some(png) => (png, set.label(index)?),
                None => {
                    let example = set.example(index)?;
                    let png = example.picture.into_png();
                    write_file(&path, &png)?;
                    (png, example.label)
                }
            };
            Ok((png, LabelRow::new(set, index, &label)?.json()?, None))
        },
        |_, (png, label, wrong)| {
            tally.add(&png);
            labels.push_str(&label);
            if !label.is_empty() {
                labels.push('\n');
            }
            tally
                .wrong
                .extend(wrong.map(|path| path.display().to_string()));
            Ok(())
        },
    )?;
    if !job.checks {
        let name = part_name("labels", "jsonl", shard);
        write_file(&folder.join(name), labels.as_bytes())?;
    }
    Ok(tally)
}
