//! Files that appear whole or not at all.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use anyhow::Context;
use serde::Serialize;

use crate::grow::Progress;

use super::part::Part;
use super::{Failure, input, progress};

/// Where a command writes.
pub(super) enum Output {
    /// Standard output, which cannot promise to be whole.
    Standard(BufWriter<io::StdoutLock<'static>>),
    /// A file under another name until it is finished.
    File {
        part: BufWriter<Part>,
        path: PathBuf,
    },
    /// A pipe or device, written as it is.
    Device {
        file: BufWriter<File>,
        path: PathBuf,
    },
}

/// What is said if standard output fails.
pub(super) const NO_STANDARD_OUTPUT: &str = "standard output cannot be written";

/// Bytes that are handed to the system at once.
const BUFFER: usize = 1 << 18;

impl Output {
    /// Opens `-`, a device or a file that is to be made or replaced.
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
            // The name of the temporary file would only confuse.
            .map_err(|error| io::Error::from(error.kind()))
            .with_context(failed)?;
        Ok(Self::File {
            part: BufWriter::with_capacity(BUFFER, part),
            path,
        })
    }

    /// Whether a file is made; what stands behind a pipe or device may be the terminal.
    fn is_file(&self) -> bool {
        matches!(self, Self::File { .. })
    }

    /// Finishes: the file appears under its name. Without this it is removed.
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

/// The file that a link leads to, whether it is there or not: the link stays one.
fn behind_links(named: &Path) -> anyhow::Result<PathBuf> {
    const MOST_LINKS: usize = 40;
    let mut path = named.to_path_buf();
    for _ in 0..MOST_LINKS {
        let Ok(target) = path.read_link() else {
            return Ok(path);
        };
        // A relative target starts from the link's folder.
        path = path
            .parent()
            .map_or_else(|| target.clone(), |folder| folder.join(&target));
    }
    anyhow::bail!(
        "'{}' is a link that leads to no file, but round in a circle",
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

/// Writes a file as a whole, or nothing; tells the number of bytes. How far the work is, is shown on
/// a terminal, unless `quiet`.
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

/// Makes a folder, and those that it lies in, where they are not there.
pub(super) fn make_folder(folder: &Path) -> anyhow::Result<()> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("the folder '{}' cannot be made", folder.display()))
}

/// That a path cannot be written.
pub(super) fn failed(error: io::Error, path: &Path) -> Failure {
    let message = if path == Path::new("-") {
        NO_STANDARD_OUTPUT.into()
    } else {
        format!("'{}' cannot be written", path.display())
    };
    anyhow::Error::new(error).context(message).into()
}

/// An output, as messages call it.
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

/// Prints something as JSON, as it is written: it may be long.
pub(super) fn print_json(value: &impl Serialize) -> anyhow::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    let written = serde_json::to_writer_pretty(&mut out, value).map_err(io::Error::from);
    written
        .and_then(|()| out.write_all(b"\n"))
        .and_then(|()| out.flush())
        .context(NO_STANDARD_OUTPUT)
}

/// Counts the bytes that pass.
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
