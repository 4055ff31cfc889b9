//! Production rules: Kaandorp's system (Kaandorp 1987, section 2.1) as a validated model.
//!
//! A [`Rule`] contains no unparsed text and no unresolved name: all indices are in range, all parameters
//! have values, and all expressions are compiled and refer only to names that exist where they are
//! evaluated. The initiator has at least one element, and every element that may be fertile has a
//! generator.

mod body;
mod extent;
mod frame;
mod generator;
mod growing;
mod selection;

pub use crate::geometry::{BaseElement, Piece, arc};
pub use body::{Body, Surface};
pub(crate) use extent::{Extent, PowerMeans};
pub use frame::{RuleFrame, Turn};
pub(crate) use frame::{constant, evaluated, newell};
pub(crate) use generator::Origin;
pub use generator::{
    ElementContext, Generator, ListedAttitude, ListedElement, Move, Part, Placement,
};
pub use growing::GrowthStart;
pub use selection::Selection;

use crate::geometry::Frame2;
use crate::metadata::{Description, Metadata, Parameter};
use crate::style::{Style, View};
use crate::tween::Growing;

/// Production rule, of the plane or of space: an initiator, generators with a selection, and base elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Rule<F: RuleFrame = Frame2> {
    pub(crate) metadata: Metadata,
    pub(crate) points: Vec<F::Point>,
    /// Points of the initiator as written.
    pub(crate) written_points: Vec<F::Coordinates>,
    pub(crate) initiator: Part,
    pub(crate) generators: Vec<Generator<F>>,
    pub(crate) selection: Selection,
    pub(crate) base_elements: Vec<F::BaseElement>,
    /// Step that is drawn while it grows, if there is one.
    pub(crate) growing: Option<Growing>,
}

impl<F: RuleFrame> Rule<F> {
    /// Returns the metadata of the file.
    #[must_use]
    pub fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    /// Returns title, source and related metadata.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.metadata.description
    }

    /// Returns the parameters with their values.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.metadata.parameters
    }

    /// Returns the elements of the initiator; their points are those of [`Rule::initiator_points`].
    #[must_use]
    pub fn initiator(&self) -> &Part {
        &self.initiator
    }

    /// Returns the points of the initiator, in the rule's units, and the vectors and angles to which the attitudes of
    /// its elements refer.
    #[must_use]
    pub fn initiator_points(&self) -> &[F::Point] {
        &self.points
    }

    /// Returns the generators.
    #[must_use]
    pub fn generators(&self) -> &[Generator<F>] {
        &self.generators
    }

    /// Returns the selection of generators for elements that name none.
    #[must_use]
    pub fn selection(&self) -> &Selection {
        &self.selection
    }

    /// Returns the base elements, to which elements refer by number; number 0 is that of the rule.
    #[must_use]
    pub fn base_elements(&self) -> &[F::BaseElement] {
        &self.base_elements
    }

    /// Returns the number of steps that the file proposes.
    #[must_use]
    pub fn steps(&self) -> Option<u32> {
        self.metadata.steps
    }

    /// Returns the published similarity dimension.
    #[must_use]
    pub fn dimension(&self) -> Option<f64> {
        self.metadata.dimension
    }

    /// Returns the published Hausdorff dimension, where it differs from the similarity dimension.
    #[must_use]
    pub fn hausdorff_dimension(&self) -> Option<f64> {
        self.metadata.hausdorff_dimension
    }

    /// Returns the style.
    #[must_use]
    pub fn style(&self) -> &Style {
        &self.metadata.style
    }

    /// Returns the view: in the plane, the part that is drawn.
    #[must_use]
    pub fn view(&self) -> &View {
        &self.metadata.view
    }

    /// Returns whether the rule depends on random draws: by a random function, or by selection at random
    /// among several generators.
    #[must_use]
    pub fn is_random(&self) -> bool {
        matches!(self.selection, Selection::AtRandom(_)) && self.selection.candidates().len() > 1
            || self.generators.iter().any(Generator::is_random)
    }

    /// Returns whether the frames of some elements are not similarities.
    #[must_use]
    pub fn is_affine(&self) -> bool {
        let listed = self.generators.iter().flat_map(Generator::elements);
        let mut all = listed.chain(&self.initiator.elements);
        all.any(ListedElement::is_stretched)
    }
}
