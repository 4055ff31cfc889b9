//! Places from which the elements of a rule grow.

use crate::geometry::Affine as _;

use super::frame::SAME;
use super::{ElementContext, ListedElement, Rule, RuleFrame};

/// Place from which an element grows, relative to the element that it replaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GrowthStart {
    /// Foot on the replaced element: a point (x, y, z) begins at (x, 0, 0), with x between 0 and 1.
    Chord,
    /// Plane of the replaced element: a point (x, y, z) begins at (x, y, 0).
    Plane,
    /// The replaced element itself.
    Element,
    /// End of the element in its place that is nearer to the middle of the replaced one; an element that takes that of the replaced one is kept.
    Point,
}

impl<F: RuleFrame> Rule<F> {
    /// Returns where elements begin that grow, by their base elements. Shapes with an area begin as the element that they
    /// replace, unless that is kept: out of a point then. Surfaces of space that tile the replaced one begin in its plane.
    pub(crate) fn starts_of_growth(&self) -> Vec<GrowthStart> {
        let moment = ElementContext {
            index: 1.0,
            age: 0.0,
            step: 0.0,
            length: 1.0,
        };
        let placed: Vec<Vec<(&ListedElement, F)>> = { self.generators.iter() }
            .map(|generator| {
                let points = generator.typical(&moment);
                let elements = generator.elements();
                elements.map(|it| (it, F::placed(it, &points))).collect()
            })
            .collect();
        let keeps = placed.iter().flatten().any(|(element, frame)| {
            !element.fertile && element.visible && frame.map().is_near(F::UNIT.map(), SAME)
        });
        let tiles = placed.iter().all(|elements| {
            let areas = elements
                .iter()
                .map(|(_, frame)| frame.grown(GrowthStart::Plane, 0.0).area());
            (areas.sum::<f64>() - 1.0).abs() <= SAME
        });
        let start = |base_element| match F::start_of_growth(base_element) {
            GrowthStart::Chord => GrowthStart::Chord,
            GrowthStart::Plane if tiles => GrowthStart::Plane,
            _ if keeps => GrowthStart::Point,
            _ => GrowthStart::Element,
        };
        self.base_elements.iter().map(start).collect()
    }
}
