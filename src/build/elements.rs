//! Builders of elements and of lists of elements.

use crate::document::node::{Node, Value};
use crate::geometry::Direction;
use crate::rule::BaseElement;

use super::PointText;
use super::written::{self, Entries};

/// A list of elements: an initiator, or a part of a generator.
///
/// The first point is the start of the list. Each further point adds an element from the previous point
/// to it. Any iterator of points converts to a list of elements.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct ElementsBuilder {
    flags: Entries,
    list: Vec<Node>,
}

impl ElementsBuilder {
    /// Creates an empty list.
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends a point.
    pub fn point(mut self, point: impl Into<PointText>) -> Self {
        self.list.push(point.into().0.into());
        self
    }

    /// Appends an element.
    pub fn element(mut self, element: ElementBuilder) -> Self {
        self.list.push(element.0.value().into());
        self
    }

    /// Sets whether one more element connects the last point to the first. Only initiators and seed
    /// parts can be closed. The default is false.
    pub fn closed(self, closed: bool) -> Self {
        Self {
            flags: self.flags.set("closed", Value::Bool(closed)),
            ..self
        }
    }

    /// Sets whether elements join each other. The default is true.
    pub fn connected(self, connected: bool) -> Self {
        Self {
            flags: self.flags.set("connected", Value::Bool(connected)),
            ..self
        }
    }

    /// Returns the entries for `elements` and the keys beside it.
    pub(super) fn entries(self) -> Entries {
        self.flags.set("elements", Value::Sequence(self.list))
    }

    /// Returns whether the list has no other keys than `elements`.
    pub(super) fn is_list(&self) -> bool {
        self.flags.is_empty()
    }

    /// Returns the bare list if it has no other keys, and a mapping otherwise.
    pub(super) fn value(self) -> Value {
        if self.is_list() {
            Value::Sequence(self.list)
        } else {
            self.entries().value()
        }
    }
}

impl<I: IntoIterator<Item: Into<PointText>>> From<I> for ElementsBuilder {
    fn from(points: I) -> Self {
        points.into_iter().fold(Self::new(), Self::point)
    }
}

/// An element with attributes.
#[derive(Clone, Debug)]
#[must_use]
pub struct ElementBuilder(Entries);

impl ElementBuilder {
    /// Creates an element from the end of the previous element to `point`.
    pub fn to(point: impl Into<PointText>) -> Self {
        Self(Entries::default().set("to", point.into().0))
    }

    fn set(self, key: &str, value: Value) -> Self {
        Self(self.0.set(key, value))
    }

    /// Sets the start point. The element joins the previous one if the two points are written alike.
    pub fn from(self, point: impl Into<PointText>) -> Self {
        self.set("from", point.into().0)
    }

    /// Sets the direction. The default is normal.
    pub fn direction(self, direction: Direction) -> Self {
        let number = f64::from(direction.number());
        self.set("direction", Value::Number(number))
    }

    /// Sets whether the element is replaced in the next step. The default is true.
    pub fn fertile(self, fertile: bool) -> Self {
        self.set("fertile", Value::Bool(fertile))
    }

    /// Sets whether the element is drawn. The default is true.
    pub fn visible(self, visible: bool) -> Self {
        self.set("visible", Value::Bool(visible))
    }

    /// Sets whether the element may join the previous one. The default is true.
    pub fn connected(self, connected: bool) -> Self {
        self.set("connected", Value::Bool(connected))
    }

    /// Sets the generator that replaces the element, which takes precedence over the selection.
    pub fn generator(self, name: impl Into<String>) -> Self {
        self.set("use", Value::Text(name.into()))
    }

    /// Sets the element's own base element.
    pub fn base_element(self, base_element: &BaseElement) -> Self {
        self.set("base_element", written::base_element(base_element))
    }
}
