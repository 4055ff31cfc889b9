//! Elements and lists of them.

use crate::document::node::{Node, Value};
use crate::geometry::Direction;
use crate::rule::BaseElement;

use super::Point;
use super::written::{self, Entries};

/// A list of elements: an initiator, or a part of a generator.
///
/// A point is an element that runs to it from the one before; the first point is where the list
/// starts. Any number of points make a list of elements.
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct Elements {
    flags: Entries,
    list: Vec<Node>,
}

impl Elements {
    /// A list without elements, to which some are added.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a point.
    pub fn point(mut self, point: impl Into<Point>) -> Self {
        self.list.push(point.into().0.into());
        self
    }

    /// Adds an element.
    pub fn element(mut self, element: Element) -> Self {
        self.list.push(element.0.value().into());
        self
    }

    /// Whether one more element runs from the last point to the first. Only initiators and parts
    /// that seed can be closed.
    pub fn closed(self, closed: bool) -> Self {
        Self {
            flags: self.flags.set("closed", Value::Bool(closed)),
            ..self
        }
    }

    /// Whether elements join at all, as they do if nothing is said.
    pub fn connected(self, connected: bool) -> Self {
        Self {
            flags: self.flags.set("connected", Value::Bool(connected)),
            ..self
        }
    }

    /// What `elements` and the keys beside it hold.
    pub(super) fn entries(self) -> Entries {
        self.flags.set("elements", Value::Sequence(self.list))
    }

    /// Whether there is nothing to say but what the elements are.
    pub(super) fn is_list(&self) -> bool {
        self.flags.is_empty()
    }

    /// The bare list, if there is nothing else to say.
    pub(super) fn value(self) -> Value {
        if self.is_list() {
            Value::Sequence(self.list)
        } else {
            self.entries().value()
        }
    }
}

impl<I: IntoIterator<Item: Into<Point>>> From<I> for Elements {
    fn from(points: I) -> Self {
        points.into_iter().fold(Self::new(), Self::point)
    }
}

/// An element with more to say than where it runs to.
#[derive(Clone, Debug)]
#[must_use]
pub struct Element(Entries);

impl Element {
    /// An element to a point, from where the one before it ends.
    pub fn to(point: impl Into<Point>) -> Self {
        Self(Entries::default().set("to", point.into().0))
    }

    fn set(self, key: &str, value: Value) -> Self {
        Self(self.0.set(key, value))
    }

    /// The point that it runs from. It joins the element before if that ends in this very point.
    pub fn from(self, point: impl Into<Point>) -> Self {
        self.set("from", point.into().0)
    }

    /// Its direction; normal if nothing is said.
    pub fn direction(self, direction: Direction) -> Self {
        let number = f64::from(direction.number());
        self.set("direction", Value::Number(number))
    }

    /// Whether it is replaced in the next step, as it is if nothing is said.
    pub fn fertile(self, fertile: bool) -> Self {
        self.set("fertile", Value::Bool(fertile))
    }

    /// Whether it is drawn, as it is if nothing is said.
    pub fn visible(self, visible: bool) -> Self {
        self.set("visible", Value::Bool(visible))
    }

    /// Whether it may join the element before it, as it may if nothing is said.
    pub fn connected(self, connected: bool) -> Self {
        self.set("connected", Value::Bool(connected))
    }

    /// The generator that replaces it, whatever the selection says.
    pub fn generator(self, name: impl Into<String>) -> Self {
        self.set("use", Value::Text(name.into()))
    }

    /// A base element of its own.
    pub fn base_element(self, base_element: &BaseElement) -> Self {
        self.set("base_element", written::base_element(base_element))
    }
}
