//! Corners that neighbouring elements share, for draws that belong to edges.

use std::collections::BTreeMap;

use crate::document::WrittenPoint;
use crate::draws::{Corner, Variable};
use crate::expression::{Dependence, Program};
use crate::geometry::{DVec3, Point as _};
use crate::resolve::Resolver;
use crate::rule::{ElementContext, ListedAttitude, ListedElement, constant};

use super::{OfRule, ResolvedFrame};

/// Largest distance of a point from the third corner of the base element that it is.
const FITS: f64 = 1e-12;

impl<F: ResolvedFrame> Resolver<OfRule<F>> {
    /// Finds the origins of the corners of elements, if any generator draws by edge. A point that depends on the draw of an
    /// edge lies on that edge, and points that are written alike are one.
    pub(super) fn find_corners(
        &self,
        elements: &mut [ListedElement],
        points: &[F::Coordinates],
        written: &[WrittenPoint],
        variables: &[Variable],
        is_initiator: bool,
    ) {
        if !self.kind.draws_by_edge {
            return;
        }
        let text = |WrittenPoint { x, y, z, .. }: &WrittenPoint| {
            let z = z.as_ref().map(|z| z.value.to_string());
            [
                x.value.to_string(),
                y.value.to_string(),
                z.unwrap_or_default(),
            ]
        };
        let mut alike: BTreeMap<[String; 3], usize> = BTreeMap::new();
        for (number, point) in written.iter().enumerate() {
            alike.entry(text(point)).or_insert(number);
        }
        let third = self.kind.base_elements.first().map(F::face);
        let third = third.and_then(|face| face.get(2)).copied();
        let replaced = [Some(DVec3::ZERO), Some(DVec3::X), third];
        let corner = |number: usize| {
            let point = &points[number];
            let mut edges = variables.iter().zip(ElementContext::NAMES.len()..);
            let on = edges.find(|(variable, slot)| {
                let depends = |program| Program::dependence(program, *slot) != Dependence::None;
                variable.edge().is_some() && point.as_ref().iter().any(depends)
            });
            if let Some(edge) = on.and_then(|(variable, _)| variable.edge()) {
                return Corner::OnEdge(edge);
            }
            let known = constant::<F>(point).map(|known| DVec3::from(known.coordinates()));
            let is_at = |corner: &Option<DVec3>| match (corner, known) {
                (Some(corner), Some(known)) => corner.distance(known) <= FITS,
                _ => false,
            };
            let same = { replaced.iter().position(is_at) }.filter(|_| !is_initiator);
            if let Some(Ok(corner)) = same.map(u8::try_from) {
                return Corner::Same(corner);
            }
            let first = alike.get(&text(&written[number])).copied();
            let first = u16::try_from(first.unwrap_or(number));
            first.map_or(Corner::Apart, Corner::Inside)
        };
        for element in elements {
            let ends = match element.direction.is_reversed() {
                true => [element.to, element.from],
                false => [element.from, element.to],
            };
            let third = match &element.attitude {
                ListedAttitude::Face(numbers) => numbers.get(2),
                ListedAttitude::Corners { points, .. } => points.get(2),
                _ => None,
            };
            // A reflected copy of a face has its third corner elsewhere.
            let third = third.filter(|_| element.direction.number() == 1);
            let [from, to] = ends.map(corner);
            let third = third.map_or(Corner::Apart, |third| corner(*third));
            element.corners = Some([from, to, third]);
        }
    }
}
