//! Pictures (PNG, JPEG, PBM, PGM and PPM) as one value a pixel, and thresholds that separate the set from its background.

#[cfg(feature = "jpeg")]
mod jpeg;
mod pnm;

use std::io::Cursor;

use png::{ColorType, Decoder, Limits, Transformations};

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
        jpeg::read(bytes, pixels)
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

/// Refusal of pictures in JPEG.
#[cfg(not(feature = "jpeg"))]
mod jpeg {
    use super::{PictureError, PixelSink};

    pub(super) fn read(_: &[u8], _: &mut impl PixelSink) -> Result<[usize; 2], PictureError> {
        let message = "the feature `jpeg` of kfrac is not enabled";
        Err(PictureError::Jpeg(message.into()))
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
