//! Fuzzing of pictures: read, and their pixels measured.
//!
//! Checks that a picture has as many values as pixels, that messages are of bounded length, and that estimates are
//! finite.

#![no_main]

use std::num::NonZero;

use kfrac::Bits;
use kfrac::import::{Channel, Raster};
use kfrac::measure::{BoxCounting, Grid};
use libfuzzer_sys::fuzz_target;

/// Maximum number of pixels that are measured.
const MAX_PIXELS: usize = 1 << 12;

fuzz_target!(|bytes: &[u8]| {
    for channel in [None, Some(Channel::Darkness), Some(Channel::Alpha)] {
        let picture = match Raster::read(bytes, channel) {
            Ok(picture) => picture,
            Err(error) => {
                assert!(error.to_string().len() < 1 << 12, "too much is said");
                continue;
            }
        };
        let pixels = picture
            .width
            .checked_mul(picture.height)
            .expect("pixels are counted");
        assert_eq!(picture.values.len(), pixels);
        if pixels > MAX_PIXELS {
            continue;
        }
        for picture in [picture.clone(), picture.inverted()] {
            let bits = Bits::of_bytes(
                &picture.values,
                picture.width,
                picture.height,
                picture.otsu(),
            );
            if bits.is_empty() {
                continue;
            }
            let counting =
                BoxCounting::of_pixels(&bits, None, &[Grid::ALONG], NonZero::<usize>::MIN);
            if let Some(estimate) = counting.estimate {
                assert!(
                    estimate.value.is_finite() && estimate.std_error >= 0.0,
                    "{estimate:?}"
                );
            }
        }
    }
});
