//! Placement of the plane on a picture.

use std::fmt;
use std::ops::Range;

use crate::geometry::{BEYOND, Bounds, DAffine2, DMat2, DVec2};
use crate::style::View;

/// Size of a picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// The longer side; the other side follows from the bounding box.
    Long(u32),
    /// Width and height; the bounding box is scaled to fit and centred.
    Exactly(u32, u32),
}

impl Default for Size {
    /// A long side of 1024 pixels.
    fn default() -> Self {
        Self::Long(1024)
    }
}

impl Size {
    /// Returns the long side.
    #[must_use]
    pub fn long_side(self) -> f64 {
        match self {
            Self::Long(side) => side.into(),
            Self::Exactly(width, height) => width.max(height).into(),
        }
    }

    /// Returns the margin that a picture has by default: 4 % of the long side, or of the shorter one of two that are
    /// given.
    #[must_use]
    pub fn margin(self) -> f64 {
        const SHARE: f64 = 0.04;
        SHARE
            * match self {
                Self::Long(side) => f64::from(side),
                Self::Exactly(width, height) => width.min(height).into(),
            }
    }
}

impl From<u32> for Size {
    fn from(side: u32) -> Self {
        Self::Long(side)
    }
}

impl From<(u32, u32)> for Size {
    fn from((width, height): (u32, u32)) -> Self {
        Self::Exactly(width, height)
    }
}

/// Writes the size as on the command line: `1024` or `1024x768`.
impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Long(side) => write!(f, "{side}"),
            Self::Exactly(width, height) => write!(f, "{width}x{height}"),
        }
    }
}

/// Largest distance from the picture, in pixels, at which positions are drawn.
const MAX_PIXELS: f64 = 1e9;

/// Largest distance from the origin to the part shown, in pixels: a double resolves about 10⁻⁴ of a pixel
/// there, which leaves room for the rounding errors of many levels.
const FINEST: f64 = 1e12;

/// Width of the strip for a set without extent across, as a fraction of its length.
const STRIP: f64 = 1.0 / 40.0;
/// Smallest width of that strip, in pixels.
const NARROWEST_STRIP: f64 = 16.0;

/// Map of the plane to a picture: pixels run right and down from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Canvas {
    size: [u32; 2],
    /// Pixels per unit of the rule.
    scale: f64,
    /// Point of the plane at the upper left corner.
    corner: DVec2,
}

/// Reason why a picture cannot show its contents.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoRoom {
    /// Margins and strokes fill the picture.
    #[error("the margins and strokes ({taken} pixels) leave no room in a picture of {size} pixels")]
    Margins {
        /// Pixels that margins and strokes take from a side.
        taken: f64,
        /// That side, in pixels.
        size: u32,
    },
    /// Nothing is drawn.
    #[error("there is nothing to draw: no element is visible")]
    Nothing,
    /// The window is so small that the rest of the set lies too far away.
    #[error(
        "the window is too small: what is drawn would be more than {MAX_PIXELS} pixels wide as a whole"
    )]
    TooClose,
    /// The window is so small that rounding is visible.
    #[error("the window is too small: numbers are not precise enough to distinguish its pixels")]
    TooFine,
    /// The bounding box is not finite.
    #[error("what is to be drawn has no finite size")]
    Infinite,
    /// A part of the set lies beyond the range of numbers.
    #[error("{BEYOND}")]
    Beyond,
}

impl Canvas {
    /// Creates a canvas that shows `bounds` with `pad` pixels of padding on every side. If the box is less than
    /// a pixel wide or high, the canvas is a strip around it.
    ///
    /// # Errors
    ///
    /// Returns an error if the box is empty or not finite, or if the padding leaves no room.
    pub fn fit(bounds: &Bounds, size: Size, pad: f64) -> Result<Self, NoRoom> {
        Self::fit_on(bounds, size, pad, true)
    }

    fn fit_on(bounds: &Bounds, size: Size, pad: f64, has_strips: bool) -> Result<Self, NoRoom> {
        if bounds.is_empty() {
            return Err(NoRoom::Nothing);
        }
        let extent = bounds.size();
        if !bounds.is_finite() || !extent.is_finite() {
            return Err(NoRoom::Infinite);
        }
        let room = |side: u32| {
            let room = f64::from(side) - 2.0 * pad;
            let taken = 2.0 * pad;
            if room > 0.0 {
                Ok(room)
            } else {
                Err(NoRoom::Margins { taken, size: side })
            }
        };
        let (scale, size) = match size {
            Size::Long(side) => {
                let scale = room(side)? / extent.max_element();
                let scale = if scale.is_finite() { scale } else { 1.0 };
                let strip = (f64::from(side) * STRIP).max(NARROWEST_STRIP);
                let short = |extent: f64| {
                    let extent = extent * scale;
                    let least = if has_strips && extent < 1.0 {
                        strip
                    } else {
                        0.0
                    };
                    whole_pixels((extent + 2.0 * pad).max(least)).min(side)
                };
                let size = if extent.x >= extent.y {
                    [side, short(extent.y)]
                } else {
                    [short(extent.x), side]
                };
                (scale, size)
            }
            Size::Exactly(width, height) => {
                let scale = (room(width)? / extent.x).min(room(height)? / extent.y);
                (if scale.is_finite() { scale } else { 1.0 }, [width, height])
            }
        };
        let centre = bounds.min() + extent / 2.0;
        let half = DVec2::new(f64::from(size[0]), -f64::from(size[1])) / (2.0 * scale);
        Ok(Self {
            size,
            scale,
            corner: centre - half,
        })
    }

