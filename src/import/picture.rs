//! Pictures (PNG, JPEG, PBM, PGM and PPM) as one value a pixel, and thresholds that separate the set from its background.

mod pnm;

use std::io::Cursor;

use png::{ColorType, Decoder, Limits, Transformations};
#[cfg(feature = "jpeg")]
use zune_jpeg::{
    JpegDecoder, zune_core::colorspace::ColorSpace, zune_core::options::DecoderOptions,
};

/// Limit of the number of pixels.
const MAX_PIXELS: u64 = 1 << 30;

/// An error in reading a picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// The file has none of the known formats.
    #[error("the picture is neither PNG, JPEG, PBM, PGM nor PPM")]
    Unknown,
    /// The PNG cannot be read.
    #[error("the PNG cannot be read")]
    Png(#[from] png::DecodingError),
    /// The JPEG cannot be read.
    #[error("the JPEG cannot be read: {0}")]
    Jpeg(String),
    /// The PBM, PGM or PPM cannot be read.
    #[error("the PBM, PGM or PPM cannot be read: {0}")]
    Pnm(String),
    /// The picture has too many pixels.
    #[error("the picture has {width} x {height} pixels, more than {MAX_PIXELS}")]
    TooLarge {
        /// Width of the picture.
        width: u64,
        /// Height of the picture.
        height: u64,
    },
    /// The picture has no pixels.
    #[error("the picture has no pixels")]
    Empty,
}

/// The property of a pixel that decides whether it belongs to the set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Darkness: 0 for white, 255 for black (ITU-R BT.601).
    Darkness,
    /// Opacity: 0 for transparent, 255 for opaque.
    Alpha,
}

/// A picture with one value a pixel.
#[derive(Clone, Debug)]
pub struct Raster {
    /// The number of pixels in a row.
    pub width: usize,
    /// The number of rows.
    pub height: usize,
    /// Property that the values hold.
    pub channel: Channel,
    /// Values, row by row from the top.
    pub values: Vec<u8>,
}

impl Raster {
    /// Returns whether bytes start with the signature of a PNG, JPEG, PBM, PGM or PPM.
    #[must_use]
    pub fn is_picture(bytes: &[u8]) -> bool {
        is_png(bytes) || is_jpeg(bytes) || pnm::is_pnm(bytes)
    }

    /// Reads a PNG, JPEG, PBM, PGM or PPM.
    ///
    /// With `None`, the channel is the opacity if the picture has transparent pixels, or else the darkness.
    /// The darkness of a transparent pixel is that on a white background. A JPEG has the orientation that its Exif data state.
    ///
    /// # Errors
    ///
    /// Returns an error if the bytes have none of these formats or are damaged, or if the picture is empty or too
    /// large.
    pub fn read(bytes: &[u8], channel: Option<Channel>) -> Result<Self, PictureError> {
        let mut pixels = Pixels::new(channel);
        let [width, height] = decode(bytes, &mut pixels)?;
        let (values, channel) = pixels.finish();
        Ok(Self {
            width,
            height,
            channel,
            values,
        })
    }

    /// Returns the picture with every value subtracted from 255, which exchanges the set and its background.
    #[must_use]
    pub fn inverted(mut self) -> Self {
        self.values
            .iter_mut()
            .for_each(|value| *value = 255 - *value);
        self
    }

    /// Returns the threshold that separates the values best; values from the threshold on belong to the set
    /// (Otsu 1979).
    ///
    /// The threshold of a picture with a single value is 128.
    #[must_use]
    pub fn otsu(&self) -> u8 {
        let mut histogram = [0u64; 256];
        for &value in &self.values {
            histogram[usize::from(value)] += 1;
        }
        otsu(&histogram)
    }
}

/// Returns the threshold with the largest variance between the two classes.
#[expect(
    clippy::cast_precision_loss,
    reason = "a threshold is chosen, nothing is counted"
)]
fn otsu(histogram: &[u64; 256]) -> u8 {
    let total: u64 = histogram.iter().sum();
    let moment = |(value, &count): (usize, &u64)| value as u64 * count;
    let sum: u64 = histogram.iter().enumerate().map(moment).sum();
    let (mut below, mut sum_below) = (0, 0);
    let mut best = (0.0, 128);
    for threshold in 1..=255u8 {
        let value = usize::from(threshold) - 1;
        below += histogram[value];
        sum_below += value as u64 * histogram[value];
        let above = total - below;
        if below == 0 || above == 0 {
            continue;
        }
        let means = sum_below as f64 / below as f64 - (sum - sum_below) as f64 / above as f64;
        let variance = below as f64 * above as f64 * means * means;
        if variance > best.0 {
            best = (variance, threshold);
        }
    }
    best.1
}

fn is_png(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89PNG\r\n\x1a\n")
}

fn is_jpeg(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0xff, 0xd8, 0xff])
}

/// Returns an error if a picture is empty or has more than [`MAX_PIXELS`] pixels.
fn check(width: u64, height: u64) -> Result<(), PictureError> {
    match width.checked_mul(height) {
        Some(0) => Err(PictureError::Empty),
        Some(pixels) if pixels <= MAX_PIXELS => Ok(()),
        _ => Err(PictureError::TooLarge { width, height }),
    }
}

/// Receiver of the samples of a picture.
pub(super) trait PixelSink {
    /// Begins a picture with a number of pixels of one to four channels: grey, grey and alpha, RGB, or RGBA.
    fn begin(&mut self, count: usize, channels: usize);
    /// Adds samples of complete pixels, from the top and from the left.
    fn add(&mut self, samples: &[u8]);
}

