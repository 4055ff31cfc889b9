//! Pictures as pixels in memory, without an encoder.

use std::io::Write;
use std::sync::atomic::AtomicBool;

use tiny_skia::{IntSize, Pixmap};

use crate::graph::Graph;
use crate::grow::Growth;
use crate::parallel::with_team;
#[cfg(feature = "cli")]
use crate::style::Colour;

use super::blended;
use super::cells::DrawingMethod;
use super::drawing::Drawing;
use super::error::RenderError;
use super::hits;
use super::options::{Labels, Options, PngEncoding};
use super::picture::Picture;
use super::plot::Plot;
use super::png::{Png, Spare, TooManyPixels, write_pixels};

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

    /// Creates a picture from four bytes a pixel, all of which are opaque.
    pub(crate) fn opaque(size: [u32; 2], bytes: Vec<u8>) -> Self {
        Self { size, bytes }
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

    /// Encodes the picture as the bytes of a PNG without metadata.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// let pixels = kfrac::Fractal::named("koch")?.steps(6).pixels(300)?;
    /// assert!(pixels.into_png(kfrac::PngEncoding::default())?.starts_with(b"\x89PNG"));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    ///
    /// If there is no memory for the encoder.
    pub fn into_png(self, encoding: PngEncoding) -> Result<Vec<u8>, RenderError> {
        let mut png = Vec::new();
        self.encode(&Labels::default(), encoding, &mut png)?;
        Ok(png)
    }
}

impl Pixels {
    /// Returns whether nothing is drawn on a background.
    #[cfg(feature = "cli")]
    pub(crate) fn are_blank(&self, background: Option<Colour>) -> bool {
        let [red, green, blue, opacity] = background.unwrap_or(Colour::TRANSPARENT).rgba();
        let Some(mut pixel) = Pixmap::new(1, 1) else {
            return false;
        };
        pixel.fill(tiny_skia::Color::from_rgba8(red, green, blue, opacity));
        self.bytes.chunks_exact(4).all(|it| it == pixel.data())
    }

    /// Copies a smaller picture over this one, at the column and row of its upper left corner. Pixels beyond the edges
    /// are left out.
    pub(crate) fn put(&mut self, other: &Self, [left, top]: [u32; 2]) {
        let [width, height] = self.size;
        let columns = other.size[0].min(width.saturating_sub(left)) as usize;
        let rows = other.size[1].min(height.saturating_sub(top)) as usize;
        for row in 0..rows {
            let to = 4 * ((top as usize + row) * width as usize + left as usize);
            let from = 4 * row * other.size[0] as usize;
            let row = &other.bytes[from..from + 4 * columns];
            self.bytes[to..to + 4 * columns].copy_from_slice(row);
        }
    }

    /// Writes the picture as PNG.
    pub(crate) fn write(self, options: &Options, out: &mut impl Write) -> Result<(), RenderError> {
        self.encode(&options.labels, options.png, out)
    }

    fn encode(
        self,
        labels: &Labels,
        encoding: PngEncoding,
        out: &mut impl Write,
    ) -> Result<(), RenderError> {
        let Self {
            size: size @ [width, height],
            bytes,
        } = self;
        let pixmap = IntSize::from_wh(width, height).and_then(|size| Pixmap::from_vec(bytes, size));
        let pixmap = pixmap.ok_or(TooManyPixels { size })?;
        Ok(write_pixels(&pixmap, labels, encoding, out)?)
    }
}

/// Returns the numbers of the picture of a graph without drawing it.
///
/// # Errors
///
/// As for [`write`](super::write).
pub(crate) fn survey(
    graph: &Graph,
    growth: &Growth<'_>,
    options: &Options,
) -> Result<Picture, RenderError> {
    Ok(match DrawingMethod::find(graph, growth, options)? {
        DrawingMethod::Elements(layout) => layout.picture(None),
        DrawingMethod::Cells(cells) => cells.picture(),
    })
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
    match DrawingMethod::find(graph, growth, options)? {
        DrawingMethod::Elements(layout) => draw(&layout.scene(), options, growth.cancel),
        DrawingMethod::Cells(cells) => draw(&cells, options, growth.cancel),
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

/// Draws paths as pixels in memory.
pub(crate) fn draw_paths(drawing: &impl Drawing, options: &Options) -> Result<Pixels, RenderError> {
    let size = drawing.size();
    with_team(options.threads, |team| {
        if let Some(density) = options.density() {
            return Ok(Pixels::of(hits::pixmap(drawing, &density, team)?));
        }
        let png = Png::begin(size, drawing.background(), Spare::default(), team)?;
        let mut png = png.blending(drawing.blend());
        blended::draw(drawing, &mut png, team)?;
        let (pixmap, _) = png.into_pixels();
        Ok(Pixels::of(pixmap))
    })
}
