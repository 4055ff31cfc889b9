//! Pictures in JPEG, shown as their Exif data state.

use std::io::Cursor;

use zune_jpeg::{
    JpegDecoder, zune_core::colorspace::ColorSpace, zune_core::options::DecoderOptions,
};

use super::{PictureError, PixelSink, check};

/// Reads a JPEG; returns width and height as it is shown.
pub(super) fn read(bytes: &[u8], pixels: &mut impl PixelSink) -> Result<[usize; 2], PictureError> {
    let failed = |error: zune_jpeg::errors::DecodeErrors| PictureError::Jpeg(error.to_string());
    let options = DecoderOptions::default()
        .set_strict_mode(true)
        .set_max_width(usize::from(u16::MAX))
        .set_max_height(usize::from(u16::MAX))
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    decoder.decode_headers().map_err(failed)?;
    let Some(info) = decoder.info() else {
        return Err(PictureError::Empty);
    };
    check(info.width.into(), info.height.into())?;
    let size = [usize::from(info.width), usize::from(info.height)];
    let orientation = decoder.exif().and_then(|exif| Orientation::read(exif));
    let frame = decoder.decode().map_err(failed)?;
    if frame.len() != 3 * size[0] * size[1] {
        return Err(PictureError::Jpeg("pixels are missing".into()));
    }
    pixels.begin(size[0] * size[1], 3);
    let Some(orientation) = orientation else {
        pixels.add(&frame);
        return Ok(size);
    };
    let stored = frame.as_chunks::<3>().0;
    let shown @ [width, height] = orientation.size(size);
    let mut row = Vec::with_capacity(3 * width);
    for y in 0..height {
        row.clear();
        row.extend((0..width).flat_map(|x| {
            let [x, y] = orientation.place([x, y], size);
            stored[y * size[0] + x]
        }));
        pixels.add(&row);
    }
    Ok(shown)
}

/// Reflections by which a picture is shown otherwise than it is stored, as a camera notes that was turned (Exif 2.32, tag
/// 274).
struct Orientation {
    /// Whether rows are columns.
    is_transposed: bool,
    /// Whether columns and rows, as they are stored, run backwards.
    is_reversed: [bool; 2],
}

impl Orientation {
    /// Reads the orientation from the first directory of Exif data, which may have flaws elsewhere; `None` if there is
    /// none, or if the picture is shown as it is stored.
    fn read(exif: &[u8]) -> Option<Self> {
        /// Tag of the orientation, and the type of its value: one number of 16 bits.
        const ENTRY: [u16; 2] = [274, 3];
        let is_little = match exif.first_chunk()? {
            b"II*\0" => true,
            b"MM\0*" => false,
            _ => return None,
        };
        let short = match is_little {
            true => u16::from_le_bytes,
            false => u16::from_be_bytes,
        };
        let long = match is_little {
            true => u32::from_le_bytes,
            false => u32::from_be_bytes,
        };
        let place = long(*exif[4..].first_chunk()?);
        let directory = exif.get(usize::try_from(place).ok()?..)?;
        let (count, entries) = directory.split_first_chunk()?;
        let number = |entry: &[u8; 12], at: usize| short([entry[at], entry[at + 1]]);
        let mut entries = { entries.as_chunks().0.iter() }.take(short(*count).into());
        let entry = entries.find(|entry| [number(entry, 0), number(entry, 2)] == ENTRY)?;
        let (is_transposed, is_reversed) = match number(entry, 8) {
            2 => (false, [true, false]),
            3 => (false, [true, true]),
            4 => (false, [false, true]),
            5 => (true, [false, false]),
            6 => (true, [false, true]),
            7 => (true, [true, true]),
            8 => (true, [true, false]),
            _ => return None,
        };
        Some(Self {
            is_transposed,
            is_reversed,
        })
    }

    /// Returns width and height as they are shown.
    fn size(&self, [width, height]: [usize; 2]) -> [usize; 2] {
        match self.is_transposed {
            true => [height, width],
            false => [width, height],
        }
    }

