//! Pictures of bits as PNG.

use std::io::{self, Write};

use png::{BitDepth, ColorType, Encoder, EncodingError};

use crate::bits::Bits;

/// Writes a picture of bits as a PNG with one bit a pixel: black where a bit is set, white elsewhere.
///
/// # Errors
///
/// Returns an error if `out` fails, or if a side is longer than 2³¹ − 1 pixels or 0.
pub fn write_bits(bits: &Bits, out: &mut impl Write) -> io::Result<()> {
    let failed = |error: EncodingError| match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    };
    let side = |side: usize| u32::try_from(side).map_err(io::Error::other);
    let mut encoder = Encoder::new(&mut *out, side(bits.width())?, side(bits.height())?);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::One);
    let mut writer = encoder.write_header().map_err(failed)?;
    let bytes = bits.width().div_ceil(8);
    let rows = (0..bits.height()).flat_map(|row| {
        let words = bits.row(row).iter();
        let bytes_of = |word: &u64| word.to_le_bytes().map(|byte| !byte.reverse_bits());
        words.flat_map(bytes_of).take(bytes)
    });
    let rows: Vec<u8> = rows.collect();
    writer.write_image_data(&rows).map_err(failed)?;
    writer.finish().map_err(failed)
}
