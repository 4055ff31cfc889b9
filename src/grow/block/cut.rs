use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::graph::{Graph, Instance, Replacement};

/// Of graphs with more objects than this it is not worked out.
const MOST_OBJECTS: usize = 1 << 12;

/// Ratios that differ by no more than rounding are one.
const ROUNDING: f64 = 1.0 - 1e-12;

/// What an object of some lengths becomes where no element is replaced that is shorter than 1: the same
/// elements for all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// The shortest of these lengths,
    pub(super) from: f64,
    /// and one in their middle.
    pub(super) length: f64,
    /// The number of steps that it takes.
    pub(super) steps: u32,
    /// The number of elements.
    pub(super) count: u64,
}

/// The cuts of an object, from length 1 on, and the length up to which they go.
#[derive(Clone, Debug, Default)]
pub(super) struct Cuts {
    pub(super) all: Vec<Cut>,
    pub(super) end: f64,
}

impl Cuts {
    /// By object, the cuts that make no more than `most` elements, if similarities place them all; none of
    /// objects whose instances are not fixed.
    pub(super) fn of(graph: &Graph, most: u64) -> Vec<Self> {
        let knows = graph.objects().len() <= MOST_OBJECTS
            && !graph.is_levelled()
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

    fn of_object(graph: &Graph, object: usize, most: u64) -> Self {
        let mut cuts = Self::default();
        let mut leaves = Leaves {
            fertile: BinaryHeap::new(),
            count: 1,
            steps: 0,
        };
        let root = Leaf {
            ratio: 1.0,
            object,
            steps: 0,
        };
        if !leaves.replace(graph, root, most) {
            return cuts;
        }
        let mut from = 1.0;
        loop {
            // The longest leaves are the next to be replaced, where the object is longer.
            let next = leaves.fertile.peek().map_or(f64::INFINITY, Leaf::from);
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
            let least = first.ratio * ROUNDING;
            let mut replaced = leaves.replace(graph, first, most);
            while replaced
                && leaves
                    .fertile
                    .peek()
                    .is_some_and(|leaf| leaf.ratio >= least)
            {
                let leaf = leaves.fertile.pop();
                replaced = leaf.is_some_and(|leaf| leaves.replace(graph, leaf, most));
            }
            if !replaced {
                return cuts;
            }
        }
    }

    /// The cut of a length, by number.
    #[inline]
    pub(super) fn number(&self, length: f64) -> Option<usize> {
        if length >= self.end {
            return None;
        }
        let longer = self.all.partition_point(|cut| cut.from <= length);
        longer.checked_sub(1)
    }
}

/// A fertile element that an object becomes.
#[derive(Clone, Copy)]
struct Leaf {
    /// Its length as a multiple of the object's.
    ratio: f64,
    object: usize,
    steps: u32,
}

impl Leaf {
    /// How long the object is at least if the leaf is replaced.
    fn from(&self) -> f64 {
        self.ratio.recip()
    }
}

impl Ord for Leaf {
    fn cmp(&self, other: &Self) -> Ordering {
        self.ratio.total_cmp(&other.ratio)
    }
}

impl PartialOrd for Leaf {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Leaf {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Leaf {}

/// What an object becomes, as far as it has been replaced.
struct Leaves {
    fertile: BinaryHeap<Leaf>,
    count: u64,
    steps: u32,
}

impl Leaves {
    /// Replaces a leaf; whether that can be done, and they are not too many.
    fn replace(&mut self, graph: &Graph, leaf: Leaf, most: u64) -> bool {
        let Replacement::Fixed(production) = &graph.objects()[leaf.object].replacement else {
            return false;
        };
        let instances = &production.body.instances;
        self.count += instances.len() as u64;
        self.count -= 1;
        self.steps = self.steps.max(leaf.steps + 1);
        let is_fertile = |instance: &&Instance| {
            let object = &graph.objects()[instance.object];
            !matches!(object.replacement, Replacement::Kept)
        };
        for instance in instances.iter().filter(is_fertile) {
            self.fertile.push(Leaf {
                ratio: leaf.ratio * instance.length,
                object: instance.object,
                steps: leaf.steps + 1,
            });
        }
        // What does not get shorter is replaced in vain.
        self.count <= most && u64::from(self.steps) <= most
    }
}
