//! Palettes of other programs, and of pictures.
//!
//! | Format | Program | Content |
//! | --- | --- | --- |
//! | `.map` | Fractint | `red green blue` in each line, from 0 to 255 |
//! | `.gpl` | GIMP, Inkscape | the same, below `GIMP Palette` |
//! | `.ugr` | Ultra Fractal | `index=0 color=3943466`, from 0 to 399, cyclic; the first gradient of a file |
//! | `.cpt` | Generic Mapping Tools | intervals of values with their colours, in RGB, HSV or grey, or by name |

mod cpt;
#[cfg(feature = "cli")]
mod picture;
mod ugr;

#[cfg(feature = "cli")]
pub(crate) use picture::of_picture;

use crate::style::{Colour, Named, Palette};

/// Number of colours by which gradients with uneven stops are represented.
const SAMPLES: u32 = 256;

/// Limit of the number of colours of a file.
const MAX_COLOURS: usize = 4096;

/// Format of a file with a palette.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PaletteFormat {
    /// Colour map of Fractint.
    Map,
    /// Palette of GIMP.
    Gpl,
    /// Gradients of Ultra Fractal.
    Ugr,
    /// Colour palette table of the Generic Mapping Tools.
    Cpt,
}

impl Named for PaletteFormat {
    const NAMES: &'static [(&'static str, Self)] = &[
        ("map", Self::Map),
        ("gpl", Self::Gpl),
        ("ugr", Self::Ugr),
        ("cpt", Self::Cpt),
    ];
}

/// Error in a file with a palette.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct PaletteError {
    /// Number of the line, from 1.
    pub line: usize,
    /// Description of the error.
    pub message: String,
}

/// Reads a palette. Colours of `.map` and `.gpl` are kept; gradients of `.ugr` and `.cpt` become 256 evenly spaced colours.
///
/// # Errors
///
/// Returns an error if a line has no colour where it must, or if there are none or more than 4096.
pub fn read_palette(text: &str, format: PaletteFormat) -> Result<Palette, PaletteError> {
    let colours = match format {
        PaletteFormat::Map => rows(text, 0)?,
        PaletteFormat::Gpl => rows(text, gpl_header(text)?)?,
        PaletteFormat::Ugr => ugr::read(text)?,
        PaletteFormat::Cpt => cpt::read(text)?,
    };
    Ok(Palette::of_colours("", &colours))
}

/// Returns an error at a line, counted from 1.
fn wrong(line: usize, message: impl Into<String>) -> PaletteError {
    PaletteError {
        line,
        message: message.into(),
    }
}

/// Iterates over the lines of a text without comments from `#` on, with their numbers, without empty ones.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let lines = (1..).zip(text.lines());
    let lines = lines.map(|(number, line)| (number, line.split('#').next().unwrap_or("").trim()));
    lines.filter(|(_, line)| !line.is_empty())
}

/// Returns the number of lines of the header of a palette of GIMP.
fn gpl_header(text: &str) -> Result<usize, PaletteError> {
    if text.lines().next().map(str::trim) != Some("GIMP Palette") {
        return Err(wrong(1, "a palette of GIMP begins with 'GIMP Palette'"));
    }
    let is_header = |line: &&str| {
        let line = line.trim_start();
        ["GIMP Palette", "Name:", "Columns:", "Channels:"]
            .iter()
            .any(|key| line.starts_with(key))
    };
    Ok(text.lines().take_while(is_header).count())
}

/// Reads lines that begin with red, green and blue, after a number of other lines.
fn rows(text: &str, header: usize) -> Result<Vec<Colour>, PaletteError> {
    let mut colours = Vec::new();
    for (number, line) in lines(text).filter(|(number, _)| *number > header) {
        let mut parts = line.split_whitespace();
        let channel = || parts.next()?.parse::<u8>().ok();
        let Some(rgb) = channels(channel) else {
            let message = "expected red, green and blue from 0 to 255, as in '255 128 0'";
            return Err(wrong(number, message));
        };
        colours.push(opaque(rgb));
        check(number, colours.len())?;
    }
    some(colours)
}

/// Returns three channels, one after another.
fn channels<T>(mut next: impl FnMut() -> Option<T>) -> Option<[T; 3]> {
    Some([next()?, next()?, next()?])
}

fn opaque([red, green, blue]: [u8; 3]) -> Colour {
    Colour::of_rgba([red, green, blue, 255])
}

/// Returns an error if there are too many colours.
fn check(line: usize, count: usize) -> Result<(), PaletteError> {
    match count > MAX_COLOURS {
        true => Err(wrong(
            line,
            format!("a palette has at most {MAX_COLOURS} colours"),
        )),
        false => Ok(()),
    }
}

fn some<T>(all: Vec<T>) -> Result<Vec<T>, PaletteError> {
    match all.is_empty() {
        true => Err(wrong(1, "the file has no colours")),
        false => Ok(all),
    }
}

