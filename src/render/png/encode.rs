//! Encoding of pixels as PNG, in the smallest layout that represents them exactly.

use std::io::{self, Write};

use png::{BitDepth, ColorType, Compression, DeflateCompression, Encoder, EncodingError, Filter};
use tiny_skia::{Pixmap, PremultipliedColorU8};

use crate::render::options::{Labels, PngEncoding};

/// Maximum number of tones at the edges of one colour. Pictures with more are continuous: palettes,
/// densities.
const TONES: usize = 128;

/// Mean length of runs of one colour below which a picture is busy, in pixels.
const SHORT: u64 = 4;

/// Writes pixels as PNG, by default with no more bits per pixel than they need: indexed for at most 256 colours,
/// greyscale if there are only greys, without an alpha channel if all pixels are opaque.
pub(in crate::render) fn encode(
    pixmap: &Pixmap,
    labels: &Labels,
    encoding: PngEncoding,
    out: &mut impl Write,
) -> io::Result<()> {
    if encoding.raw {
        return write_raw(pixmap, out);
    }
    let colours = Colours::of(pixmap);
    let size = [pixmap.width(), pixmap.height()];
    // The encoder would not return the error of `out`, hence the copy in memory.
    let mut bytes = Vec::new();
    encode_pieces(size, &colours, labels, encoding, &mut bytes, |encode| {
        encode(pixmap)
    })?;
    out.write_all(&bytes)
}

/// Writes pixels that come in pieces of some rows each, from the top. `colours` are the colours of all
/// pieces; `give` passes on one piece after another.
pub(in crate::render) fn encode_pieces<E: From<io::Error>>(
    [width, height]: [u32; 2],
    colours: &Colours,
    labels: &Labels,
    encoding: PngEncoding,
    out: &mut impl Write,
    give: impl FnOnce(&mut dyn FnMut(&Pixmap) -> io::Result<()>) -> Result<(), E>,
) -> Result<(), E> {
    if encoding.raw {
        return give(&mut |pixmap| write_raw(pixmap, out));
    }
    let mut encoder = Encoder::new(out, width, height);
    let layout = match encoding.grey {
        true => Layout::grey(colours.opaque),
        false => colours.layout(),
    };
    // Line art has long runs of one colour. Filters break them up, including the default of a compression
    // level.
    let mut filter = Filter::NoFilter;
    if encoding.fast {
        encoder.set_compression(Compression::Fast);
        // That compression shortens runs of zeros only.
        filter = Filter::Up;
    } else if colours.few.colours.len() > TONES || colours.are_busy() {
        // Takes a half to a sixth of the time of the default for a tenth more bytes: these pictures take
        // longest.
        encoder.set_deflate_compression(DeflateCompression::Level(2));
    } else {
        encoder.set_compression(Compression::Balanced);
    }
    encoder.set_filter(filter);
    encoder.set_color(layout.colour);
    encoder.set_depth(layout.depth);
    if layout.colour == ColorType::Indexed {
        let colours = colours.palette();
        encoder.set_palette(
            colours
                .iter()
                .flat_map(|&[red, green, blue, _]| [red, green, blue])
                .collect::<Vec<_>>(),
        );
        if !layout.opaque {
            encoder.set_trns(colours.iter().map(|colour| colour[3]).collect::<Vec<_>>());
        }
    }
    for (keyword, text) in labels.texts() {
        (encoder.add_itxt_chunk(keyword.into(), text)).map_err(io_error)?;
    }
    let mut writer = encoder.write_header().map_err(io_error)?;
    let mut stream = writer.stream_writer().map_err(io_error)?;
    let mut row = Vec::new();
    let mut encode = |pixmap: &Pixmap| -> io::Result<()> {
        for pixels in pixmap.pixels().chunks_exact(width as usize) {
            row.clear();
            match layout.colour {
                ColorType::Indexed => indices(pixels, &colours.few, layout.depth, &mut row),
                ColorType::Grayscale => row.extend(pixels.iter().map(|&pixel| luma(rgba(pixel)))),
                ColorType::GrayscaleAlpha => row.extend(pixels.iter().flat_map(|&pixel| {
                    let colour = rgba(pixel);
                    [luma(colour), colour[3]]
                })),
                ColorType::Rgb => row.extend(
                    pixels
                        .iter()
                        .flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()]),
                ),
                ColorType::Rgba => row.extend(pixels.iter().flat_map(|&pixel| rgba(pixel))),
            }
            stream.write_all(&row)?;
        }
        Ok(())
    };
    give(&mut encode)?;
    stream.finish().map_err(io_error)?;
    Ok(writer.finish().map_err(io_error)?)
}

