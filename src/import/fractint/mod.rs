//! Files of Fractint, a program of the years from 1988: L-systems (`.l`) and systems of maps (`.ifs`).
//!
//! A file has many entries, `Name { … }`, with comments from a semicolon to the end of a line. Each
//! becomes a file of its own. What an entry says that cannot be told is named, with its place, and
//! the others are read all the same.

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

/// What the entries of a file are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fractint {
    /// L-systems, files that end in `.l`.
    LSystems,
    /// Systems of affine maps of the plane, files that end in `.ifs`.
    Ifs,
}

/// An entry that has been looked at.
#[derive(Clone, Debug)]
pub struct Imported {
    /// Its name in the file.
    pub name: String,
    /// The same as a file of ours; `None` if it could not be written.
    pub document: Option<Document>,
    /// What could not be read, or is not the same: errors where there is no document.
    pub found: Diagnostics,
}

/// The entries of a file, in its order, and what stands between them that is none.
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

/// The file with what is said of the entry, read back.
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
            // Their places are in a text that nobody sees.
            let said = mistakes.iter().map(|mistake| {
                let here = Diagnostic::error(mistake.message()).at(&entry.place);
                mistake
                    .hint_text()
                    .iter()
                    .fold(here, |here, hint| here.hint(*hint))
            });
            found.extend(said);
            None
        }
    }
}

#[cfg(test)]
mod tests;
