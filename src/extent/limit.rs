//! Reasons why a graph does not determine a limit set.

use crate::graph::Graph;

use super::Bounded;

/// Reason why a graph does not determine a limit set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoLimit {
    /// The set depends on the seed of random draws.
    #[error("numbers are drawn in it at random, so it has no one limit set")]
    Draws,
    /// The replacement of an element depends on the number of elements before it.
    #[error("what becomes of its elements hangs on their index, which no map tells")]
    CountsIndex,
    /// The graph is resolved for a limited number of steps only.
    #[error("what replaces an element changes from step to step without end")]
    Endless,
    /// Seeds are placed as the initiator.
    #[error("it has no limit set: its seeds are placed as the initiator, so nothing shrinks")]
    Resets,
    /// Elements do not shrink.
    #[error("it has no limit set: its elements do not shrink")]
    DoesNotShrink,
    /// The limit set is empty.
    #[error("nothing of it is drawn in the limit")]
    Empty,
}

impl<F: Bounded> Graph<F> {
    /// Checks that the graph determines the limit set: that of the approximants as drawn, which contains
    /// infertile visible elements.
    ///
    /// # Errors
    ///
    /// The reason why it does not.
    pub fn check_limit_set(&self) -> Result<(), NoLimit> {
        if self.draws() {
            return Err(NoLimit::Draws);
        }
        if !self.is_regular() || !self.is_plain() {
            return Err(NoLimit::CountsIndex);
        }
        if self.depth().is_some() {
            return Err(NoLimit::Endless);
        }
        if self.resets().contains(&true) {
            return Err(NoLimit::Resets);
        }
        if !self.contracts() {
            return Err(NoLimit::DoesNotShrink);
        }
        let alive = self.alive(true);
        let mut initiator = self.initiator(0).instances.iter();
        if !initiator.any(|instance| alive[instance.object]) {
            return Err(NoLimit::Empty);
        }
        Ok(())
    }
}
