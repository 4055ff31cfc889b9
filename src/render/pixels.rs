//! Pictures as pixels in memory, without an encoder.

use std::sync::atomic::AtomicBool;

use tiny_skia::Pixmap;

use crate::graph::Graph;
use crate::grow::Growth;
use crate::parallel::with_team;

use super::cells::Way;
use super::drawing::Drawing;
use super::error::RenderError;
use super::options::Options;
use super::plot::Plot;
use super::png::Png;

/// Pixels of a picture, in rows from the top, each from the left: red, green, blue and alpha of 8 bits (sRGB).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    size: [u32; 2],
    bytes: Vec<u8>,
}

impl Pixels {
    pub(super) fn of(pixmap: Pixmap) -> Self {
        Self {
            size: [pixmap.width(), pixmap.height()],
            bytes: pixmap.take(),
        }
    }

    /// Returns width and height.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns four bytes a pixel, with colours premultiplied by alpha.
    #[must_use]
    pub fn premultiplied(&self) -> &[u8] {
        &self.bytes
    }

    /// Converts to four bytes a pixel, with colours that are not premultiplied, as in PNG.
    #[must_use]
    pub fn into_straight(mut self) -> Vec<u8> {
        for pixel in self.bytes.chunks_exact_mut(4) {
            let alpha = u16::from(pixel[3]);
            if alpha != 0 && alpha != 255 {
                for channel in &mut pixel[..3] {
                    let straight = (u16::from(*channel) * 255 + alpha / 2) / alpha;
                    *channel = u8::try_from(straight).unwrap_or(u8::MAX);
                }
            }
        }
        self.bytes
    }
}

/// Grows a graph and draws the approximant as pixels in memory, of any size that
/// [fits into memory](super::TooManyPixels).
///
/// [`Options::format`], [`Options::labels`] and [`Options::in_one_piece`] have no effect.
///
/// # Errors
///
/// As for [`write`](super::write).
pub fn pixels(
    graph: &Graph,
    growth: &Growth<'_>,
    options: &Options,
) -> Result<Pixels, RenderError> {
    match Way::find(graph, growth, options)? {
        Way::Elements(layout) => draw(&layout.scene(), options, growth.cancel),
        Way::Cells(cells) => draw(&cells, options, growth.cancel),
    }
}

fn draw(
    drawing: &impl Drawing,
    options: &Options,
    cancel: Option<&AtomicBool>,
) -> Result<Pixels, RenderError> {
    if options.plot {
        return draw_paths(&Plot::of(drawing, options, cancel)?, options);
    }
    draw_paths(drawing, options)
}

fn draw_paths(drawing: &impl Drawing, options: &Options) -> Result<Pixels, RenderError> {
    let size = drawing.size();
    with_team(options.threads, |team| {
        let mut png = Png::begin(size, drawing.background(), team)?;
        drawing.draw(&mut png, team)?;
        let (pixmap, _) = png.into_pixels();
        Ok(Pixels::of(pixmap))
    })
}
