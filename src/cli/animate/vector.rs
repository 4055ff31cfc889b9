//! Films as SVG.

use std::io::{self, Write};
use std::path::Path;

use crate::film::{self, FilmOptions};

use super::super::{Failure, output};
use super::Arguments;
use super::frames::Purpose;
use super::plan::Film;
use super::target::watched;

/// Largest number of elements of all frames together: browsers show them smoothly.
const MAX_ELEMENTS: u64 = 20_000;

/// Argument of a frame that is drawn up to a share.
const DRAWN: &str = "--drawn=";

/// Writes a film as one drawing that changes.
pub(super) fn write(
    arguments: &Arguments,
    film: &mut Film<'_>,
    options: &FilmOptions,
    path: &Path,
    out: &mut dyn Write,
) -> Result<(), Failure> {
    let closes = arguments.is_loop || arguments.bounce;
    let failed = |error: io::Error| match error.kind() {
        io::ErrorKind::InvalidData => Failure::Usage(error.to_string()),
        _ => output::failed(error, path),
    };
    let count = film.frames.arguments.len();
    if arguments.draw {
        let shares = drawn(film)?;
        film.frames.arguments[0].retain(|it| !it.starts_with(DRAWN));
        let documents = documents(arguments, film, [0], 1)?;
        let document = documents.first().map(Vec::as_slice).unwrap_or_default();
        return film::write_drawn(document, &shares, options, closes, out).map_err(failed);
    }
    let documents = documents(arguments, film, 0..count, count as u64)?;
    film::write_frames(&documents, options, closes, out).map_err(failed)
}

/// Returns the shares of the way of a pen by frame.
fn drawn(film: &Film<'_>) -> Result<Vec<f64>, Failure> {
    let frames = &film.frames.arguments;
    let is_share = |it: &&String| it.starts_with(DRAWN);
    let others = |number: usize| frames[number].iter().filter(|it| !is_share(it));
    if (1..frames.len()).any(|number| !others(number).eq(others(0))) {
        let message =
            "an SVG that is drawn by --draw changes in nothing else: write a .gif or .png";
        return Err(Failure::Usage(message.into()));
    }
    let share = |frame: &Vec<String>| -> Option<f64> {
        let share = frame.iter().find_map(|it| it.strip_prefix(DRAWN));
        share?.parse().ok()
    };
    let shares: Option<Vec<f64>> = frames.iter().map(share).collect();
    Ok(shares.unwrap_or_default())
}

/// Draws frames as SVG documents. `times` is the number of frames for which the elements of each count.
fn documents(
    arguments: &Arguments,
    film: &Film<'_>,
    numbers: impl IntoIterator<Item = usize>,
    times: u64,
) -> Result<Vec<Vec<u8>>, Failure> {
    let is_nested = arguments.others.value("svg") == Some("instanced");
    let mut documents = Vec::new();
    let count = film.frames.arguments.len();
    watched(arguments, &film.frames, count, || {
        film.frames.draw(numbers, Purpose::Lines, &[], |_, done| {
            let elements = done.elements.unwrap_or_default().saturating_mul(times);
            if elements > MAX_ELEMENTS && !is_nested {
                let message = format!(
                    "all frames together have {elements} elements, and an animated SVG has up to {MAX_ELEMENTS}: give fewer \
                     --steps or --frames, --svg instanced, or write a .gif or .png"
                );
                return Err(Failure::Usage(message));
            }
            documents.push(std::mem::take(&mut done.bytes));
            Ok(())
        })
    })?;
    Ok(documents)
}
