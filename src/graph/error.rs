//! Errors of compilation and of walks, and their diagnostics.

use crate::diagnostic::Diagnostic;
use crate::lsystem::RewriteError;
use crate::model::OutOfRange;
use crate::rule::{ElementContext, Rule};

/// Error: a model cannot be compiled or grown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompileError {
    /// A generator has a point that is not finite.
    #[error(
        "generator '{generator}' has a point that is not finite where i = {index}, age = {age}, \
         step = {step}, length = {length}"
    )]
    NotFinite {
        /// Name of the generator.
        generator: String,
        /// Index of the element in its fractal (modulo m, where only the remainder matters).
        index: f64,
        /// Age of its fractal.
        age: f64,
        /// Number of the approximant that was replaced.
        step: f64,
        /// Length of the element relative to that of its initiator element.
        length: f64,
    },
    /// The word of an L-system cannot be derived.
    #[error(transparent)]
    Word(#[from] RewriteError),
    /// A coordinate of the turtle is beyond the range of doubles.
    #[error("the turtle goes too far: a coordinate is not finite")]
    TooFar,
    /// The model is too large, too small, or too far from the origin.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
}

impl CompileError {
    pub(crate) fn not_finite(generator: &str, moment: &ElementContext) -> Self {
        Self::NotFinite {
            generator: generator.into(),
            index: moment.index,
            age: moment.age,
            step: moment.step,
            length: moment.length,
        }
    }

    /// Converts the error to a diagnostic of the file from which the rule was read.
    #[must_use]
    pub fn diagnostic(&self, rule: &Rule) -> Diagnostic {
        let Self::NotFinite {
            generator,
            index,
            age,
            step,
            length,
        } = self
        else {
            return Diagnostic::error(self.to_string());
        };
        let moment = ElementContext {
            index: *index,
            age: *age,
            step: *step,
            length: *length,
        };
        let diagnostic = Diagnostic::error(self.to_string());
        let mut generators = rule.generators().iter();
        let Some(generator) = generators.find(|known| known.name() == generator) else {
            return diagnostic;
        };
        match generator.infinite_coordinate(&moment) {
            Some((place, values)) => {
                let values = values
                    .iter()
                    .map(|(name, value)| format!("{name} = {value}"));
                let values = values.collect::<Vec<_>>().join(", ");
                Diagnostic::error(format!("this is not finite where {values}"))
                    .at(place)
                    .hint("if(CONDITION, THIS, OTHERWISE) chooses between two values")
            }
            None => diagnostic.at(&generator.origin.name),
        }
    }
}
