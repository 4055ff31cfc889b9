//! Pictures of grey levels, or of opaque colours, in memory.

use png::{BitDepth, ColorType, Compression, Encoder, Filter};

use crate::chaos::Histogram;
use crate::style::Tone;

/// Picture of 8 bits a channel, in rows from the top: grey levels, or red, green and blue (sRGB).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Levels {
    size: [u32; 2],
    channels: u8,
    bytes: Vec<u8>,
}

impl Levels {
    /// Creates a picture of grey levels; `None` if their number is not that of the pixels.
    #[must_use]
    pub fn grey(size: [u32; 2], bytes: Vec<u8>) -> Option<Self> {
        Self::of(size, 1, bytes)
    }

    /// Creates a picture of colours; `None` if there are not three bytes a pixel.
    #[must_use]
    pub fn rgb(size: [u32; 2], bytes: Vec<u8>) -> Option<Self> {
        Self::of(size, 3, bytes)
    }

    fn of(size: [u32; 2], channels: u8, bytes: Vec<u8>) -> Option<Self> {
        let pixels = size[0] as usize * size[1] as usize;
        let fits = pixels > 0 && bytes.len() == pixels * usize::from(channels);
        fits.then_some(Self {
            size,
            channels,
            bytes,
        })
    }

    /// Returns the levels of a histogram of one class: 0 for pixels that are not hit, and 1 to 255 by the tone.
    ///
    /// ```
    /// # fn main() -> Result<(), kfrac::Error> {
    /// use kfrac::render::Levels;
    /// use kfrac::style::Tone;
    ///
    /// let fern = kfrac::Fractal::named("barnsley-fern")?.histogram(100_000, (256, 256))?;
    /// let picture = Levels::of_hits(&fern, Tone::Log);
    /// assert_eq!(picture.bytes().iter().max(), Some(&255));
    /// assert!(picture.into_png().starts_with(b"\x89PNG"));
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn of_hits(histogram: &Histogram, tone: Tone) -> Self {
        Self::of_counts(histogram.counts(0), histogram.size(), tone)
    }

    /// Returns the levels of points that were counted in the pixels.
    pub(crate) fn of_counts(counts: &[u32], size: [u32; 2], tone: Tone) -> Self {
        let most = counts.iter().copied().max().unwrap_or(0);
        let level = |hits: u32| match hits {
            0 => 0,
            hits => super::density::level(tone.of(hits.into(), most.into())),
        };
        let known: Vec<u8> = (0..=most.min(TABULATED)).map(level).collect();
        let levels = counts.iter().map(|&hits| match known.get(hits as usize) {
            Some(&level) => level,
            None => level(hits),
        });
        Self {
            size,
            channels: 1,
            bytes: levels.collect(),
        }
    }

    /// Returns width and height.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the number of bytes a pixel: 1 for grey levels, 3 for colours.
    #[must_use]
    pub fn channels(&self) -> u8 {
        self.channels
    }

    /// Returns the bytes of all pixels.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Converts to the bytes of all pixels.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    /// Encodes the picture as the bytes of a PNG without metadata, with compression that is fast rather than strong.
    #[must_use]
    pub fn into_png(self) -> Vec<u8> {
        let mut png = Vec::with_capacity(self.bytes.len() / 4 + 1024);
        let mut encoder = Encoder::new(&mut png, self.size[0], self.size[1]);
        encoder.set_color(match self.channels {
            1 => ColorType::Grayscale,
            _ => ColorType::Rgb,
        });
        encoder.set_depth(BitDepth::Eight);
        encoder.set_compression(Compression::Fast);
        // That compression shortens runs of zeros, which the background is made of.
        encoder.set_filter(Filter::NoFilter);
        let written = encoder.write_header().and_then(|mut writer| {
            writer.write_image_data(&self.bytes)?;
            writer.finish()
        });
        // Writing to memory does not fail, and the number of bytes is that of the header.
        debug_assert!(written.is_ok(), "{written:?}");
        png
    }
}

/// Number of hits up to which levels are tabulated.
const TABULATED: u32 = 4096;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_read_back() {
        let bytes: Vec<u8> = (0..60).map(|it| if it % 7 == 0 { it } else { 0 }).collect();
        for (channels, size) in [(1, [10, 6]), (3, [5, 4])] {
            let picture = Levels::of(size, channels, bytes.clone()).unwrap();
            let png = picture.into_png();
            let mut reader = png::Decoder::new(std::io::Cursor::new(png))
                .read_info()
                .unwrap();
            let mut decoded = vec![0; reader.output_buffer_size().unwrap()];
            let info = reader.next_frame(&mut decoded).unwrap();
            assert_eq!([info.width, info.height], size);
            assert_eq!(decoded, bytes);
        }
        assert_eq!(Levels::grey([3, 3], vec![0; 8]), None);
        assert_eq!(Levels::rgb([0, 3], Vec::new()), None);
    }
}
