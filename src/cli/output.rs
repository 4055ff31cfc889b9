//! Output to files that appear complete or not at all, to pipes, devices and standard output.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;
use serde::Serialize;

use crate::grow::Progress;

use super::part::Part;
use super::{Failure, input, progress};

/// Destination of the output of a command.
pub(super) enum Output {
    /// Standard output, which may be left incomplete.
    Standard(BufWriter<io::StdoutLock<'static>>),
    /// File that has a temporary name until it is finished.
    File {
        part: BufWriter<Part>,
        path: PathBuf,
    },
    /// Pipe or device, written directly.
    Device {
        file: BufWriter<File>,
        path: PathBuf,
    },
}

/// Message for a failure to write to standard output.
pub(super) const NO_STANDARD_OUTPUT: &str = "standard output cannot be written";

/// Size of the write buffer in bytes.
const BUFFER: usize = 1 << 18;

impl Output {
    /// Opens an output: standard output for `-`, a pipe or device, or a file that is created or replaced.
    pub(super) fn create(path: &Path) -> anyhow::Result<Self> {
        if path == Path::new("-") {
            return Ok(Self::Standard(BufWriter::with_capacity(
                BUFFER,
                io::stdout().lock(),
            )));
        }
        let failed = || format!("'{}' cannot be written", path.display());
        let metadata = path.metadata().ok();
        let names_folder = path.to_string_lossy().ends_with(std::path::is_separator);
        if metadata.is_none() && names_folder {
            anyhow::bail!("there is no folder '{}'", path.display());
        }
        if metadata.as_ref().is_some_and(std::fs::Metadata::is_dir) {
            anyhow::bail!("'{}' is a folder", path.display());
        }
        if metadata
            .as_ref()
            .is_some_and(|metadata| !metadata.is_file())
        {
            let device = File::options()
                .write(true)
                .open(path)
                .with_context(failed)?;
            let file = BufWriter::with_capacity(BUFFER, device);
            return Ok(Self::Device {
                file,
                path: path.to_path_buf(),
            });
        }
        let path = behind_links(path)?;
        input::check_is_not_read(&path)?;
        let folder = match path.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        if !folder.exists() {
            anyhow::bail!("there is no folder '{}'", folder.display());
        }
        let part = Part::begin(folder, metadata.map(|metadata| metadata.permissions()))
            // The name of the temporary file in the error would be confusing.
            .map_err(|error| io::Error::from(error.kind()))
            .with_context(failed)?;
        Ok(Self::File {
            part: BufWriter::with_capacity(BUFFER, part),
            path,
        })
    }

    /// Returns whether the output is a regular file. A pipe or device may be the terminal.
    fn is_file(&self) -> bool {
        matches!(self, Self::File { .. })
    }

    /// Finishes the output: a file appears under its name. A file that is dropped without this is removed.
    pub(super) fn finish(self) -> anyhow::Result<()> {
        match self {
            Self::Standard(mut out) => out.flush().context(NO_STANDARD_OUTPUT)?,
            Self::Device { mut file, path } => file
                .flush()
                .with_context(|| format!("'{}' cannot be written", path.display()))?,
            Self::File { part, path } => part
                .into_inner()
                .map_err(io::IntoInnerError::into_error)
                .and_then(|part| part.finish(&path))
                .with_context(|| format!("'{}' cannot be written", path.display()))?,
        }
        Ok(())
    }
}

/// Returns the file that a symbolic link resolves to, which need not exist: the link itself is kept.
fn behind_links(named: &Path) -> anyhow::Result<PathBuf> {
    const MOST_LINKS: usize = 40;
    let mut path = named.to_path_buf();
    for _ in 0..MOST_LINKS {
        let Ok(target) = path.read_link() else {
            return Ok(path);
        };
        // A relative target is relative to the link's folder.
        path = path
            .parent()
            .map_or_else(|| target.clone(), |folder| folder.join(&target));
    }
    anyhow::bail!(
        "'{}' is a symbolic link that leads back to itself",
        named.display()
    )
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Standard(out) => out.write(bytes),
            Self::File { part, .. } => part.write(bytes),
            Self::Device { file, .. } => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Standard(out) => out.flush(),
            Self::File { part, .. } => part.flush(),
            Self::Device { file, .. } => file.flush(),
        }
    }
}

/// Writes a file completely or not at all, and returns its size in bytes. Progress is shown on a terminal,
/// unless `quiet`.
pub(super) fn write<T>(
    path: &Path,
    quiet: bool,
    content: impl FnOnce(&mut Counted<Output>, Option<&Progress>) -> Result<T, Failure>,
) -> Result<(T, u64), Failure> {
    let mut out = Counted {
        inner: Output::create(path)?,
        bytes: 0,
    };
    let shows_progress = !quiet && out.inner.is_file();
    let told = progress::watched(shows_progress, |progress| content(&mut out, progress))?;
    out.inner.finish()?;
    Ok((told, out.bytes))
}

/// Creates a folder and its missing parents.
pub(super) fn make_folder(folder: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("the folder '{}' cannot be created", folder.display()))
}

/// Returns the failure to write to `path`.
pub(super) fn failed(error: io::Error, path: &Path) -> Failure {
    let message = if path == Path::new("-") {
        NO_STANDARD_OUTPUT.into()
    } else {
        format!("'{}' cannot be written", path.display())
    };
    anyhow::Error::new(error).context(message).into()
}

/// Returns the name of an output in messages.
pub(super) fn called(path: &Path) -> String {
    if path == Path::new("-") {
        "standard output".into()
    } else {
        path.display().to_string()
    }
}

/// Writes a text to standard output.
pub(super) fn print(text: &str) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .context(NO_STANDARD_OUTPUT)
}

/// Prints a value as JSON to standard output. The text is streamed, because it may be long.
pub(super) fn print_json(value: &impl Serialize) -> anyhow::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    let written = serde_json::to_writer_pretty(&mut out, value).map_err(io::Error::from);
    written
        .and_then(|()| out.write_all(b"\n"))
        .and_then(|()| out.flush())
        .context(NO_STANDARD_OUTPUT)
}

/// Writer that counts bytes.
pub(super) struct Counted<W> {
    inner: W,
    bytes: u64,
}

impl<W: Write> Write for Counted<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.inner.write(bytes)?;
        self.bytes += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}
