//! Resolution of lists of elements and of the initiator.

use std::borrow::Cow;

use crate::document::{Entry, Listed, RuleDocument, Written, WrittenPoint};
use crate::expression::{Expression, Program};
use crate::geometry::Direction;

use super::values;
use super::{OfRule, ResolvedFrame};
use crate::resolve::{Resolver, whole_number};
use crate::rule::{ListedAttitude, ListedElement, Part, Placement};

/// A point of a list, with its number.
struct ListedPoint {
    point: WrittenPoint,
    number: usize,
}

impl<F: ResolvedFrame> Resolver<OfRule<F>> {
    /// Resolves a list of elements. Its points are appended to `points` and numbered accordingly. With
    /// `initiator`, which is set for initiators and for seed parts, a chain may return to its first
    /// point.
    pub(super) fn elements(
        &mut self,
        entries: &[Entry],
        closed: bool,
        connected: bool,
        points: &mut Vec<WrittenPoint>,
        initiator: bool,
    ) -> Vec<ListedElement> {
        let mut elements: Vec<ListedElement> = Vec::with_capacity(entries.len());
        points.reserve(entries.len());
        let mut first: Option<ListedPoint> = None;
        let mut last: Option<ListedPoint> = None;
        let add = |points: &mut Vec<WrittenPoint>, point: &WrittenPoint| {
            points.push(point.clone());
            ListedPoint {
                point: point.clone(),
                number: points.len() - 1,
            }
        };
        for entry in entries {
            let (from, to, listed) = match entry {
                Entry::Point(point) if last.is_none() => {
                    let start = add(points, point);
                    first = Some(ListedPoint {
                        point: point.clone(),
                        number: start.number,
                    });
                    last = Some(start);
                    continue;
                }
                Entry::Point(point) => (None, Cow::Borrowed(point), None),
                Entry::Element(listed) => (listed.from.as_ref(), listed.end(), Some(listed)),
            };
            let to = &*to;
            let mut joined = !elements.is_empty();
            let start = match (from, last.take()) {
                (Some(from), Some(last)) if from.is_written_like(&last.point) => last,
                (Some(from), _) => {
                    joined = false;
                    add(points, from)
                }
                (None, Some(last)) => last,
                // The missing start has been reported.
                (None, None) => add(points, &WrittenPoint::unknown(&to.place)),
            };
            if first.is_none() {
                first = Some(ListedPoint {
                    point: start.point.clone(),
                    number: start.number,
                });
            }
            // A chain whose end is written like its first point ends on that point.
            let end = match &first {
                Some(first) if initiator && to.is_written_like(&first.point) => ListedPoint {
                    point: to.clone(),
                    number: first.number,
                },
                _ => add(points, to),
            };
            let mut element = self.listed_element(listed.map(Box::as_ref));
            element.from = start.number;
            element.to = end.number;
            if let Some(face) = listed.and_then(|listed| listed.face.as_ref()) {
                let others = face.iter().skip(2).map(|point| add(points, point).number);
                let numbers = [start.number, end.number].into_iter().chain(others);
                element.attitude = ListedAttitude::Face(numbers.collect());
            }
            if let Some([_, _, other]) = listed.and_then(|listed| listed.corners.as_deref())
                && let ListedAttitude::Corners { points: all, .. } = &mut element.attitude
            {
                *all = [start.number, end.number, add(points, other).number];
            }
            element.joined = connected && joined && listed.is_none_or(|listed| listed.connected);
            elements.push(element);
            last = Some(end);
        }
        if let (Some(first), Some(last)) = (first, last) {
            let returns = initiator && elements.len() > 1 && last.number == first.number;
            if closed && !returns {
                let mut element = self.listed_element(None);
                (element.from, element.to) = (last.number, first.number);
                element.joined = connected && !elements.is_empty();
                elements.push(element);
            }
            if let Some(element) = elements.first_mut().filter(|_| closed || returns) {
                element.joined = connected && element.from == first.number;
            }
        }
        elements
    }

