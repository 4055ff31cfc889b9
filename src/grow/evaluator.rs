use crate::geometry::DVec2;
use crate::graph::{CompileError, Evaluated, Graph, Production, Replacement};
use crate::rule;

use super::start::Standing;

/// When an element is replaced.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    /// The step in which its fractal was born,
    pub(crate) born: u32,
    /// and that in which it was.
    pub(crate) level: u32,
    /// Its rank in its fractal, where ranks are counted; else 0.
    pub(crate) rank: u64,
}

impl Moment {
    /// What the expressions of a rule see of it, where an element stands.
    #[expect(clippy::cast_precision_loss, reason = "no walk counts to 2⁵³")]
    pub(crate) fn seen(self, standing: &Standing) -> rule::Moment {
        rule::Moment {
            index: self.rank.max(1) as f64,
            age: f64::from(self.level - self.born),
            step: f64::from(self.level),
            length: standing.length,
        }
    }
}

/// Works out productions where elements stand; memory is used again.
#[derive(Default)]
pub(crate) struct Evaluator {
    slots: Vec<f64>,
    points: Vec<DVec2>,
}

impl Evaluator {
    /// Overwrites a production with that of an object that is [`Replacement::Evaluated`].
    pub(crate) fn evaluate(
        &mut self,
        graph: &Graph,
        standing: &Standing,
        object: usize,
        moment: Moment,
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
