//! Lengths on pictures and sizes of pictures, in pixels, millimetres, centimetres or inches, or by the name of a paper.

use std::fmt;

use crate::render::{Size, Unit};
use crate::style::Width;

/// Length of a CSS pixel in millimetres.
const PIXEL: f64 = 25.4 / 96.0;

/// Millimetres in an inch.
const INCH: f64 = 25.4;

/// Returns the number of a length with a physical unit, and the millimetres in the unit.
fn physical(text: &str) -> Option<(f64, f64)> {
    let units = [("mm", 1.0), ("cm", 10.0), ("in", INCH)];
    units.into_iter().find_map(|(unit, millimetres)| {
        let number = text.strip_suffix(unit)?.trim_end();
        Some((number.parse().ok()?, millimetres))
    })
}

/// Length in pixels or millimetres.
#[derive(Clone, Copy)]
pub(super) enum Length {
    Pixels(f64),
    Millimetres(f64),
}

impl Length {
    /// Parses a length that is not negative.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let length = match physical(text) {
            Some((number, unit)) => Some(Self::Millimetres(number * unit)),
            None => text.parse().ok().map(Self::Pixels),
        };
        let is_right = |length: &Self| match *length {
            Self::Pixels(length) | Self::Millimetres(length) => length.is_finite() && length >= 0.0,
        };
        length.filter(is_right).ok_or_else(|| {
            "expected a number of pixels, or a length such as 0.3mm, 1cm or 0.5in, that is not negative".into()
        })
    }

    /// Returns the length in units of a picture.
    pub(super) fn count(self, unit: Unit) -> f64 {
        match (self, unit) {
            (Self::Pixels(pixels), Unit::Pixel) => pixels,
            (Self::Pixels(pixels), Unit::Tenth) => pixels * (10.0 * PIXEL),
            (Self::Millimetres(length), Unit::Pixel) => length / PIXEL,
            (Self::Millimetres(length), Unit::Tenth) => length * 10.0,
        }
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pixels(pixels) => pixels.fmt(f),
            Self::Millimetres(length) => write!(f, "{length}mm"),
        }
    }
}

/// Width of strokes.
#[derive(Clone, Copy)]
pub(super) enum StrokeWidth {
    Length(Length),
    /// Multiple of the length of the element.
    Relative(f64),
}

impl StrokeWidth {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        match text.strip_suffix('%').map(Length::parse) {
            Some(Ok(Length::Pixels(percent))) => Ok(Self::Relative(percent / 100.0)),
            Some(_) => Err("expected a percentage of the element's length".into()),
            None => Length::parse(text).map(Self::Length),
        }
    }

    pub(super) fn of(width: Width) -> Self {
        match width {
            Width::Pixels(pixels) => Self::Length(Length::Pixels(pixels)),
            Width::Relative(width) => Self::Relative(width),
        }
    }

    /// Returns the width as it is stored in a style.
    pub(super) fn width(self, unit: Unit) -> Width {
        match self {
            Self::Length(length) => Width::Pixels(length.count(unit)),
            Self::Relative(width) => Width::Relative(width),
        }
    }
}

impl fmt::Display for StrokeWidth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length(length) => length.fmt(f),
            Self::Relative(width) => write!(f, "{}%", width * 100.0),
        }
    }
}

/// Size of a picture, in pixels or millimetres.
#[derive(Clone, Copy)]
pub(super) struct Paper {
    pub(super) size: Size,
    pub(super) unit: Unit,
}

/// Largest side of a picture in pixels, or in tenths of a millimetre.
const MAX_UNITS: u32 = 1_000_000;

/// Largest side in pixels of a picture that is drawn in tiles.
const MAX_OF_TILES: u32 = 1 << 30;

/// Parses the size of a picture in pixels.
pub(super) fn size(text: &str) -> Result<Size, String> {
    size_up_to(text, MAX_UNITS)
}

fn size_up_to(text: &str, most: u32) -> Result<Size, String> {
    let side = |text: &str| match text.parse::<u32>() {
        Ok(side) if (1..=most).contains(&side) => Ok(side),
        _ => Err(format!(
            "a side is a whole number of pixels from 1 to {MAX_UNITS}"
        )),
    };
    sides(text, side)
}

/// Papers with their sides in millimetres, upright (ISO 216; ANSI Y14.1).
const PAPERS: [(&str, [f64; 2]); 12] = [
    ("a0", [841.0, 1189.0]),
    ("a1", [594.0, 841.0]),
    ("a2", [420.0, 594.0]),
    ("a3", [297.0, 420.0]),
    ("a4", [210.0, 297.0]),
    ("a5", [148.0, 210.0]),
    ("a6", [105.0, 148.0]),
    ("b4", [250.0, 353.0]),
    ("b5", [176.0, 250.0]),
    ("letter", [8.5 * INCH, 11.0 * INCH]),
    ("legal", [8.5 * INCH, 14.0 * INCH]),
    ("tabloid", [11.0 * INCH, 17.0 * INCH]),
];

/// Returns the size of a paper by its name, such as `a4` or `letter-landscape`.
fn named(text: &str) -> Option<Size> {
    let text = text.to_lowercase();
    let (name, lies) = match text.strip_suffix("-landscape") {
        Some(name) => (name, true),
        None => (text.as_str(), false),
    };
    let (_, [short, long]) = PAPERS.into_iter().find(|(paper, _)| *paper == name)?;
    let [width, height] = if lies { [long, short] } else { [short, long] };
    Some(Size::Exactly(tenths(width)?, tenths(height)?))
}

/// Returns a number of millimetres in tenths, rounded; `None` if it is out of range.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "within bounds"
)]
fn tenths(millimetres: f64) -> Option<u32> {
    let whole = (millimetres * 10.0).round();
    (1.0..=f64::from(MAX_UNITS))
        .contains(&whole)
        .then_some(whole as u32)
}

