//! YUV4MPEG2: frames without compression, for other encoders.

use std::io::{self, Write};

use super::{FilmEncoder, FilmOptions, on_white, runs};

/// Differences of greys.
const NO_COLOUR: u8 = 128;

/// Encoder of YUV4MPEG2: three planes of full size a frame, in the limited range of ITU-R BT.601, on white paper.
pub(crate) struct Y4m<W> {
    out: W,
    planes: [Vec<u8>; 3],
    /// Whether the frame before has colours.
    is_coloured: bool,
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
            is_coloured: false,
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
        if std::mem::take(&mut self.is_coloured) {
            colours.iter_mut().for_each(|plane| plane.fill(NO_COLOUR));
        }
        let mut first = 0;
        for run in runs(pixels) {
            let end = first + run.len();
            let [own, differences @ ..] = converted(on_white(run[0]));
            luma[first..end].fill(own);
            if differences != [NO_COLOUR; 2] {
                self.is_coloured = true;
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
    // The factors of a difference add up to zero.
    let is_grey = red == green && green == blue;
    if is_grey {
        return [rounded(luma, 16), NO_COLOUR, NO_COLOUR];
    }
    let blueness = -9_714 * red - 19_070 * green + 28_784 * blue;
    let redness = 28_784 * red - 24_103 * green - 4_681 * blue;
    [
        rounded(luma, 16),
        rounded(blueness, 128),
        rounded(redness, 128),
    ]
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "from 16 to 240"
)]
fn rounded(sum: i32, zero: i32) -> u8 {
    (((sum + (1 << 15)) >> 16) + zero) as u8
}

#[cfg(test)]
mod tests {
    use super::super::{Labels, Rate};
    use super::*;

    #[test]
    fn colours_have_the_values_of_the_standard() {
        assert_eq!(converted([255; 3]), [235, 128, 128]);
        assert_eq!(converted([0; 3]), [16, 128, 128]);
        assert_eq!(converted([255, 0, 0]), [81, 90, 240]);
        assert_eq!(converted([0, 255, 0]), [145, 54, 34]);
        assert_eq!(converted([0, 0, 255]), [41, 240, 110]);
        assert_eq!(converted([100; 3]), [102, 128, 128]);
        assert_eq!(converted([100, 100, 101]), [102, 128, 128]);
    }

    /// A frame has nothing of the colours of the one before.
    #[test]
    fn frames_do_not_depend_on_those_before() {
        let options = FilmOptions {
            size: [2, 1],
            frames: 2,
            rate: Rate {
                frames: 25,
                seconds: 1,
            },
            repeats: false,
            is_opaque: true,
            labels: Labels::default(),
        };
        let frame = |pixels: [[u8; 4]; 2]| pixels.as_flattened().to_vec();
        let red = frame([[255, 0, 0, 255], [9, 9, 9, 255]]);
        let grey = frame([[80, 80, 80, 255]; 2]);
        let written = |frames: &[&Vec<u8>]| {
            let mut out = Vec::new();
            let mut film = Y4m::begin(&mut out, &options).unwrap();
            frames.iter().for_each(|it| film.add(it).unwrap());
            out
        };
        let (all, alone) = (written(&[&red, &grey]), written(&[&grey]));
        assert_eq!(all[all.len() - 6..], alone[alone.len() - 6..]);
    }
}
