use crate::diagnostic::Diagnostic;
use crate::lsystem::RewriteError;
use crate::model::OutOfRange;
use crate::rule::{Moment, Rule};

/// A model that cannot be grown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CompileError {
    /// A generator has a point that is not finite.
    #[error(
        "generator '{generator}' has a point that is not finite where i = {index}, age = {age}, \
         step = {step}, length = {length}"
    )]
    NotFinite {
        /// The generator's name.
        generator: String,
        /// The element's rank in its fractal (modulo m, where only that matters).
        index: f64,
        /// The age of its fractal.
        age: f64,
        /// The number of the approximant that was being replaced.
        step: f64,
        /// Its length relative to the initiator's.
        length: f64,
    },
    /// The word of an L-system cannot be written.
    #[error(transparent)]
    Word(#[from] RewriteError),
    /// A turtle goes farther than a double can say.
    #[error("the turtle goes too far: a coordinate is not finite")]
    TooFar,
    /// The model is too large, too small, or too far from the origin.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
}

impl CompileError {
    pub(crate) fn not_finite(generator: &str, moment: &Moment) -> Self {
        Self::NotFinite {
            generator: generator.into(),
            index: moment.index,
            age: moment.age,
            step: moment.step,
            length: moment.length,
        }
    }

    /// The error as a mistake in the file that the rule was read from.
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
        let moment = Moment {
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
