use std::fmt;

/// What a picture's size is counted in, and with it all else that is said in pixels: strokes,
/// margins, details.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unit {
    /// Pixels as CSS has them, of 1/96 inch where that matters.
    #[default]
    Pixel,
    /// Tenths of a millimetre.
    Tenth,
}

impl Unit {
    /// How long it is, in millimetres.
    #[must_use]
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Pixel => 25.4 / 96.0,
            Self::Tenth => 0.1,
        }
    }

    /// So many units, as SVG writes them.
    pub(super) fn length(self, units: u32) -> Length {
        Length { units, unit: self }
    }
}

/// A side of a picture.
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
