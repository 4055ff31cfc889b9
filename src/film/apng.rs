//! Animated PNG: every frame holds the part that differs from the frame before it.

use std::io::{self, Write};

use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder, Filter, Writer};

use super::{FilmEncoder, FilmOptions, changed, failed, rows};

/// Encoder of an animated PNG.
pub(crate) struct Apng<W: Write> {
    writer: Writer<W>,
    width: u32,
    is_opaque: bool,
    /// Preceding frame; empty before the first.
    before: Vec<u8>,
    /// Scratch memory for the part of a frame that is written.
    part: Vec<u8>,
}

impl<W: Write> Apng<W> {
    /// Begins a file.
    pub(crate) fn begin(out: W, options: &FilmOptions) -> io::Result<Self> {
        let [width, height] = options.size;
        let mut encoder = Encoder::new(out, width, height);
        encoder.set_color(match options.is_opaque {
            true => ColorType::Rgb,
            false => ColorType::Rgba,
        });
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Balanced);
        // Line art has long runs of one colour, which filters break up.
        encoder.set_filter(Filter::NoFilter);
        let plays = u32::from(!options.repeats);
        (encoder.set_animated(options.frames, plays)).map_err(failed)?;
        let rate = options.rate;
        // Numerator and denominator have 16 bits.
        let delay = [rate.seconds, rate.frames].map(u16::try_from);
        let [Ok(seconds), Ok(frames)] = delay else {
            return Err(failed(
                "a PNG has up to 65535 frames in a number of seconds",
            ));
        };
        encoder
            .set_frame_delay(seconds, frames)
            .and_then(|()| encoder.set_dispose_op(DisposeOp::None))
            .and_then(|()| encoder.set_blend_op(BlendOp::Source))
            .map_err(failed)?;
        for (keyword, text) in options.labels.texts() {
            (encoder.add_itxt_chunk(keyword.into(), text)).map_err(failed)?;
        }
        Ok(Self {
            writer: encoder.write_header().map_err(failed)?,
            width,
            is_opaque: options.is_opaque,
            before: Vec::new(),
            part: Vec::new(),
        })
    }
}

impl<W: Write> FilmEncoder for Apng<W> {
    fn add(&mut self, pixels: &[u8]) -> io::Result<()> {
        let height = u32::try_from(pixels.len() / (4 * self.width as usize)).unwrap_or(u32::MAX);
        let area = match self.before.is_empty() {
            true => [0, 0, self.width, height],
            false => changed(&self.before, pixels, self.width),
        };
        let [left, top, across, down] = area;
        self.part.clear();
        for row in rows(pixels, self.width, area) {
            match self.is_opaque {
                true => push_opaque(row, &mut self.part),
                false => self.part.extend_from_slice(row),
            }
        }
        if !self.before.is_empty() {
            // The position goes first: a part must lie in the picture at any time.
            (self.writer.reset_frame_position())
                .and_then(|()| self.writer.set_frame_dimension(across, down))
                .and_then(|()| self.writer.set_frame_position(left, top))
                .map_err(failed)?;
        }
        (self.writer.write_image_data(&self.part)).map_err(failed)?;
        self.before.clear();
        self.before.extend_from_slice(pixels);
        Ok(())
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        self.writer.finish().map_err(failed)
    }
}

/// Adds the colours of opaque pixels.
fn push_opaque(row: &[u8], part: &mut Vec<u8>) {
    let pixels = row.as_chunks::<4>().0;
    let start = part.len();
    part.resize(start + 3 * pixels.len(), 0);
    let colours = part[start..].as_chunks_mut::<3>().0;
    for (colour, &[red, green, blue, _]) in colours.iter_mut().zip(pixels) {
        *colour = [red, green, blue];
    }
}
