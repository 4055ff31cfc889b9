//! Units of length of pictures.

use std::fmt;

/// Unit of a picture's size, and of all other lengths given in pixels: strokes, margins, details.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unit {
    /// CSS pixel: 1/96 inch in formats with physical lengths.
    #[default]
    Pixel,
    /// Tenth of a millimetre.
    Tenth,
}

impl Unit {
    /// Returns the length of the unit in millimetres.
    #[must_use]
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Pixel => 25.4 / 96.0,
            Self::Tenth => 0.1,
        }
    }

    /// Returns a length in units, to be displayed as in SVG.
    pub(super) fn length(self, units: u32) -> Length {
        Length { units, unit: self }
    }
}

/// Length of a side of a picture.
pub(super) struct Length {
    units: u32,
    unit: Unit,
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { units, unit } = *self;
        match unit {
            Unit::Pixel => write!(f, "{units}"),
            Unit::Tenth => write!(f, "{}mm", f64::from(units) / 10.0),
        }
    }
}
