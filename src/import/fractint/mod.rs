//! Files of Fractint, a program of the years from 1988: L-systems (`.l`) and systems of maps (`.ifs`).
//!
//! A file has many entries, `Name { … }`, with comments from a semicolon to the end of a line. Each becomes a
//! document of its own. Parts of an entry that cannot be converted are reported with their places, and the
//! other entries are read regardless.

mod commands;
mod entries;
mod lsystem;
mod maps;
mod palette;

use std::sync::Arc;

use crate::build::written::Entries;
use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostic, Diagnostics, Source};
use crate::document::Document;
use crate::document::node::{Node, Value};

use entries::Entry;

/// Kind of the entries in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Fractint {
    /// L-systems, in files with the extension `.l`.
    LSystems,
    /// Systems of affine maps of the plane or of space, in files with the extension `.ifs`.
    Ifs,
}

/// Result of importing an entry.
#[derive(Clone, Debug)]
pub struct Imported {
    /// Name of the entry in its file.
    pub name: String,
    /// The entry as a document of kfrac; `None` if the conversion failed.
    pub document: Option<Document>,
    /// Diagnostics of parts that could not be read or differ; errors if there is no document.
    pub found: Diagnostics,
}

/// Reads the entries of a file, in its order; the diagnostics report text that belongs to no entry.
#[must_use]
pub fn read(source: &Arc<Source>, kind: Fractint) -> (Vec<Imported>, Diagnostics) {
    let mut stray = Diagnostics::default();
    let entries = entries::of(source, &mut stray);
    let imported = entries.iter().map(|entry| import(entry, kind)).collect();
    (imported, stray)
}

fn import(entry: &Entry, kind: Fractint) -> Imported {
    let mut found = entry.found.clone();
    let own = match kind {
        Fractint::LSystems => lsystem::write(entry, &mut found),
        Fractint::Ifs => maps::write(entry, &mut found),
    };
    let own = own.filter(|_| !found.has_errors());
    Imported {
        name: entry.name.clone(),
        document: own.and_then(|own| document(entry, own, &mut found)),
        found,
    }
}

/// Returns the document of an entry, completed with its name, comments and source, and read back.
fn document(entry: &Entry, own: Entries, found: &mut Diagnostics) -> Option<Document> {
    let text = |text: &str| Value::Text(text.into());
    let file = entry.place.source().path().file_name();
    let file = file.map_or_else(String::new, |file| format!(" in {}", file.display()));
    let comment = entry.comment();
    let heading = Entries::default()
        .set("title", text(&entry.name))
        .set_some("about", (!comment.is_empty()).then(|| text(&comment)))
        .set(
            "source",
            text(&format!("{}{file}, for Fractint", entry.name)),
        );
    let written = Node::from(heading.and(own).value()).to_yaml();
    let read = Document::read(&Source::new("(imported)", written), &Catalogue::embedded());
    let checked = read.and_then(|document| document.resolve(&[]).map(|_| document));
    match checked {
        Ok(document) => Some(document),
        Err(mistakes) => {
            // The places of these errors are in a generated text: the entry is reported instead.
            let located = mistakes.iter().map(|mistake| {
                let here = Diagnostic::error(mistake.message()).at(&entry.place);
                mistake
                    .hint_text()
                    .iter()
                    .fold(here, |here, hint| here.hint(*hint))
            });
            found.extend(located);
            None
        }
    }
}

#[cfg(test)]
mod tests;
