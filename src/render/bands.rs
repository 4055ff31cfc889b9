//! Pictures larger than memory: drawn in bands of rows, one after another, and encoded band by band.
//!
//! Every band of an approximant takes a walk that skips what lies outside the band, where the graph permits
//! that; any other drawing is drawn again for every band, and only the rows of the band are kept. A first
//! pass over the bands collects the colours, which determine the encoding of pixels; it ends as soon as
//! further pixels cannot change that. A second pass draws and encodes. The bytes do not depend on the height
//! of bands, unless tiny-skia draws a path that is so long that it is divided.

use std::io::{self, Write};
use std::num::NonZero;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use crate::grow::{Growth, Progress, WalkError};
use crate::parallel::with_team;
use crate::style::Width;

use super::blended;
use super::drawing::Drawing;
use super::error::RenderError;
use super::layout::Layout;
use super::options::Options;
use super::paint::overhang;
use super::png::{BAND_ROWS, Colours, KeptSprites, Pixmap, Png, Spare, encode_pieces};
use super::scene::Scene;

/// Pixels of a band, and buffers for the next one.
type Band = Result<(Pixmap, Spare), RenderError>;

/// Picture that is drawn in bands.
struct Bands<'a> {
    size: [u32; 2],
    /// Number of rows of a band.
    rows: u32,
    /// Whether the background is opaque.
    on_opaque: bool,
    options: &'a Options,
    cancel: Option<&'a AtomicBool>,
    /// Progress, in pixels, since elements are visited again in every band.
    progress: Option<&'a Progress>,
}

/// Draws and encodes a measured approximant.
pub(super) fn write_layout(
    layout: &Layout<'_>,
    options: &Options,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    let Layout {
        prepass,
        canvas,
        growth,
    } = layout;
    let style = &options.style;
    let stroke = match style.width {
        Width::Pixels(width) => width * overhang(style),
        Width::Relative(_) => 0.0,
    };
    // Antialiasing colours pixels that a shape covers in part.
    let pad = stroke + 1.0;
    let all = canvas.shown(pad);
    let culling = prepass.culling().clone();
    let culling = culling.within(&all, prepass.graph(), growth, style, prepass.counts_ranks());
    let bands = Bands {
        progress: growth.progress,
        ..Bands::of(&layout.scene(), options, growth.cancel)
    };
    if let Some(progress) = growth.progress {
        let [width, height] = canvas.size().map(u64::from);
        let walked = u64::from(prepass.walked) * prepass.elements;
        progress.expect(2 * width * height + walked);
    }
    let growth = Growth {
        progress: None,
        ..*growth
    };
    let sprites = Arc::<KeptSprites>::default();
    bands.write(out, |rows, spare| {
        let shown = canvas.shown_in(rows.clone(), pad);
        let prepass = prepass.clone().of_what_is_in(culling.moved_to(&shown));
        let scene = Scene {
            sprites: Some(Arc::clone(&sprites)),
            ..Scene::new(&prepass, &growth, *canvas)
        };
        drawn(&scene, rows, spare, options.threads)
    })
}

/// Draws and encodes any drawing.
pub(super) fn write_drawing(
    drawing: &impl Drawing,
    options: &Options,
    cancel: Option<&AtomicBool>,
    out: &mut impl Write,
) -> Result<(), RenderError> {
    let bands = Bands::of(drawing, options, cancel);
    bands.write(out, |rows, spare| {
        drawn(drawing, rows, spare, options.threads)
    })
}

/// Draws a band.
fn drawn(drawing: &impl Drawing, rows: Range<u32>, spare: Spare, threads: NonZero<usize>) -> Band {
    let (size, background) = (drawing.size(), drawing.background());
    with_team(threads, |team| {
        let png = Png::begin_band(size, rows, background, spare, team)?;
        let mut png = png.blending(drawing.blend());
        blended::draw(drawing, &mut png, team)?;
        Ok(png.into_pixels())
    })
}

impl<'a> Bands<'a> {
    /// Divides a drawing into bands of at most [`Options::band`] pixels, up to a whole number of raster
    /// strips.
    fn of(drawing: &impl Drawing, options: &'a Options, cancel: Option<&'a AtomicBool>) -> Self {
        let size @ [width, height] = drawing.size();
        let rows = (options.band / u64::from(width)).clamp(1, height.into());
        let rows = u32::try_from(rows).unwrap_or(height);
        let background = drawing.background();
        Self {
            size,
            rows: rows.next_multiple_of(BAND_ROWS),
            on_opaque: background.is_some_and(|it| it == it.opaque()),
            options,
            cancel,
            progress: None,
        }
    }

    /// Draws and encodes the bands.
    fn write(
        &self,
        out: &mut impl Write,
        draw: impl Fn(Range<u32>, Spare) -> Band,
    ) -> Result<(), RenderError> {
        let mut spare = Spare::default();
        let mut give = |rows: Range<u32>, give: &mut dyn FnMut(&Pixmap) -> io::Result<()>| {
            // A walk over few elements does not check for cancellation.
            if self.cancel.is_some_and(|it| it.load(Relaxed)) {
                return Err(RenderError::Walk(WalkError::Cancelled));
            }
            let (pixels, unused) = draw(rows.clone(), std::mem::take(&mut spare))?;
            spare = unused;
            self.count(&rows);
            Ok(give(&pixels)?)
        };
        let mut colours = Colours::none();
        for rows in self.each() {
            if colours.are_settled(self.on_opaque) {
                self.count(&rows);
            } else {
                give(rows, &mut |pixels| {
                    colours.add(pixels);
                    Ok(())
                })?;
            }
        }
        let colours = colours.sorted();
        let mut out = KeptError { out, error: None };
        let Options { labels, png, .. } = self.options;
        let encoded = encode_pieces(self.size, &colours, labels, *png, &mut out, |encode| {
            self.each().try_for_each(|rows| give(rows, encode))
        });
        match out.error {
            Some(error) => Err(error.into()),
            None => encoded,
        }
    }

    /// Iterates over the rows of the bands.
    fn each(&self) -> impl Iterator<Item = Range<u32>> {
        let [_, height] = self.size;
        let tops = (0..height).step_by(self.rows as usize);
        tops.map(move |top| top..top.saturating_add(self.rows).min(height))
    }

    fn count(&self, rows: &Range<u32>) {
        if let Some(progress) = self.progress {
            let [width, _] = self.size;
            progress.count(u64::from(width) * u64::from(rows.end - rows.start));
        }
    }
}

/// Writer that keeps the error of a failed write, of which the encoder sees the kind only.
struct KeptError<W> {
    out: W,
    error: Option<io::Error>,
}

impl<W: Write> Write for KeptError<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes).map_err(|error| {
            let kind = error.kind();
            self.error = Some(error);
            kind.into()
        })
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests;
