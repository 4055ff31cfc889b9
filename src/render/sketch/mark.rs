//! Marks, of which sketches consist.

use crate::render::display::DisplayList;
use crate::render::paint_key::PaintKey;

/// Successive elements with equal paint keys, each joined to the one before.
#[derive(Clone, Copy)]
pub(in crate::render) struct LineMark {
    pub(in crate::render) key: PaintKey,
    /// Whether the first element joins the preceding one.
    pub(in crate::render) joined: bool,
    /// Whether the first element starts, and the last one ends, where its frame does.
    pub(in crate::render) meets_frame: [bool; 2],
}

/// Instruction to draw something through the next points of a sketch.
#[derive(Clone, Copy)]
pub(in crate::render) enum Mark {
    /// Beginning of a fractal.
    Begin,
    /// Class of the following elements.
    Class(u64),
    /// Beginning of a line, at a point.
    Line(LineMark),
    /// Beginning of a polygon, at a point.
    Polygon(PaintKey),
    /// Beginning or continuation of the outline of a fractal, at a point.
    Area,
    /// Curve, by three points.
    Curve,
    /// End of a polygon, with whether it has returned to its start.
    Close { returned: bool },
    /// Open element that is not drawn, by its end, with whether its frame ends there.
    Skip { meets_frame: bool },
    /// Element that is not drawn and that nothing can join.
    Break,
    /// End of the fractal, as in `Visitor::end`.
    End(bool),
}

/// Marks with their points, segment batches and sprites.
pub(in crate::render) type Sketch = DisplayList<Mark, PaintKey>;
