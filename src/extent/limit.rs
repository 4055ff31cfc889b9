//! The limit set of a graph, or the reason why there is none.

use crate::geometry::{Bounds, Frame, Frame2};
use crate::graph::Graph;
use crate::lsystem::NoGrowth;

use super::Bounded;

/// Reason why a graph does not determine a limit set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoLimit {
    /// The set depends on the seed of random draws.
    #[error("numbers are drawn in it at random, so it has no one limit set")]
    Draws,
    /// The replacement of an element depends on the number of elements before it.
    #[error("the replacement of its elements depends on their index, which no map determines")]
    CountsIndex,
    /// The graph is resolved for a limited number of steps only.
    #[error("what replaces an element changes from step to step without end")]
    Endless,
    /// Seeds are placed as the initiator.
    #[error("it has no limit set: its seeds are placed as the initiator, so nothing shrinks")]
    Resets,
    /// Elements do not shrink.
    #[error("there is no limit set: what is replaced does not shrink")]
    DoesNotShrink,
    /// Products of very many maps are needed until all of them shrink.
    #[error("its maps enlarge before they shrink, in products of too many to be followed")]
    ShrinksLate,
    /// No element is replaced infinitely often.
    #[error("nothing stays fertile")]
    NothingFertile,
    /// Products of maps grow, and shrink on average only.
    #[error(
        "there is no limit set: its maps contract on average only, and random iteration draws the measure that its points \
         approach"
    )]
    OnAverage,
    /// The words of an L-system approach no limit set.
    #[error(transparent)]
    Words(#[from] NoGrowth),
    /// The limit set is empty.
    #[error("nothing of it is drawn in the limit")]
    Empty,
}

/// The limit set of a graph: that of the approximants as drawn, which contains infertile visible elements.
#[derive(Clone, Debug)]
pub struct Limit<'g, F: Frame = Frame2> {
    graph: &'g Graph<F>,
    /// Whether the subtree of each object is drawn in the limit.
    drawn: Vec<bool>,
}

impl<F: Bounded> Limit<'_, F> {
    /// Returns the bounding box; `None` if the graph does not determine it (see
    /// [`limit_bounds`](Graph::limit_bounds)).
    #[must_use]
    pub fn bounds(&self) -> Option<Bounds<F::Point>> {
        self.graph.limit_bounds()
    }

    /// Returns, for every object, whether its subtree is drawn in the limit.
    #[must_use]
    pub fn drawn(&self) -> &[bool] {
        &self.drawn
    }
}

impl<F: Frame> Graph<F> {
    /// Checks that the replacements are a finite number of lists of fixed maps, composed with their parents'.
    ///
    /// # Errors
    ///
    /// The reason why they are not.
    pub(crate) fn check_maps(&self) -> Result<(), NoLimit> {
        if let Some(reason) = self.no_limit {
            return Err(reason);
        }
        if !self.is_regular() || !self.is_plain() {
            return Err(if self.draws() {
                NoLimit::Draws
            } else {
                NoLimit::CountsIndex
            });
        }
        if self.depth().is_some() {
            return Err(NoLimit::Endless);
        }
        if self.resets().contains(&true) {
            return Err(NoLimit::Resets);
        }
        Ok(())
    }
}

impl<F: Bounded> Graph<F> {
    /// Returns the limit set: that of the approximants as drawn, which contains infertile visible elements.
    ///
    /// # Errors
    ///
    /// The reason why the graph determines none.
    pub fn limit(&self) -> Result<Limit<'_, F>, NoLimit> {
        if self.draws() {
            return Err(NoLimit::Draws);
        }
        self.check_maps()?;
        if !self.contracts() {
            return Err(NoLimit::DoesNotShrink);
        }
        let drawn = self.alive(true);
        let mut initiator = self.initiator(0).instances.iter();
        if !initiator.any(|instance| drawn[instance.object]) {
            return Err(NoLimit::Empty);
        }
        Ok(Limit { graph: self, drawn })
    }
}
