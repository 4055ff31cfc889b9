//! Films: frames of one size in a file, encoded one after another.

mod apng;
mod gif;
mod svg;
mod y4m;

use std::io;

pub(crate) use apng::Apng;
pub(crate) use gif::Gif;
pub(crate) use svg::{write_drawn, write_frames};
pub(crate) use y4m::Y4m;

use crate::render::Labels;

/// Properties of a film.
#[derive(Clone, Debug)]
pub(crate) struct FilmOptions {
    /// Width and height in pixels.
    pub(crate) size: [u32; 2],
    /// Number of frames.
    pub(crate) frames: u32,
    pub(crate) rate: Rate,
    /// Whether the film is repeated without end.
    pub(crate) repeats: bool,
    /// Whether all pixels are opaque.
    pub(crate) is_opaque: bool,
    pub(crate) labels: Labels,
}

/// Number of frames a second, as a fraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rate {
    pub(crate) frames: u32,
    pub(crate) seconds: u32,
}

impl Rate {
    /// Returns the time at which a frame begins, in hundredths of a second.
    fn hundredths(self, frame: u32) -> u64 {
        let frames = u64::from(self.frames);
        (200 * u64::from(frame) * u64::from(self.seconds) + frames) / (2 * frames)
    }
}

/// Encoder of a film.
pub(crate) trait FilmEncoder {
    /// Encodes the next frame: four bytes a pixel, red, green, blue and alpha, in rows from the top.
    fn add(&mut self, pixels: &[u8]) -> io::Result<()>;

    /// Writes the end of the file.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// Part of a frame: left and upper edge, width and height in pixels.
type Area = [u32; 4];

/// Returns the smallest part that differs between two frames of a width; a pixel if none does.
fn changed(before: &[u8], after: &[u8], width: u32) -> Area {
    let stride = 4 * width as usize;
    let rows = before.chunks_exact(stride).zip(after.chunks_exact(stride));
    let mut all: Option<[usize; 4]> = None;
    for (row, (before, after)) in rows.enumerate() {
        let differ = |(before, after): (&[u8; 4], &[u8; 4])| before != after;
        let (before, after) = (before.as_chunks::<4>().0, after.as_chunks::<4>().0);
        let Some(first) = before.iter().zip(after).position(differ) else {
            continue;
        };
        let last = before.iter().zip(after).rposition(differ).unwrap_or(first);
        let [left, right, top] = all.map_or([first, last, row], |[left, right, top, _]| {
            [left.min(first), right.max(last), top]
        });
        all = Some([left, right, top, row]);
    }
    let [left, right, top, bottom] = all.unwrap_or_default();
    [left, top, right - left + 1, bottom - top + 1].map(|it| u32::try_from(it).unwrap_or(u32::MAX))
}

/// Iterates over the rows of a part of a frame.
fn rows(pixels: &[u8], width: u32, area: Area) -> impl Iterator<Item = &[u8]> {
    let [left, top, across, down] = area.map(|it| it as usize);
    let rows = pixels.chunks_exact(4 * width as usize).skip(top).take(down);
    rows.map(move |row| &row[4 * left..4 * (left + across)])
}

/// Number of pixels that are compared at once.
const WIDE: usize = 16;

/// Iterates over runs of equal pixels.
fn runs(pixels: &[u8]) -> impl Iterator<Item = &[[u8; 4]]> {
    let mut rest = pixels.as_chunks::<4>().0;
    std::iter::from_fn(move || {
        let first = *rest.first()?;
        let differs = |pixel: &[u8; 4]| u32::from_ne_bytes(*pixel) != u32::from_ne_bytes(first);
        let mut length = 1;
        if rest.get(1) == Some(&first) {
            // The comparisons of a chunk are independent of each other.
            let equal = |chunk: &[[u8; 4]]| chunk.iter().fold(true, |all, it| all & !differs(it));
            let wide = rest[1..].chunks_exact(WIDE);
            length += WIDE * wide.take_while(|it| equal(it)).count();
        }
        let after = rest[length..].iter();
        length += after.take_while(|it| !differs(it)).count();
        let (run, others) = rest.split_at(length);
        rest = others;
        Some(run)
    })
}

/// Blends a pixel with white paper.
fn on_white([red, green, blue, alpha]: [u8; 4]) -> [u8; 3] {
    if alpha == u8::MAX {
        return [red, green, blue];
    }
    [red, green, blue].map(|value| {
        let [value, alpha] = [value, alpha].map(u32::from);
        u8::try_from((value * alpha + 255 * (255 - alpha) + 127) / 255).unwrap_or(u8::MAX)
    })
}

/// Returns the failure of an encoder.
fn failed(error: impl Into<Box<dyn std::error::Error + Send + Sync>>) -> io::Error {
    io::Error::other(error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_holds_what_differs() {
        let mut after = vec![0; 4 * 5 * 4];
        let before = after.clone();
        assert_eq!(changed(&before, &after, 5), [0, 0, 1, 1]);
        for (x, y) in [(1, 1), (3, 2)] {
            after[4 * (5 * y + x) + 1] = 7;
        }
        assert_eq!(changed(&before, &after, 5), [1, 1, 3, 2]);
        let part: Vec<_> = rows(&after, 5, [1, 1, 3, 2]).collect();
        assert_eq!(part.concat().iter().filter(|it| **it == 7).count(), 2);
        assert_eq!(part.len(), 2);
    }

    #[test]
    fn runs_are_as_long_as_equal_pixels() {
        let lengths = [1, 2, 15, 16, 17, 1, 33, 64, 3];
        let colours = |number: usize| [u8::try_from(number % 2).unwrap(), 0, 1, 9];
        let pixels: Vec<_> = { lengths.iter().enumerate() }
            .flat_map(|(number, length)| vec![colours(number); *length])
            .collect();
        let found: Vec<_> = runs(pixels.as_flattened()).collect();
        let expected =
            { lengths.iter().enumerate() }.map(|(number, length)| vec![colours(number); *length]);
        assert_eq!(found, expected.collect::<Vec<_>>());
    }

    #[test]
    fn times_do_not_drift() {
        let rate = Rate {
            frames: 30,
            seconds: 1,
        };
        assert_eq!(rate.hundredths(30), 100);
        assert_eq!(rate.hundredths(3000), 10_000);
        assert_eq!(on_white([0, 0, 0, 128]), [127; 3]);
        assert_eq!(on_white([9, 8, 7, 255]), [9, 8, 7]);
    }
}
