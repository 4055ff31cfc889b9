//! YUV4MPEG2: frames without compression, for other encoders.

use std::io::{self, Write};

use super::{FilmEncoder, FilmOptions, on_white, runs};

/// Differences of greys.
const NO_COLOUR: u8 = 128;

/// Encoder of YUV4MPEG2: three planes of full size a frame, in the limited range of ITU-R BT.601, on white paper.
pub(crate) struct Y4m<W> {
    out: W,
    planes: [Vec<u8>; 3],
}

impl<W: Write> Y4m<W> {
    /// Begins a film.
    pub(crate) fn begin(mut out: W, options: &FilmOptions) -> io::Result<Self> {
        let [width, height] = options.size;
        let rate = options.rate;
        writeln!(
            out,
            "YUV4MPEG2 W{width} H{height} F{}:{} Ip A1:1 C444 XCOLORRANGE=LIMITED",
            rate.frames, rate.seconds
        )?;
        Ok(Self {
            out,
            planes: Default::default(),
        })
    }
}

impl<W: Write> FilmEncoder for Y4m<W> {
    fn add(&mut self, pixels: &[u8]) -> io::Result<()> {
        let count = pixels.len() / 4;
        for plane in &mut self.planes {
            plane.resize(count, NO_COLOUR);
        }
        let [luma, colours @ ..] = &mut self.planes;
        colours.iter_mut().for_each(|plane| plane.fill(NO_COLOUR));
        let mut first = 0;
        for run in runs(pixels) {
            let end = first + run.len();
            let [own, differences @ ..] = converted(on_white(run[0]));
            luma[first..end].fill(own);
            if differences != [NO_COLOUR; 2] {
                for (plane, value) in colours.iter_mut().zip(differences) {
                    plane[first..end].fill(value);
                }
            }
            first = end;
        }
        self.out.write_all(b"FRAME\n")?;
        { self.planes.iter() }.try_for_each(|plane| self.out.write_all(plane))
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.out.flush()
    }
}

/// Returns luma and both differences of a colour, rounded.
fn converted(colour: [u8; 3]) -> [u8; 3] {
    let [red, green, blue] = colour.map(i32::from);
    let luma = 16_829 * red + 33_039 * green + 6_416 * blue;
    let blueness = -9_714 * red - 19_070 * green + 28_784 * blue;
    let redness = 28_784 * red - 24_103 * green - 4_681 * blue;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "from 16 to 240"
    )]
    let rounded = |sum: i32, zero: i32| (((sum + (1 << 15)) >> 16) + zero) as u8;
    [
        rounded(luma, 16),
        rounded(blueness, 128),
        rounded(redness, 128),
    ]
}

#[cfg(test)]
mod tests {
    use super::converted;

    #[test]
    fn colours_have_the_values_of_the_standard() {
        assert_eq!(converted([255; 3]), [235, 128, 128]);
        assert_eq!(converted([0; 3]), [16, 128, 128]);
        assert_eq!(converted([255, 0, 0]), [81, 90, 240]);
        assert_eq!(converted([0, 255, 0]), [145, 54, 34]);
        assert_eq!(converted([0, 0, 255]), [41, 240, 110]);
    }
}
