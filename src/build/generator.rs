//! Builders of generators and of the moves of their points.

use crate::document::node::{Node, Value};
use crate::rule::Placement;

use super::written::{self, Entries};
use super::{ElementsBuilder, NumberText, PointText};

/// A generator: the replacement of a fertile element. A list of elements or points converts to a
/// generator of one part.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct GeneratorBuilder {
    variables: Entries,
    moves: Vec<Node>,
    parts: Vec<(Placement, ElementsBuilder)>,
}

impl GeneratorBuilder {
    /// Creates a generator without parts.
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends a part.
    pub fn part(mut self, placement: Placement, elements: impl Into<ElementsBuilder>) -> Self {
        self.parts.push((placement, elements.into()));
        self
    }

    /// Adds a random variable, which is drawn for every replacement from `uniform(a, b)`, `normal(mean,
    /// deviation)` or `choice(a, b, ...)`.
    pub fn random(self, name: impl Into<String>, distribution: impl Into<NumberText>) -> Self {
        Self {
            variables: self.variables.add(name, distribution.into().0),
            ..self
        }
    }

    /// Appends a move, which acts after the previous ones.
    pub fn moves(mut self, moving: MoveBuilder) -> Self {
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

impl<E: Into<ElementsBuilder>> From<E> for GeneratorBuilder {
    fn from(elements: E) -> Self {
        Self::new().part(Placement::Stays, elements)
    }
}

/// A move of points of a generator: a scaling and a rotation about a centre, followed by a translation.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct MoveBuilder(Entries);

impl MoveBuilder {
    /// Creates the identity, which applies to all points but the first and the last one of what takes
    /// the element's place. Points of seed parts all move.
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the angle of rotation in degrees, counter-clockwise. The default is 0.
    pub fn rotate(self, angle: impl Into<NumberText>) -> Self {
        Self(self.0.set("rotate", angle.into().0))
    }

    /// Sets the scaling factors along x and y. The default is 1.
    pub fn scale(self, factors: impl Into<PointText>) -> Self {
        Self(self.0.set("scale", factors.into().0))
    }

    /// Sets the translation. The default is (0, 0).
    pub fn translate(self, translation: impl Into<PointText>) -> Self {
        Self(self.0.set("translate", translation.into().0))
    }

    /// Sets the centre of scaling and rotation. The default is (0, 0).
    pub fn about(self, centre: impl Into<PointText>) -> Self {
        Self(self.0.set("about", centre.into().0))
    }

    /// Sets the points that move, by their numbers from 0 in the order of their first occurrence.
    pub fn points(self, numbers: impl IntoIterator<Item = u32>) -> Self {
        let numbers = numbers.into_iter();
        let numbers = numbers.map(|number| Value::Number(f64::from(number)));
        Self(self.0.set("points", written::sequence(numbers)))
    }

    /// Moves all points, including the two ends.
    pub fn all_points(self) -> Self {
        Self(self.0.set("points", Value::Text("all".into())))
    }
}
