//! Initiators that are approximants of other rules.

use crate::document::{Entry, FractalDocument, Listed, Written, WrittenNumber, WrittenPoint};
use crate::expression::Expression;
use crate::geometry::{DVec2, Direction};
use crate::grow::{Element, Elements, WalkError};
use crate::kind::Kind;

use crate::resolve::Resolver;
use crate::resolve::fractal::{INSTEAD, TOO_SLOW};

/// Entries of a list of elements, with whether each joins the one before.
type Entries = (Vec<Entry>, Vec<bool>);

/// Distance, as a multiple of the element's length, within which the end of an element is the start of the next.
const JOINT: f64 = 1e-9;

impl<K> Resolver<K> {
    /// Grows a rule of the plane and returns the elements of its approximant, in the order of traversal, as the entries of an
    /// initiator. Reports a mistake and returns `None`.
    pub(super) fn approximant(&mut self, document: &FractalDocument) -> Option<Entries> {
        self.within_budget(document, |resolver| resolver.entries_of(document))
    }

    fn entries_of(&mut self, document: &FractalDocument) -> Option<Entries> {
        let (model, growth) = self.grown(document)?;
        if model.kind() != Kind::Rule || model.is_in_space() {
            let message =
                "an initiator begins with the approximant of a production rule of the plane";
            self.error_with_hint(&document.place, message, "{from: koch, steps: 3}");
            return None;
        }
        let graph = self.graph(document, &model, growth.steps)?;
        let elements: Result<Vec<_>, _> = Elements::of(&graph, &growth)
            .map(|found| found.map(|(_, element)| element))
            .collect();
        let elements = match elements {
            Ok(elements) if !elements.is_empty() => elements,
            Ok(_) => {
                let message = "this approximant has no element";
                self.error_with_hint(&document.place, message, "another number of steps");
                return None;
            }
            Err(WalkError::TooManyElements { .. }) if self.is_slow(&growth) => {
                self.error_with_hint(&document.place, TOO_SLOW, INSTEAD);
                return None;
            }
            Err(error) => {
                self.error_with_hint(&document.place, error.to_string(), "fewer steps");
                return None;
            }
        };
        let mut last: Option<DVec2> = None;
        let entries = elements.iter().map(|element| {
            let [from, to] = ends(element);
            let near = |last: DVec2| last.distance(from) <= JOINT * from.distance(to);
            let follows = element.joined && last.is_some_and(near);
            last = Some(to);
            entry(document, element, (!follows).then_some(from), to)
        });
        let entries = entries.collect();
        let joins = elements.iter().map(|element| element.joined).collect();
        Some((entries, joins))
    }
}

/// Returns the ends of an element as it is listed.
fn ends(element: &Element) -> [DVec2; 2] {
    let [reversed, ..] = element.frame.direction().reflected();
    let ends = [DVec2::ZERO, DVec2::X].map(|end| element.frame.apply(end));
    match reversed {
        false => ends,
        true => [ends[1], ends[0]],
    }
}

fn entry(document: &FractalDocument, element: &Element, from: Option<DVec2>, to: DVec2) -> Entry {
    let place = &document.place;
    let number = |value: f64| WrittenNumber {
        value: Expression::number(value),
        place: place.clone(),
    };
    let point = |at: DVec2| WrittenPoint {
        x: number(at.x),
        y: number(at.y),
        z: None,
        place: place.clone(),
    };
    let direction = match element.frame.direction() {
        Direction::Normal => None,
        other => Some(Written {
            value: Expression::number(other.number().into()),
            place: place.clone(),
        }),
    };
    Entry::Element(Box::new(Listed {
        from: from.map(point),
        to: Some(point(to)),
        face: None,
        corners: None,
        up: None,
        normal: None,
        roll: None,
        direction,
        fertile: element.fertile,
        visible: element.visible,
        connected: true,
        generator: None,
        base_element: None,
        tint: None,
        place: place.clone(),
    }))
}
