//! Files of films.

use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use crate::film::{Apng, FilmEncoder, FilmOptions, Gif, Y4m};

use crate::render::Labels;
use crate::style::Named;

use super::super::labels::labels;
use super::super::rule::Loaded;
use super::super::template::NumberedName;
use super::super::{Failure, format, output, progress, readable, redrawn};
use super::Arguments;
use super::frames::{Frames, Purpose};
use super::plan::Film;
use super::vector;
use super::video::Video;

/// Format of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Format {
    Gif,
    Apng,
    Y4m,
    /// Container that ffmpeg writes.
    Mp4,
    Webm,
    /// Lines that move.
    Svg,
}

impl Named for Format {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("gif", Self::Gif),
        ("png", Self::Apng),
        ("apng", Self::Apng),
        ("y4m", Self::Y4m),
        ("mp4", Self::Mp4),
        ("webm", Self::Webm),
        ("svg", Self::Svg),
    ];
}

impl Format {
    /// Returns the format of the file that arguments name; `None` for a PNG for each frame.
    pub(super) fn of(arguments: &Arguments, path: &Path) -> Result<Option<Self>, Failure> {
        if Numbered::of(path)?.is_some() {
            return Ok(None);
        }
        match (arguments.format, path == Path::new("-")) {
            (None, true) => Ok(Some(Self::Y4m)),
            (asked, _) => format::choose(asked, Some(path)).map(Some),
        }
    }

    /// Begins a film of pixels in this format.
    fn begin<'o>(
        self,
        out: &'o mut dyn Write,
        options: &FilmOptions,
    ) -> io::Result<Box<dyn FilmEncoder + 'o>> {
        Ok(match self {
            Self::Gif => Box::new(Gif::begin(out, options)?),
            Self::Apng => Box::new(Apng::begin(out, options)?),
            Self::Y4m => Box::new(Y4m::begin(out, options)?),
            Self::Svg => return Err(io::ErrorKind::Unsupported.into()),
            Self::Mp4 | Self::Webm => Box::new(Video::begin(out, options, self == Self::Mp4)?),
        })
    }
}

/// Writes a film, and describes what has been written.
pub(super) fn write(
    arguments: &Arguments,
    mut film: Film<'_>,
    loaded: &Loaded,
    format: Option<Format>,
    path: &Path,
) -> Result<String, Failure> {
    if let Some(numbered) = Numbered::of(path)? {
        return numbered.write(arguments, &film);
    }
    let format = format.unwrap_or(Format::Gif);
    if arguments.only.is_some() {
        let message = "--only draws some frames of a film in PNGs: name them with a number, as -o film-%04d.png";
        return Err(Failure::Usage(message.into()));
    }
    let count = film.frames.arguments.len();
    let frames = u32::try_from(count).unwrap_or(u32::MAX);
    let mut options = FilmOptions {
        size: film.size,
        frames,
        rate: arguments.fps,
        repeats: !arguments.once,
        is_opaque: true,
        labels: described(arguments, loaded, frames),
    };
    // Elements alone, which cover the first frame, may leave later ones.
    let has_background = arguments.others.value("background") != Some("none");
    let explain = |error: io::Error| output::failed(error, path);
    let ((), bytes) = output::write(path, true, |out, _| {
        if format == Format::Svg {
            return vector::write(arguments, &mut film, &options, path, out);
        }
        watched(arguments, &film.frames, count, || {
            let mut out = Some(out as &mut dyn Write);
            let mut encoder = None;
            film.frames
                .draw(0..count, Purpose::Pixels, &[], |_, done| {
                    if let Some(out) = out.take() {
                        options.is_opaque = has_background
                            && done.bytes.as_chunks::<4>().0.iter().all(|it| it[3] == 255);
                        encoder = Some(format.begin(out, &options).map_err(explain)?);
                    }
                    if let Some(held) = &arguments.held
                        && held.cancel.load(Ordering::Relaxed)
                    {
                        return Err(Failure::Usage("the film has been cancelled".into()));
                    }
                    match &mut encoder {
                        Some(encoder) => encoder.add(&done.bytes).map_err(explain),
                        None => Ok(()),
                    }
                })?;
            encoder.map_or(Ok(()), |encoder| encoder.finish().map_err(explain))
        })
    })?;
    let [width, height] = film.size;
    Ok(format!(
        "{}: {}, {width} x {height} pixels, {}",
        output::called(path),
        readable::counted(&u64::from(frames).into(), "frame"),
        readable::bytes(bytes)
    ))
}

