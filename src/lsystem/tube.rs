//! Tubes: lines of a turtle in space as bodies with a width.

use crate::expression::degrees;
use crate::geometry::{DVec3, Solid};
use crate::rule::Body;
use crate::style::Tube;

/// A line of a turtle that is drawn as a tube.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TubeLine {
    /// Its length.
    pub length: f64,
    /// Widths at its start and at its end, as multiples of the turtle's initial width.
    pub widths: [f64; 2],
    /// Whether the turtle has turned since the line before.
    pub is_bent: bool,
}

/// Part of a tube, in the unit frame of its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TubePart {
    /// Frustum about the line, with the bits of the radii at its ends, of which the larger is 1.
    Frustum([u64; 2]),
    /// Half a ball before the start, of radius 1: it fills the wedge that is open between tubes at an angle.
    Knob,
    /// The line itself, where its width is 0.
    Line,
}

/// Factors by which a part is stretched along its line and across it.
pub type Stretch = [f64; 2];

/// Largest number of corners of a part, which are those of a convex hull.
const MAX_CORNERS: u32 = 98;

impl Tube {
    /// Iterates over the parts of the tube along a line.
    pub fn parts(self, line: &TubeLine) -> impl Iterator<Item = (TubePart, Stretch)> {
        let radii = line.widths.map(|width| width * self.width / 2.0);
        let widest = radii[0].max(radii[1]);
        let body = match widest > 0.0 {
            true => {
                let ends = radii.map(|radius| (radius / widest).to_bits());
                (TubePart::Frustum(ends), [1.0, widest / line.length])
            }
            false => (TubePart::Line, [1.0, 1.0]),
        };
        let knob =
            (line.is_bent && radii[0] > 0.0).then(|| (TubePart::Knob, [radii[0] / line.length; 2]));
        [body].into_iter().chain(knob)
    }

    /// Returns a part as a base element.
    #[must_use]
    pub fn body(self, part: TubePart) -> Body {
        let mut corners = Vec::new();
        match part {
            TubePart::Line => return Body::line(),
            TubePart::Frustum(ends) => {
                for (x, radius) in [0.0, 1.0].into_iter().zip(ends.map(f64::from_bits)) {
                    self.circle(x, radius, &mut corners);
                }
            }
            TubePart::Knob => {
                let rows = (self.sides / 4).clamp(1, (MAX_CORNERS / self.sides).max(1));
                for row in 0..rows {
                    let angle = 90.0 * f64::from(row) / f64::from(rows);
                    self.circle(-degrees::sin(angle), degrees::cos(angle), &mut corners);
                }
                corners.push(DVec3::NEG_X);
            }
        }
        let solid = Solid::hull(&corners);
        let body = Body::new(vec![solid.into()], Vec::new(), true);
        body.unwrap_or_else(Body::line)
    }

    /// Adds the corners of a circle about the x axis: a single one for the radius 0.
    fn circle(self, x: f64, radius: f64, corners: &mut Vec<DVec3>) {
        if radius == 0.0 {
            return corners.push(DVec3::X * x);
        }
        corners.extend((0..self.sides).map(|side| {
            let angle = 360.0 * f64::from(side) / f64::from(self.sides);
            DVec3::new(
                x,
                radius * degrees::cos(angle),
                radius * degrees::sin(angle),
            )
        }));
    }
}
