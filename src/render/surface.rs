//! Surfaces: the interface between drawing and the formats of pictures.

use std::io;

use super::paint::{Paint, Position};
use super::png::Raster;

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
    /// Draws straight lines, each as a subpath, by pairs of ends. The ends of a dot are equal.
    #[inline]
    fn segments(&mut self, ends: &[Position]) {
        for &[from, to] in ends.as_chunks().0 {
            self.move_to(from);
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
