//! `kfrac import`: converts files of other programs.

use std::collections::BTreeSet;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::ValueHint;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use serde::Serialize;

use crate::catalogue::{cannot_be_read, open_file};
use crate::diagnostic::{Diagnostic, Diagnostics, Source, listed};
use crate::import::{ImportOptions, Imported, MapColumns, SourceFormat, read};
use crate::style::Named as _;

use super::check::{DiagnosticRow, row};
use super::{Failure, help, input, output, text};

/// Converts files of other programs to files that kfrac can grow
///
/// Each entry of a file becomes a YAML file of the same name; a table of maps is one entry with the name of its file.
/// Constructs without a counterpart are reported for each entry with their lines, and an entry that cannot be converted to
/// the same set is not written. The exit status is 1 if an entry is not written.
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Files to convert, or - for standard input
    #[arg(value_name = "FILE", required = true, value_hint = ValueHint::FilePath)]
    sources: Vec<PathBuf>,
    /// Format of the files, by default that of the extension of each
    #[arg(long, value_name = "FORMAT", value_parser = format())]
    from: Option<SourceFormat>,
    /// Columns of tables of maps, by letters, such as abcdefp
    ///
    /// Each letter stands for a number of a map: x' = a x + b y + e, y' = c x + d y + f, in space x' = a x + b y + c z + j,
    /// y' = d x + e y + f z + k, z' = g x + h y + i z + l, and p for its probability; - is a column that is left out. acbdef
    /// is the order of SVG and flam3, abecdf that of x' before y'. By default the header of a table names its columns, in any
    /// order.
    #[arg(long, value_name = "LETTERS", allow_hyphen_values = true)]
    columns: Option<MapColumns>,
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
  kfrac import tiles.aifs -o tiles
      Converts every set of IFStile's format: a system, or a structure where sets refer to each other
  kfrac import curves.json --from genes
      Converts genes of plane-filling curves on square and triangular lattices to rules
  kfrac import tower.es
      Converts a program of Structure Synth to a structure in space, whose random choices are drawn once
  kfrac import maple.txt --from csv --columns abecdfp
      Reads a row of a table as the coefficients of x', those of y', and a probability
";

fn format() -> impl TypedValueParser<Value = SourceFormat> {
    let formats = SourceFormat::NAMES.iter();
    let formats = formats.map(|(name, format)| PossibleValue::new(*name).help(format.described()));
    PossibleValuesParser::new(formats)
        .try_map(|name| SourceFormat::from_name(&name).ok_or("unknown"))
}

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
    let options = ImportOptions::default();
    let options = match &arguments.columns {
        Some(columns) => options.columns(columns.clone()),
        None => options,
    };
    let mut all_written = true;
    let mut rows = Vec::new();
    for path in &arguments.sources {
        let format = format_of(path, arguments)?;
        let source = open(path)?;
        let (entries, stray) = read(&source, format, &options);
        if stray.has_errors() && entries.is_empty() {
            return Err(stray.into());
        }
        if entries.is_empty() {
            let message = format!("'{}' has no entries", source.name());
            let hint = format!("an entry is {}", format.example());
            return Err(Diagnostic::error(message).hint(hint).into());
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
            report(source.name(), &reports, &arguments.output);
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
fn report(name: &str, reports: &[Entry], folder: &Path) {
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
    let folder = folder.display();
    text::print_message(&format!(
        "{name}: {}{of} written to {folder}",
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

/// Returns the format of a file: that of the arguments, or that of its extension.
fn format_of(path: &Path, arguments: &Arguments) -> Result<SourceFormat, Failure> {
    let format = arguments.from.or_else(|| SourceFormat::of_path(path));
    let format = format.ok_or_else(|| {
        let name = match path == Path::new("-") {
            true => "standard input".into(),
            false => format!("'{}'", path.display()),
        };
        let names = listed(SourceFormat::NAMES.iter().map(|(name, _)| *name));
        Failure::Usage(format!(
            "the format of {name} is not known: --from is one of {names}"
        ))
    })?;
    if arguments.columns.is_some() && format != SourceFormat::Csv {
        let message = format!(
            "--columns is for tables of maps, not for {}",
            format.described()
        );
        return Err(Failure::Usage(message));
    }
    Ok(format)
}

/// Returns the text of a file, or of standard input.
fn open(path: &Path) -> Result<Arc<Source>, Failure> {
    input::note(path);
    let is_standard_input = path == Path::new("-");
    let input: Box<dyn io::Read> = match is_standard_input {
        true => Box::new(io::stdin().lock()),
        false => Box::new(open_file(path)?),
    };
    let mut bytes = Vec::new();
    let read = input
        .take(Source::MAX_BYTES as u64 + 1)
        .read_to_end(&mut bytes);
    read.map_err(|error| cannot_be_read(path, &error))?;
    // Files may be older than UTF-8: other bytes are read as Latin-1.
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
    Ok(match is_standard_input {
        true => Source::read("<stdin>", bytes)?,
        false => Source::read_file(path, bytes)?,
    })
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