/// Draws frames while the number of finished ones is shown.
pub(super) fn watched<T>(
    arguments: &Arguments,
    frames: &Frames<'_>,
    count: usize,
    work: impl FnOnce() -> T,
) -> T {
    frames.drawn.store(0, Ordering::Relaxed);
    let describe = || format!("{} of {count} frames", frames.drawn.load(Ordering::Relaxed));
    progress::watched_as(!arguments.quiet, describe, work)
}

/// Returns the labels of a film.
fn described(arguments: &Arguments, loaded: &Loaded, frames: u32) -> Labels {
    let shown = format!("Film of {frames} frames");
    labels(loaded, &shown, "animate", arguments.given.labelled())
}

/// File for each frame, with its number in the name.
struct Numbered(NumberedName);

impl Numbered {
    /// Reads a name such as `film-%04d.png`; `None` without a number.
    fn of(path: &Path) -> Result<Option<Self>, Failure> {
        let name = path.to_string_lossy();
        let wrong = || {
            let message = format!(
                "'{name}': the number of a frame is written %d or %04d, once, in the name of a .png"
            );
            Failure::Usage(message)
        };
        if !name.contains('%') {
            return Ok(None);
        }
        let is_png = path.extension() == Some(OsStr::new("png"));
        let numbered = NumberedName::parse(&name).filter(|_| is_png);
        Ok(Some(Self(numbered.ok_or_else(wrong)?)))
    }

    fn path(&self, number: usize) -> PathBuf {
        self.0.with(number as u64).into()
    }

    /// Writes the frames, and describes what has been written.
    fn write(&self, arguments: &Arguments, film: &Film) -> Result<String, Failure> {
        let count = film.frames.arguments.len();
        let mut numbers: Vec<usize> = match &arguments.only {
            Some(only) => only.as_slice().iter().map(|it| *it as usize).collect(),
            None => (0..count).collect(),
        };
        if let Some(beyond) = numbers.iter().find(|number| **number >= count) {
            let last = count - 1;
            let message = format!("--only {beyond}: the last frame has the number {last}");
            return Err(Failure::Usage(message));
        }
        let asked = numbers.len();
        self.omit_finished(film, &mut numbers)?;
        let kept = asked - numbers.len();
        let mut bytes = 0;
        watched(arguments, &film.frames, numbers.len(), || {
            film.frames
                .draw(numbers, Purpose::Png, &[], |number, done| {
                    let path = self.path(number);
                    bytes += done.bytes.len() as u64;
                    let write =
                        |out: &mut output::Counted<output::Output>| out.write_all(&done.bytes);
                    output::write(&path, true, |out, _| {
                        write(out).map_err(|error| output::failed(error, &path))
                    })?;
                    Ok(())
                })
        })?;
        let [width, height] = film.size;
        let kept = match kept {
            0 => String::new(),
            kept => format!(", {kept} of them kept"),
        };
        Ok(format!(
            "{} to {}: {}{kept}, {width} x {height} pixels, {}",
            self.path(0).display(),
            self.path(count - 1).display(),
            readable::counted(&(asked as u64).into(), "frame"),
            readable::bytes(bytes)
        ))
    }

    /// Takes away the numbers of frames whose files exist and have been drawn by an equal command.
    fn omit_finished(&self, film: &Film, numbers: &mut Vec<usize>) -> Result<(), Failure> {
        let existing = numbers.iter().copied();
        let existing: Vec<usize> = existing.filter(|it| self.path(*it).exists()).collect();
        let mut finished = BTreeSet::new();
        film.frames
            .draw(existing, Purpose::PngSurvey, &[], |number, done| {
                let expected = &done.provenance;
                if expected.is_some() && provenance(&self.path(number)) == *expected {
                    finished.insert(number);
                }
                Ok(())
            })?;
        numbers.retain(|number| !finished.contains(number));
        Ok(())
    }
}

/// Returns the text from which a PNG was made; `None` without a complete file.
fn provenance(path: &Path) -> Option<String> {
    const END: &[u8] = b"IEND\xAE\x42\x60\x82";
    std::fs::read(path).ok().filter(|it| it.ends_with(END))?;
    redrawn::of_png(path).ok().flatten()
}