/// Returns evenly spaced colours along stops, whose places ascend; between them, colours change linearly in RGB. Of
/// two stops at one place, the second begins there.
fn sampled(stops: &[(f64, [f64; 3])]) -> Vec<Colour> {
    let (Some(first), Some(last)) = (stops.first(), stops.last()) else {
        return Vec::new();
    };
    let sample = |number: u32| {
        let share = f64::from(number) / f64::from(SAMPLES - 1);
        let place = first.0 + (last.0 - first.0) * share;
        let after = stops.partition_point(|stop| stop.0 <= place);
        let (from, to) = (stops[after.max(1) - 1], stops[after.min(stops.len() - 1)]);
        let width = to.0 - from.0;
        let share = if width > 0.0 {
            (place - from.0) / width
        } else {
            0.0
        };
        let channel = |axis: usize| byte(from.1[axis] + (to.1[axis] - from.1[axis]) * share);
        opaque([channel(0), channel(1), channel(2)])
    };
    (0..SAMPLES).map(sample).collect()
}

/// Returns a channel from 0 to 255.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
fn byte(value: f64) -> u8 {
    value.round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, format: PaletteFormat) -> Vec<String> {
        let palette = read_palette(text, format).unwrap();
        palette.colours().iter().map(ToString::to_string).collect()
    }

    #[test]
    fn rows_are_colours() {
        let map = "0 0 0  the first\n255 128 0\n\n 16 32 64\n";
        assert_eq!(
            read(map, PaletteFormat::Map),
            ["#000000", "#ff8000", "#102040"]
        );
        let gpl = "GIMP Palette\nName: Fall\nColumns: 2\n#\n 139  69  19\tbark\n210 105  30 leaf\n";
        assert_eq!(read(gpl, PaletteFormat::Gpl), ["#8b4513", "#d2691e"]);
    }

    #[test]
    fn gradients_of_ultra_fractal_are_cyclic() {
        // Colours are blue, green and red, from the highest byte down.
        let text = "fire {\ngradient:\n  title=\"Fire\" smooth=no\n  index=0 color=255\n  index=200 color=65280\n\
                    opacity:\n  smooth=no index=0 opacity=255\n}\nnext {\ngradient:\n index=0 color=0\n}\n";
        let colours = read(text, PaletteFormat::Ugr);
        assert_eq!(colours.len(), 256);
        assert_eq!(colours[0], "#ff0000");
        assert_eq!(colours[255], "#ff0000");
        assert_eq!(colours[64], "#7f8000");
        let middle = Colour::parse(&colours[128]).unwrap().rgba();
        assert!(middle[1] > 253 && middle[0] < 3, "{middle:?}");
        assert_eq!(colours[191], colours[64]);
    }

    #[test]
    fn tables_of_gmt_have_intervals() {
        let text = "# COLOR_MODEL = RGB\n0 0 0 0 1 255 255 255\n1\t255 0 0 3 255 0 0 L ; two\nB 0 0 0\nN 127\n";
        let colours = read(text, PaletteFormat::Cpt);
        assert_eq!(
            [colours[0].as_str(), &colours[42], &colours[200]],
            ["#000000", "#7e7e7e", "#ff0000"]
        );
        for text in [
            "0 red 1 #0000ff\n",
            "0 255/0/0 1 0/0/255\n",
            "# COLOR_MODEL = HSV\n0 0-1-1 1 240-1-1\n",
            "# COLOR_MODEL = HSV\n0 0 1 1 1 240 1 1\n",
        ] {
            let colours = read(text, PaletteFormat::Cpt);
            assert_eq!(
                [&colours[0], &colours[255]],
                ["#ff0000", "#0000ff"],
                "{text}"
            );
        }
        let colours = read("0 0 1 255\n", PaletteFormat::Cpt);
        assert_eq!([&colours[0], &colours[255]], ["#000000", "#ffffff"]);
    }

    #[test]
    fn mistakes_are_reported_with_their_lines() {
        use PaletteFormat::{Cpt, Gpl, Map, Ugr};
        let cases = [
            ("0 0 0\n255 256 0\n", Map, "line 2: expected red"),
            ("", Map, "line 1: the file has no colours"),
            ("1 2 3\n", Gpl, "line 1: a palette of GIMP begins"),
            ("GIMP Palette\n1 2\n", Gpl, "line 2: expected red"),
            ("x {\n index=1\n}\n", Ugr, "line 2: expected a colour"),
            ("x {\n}\n", Ugr, "the file has no colours"),
            ("0 0 0 0 1 0 0\n", Cpt, "line 1: expected"),
            (
                "1 red 0 blue\n",
                Cpt,
                "line 1: an interval ends after it begins",
            ),
            (
                "0 nocolour 1 blue\n",
                Cpt,
                "line 1: 'nocolour' is no colour",
            ),
        ];
        for (text, format, expected) in cases {
            let error = read_palette(text, format).unwrap_err().to_string();
            assert!(error.contains(expected), "{text:?}: {error}");
        }
    }
}
