//! Marks, of which sketches consist.

use crate::render::WIDTHS_AN_OCTAVE;
use crate::render::surface::{PlacedSprite, Position, SegmentBatch};
use crate::style::Colour;

/// Paint key: a path ends where it changes.
#[derive(Clone, Copy, PartialEq)]
pub(in crate::render) struct PaintKey {
    pub(in crate::render) kind: Kind,
    /// Class of the stroke width, in steps of an eighth of an octave, if widths differ; for specks, the width
    /// in eighths of a pixel.
    pub(in crate::render) width: i32,
    /// Colour, if tints apply.
    pub(in crate::render) colour: Option<Colour>,
}

impl PaintKey {
    /// Returns whether shapes with paint key `other` may continue an open path with this one. Specks whose
    /// strokes differ by at most a quarter of a pixel share a path, so that squares alternating between two
    /// sizes do not need a path each.
    pub(in crate::render) fn serves(self, other: Self) -> bool {
        const ALIKE: u32 = 2;
        let is_alike = self.kind == Kind::Speck && self.width.abs_diff(other.width) <= ALIKE;
        let width = if is_alike { self.width } else { other.width };
        self == Self { width, ..other }
    }

    /// Returns whether the path consists of closed base elements.
    pub(in crate::render) fn is_of_polygons(self) -> bool {
        matches!(self.kind, Kind::Polygon | Kind::Speck)
    }

    /// Paint key of tufts, with the thinnest stroke.
    pub(in crate::render) const TUFTS: Self = Self {
        kind: Kind::Line,
        width: 0,
        colour: None,
    };

    /// Paint key of the areas of fractals.
    pub(in crate::render) const AREA: Self = Self {
        kind: Kind::Area,
        width: 0,
        colour: None,
    };
}

/// Kind of the shapes in a path.
#[derive(Clone, Copy, PartialEq)]
pub(in crate::render) enum Kind {
    /// Open lines.
    Line,
    /// Closed paths of lines, stroked and filled.
    Ring,
    /// Fractals that are closed chains, filled without a stroke.
    Area,
    /// Closed base elements.
    Polygon,
    /// Closed base elements that are narrower than a pixel, stroked so that they are visible.
    Speck,
}

/// Successive elements with equal paint keys, each joined to the one before.
#[derive(Clone, Copy)]
pub(in crate::render) struct Line {
    pub(in crate::render) look: PaintKey,
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
    Line(Line),
    /// Beginning of a polygon, at a point.
    Polygon(PaintKey),
    /// Polygons with equal paint keys and equal numbers of vertices.
    Polygons {
        look: PaintKey,
        vertices: usize,
        count: usize,
    },
    /// Beginning or continuation of the outline of a fractal, at a point.
    Area,
    /// Number of straight lines, each to a point.
    Lines(usize),
    /// Curve, by three points.
    Curve,
    /// Number of tufts.
    Tufts(usize),
    /// Sprites with equal paint keys.
    Sprites { look: PaintKey, count: usize },
    /// End of a polygon, with whether it has returned to its start.
    Close { returned: bool },
    /// Open element that is not drawn, by its end, with whether its frame ends there.
    Skip { meets_frame: bool },
    /// Element that is not drawn and that nothing can join.
    Break,
    /// End of the fractal, as in `Visitor::end`.
    End(bool),
}

/// Marks with their points, tufts and sprites.
#[derive(Default)]
pub(in crate::render) struct Sketch {
    pub(in crate::render) marks: Vec<Mark>,
    pub(in crate::render) points: Vec<Position>,
    pub(in crate::render) tufts: Vec<SegmentBatch>,
    pub(in crate::render) sprites: Vec<PlacedSprite>,
}

/// Returns the class of a stroke width, from the logarithm of the width in hundredths of a pixel. Smaller
/// widths than one hundredth are in class 0.
#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
pub(in crate::render) fn width_class(octave: f64) -> i32 {
    // The cast rounds down, as the value is not negative.
    (WIDTHS_AN_OCTAVE * octave.max(0.0) + 0.5) as i32
}

/// Returns the width of a class in hundredths of a pixel: there are eight classes per octave.
pub(in crate::render) fn class_width(class: i32) -> f64 {
    // exp2 of eighths is tabulated, for there may be a path for every element.
    const EIGHTHS: [f64; 8] = [
        1.0,
        1.090_507_732_665_257_7,
        1.189_207_115_002_721,
        1.296_839_554_651_009_6,
        std::f64::consts::SQRT_2,
        1.542_210_825_407_940_7,
        1.681_792_830_507_429,
        1.834_008_086_409_342_4,
    ];
    libm::ldexp(EIGHTHS[class.rem_euclid(8) as usize], class.div_euclid(8))
}

#[cfg(test)]
mod tests {
    use super::{WIDTHS_AN_OCTAVE, class_width, width_class};

    #[test]
    fn classes_of_widths_are_steps_of_octaves() {
        for class in 0..100 {
            let octave = f64::from(class) / WIDTHS_AN_OCTAVE;
            assert!((class_width(class) / libm::exp2(octave) - 1.0).abs() < 1e-15);
            for off in [-0.06, 0.06] {
                assert_eq!(width_class(octave + off), class);
            }
        }
        assert_eq!(width_class(-5.0), 0);
    }
}
