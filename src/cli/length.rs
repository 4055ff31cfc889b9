//! Lengths on pictures and sizes of pictures, in pixels or millimetres.

use std::fmt;

use crate::render::{Size, Unit};
use crate::style::Width;

/// Length of a CSS pixel in millimetres.
const PIXEL: f64 = 25.4 / 96.0;

/// Length in pixels or millimetres.
#[derive(Clone, Copy)]
pub(super) enum Length {
    Pixels(f64),
    Millimetres(f64),
}

impl Length {
    /// Parses a length that is not negative.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let (number, of): (_, fn(f64) -> Self) = match text.strip_suffix("mm") {
            Some(number) => (number.trim_end(), Self::Millimetres),
            None => (text, Self::Pixels),
        };
        match number.parse::<f64>() {
            Ok(length) if length.is_finite() && length >= 0.0 => Ok(of(length)),
            _ => Err(
                "expected a number of pixels, or of millimetres such as 0.3mm, that is not \
                      negative"
                    .into(),
            ),
        }
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

const MAX_UNITS: u32 = 1_000_000;

/// Parses the size of a picture in pixels.
pub(super) fn size(text: &str) -> Result<Size, String> {
    let side = |text: &str| match text.parse::<u32>() {
        Ok(side) if (1..=MAX_UNITS).contains(&side) => Ok(side),
        _ => Err(format!(
            "a side is a whole number of pixels from 1 to {MAX_UNITS}"
        )),
    };
    sides(text, side)
}

/// Parses the size of a picture in pixels or millimetres.
pub(super) fn paper(text: &str) -> Result<Paper, String> {
    if let Ok(size) = size(text) {
        let unit = Unit::Pixel;
        return Ok(Paper { size, unit });
    }
    let most = f64::from(MAX_UNITS);
    let side = |text: &str| {
        let tenths = text.strip_suffix("mm").and_then(|number| {
            let tenths = number.parse::<f64>().ok()? * 10.0;
            let whole = tenths.round();
            let is_whole = (tenths - whole).abs() < 1e-6 && (1.0..=most).contains(&whole);
            is_whole.then_some(whole)
        });
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "within bounds"
        )]
        tenths.map(|tenths| tenths as u32).ok_or_else(|| {
            format!(
                "a side is a whole number of pixels from 1 to {MAX_UNITS}, or of millimetres with \
                 one decimal at most and up to {}mm: 200mm, 210mmx297mm",
                MAX_UNITS / 10
            )
        })
    };
    sides(text, side).map(|size| Paper {
        size,
        unit: Unit::Tenth,
    })
}

fn sides(text: &str, side: impl Fn(&str) -> Result<u32, String>) -> Result<Size, String> {
    match text.split_once('x') {
        Some((width, height)) => Ok(Size::Exactly(side(width)?, side(height)?)),
        None => Ok(Size::Long(side(text)?)),
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
            "2cm",
            "-3mm",
            "NaNmm",
            "infmm",
        ] {
            assert!(paper(text).is_err(), "{text}");
        }
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