/// Reads a PNG, JPEG, PBM, PGM or PPM; returns width and height.
pub(super) fn decode(
    bytes: &[u8],
    pixels: &mut impl PixelSink,
) -> Result<[usize; 2], PictureError> {
    if is_png(bytes) {
        png(bytes, pixels)
    } else if is_jpeg(bytes) {
        jpeg(bytes, pixels)
    } else if pnm::is_pnm(bytes) {
        pnm::read(bytes, pixels)
    } else {
        Err(PictureError::Unknown)
    }
}

fn png(bytes: &[u8], pixels: &mut impl PixelSink) -> Result<[usize; 2], PictureError> {
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), Limits { bytes: 1 << 28 });
    decoder.set_transformations(Transformations::normalize_to_color8());
    let header = decoder.read_header_info()?;
    check(header.width.into(), header.height.into())?;
    let mut reader = decoder.read_info()?;
    let (width, height) = reader.info().size();
    let (width, height) = (width as usize, height as usize);
    let channels = match reader.output_color_type().0 {
        ColorType::Grayscale => 1,
        ColorType::GrayscaleAlpha => 2,
        ColorType::Rgb => 3,
        _ => 4,
    };
    pixels.begin(width * height, channels);
    if reader.info().interlaced {
        // The rows of an interlaced picture come out of order: the whole frame is needed.
        let mut frame = vec![0; width * height * channels];
        reader.next_frame(&mut frame)?;
        pixels.add(&frame);
    } else {
        while let Some(row) = reader.next_row()? {
            pixels.add(row.data());
        }
    }
    Ok([width, height])
}

#[cfg(not(feature = "jpeg"))]
fn jpeg(_: &[u8], _: &mut impl PixelSink) -> Result<[usize; 2], PictureError> {
    Err(PictureError::Jpeg(
        "the feature `jpeg` of kfrac is not enabled".into(),
    ))
}

#[cfg(feature = "jpeg")]
fn jpeg(bytes: &[u8], pixels: &mut impl PixelSink) -> Result<[usize; 2], PictureError> {
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
#[cfg(feature = "jpeg")]
struct Orientation {
    /// Whether rows are columns.
    is_transposed: bool,
    /// Whether columns and rows, as they are stored, run backwards.
    is_reversed: [bool; 2],
}

#[cfg(feature = "jpeg")]
impl Orientation {
    /// Reads the orientation from Exif data; `None` if there is none, or if the picture is shown as it is stored.
    fn read(exif: &[u8]) -> Option<Self> {
        let exif = exif::Reader::new().read_raw(exif.to_vec()).ok()?;
        let field = exif.get_field(exif::Tag::Orientation, exif::In::PRIMARY)?;
        let (is_transposed, is_reversed) = match field.value.get_uint(0)? {
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

/// Accumulator of samples, which reduces each pixel to one value.
struct Pixels {
    channels: usize,
    asked: Option<Channel>,
    darkness: Vec<u8>,
    alpha: Vec<u8>,
}

impl Pixels {
    fn new(asked: Option<Channel>) -> Self {
        Self {
            channels: 1,
            asked,
            darkness: Vec::new(),
            alpha: Vec::new(),
        }
    }

    fn finish(self) -> (Vec<u8>, Channel) {
        let channel = self.asked.unwrap_or_else(|| {
            if self.alpha.iter().any(|&alpha| alpha < 255) {
                Channel::Alpha
            } else {
                Channel::Darkness
            }
        });
        match channel {
            Channel::Darkness => (self.darkness, channel),
            Channel::Alpha => (self.alpha, channel),
        }
    }
}

impl PixelSink for Pixels {
    fn begin(&mut self, count: usize, channels: usize) {
        self.channels = channels;
        let room = |wanted: bool| Vec::with_capacity(if wanted { count } else { 0 });
        self.darkness = room(self.asked != Some(Channel::Alpha));
        self.alpha = room(keeps_alpha(self.asked, channels));
    }

    fn add(&mut self, samples: &[u8]) {
        for pixel in samples.chunks_exact(self.channels) {
            let (grey, alpha) = match *pixel {
                [grey] => (grey, 255),
                [grey, alpha] => (grey, alpha),
                [red, green, blue] => (luma(red, green, blue), 255),
                [red, green, blue, alpha] => (luma(red, green, blue), alpha),
                _ => unreachable!("pixels have one to four channels"),
            };
            if self.asked != Some(Channel::Alpha) {
                let darkness = u32::from(255 - grey) * u32::from(alpha) + 127;
                self.darkness
                    .push(u8::try_from(darkness / 255).unwrap_or(255));
            }
            if keeps_alpha(self.asked, self.channels) {
                self.alpha.push(alpha);
            }
        }
    }
}

/// Returns whether the opacity may be the channel of the result.
fn keeps_alpha(asked: Option<Channel>, channels: usize) -> bool {
    match asked {
        Some(channel) => channel == Channel::Alpha,
        None => channels.is_multiple_of(2),
    }
}

/// Returns the luminance of a colour (ITU-R BT.601), with weights in 65,536ths.
fn luma(red: u8, green: u8, blue: u8) -> u8 {
    let [red, green, blue] = [red, green, blue].map(u32::from);
    let sum = 19_595 * red + 38_470 * green + 7_471 * blue + 0x8000;
    u8::try_from(sum >> 16).unwrap_or(255)
}

#[cfg(test)]
#[cfg(feature = "jpeg")]
mod tests {
    use super::*;

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
        // Data that cannot be read have no effect.
        for damaged in [&b""[..], b"MM\0*\0\0\0\x08\0\x01", b"JJ\0*\0\0\0\x08"] {
            assert_eq!(quarters(&with_exif(damaged)), (LEFT, wide));
        }
    }
}
