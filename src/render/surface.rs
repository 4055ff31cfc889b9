//! Surfaces: the interface between drawing and the formats of pictures.

use std::io;

use crate::geometry::DVec2;
use crate::style::{Cap, Colour, Join};

use super::png::Raster;

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

/// Destination of drawings: a format of pictures.
///
/// Paths follow one another, each between [`Surface::begin`] and [`Surface::end`]; later ones lie on top.
/// Successive vertices of their subpaths differ, except for dots, which are one line of length 0.
pub(crate) trait Surface {
    /// Begins a path.
    fn begin(&mut self, paint: &Paint) -> io::Result<()>;
    /// Begins a subpath.
    fn move_to(&mut self, to: Position);
    /// Draws a straight line.
    fn line_to(&mut self, to: Position);
    /// Draws straight lines, one after another.
    #[inline]
    fn lines_to(&mut self, to: &[Position]) {
        for &to in to {
            self.line_to(to);
        }
    }
    /// Draws a cubic Bézier curve.
    fn curve_to(&mut self, a: Position, b: Position, to: Position);
    /// Closes the subpath with a line to its first vertex.
    fn close(&mut self);
    /// Hands on the drawn portion of the path, if it is large.
    fn hand_on(&mut self) -> io::Result<()>;
    /// Ends the path.
    fn end(&mut self) -> io::Result<()>;

    /// Returns whether areas with this paint that are narrower than a pixel are to be stroked to a width of
    /// one pixel, so that they are visible. `false` if the surface ensures that itself, or draws no areas.
    fn broadens(&self, _: &Paint) -> bool {
        false
    }

    /// Returns the surface as one of pixels, which are drawn with less work than paths take; `None` unless
    /// overridden.
    fn raster(&mut self) -> Option<&mut dyn Raster> {
        None
    }

    /// Begins a part of the picture: a window with corner and size in pixels. Positions are relative to it,
    /// and nothing is drawn outside. Returns whether any of it is visible; otherwise the part does not begin.
    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<bool>;
    /// Ends a part.
    fn leave(&mut self) -> io::Result<()>;
    /// Sets the text that the next path represents, for formats that can state it.
    fn label(&mut self, _: &str) {}
}
