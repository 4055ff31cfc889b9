//! What sketches are made of.

use crate::render::WIDTHS_AN_OCTAVE;
use crate::render::surface::{Position, Stamped, Tuft};
use crate::style::Colour;

/// What tells paths apart: a new one is begun where this changes.
#[derive(Clone, Copy, PartialEq)]
pub(in crate::render) struct Look {
    pub(in crate::render) kind: Kind,
    /// The width of a stroke where widths differ, in steps of an eighth of an octave; of specks, in eighths
    /// of a pixel.
    pub(in crate::render) width: i32,
    /// Its colour, where what is drawn is tinted.
    pub(in crate::render) colour: Option<Colour>,
}

impl Look {
    /// Whether what looks like `other` may go on in an open path of this look. Specks whose strokes differ
    /// by a quarter of a pixel or less share one, so that squares of two sizes in turn do not need a path each.
    pub(in crate::render) fn serves(self, other: Self) -> bool {
        const ALIKE: u32 = 2;
        let is_alike = self.kind == Kind::Speck && self.width.abs_diff(other.width) <= ALIKE;
        let width = if is_alike { self.width } else { other.width };
        self == Self { width, ..other }
    }

    /// Whether it is of closed base elements.
    pub(in crate::render) fn is_of_polygons(self) -> bool {
        matches!(self.kind, Kind::Polygon | Kind::Speck)
    }

    /// Of tufts: a stroke as thin as there are.
    pub(in crate::render) const TUFTS: Self = Self {
        kind: Kind::Line,
        width: 0,
        colour: None,
    };

    /// Of the areas of fractals.
    pub(in crate::render) const AREA: Self = Self {
        kind: Kind::Area,
        width: 0,
        colour: None,
    };
}

/// What a path holds.
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
    /// Closed base elements that are narrower than a pixel, stroked so that they can be seen.
    Speck,
}

/// Elements in a row, each joined to the one before, that look alike.
#[derive(Clone, Copy)]
pub(in crate::render) struct Line {
    pub(in crate::render) look: Look,
    /// Whether the first one joins what comes before.
    pub(in crate::render) joined: bool,
    /// Whether the first one starts, and the last one ends, where its frame does.
    pub(in crate::render) meets_frame: [bool; 2],
}

/// What is to be drawn through the next points of a sketch.
#[derive(Clone, Copy)]
pub(in crate::render) enum Mark {
    /// A fractal begins.
    Begin,
    /// Elements of a class come.
    Class(u64),
    /// A line begins at a point.
    Line(Line),
    /// A polygon begins at a point.
    Polygon(Look),
    /// Polygons that look alike, by number, each of so many vertices.
    Polygons {
        look: Look,
        vertices: usize,
        count: usize,
    },
    /// The outline of a fractal begins or goes on at a point.
    Area,
    /// Straight lines to so many points.
    Lines(usize),
    /// A curve, by three points.
    Curve,
    /// So many tufts.
    Tufts(usize),
    /// So many stamps of what looks alike.
    Stamps { look: Look, count: usize },
    /// The polygon is closed; whether it has returned to its start.
    Close { returned: bool },
    /// An open element that is not drawn, by its end, and whether its frame ends there.
    Skip { meets_frame: bool },
    /// An element that nothing can be joined to, not drawn.
    Break,
    /// The fractal ends; as [`Visitor::end`].
    End(bool),
}

/// Marks, and the points, tufts and stamps that they are about.
#[derive(Default)]
pub(in crate::render) struct Sketch {
    pub(in crate::render) marks: Vec<Mark>,
    pub(in crate::render) points: Vec<Position>,
    pub(in crate::render) tufts: Vec<Tuft>,
    pub(in crate::render) stamps: Vec<Stamped>,
}

/// The width of a relative stroke in steps, from the logarithm of its width; not less than one
/// hundredth of a pixel.
#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
pub(in crate::render) fn width_class(octave: f64) -> i32 {
    // Rounded, as it is not negative.
    (WIDTHS_AN_OCTAVE * octave.max(0.0) + 0.5) as i32
}

/// The width of a class in hundredths of a pixel: there are eight to an octave.
pub(in crate::render) fn class_width(class: i32) -> f64 {
    // exp2 of eighths, for there may be a path for every element.
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