    /// Returns the column and the row where a shown pixel is stored, in a picture that is stored in a size.
    fn place(&self, [x, y]: [usize; 2], size: [usize; 2]) -> [usize; 2] {
        let place = if self.is_transposed { [y, x] } else { [x, y] };
        [0, 1].map(|axis| match self.is_reversed[axis] {
            true => size[axis] - 1 - place[axis],
            false => place[axis],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::Raster;

    /// A JPEG of 16 × 8 pixels in hexadecimal digits, without Exif data: the upper left quarter, of 8 × 4 pixels, is dark.
    const QUARTER: &str = "ffd8ffe000104a46494600010100000100010000ffdb0043000d090a0b0a080d0b0a0b0e0e0d0f13201513121213271c\
        1e17202e2931302e292d2c333a4a3e333646372c2d405741464c4e525352323e5a615a50604a51524fffc0000b080008\
        001001011100ffc4001500010100000000000000000000000000000007ffc40018100002030000000000000000000000\
        0000001765a4e2ffda0008010100003f0028e7aa6ca71fffd9";

    fn quarter() -> Vec<u8> {
        let digits = QUARTER.as_bytes().as_chunks::<2>().0;
        let byte = |pair: &[u8; 2]| u8::from_str_radix(str::from_utf8(pair).unwrap(), 16);
        digits.iter().map(|pair| byte(pair).unwrap()).collect()
    }

    /// Returns the picture with Exif data.
    fn with_exif(exif: &[u8]) -> Vec<u8> {
        const HEADER: usize = 20;
        let length = u16::try_from(exif.len() + 8).unwrap();
        let mut bytes = quarter();
        let rest = bytes.split_off(HEADER);
        bytes.extend(b"\xff\xe1");
        bytes.extend(length.to_be_bytes());
        bytes.extend(b"Exif\0\0");
        bytes.extend(exif);
        bytes.extend(rest);
        bytes
    }

    /// Returns whether each quarter is dark, from the left and from the top, and the size.
    fn quarters(bytes: &[u8]) -> ([bool; 4], [usize; 2]) {
        let picture = Raster::read(bytes, None).unwrap();
        let size @ [width, height] = [picture.width, picture.height];
        let dark = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, down)| {
            let columns = right * width / 2..(right + 1) * width / 2;
            let rows = down * height / 2..(down + 1) * height / 2;
            let values = rows.flat_map(|y| columns.clone().map(move |x| y * width + x));
            let dark = values.filter(|at| picture.values[*at] > 128).count();
            assert!(dark == 0 || dark == width * height / 4, "{dark}");
            dark > 0
        });
        (dark, size)
    }

    #[test]
    fn a_jpeg_is_shown_as_its_camera_was_held() {
        const LEFT: [bool; 4] = [true, false, false, false];
        const RIGHT: [bool; 4] = [false, true, false, false];
        const LOWER_LEFT: [bool; 4] = [false, false, true, false];
        const LOWER_RIGHT: [bool; 4] = [false, false, false, true];
        let (wide, high) = ([16, 8], [8, 16]);
        assert_eq!(quarters(&quarter()), (LEFT, wide));
        for (orientation, shown) in [
            (1, (LEFT, wide)),
            (2, (RIGHT, wide)),
            (3, (LOWER_RIGHT, wide)),
            (4, (LOWER_LEFT, wide)),
            (5, (LEFT, high)),
            (6, (RIGHT, high)),
            (7, (LOWER_RIGHT, high)),
            (8, (LOWER_LEFT, high)),
            // No such orientation.
            (0, (LEFT, wide)),
            (9, (LEFT, wide)),
        ] {
            // A directory of one entry: tag 274, one short integer.
            let mut exif = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01".to_vec();
            exif.extend([0, orientation, 0, 0, 0, 0, 0, 0]);
            assert_eq!(quarters(&with_exif(&exif)), shown, "{orientation}");
        }
        // Little-endian data, and data with a flaw behind the orientation: the second entry is cut.
        let little = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0\x06\0\0\0\0\0\0\0";
        let cut = b"MM\0*\0\0\0\x08\0\x02\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\x01\x1a\0\x05";
        for turned in [&little[..], cut] {
            assert_eq!(quarters(&with_exif(turned)), (RIGHT, high));
        }
        // Data that cannot be read have no effect.
        for damaged in [&b""[..], b"MM\0*\0\0\0\x08\0\x01", b"JJ\0*\0\0\0\x08"] {
            assert_eq!(quarters(&with_exif(damaged)), (LEFT, wide));
        }
    }
}
