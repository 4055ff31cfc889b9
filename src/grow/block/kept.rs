//! Blocks that several walks over a graph share.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use crate::geometry::{Frame, Frame2};
use crate::graph::Graph;

use super::Blocks;

/// Maximum number of sets of blocks that are kept.
const MOST: usize = 4;

/// Blocks of one graph, kept for further walks over it.
pub(crate) struct KeptBlocks<F: Frame = Frame2>(Mutex<Vec<(Limits, Arc<Blocks<F>>)>>);

/// Largest number of elements of a block, and length below which elements are not replaced, in bits.
type Limits = (u64, Option<u64>);

impl<F: Frame> Default for KeptBlocks<F> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<F: Frame> KeptBlocks<F> {
    /// Returns the blocks that [`Blocks::of`] returns. All calls have the same graph.
    pub(in crate::grow) fn of(
        &self,
        graph: &Graph<F>,
        longest: u64,
        shortest: Option<f64>,
    ) -> Arc<Blocks<F>> {
        let limits = (longest, shortest.map(f64::to_bits));
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, blocks)) = kept.iter().find(|(known, _)| *known == limits) {
            return Arc::clone(blocks);
        }
        let blocks = Arc::new(Blocks::of(graph, longest, shortest));
        kept.truncate(MOST - 1);
        kept.insert(0, (limits, Arc::clone(&blocks)));
        blocks
    }
}

impl<F: Frame> fmt::Debug for KeptBlocks<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("KeptBlocks").finish_non_exhaustive()
    }
}
