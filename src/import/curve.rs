//! Rules of curves by edge replacement: one generator on the unit segment.

use crate::build::NumberText;
use crate::build::written::{Entries, sequence};
use crate::document::node::Value;
use crate::geometry::Direction;

use super::lattice::Lattice;

/// Number of elements up to which steps are drawn by default.
const DRAWN: usize = 5000;

/// An element of a generator, which begins where the one before it ends.
pub(super) struct Element {
    /// End of the element, as a point.
    pub(super) to: Value,
    pub(super) direction: Direction,
    pub(super) is_fertile: bool,
    pub(super) is_visible: bool,
}

impl Element {
    fn is_plain(&self) -> bool {
        self.direction == Direction::Normal && self.is_fertile && self.is_visible
    }

    fn value(self) -> Value {
        if self.is_plain() {
            return self.to;
        }
        let turned = (self.direction != Direction::Normal).then_some(self.direction);
        let turned = turned.map(|it| NumberText::from(i32::from(it.number())).0);
        Entries::default()
            .set("to", self.to)
            .set_some("direction", turned)
            .set_some("fertile", (!self.is_fertile).then_some(Value::Bool(false)))
            .set_some("visible", (!self.is_visible).then_some(Value::Bool(false)))
            .value()
    }
}

/// Returns the keys of the rule whose generator leads from (0, 0) through the ends of its elements.
pub(super) fn rule(elements: Vec<Element>) -> Entries {
    let point = |x| Lattice::Gaussian.point([x, 0], 1);
    let fertile = elements.iter().filter(|it| it.is_fertile).count();
    let points = elements.into_iter().map(Element::value);
    let generator = sequence([point(0)].into_iter().chain(points));
    Entries::default()
        .set("initiator", sequence([point(0), point(1)]))
        .set("generator", generator)
        .set("steps", Value::Number(f64::from(drawn_steps(fertile))))
}

/// Returns the largest number of steps from 1 to 12 with up to a number of elements.
fn drawn_steps(fertile: usize) -> u32 {
    let is_drawn = |steps: &u32| {
        fertile
            .checked_pow(*steps)
            .is_some_and(|count| count <= DRAWN)
    };
    (2..=12).take_while(is_drawn).last().unwrap_or(1)
}
