//! Time and size of a film, before it is made.

use super::super::{Failure, readable};
use super::frames::Purpose;
use super::plan::Film;
use super::target::Format;

/// Largest number of frames that are estimated; others are like them.
const MOST: usize = 32;

/// Seconds that a processor of 2026 takes for a pixel of a frame and its encoding, within a factor of about 3.
const SECONDS_A_PIXEL: f64 = 2e-8;

/// Seconds and bytes from which a film is worth a note.
const WORTH: [f64; 2] = [1.0, 1e6];

/// Returns a note on the time that a film takes and on its size; `None` for a small one, and where frames have no
/// forecast: in zooms and in space.
pub(super) fn note(film: &Film<'_>, format: Option<Format>) -> Result<Option<String>, Failure> {
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
    if sampled == 0.0 {
        return Ok(None);
    }
    #[expect(clippy::cast_precision_loss, reason = "a film has few frames")]
    let frames = count as f64;
    let [width, height] = film.size.map(f64::from);
    let pixels = width * height * frames;
    let threads = film.frames.threads.get().min(count);
    #[expect(clippy::cast_precision_loss, reason = "there are few threads")]
    let seconds = (seconds / sampled * frames + pixels * SECONDS_A_PIXEL) / threads as f64;
    let size = match format {
        Some(Format::Y4m) => Some(3.0 * pixels),
        Some(Format::Mp4 | Format::Webm) => None,
        _ => Some(bytes / sampled * frames),
    };
    if seconds < WORTH[0] && size.unwrap_or_default() < WORTH[1] {
        return Ok(None);
    }
    let size = size.map_or_else(String::new, |size| {
        format!(", {}", readable::rough_bytes(size))
    });
    Ok(Some(format!(
        "note: {} of up to {}: {}{size}",
        readable::counted(&(count as u64).into(), "frame"),
        readable::counted(&elements.into(), "element"),
        readable::duration(seconds)
    )))
}
