//! Productions that are computed for each element.

use crate::geometry::DVec2;
use crate::graph::{CompileError, Evaluated, Graph, Production, Replacement};
use crate::rule;

use super::start::Standing;

/// Circumstances of a replacement, as far as they do not depend on the place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReplacementContext {
    /// Step in which the element's fractal was born.
    pub(crate) born: u32,
    /// Step in which the element was born.
    pub(crate) level: u32,
    /// Rank of the element in its fractal; 0 unless the walk counts ranks.
    pub(crate) rank: u64,
}

impl ReplacementContext {
    /// Returns the values that a rule's expressions see of the element.
    #[expect(clippy::cast_precision_loss, reason = "no walk counts to 2⁵³")]
    pub(crate) fn seen(self, standing: &Standing) -> rule::ElementContext {
        rule::ElementContext {
            index: self.rank.max(1) as f64,
            age: f64::from(self.level - self.born),
            step: f64::from(self.level),
            length: standing.length,
        }
    }
}

/// Evaluator of productions, with buffers that are reused.
#[derive(Default)]
pub(crate) struct Evaluator {
    slots: Vec<f64>,
    points: Vec<DVec2>,
}

impl Evaluator {
    /// Computes the production of an object that is [`Replacement::Evaluated`], and overwrites `production`.
    pub(crate) fn evaluate(
        &mut self,
        graph: &Graph,
        standing: &Standing,
        object: usize,
        moment: ReplacementContext,
        production: &mut Production,
    ) -> Result<(), CompileError> {
        let Replacement::Evaluated(alternatives) = &graph.objects()[object].replacement else {
            unreachable!("a graph is walked no deeper than it is resolved");
        };
        let rule = match graph.evaluated() {
            Evaluated::Rule(rule) => rule,
            Evaluated::Words(words) => {
                words.evaluate(alternatives, standing.path, production);
                return Ok(());
            }
        };
        let moment = moment.seen(standing);
        let alternative = if let [only] = &alternatives[..] {
            only
        } else {
            let generator = rule.selection().select(&moment, standing.path);
            alternatives
                .iter()
                .find(|alternative| alternative.generator == generator)
                .unwrap_or_else(|| unreachable!("every candidate has its alternative"))
        };
        let generator = &rule.generators()[alternative.generator];
        generator.evaluate(&moment, standing.path, &mut self.slots, &mut self.points);
        if !self.points.iter().all(|point| point.is_finite()) {
            return Err(CompileError::not_finite(generator.name(), &moment));
        }
        production.set(generator.parts(), &self.points, &alternative.objects);
        Ok(())
    }
}
