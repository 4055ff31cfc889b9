//! Input files of a process, which its output must not replace.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::catalogue::Catalogue;
use crate::diagnostic::{Diagnostics, Source};
use crate::document::Document;

/// Canonical paths of the files that have been read.
static READ: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// Records that a file is read; `-` is the file that standard input is redirected from, where that is known.
pub(super) fn note(path: &Path) {
    let path = match path == Path::new("-") {
        true => Path::new("/dev/stdin"),
        false => path,
    };
    // A file without a path cannot be replaced.
    if let Ok(path) = fs::canonicalize(path) {
        let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
        read.insert(path);
    }
}

/// Reads a document from a text, and records all files that it consists of.
pub(super) fn document(
    source: &Arc<Source>,
    catalogue: &Catalogue,
) -> Result<Document, Diagnostics> {
    let document = Document::read(source, catalogue)?;
    document.paths().into_iter().for_each(note);
    Ok(document)
}

/// Returns an error if the file at `path` has been read.
pub(super) fn check_is_not_read(path: &Path) -> anyhow::Result<()> {
    let read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if fs::canonicalize(path).is_ok_and(|path| read.contains(&path)) {
        anyhow::bail!(
            "'{}' is an input file and would be overwritten by the output: write to another file",
            path.display()
        );
    }
    Ok(())
}
