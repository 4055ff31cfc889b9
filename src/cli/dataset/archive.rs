//! Data sets as archives for WebDataset.

use std::fs;
use std::io::Cursor;
use std::ops::Range;

use anyhow::Context;

use super::super::{Failure, output};
use super::folder::{ArchiveName, write_file};
use super::manifest::{LabelRow, Tally};
use super::{Job, Shard};

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
        let written = fs::read(&path).ok();
        if let Some(written) = written.as_ref().filter(|_| !job.checks) {
            for png in pictures_of(written).with_context(|| output::called(&path))? {
                tally.add(&png);
            }
            continue;
        }
        let bytes = made(job, pictures, &mut tally)?;
        match job.checks {
            true if written.is_none_or(|written| written != bytes) => {
                tally.wrong.push(path.display().to_string());
            }
            true => {}
            false => write_file(&path, &bytes)?,
        }
    }
    Ok((
        (own.start * size).min(len)..(own.end * size).min(len),
        tally,
    ))
}

/// Returns the bytes of an archive.
fn made(job: &Job<'_>, pictures: Range<u64>, tally: &mut Tally) -> Result<Vec<u8>, Failure> {
    let set = job.set;
    let mut archive = tar::Builder::new(Vec::new());
    job.each(
        pictures,
        |index| {
            let example = set.example(index)?;
            let label = LabelRow::new(set, index, &example.label)?.json()?;
            let key = format!("{:05}_{:06}", example.category, example.instance);
            Ok((key, example.category, example.picture.into_png(), label))
        },
        |_, (key, category, png, label)| {
            tally.add(&png);
            let files = [
                ("png", png.as_slice()),
                ("cls", category.to_string().as_bytes()),
                ("json", label.as_bytes()),
            ]
            .map(|(extension, bytes)| (format!("{key}.{extension}"), bytes.to_vec()));
            for (name, bytes) in files {
                let mut header = tar::Header::new_ustar();
                header.set_size(bytes.len() as u64);
                header.set_mode(0o644);
                header.set_mtime(0);
                header.set_entry_type(tar::EntryType::Regular);
                archive.append_data(&mut header, name, bytes.as_slice())?;
            }
            Ok(())
        },
    )?;
    Ok(archive.into_inner()?)
}

/// Returns the pictures of an archive.
fn pictures_of(bytes: &[u8]) -> anyhow::Result<Vec<Vec<u8>>> {
    let mut archive = tar::Archive::new(Cursor::new(bytes));
    let mut pictures = Vec::new();
    for entry in archive.entries()? {
        let mut entry = entry?;
        if entry.path()?.extension().is_some_and(|it| it == "png") {
            let mut png = Vec::new();
            std::io::Read::read_to_end(&mut entry, &mut png)?;
            pictures.push(png);
        }
    }
    Ok(pictures)
}
