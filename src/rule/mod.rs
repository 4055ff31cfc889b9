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
mod resolve;
mod selection;

pub use base_element::{BaseElement, Piece, arc};
pub(crate) use generator::Origin;
pub use generator::{Generator, ListedElement, Moment, Move, Part, Placement};
pub(crate) use resolve::MOST_STEPS;
pub use selection::Selection;

use crate::geometry::DVec2;
use crate::style::{Style, View};

/// What a file says about itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// The title.
    pub title: Option<String>,
    /// A few sentences.
    pub about: Option<String>,
    /// The paper, book or person that it comes from.
    pub source: Option<String>,
    /// Words to find it by.
    pub tags: Vec<String>,
}

/// A parameter with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// The name that expressions and `--set` call it by.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// The least value that it may have.
    pub min: Option<f64>,
    /// The largest value that it may have.
    pub max: Option<f64>,
    /// What it means.
    pub about: Option<String>,
}

impl Parameter {
    /// A parameter without limits.
    #[must_use]
    pub fn new(name: impl Into<String>, value: f64) -> Self {
        Self {
            name: name.into(),
            value,
            min: None,
            max: None,
            about: None,
        }
    }
}

/// A production rule: an initiator, generators with a selection, and base elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    pub(crate) description: Description,
    pub(crate) parameters: Vec<Parameter>,
    pub(crate) points: Vec<DVec2>,
    pub(crate) initiator: Part,
    pub(crate) generators: Vec<Generator>,
    pub(crate) selection: Selection,
    pub(crate) base_elements: Vec<BaseElement>,
    pub(crate) steps: Option<u32>,
    pub(crate) dimension: Option<f64>,
    pub(crate) hausdorff_dimension: Option<f64>,
    pub(crate) style: Style,
    pub(crate) view: View,
}

impl Rule {
    /// Title, source and the like.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The parameters with their values.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
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
        self.steps
    }

    /// The published similarity dimension.
    #[must_use]
    pub fn dimension(&self) -> Option<f64> {
        self.dimension
    }

    /// The published Hausdorff dimension, where it differs from the similarity dimension.
    #[must_use]
    pub fn hausdorff_dimension(&self) -> Option<f64> {
        self.hausdorff_dimension
    }

    /// How it is drawn.
    #[must_use]
    pub fn style(&self) -> &Style {
        &self.style
    }

    /// What part of the plane is drawn.
    #[must_use]
    pub fn view(&self) -> &View {
        &self.view
    }

    /// Whether anything depends on draws: a random function, or selection at random.
    #[must_use]
    pub fn is_random(&self) -> bool {
        matches!(self.selection, Selection::AtRandom(_)) && self.selection.candidates().len() > 1
            || self.generators.iter().any(Generator::is_random)
    }
}
