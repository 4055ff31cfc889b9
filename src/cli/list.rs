//! `kfrac list`: lists the library.

use std::path::PathBuf;

use clap::ValueHint;
use serde::Serialize;

use crate::catalogue::{Catalogue, LibraryFile, Shelf};
use crate::diagnostic::{Diagnostic, did_you_mean};
use crate::metadata::Description;

use super::{Failure, gallery, help, output};

/// Lists the library: rules and components
#[derive(clap::Args)]
#[command(after_long_help = help::styled(MORE))]
pub(super) struct Arguments {
    /// Lists only entries whose name, title or tags contain this text
    #[arg(value_name = "PATTERN")]
    pattern: Option<String>,
    /// Prints the list as JSON
    #[arg(long)]
    json: bool,
    /// Writes the list as a page with pictures, index.html in a folder, which is made if it is missing
    #[arg(long, value_name = "DIR", conflicts_with = "json", value_hint = ValueHint::DirPath)]
    html: Option<PathBuf>,
}

const MORE: &str = "\
Examples:
  kfrac list
      Lists everything
  kfrac list tree
      Lists the entries with tree in their name, title or tags
  kfrac list --html gallery
      Writes a page with pictures, gallery/index.html
  kfrac list --library rules --json
      Lists the library with the files of a folder, as JSON
";

/// Entry of the library, as it is listed.
#[derive(Clone, Serialize)]
pub(crate) struct ListRow {
    pub(crate) name: String,
    kind: &'static str,
    pub(super) title: Option<String>,
    pub(super) tags: Vec<String>,
    pub(super) source: Option<String>,
    path: String,
}

pub(super) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let entries = catalogue.entries();
    let asked = arguments.pattern.as_deref().unwrap_or_default();
    let pattern = asked.to_lowercase();
    let rows: Vec<_> = entries
        .iter()
        .map(|entry| (entry, row(entry, catalogue)))
        .filter(|(_, row)| row.matches(&pattern))
        .collect();
    if let Some(folder) = &arguments.html
        && !rows.is_empty()
    {
        let entries: Vec<_> = { rows.into_iter() }
            .map(|(entry, row)| (entry.clone(), row))
            .collect();
        return gallery::write(folder, &entries, catalogue);
    }
    if arguments.json {
        let rows: Vec<_> = rows.iter().map(|(_, row)| row).collect();
        return Ok(output::print_json(&rows)?);
    }
    if rows.is_empty() {
        let message = format!("nothing in the library has '{asked}' in its name, title or tags");
        let names = entries.iter().map(|entry| entry.name.as_str());
        let hint = did_you_mean(asked, names);
        return Err(Diagnostic::error(message)
            .hint(hint.unwrap_or_else(|| "`kfrac list` lists all entries".into()))
            .into());
    }
    let wide = rows
        .iter()
        .map(|(_, row)| row.name.chars().count())
        .max()
        .unwrap_or(0);
    let mut text = String::new();
    for shelf in Shelf::all() {
        let mut heading = Some(shelf.folder().replace('_', " "));
        for (_, row) in rows.iter().filter(|(entry, _)| entry.shelf == shelf) {
            if let Some(heading) = heading.take() {
                if !text.is_empty() {
                    text.push('\n');
                }
                text.push_str(&heading);
                text.push('\n');
            }
            let title = row.title.as_deref().unwrap_or_default();
            let line = format!("  {:wide$}  {title}", row.name);
            text.push_str(line.trim_end());
            text.push('\n');
        }
    }
    Ok(output::print(&text)?)
}

/// Returns the row of an entry. A file that cannot be read has its name only; `kfrac check` reports its
/// errors.
pub(crate) fn row(entry: &LibraryFile, catalogue: &Catalogue) -> ListRow {
    let Description {
        title,
        source,
        tags,
        ..
    } = catalogue.description(entry);
    ListRow {
        name: entry.name.clone(),
        kind: entry.shelf.kind(),
        title,
        tags,
        source,
        path: entry
            .path
            .as_ref()
            .map_or("embedded".into(), |path| path.display().to_string()),
    }
}

impl ListRow {
    fn matches(&self, pattern: &str) -> bool {
        let texts = [Some(&self.name), self.title.as_ref()]
            .into_iter()
            .flatten()
            .chain(&self.tags);
        texts
            .into_iter()
            .any(|text| text.to_lowercase().contains(pattern))
    }
}
