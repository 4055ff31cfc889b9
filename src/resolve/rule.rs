//! Resolution of production rules.

mod approximant;
mod attitude;
mod base_element;
mod body;
mod corners;
mod elements;
mod frame;
mod generator;
mod moves;
mod selection;

use std::collections::HashMap;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Place};
use crate::document::{RuleDocument, WrittenPoint};
use crate::geometry::Point as _;
use crate::metadata::Metadata;
use crate::rule::{ElementContext, Generator, ListedElement, Rule, Selection, constant};

use crate::style::{ColorBy, Width};
use generator::loops_shrink;

use super::Resolver;
use super::random::BY_EDGE;
pub(super) use frame::ResolvedFrame;

/// State that is specific to rules.
pub(super) struct OfRule<F: ResolvedFrame> {
    base_elements: Vec<F::BaseElement>,
    /// Places of base elements, with their indices.
    base_element_places: Vec<(Place, usize)>,
    /// Vectors and angles to which the attitudes of elements refer, until they follow the points.
    vectors: Vec<WrittenPoint>,
    generator_names: Vec<String>,
    generator_numbers: HashMap<String, usize>,
    /// Warnings of elements that are not shorter than those they replace. The warnings are dropped if
    /// every cycle of generators shrinks nonetheless.
    growing: Vec<Diagnostic>,
    /// Whether draws of a generator belong to edges.
    draws_by_edge: bool,
    /// Width of the tubes that lines are in space, as a multiple of the element's length.
    tube: Option<f64>,
}

impl<F: ResolvedFrame> Default for OfRule<F> {
    fn default() -> Self {
        Self {
            base_elements: Vec::new(),
            base_element_places: Vec::new(),
            vectors: Vec::new(),
            generator_names: Vec::new(),
            generator_numbers: HashMap::new(),
            growing: Vec::new(),
            draws_by_edge: false,
            tube: None,
        }
    }
}

impl<F: ResolvedFrame> Resolver<OfRule<F>> {
    pub(super) fn rule(&mut self, document: &RuleDocument, mut metadata: Metadata) -> Rule<F> {
        self.kind.tube = match metadata.style.width {
            Width::Relative(width) => Some(width).filter(|width| *width > 0.0),
            Width::Pixels(_) => None,
        };
        match &document.base_element {
            Some(document) => {
                self.base_element(document);
            }
            None => {
                self.kind.base_elements.push(F::line(self.kind.tube));
            }
        }
        let names = document.generators.iter().map(|(name, _)| &name.value);
        self.kind.generator_names = names.cloned().collect();
        let numbers = self.kind.generator_names.iter().cloned().zip(0..);
        self.kind.generator_numbers = numbers.collect();

        let mut moment = self.constants.clone();
        for (slot, name) in ElementContext::NAMES.into_iter().enumerate() {
            moment.variable(name, slot);
        }
        let moment = Arc::new(moment);
        let random = { document.generators.iter() }.flat_map(|(_, generator)| &generator.random);
        self.kind.draws_by_edge =
            { random }.any(|(_, drawn)| matches!(drawn.value.as_call(), Some((BY_EDGE, _))));
        let (written_points, initiator) = self.initiator(document);
        let generators: Vec<_> = document
            .generators
            .iter()
            .map(|(name, generator)| self.generator(name, generator, &moment))
            .collect();
        let selection = self.selection(document, &moment);
        self.check_generators_are_selected(document);
        let growing = std::mem::take(&mut self.kind.growing);
        let selection = selection.unwrap_or(Selection::Always(0));
        if !growing.is_empty() && !loops_shrink(&generators, &selection) {
            growing
                .into_iter()
                .for_each(|doubt| self.diagnostics.push(doubt));
        }
        let base_elements = std::mem::take(&mut self.kind.base_elements);
        let is_tinted = |element: &ListedElement| element.tint.is_some();
        let has_colours = base_elements.iter().any(F::has_colours)
            || initiator.elements.iter().any(is_tinted)
            || { generators.iter().flat_map(Generator::elements) }.any(is_tinted);
        if has_colours && !document.metadata.sets_colours {
            metadata.style.color_by = ColorBy::Tint;
        }
        Rule {
            metadata,
            points: values::<F>(&written_points),
            written_points,
            initiator,
            generators,
            selection,
            base_elements,
            growing: None,
        }
    }
}

/// Returns the values of points; NaN for one whose coordinates are not constants.
fn values<F: ResolvedFrame>(points: &[F::Coordinates]) -> Vec<F::Point> {
    let values = points.iter().map(constant::<F>);
    values
        .map(|it| it.unwrap_or(F::Point::splat(f64::NAN)))
        .collect()
}