    /// Creates a canvas that shows a window: lower left corner, width, height.
    ///
    /// # Errors
    ///
    /// Returns an error if the window is empty or not finite, or if the margin leaves no room.
    pub fn of_window(
        [x, y, width, height]: [f64; 4],
        view: &View,
        size: Size,
    ) -> Result<Self, NoRoom> {
        let corner = DVec2::new(x, y);
        let shown = Bounds::new(corner, corner + DVec2::new(width, height));
        Self::fit_on(&shown, size, view.pad(), false)
    }

    /// Returns the part of the plane that is shown, extended by `pad` pixels on every side.
    pub(super) fn shown(&self, pad: f64) -> Bounds {
        self.shown_in(0..self.size[1], pad)
    }

    /// Returns the part of the plane that is shown in some rows of pixels, likewise extended.
    pub(super) fn shown_in(&self, rows: Range<u32>, pad: f64) -> Bounds {
        let width = f64::from(self.size[0]);
        let [top, bottom] = [rows.start, rows.end].map(f64::from);
        let pad = pad / self.scale;
        let corners = [[0.0, -top], [width, -bottom]];
        let [upper, lower] = corners.map(|[x, y]| self.corner + DVec2::new(x, y) / self.scale);
        let shown = Bounds::new(upper, lower);
        Bounds::new(shown.min() - pad, shown.max() + pad)
    }

    /// Checks that rounding errors are invisible, where growth starts from a box.
    pub(super) fn check_precision(&self, start: &Bounds) -> Result<(), NoRoom> {
        let mut all = self.shown(0.0);
        all.add_all(start);
        let far = all.min().abs().max(all.max().abs()).max_element();
        if far * self.scale > FINEST {
            return Err(NoRoom::TooFine);
        }
        Ok(())
    }

    /// Returns the canvas of the same size that shows a point in its middle, magnified.
    pub(super) fn magnified(&self, factor: f64, middle: DVec2) -> Self {
        let scale = self.scale * factor;
        let [width, height] = self.size.map(f64::from);
        Self {
            scale,
            corner: middle + DVec2::new(-width, height) / (2.0 * scale),
            ..*self
        }
    }

    /// Returns whether a box lies near enough to the picture to be drawn.
    #[must_use]
    pub fn holds(&self, bounds: &Bounds) -> bool {
        let corners = [bounds.min(), bounds.max()].map(|corner| self.pixel(corner));
        corners
            .iter()
            .all(|corner| corner.abs().max_element() <= MAX_PIXELS)
    }

    /// Returns the width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the number of pixels per unit of the rule.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns the part of the plane that is shown: lower left corner, width, height.
    #[must_use]
    pub fn window(&self) -> [f64; 4] {
        let shown = self.shown(0.0);
        let ([x, y], [width, height]) = (shown.min().into(), shown.size().into());
        [x, y, width, height]
    }

    /// Returns the position of a point of the plane, in pixels from the upper left corner, y down.
    #[inline]
    #[must_use]
    pub fn pixel(&self, point: DVec2) -> DVec2 {
        DVec2::new(
            (point.x - self.corner.x) * self.scale,
            (self.corner.y - point.y) * self.scale,
        )
    }

    /// Returns the map from the plane to pixels.
    #[must_use]
    pub fn to_pixels(&self) -> DAffine2 {
        self.map(&DAffine2::IDENTITY)
    }

    /// Composes a map into the plane with the map to pixels.
    pub(super) fn map(&self, map: &DAffine2) -> DAffine2 {
        let scale = DMat2::from_diagonal(DVec2::new(self.scale, -self.scale));
        DAffine2 {
            matrix2: scale * map.matrix2,
            translation: self.pixel(map.translation),
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate, and pictures are smaller than that"
)]
fn whole_pixels(extent: f64) -> u32 {
    // An excess of less than 10⁻⁹ pixels is rounding, not extent.
    ((extent - 1e-9).ceil() as u32).max(1)
}
