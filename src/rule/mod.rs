//! Production rules: Kaandorp's system (Kaandorp 1987, section 2.1) as a validated model.
//!
//! A [`Rule`] holds no text that is still to be parsed and no name that is still to be looked up:
//! all indices are in range, all parameters have their values, all expressions are compiled and
//! see only names that exist where they are evaluated. Its initiator has at least one element and
//! every element that may be fertile has a generator.

mod base_element;
pub mod draw;
mod extent;
mod generator;
mod selection;

pub use base_element::{BaseElement, Piece, arc};
pub(crate) use extent::Extent;
pub(crate) use generator::Origin;
pub use generator::{Generator, ListedElement, Moment, Move, Part, Placement};
pub use selection::Selection;

use crate::geometry::DVec2;
use crate::heading::{Description, Heading, Parameter};
use crate::style::{Style, View};

/// A production rule: an initiator, generators with a selection, and base elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    pub(crate) heading: Heading,
    /// How the initiator was written.
    pub(crate) origin: Origin,
    pub(crate) points: Vec<DVec2>,
    pub(crate) initiator: Part,
    pub(crate) generators: Vec<Generator>,
    pub(crate) selection: Selection,
    pub(crate) base_elements: Vec<BaseElement>,
}

impl Rule {
    /// What files of all kinds say.
    #[must_use]
    pub fn heading(&self) -> &Heading {
        &self.heading
    }

    /// Title, source and the like.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.heading.description
    }

    /// The parameters with their values.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.heading.parameters
    }

    /// The initiator's elements; their points are those of [`Rule::initiator_points`].
    #[must_use]
    pub fn initiator(&self) -> &Part {
        &self.initiator
    }

    /// The points of the initiator, in the rule's own units.
    #[must_use]
    pub fn initiator_points(&self) -> &[DVec2] {
        &self.points
    }

    /// The array of generators.
    #[must_use]
    pub fn generators(&self) -> &[Generator] {
        &self.generators
    }

    /// How a generator is selected for an element that does not name its own.
    #[must_use]
    pub fn selection(&self) -> &Selection {
        &self.selection
    }

    /// The base elements that elements refer to by number; 0 is the rule's.
    #[must_use]
    pub fn base_elements(&self) -> &[BaseElement] {
        &self.base_elements
    }

    /// The number of steps that the file proposes.
    #[must_use]
    pub fn steps(&self) -> Option<u32> {
        self.heading.steps
    }

    /// The published similarity dimension.
    #[must_use]
    pub fn dimension(&self) -> Option<f64> {
        self.heading.dimension
    }

    /// The published Hausdorff dimension, where it differs from the similarity dimension.
    #[must_use]
    pub fn hausdorff_dimension(&self) -> Option<f64> {
        self.heading.hausdorff_dimension
    }

    /// How it is drawn.
    #[must_use]
    pub fn style(&self) -> &Style {
        &self.heading.style
    }

    /// What part of the plane is drawn.
    #[must_use]
    pub fn view(&self) -> &View {
        &self.heading.view
    }

    /// Whether anything depends on draws: a random function, or selection at random.
    #[must_use]
    pub fn is_random(&self) -> bool {
        matches!(self.selection, Selection::AtRandom(_)) && self.selection.candidates().len() > 1
            || self.generators.iter().any(Generator::is_random)
    }
}
