//! Maps of a production rule.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::document::{MoveDocument, RuleDocument};
use crate::draws;
use crate::expression::Precise;
use crate::graph::{Graph, Instance};
use crate::rule::{self, ListedElement, Rule};

use crate::zoom::fixed::{Fixed, Vector, product};

use super::{Names, Numbers, Parent};

/// Maps of a production rule.
pub(super) struct OfRule<'a> {
    document: &'a RuleDocument,
    rule: &'a Rule,
    /// Points of the initiator.
    points: Vec<Vector>,
    /// Elements of every generator, by position.
    listed: Vec<Vec<&'a ListedElement>>,
}

impl<'a> OfRule<'a> {
    pub(super) fn new(document: &'a RuleDocument, rule: &'a Rule, numbers: &mut Numbers) -> Self {
        let points = rule.origin.points.iter();
        let generators = rule.generators().iter();
        Self {
            document,
            rule,
            points: points.map(|point| numbers.point(point, &[])).collect(),
            listed: generators.map(|it| it.elements().collect()).collect(),
        }
    }

    pub(super) fn root(&self, instance: &Instance) -> Fixed {
        let element = &self.rule.initiator().elements[instance.position as usize];
        let [from, to] = [element.from, element.to].map(|point| &self.points[point]);
        Fixed::between(from, to, element.direction)
    }

    pub(super) fn children(
        &self,
        graph: &Graph,
        parent: Parent<'_>,
        wanted: &[&Instance],
        numbers: &mut Numbers,
    ) -> Vec<Arc<Fixed>> {
        let Some(number) = wanted
            .first()
            .and_then(|it| graph.objects()[it.object].origin)
        else {
            return Vec::new();
        };
        let generator = &self.rule.generators()[number];
        let moment = parent.moment.seen(parent.standing);
        let slots = generator.slots(&moment, parent.standing.path);
        let variables = generator.variables().iter().map(draws::Variable::name);
        let names = rule::ElementContext::NAMES.into_iter().chain(variables);
        let names: Vec<(&str, Precise)> = names.zip(slots.into_iter().map(Precise::of)).collect();
        let mut points: BTreeMap<usize, Vector> = BTreeMap::new();
        for instance in wanted {
            let element = self.listed[number][instance.position as usize];
            for point in [element.from, element.to] {
                let written = &generator.origin.points[point];
                let made = points.entry(point);
                made.or_insert_with(|| numbers.point(written, &names));
            }
        }
        let moves = self.document.generators[number].1.moves.iter();
        for (written, moving) in moves.zip(&generator.moves) {
            let mut moved = moving.points.iter().filter(|it| points.contains_key(it));
            if moved.next().is_none() {
                continue;
            }
            let map = numbers.moving(written, &names);
            for point in &*moving.points {
                if let Some(point) = points.get_mut(point) {
                    *point = map.image(point, numbers.bits());
                }
            }
        }
        let child = |instance: &&Instance| {
            let element = self.listed[number][instance.position as usize];
            let [from, to] = [element.from, element.to].map(|point| &points[&point]);
            Arc::new(Fixed::between(from, to, element.direction))
        };
        wanted.iter().map(child).collect()
    }
}

impl Numbers {
    /// Evaluates the map of a [`rule::Move`].
    fn moving(&mut self, document: &MoveDocument, names: Names<'_>) -> Fixed {
        let bits = self.bits();
        let mut whole = Fixed::identity(bits);
        if let Some([x, y]) = &document.scale {
            let [x, y] = [x, y].map(|factor| self.fixed(factor, names));
            (whole.axes[0][0], whole.axes[1][1]) = (x, y);
        }
        if let Some(angle) = &document.rotate {
            let turn = self.turn(angle, names);
            whole = Fixed::rotation(turn, bits).after(&whole, bits, false);
        }
        let zero = || Fixed::identity(0).origin;
        let mut vector = |point: &Option<_>| match point {
            Some(point) => self.point(point, names),
            None => zero(),
        };
        let (about, shift) = (vector(&document.about), vector(&document.shift));
        let [[a, b], [c, d]] = &whole.axes;
        let turned =
            |first, second| product(first, &about[0], bits) + product(second, &about[1], bits);
        whole.origin = [
            &about[0] - turned(a, c) + &shift[0],
            &about[1] - turned(b, d) + &shift[1],
        ];
        whole
    }
}