/// Writes pixels without encoding them.
fn write_raw(pixmap: &Pixmap, out: &mut impl Write) -> io::Result<()> {
    let width = pixmap.width() as usize;
    let mut row = Vec::new();
    let rows = pixmap.data().chunks_exact(4 * width);
    for (bytes, pixels) in rows.zip(pixmap.pixels().chunks_exact(width)) {
        // Most pixels are opaque or empty, and need no division.
        let is_plain = |pixel: &PremultipliedColorU8| matches!(pixel.alpha(), 0 | 255);
        if pixels.iter().fold(true, |all, it| all & is_plain(it)) {
            out.write_all(bytes)?;
            continue;
        }
        row.clear();
        row.extend_from_slice(bytes);
        let values = row.as_chunks_mut::<4>().0.iter_mut().zip(pixels);
        for (values, &pixel) in values.filter(|(_, pixel)| !is_plain(pixel)) {
            *values = rgba(pixel);
        }
        out.write_all(&row)?;
    }
    Ok(())
}

type Rgba = [u8; 4];

fn rgba(pixel: PremultipliedColorU8) -> Rgba {
    let colour = pixel.demultiply();
    [colour.red(), colour.green(), colour.blue(), colour.alpha()]
}

/// Returns the luma of a colour; that of a grey is its level.
fn luma([red, green, blue, _]: Rgba) -> u8 {
    let luma = 2126 * u32::from(red) + 7152 * u32::from(green) + 722 * u32::from(blue);
    u8::try_from((luma + 5000) / 10_000).unwrap_or(u8::MAX)
}

/// Colours of a picture.
pub(in crate::render) struct Colours {
    /// All colours, if there are at most 256.
    few: Few,
    grey: bool,
    opaque: bool,
    /// Numbers of pixels, and of runs of one colour in their rows.
    pixels: u64,
    runs: u64,
}

/// Set of some hundred colours: a hash table with linear probing.
struct Few {
    colours: Vec<PremultipliedColorU8>,
    /// Index of a colour plus 1; 0 for a free slot.
    slots: [u16; Self::SLOTS],
}

impl Few {
    const MOST: usize = 256;
    const SLOTS: usize = 1024;

    /// Creates a set of colours.
    fn new(colours: Vec<PremultipliedColorU8>) -> Self {
        let mut few = Self {
            colours: Vec::new(),
            slots: [0; Self::SLOTS],
        };
        colours.into_iter().for_each(|colour| few.add(colour));
        few
    }

    /// Returns the slot in which a colour is or could be.
    fn slot(&self, colour: PremultipliedColorU8) -> usize {
        // Fibonacci hashing: the upper ten bits.
        let mut slot = bits(colour).wrapping_mul(0x9E37_79B9) as usize >> 22;
        while let Some(place) = self.slots[slot].checked_sub(1)
            && self.colours[usize::from(place)] != colour
        {
            slot = (slot + 1) % Self::SLOTS;
        }
        slot
    }

    /// Adds a colour, unless there are more than `MOST` already.
    fn add(&mut self, colour: PremultipliedColorU8) {
        if self.colours.len() > Self::MOST {
            return;
        }
        let slot = self.slot(colour);
        if self.slots[slot] == 0 {
            self.colours.push(colour);
            self.slots[slot] = u16::try_from(self.colours.len()).unwrap_or_default();
        }
    }

    /// Returns the index of a colour of the set.
    fn place(&self, colour: PremultipliedColorU8) -> u8 {
        let place = self.slots[self.slot(colour)].saturating_sub(1);
        u8::try_from(place).unwrap_or_default()
    }
}

