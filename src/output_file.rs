//! Output files, which appear complete or not at all, and pipes and devices, which are written directly.
//!
//! Files are written to their final folder under a temporary name, and renamed when complete. A process that is
//! killed cannot remove its file. Unfinished files are locked, and a lock ends with the process that holds it: a
//! file without a lock is abandoned, and the next process that writes to the folder removes it. A process that
//! handles signals removes [unfinished] files itself.
//!
//! Large files are brought to the disk while more is written, so that their end does not wait for all of it.

use std::collections::BTreeSet;
use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Write};
#[cfg(feature = "cli")]
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};

const PREFIX: &str = ".kfrac-";
const SUFFIX: &str = ".part";

/// Size of the write buffer in bytes.
pub(crate) const BUFFER: usize = 1 << 18;

/// Number of bytes after which the system is asked to bring a file to the disk while more is written.
const SYNCED: u64 = 1 << 24;

/// Error of writing a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The folder of the file does not exist.
    #[error("there is no folder '{}'", .0.display())]
    NoFolder(PathBuf),
    /// There is a folder of this name.
    #[error("'{}' is a folder", .0.display())]
    IsFolder(PathBuf),
    /// Symbolic links lead back to themselves.
    #[error("'{}' is a symbolic link that leads back to itself", .0.display())]
    LinkLoop(PathBuf),
    /// The file system refuses.
    #[error("'{}' cannot be written: {error}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The reason.
        #[source]
        error: io::Error,
    },
}

/// File that is written. It is removed if it is dropped before it is finished.
pub(crate) struct OutputFile {
    file: BufWriter<File>,
    /// Name of the finished file, or of the device.
    path: PathBuf,
    /// Temporary name, until the file is finished; `None` for a pipe or device.
    part: Option<PathBuf>,
    /// Bytes that were written since the last synchronization began.
    unsynced: u64,
    /// Synchronization in progress.
    sync: Option<JoinHandle<io::Result<()>>>,
}

impl OutputFile {
    /// Creates or replaces a file, or opens a pipe or device. A symbolic link is kept, and its target replaced.
    pub(crate) fn create(named: &Path) -> Result<Self, WriteError> {
        let failed = |error| WriteError::Io {
            path: named.into(),
            error,
        };
        let metadata = named.metadata().ok();
        let names_folder = named.to_string_lossy().ends_with(std::path::is_separator);
        if metadata.is_none() && names_folder {
            return Err(WriteError::NoFolder(named.into()));
        }
        if metadata.as_ref().is_some_and(fs::Metadata::is_dir) {
            return Err(WriteError::IsFolder(named.into()));
        }
        if metadata.as_ref().is_some_and(|it| !it.is_file()) {
            let device = File::options().write(true).open(named).map_err(failed)?;
            return Ok(Self {
                file: BufWriter::with_capacity(BUFFER, device),
                path: named.into(),
                part: None,
                unsynced: 0,
                sync: None,
            });
        }
        let path = behind_links(named)?;
        let folder = match path.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        if !folder.exists() {
            return Err(WriteError::NoFolder(folder.into()));
        }
        let permissions = metadata.map(|metadata| metadata.permissions());
        Self::begin(folder, &path, permissions).map_err(|error| failed(error.kind().into()))
    }

    /// Creates a file for a while: it never appears under a name of its own.
    #[cfg(feature = "cli")]
    pub(crate) fn temporary() -> io::Result<Self> {
        Self::begin(&std::env::temp_dir(), Path::new(""), None)
    }

    /// Reads bytes that have been written, from a place on.
    #[cfg(feature = "cli")]
    pub(crate) fn read_at(&mut self, place: u64, bytes: &mut [u8]) -> io::Result<()> {
        // The buffer is empty after the move.
        self.file.seek(SeekFrom::Start(place))?;
        self.file.get_mut().read_exact(bytes)
    }

    /// Begins a file, with the permissions of the one that it replaces.
    fn begin(folder: &Path, path: &Path, permissions: Option<Permissions>) -> io::Result<Self> {
        remove_abandoned(folder);
        let file = loop {
            let file = Self::locked(folder, path)?;
            // Between its creation and its lock, another process may have removed it as abandoned.
            if file.part.as_ref().is_some_and(|part| part.exists()) {
                break file;
            }
        };
        if let Some(permissions) = permissions {
            // Whoever could not read the old file must not be able to read the new one.
            file.file.get_ref().set_permissions(permissions)?;
        }
        Ok(file)
    }

