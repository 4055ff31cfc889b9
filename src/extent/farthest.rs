//! Bounding box of a limit set by branch and bound, for frames whose subtrees are bounded by balls alone.

mod crowd;

use std::cell::Cell;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::fast_hash::FastMap;
use crate::geometry::{Bounds, Frame, Outline, Point};
use crate::graph::{Graph, Instance, Object, Replacement};
use crate::work;

use self::crowd::{Crowds, Part};
use super::Bounded;
use super::bounds::ends;

/// Limit of the number of instances that are replaced, for a direction.
const MAX_WORK: usize = 1 << 17;

/// Limit of the number of instances that are looked at, for a direction.
const MAX_LOOKED: usize = 1 << 22;

/// [Work](work) of an instance that is looked at.
const LOOK: usize = 4;

/// Limit of the number of instances that are kept, for a direction.
const MAX_KEPT: usize = 1 << 19;

/// Limit of the number of instances in each other that are searched for a first value.
const MAX_DEPTH: usize = 1 << 10;

/// Relative difference that is rounding.
const ROUNDING: f64 = 1e-16;

/// Relative error of the box.
const TOLERANCE: f64 = 1e-13;

/// An instance, by the part of a linear functional that it contributes.
struct Node<F: Frame> {
    object: usize,
    /// The functional in the coordinates of the object.
    vector: F::Point,
    offset: f64,
    /// Upper bound of the functional.
    farthest: f64,
}

impl<F: Frame> PartialEq for Node<F> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<F: Frame> Eq for Node<F> {}

impl<F: Frame> PartialOrd for Node<F> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<F: Frame> Ord for Node<F> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.farthest.total_cmp(&other.farthest)
    }
}

/// Balls that contain the subtrees of objects, in the limit.
pub(super) struct Balls<F: Frame> {
    /// Objects whose subtrees are drawn in the limit.
    alive: Vec<bool>,
    /// Radii about the middle of the unit frame, by object.
    reaches: Vec<f64>,
    crowds: Crowds<F>,
    /// Number of instances that were looked at.
    pub(super) looked: Cell<usize>,
}

impl<F: Bounded> Balls<F> {
    pub(super) fn of(graph: &Graph<F>) -> Self {
        let radius = graph.outline_radii();
        let own = |object: &Object<F>| match object.replacement {
            Replacement::Fixed(_) => 0.0,
            _ => radius(object),
        };
        let alive = graph.alive(true);
        Self {
            crowds: Crowds::of(graph, &alive),
            alive,
            reaches: graph.reaches(own),
            looked: Cell::new(0),
        }
    }
}

impl<F: Bounded> Graph<F> {
    /// Returns the bounding box of the limit set that begins with some instances, to within 1e-13 of its distance and
    /// extent. An instance is replaced only while its ball may reach farther than all points that are known (Land & Doig
    /// 1960), and of several that differ by a translation, only the farthest. `None` if a subtree is not bounded, or if that
    /// takes too long.
    pub(super) fn limit_bounds_by(
        &self,
        balls: &Balls<F>,
        start: &[Instance<F>],
    ) -> Option<Bounds<F::Point>> {
        let [max, min] = ends(|axis| self.farthest(axis, start, balls))?;
        let bounds = Bounds::new(min, max);
        bounds.is_finite().then_some(bounds)
    }

    /// Returns a value of a linear functional that the limit set reaches: that of the farthest instance, of the farthest in it,
    /// and so on. Few instances reach farther than that. `size` is that of the set, about.
    fn reached(&self, axis: F::Point, start: &[Instance<F>], size: f64, balls: &Balls<F>) -> f64 {
        let mut instances: Vec<&Instance<F>> = start.iter().collect();
        let (mut outer, mut offset) = (axis, 0.0);
        let mut surely = f64::NEG_INFINITY;
        for _ in 0..MAX_DEPTH {
            let mut best: Option<Node<F>> = None;
            let is_replaced = |object: usize| {
                let replacement = &self.objects()[object].replacement;
                balls.alive[object] && matches!(replacement, Replacement::Fixed(_))
            };
            for instance in instances.iter().filter(|it| is_replaced(it.object)) {
                let object = instance.object;
                let vector = instance.frame.pullback(outer);
                let offset = offset + outer.dot(instance.frame.origin());
                let radius = vector.length() * balls.reaches[object];
                let middle = offset + vector.dot(self.middle());
                let farthest = middle + radius;
                if radius.is_finite() && best.as_ref().is_none_or(|it| farthest > it.farthest) {
                    surely = surely.max(middle - radius);
                    best = Some(Node {
                        object,
                        vector,
                        offset,
                        farthest,
                    });
                }
            }
            // Nothing in it is farther, but for rounding.
            let is_close =
                |node: &Node<F>| node.farthest <= surely + ROUNDING * (size + surely.abs());
            let Some(node) = best.filter(|node| !is_close(node)) else {
                break;
            };
            let Replacement::Fixed(successor) = &self.objects()[node.object].replacement else {
                break;
            };
            instances = balls.crowds.replaced(node.object, successor);
            (outer, offset) = (node.vector, node.offset);
        }
        surely
    }