/// Layout of pixels.
struct Layout {
    colour: ColorType,
    depth: BitDepth,
    opaque: bool,
}

impl Layout {
    /// Returns the layout of grey levels.
    fn grey(opaque: bool) -> Self {
        Self {
            colour: match opaque {
                true => ColorType::Grayscale,
                false => ColorType::GrayscaleAlpha,
            },
            depth: BitDepth::Eight,
            opaque,
        }
    }
}

impl Colours {
    /// Returns the colours of a picture without pixels.
    pub(in crate::render) fn none() -> Self {
        Self {
            few: Few::new(Vec::new()),
            grey: true,
            opaque: true,
            pixels: 0,
            runs: 0,
        }
    }

    fn of(pixmap: &Pixmap) -> Self {
        let mut colours = Self::none();
        colours.add(pixmap);
        colours.sorted()
    }

    /// Adds the colours of some pixels.
    pub(in crate::render) fn add(&mut self, pixmap: &Pixmap) {
        let width = pixmap.width() as usize;
        self.pixels += pixmap.pixels().len() as u64;
        // Runs end with their rows, whatever piece the rows come in.
        for row in pixmap.pixels().chunks_exact(width) {
            let mut last = None;
            for &pixel in row {
                if last == Some(pixel) {
                    continue;
                }
                last = Some(pixel);
                self.runs += 1;
                self.grey &= pixel.red() == pixel.green() && pixel.green() == pixel.blue();
                self.opaque &= pixel.is_opaque();
                self.few.add(pixel);
            }
        }
    }

    /// Returns whether runs of one colour are short in the mean.
    fn are_busy(&self) -> bool {
        self.pixels < SHORT * self.runs
    }

    /// Returns whether further pixels cannot change the layout, on a background that is opaque or not.
    pub(in crate::render) fn are_settled(&self, on_opaque: bool) -> bool {
        self.few.colours.len() > Few::MOST && !self.grey && (on_opaque || !self.opaque)
    }

    /// Sorts the colours, so that their order does not depend on their positions.
    pub(in crate::render) fn sorted(self) -> Self {
        let mut colours = self.few.colours;
        colours.sort_unstable_by_key(|&pixel| bits(pixel));
        Self {
            few: Few::new(colours),
            ..self
        }
    }

    /// Returns the colours of a palette in its order.
    fn palette(&self) -> Vec<Rgba> {
        self.few.colours.iter().map(|&pixel| rgba(pixel)).collect()
    }

    fn layout(&self) -> Layout {
        let count = self.few.colours.len();
        if self.grey && self.opaque && count > 16 || self.grey && count > Few::MOST {
            return Layout::grey(self.opaque);
        }
        let depth = match count {
            0..=2 => BitDepth::One,
            3..=4 => BitDepth::Two,
            5..=16 => BitDepth::Four,
            _ => BitDepth::Eight,
        };
        let colour = match self.opaque {
            _ if count <= Few::MOST => ColorType::Indexed,
            true => ColorType::Rgb,
            false => ColorType::Rgba,
        };
        Layout {
            colour,
            depth,
            opaque: self.opaque,
        }
    }
}

/// Returns a pixel as a number.
fn bits(pixel: PremultipliedColorU8) -> u32 {
    u32::from_be_bytes([pixel.alpha(), pixel.red(), pixel.green(), pixel.blue()])
}

/// Encodes a row as indices into the palette, packed from the left.
fn indices(pixels: &[PremultipliedColorU8], few: &Few, depth: BitDepth, row: &mut Vec<u8>) {
    let depth = depth as usize;
    let mut last = None;
    let mut place = 0;
    let (mut byte, mut used) = (0u8, 0);
    for &pixel in pixels {
        if last != Some(pixel) {
            last = Some(pixel);
            place = few.place(pixel);
        }
        used += depth;
        byte |= place << (8 - used);
        if used == 8 {
            row.push(byte);
            (byte, used) = (0, 0);
        }
    }
    if used > 0 {
        row.push(byte);
    }
}

fn io_error(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
