//! Edges of a graph: the objects that may take an object's place, and what follows from them alone.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::digraph::Ancestry;
use crate::expression::Interval;
use crate::fast_hash::{FastMap, FastSet};
use crate::geometry::{Frame, Point};
use crate::rule::Placement;

use super::{Graph, Instance, Object, Replacement};

/// Object in the place of another one, or seeded by it.
pub(crate) struct Edge {
    pub(crate) object: usize,
    /// Largest distance of its middle from the middle of the parent's frame, as a multiple of the
    /// parent's length.
    pub(crate) away: f64,
    /// Largest length, as a multiple of the parent's.
    pub(crate) length: f64,
}

/// Edges of the objects of a graph. Objects that are replaced by one and the same successor share a list.
pub(crate) struct Edges {
    lists: Vec<Vec<Edge>>,
    /// Number of the list of each object.
    of: Vec<usize>,
}

impl Edges {
    /// Returns the edges of an object.
    pub(crate) fn of(&self, object: usize) -> &[Edge] {
        &self.lists[self.of[object]]
    }

    /// Iterates over all edges, those of a shared list once.
    pub(crate) fn distinct(&self) -> impl Iterator<Item = &Edge> {
        self.lists.iter().flatten()
    }

    /// Returns a function of the list of an object, which `known` holds as far as it was computed before.
    pub(crate) fn shared<T: Copy>(
        &self,
        object: usize,
        known: &mut [Option<T>],
        function: impl FnOnce(&[Edge]) -> T,
    ) -> T {
        let list = self.of[object];
        *known[list].get_or_insert_with(|| function(&self.lists[list]))
    }

    /// Returns the number of lists.
    pub(crate) fn lists(&self) -> usize {
        self.lists.len()
    }
}

impl<F: Frame> Graph<F> {
    /// Returns, for every object, the objects that may take its place or that it may seed, including all
    /// random alternatives, with upper bounds of their lengths as multiples of its length.
    pub(crate) fn ratios(&self) -> Vec<Vec<(usize, f64)>> {
        let edges = self.edges(f64::INFINITY);
        let of = |object| {
            let edges = edges.of(object).iter();
            edges.map(|edge| (edge.object, edge.length)).collect()
        };
        (0..self.objects.len()).map(of).collect()
    }

    /// Returns the edges to the possible children of every object: with upper bounds of distance and
    /// length or, for a finite power, with upper bounds of their power means (see `Generator::means`).
    pub(crate) fn edges(&self, power: f64) -> Edges {
        let mut extents = BTreeMap::new();
        let edges = |object: usize| {
            let Replacement::Evaluated(alternatives) = &self.objects[object].replacement else {
                let edge = |(_, instance): (_, &Instance<F>)| Edge {
                    object: instance.object,
                    away: (instance.frame.apply(self.middle) - self.middle).length(),
                    length: instance.length,
                };
                return self.children(object).map(edge).collect();
            };
            let mut edges = Vec::new();
            for alternative in alternatives.iter() {
                let generator = alternative.generator;
                let extents = extents.entry(generator).or_insert_with(|| {
                    let source = self.source();
                    source.extents(generator, power, &self.moments(), self.middle)
                });
                let drawn = alternative.objects.iter().zip(extents);
                edges.extend(drawn.map(|(&object, extent)| Edge {
                    object,
                    away: extent.away,
                    length: extent.length,
                }));
            }
            edges
        };
        let (of, firsts) = self.replacements();
        let lists = firsts.into_iter().map(edges).collect();
        Edges { lists, of }
    }

    /// Returns the number of the replacement of each object, and the first object of each replacement: objects that are
    /// replaced by one and the same successor have one.
    pub(crate) fn replacements(&self) -> (Vec<usize>, Vec<usize>) {
        let (mut known, mut firsts) = (FastMap::default(), Vec::new());
        let of = self.objects.iter().enumerate().map(|(number, object)| {
            // Successors are shared by reference. Objects without children have keys that are no addresses.
            let key = match &object.replacement {
                Replacement::Fixed(successor) => Arc::as_ptr(successor).addr(),
                Replacement::Evaluated(alternatives) => Arc::as_ptr(alternatives).addr(),
                Replacement::Kept => 0,
                Replacement::Unresolved => 1,
            };
            *known.entry(key).or_insert_with(|| {
                firsts.push(number);
                firsts.len() - 1
            })
        });
        (of.collect(), firsts)
    }

    /// Returns the ranges of all values that expressions see of an element.
    fn moments(&self) -> [Interval; 4] {
        let time = Interval::new(0.0, self.depth.map_or(f64::INFINITY, f64::from));
        let index = Interval::new(1.0, f64::INFINITY);
        let length = Interval::new(0.0, f64::INFINITY);
        [index, time, time, length]
    }

    /// Returns, for every object, whether it leads to seeds that are placed as the initiator. The subtree
    /// of such an object does not shrink with the object.
    #[must_use]
    pub fn resets(&self) -> Vec<bool> {
        self.leading_to_replacements(|object| {
            let mut placements = self.placements(object);
            placements.any(|placement| placement == Placement::SeedsAsInitiator)
        })
    }

    /// Returns, for every object, whether it leads to seeds.
    pub(crate) fn leads_to_seeds(&self) -> Vec<bool> {
        self.leading_to_replacements(|object| {
            self.objects[object].is_unresolved() || self.placements(object).any(Placement::seeds)
        })
    }