    fn listed_element(&mut self, listed: Option<&Listed>) -> ListedElement {
        let mut element = ListedElement {
            from: 0,
            to: 0,
            direction: Direction::Normal,
            attitude: ListedAttitude::Least,
            corners: None,
            fertile: true,
            visible: true,
            joined: false,
            generator: None,
            base_element: 0,
            tint: None,
        };
        let Some(listed) = listed else { return element };
        element.fertile = listed.fertile;
        element.visible = listed.visible;
        if let Some(number) = &listed.direction
            && let Some(value) = self.constant(number)
        {
            let direction = whole_number(value, F::DIRECTIONS).and_then(Direction::from_number);
            if direction.is_none() {
                let (message, hint) = match F::DIRECTIONS {
                    4 => (
                        "a direction is 1, 2, 3 or 4",
                        "1 normal, 2 y reflected, 3 x reflected, 4 both reflected",
                    ),
                    _ => (
                        "a direction is a number from 1 to 8",
                        "1 normal, 2 y reflected, 3 x reflected, 4 both; 5 to 8 are these with z reflected",
                    ),
                };
                self.error_with_hint(&number.place, message, hint);
            }
            element.direction = direction.unwrap_or_default();
        }
        // Numbers among the vectors until these follow the points.
        element.attitude = match (&listed.normal, &listed.roll) {
            (Some(normal), _) => ListedAttitude::Normal(self.vector(normal.clone())),
            (None, Some(roll)) => {
                let zero = Written {
                    value: Expression::number(0.0),
                    place: roll.place.clone(),
                };
                ListedAttitude::Roll(self.vector(WrittenPoint {
                    x: roll.clone(),
                    y: zero,
                    z: None,
                    place: roll.place.clone(),
                }))
            }
            (None, None) => ListedAttitude::Least,
        };
        if let Some(name) = &listed.generator {
            element.generator = self.generator_named(name);
            if !listed.fertile {
                self.error_with_hint(
                    &name.place,
                    "an infertile element is not replaced",
                    "leave out `use`, or `fertile: false`",
                );
            }
        }
        element.tint = self.constant_tint(listed.tint.as_deref(), &listed.place);
        if let Some(document) = &listed.base_element {
            element.base_element = self.base_element(document);
        }
        if listed.corners.is_some() {
            let up = listed.up.clone();
            let face = F::face(&self.kind.base_elements[element.base_element]);
            let third = face
                .get(2)
                .map_or([0.0, 1.0], |corner| [corner.x, corner.y]);
            element.attitude = ListedAttitude::Corners {
                points: [0; 3],
                third,
                up: up.map(|up| self.vector(up)),
            };
        }
        element
    }

    fn vector(&mut self, vector: WrittenPoint) -> usize {
        self.kind.vectors.push(vector);
        self.kind.vectors.len() - 1
    }

    /// Appends the vectors and angles to which the attitudes of elements refer to the points.
    pub(super) fn append_vectors<'a>(
        &mut self,
        elements: impl Iterator<Item = &'a mut ListedElement>,
        points: &mut Vec<WrittenPoint>,
    ) {
        for element in elements {
            if let ListedAttitude::Normal(number)
            | ListedAttitude::Roll(number)
            | ListedAttitude::Corners {
                up: Some(number), ..
            } = &mut element.attitude
            {
                *number += points.len();
            }
        }
        points.append(&mut self.kind.vectors);
    }

    pub(super) fn initiator(&mut self, document: &RuleDocument) -> (Vec<F::Coordinates>, Part) {
        let initiator = &document.initiator;
        let mut written = Vec::new();
        let grown = { initiator.approximant.as_ref() }
            .map(|document| self.approximant(document).unwrap_or_default());
        let entries = grown.as_ref().map(|(entries, _)| entries.as_slice());
        let mut elements = self.elements(
            entries.unwrap_or(&initiator.entries),
            initiator.closed,
            initiator.connected,
            &mut written,
            true,
        );
        for (element, joined) in elements
            .iter_mut()
            .zip(grown.iter().flat_map(|(_, joins)| joins))
        {
            element.joined = *joined;
        }
        self.append_vectors(elements.iter_mut(), &mut written);
        let unknown = || F::splat(&Program::unknown());
        let programs = written.iter();
        let programs = programs.map(|point| F::point(self, point).unwrap_or_else(unknown));
        let programs: Vec<_> = programs.collect();
        let points = values::<F>(&programs);
        self.check_attitudes(&elements, &points, &written);
        self.find_corners(&mut elements, &programs, &written, &[], true);
        for element in &elements {
            if points[element.from] == points[element.to] {
                let place = &written[element.to].place.clone();
                self.error_with_hint(
                    place,
                    "this element of the initiator has no length",
                    "it ends where it starts",
                );
            }
        }
        let part = Part {
            placement: Placement::Stays,
            elements,
            meets_frame: [false; 2],
        };
        (programs, part)
    }
}
