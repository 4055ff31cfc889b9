//! Productions that are computed for each element.

use crate::geometry::{Frame, Frame2};
use crate::graph::{Buffers, CompileError, Graph, Replacement, Successor};
use crate::rule;

use super::start::TraversalState;

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
    pub(crate) fn seen<F: Frame>(self, state: &TraversalState<F>) -> rule::ElementContext {
        rule::ElementContext {
            index: self.rank.max(1) as f64,
            age: f64::from(self.level - self.born),
            step: f64::from(self.level),
            length: state.length,
        }
    }
}

/// Evaluator of successors, with buffers that are reused.
#[derive(Default)]
pub(crate) struct Evaluator<F: Frame = Frame2>(Buffers<F>);

impl<F: Frame> Evaluator<F> {
    /// Returns the successor of an element that is replaced: a fixed one, or `made`, which is evaluated.
    pub(crate) fn successor<'s>(
        &mut self,
        graph: &'s Graph<F>,
        state: &TraversalState<F>,
        object: usize,
        moment: ReplacementContext,
        made: &'s mut Successor<F>,
    ) -> Result<&'s Successor<F>, CompileError> {
        if let Some(successor) = graph.objects()[object].successor() {
            return Ok(successor);
        }
        self.evaluate(graph, state, object, moment, made)?;
        Ok(made)
    }

    /// Computes the successor of an object that is [`Replacement::Evaluated`], and overwrites `successor`.
    pub(crate) fn evaluate(
        &mut self,
        graph: &Graph<F>,
        state: &TraversalState<F>,
        object: usize,
        moment: ReplacementContext,
        successor: &mut Successor<F>,
    ) -> Result<(), CompileError> {
        let Replacement::Evaluated(alternatives) = &graph.objects()[object].replacement else {
            unreachable!("a graph is walked no deeper than it is resolved");
        };
        let (path, context) = (state.path, moment.seen(state));
        let source = graph.source();
        source.evaluate(alternatives, path, &context, &mut self.0, successor)
    }
}
