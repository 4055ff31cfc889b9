//! Files of Fractint, a program of the years from 1988: L-systems (`.l`) and systems of maps (`.ifs`).
//!
//! A file has many entries, `Name { … }`, with comments from a semicolon to the end of a line. Each becomes a
//! document of its own. Parts of an entry that cannot be converted are reported with their places, and the
//! other entries are read regardless.

mod commands;
mod entries;
pub(super) mod lsystem;
pub(super) mod maps;
mod palette;

use std::sync::Arc;

use crate::build::written::Entries;
use crate::diagnostic::{Diagnostics, Source};

use super::Imported;
use super::document::Heading;
use entries::Entry;

/// Reads the entries of a file, in its order, with the converter of its kind; the diagnostics report text that belongs to
/// no entry.
pub(super) fn read(
    source: &Arc<Source>,
    write: fn(&Entry, &mut Diagnostics) -> Option<Entries>,
) -> (Vec<Imported>, Diagnostics) {
    let mut stray = Diagnostics::default();
    let entries = entries::of(source, &mut stray);
    let imported = entries.iter().map(|entry| {
        let mut found = entry.found.clone();
        let own = write(entry, &mut found);
        let heading = Heading {
            name: &entry.name,
            place: &entry.place,
            about: &entry.comment(),
            origin: "for Fractint",
        };
        heading.imported(own, found)
    });
    (imported.collect(), stray)
}

#[cfg(test)]
mod tests;
