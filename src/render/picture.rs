//! Descriptions of written pictures.

use super::plot::Plotted;

/// A picture that has been written.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Part of the plane that is shown, in the coordinates of the graph: lower left corner, width, height. `None` in
    /// space, and where doubles do not hold it.
    pub window: Option<[f64; 4]>,
    /// Number of steps: that of the growth, or the one that a detail took.
    pub steps: u32,
    /// Number of elements, without those outside a window that were not visited; of a limit set, that of the
    /// lines and dots that it is drawn with.
    pub elements: u64,
    /// Whether the limit set itself is drawn, by the cells of a grid within pixels that it meets, because its
    /// elements are too many or become flat.
    pub is_limit: bool,
    /// Number of fractals, with the same limits.
    pub fractals: u64,
    /// Whether elements outside a window may not have been visited.
    pub is_part: bool,
    /// Present if nothing meets the window: the boxes of all outlines lie outside.
    pub empty: Option<Empty>,
    /// Lengths and strokes of a plot.
    pub plotted: Option<Plotted>,
    /// Numbers of symbols and instances, if the picture is made of nested instances; its elements are not counted then.
    pub instanced: Option<Instanced>,
}

/// A window that shows nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Empty {
    /// Nearest visible point, if it is known: of a [`ZoomTarget`](super::ZoomTarget).
    pub nearest: Option<NearestPoint>,
}

/// Point nearest to the middle of a zoomed picture that shows nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NearestPoint {
    /// Distance in the rule's units, to a thousandth.
    pub distance: f64,
    /// Largest magnification of a picture that shows the point at its edge.
    pub factor: f64,
}

/// Size of a picture of nested instances.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Instanced {
    /// Number of symbols.
    pub symbols: u64,
    /// Number of elements and instances to which a viewer expands it; infinite beyond the range of doubles.
    pub expanded: f64,
}
