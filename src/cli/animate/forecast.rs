//! Time and size of a film, before it is made.

use std::time::Instant;

use super::super::{Failure, readable};
use super::frames::Purpose;
use super::plan::Film;
use super::target::Format;

/// Number of frames of a film of which some are drawn for a forecast.
const FEW: usize = 20;

/// Largest number of frames that are estimated; others are like them.
const MOST: usize = 32;

/// Seconds that a processor of 2026 takes for a pixel of a frame and its encoding, within a factor of about 3.
const SECONDS_A_PIXEL: f64 = 2e-8;

/// Seconds and bytes from which a film is worth a note.
const WORTH: [f64; 2] = [1.0, 1e6];

/// Cost of a film.
struct Cost {
    /// Largest number of elements of a frame, if the graph determines it.
    elements: Option<u64>,
    /// Seconds on one thread.
    seconds: f64,
    /// Size of the PNGs of all frames in bytes.
    bytes: f64,
}

/// Returns a note on the time that a film takes and on its size; `None` for a small one.
pub(super) fn note(film: &Film<'_>, format: Option<Format>) -> Result<Option<String>, Failure> {
    let count = film.frames.arguments.len();
    let [width, height] = film.size.map(f64::from);
    let estimated = estimated(film)?;
    let Some(cost) = estimated.map_or_else(|| tried(film), |cost| Ok(Some(cost)))? else {
        return Ok(None);
    };
    let threads = film.frames.threads.get().min(count);
    #[expect(clippy::cast_precision_loss, reason = "a film has few frames")]
    let (frames, seconds) = (count as f64, cost.seconds / threads as f64);
    let size = match format {
        Some(Format::Y4m) => Some(3.0 * width * height * frames),
        Some(Format::Mp4 | Format::Webm) => None,
        _ => Some(cost.bytes),
    };
    if seconds < WORTH[0] && size.unwrap_or_default() < WORTH[1] {
        return Ok(None);
    }
    let frames = readable::counted(&(count as u64).into(), "frame");
    let elements = cost.elements.map_or_else(String::new, |elements| {
        let elements = readable::counted(&elements.into(), "element");
        format!(" of up to {elements}")
    });
    let size = size.map_or_else(String::new, |size| {
        format!(", {}", readable::rough_bytes(size))
    });
    let seconds = readable::duration(seconds);
    Ok(Some(format!("note: {frames}{elements}: {seconds}{size}")))
}

/// Returns the cost of a film that the graphs of its frames determine; `None` for zooms, for random iteration and in space.
fn estimated(film: &Film<'_>) -> Result<Option<Cost>, Failure> {
    let arguments = &film.frames.arguments;
    let is_surveyed = |it: &String| {
        !["--zoom=", "--from=", "--method="]
            .iter()
            .any(|own| it.starts_with(own))
    };
    if !arguments.iter().flatten().all(is_surveyed) {
        return Ok(None);
    }
    let count = arguments.len();
    let step = count.div_ceil(MOST);
    let (mut sampled, mut elements, mut seconds, mut bytes) = (0.0, 0, 0.0, 0.0);
    film.frames
        .draw((0..count).step_by(step), Purpose::Survey, &[], |_, done| {
            elements = elements.max(done.elements.unwrap_or_default());
            if let Some(estimate) = done.estimate {
                sampled += 1.0;
                seconds += estimate.seconds;
                bytes += estimate.png_bytes;
            }
            Ok(())
        })?;
    #[expect(clippy::cast_precision_loss, reason = "a film has few frames")]
    let frames = count as f64;
    let [width, height] = film.size.map(f64::from);
    Ok((sampled > 0.0).then(|| Cost {
        elements: Some(elements),
        seconds: (seconds / sampled + width * height * SECONDS_A_PIXEL) * frames,
        bytes: bytes / sampled * frames,
    }))
}

/// Returns the cost of a film from that of three frames, which are drawn; `None` if that is a large part of the film.
fn tried(film: &Film<'_>) -> Result<Option<Cost>, Failure> {
    let count = film.frames.arguments.len();
    if count < FEW {
        return Ok(None);
    }
    let (mut bytes, mut seconds) = (0.0, 0.0);
    for number in [0, count / 2, count - 1] {
        let start = Instant::now();
        film.frames.draw([number], Purpose::Png, &[], |_, done| {
            #[expect(clippy::cast_precision_loss, reason = "a size is shown in two digits")]
            {
                bytes += done.bytes.len() as f64;
            }
            Ok(())
        })?;
        seconds += start.elapsed().as_secs_f64();
    }
    #[expect(clippy::cast_precision_loss, reason = "a film has few frames")]
    let times = count as f64 / 3.0;
    Ok(Some(Cost {
        elements: None,
        seconds: seconds * times,
        bytes: bytes * times,
    }))
}
