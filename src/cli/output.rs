//! Output to files that appear complete or not at all, to pipes, devices and standard output.

use std::io::{self, BufWriter, Write};
use std::path::Path;

use anyhow::{Context, anyhow};
use serde::Serialize;

use crate::grow::Progress;
use crate::output_file::{BUFFER, OutputFile, WriteError, behind_links};
use crate::render::{Remedy, RenderError};

use super::held::Memory;
use super::{Failure, input, progress};

/// Destination of the output of a command.
pub(super) enum Output {
    /// Standard output, which may be left incomplete.
    Standard(BufWriter<io::StdoutLock<'static>>),
    File(OutputFile),
    Memory(Memory),
}

/// Message for a failure to write to standard output.
pub(super) const NO_STANDARD_OUTPUT: &str = "standard output cannot be written";

impl Output {
    /// Opens an output: standard output for `-`, a pipe or device, or a file that is created or replaced.
    pub(super) fn create(path: &Path) -> Result<Self, Failure> {
        if path == Path::new("-") {
            let out = io::stdout().lock();
            return Ok(Self::Standard(BufWriter::with_capacity(BUFFER, out)));
        }
        if path.is_file() {
            input::check_is_not_read(&behind_links(path)?)?;
        }
        Ok(Self::File(OutputFile::create(path)?))
    }

    /// Returns whether the output is a regular file. A pipe or device may be the terminal.
    fn is_file(&self) -> bool {
        matches!(self, Self::File(file) if file.is_regular())
    }

    /// Finishes the output: a file appears under its name. A file that is dropped without this is removed.
    pub(super) fn finish(self) -> Result<(), Failure> {
        match self {
            Self::Standard(mut out) => Ok(out.flush().context(NO_STANDARD_OUTPUT)?),
            Self::File(file) => Ok(file.finish()?),
            Self::Memory(_) => Ok(()),
        }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        match error {
            WriteError::Io { path, error } => failed(error, &path),
            error => anyhow::Error::new(error).into(),
        }
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Standard(out) => out.write(bytes),
            Self::File(file) => file.write(bytes),
            Self::Memory(memory) => memory.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Standard(out) => out.flush(),
            Self::File(file) => file.flush(),
            Self::Memory(memory) => memory.flush(),
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
    let written = progress::watched(shows_progress, |progress| content(&mut out, progress))?;
    out.inner.finish()?;
    Ok((written, out.bytes))
}

/// Writes to memory, at most `most` bytes, and returns them. `spare` is empty memory for them.
pub(super) fn write_held<T>(
    spare: Vec<u8>,
    most: usize,
    content: impl FnOnce(&mut Counted<Output>, Option<&Progress>) -> Result<T, Failure>,
) -> Result<(T, Vec<u8>), Failure> {
    let mut out = Counted {
        inner: Output::Memory(Memory::new(spare, most)),
        bytes: 0,
    };
    let written = content(&mut out, None)?;
    let Output::Memory(Memory { bytes, .. }) = out.inner else {
        unreachable!("the output is memory");
    };
    Ok((written, bytes))
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

/// Returns the failure to draw a picture into `path`, with the option that remedies it.
pub(super) fn explain(error: RenderError, path: &Path) -> Failure {
    let option = match error.remedy() {
        Some(Remedy::OtherColours) => "--color-by none",
        Some(Remedy::NoFill) => "--fill transparent",
        Some(Remedy::RoundEnds) => "--cap round --join round",
        Some(Remedy::PixelWidth) => "--stroke-width 1.5",
        Some(Remedy::Window) => "--view X,Y,W,H",
        None => {
            return match error {
                RenderError::Io(error) => failed(error, path),
                other => anyhow::Error::new(other).into(),
            };
        }
    };
    anyhow!("{error} ({option})").into()
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

/// Prints a result, as JSON or as text.
pub(super) fn print_as(
    is_json: bool,
    value: &impl Serialize,
    text: impl FnOnce() -> String,
) -> Result<(), Failure> {
    let printed = match is_json {
        true => print_json(value),
        false => print(&text()),
    };
    Ok(printed?)
}

/// Writes a text to a file or to standard output.
pub(super) fn write_text(path: &Path, text: &str) -> Result<(), Failure> {
    let write = |out: &mut Counted<Output>| out.write_all(text.as_bytes());
    self::write(path, true, |out, _| {
        write(out).map_err(|error| failed(error, path))
    })
    .map(|_| ())
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
