//! Points whose images are to be computed, by the number of maps that lead to them.

use std::collections::VecDeque;

use super::net::Net;

/// Points by the number of maps and by set: the next wave, and those of later waves.
pub(super) struct Waves<P> {
    coming: VecDeque<Vec<Vec<P>>>,
}

impl<P> Waves<P> {
    /// Creates waves without points.
    pub(super) fn of(net: &Net) -> Self {
        let coming = (0..net.max_maps()).map(|_| none(net.nodes.len()));
        Self {
            coming: coming.collect(),
        }
    }

    /// Adds a point of a set to which `maps` maps lead from a point of the last wave. Points to which no maps
    /// lead belong to the next wave.
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

    /// Returns whether no points are left.
    pub(super) fn are_over(&self) -> bool {
        self.coming.iter().flatten().all(Vec::is_empty)
    }
}

fn none<P>(nodes: usize) -> Vec<Vec<P>> {
    (0..nodes).map(|_| Vec::new()).collect()
}
