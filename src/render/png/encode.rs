use std::collections::HashMap;
use std::io::{self, Write};

use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};
use tiny_skia::{Pixmap, PremultipliedColorU8};

use crate::render::Labels;

/// Writes pixels as PNG, with no more bits a pixel than they need: indexed where there are 256
/// colours at most, grey where there is nothing else, without opacity where all is opaque.
pub(super) fn encode(pixmap: &Pixmap, labels: &Labels, out: &mut impl Write) -> io::Result<()> {
    let mut encoder = Encoder::new(out, pixmap.width(), pixmap.height());
    // Line art has long runs of one colour, which filters only break up.
    encoder.set_filter(Filter::NoFilter);
    encoder.set_compression(Compression::Balanced);
    let colours = Colours::of(pixmap);
    let layout = colours.layout();
    encoder.set_color(layout.colour);
    encoder.set_depth(layout.depth);
    if layout.colour == ColorType::Indexed {
        let colours = colours.sorted();
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
    let index = colours.index();
    let width = pixmap.width() as usize;
    let mut row = Vec::new();
    for pixels in pixmap.pixels().chunks_exact(width) {
        row.clear();
        match layout.colour {
            ColorType::Indexed => indices(pixels, &index, layout.depth, &mut row),
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
    stream.finish().map_err(io_error)?;
    writer.finish().map_err(io_error)
}

type Rgba = [u8; 4];

fn rgba(pixel: PremultipliedColorU8) -> Rgba {
    let colour = pixel.demultiply();
    [colour.red(), colour.green(), colour.blue(), colour.alpha()]
}

/// What colours a picture has.
struct Colours {
    /// Every one of them, if there are 256 at most.
    few: Option<Vec<PremultipliedColorU8>>,
    grey: bool,
    opaque: bool,
}

/// How pixels are laid out.
struct Layout {
    colour: ColorType,
    depth: BitDepth,
    opaque: bool,
}

impl Colours {
    const FEW: usize = 256;

    fn of(pixmap: &Pixmap) -> Self {
        let mut seen = HashMap::new();
        let (mut grey, mut opaque) = (true, true);
        let mut last = None;
        for &pixel in pixmap.pixels() {
            if last == Some(pixel) {
                continue;
            }
            last = Some(pixel);
            grey &= pixel.red() == pixel.green() && pixel.green() == pixel.blue();
            opaque &= pixel.is_opaque();
            if seen.len() <= Self::FEW {
                seen.insert(bits(pixel), pixel);
            }
        }
        let few = (seen.len() <= Self::FEW).then(|| {
            let mut all: Vec<_> = seen.into_values().collect();
            all.sort_unstable_by_key(|&pixel| bits(pixel));
            all
        });
        Self { few, grey, opaque }
    }

    /// The colours of a palette in its order.
    fn sorted(&self) -> Vec<Rgba> {
        let few = self.few.as_deref().unwrap_or_default();
        few.iter().map(|&pixel| rgba(pixel)).collect()
    }

    /// The place of every colour in the palette.
    fn index(&self) -> HashMap<u32, u8> {
        let few = self.few.as_deref().unwrap_or_default();
        few.iter().map(|&pixel| bits(pixel)).zip(0..=255).collect()
    }

    fn layout(&self) -> Layout {
        let count = self.few.as_ref().map_or(usize::MAX, Vec::len);
        let depth = match count {
            0..=2 => BitDepth::One,
            3..=4 => BitDepth::Two,
            5..=16 => BitDepth::Four,
            _ => BitDepth::Eight,
        };
        let colour = match (self.grey, self.opaque) {
            _ if count <= 16 => ColorType::Indexed,
            (true, true) => ColorType::Grayscale,
            _ if count <= Self::FEW => ColorType::Indexed,
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
fn indices(
    pixels: &[PremultipliedColorU8],
    index: &HashMap<u32, u8>,
    depth: BitDepth,
    row: &mut Vec<u8>,
) {
    let depth = depth as usize;
    let mut last = None;
    let mut place = 0;
    let (mut byte, mut used) = (0u8, 0);
    for &pixel in pixels {
        if last != Some(pixel) {
            last = Some(pixel);
            place = index.get(&bits(pixel)).copied().unwrap_or_default();
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
