//! Opening of files outside the library.

use std::fs::{self, File, FileType};
use std::io;
use std::path::Path;

use crate::diagnostic::Diagnostic;

/// Opens a file that has an end: a regular file or a pipe.
///
/// # Errors
///
/// Returns an error if the file does not exist or cannot be opened, or if it is a folder, a device, a
/// terminal or a socket, which may have no end.
pub fn open_file(path: &Path) -> Result<File, Diagnostic> {
    let name = path.display();
    let failed = |error| cannot_be_read(path, &error);
    let kind = fs::metadata(path).map_err(failed)?.file_type();
    if kind.is_dir() {
        return Err(Diagnostic::error(format!("'{name}' is a folder")));
    }
    if !kind.is_file() && !is_pipe(kind) {
        let message = format!("'{name}' is neither a file nor a pipe");
        return Err(Diagnostic::error(message).hint("- reads from standard input"));
    }
    File::open(path).map_err(failed)
}

/// Returns the error for a file that cannot be read.
#[must_use]
pub fn cannot_be_read(path: &Path, error: &io::Error) -> Diagnostic {
    let name = path.display();
    Diagnostic::error(match error.kind() {
        io::ErrorKind::NotFound | io::ErrorKind::NotADirectory => {
            format!("there is no file '{name}'")
        }
        _ => format!("'{name}' cannot be read: {error}"),
    })
}

#[cfg(unix)]
fn is_pipe(kind: FileType) -> bool {
    use std::os::unix::fs::FileTypeExt;
    kind.is_fifo()
}

/// Returns false: other systems have no named pipes in the file system.
#[cfg(not(unix))]
fn is_pipe(_: FileType) -> bool {
    false
}
