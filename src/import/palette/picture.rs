//! Palettes of pictures: their most frequent colours.

use color_quant::NeuQuant;

use super::super::picture::{PictureError, PixelSink, decode};
use crate::fast_hash::FastMap;
use crate::style::{Colour, Palette, oklab, similar};

/// Number of colours into which a picture is divided first.
const MAX_QUANTISED: usize = 256;

/// Limit of the number of samples of a picture from which its colours are found.
const MAX_SAMPLED: usize = 1 << 20;

/// Reads a PNG, JPEG, PBM, PGM or PPM, and returns a palette of at most `count` of its colours, from the darkest to the
/// lightest. Pixels are divided into colours by a neural network (Dekker 1994), of which similar ones are merged by
/// their frequency (Ward 1963) in Oklab. Transparent pixels do not count.
///
/// # Errors
///
/// Returns an error if the picture cannot be read, or has no opaque pixels.
pub(crate) fn of_picture(bytes: &[u8], count: usize) -> Result<Palette, PictureError> {
    let mut colours = Colours::default();
    decode(bytes, &mut colours)?;
    if colours.rgba.is_empty() {
        return Err(PictureError::Empty);
    }
    let mut counts: FastMap<[u8; 3], u64> = FastMap::default();
    let pixels = colours.rgba.as_chunks::<4>().0;
    for [red, green, blue, _] in pixels {
        *counts.entry([*red, *green, *blue]).or_default() += 1;
    }
    if counts.len() > MAX_QUANTISED {
        counts.clear();
        let network = NeuQuant::new(1, MAX_QUANTISED, &colours.rgba);
        for pixel in pixels {
            let own = network.lookup(network.index_of(pixel));
            let [red, green, blue, _] = own.unwrap_or(*pixel);
            *counts.entry([red, green, blue]).or_default() += 1;
        }
    }
    let mut all: Vec<_> = counts.into_iter().collect();
    all.sort_unstable();
    let all: Vec<_> = { all.into_iter() }
        .map(|([red, green, blue], count)| (Colour::of_rgba([red, green, blue, 255]), count))
        .collect();
    let clusters = similar(&all, count);
    let mut found: Vec<Colour> = clusters.into_iter().map(|(colour, _)| colour).collect();
    found.sort_by(|a, b| oklab(*a)[0].total_cmp(&oklab(*b)[0]));
    Ok(Palette::of_colours("", &found))
}

/// Opaque colours of a picture, at most as many as are sampled.
#[derive(Default)]
struct Colours {
    channels: usize,
    /// One of so many pixels is sampled.
    stride: usize,
    /// Number of pixels so far.
    seen: usize,
    rgba: Vec<u8>,
}

impl PixelSink for Colours {
    fn begin(&mut self, count: usize, channels: usize) {
        (self.channels, self.stride) = (channels, count.div_ceil(MAX_SAMPLED).max(1));
    }

    fn add(&mut self, samples: &[u8]) {
        for pixel in samples.chunks_exact(self.channels) {
            self.seen += 1;
            if !self.seen.is_multiple_of(self.stride) {
                continue;
            }
            let ([red, green, blue], alpha) = match *pixel {
                [grey] => ([grey; 3], 255),
                [grey, alpha] => ([grey; 3], alpha),
                [red, green, blue] => ([red, green, blue], 255),
                [red, green, blue, alpha] => ([red, green, blue], alpha),
                _ => continue,
            };
            if alpha > 127 {
                self.rgba.extend([red, green, blue, 255]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ppm(pixels: &[[u8; 3]]) -> Vec<u8> {
        let mut bytes = format!("P6\n{} 1\n255\n", pixels.len()).into_bytes();
        bytes.extend(pixels.iter().flatten());
        bytes
    }

    #[test]
    fn pictures_have_their_frequent_colours() {
        let mut pixels = vec![[200, 30, 30]; 500];
        pixels.extend([[20, 20, 60]; 400]);
        pixels.extend([[240, 230, 200]; 300]);
        pixels.extend([[202, 31, 29]; 20]);
        let palette = of_picture(&ppm(&pixels), 3).unwrap();
        let names: Vec<_> = palette.colours().iter().map(ToString::to_string).collect();
        assert_eq!(names, ["#14143c", "#c81e1e", "#f0e6c8"]);
        // A picture of many colours.
        let mut many = Vec::new();
        for at in 0..30_000_u32 {
            let noise = |by: u32| u8::try_from(at * by % 23).unwrap();
            many.push(match at % 3 {
                0 => [180 + noise(7), noise(5), noise(11)],
                1 => [noise(13), 120 + noise(17), noise(3)],
                _ => [200 + noise(7), 200 + noise(9), 220 + noise(11)],
            });
        }
        let palette = of_picture(&ppm(&many), 3).unwrap();
        let near = [[191, 11, 11], [11, 131, 11], [211, 211, 231]];
        for (colour, near) in palette.colours().iter().zip(near) {
            let [red, green, blue, _] = colour.rgba();
            let off = [red, green, blue].into_iter().zip(near);
            let off = off.map(|(a, b)| a.abs_diff(b));
            assert!(off.max() < Some(25), "{colour} is not near {near:?}");
        }
        assert_eq!(of_picture(&ppm(&many), 3).unwrap(), palette);
        assert!(of_picture(&ppm(&[]), 3).is_err());
        assert!(of_picture(b"GIF89a", 3).is_err());
    }
}