    /// Returns, for every object, whether it is replaced in a way or may lead to an object that is. `is_so` is asked of one
    /// object of each replacement.
    fn leading_to_replacements(&self, is_so: impl Fn(usize) -> bool) -> Vec<bool> {
        let (of, firsts) = self.replacements();
        let are_so: Vec<bool> = firsts.into_iter().map(is_so).collect();
        self.leading_to(|object| are_so[of[object]])
    }

    /// Iterates over the placements of the seeds, and of the parts of random successors, of an object.
    fn placements(&self, object: usize) -> impl Iterator<Item = Placement> {
        let object = &self.objects[object];
        let seeds = object.successor().into_iter().flat_map(|it| &it.seeds);
        let parts = object.alternatives().iter().flat_map(|it| self.parts(it));
        let parts = parts.map(|part| part.placement);
        seeds.map(|seed| seed.placement).chain(parts)
    }

    /// Returns, for every object, whether it is of a kind or may lead to an object of the kind.
    pub(crate) fn leading_to(&self, kind: impl Fn(usize) -> bool) -> Vec<bool> {
        let set: Vec<bool> = (0..self.objects.len()).map(kind).collect();
        if !set.contains(&true) {
            return set;
        }
        let (of, firsts) = self.replacements();
        let lists = firsts.into_iter().map(|object| self.successors(object));
        Ancestry::of(of, lists).leading_to(set)
    }

    /// Returns, for every object, whether its subtree is certain to draw something: for approximants, at
    /// every later level; for the limit, infinitely often. The latter are objects that lead to a visible
    /// kept object, or to visible objects for ever.
    pub(crate) fn alive(&self, limit: bool) -> Vec<bool> {
        let ends = |object: usize| {
            let object = &self.objects[object];
            object.is_kept() || object.is_unresolved()
        };
        let (of, firsts) = self.replacements();
        let children = |object| self.children(object).map(|(_, instance)| instance.object);
        let ancestry = Ancestry::of(of, firsts.into_iter().map(children));
        let visible = self.objects.iter().map(|object| object.visible).collect();
        let lasting = ancestry.lasting(visible, ends);
        match limit {
            true => ancestry.leading_to(lasting),
            false => lasting,
        }
    }

    /// Iterates over the fixed instances that take an object's place or that it seeds.
    pub(crate) fn children(
        &self,
        object: usize,
    ) -> impl Iterator<Item = (Placement, &Instance<F>)> {
        let successor = self.objects[object].successor().into_iter();
        successor.flat_map(|successor| successor.placed_instances())
    }

    /// Iterates over all instances of fixed successors, those of a shared one once, with their placements.
    pub(crate) fn instances(&self) -> impl Iterator<Item = (Placement, &Instance<F>)> {
        let mut known = FastSet::default();
        let successors = self.objects.iter().filter_map(Object::successor);
        let distinct = successors.filter(move |it| known.insert(Arc::as_ptr(it).addr()));
        distinct.flat_map(|successor| successor.placed_instances())
    }

    /// Returns the largest ratio of a fertile instance.
    pub(crate) fn longest_ratio(&self) -> f64 {
        let fertile = self
            .instances()
            .filter(|(_, instance)| self.is_fertile(instance.object));
        fertile
            .map(|(_, instance)| instance.length)
            .fold(0.0, f64::max)
    }

    /// Iterates over the objects that may take an object's place or that it may seed.
    fn successors(&self, object: usize) -> impl Iterator<Item = usize> {
        let drawn = self.objects[object].alternatives().iter();
        let fixed = self.children(object).map(|(_, instance)| instance.object);
        fixed.chain(drawn.flat_map(|alternative| alternative.objects.iter().copied()))
    }

    /// Returns the largest ratio of edges to objects that may be fertile.
    pub(crate) fn longest_edge(&self, edges: &Edges) -> f64 {
        let fertile = edges.distinct().filter(|edge| self.is_fertile(edge.object));
        fertile.map(|edge| edge.length).fold(0.0, f64::max)
    }

    /// Returns the common length of all fertile elements of the initiator, and the common ratio of all
    /// fertile instances, provided that each exists, that the graph is plain and that growth begins in
    /// step 0: reaching a given length then takes a fixed number of steps.
    #[must_use]
    pub fn even_lengths(&self) -> Option<[f64; 2]> {
        if !self.is_plain() || !self.is_similar() || self.is_time_indexed() {
            return None;
        }
        if !self.roots.elements.is_empty() || self.resets().contains(&true) {
            return None;
        }
        let fertile = |instance: &&Instance<F>| self.is_fertile(instance.object);
        let start = self.initiator(0).instances.iter().filter(fertile);
        let later = self.instances().map(|(_, instance)| instance);
        let start = one_length(start)?;
        Some([start * self.unit, one_length(later.filter(fertile))?])
    }
}

/// Returns the common length of all instances, if there is one.
fn one_length<'g, F: Frame>(mut instances: impl Iterator<Item = &'g Instance<F>>) -> Option<f64> {
    // Rounding makes equal sides slightly unequal.
    const ROUNDING: f64 = 1e-12;
    let length = instances.next()?.length;
    let same = |instance: &Instance<F>| (instance.length - length).abs() <= ROUNDING * length;
    instances.all(same).then_some(length)
}

#[cfg(test)]
mod tests;
