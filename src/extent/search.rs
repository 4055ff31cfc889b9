//! Bounding box of an approximant by branch and bound (Land & Doig 1960): an element is replaced only if its
//! subtree may extend beyond the box found so far.

use std::collections::BinaryHeap;

use crate::geometry::{Bounds, Frame, Outline, Point};
use crate::graph::{Graph, Successor};

use crate::grow::{
    Enter, Evaluator, Growth, ReplacementContext, Subtree, TraversalState, seed_placement,
};
use crate::parallel::is_cancelled;
use crate::priority::Keyed;

/// Maximum number of replacements; beyond it the search is abandoned.
const MAX_WORK: usize = 1 << 18;

/// Maximum number of elements that are looked at.
const MAX_LOOKED: usize = 1 << 23;

/// Radii of subtrees and padding, by object.
pub(crate) struct Reaches<'a> {
    /// Radius of the disc that contains the subtree of an object, about the middle of its unit frame: see
    /// [`Graph::reaches`].
    pub(crate) all: &'a [f64],
    /// Padding around the outline of an object, as a multiple of its length.
    pub(crate) pads: &'a [f64],
}

/// Element to be replaced.
struct Node<F: Frame> {
    state: TraversalState<F>,
    object: usize,
    /// Step of birth of its fractal.
    born: u32,
    level: u32,
}

struct Maximisation<'a, F: Frame, E> {
    graph: &'a Graph<F>,
    steps: u32,
    reaches: &'a Reaches<'a>,
    enter: E,
    /// Box of the elements found so far.
    bounds: Bounds<F::Point>,
    /// Direction in which the search maximises.
    direction: F::Point,
    /// Elements by the upper bounds of their subtrees' extent in that direction.
    heap: BinaryHeap<Keyed<Node<F>>>,
    /// Number of elements that have been looked at.
    looked: usize,
}

/// Computes the bounding box that a walk with `enter` as its visitor's decision would find, bit by bit.
///
/// `None` if the walk counts indices, if a subtree is not bounded, if a generator yields points that are not
/// finite, if the search takes more than 2¹⁸ replacements or 2²³ elements, or if it is cancelled. The box is empty if
/// nothing is drawn.
pub(crate) fn search<F: Frame>(
    graph: &Graph<F>,
    growth: &Growth<'_>,
    reaches: &Reaches<'_>,
    enter: impl Fn(&Subtree<F>) -> Enter,
) -> Option<Bounds<F::Point>> {
    if graph.counts_index() || !reaches.all.iter().all(|reach| reach.is_finite()) {
        return None;
    }
    let mut search = Maximisation {
        graph,
        steps: growth.steps,
        reaches,
        enter,
        bounds: Bounds::EMPTY,
        direction: F::Point::ZERO,
        heap: BinaryHeap::new(),
        looked: 0,
    };
    let mut evaluator = Evaluator::default();
    let mut drawn = Successor::default();
    let mut work = 0;
    for &direction in F::Point::AXES {
        search.direction = direction;
        search.heap.clear();
        let whole = TraversalState::whole(growth.seed);
        for instance in &graph.initiator(growth.steps).instances {
            search.add(whole.root(graph, instance), instance.object, 0, 0);
        }
        while let Some(Keyed { key, item: node }) = search.heap.pop() {
            if key <= search.found() {
                break;
            }
            work += 1;
            let is_much = work > MAX_WORK || search.looked > MAX_LOOKED;
            if is_much || is_cancelled(growth.cancel) {
                return None;
            }
            let moment = ReplacementContext {
                born: node.born,
                level: node.level,
                rank: 0,
            };
            let successor =
                evaluator.successor(graph, &node.state, node.object, moment, &mut drawn);
            search.replace(&node, successor.ok()?);
        }
    }
    Some(search.bounds)
}

impl<F: Frame, E: Fn(&Subtree<F>) -> Enter> Maximisation<'_, F, E> {
    /// Returns the extent, in the direction of the search, of the box found so far.
    fn found(&self) -> f64 {
        if self.bounds.is_empty() {
            return f64::NEG_INFINITY;
        }
        let [min, max] = [self.bounds.min(), self.bounds.max()];
        min.dot(self.direction).max(max.dot(self.direction))
    }

    fn replace(&mut self, node: &Node<F>, successor: &Successor<F>) {
        let level = node.level + 1;
        for instance in &successor.body.instances {
            let state = node.state.child(self.graph, instance);
            self.add(state, instance.object, node.born, level);
        }
        for seed in &successor.seeds {
            let start = seed_placement(self.graph, &node.state, seed.placement);
            for instance in &seed.chain.instances {
                let state = start.child(self.graph, instance);
                self.add(state, instance.object, level, level);
            }
        }
    }

    /// Adds an element: extends the box by its outline, or queues it if its subtree may extend the box.
    fn add(&mut self, state: TraversalState<F>, object: usize, born: u32, level: u32) {
        // The slack covers rounding in the bound, which could exclude an element that decides the box.
        const SLACK: f64 = 1.0 + 1e-9;
        self.looked += 1;
        let subtree = Subtree {
            frame: state.frame,
            object,
            born: level,
        };
        let own = &self.graph.objects()[object];
        let ends = !self.graph.is_fertile(object) || level == self.steps;
        let enter = if ends {
            Enter::Keep
        } else {
            (self.enter)(&subtree)
        };
        let length = state.frame.stretch();
        match enter {
            Enter::Keep if own.visible => {
                let base_element = &self.graph.base_elements()[own.base_element];
                let pad = self.reaches.pads[object] * length;
                base_element.add_to(&mut self.bounds, &state.frame, pad);
            }
            Enter::Keep | Enter::Skip => {}
            Enter::Replace | Enter::Divide => {
                let middle = state.frame.apply(self.graph.middle());
                let farthest =
                    middle.dot(self.direction) + self.reaches.all[object] * length * SLACK;
                if farthest > self.found() {
                    let item = Node {
                        state,
                        object,
                        born,
                        level,
                    };
                    let key = farthest;
                    self.heap.push(Keyed { key, item });
                }
            }
        }
    }
}