/// Parses the size of a picture: in pixels, in millimetres, centimetres or inches, or the name of a paper.
pub(super) fn paper(text: &str) -> Result<Paper, String> {
    paper_up_to(text, MAX_UNITS)
}

/// Parses the size of a picture that may be drawn in tiles, which may then have more pixels.
pub(super) fn paper_or_tiles(text: &str) -> Result<Paper, String> {
    paper_up_to(text, MAX_OF_TILES)
}

fn paper_up_to(text: &str, most: u32) -> Result<Paper, String> {
    if let Ok(size) = size_up_to(text, most) {
        let unit = Unit::Pixel;
        return Ok(Paper { size, unit });
    }
    let unit = Unit::Tenth;
    if let Some(size) = named(text) {
        return Ok(Paper { size, unit });
    }
    let more = match most > MAX_UNITS {
        true => format!(", with --tiles to {most}"),
        false => String::new(),
    };
    let side = |text: &str| {
        let side = physical(text).and_then(|(number, unit)| {
            let millimetres = number * unit;
            let whole = (millimetres * 10.0).round();
            // Inches are rounded to tenths of a millimetre.
            let is_whole = unit == INCH || (millimetres * 10.0 - whole).abs() < 1e-6;
            tenths(millimetres).filter(|_| is_whole)
        });
        side.ok_or_else(|| {
            format!(
                "a side is a whole number of pixels from 1 to {MAX_UNITS}{more}, or a length of whole tenths of a millimetre up \
                 to {}mm: 200mm, 21cmx29.7cm, 8.5inx11in; papers are a0 to a6, b4, b5, letter, legal and tabloid, upright \
                 or as a4-landscape",
                MAX_UNITS / 10
            )
        })
    };
    sides(text, side).map(|size| Paper { size, unit })
}

fn sides(text: &str, side: impl Fn(&str) -> Result<u32, String>) -> Result<Size, String> {
    match text.split_once('x') {
        Some((width, height)) => Ok(Size::Exactly(side(width)?, side(height)?)),
        None => Ok(Size::Long(side(text)?)),
    }
}

impl Paper {
    /// Returns an error if a single picture of this size is too large.
    pub(super) fn check_single(&self) -> Result<(), String> {
        let sides = match self.size {
            Size::Long(side) => [side; 2],
            Size::Exactly(width, height) => [width, height],
        };
        if sides.into_iter().all(|side| side <= MAX_UNITS) {
            return Ok(());
        }
        Err(format!(
            "--size {self}: the side of a picture is at most {MAX_UNITS} pixels; --tiles allows {MAX_OF_TILES}"
        ))
    }
}

impl fmt::Display for Paper {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let length = |side: u32| length(side, self.unit);
        match (self.unit, self.size) {
            (Unit::Pixel, size) => size.fmt(f),
            (Unit::Tenth, Size::Long(side)) => write!(f, "{}mm", length(side)),
            (Unit::Tenth, Size::Exactly(width, height)) => {
                write!(f, "{}mmx{}mm", length(width), length(height))
            }
        }
    }
}

/// Formats the width and height of a picture.
pub(super) fn described([width, height]: [u32; 2], unit: Unit) -> String {
    let noun = match unit {
        Unit::Pixel => "pixels",
        Unit::Tenth => "mm",
    };
    format!("{} x {} {noun}", length(width, unit), length(height, unit))
}

/// Returns a side in pixels or millimetres.
fn length(side: u32, unit: Unit) -> f64 {
    match unit {
        Unit::Pixel => side.into(),
        Unit::Tenth => f64::from(side) / 10.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_and_written() {
        for text in [
            "1024",
            "300x200",
            "200mm",
            "29.7mmx21mm",
            "0.1mm",
            "100000mm",
        ] {
            assert_eq!(paper(text).unwrap().to_string(), text);
        }
        for text in [
            "0",
            "0mm",
            "20.05mm",
            "100001mm",
            "200mmx150",
            "150x200mm",
            "mm",
            "2.005cm",
            "a7",
            "a4-upright",
            "3ft",
            "-3mm",
            "-1in",
            "NaNmm",
            "infmm",
        ] {
            assert!(paper(text).is_err(), "{text}");
        }
    }

    #[test]
    fn other_units_and_papers_are_millimetres() {
        for (text, expected) in [
            ("2cm", "20mm"),
            ("8in", "203.2mm"),
            ("8.25inx1in", "209.6mmx25.4mm"),
            ("a4", "210mmx297mm"),
            ("A3-landscape", "420mmx297mm"),
            ("letter", "215.9mmx279.4mm"),
        ] {
            assert_eq!(paper(text).unwrap().to_string(), expected);
        }
        // Each paper of a series is half of the one before.
        for pair in PAPERS[..7].windows(2) {
            let [large, small] = [pair[0].1, pair[1].1];
            assert_eq!(large[0], small[1]);
            assert_eq!((large[1] / 2.0).floor(), small[0]);
        }
        assert_eq!(Length::parse("0.5in").unwrap().to_string(), "12.7mm");
        assert_eq!(Length::parse("1 cm").unwrap().to_string(), "10mm");
    }

    #[test]
    fn lengths_are_what_they_are_on_any_picture() {
        let millimetre = Length::parse("25.4mm").unwrap();
        assert!((millimetre.count(Unit::Pixel) - 96.0).abs() < 1e-12);
        assert_eq!(millimetre.count(Unit::Tenth), 254.0);
        let pixels = Length::parse("96").unwrap();
        assert!((pixels.count(Unit::Tenth) - 254.0).abs() < 1e-12);
    }
}
