//! From a rule as written to the validated model: names are looked up, expressions compiled,
//! everything is checked, and all that is wrong is said at once.
//!
//! Nothing is said of what depends on a mistake that has been reported: expressions that could not
//! be read and names that may belong to what was not found are unknown, and so is all that is
//! computed from them.

mod base_element;
mod elements;
mod generator;
mod numbers;
mod parameters;
mod random;
mod selection;

use std::collections::HashMap;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Diagnostics, Place};
use crate::document::{Number, RuleDocument, Setting};
use crate::expression::Scope;

use super::{BaseElement, Moment, Rule, Selection};

/// Behind this many mistakes no more are looked for.
const MOST_MISTAKES: usize = 1000;

/// Numbers of steps beyond this are refused.
pub(crate) const MOST_STEPS: u32 = 1_000_000;

impl Rule {
    /// Validates a rule as written, with parameters set from outside.
    ///
    /// # Errors
    ///
    /// All that is wrong with it. What is only doubtful comes with the rule.
    pub(crate) fn resolve(
        document: &RuleDocument,
        settings: &[Setting],
    ) -> Result<(Self, Diagnostics), Diagnostics> {
        let mut resolver = Resolver::default();
        let rule = resolver.rule(document, settings);
        if resolver.diagnostics.has_errors() {
            return Err(resolver.diagnostics);
        }
        Ok((rule, resolver.diagnostics))
    }
}

#[derive(Default)]
struct Resolver {
    diagnostics: Diagnostics,
    /// How many of them are errors.
    mistakes: usize,
    /// The rule's parameters.
    constants: Scope,
    base_elements: Vec<BaseElement>,
    /// Where base elements were written, and their numbers.
    base_element_places: Vec<(Place, usize)>,
    generator_names: Vec<String>,
    generator_numbers: HashMap<String, usize>,
    /// Whether a parent or a component is missing, which may have other names.
    incomplete: bool,
}

impl Resolver {
    fn error(&mut self, place: &Place, message: impl Into<String>) {
        self.mistakes += 1;
        self.diagnostics.push(Diagnostic::error(message).at(place));
    }

    fn error_with_hint(
        &mut self,
        place: &Place,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.mistakes += 1;
        self.diagnostics
            .push(Diagnostic::error(message).at(place).hint(hint));
    }

    fn rule(&mut self, document: &RuleDocument, settings: &[Setting]) -> Rule {
        self.incomplete = !document.complete;
        let parameters = self.parameters(document, settings);
        if self.incomplete {
            self.constants.accept_any_name();
        }
        match &document.base_element {
            Some(document) => {
                self.base_element(document);
            }
            None => {
                self.base_elements.push(BaseElement::line());
            }
        }
        let names = document.generators.iter().map(|(name, _)| &name.value);
        self.generator_names = names.cloned().collect();
        let numbers = self.generator_names.iter().cloned().zip(0..);
        self.generator_numbers = numbers.collect();

        let mut moment = self.constants.clone();
        for (slot, name) in Moment::NAMES.into_iter().enumerate() {
            moment.variable(name, slot);
        }
        let moment = Arc::new(moment);
        let (points, initiator) = self.initiator(document);
        let generators: Vec<_> = document
            .generators
            .iter()
            .map(|(name, generator)| self.generator(name, generator, &moment))
            .collect();
        let selection = self.selection(document, &moment);
        self.check_generators_are_selected(document);
        let steps = document.steps.as_ref();
        Rule {
            description: document.description.clone(),
            parameters,
            points,
            initiator,
            generators,
            selection: selection.unwrap_or(Selection::Always(0)),
            base_elements: std::mem::take(&mut self.base_elements),
            steps: steps.and_then(|number| self.steps(number)),
            dimension: self.dimension(document.dimension.as_ref()),
            hausdorff_dimension: self.dimension(document.hausdorff_dimension.as_ref()),
            style: document.style.clone(),
            view: document.view,
        }
    }

    fn steps(&mut self, number: &Number) -> Option<u32> {
        let value = self.constant(number)?;
        let whole = whole_number(value, MOST_STEPS);
        if whole.is_none() {
            let message = format!(
                "a number of steps is a whole number from 0 to 1,000,000{}",
                numbers::but(number, value)
            );
            if value > 0.0 && value <= f64::from(MOST_STEPS) {
                let hint = format!("steps: {}", value.trunc());
                self.error_with_hint(&number.place, message, hint);
            } else {
                self.error(&number.place, message);
            }
        }
        whole
    }

    fn dimension(&mut self, number: Option<&Number>) -> Option<f64> {
        self.constant(number?)
    }
}

fn is_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// A value as a whole number from 0 to `most`.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the value is checked"
)]
fn whole_number(value: f64, most: u32) -> Option<u32> {
    (value >= 0.0 && value <= f64::from(most) && value.fract() == 0.0).then_some(value as u32)
}
