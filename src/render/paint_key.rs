//! Paint keys: kinds of shapes and the paints with which a scene draws them.

use crate::style::{Cap, Colour, Join};

use super::paint::{FINE, Paint, Pen, Stroke};
use super::paint::{WIDTHS_AN_OCTAVE, pen};
use super::scene::Scene;

/// Number of widths of specks' strokes per pixel.
pub(super) const SPECK_WIDTHS: f64 = 8.0;

/// Paint key: a path ends where it changes.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct PaintKey {
    pub(super) kind: PathKind,
    /// Class of the stroke width, in steps of an eighth of an octave, if widths differ; for specks, the width
    /// in eighths of a pixel.
    pub(super) width: i32,
    /// Colour, if tints apply.
    pub(super) colour: Option<Colour>,
}

/// Kind of the shapes in a path.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum PathKind {
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

impl PaintKey {
    /// Returns the key of shapes without tint, with the thinnest stroke if widths differ.
    pub(super) const fn of(kind: PathKind) -> Self {
        Self {
            kind,
            width: 0,
            colour: None,
        }
    }

    /// Returns whether shapes with paint key `other` may continue an open path with this one. Specks whose
    /// strokes differ by at most a quarter of a pixel share a path, so that squares alternating between two
    /// sizes do not need a path each.
    pub(super) fn serves(self, other: Self) -> bool {
        const ALIKE: u32 = 2;
        let is_alike = self.kind == PathKind::Speck && self.width.abs_diff(other.width) <= ALIKE;
        let width = if is_alike { self.width } else { other.width };
        self == Self { width, ..other }
    }

    /// Returns whether the path consists of closed base elements.
    pub(super) fn is_of_polygons(self) -> bool {
        matches!(self.kind, PathKind::Polygon | PathKind::Speck)
    }

    /// Returns the paint of a class that has a colour of its own if colours depend on classes.
    pub(super) fn paint(self, scene: &Scene<'_>, colour: Option<Colour>) -> Paint {
        let style = scene.style;
        let own = self.colour.or(colour);
        let colour = own.unwrap_or(style.lines());
        let mut pen = pen(style);
        if !scene.has_one_width() {
            pen.width = class_width(self.width) / FINE;
        }
        let stroke = |colour| Some(Stroke { colour, pen });
        let (fill, stroke) = match self.kind {
            PathKind::Line => (None, stroke(colour)),
            PathKind::Ring => (style.fill, stroke(colour)),
            PathKind::Area => (style.fill, None),
            PathKind::Speck => {
                let colour = own.unwrap_or(style.polygons());
                let pen = Pen {
                    width: f64::from(self.width) / SPECK_WIDTHS,
                    cap: Cap::Round,
                    join: Join::Round,
                    dash: 0.0,
                };
                (Some(colour), Some(Stroke { colour, pen }))
            }
            PathKind::Polygon => (
                Some(own.unwrap_or(style.polygons())),
                style
                    .stroke
                    .filter(|_| style.outlines_polygons())
                    .and_then(stroke),
            ),
        };
        Paint {
            fill,
            stroke,
            has_holes: false,
        }
    }
}

/// Returns the class of a stroke width, from the logarithm of the width in hundredths of a pixel. Smaller
/// widths than one hundredth are in class 0.
#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
pub(super) fn width_class(octave: f64) -> i32 {
    // The cast rounds down, as the value is not negative.
    (WIDTHS_AN_OCTAVE * octave.max(0.0) + 0.5) as i32
}

/// Returns the width of a class in hundredths of a pixel: there are eight classes per octave.
pub(super) fn class_width(class: i32) -> f64 {
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
