//! Positions on pictures, and the paints of paths.

use crate::geometry::DVec2;
use crate::style::{Cap, Colour, Join, Style, Width};

/// Number of steps per octave that relative stroke widths are rounded to.
pub(super) const WIDTHS_AN_OCTAVE: f64 = 8.0;

/// Position on a picture, in hundredths of a pixel from the upper left corner, with y down.
///
/// Positions are rounded once, so that pictures of all formats show the same points, each within 0.01 pixels.
pub(crate) type Position = [i64; 2];

/// Units of positions per pixel.
pub(crate) const FINE: f64 = 100.0;

/// Returns the position nearest to a point that is given in units of positions.
///
/// Ties are decided slightly early, so that they do not depend on rounding in the last bits, which varies
/// with the way in which a point is computed.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "casts from floats saturate; what is on a picture is exact"
)]
pub(crate) fn position(point: DVec2) -> Position {
    const HALF: f64 = 0.5 + 1e-6;
    [point.x + HALF, point.y + HALF].map(|value| {
        let towards_zero = value as i64;
        towards_zero - i64::from(value < towards_zero as f64)
    })
}

/// Paint of a path, which is first filled and then stroked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Paint {
    /// Colour of the area, under the nonzero rule.
    pub(crate) fill: Option<Colour>,
    /// Line along the path.
    pub(crate) stroke: Option<Stroke>,
    /// Whether a subpath may be a hole in another, as in letters.
    pub(crate) has_holes: bool,
}

/// Line along a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    /// Colour.
    pub(crate) colour: Colour,
    /// Width and shape.
    pub(crate) pen: Pen,
}

/// Pen with which strokes are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pen {
    /// Width, in pixels.
    pub(crate) width: f64,
    /// Ends of open paths.
    pub(crate) cap: Cap,
    /// Corners of paths.
    pub(crate) join: Join,
    /// Length of dashes and of the gaps between them, in pixels; 0 for a line without gaps.
    pub(crate) dash: f64,
}

impl Pen {
    /// Returns the length that caps add to each end of a line, in widths, by the area that they cover.
    pub(crate) fn overshoot(&self) -> f64 {
        match self.cap {
            Cap::Butt => 0.0,
            // Area of half a disc.
            Cap::Round => std::f64::consts::FRAC_PI_8,
            Cap::Square => 0.5,
        }
    }
}

/// Returns the pen of a style; of one pixel where widths are relative.
pub(crate) fn pen(style: &Style) -> Pen {
    Pen {
        width: match style.width {
            Width::Pixels(width) => width,
            Width::Relative(_) => 1.0,
        },
        cap: style.cap,
        join: style.join,
        dash: 0.0,
    }
}

/// Returns the largest distance of a stroke's edge from its path, as a multiple of its width.
pub(super) fn overhang(style: &Style) -> f64 {
    let cap = if style.cap == Cap::Square {
        std::f64::consts::FRAC_1_SQRT_2
    } else {
        0.5
    };
    // The default miter limit of SVG is four times the width.
    let join = if style.join == Join::Miter { 2.0 } else { 0.5 };
    f64::max(cap, join)
}

/// Returns that distance for relative widths, which are rounded and may be drawn wider.
pub(super) fn relative_overhang(style: &Style) -> f64 {
    libm::exp2(0.5 / WIDTHS_AN_OCTAVE) * overhang(style)
}
