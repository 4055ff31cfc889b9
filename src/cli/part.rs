//! Unfinished files: they are written to their final folder under a temporary name, and renamed when
//! complete.
//!
//! A process that is killed cannot remove its file. Unfinished files are locked, and a lock ends with the
//! process that holds it: a file without a lock is abandoned, and the next process that writes to the folder
//! removes it.

use std::collections::BTreeSet;
use std::fs::{self, File, Permissions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::TempPath;

use super::stop;

const PREFIX: &str = ".kfrac-";
const SUFFIX: &str = ".part";

/// Unfinished file. It is removed if it is dropped before it is finished.
pub(super) struct Part {
    file: File,
    /// Temporary name, until the file is finished.
    path: Option<TempPath>,
}

impl Part {
    /// Creates a file in a folder, with the permissions of the one that it replaces.
    pub(super) fn begin(folder: &Path, permissions: Option<Permissions>) -> io::Result<Self> {
        remove_abandoned(folder);
        let part = loop {
            let part = Self::locked(folder)?;
            // Between its creation and its lock, another process may have removed it as abandoned.
            if part.is_there() {
                break part;
            }
        };
        if let Some(permissions) = permissions {
            // Whoever could not read the old file must not be able to read the new one.
            part.file.set_permissions(permissions)?;
        }
        Ok(part)
    }

    fn locked(folder: &Path) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The mask of the user restricts these permissions, as for any new file.
            builder.permissions(Permissions::from_mode(0o666));
        }
        let mut unfinished = stop::unfinished();
        let (file, path) = builder.tempfile_in(folder)?.into_parts();
        unfinished.begin(&path);
        // Some file systems have no locks; abandoned files are kept there.
        let _ = file.lock();
        Ok(Self {
            file,
            path: Some(path),
        })
    }

    fn is_there(&self) -> bool {
        self.path.as_ref().is_some_and(|path| path.exists())
    }

    /// Finishes the file: it appears under its name, once all of it is on the disk.
    pub(super) fn finish(mut self, path: &Path) -> io::Result<()> {
        match self.file.sync_all() {
            // Some file systems do not support syncing.
            Err(error)
                if !matches!(
                    error.kind(),
                    io::ErrorKind::Unsupported | io::ErrorKind::InvalidInput
                ) =>
            {
                return Err(error);
            }
            _ => {}
        }
        let mut unfinished = stop::unfinished();
        if let Some(part) = self.path.take() {
            let name = part.to_path_buf();
            // A file that cannot be renamed is removed here.
            let renamed = part.persist(path).map_err(|error| error.error);
            unfinished.end(&name);
            renamed?;
        }
        Ok(())
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        if let Some(path) = self.path.take() {
            let mut unfinished = stop::unfinished();
            let name = path.to_path_buf();
            drop(path);
            unfinished.end(&name);
        }
    }
}

impl io::Write for Part {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Removes abandoned files from a folder, once per process.
fn remove_abandoned(folder: &Path) {
    static TIDIED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let mut tidied = TIDIED.lock().unwrap_or_else(PoisonError::into_inner);
    if !tidied.insert(folder.to_path_buf()) {
        return;
    }
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let is_part = name.starts_with(PREFIX) && name.ends_with(SUFFIX);
        if !is_part || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        // On some file systems only a file that may be written can be locked.
        let open = |write| File::options().read(true).write(write).open(entry.path());
        let file = open(true).or_else(|_| open(false));
        if file.is_ok_and(|file| file.try_lock().is_ok()) {
            // A failure to remove it has no consequences.
            let _ = fs::remove_file(entry.path());
        }
    }
}
