use std::fmt;
use std::ops::Range;

use crate::geometry::{BEYOND, Bounds, DAffine2, DMat2, DVec2};
use crate::style::View;

use super::Survey;

/// The size of a picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// The long side; the other follows from what is drawn.
    Long(u32),
    /// Width and height; what is drawn is fitted into them, in the middle.
    Exactly(u32, u32),
}

/// As the command line has it: `1024` or `1024x768`.
impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Long(side) => write!(f, "{side}"),
            Self::Exactly(width, height) => write!(f, "{width}x{height}"),
        }
    }
}

/// Positions farther away than this many pixels are not drawn.
const MOST_PIXELS: f64 = 1e9;

/// The most pixels from the origin to what is shown: a double tells the thousandth part of such a
/// pixel, which leaves room for the errors of many levels.
const FINEST: f64 = 1e12;

/// The width of the strip for a set without extent across, as a part of its length, and in pixels at least.
const STRIP: f64 = 1.0 / 40.0;
const NARROWEST_STRIP: f64 = 16.0;

/// How the plane is laid on a picture: pixels run right and down from the upper left corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Canvas {
    size: [u32; 2],
    /// Pixels a unit of the rule.
    scale: f64,
    /// The point of the plane that lies in the upper left corner.
    corner: DVec2,
}

/// A picture that margin and strokes fill.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoRoom {
    /// Nothing is left between the margins.
    #[error("the margins and strokes ({taken} pixels) leave no room in a picture of {size} pixels")]
    Margins {
        /// The pixels that margins and strokes take from a side.
        taken: f64,
        /// That side.
        size: u32,
    },
    /// Nothing is drawn.
    #[error("there is nothing to draw: no element is visible")]
    Nothing,
    /// The window shows so little of what is drawn that the rest lies too far away.
    #[error(
        "the window is too small: what is drawn would be more than {MOST_PIXELS} pixels wide as a whole"
    )]
    TooClose,
    /// The window is so small that rounding shows in it.
    #[error("the window is too small: numbers are not precise enough to tell its pixels apart")]
    TooFine,
    /// What is drawn is larger than numbers can tell.
    #[error("what is to be drawn has no finite size")]
    Infinite,
    /// A part of what is drawn is.
    #[error("{BEYOND}")]
    Beyond,
}

impl Canvas {
    /// The canvas that shows `bounds` with `pad` pixels free on every side; of what is less than a pixel
    /// wide or high, a strip that can be seen.
    ///
    /// # Errors
    ///
    /// If the box is empty or not finite, or if the padding leaves no room.
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

    /// The canvas that shows what surveys have seen, all of them on the same scale, or a window.
    pub(crate) fn of(surveys: &[Survey<'_>], view: &View, size: Size) -> Result<Self, NoRoom> {
        let mut all = Bounds::EMPTY;
        for survey in surveys {
            all.add_all(&survey.bounds);
        }
        if view.window.is_none() && surveys.iter().any(|survey| survey.is_beyond) {
            return Err(NoRoom::Beyond);
        }
        let overhang = surveys.iter().map(Survey::overhang).fold(0.0, f64::max);
        let canvas = match view.window {
            Some(window) => Self::of_window(window, view, size)?,
            None => Self::fit(&all, size, view.margin + overhang)?,
        };
        if !all.is_empty() && !canvas.holds(&all) {
            return Err(NoRoom::TooClose);
        }
        Ok(canvas)
    }

    /// The canvas that shows a window: lower left corner, width, height.
    ///
    /// # Errors
    ///
    /// If the window is empty or not finite, or if the margin leaves no room.
    pub fn of_window(
        [x, y, width, height]: [f64; 4],
        view: &View,
        size: Size,
    ) -> Result<Self, NoRoom> {
        let corner = DVec2::new(x, y);
        let shown = Bounds::new(corner, corner + DVec2::new(width, height));
        Self::fit_on(&shown, size, view.margin, false)
    }

    /// What part of the plane is shown, with so many pixels more on every side.
    pub(super) fn shown(&self, pad: f64) -> Bounds {
        self.shown_in(0..self.size[1], pad)
    }

    /// The same of some rows of pixels.
    pub(super) fn shown_in(&self, rows: Range<u32>, pad: f64) -> Bounds {
        let width = f64::from(self.size[0]);
        let [top, bottom] = [rows.start, rows.end].map(f64::from);
        let pad = pad / self.scale;
        let corners = [[0.0, -top], [width, -bottom]];
        let [upper, lower] = corners.map(|[x, y]| self.corner + DVec2::new(x, y) / self.scale);
        let shown = Bounds::new(upper, lower);
        Bounds::new(shown.min() - pad, shown.max() + pad)
    }

    /// Refuses to show places that rounding makes uncertain, in what starts from a box.
    pub(super) fn check_precision(&self, start: &Bounds) -> Result<(), NoRoom> {
        let mut all = self.shown(0.0);
        all.add_all(start);
        let far = all.min().abs().max(all.max().abs()).max_element();
        if far * self.scale > FINEST {
            return Err(NoRoom::TooFine);
        }
        Ok(())
    }

    /// Whether all of a box lies near enough to be drawn.
    #[must_use]
    pub fn holds(&self, bounds: &Bounds) -> bool {
        let corners = [bounds.min(), bounds.max()].map(|corner| self.pixel(corner));
        corners
            .iter()
            .all(|corner| corner.abs().max_element() <= MOST_PIXELS)
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Pixels a unit of the rule.
    #[must_use]
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// Where a point of the plane lies, in pixels from the upper left corner, y down.
    #[inline]
    #[must_use]
    pub fn pixel(&self, point: DVec2) -> DVec2 {
        DVec2::new(
            (point.x - self.corner.x) * self.scale,
            (self.corner.y - point.y) * self.scale,
        )
    }

    /// The map from the plane to pixels.
    #[must_use]
    pub fn to_pixels(&self) -> DAffine2 {
        self.map(&DAffine2::IDENTITY)
    }

    /// A map into the plane as one into the picture, in pixels.
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
    // A hair less than a whole pixel more is rounding, not extent.
    ((extent - 1e-9).ceil() as u32).max(1)
}
