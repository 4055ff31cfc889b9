//! Files that are read, and so are not replaced by what is made of them.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostics, Source};
use crate::document::Document;

/// The files that have been read, by paths without links.
static READ: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Notes that a file is read; `-` is the one that standard input comes from, where that is known.
pub(super) fn note(path: &Path) {
    let path = match path == Path::new("-") {
        true => Path::new("/dev/stdin"),
        false => path,
    };
    // What has no path cannot be replaced.
    if let Ok(path) = fs::canonicalize(path) {
        let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
        read.insert(path);
    }
}

/// Reads a rule from a text, and notes all files that it comes from.
pub(super) fn document(
    source: &Arc<Source>,
    catalogue: &Catalogue,
) -> Result<Document, Diagnostics> {
    let document = Document::read(source, catalogue)?;
    document.paths().into_iter().for_each(note);
    Ok(document)
}

/// Refuses to replace a file that has been read.
pub(super) fn check_is_not_read(path: &Path) -> anyhow::Result<()> {
    let read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if fs::canonicalize(path).is_ok_and(|path| read.contains(&path)) {
        anyhow::bail!(
            "'{}' is read here, and would be replaced by what is made of it: write to another file",
            path.display()
        );
    }
    Ok(())
}
