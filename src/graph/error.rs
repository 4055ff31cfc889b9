//! Errors of compilation and of walks, and their diagnostics.

use crate::diagnostic::Diagnostic;
use crate::lsystem::RewriteError;
use crate::readable::grouped;
use crate::rule::{ElementContext, Rule, RuleFrame};

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
    /// An object of a structure has an instance whose drawn transform is not finite.
    #[error("object '{object}' has a drawn transform that is not finite where step = {step}")]
    DrawnNotFinite {
        /// Name of the object.
        object: String,
        /// Number of the approximant that was replaced.
        step: f64,
    },
    /// The model lies in space, and a graph of the plane is asked for.
    #[error("it lies in space, and this is known of the plane only")]
    InSpace,
    /// The word of an L-system cannot be derived.
    #[error(transparent)]
    Word(#[from] RewriteError),
    /// The graph of an L-system is too large, and its word cannot be derived instead.
    #[error(
        "{steps} steps need a graph of {} modules, all words at all steps, and {} are the most; without a graph, {word}",
        grouped(&(*work).into()),
        grouped(&(*most).into())
    )]
    LargeGraph {
        /// Number of steps.
        steps: u32,
        /// Number of modules of the words of all symbols at all steps.
        work: u64,
        /// Limit of this number.
        most: u64,
        /// A number of steps whose graph is within the limit.
        fits: u32,
        /// Error of the word.
        word: RewriteError,
    },
    /// The initiator and its images under a symmetry have too many elements to be listed.
    #[error("the initiator and its images under {group} have more than {} elements", grouped(&(*most).into()))]
    TooManyImages {
        /// Name of the group.
        group: String,
        /// Limit of their number.
        most: u64,
    },
    /// A coordinate of the turtle is beyond the range of doubles.
    #[error("the turtle goes too far: a coordinate is not finite")]
    TooFar,
    /// The model is too large, too small, or too far from the origin.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
}

impl CompileError {
    /// Returns a step that is compiled or written, where a later one is too large or takes too much work: the deepest whose word
    /// is short enough, or one whose graph is small enough.
    pub(crate) fn deepest(&self) -> Option<u32> {
        match self {
            Self::Word(RewriteError::TooLong { step, .. } | RewriteError::TooMuchWork { step }) => {
                step.checked_sub(1)
            }
            Self::LargeGraph { fits, word, .. } => match word {
                RewriteError::TooLong { step, .. } | RewriteError::TooMuchWork { step } => {
                    Some(step.saturating_sub(1).max(*fits))
                }
                RewriteError::NotFinite { .. } => Some(*fits),
            },
            _ => None,
        }
    }

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
    pub fn diagnostic<F: RuleFrame>(&self, rule: &Rule<F>) -> Diagnostic {
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

/// Least and greatest extent of a model: approximants must stay within the range of doubles.
pub(crate) const EXTENTS: [f64; 2] = [1e-300, 1e300];

/// Limit of the distance from the origin, as a multiple of the extent, beyond which doubles do not
/// resolve pixels.
pub(crate) const FARTHEST: f64 = 1e12;

/// Error: a model is beyond the range or the precision of doubles.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OutOfRange {
    /// The model is too large or too small.
    #[error(
        "it is {size:.3e} across: what is drawn and measured is from {least:e} to {most:e}; numbers \
         in other units are right",
        least = EXTENTS[0],
        most = EXTENTS[1]
    )]
    Size {
        /// Longer side of the bounding box, approximately, in the model's units.
        size: f64,
    },
    /// The model is too far from the origin.
    #[error(
        "it lies {distance:.3e} from the origin, {ratio:.1e} times its extent of {size:.3e}: numbers do not \
         distinguish its points, and less than {FARTHEST:e} times is right, such as a place at the origin",
        ratio = distance / size
    )]
    Distance {
        /// Distance from the origin: the larger coordinate, in the model's units.
        distance: f64,
        /// Longer side of the bounding box, approximately, in the model's units.
        size: f64,
    },
    /// An approximant leaves the range of doubles.
    #[error(
        "by step {step} it becomes larger than the range of numbers, 1.8e308: fewer steps are right"
    )]
    Growth {
        /// Number of steps of the approximant.
        step: u32,
    },
}
