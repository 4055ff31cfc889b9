//! Points whose images are to be worked out, by the number of maps that lead to them.

use std::collections::VecDeque;

use super::net::Net;

/// Points by the number of maps and by set: what comes next, and what is some maps further.
pub(super) struct Waves<P> {
    coming: VecDeque<Vec<Vec<P>>>,
}

impl<P> Waves<P> {
    /// No points of any set yet.
    pub(super) fn of(net: &Net) -> Self {
        let coming = (0..net.most_maps()).map(|_| none(net.nodes.len()));
        Self {
            coming: coming.collect(),
        }
    }

    /// Adds a point of a set that so many maps lead to from those of the last wave. Those of a start, to
    /// which none does, come next.
    #[inline]
    pub(super) fn push(&mut self, maps: usize, node: usize, point: P) {
        self.coming[maps.saturating_sub(1)][node].push(point);
    }

    /// Takes the points of the next wave, by set.
    pub(super) fn next(&mut self) -> Vec<Vec<P>> {
        let nodes = self.coming.front().map_or(0, Vec::len);
        self.coming.push_back(none(nodes));
        self.coming.pop_front().unwrap_or_default()
    }

    /// Whether no points are left.
    pub(super) fn are_over(&self) -> bool {
        self.coming.iter().flatten().all(Vec::is_empty)
    }
}

fn none<P>(nodes: usize) -> Vec<Vec<P>> {
    (0..nodes).map(|_| Vec::new()).collect()
}