    /// Returns the greatest value of a linear functional on the limit set.
    fn farthest(&self, axis: F::Point, start: &[Instance<F>], balls: &Balls<F>) -> Option<f64> {
        let mut heap: BinaryHeap<Node<F>> = BinaryHeap::new();
        // The greatest value that is certain to be reached.
        let mut surely = f64::NEG_INFINITY;
        // The greatest offset of each behaviour and functional: many tie where the set touches a plane along a part.
        let mut known: FastMap<(usize, [u64; 3]), f64> = FastMap::default();
        let mut add = |heap: &mut BinaryHeap<Node<F>>,
                       surely: &mut f64,
                       instance: &Instance<F>,
                       outer: F::Point,
                       offset: f64| {
            if !balls.alive[instance.object] {
                return Some(());
            }
            let vector = instance.frame.pullback(outer);
            let offset = offset + outer.dot(instance.frame.origin());
            if !matches!(
                self.objects()[instance.object].replacement,
                Replacement::Fixed(_)
            ) {
                if let Some(outline) = self.drawn(instance.object) {
                    *surely = surely.max(offset + outline.support(vector));
                }
                return Some(());
            }
            let radius = vector.length() * balls.reaches[instance.object];
            let middle = offset + vector.dot(self.middle());
            if !radius.is_finite() {
                return None;
            }
            *surely = surely.max(middle - radius);
            if middle + radius <= *surely {
                return Some(());
            }
            let behaviour = self.objects()[instance.object].behaviour;
            // Negative zero is zero.
            let key = vector.coordinates().map(|it| (it + 0.0).to_bits());
            let best = known.entry((behaviour, key)).or_insert(f64::NEG_INFINITY);
            if offset <= *best {
                return Some(());
            }
            *best = offset;
            heap.push(Node {
                object: instance.object,
                vector,
                offset,
                farthest: middle + radius,
            });
            Some(())
        };
        for instance in start {
            add(&mut heap, &mut surely, instance, axis, 0.0)?;
        }
        let (mut work, mut looked) = (0, 0);
        let size = heap.peek().map_or(0.0, |node| node.farthest - surely);
        surely = surely.max(self.reached(axis, start, size, balls));
        while let Some(node) = heap.pop() {
            let tolerance = TOLERANCE * (size + surely.abs());
            if node.farthest <= surely + tolerance {
                return Some(f64::midpoint(node.farthest.max(surely), surely));
            }
            let Replacement::Fixed(successor) = &self.objects()[node.object].replacement else {
                continue;
            };
            work += 1;
            if work > MAX_WORK || looked > MAX_LOOKED || heap.len() > MAX_KEPT {
                return None;
            }
            let mut look = |count: usize, work: usize| {
                looked += count;
                balls.looked.set(balls.looked.get() + count);
                work::count(work);
            };
            let Some(parts) = balls.crowds.in_place_of(node.object) else {
                for (_, instance) in successor.placed_instances() {
                    look(1, LOOK);
                    add(&mut heap, &mut surely, instance, node.vector, node.offset)?;
                }
                continue;
            };
            for part in parts {
                match part {
                    Part::Replaced(number) => {
                        look(1, LOOK);
                        let instance = &successor.body.instances[*number];
                        add(&mut heap, &mut surely, instance, node.vector, node.offset)?;
                    }
                    Part::Crowd(crowd) => {
                        look(crowd.len(), crowd.len());
                        let outlines = self.base_elements();
                        surely = crowd.farthest(outlines, node.vector, node.offset, surely);
                    }
                }
            }
        }
        surely.is_finite().then_some(surely)
    }
}
