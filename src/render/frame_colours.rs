//! Colours of elements by their frames: by angle, length and place in the picture.

use crate::geometry::{Bounds, DVec2, Frame2};
use crate::graph::Graph;
use crate::grow::Element;
use crate::rule::BaseElement;
use crate::style::{ColorBy, Colour, Style};

/// Number of colours into which the range is divided.
const COLOURS: usize = 256;

/// Relative difference up to which all lengths are taken to be equal.
const EVEN: f64 = 1e-9;

/// Colours of elements by an attribute of their frames.
#[derive(Clone, Debug)]
pub(super) struct FrameColours {
    by: ColorBy,
    /// Whether the end of the range is its beginning, so that the last colour is followed by the first one.
    is_cyclic: bool,
    /// Values of the first and the last colour.
    range: [f64; 2],
    /// Centre of the picture.
    centre: DVec2,
    colours: Vec<Colour>,
    /// By base element, the centre of the box of its outline.
    centres: Vec<DVec2>,
}

impl FrameColours {
    /// Returns the colours in a picture that shows a part of the plane, for elements of lengths between two; `None` if colours are not
    /// by frame.
    pub(super) fn of(
        style: &Style,
        graph: &Graph,
        window @ [left, bottom, width, height]: [f64; 4],
        lengths: [f64; 2],
    ) -> Option<Self> {
        let by = style.color_by;
        let range = match by {
            ColorBy::Angle => [0.0, 360.0],
            ColorBy::Length => lengths,
            ColorBy::Distance => [0.0, width.max(height) / 2.0],
            by => by.range_across(window)?,
        };
        let is_cyclic = by == ColorBy::Angle && style.color_range.is_none();
        let last = if is_cyclic { COLOURS } else { COLOURS - 1 };
        #[expect(clippy::cast_precision_loss, reason = "there are few colours")]
        let colour = |number: usize| style.palette.at(number as f64 / last as f64);
        let centre = |outline: &BaseElement| {
            let mut bounds = Bounds::EMPTY;
            outline.add_to(&mut bounds, &Frame2::UNIT, 0.0);
            bounds.centre()
        };
        Some(Self {
            by,
            is_cyclic,
            range: style.color_range.unwrap_or(range),
            centre: DVec2::new(left + width / 2.0, bottom + height / 2.0),
            colours: (0..COLOURS).map(colour).collect(),
            centres: graph.base_elements().iter().map(centre).collect(),
        })
    }

    /// Returns the colour of an element.
    pub(super) fn at(&self, element: &Element, graph: &Graph) -> Colour {
        let share = self.share(element, graph);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "casts from floats saturate, and there are few colours"
        )]
        let number = match self.is_cyclic {
            true => (share * COLOURS as f64).round() as usize % COLOURS,
            false => (share.clamp(0.0, 1.0) * (COLOURS - 1) as f64).round() as usize,
        };
        self.colours[number]
    }

    /// Returns the place of an element in the range, from 0 to 1 within it.
    fn share(&self, element: &Element, graph: &Graph) -> f64 {
        let [first, last] = self.range;
        let value = match self.by {
            ColorBy::Angle => {
                let [start, end] = element.frame.ends();
                let way = end - start;
                let angle = libm::atan2(way.y, way.x).to_degrees() - first;
                let (angle, span) = (angle.rem_euclid(360.0), last - first);
                // Outside the range, the nearer end counts.
                return match angle - span > 360.0 - angle {
                    true => 0.0,
                    false => angle / span,
                };
            }
            ColorBy::Length => return share_of_length(length(element), self.range),
            ColorBy::X => self.place(element, graph).x,
            ColorBy::Y => self.place(element, graph).y,
            _ => self.place(element, graph).distance(self.centre),
        };
        match last > first {
            true => (value - first) / (last - first),
            false => 0.0,
        }
    }

    /// Returns the place of an element: the centre of its outline's box in its frame.
    fn place(&self, element: &Element, graph: &Graph) -> DVec2 {
        let outline = graph.objects()[element.object].base_element;
        element.frame.map().transform_point2(self.centres[outline])
    }
}

/// Returns the length |p1 − p0| of an element.
pub(super) fn length(element: &Element) -> f64 {
    let [start, end] = element.frame.ends();
    start.distance(end)
}

/// Returns the place of a length in a range, by ratios unless the range begins at 0.
fn share_of_length(length: f64, [first, last]: [f64; 2]) -> f64 {
    if last <= first * (1.0 + EVEN) {
        return 1.0;
    }
    if first <= 0.0 {
        return (length - first) / (last - first);
    }
    match length > 0.0 {
        true => libm::log(length / first) / libm::log(last / first),
        false => 0.0,
    }
}
