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

/// Limits of a search, beyond which it is abandoned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    /// Number of replacements.
    replaced: usize,
    /// Number of elements that are looked at, and of points of outlines that may extend the box.
    looked: usize,
    /// Number of elements that are held to be replaced, up to those that replace one element.
    queued: usize,
}

impl Limits {
    /// Limits for a picture that is drawn.
    pub(crate) const DRAWING: Self = Self {
        replaced: 1 << 18,
        looked: 1 << 23,
        queued: 1 << 19,
    };

    /// Limits for an estimate of a size.
    pub(crate) const ESTIMATE: Self = Self {
        replaced: 1 << 15,
        looked: 1 << 19,
        queued: 1 << 15,
    };

    /// Returns the limits of a search instead of which a walk over so many elements may be made.
    pub(crate) fn instead_of(elements: u64) -> Self {
        /// Number of elements that are looked at for each that is held.
        const TURNOVER: usize = 16;
        let elements = usize::try_from(elements).unwrap_or(usize::MAX);
        let looked = elements.min(Self::DRAWING.looked);
        Self {
            looked,
            queued: looked / TURNOVER,
            ..Self::DRAWING
        }
    }
}

/// Radii of subtrees and padding, by object.
pub(crate) struct Reaches<'a> {
    /// Radius of the disc that contains the subtree of an object, about the middle of its unit frame: see
    /// [`Graph::reaches`].
    pub(crate) all: &'a [f64],
    /// Padding around the outline of an object, as a multiple of its length.
    pub(crate) pads: &'a [f64],
}

/// Element to be replaced.
#[derive(Clone, Copy)]
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
    /// Number of elements and points that have been looked at.
    looked: usize,
    evaluator: Evaluator<F>,
    /// Memory of successors that are drawn.
    drawn: Successor<F>,
}

/// Computes the bounding box that a walk with `enter` as its visitor's decision would find, bit by bit.
///
/// `None` if the walk counts indices, if a subtree is not bounded, if a generator yields points that are not
/// finite, if the search exceeds the limits, or if it is cancelled. The box is empty if nothing is drawn.
pub(crate) fn search<F: Frame>(
    graph: &Graph<F>,
    growth: &Growth<'_>,
    reaches: &Reaches<'_>,
    limits: Limits,
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
        evaluator: Evaluator::default(),
        drawn: Successor::default(),
    };
    let mut work = 0;
    for &direction in F::Point::AXES {
        search.direction = direction;
        search.heap.clear();
        let whole = TraversalState::whole(growth.seed);
        for instance in &graph.initiator(growth.steps).instances {
            let placed = search.look(whole.root(graph, instance), instance.object, 0, 0);
            search.heap.extend(placed);
        }
        while let Some(Keyed { key, item: node }) = search.heap.pop() {
            if key <= search.found() {
                break;
            }
            work += 1;
            let is_much = work > limits.replaced || search.looked > limits.looked;
            if is_much || is_cancelled(growth.cancel) {
                return None;
            }
            let mut heap = std::mem::take(&mut search.heap);
            let replaced = search.replace(&node, |child| heap.push(child));
            search.heap = heap;
            replaced?;
            if search.heap.len() > limits.queued {
                search.thin(limits, growth)?;
                if search.heap.len() > limits.queued / 2 {
                    return None;
                }
            }
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

    /// Replaces an element: extends the box by the elements that stay, and yields those that may have to be replaced.
    /// `None` if a generator yields points that are not finite.
    fn replace(&mut self, node: &Node<F>, mut queue: impl FnMut(Keyed<Node<F>>)) -> Option<()> {
        let moment = ReplacementContext {
            born: node.born,
            level: node.level,
            rank: 0,
        };
        let mut drawn = std::mem::take(&mut self.drawn);
        let graph = self.graph;
        let evaluator = &mut self.evaluator;
        let successor = evaluator.successor(graph, &node.state, node.object, moment, &mut drawn);
        let successor = successor.ok()?;
        let level = node.level + 1;
        for instance in &successor.body.instances {
            let state = node.state.child(graph, instance);
            let child = self.look(state, instance.object, node.born, level);
            child.into_iter().for_each(&mut queue);
        }
        for seed in &successor.seeds {
            let start = seed_placement(graph, &node.state, seed.placement);
            for instance in &seed.chain.instances {
                let state = start.child(graph, instance);
                let child = self.look(state, instance.object, level, level);
                child.into_iter().for_each(&mut queue);
            }
        }
        self.drawn = drawn;
        Some(())
    }

    /// Removes elements from the queue whose subtrees cannot extend the box, which is extended before by the elements to
    /// which the most promising ones lead. `None` if a generator yields points that are not finite, if the search exceeds the
    /// limits, or if it is cancelled.
    fn thin(&mut self, limits: Limits, growth: &Growth<'_>) -> Option<()> {
        let mut next = self.heap.peek().map(|first| first.item);
        while let Some(node) = next {
            if self.looked > limits.looked || is_cancelled(growth.cancel) {
                return None;
            }
            let mut farthest: Option<Keyed<Node<F>>> = None;
            self.replace(&node, |child| {
                if farthest.as_ref().is_none_or(|known| known.key < child.key) {
                    farthest = Some(child);
                }
            })?;
            next = farthest.map(|child| child.item);
        }
        let found = self.found();
        self.heap.retain(|queued| queued.key > found);
        Some(())
    }

    /// Looks at an element: extends the box by its outline, or returns it if its subtree may extend the box.
    fn look(
        &mut self,
        state: TraversalState<F>,
        object: usize,
        born: u32,
        level: u32,
    ) -> Option<Keyed<Node<F>>> {
        // The slack covers rounding in the bounds, which could exclude an element that decides the box: that of lengths, and
        // that of coordinates.
        const SLACK: f64 = 1.0 + 1e-9;
        const ROUNDING: f64 = 16.0 * f64::EPSILON;
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
        let middle = state.frame.apply(self.graph.middle());
        let key = middle.dot(self.direction)
            + self.reaches.all[object] * length * SLACK
            + middle.length() * ROUNDING;
        match enter {
            // Outlines inside the box found so far do not extend it in the direction of the search.
            Enter::Keep if own.visible && key <= self.found() => None,
            Enter::Keep if own.visible => {
                let base_element = &self.graph.base_elements()[own.base_element];
                self.looked += base_element.complexity();
                let pad = self.reaches.pads[object] * length;
                base_element.add_to(&mut self.bounds, &state.frame, pad);
                None
            }
            Enter::Keep | Enter::Skip => None,
            Enter::Replace | Enter::Divide => (key > self.found()).then_some(Keyed {
                key,
                item: Node {
                    state,
                    object,
                    born,
                    level,
                },
            }),
        }
    }
}
