//! Ranges of lengths in which an object has the same expansion down to a cutoff length.

use std::collections::BinaryHeap;

use crate::geometry::Frame;
use crate::graph::{Graph, Instance};
use crate::priority::Keyed;

/// Maximum number of objects of a graph; for larger graphs no ranges are computed.
const MAX_OBJECTS: usize = 1 << 12;

/// Factor that allows for rounding: ratios of lengths that differ by less are taken to be equal.
const ROUNDING: f64 = 1.0 - 1e-12;

/// Range of lengths of an object, and its expansion down to length 1 (shorter elements are not replaced),
/// which is the same throughout the range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// Lower end of the range.
    pub(super) from: f64,
    /// Length in the range: the geometric mean of its ends, or twice the lower end if the range is
    /// unbounded.
    pub(super) length: f64,
    /// Number of steps of the expansion.
    pub(super) steps: u32,
    /// Number of elements of the expansion.
    pub(super) count: u64,
}

/// Consecutive ranges of lengths of an object, from 1, and the upper end of the last one.
#[derive(Clone, Debug, Default)]
pub(super) struct Cuts {
    pub(super) all: Vec<Cut>,
    pub(super) end: f64,
}

impl Cuts {
    /// Computes, for every object, the ranges whose expansions have at most `most` elements. Objects whose
    /// instances are not fixed have no ranges; the list is empty unless all maps are similarities.
    pub(super) fn of<F: Frame>(graph: &Graph<F>, most: u64) -> Vec<Self> {
        let knows = graph.objects().len() <= MAX_OBJECTS
            && !graph.is_time_indexed()
            && !graph.counts_index()
            && !graph.resets().contains(&true)
            && graph.is_similar();
        if !knows || most == 0 {
            return Vec::new();
        }
        let objects = 0..graph.objects().len();
        objects
            .map(|object| Self::of_object(graph, object, most))
            .collect()
    }

    fn of_object<F: Frame>(graph: &Graph<F>, object: usize, most: u64) -> Self {
        let mut cuts = Self::default();
        let mut leaves = Leaves {
            fertile: BinaryHeap::new(),
            count: 1,
            steps: 0,
        };
        let root = Keyed {
            key: 1.0,
            item: Leaf { object, steps: 0 },
        };
        if !leaves.replace(graph, root, most) {
            return cuts;
        }
        let mut from = 1.0;
        loop {
            // As the object's length increases, the longest leaf is the next to be replaced.
            let next = leaves
                .fertile
                .peek()
                .map_or(f64::INFINITY, |leaf| leaf.key.recip());
            if next * ROUNDING > from {
                let middle = if next.is_finite() {
                    (from * next).sqrt()
                } else {
                    2.0 * from
                };
                cuts.all.push(Cut {
                    from,
                    length: middle,
                    steps: leaves.steps,
                    count: leaves.count,
                });
                cuts.end = next;
                from = next;
            }
            let Some(first) = leaves.fertile.pop() else {
                return cuts;
            };
            let least = first.key * ROUNDING;
            let mut replaced = leaves.replace(graph, first, most);
            while replaced && leaves.fertile.peek().is_some_and(|leaf| leaf.key >= least) {
                let leaf = leaves.fertile.pop();
                replaced = leaf.is_some_and(|leaf| leaves.replace(graph, leaf, most));
            }
            if !replaced {
                return cuts;
            }
        }
    }

    /// Returns the number of the range that contains a length.
    #[inline]
    pub(super) fn number(&self, length: f64) -> Option<usize> {
        if length >= self.end {
            return None;
        }
        let longer = self.all.partition_point(|cut| cut.from <= length);
        longer.checked_sub(1)
    }
}

/// Fertile element of an expansion.
#[derive(Clone, Copy)]
struct Leaf {
    object: usize,
    steps: u32,
}

/// Partial expansion of an object.
struct Leaves {
    /// Fertile elements by their lengths, as multiples of the object's.
    fertile: BinaryHeap<Keyed<Leaf>>,
    count: u64,
    steps: u32,
}

impl Leaves {
    /// Replaces a leaf, and returns whether its instances are fixed and the limit of elements holds.
    fn replace<F: Frame>(&mut self, graph: &Graph<F>, leaf: Keyed<Leaf>, most: u64) -> bool {
        let Keyed { key, item: leaf } = leaf;
        let Some(successor) = graph.objects()[leaf.object].successor() else {
            return false;
        };
        let instances = &successor.body.instances;
        self.count += instances.len() as u64;
        self.count -= 1;
        self.steps = self.steps.max(leaf.steps + 1);
        let is_fertile = |instance: &&Instance<F>| graph.is_fertile(instance.object);
        for instance in instances.iter().filter(is_fertile) {
            let item = Leaf {
                object: instance.object,
                steps: leaf.steps + 1,
            };
            let key = key * instance.length;
            self.fertile.push(Keyed { key, item });
        }
        // The limit of steps ends the replacement of elements that do not shrink.
        self.count <= most && u64::from(self.steps) <= most
    }
}
