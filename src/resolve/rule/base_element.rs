//! Resolution of base elements.

use crate::document::{BaseElementDocument, WrittenPoint};
use crate::geometry::{DVec2, Direction, Frame2};
use crate::resolve::Resolver;

use super::{OfRule, ResolvedFrame};
use crate::rule::BaseElement;

impl<F: ResolvedFrame> Resolver<OfRule<F>> {
    /// Returns the index of a base element, which is resolved if its place is new.
    pub(super) fn base_element(&mut self, document: &BaseElementDocument) -> usize {
        let known = self
            .kind
            .base_element_places
            .iter()
            .find(|(place, _)| *place == document.place);
        if let Some((_, known)) = known {
            return *known;
        }
        let made = F::base_element(self, document);
        // A valid placeholder prevents further reports at other uses.
        let tube = self.kind.tube;
        let number = self.known_or_new(made.unwrap_or_else(|| F::line(tube)));
        self.kind
            .base_element_places
            .push((document.place.clone(), number));
        number
    }

    /// Returns the index of a base element. Equal base elements share one index.
    fn known_or_new(&mut self, made: F::BaseElement) -> usize {
        let known = self
            .kind
            .base_elements
            .iter()
            .position(|known| *known == made);
        known.unwrap_or_else(|| {
            self.kind.base_elements.push(made);
            self.kind.base_elements.len() - 1
        })
    }
}

impl<K> Resolver<K> {
    /// Resolves a base element of the plane.
    pub(in crate::resolve) fn plane_base_element(
        &mut self,
        document: &BaseElementDocument,
    ) -> Option<BaseElement> {
        let before = self.diagnostics.len();
        let (outline, frame) = (self.outline(document), self.base_frame(document));
        match (outline, frame) {
            (Some((start, pieces)), Some(frame)) if self.diagnostics.len() == before => {
                let map = frame.map().inverse();
                let pieces = pieces.iter().map(|piece| piece.transformed(&map)).collect();
                let start = map.transform_point2(start);
                let made = BaseElement::new(start, pieces, document.closed);
                if made.is_none() {
                    self.error_with_hint(
                        &document.place,
                        "this base element has no extent",
                        "its points must not all be the same",
                    );
                }
                made
            }
            _ => None,
        }
    }

    /// Returns the frame that `from` and `to` define in the outline's own coordinates.
    fn base_frame(&mut self, document: &BaseElementDocument) -> Option<Frame2> {
        let mut end = |point: &Option<WrittenPoint>, default: DVec2| match point {
            Some(point) => self.constant_point(point),
            None => Some(default),
        };
        let (from, to) = (
            end(&document.from, DVec2::ZERO)?,
            end(&document.to, DVec2::X)?,
        );
        if from == to {
            self.report_no_base(document);
        }
        Some(Frame2::between(from, to, Direction::Normal))
    }

    /// Reports a base element whose `from` and `to` are one point.
    pub(super) fn report_no_base(&mut self, document: &BaseElementDocument) {
        let place = { document.from.as_ref().or(document.to.as_ref()) }.map(|point| &point.place);
        let place = place.unwrap_or(&document.place).clone();
        self.error_with_hint(
            &place,
            "`from` and `to` of this base element coincide",
            "they come to lie on (0, 0) and (1, 0)",
        );
    }
}
