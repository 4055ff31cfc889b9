use std::io;
use std::sync::Arc;

use crate::geometry::DVec2;
use crate::style::{Cap, Colour, Join};

use super::filled::Filled;
use super::png::{RoundPen, Stamp};

/// A position on a picture in hundredths of a pixel, from the upper left corner, y down.
///
/// Positions are rounded once, so that pictures of all formats show the same points, and none is
/// off by more than 0.01 pixels.
pub(crate) type Position = [i64; 2];

/// Units of positions to a pixel.
pub(crate) const FINE: f64 = 100.0;

/// The position nearest to a point that is given in their units.
///
/// Halves are decided a hair before they are reached: so rounding in the last bits, which depends on
/// the way that a point is computed, does not decide them.
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

/// How a path is painted: filled first, then stroked.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Paint {
    /// The colour of the area, under the nonzero rule.
    pub(crate) fill: Option<Colour>,
    /// The line along the path.
    pub(crate) stroke: Option<Stroke>,
}

/// A line along a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    /// Its colour.
    pub(crate) colour: Colour,
    /// Its width and shape.
    pub(crate) pen: Pen,
}

/// The pen that strokes are drawn with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pen {
    /// The width in pixels.
    pub(crate) width: f64,
    /// The ends of open paths.
    pub(crate) cap: Cap,
    /// The corners of paths.
    pub(crate) join: Join,
    /// The length of dashes and of the gaps between them, in pixels; 0 for a line without gaps.
    pub(crate) dash: f64,
}

impl Pen {
    /// How much longer caps make a line of the pen at each end, in widths, by the area that they
    /// cover.
    pub(crate) fn overshoot(&self) -> f64 {
        match self.cap {
            Cap::Butt => 0.0,
            // As much as half a disc.
            Cap::Round => std::f64::consts::FRAC_PI_8,
            Cap::Square => 0.5,
        }
    }
}

/// Thin lines that lie near each other, drawn as one: as a box that is no larger than a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tuft {
    /// Twice its middle, in hundredths of a pixel,
    pub(crate) middle: [i32; 2],
    /// and its width and height.
    pub(crate) extent: [u32; 2],
    /// The area of the lines, in pixels.
    pub(crate) area: f32,
    /// Their width, in pixels.
    pub(crate) width: f32,
}

/// A stamp, and the pixel on which it is put.
#[derive(Clone, Debug)]
pub(crate) struct Stamped {
    pub(crate) stamp: Arc<Stamp>,
    pub(crate) pixel: [i64; 2],
}

/// Way to draw stamps: shapes are filled, and lines are drawn with the pen.
#[derive(Clone)]
pub(crate) struct Stencil {
    /// Pen of lines and outlines.
    pub(crate) pen: Option<Arc<RoundPen>>,
    /// Whether shapes are outlined.
    pub(crate) outlines: bool,
}

/// Where the parts of pictures are made: a picture's format.
///
/// Paths come one after another, each between [`Surface::begin`] and [`Surface::end`]; what comes
/// later lies on top. Their subpaths have no two equal vertices in a row but dots, which are one
/// line of no length.
pub(crate) trait Surface {
    /// Begins a path.
    fn begin(&mut self, paint: &Paint) -> io::Result<()>;
    /// Begins a subpath.
    fn move_to(&mut self, to: Position);
    /// A straight line.
    fn line_to(&mut self, to: Position);
    /// Straight lines, one after another.
    #[inline]
    fn lines_to(&mut self, to: &[Position]) {
        for &to in to {
            self.line_to(to);
        }
    }
    /// A cubic Bézier curve.
    fn curve_to(&mut self, a: Position, b: Position, to: Position);
    /// Closes the subpath with a line to its first vertex.
    fn close(&mut self);
    /// A polygon that is a subpath of its own, with vertices that may be equal, where the surface knows
    /// a short way to draw it; whether it does.
    fn polygon(&mut self, _: &[Position]) -> bool {
        false
    }
    /// Hands on what has been drawn of the path, if that is much.
    fn hand_on(&mut self) -> io::Result<()>;
    /// Ends the path.
    fn end(&mut self) -> io::Result<()>;

    /// How far, in pixels, outlines may lie beside where they are, which then cannot be seen; `None` where
    /// all of them is kept.
    fn grain(&self) -> Option<f64> {
        None
    }

    /// Whether areas that are painted so and narrower than a pixel are to be stroked, so that they are as wide
    /// and can be seen; not where the surface sees to that, or draws no areas.
    fn broadens(&self, _: &Paint) -> bool {
        false
    }

    /// Strokes that are thinner than this, in pixels, may come as tufts where they are short; none
    /// unless said otherwise.
    fn tufts_below(&self, _: &Stroke) -> f64 {
        0.0
    }
    /// Tufts, within a path of one that may come so.
    fn tufts(&mut self, _: &[Tuft]) {}

    /// What draws stamps that may be put where paths are painted so, if they may: whatever they cover
    /// more than once stays covered once.
    fn stencil(&mut self, _: &Paint) -> Option<Stencil> {
        None
    }
    /// Stamps, within a path that is painted so.
    fn stamps(&mut self, _: &[Stamped]) {}

    /// What tells which pixels are covered all over, where paths that are painted so are drawn by
    /// layers, each of one opaque colour, or of two, of which that of strokes lies on top and is asked for;
    /// nothing unless said otherwise.
    fn filled(&mut self, _: &Paint) -> Option<Arc<Filled>> {
        None
    }
    /// The paths that come are of a layer.
    fn layer(&mut self, _: u64) {}

    /// Begins a part of the picture: a window with corner and size in pixels. Positions are in it
    /// and nothing is drawn outside. Tells whether any of it shows; if none does, it does not begin.
    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<bool>;
    /// Ends a part.
    fn leave(&mut self) -> io::Result<()>;
    /// What the next path says in words, where the format can tell.
    fn label(&mut self, text: &str);
}
