use std::io::{self, Write};

use png::{BitDepth, ColorType, Compression, DeflateCompression, Encoder, EncodingError, Filter};
use tiny_skia::{Pixmap, PremultipliedColorU8};

use crate::render::Labels;

/// Edges of one colour have no more tones than this. What has more is continuous: palettes, densities.
const TONES: usize = 128;

/// Writes pixels as PNG, with no more bits a pixel than they need: indexed where there are 256
/// colours at most, grey where there is nothing else, without opacity where all is opaque.
pub(in crate::render) fn encode(
    pixmap: &Pixmap,
    labels: &Labels,
    out: &mut impl Write,
) -> io::Result<()> {
    let colours = Colours::of(pixmap);
    let size = [pixmap.width(), pixmap.height()];
    encode_pieces(size, &colours, labels, out, |encode| encode(pixmap))
}

/// The same of pixels that come in pieces of some rows each, from the top, and of whose colours all
/// is known. `give` hands on one after another.
pub(in crate::render) fn encode_pieces<E: From<io::Error>>(
    [width, height]: [u32; 2],
    colours: &Colours,
    labels: &Labels,
    out: &mut impl Write,
    give: impl FnOnce(&mut dyn FnMut(&Pixmap) -> io::Result<()>) -> Result<(), E>,
) -> Result<(), E> {
    let mut encoder = Encoder::new(out, width, height);
    let layout = colours.layout();
    if colours.few.colours.len() > TONES {
        // Half the time of what is usual, for a tenth more bytes: these pictures take longest.
        encoder.set_deflate_compression(DeflateCompression::Level(2));
    } else {
        encoder.set_compression(Compression::Balanced);
    }
    // Line art has long runs of one colour, which filters, a compression's own too, only break up.
    encoder.set_filter(Filter::NoFilter);
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
    for (keyword, text) in [
        ("Title", labels.title.as_str()),
        ("Description", &labels.description),
        ("Software", concat!("kfrac ", env!("CARGO_PKG_VERSION"))),
        ("Comment", &labels.provenance),
    ] {
        if !text.is_empty() {
            encoder
                .add_itxt_chunk(keyword.into(), text.replace('\0', ""))
                .map_err(io_error)?;
        }
    }
    let mut writer = encoder.write_header().map_err(io_error)?;
    let mut stream = writer.stream_writer().map_err(io_error)?;
    let mut row = Vec::new();
    let mut encode = |pixmap: &Pixmap| -> io::Result<()> {
        for pixels in pixmap.pixels().chunks_exact(width as usize) {
            row.clear();
            match layout.colour {
                ColorType::Indexed => indices(pixels, &colours.few, layout.depth, &mut row),
                ColorType::Grayscale => row.extend(pixels.iter().map(|pixel| pixel.red())),
                ColorType::GrayscaleAlpha => row.extend(pixels.iter().flat_map(|&pixel| {
                    let [grey, _, _, opacity] = rgba(pixel);
                    [grey, opacity]
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

type Rgba = [u8; 4];

fn rgba(pixel: PremultipliedColorU8) -> Rgba {
    let colour = pixel.demultiply();
    [colour.red(), colour.green(), colour.blue(), colour.alpha()]
}

/// What colours a picture has.
pub(in crate::render) struct Colours {
    /// Every one of them, if there are 256 at most.
    few: Few,
    grey: bool,
    opaque: bool,
}

/// Some hundred colours, and where to find them: a hash table with linear probing.
struct Few {
    colours: Vec<PremultipliedColorU8>,
    /// One more than the place of a colour, 0 where there is none.
    slots: [u16; Self::SLOTS],
}

impl Few {
    const MOST: usize = 256;
    const SLOTS: usize = 1024;

    /// The first colours.
    fn new(colours: Vec<PremultipliedColorU8>) -> Self {
        let mut few = Self {
            colours: Vec::new(),
            slots: [0; Self::SLOTS],
        };
        colours.into_iter().for_each(|colour| few.add(colour));
        few
    }

    /// Where a colour is, or could be.
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

    /// Adds a colour, unless there are more than enough.
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

    /// The place of a colour that there is.
    fn place(&self, colour: PremultipliedColorU8) -> u8 {
        let place = self.slots[self.slot(colour)].saturating_sub(1);
        u8::try_from(place).unwrap_or_default()
    }
}

/// How pixels are laid out.
struct Layout {
    colour: ColorType,
    depth: BitDepth,
    opaque: bool,
}

impl Colours {
    /// Those of a picture without pixels.
    pub(in crate::render) fn none() -> Self {
        Self {
            few: Few::new(Vec::new()),
            grey: true,
            opaque: true,
        }
    }

    fn of(pixmap: &Pixmap) -> Self {
        let mut colours = Self::none();
        colours.add(pixmap);
        colours.sorted()
    }

    /// Adds those of some pixels.
    pub(in crate::render) fn add(&mut self, pixmap: &Pixmap) {
        let mut last = None;
        for &pixel in pixmap.pixels() {
            if last == Some(pixel) {
                continue;
            }
            last = Some(pixel);
            self.grey &= pixel.red() == pixel.green() && pixel.green() == pixel.blue();
            self.opaque &= pixel.is_opaque();
            self.few.add(pixel);
        }
    }

    /// Whether more pixels change nothing, on a background that is opaque or is not.
    pub(in crate::render) fn are_settled(&self, on_opaque: bool) -> bool {
        self.few.colours.len() > Few::MOST && !self.grey && (on_opaque || !self.opaque)
    }

    /// The same in an order that does not depend on where they are.
    pub(in crate::render) fn sorted(self) -> Self {
        let mut colours = self.few.colours;
        colours.sort_unstable_by_key(|&pixel| bits(pixel));
        Self {
            few: Few::new(colours),
            ..self
        }
    }

    /// The colours of a palette in its order.
    fn palette(&self) -> Vec<Rgba> {
        self.few.colours.iter().map(|&pixel| rgba(pixel)).collect()
    }

    fn layout(&self) -> Layout {
        let count = self.few.colours.len();
        let depth = match count {
            0..=2 => BitDepth::One,
            3..=4 => BitDepth::Two,
            5..=16 => BitDepth::Four,
            _ => BitDepth::Eight,
        };
        let colour = match (self.grey, self.opaque) {
            _ if count <= 16 => ColorType::Indexed,
            (true, true) => ColorType::Grayscale,
            _ if count <= Few::MOST => ColorType::Indexed,
            (true, false) => ColorType::GrayscaleAlpha,
            (false, true) => ColorType::Rgb,
            (false, false) => ColorType::Rgba,
        };
        Layout {
            colour,
            depth,
            opaque: self.opaque,
        }
    }
}

/// A pixel as a number.
fn bits(pixel: PremultipliedColorU8) -> u32 {
    u32::from_be_bytes([pixel.alpha(), pixel.red(), pixel.green(), pixel.blue()])
}

/// A row of a picture with a palette: places in it, packed from the left.
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
