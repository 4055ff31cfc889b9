//! Generators and what moves their points.

use crate::document::node::{Node, Value};
use crate::rule::Placement;

use super::written::{self, Entries};
use super::{Elements, Number, Point};

/// What replaces a fertile element. A list of elements, or of points, is a generator.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct Generator {
    variables: Entries,
    moves: Vec<Node>,
    parts: Vec<(Placement, Elements)>,
}

impl Generator {
    /// A generator without parts, to which some are added.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a part.
    pub fn part(mut self, placement: Placement, elements: impl Into<Elements>) -> Self {
        self.parts.push((placement, elements.into()));
        self
    }

    /// Adds a variable that is drawn anew for every element that is replaced, from
    /// `uniform(a, b)`, `normal(mean, deviation)` or `choice(a, b, ...)`.
    pub fn random(self, name: impl Into<String>, distribution: impl Into<Number>) -> Self {
        Self {
            variables: self.variables.add(name, distribution.into().0),
            ..self
        }
    }

    /// Adds a move, which is done after those before it.
    pub fn moves(mut self, moving: Move) -> Self {
        self.moves.push(moving.0.value().into());
        self
    }

    pub(super) fn value(self) -> Value {
        let has_more = !self.variables.is_empty() || !self.moves.is_empty();
        if let ([(Placement::Stays, elements)], false) = (self.parts.as_slice(), has_more)
            && elements.is_list()
        {
            return elements.clone().value();
        }
        let parts = self.parts.into_iter().map(|(placement, elements)| {
            let entries = match placement {
                Placement::Stays => Entries::default(),
                Placement::Seeds => Entries::default().set("seeds", Value::Bool(true)),
                Placement::SeedsAsInitiator => Entries::default()
                    .set("seeds", Value::Bool(true))
                    .set("placed", Value::Text("initiator".into())),
            };
            entries.and(elements.entries()).value()
        });
        let mut entries = Entries::default();
        if !self.variables.is_empty() {
            entries = entries.set("random", self.variables.value());
        }
        if !self.moves.is_empty() {
            entries = entries.set("move", Value::Sequence(self.moves));
        }
        entries.set("parts", written::sequence(parts)).value()
    }
}

impl<E: Into<Elements>> From<E> for Generator {
    fn from(elements: E) -> Self {
        Self::new().part(Placement::Stays, elements)
    }
}

/// Scales and turns points of a generator about a centre, then shifts them.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct Move(Entries);

impl Move {
    /// A move that is still to be told what it does. It moves all points but the two ends of what
    /// takes the element's place.
    pub fn new() -> Self {
        Self::default()
    }

    /// The angle, in degrees, positive counter-clockwise; 0 if nothing is said.
    pub fn rotate(self, angle: impl Into<Number>) -> Self {
        Self(self.0.set("rotate", angle.into().0))
    }

    /// The factors along x and y; 1 if nothing is said.
    pub fn scale(self, factors: impl Into<Point>) -> Self {
        Self(self.0.set("scale", factors.into().0))
    }

    /// How far points are shifted in the end; not at all if nothing is said.
    pub fn shift(self, shift: impl Into<Point>) -> Self {
        Self(self.0.set("shift", shift.into().0))
    }

    /// The centre of turning and scaling; (0, 0) if nothing is said.
    pub fn about(self, centre: impl Into<Point>) -> Self {
        Self(self.0.set("about", centre.into().0))
    }

    /// The numbers of the points that move, from 0 in the order in which they are first written.
    pub fn points(self, numbers: impl IntoIterator<Item = u32>) -> Self {
        let numbers = numbers.into_iter();
        let numbers = numbers.map(|number| Value::Number(f64::from(number)));
        Self(self.0.set("points", written::sequence(numbers)))
    }

    /// All points move, the two ends too.
    pub fn all_points(self) -> Self {
        Self(self.0.set("points", Value::Text("all".into())))
    }
}