    fn locked(folder: &Path, path: &Path) -> io::Result<Self> {
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        let mut unfinished = unfinished();
        let (file, part) = loop {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let name = format!("{PREFIX}{}-{number}{SUFFIX}", std::process::id());
            let part = folder.join(name);
            let mut options = File::options();
            match options.read(true).write(true).create_new(true).open(&part) {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                file => break (file?, part),
            }
        };
        unfinished.push(part.clone());
        // Some file systems have no locks; abandoned files are kept there.
        let _ = file.lock();
        Ok(Self {
            file: BufWriter::with_capacity(BUFFER, file),
            path: path.into(),
            part: Some(part),
            unsynced: 0,
            sync: None,
        })
    }

    /// Returns whether the output is a regular file. A pipe or device may be the terminal.
    #[cfg(feature = "cli")]
    pub(crate) fn is_regular(&self) -> bool {
        self.part.is_some()
    }

    /// Finishes the output: a file appears under its name, once all of it is on the disk.
    pub(crate) fn finish(mut self) -> Result<(), WriteError> {
        self.complete().map_err(|error| WriteError::Io {
            path: self.path.clone(),
            error,
        })
    }

    fn complete(&mut self) -> io::Result<()> {
        self.file.flush()?;
        if self.part.is_none() {
            return Ok(());
        }
        self.end_sync()?;
        synced(self.file.get_ref().sync_all())?;
        let mut unfinished = unfinished();
        if let Some(part) = &self.part {
            fs::rename(part, &self.path)?;
            unfinished.retain(|file| file != part);
        }
        self.part = None;
        Ok(())
    }

    /// Begins to bring large files to the disk before they are finished, beside the work that produces the rest.
    fn sync_early(&mut self, written: usize) -> io::Result<()> {
        self.unsynced += written as u64;
        let is_busy = self.sync.as_ref().is_some_and(|sync| !sync.is_finished());
        // Pipes and devices have no disk, and a file without a name need not last.
        let is_kept = self.part.is_some() && self.path != Path::new("");
        if self.unsynced < SYNCED || is_busy || !is_kept {
            return Ok(());
        }
        self.end_sync()?;
        self.unsynced = 0;
        // Without a further handle or thread, the file is synchronized when it is finished.
        if let Ok(file) = self.file.get_ref().try_clone() {
            let begun = thread::Builder::new().spawn(move || synced(file.sync_data()));
            self.sync = begun.ok();
        }
        Ok(())
    }

    /// Waits for the synchronization in progress. An error of the disk is reported to it alone.
    fn end_sync(&mut self) -> io::Result<()> {
        match self.sync.take().map(JoinHandle::join) {
            Some(Ok(result)) => result,
            Some(Err(panic)) => std::panic::resume_unwind(panic),
            None => Ok(()),
        }
    }
}

impl Drop for OutputFile {
    fn drop(&mut self) {
        if let Some(part) = &self.part {
            let mut unfinished = unfinished();
            // Nothing is left to be done about a file that cannot be removed.
            let _ = fs::remove_file(part);
            unfinished.retain(|file| file != part);
        }
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.sync_early(written)?;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Returns the result of a synchronization, which some file systems do not support.
fn synced(result: io::Result<()>) -> io::Result<()> {
    result.or_else(|error| match error.kind() {
        io::ErrorKind::Unsupported | io::ErrorKind::InvalidInput => Ok(()),
        _ => Err(error),
    })
}

/// Locks the list of unfinished files. While the lock is held, files are neither created, nor renamed, nor removed.
pub(crate) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Returns the file that a symbolic link resolves to, which need not exist.
pub(crate) fn behind_links(named: &Path) -> Result<PathBuf, WriteError> {
    const MAX_LINKS: usize = 40;
    let mut path = named.to_path_buf();
    for _ in 0..MAX_LINKS {
        let Ok(target) = path.read_link() else {
            return Ok(path);
        };
        // A relative target is relative to the link's folder.
        path = path
            .parent()
            .map_or_else(|| target.clone(), |folder| folder.join(&target));
    }
    Err(WriteError::LinkLoop(named.into()))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_files_are_whole_and_leave_nothing_beside_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("large");
        let block: Vec<u8> = (0..=u8::MAX).cycle().take(1 << 20).collect();
        let blocks = 3 * SYNCED / block.len() as u64;
        let write = || {
            let mut file = OutputFile::create(&path).unwrap();
            (0..blocks).for_each(|_| file.write_all(&block).unwrap());
            assert!(file.sync.is_some());
            file
        };
        drop(write());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        write().finish().unwrap();
        assert_eq!(
            fs::read(&path).unwrap(),
            block.repeat(usize::try_from(blocks).unwrap())
        );
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    }
}
