//! `kfrac import`: converts files of Fractint.

use std::collections::BTreeSet;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::ValueHint;
use serde::Serialize;

use crate::catalogue::{cannot_be_read, open_file};
use crate::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::import::{Fractint, Imported, read_fractint};

use super::check::{DiagnosticRow, row};
use super::{Failure, help, output, text};

/// Converts the entries of Fractint files to files that kfrac can grow
///
/// An L-system file (.l) or a file of systems of maps, of the plane or (3D) of space (.ifs), has many entries, each of which
/// becomes a YAML file of the same name. Unsupported constructs are reported for each entry, and an entry
/// that cannot be converted faithfully is not written. The exit status is 1 if an entry is not written.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Fractint files, with the extension .l or .ifs
    #[arg(value_name = "FILE", required = true, value_hint = ValueHint::FilePath)]
    sources: Vec<PathBuf>,
    /// Output folder, which is created if necessary
    #[arg(long, short, value_name = "FOLDER", default_value = ".", value_hint = ValueHint::DirPath)]
    output: PathBuf,
    /// Replaces existing files
    #[arg(long)]
    force: bool,
    /// Prints the result for every entry as JSON
    #[arg(long)]
    json: bool,
}

const MORE: &str = "\
Examples:
  kfrac import fractint.l -o curves
      Converts every L-system of a file, and reports the entries that are not supported
  kfrac import *.ifs
      Converts several files of systems of maps, into the current folder
";

/// Result for an entry, or for the text between entries.
#[derive(Serialize)]
struct Report<'a> {
    entry: Option<&'a str>,
    file: Option<String>,
    found: Vec<DiagnosticRow<'a>>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut written = Written {
        folder: &arguments.output,
        force: arguments.force,
        names: BTreeSet::new(),
    };
    let mut all_written = true;
    let mut rows = Vec::new();
    for path in &arguments.sources {
        let (source, kind) = open(path)?;
        let (entries, stray) = read_fractint(&source, kind);
        if entries.is_empty() {
            let message = format!("'{}' has no entries", path.display());
            return Err(Diagnostic::error(message)
                .hint("an entry is Name { ... }")
                .into());
        }
        let mut reports = vec![(None, None, stray)];
        for Imported {
            name,
            document,
            mut found,
        } in entries
        {
            let file = match document {
                Some(document) => written.write(&name, &document.to_yaml(), &mut found)?,
                None => None,
            };
            all_written &= file.is_some();
            reports.push((Some(name), file, found));
        }
        if arguments.json {
            rows.extend(reports);
        } else {
            report(path, &reports, &arguments.output);
        }
    }
    if arguments.json {
        let reports = rows.iter().map(|(entry, file, found)| Report {
            entry: entry.as_deref(),
            file: file
                .as_ref()
                .map(|file: &PathBuf| file.display().to_string()),
            found: found.iter().map(|found| row("", found)).collect(),
        });
        let reports = reports.filter(|report| report.entry.is_some() || !report.found.is_empty());
        output::print_json(&reports.collect::<Vec<_>>())?;
    }
    if all_written {
        Ok(())
    } else {
        Err(Failure::Reported)
    }
}

type Entry = (Option<String>, Option<PathBuf>, Diagnostics);

/// Prints the diagnostics of a file and the number of entries that were written.
fn report(path: &Path, reports: &[Entry], folder: &Path) {
    // Each entry is reported separately, because a list of diagnostics is abbreviated after its first ones.
    for (_, _, found) in reports.iter().filter(|(_, _, found)| !found.is_empty()) {
        text::print_diagnostics(found);
    }
    let entries = reports.iter().filter(|(name, ..)| name.is_some());
    let (written, left): (Vec<&Entry>, Vec<&Entry>) =
        entries.partition(|(_, file, _)| file.is_some());
    let of = match left.len() {
        0 => String::new(),
        _ => format!(" of {}", written.len() + left.len()),
    };
    let (path, folder) = (path.display(), folder.display());
    text::print_message(&format!(
        "{path}: {}{of} written to {folder}",
        written.len()
    ));
    if !left.is_empty() {
        let names: Vec<_> = left
            .iter()
            .filter_map(|(name, ..)| name.as_deref())
            .collect();
        text::print_message(&format!("not written: {}", names.join(", ")));
    }
}

/// Returns the text of a file, and its kind by its extension.
fn open(path: &Path) -> Result<(Arc<Source>, Fractint), Failure> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let kind = match extension.to_str() {
        Some("l") => Fractint::LSystems,
        Some("ifs") => Fractint::Ifs,
        _ => {
            let message = format!("'{}' is neither a .l nor a .ifs file", path.display());
            return Err(Failure::Usage(message));
        }
    };
    let mut bytes = Vec::new();
    let read = open_file(path)?
        .take(Source::MAX_BYTES as u64 + 1)
        .read_to_end(&mut bytes);
    read.map_err(|error| cannot_be_read(path, &error))?;
    // Files of Fractint may be older than UTF-8: other bytes are read as Latin-1.
    if std::str::from_utf8(&bytes).is_err()
        && !bytes.contains(&0)
        && bytes.len() <= Source::MAX_BYTES
    {
        bytes = bytes
            .iter()
            .map(|&byte| char::from(byte))
            .collect::<String>()
            .into_bytes();
    }
    Ok((Source::read_file(path, bytes)?, kind))
}

/// Files that have been written.
struct Written<'a> {
    folder: &'a Path,
    force: bool,
    names: BTreeSet<String>,
}

impl Written<'_> {
    /// Writes the file of an entry, unless it exists and must not be replaced.
    fn write(
        &mut self,
        entry: &str,
        yaml: &str,
        found: &mut Diagnostics,
    ) -> Result<Option<PathBuf>, Failure> {
        let path = self.folder.join(self.name(entry));
        if path.exists() && !self.force {
            let message = format!("'{}' exists: {entry} is not written", path.display());
            found.push(Diagnostic::error(message).hint("--force replaces it"));
            return Ok(None);
        }
        output::make_folder(self.folder)?;
        output::write_text(&path, yaml)?;
        Ok(Some(path))
    }

    /// Returns a unique name for the file of an entry: lower-case letters, digits and dashes.
    fn name(&mut self, entry: &str) -> String {
        let letters = entry
            .chars()
            .map(|c| if c.is_alphanumeric() { c } else { ' ' });
        let words: String = letters.flat_map(char::to_lowercase).collect();
        let mut stem = words.split_whitespace().collect::<Vec<_>>().join("-");
        if stem.is_empty() {
            stem.push_str("unnamed");
        }
        let mut name = format!("{stem}.yaml");
        let mut number = 2;
        while !self.names.insert(name.clone()) {
            name = format!("{stem}-{number}.yaml");
            number += 1;
        }
        name
    }
}
