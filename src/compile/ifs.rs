//! Compilation of an iterated function system to its graph.

use std::sync::Arc;

use crate::geometry::{Bounds, Outline, Point};
use crate::ifs::{AffineMap, Ifs, OutlineOf, System, Verdict};

use super::instancing::instance;
use crate::extent::{Bounded, Fineness, NoLimit, Own};
use crate::graph::{Chain, Graph, Object, Replacement, Successor};
use crate::instancing::Tint;

/// Limit of the number of instances in a graph whose objects record the last map.
const MAX_INSTANCES: usize = 4_000_000;

/// Number of the base element of the initial set; it is provisional until the limit set is known.
const INITIAL: usize = 0;

impl<F: Bounded> Graph<F> {
    /// Compiles a system to its graph, whose unit frame is the plane or space itself.
    ///
    /// The graph has an object for the whole, drawn as the initial set, and one for the set inside every
    /// map. In a recurrent system, the set inside f_j consists of the images f_i of the sets inside f_i,
    /// over the edges from i to j, because f_j is applied after f_i. Approximant 0 is therefore the
    /// initial set I, approximant 1 the union of all f_j(I), approximant 2 that of all f_j(f_i(I)), and
    /// so on. Condensation sets are infertile. If there are condensation sets and no initial set is
    /// given, the former are drawn from step 0 on, and the other objects are invisible. If the initial
    /// set has several outlines, all but the first are objects that vanish when the first is replaced.
    ///
    /// A duplicate map, with the same maps before it, yields the same images and is omitted.
    #[must_use]
    pub fn of_system<M: AffineMap<Frame = F>>(system: &System<M>) -> Self {
        Self::compile_system(system, false)
    }

    /// Compiles a system to a graph whose objects record the map that is applied last, which takes more
    /// objects. `None` if the graph would have too many instances.
    #[must_use]
    pub fn with_last_maps<M: AffineMap<Frame = F>>(system: &System<M>) -> Option<Self> {
        let size = system
            .ifs()
            .size()
            .saturating_mul(system.ifs().maps().len());
        (size <= MAX_INSTANCES).then(|| Self::compile_system(system, true))
    }

    fn compile_system<M: AffineMap<Frame = F>>(system: &System<M>, by_last_map: bool) -> Self {
        let ifs = system.ifs();
        let (mut graph, limit) = Self::provisional(system, by_last_map);
        let initial = ifs.initial().map(|set| M::outlines(set).swap_remove(0));
        let initial = initial.unwrap_or_else(|| M::filling(limit));
        let mut whole = limit.unwrap_or(Bounds::EMPTY);
        if limit.is_none() {
            initial.add_to(&mut whole, &F::UNIT, 0.0);
        }
        Arc::make_mut(&mut graph.base_elements)[INITIAL] = initial;
        graph.set_extent(&whole);
        graph
    }

    /// Returns the bounding box of a system's limit set, under the conditions of [`Graph::limit_bounds`].
    pub(crate) fn limit_bounds_of<M: AffineMap<Frame = F>>(
        system: &System<M>,
    ) -> Option<Bounds<F::Point>> {
        let (_, limit) = Self::provisional(system, false);
        limit
    }

    /// Returns a graph without its unit of length and without its initial set, which follow from the limit set; and the box
    /// of that.
    fn provisional<M: AffineMap<Frame = F>>(
        system: &System<M>,
        by_last_map: bool,
    ) -> (Self, Option<Bounds<F::Point>>) {
        let mut graph = Compiler::new(system, by_last_map).run();
        let diverges = system.contraction().verdict == Verdict::Diverges;
        graph.no_limit = diverges.then_some(NoLimit::OnAverage);
        graph.middle = middle(&graph);
        let limit = graph.limit_bounds();
        graph.limit_bounds = Some(limit);
        (graph, limit)
    }
}

/// Returns the approximate centre of the limit of a graph.
fn middle<F: Bounded>(graph: &Graph<F>) -> F::Point {
    let mut bounds = Bounds::EMPTY;
    let drawn = graph.alive(true);
    let own = Own::Outlines(&vec![0.0; drawn.len()]);
    if let Some(hulls) = F::hulls(graph, &own, Some(&drawn), Fineness::ROUGH) {
        for corner in hulls.corners(0) {
            bounds.add(*corner);
        }
    }
    Some(bounds.centre())
        .filter(|centre| centre.is_finite())
        .unwrap_or_default()
}

struct Compiler<'s, M: AffineMap> {
    ifs: &'s Ifs<M>,
    /// Outlines of the condensation sets.
    sets: Vec<OutlineOf<M>>,
    /// Outlines of a given initial set, without the first.
    others: Vec<OutlineOf<M>>,
    chained: bool,
    /// Whether there are separate objects for every map that may be applied last.
    by_last_map: bool,
    /// Maps that may be applied before each map, without duplicates.
    before: Vec<Vec<usize>>,
    /// Maps without duplicates.
    maps: Vec<usize>,
}

impl<'s, M: AffineMap> Compiler<'s, M> {
    fn new(system: &'s System<M>, by_last_map: bool) -> Self {
        let ifs = system.ifs();
        let count = ifs.maps().len();
        let mut before = vec![Vec::new(); count];
        match ifs.edges() {
            Some(edges) => edges.for_each(|(edge, _)| before[edge.to].push(edge.from)),
            None => before = vec![(0..count).collect(); count],
        }
        before.iter_mut().for_each(|maps| maps.sort_unstable());
        let maps = ifs.maps();
        let is_same = |a: usize, b: usize| {
            maps[a].affine == maps[b].affine
                && maps[a].tint == maps[b].tint
                && before[a] == before[b]
        };
        let first = |map: usize| (0..map).find(|&other| is_same(other, map)).unwrap_or(map);
        let firsts: Vec<usize> = (0..count).map(first).collect();
        for maps in &mut before {
            maps.iter_mut().for_each(|map| *map = firsts[*map]);
            maps.sort_unstable();
            maps.dedup();
        }
        let sets = ifs.condensation().iter();
        Self {
            ifs,
            sets: sets.flat_map(|set| M::outlines(&set.shape)).collect(),
            others: ifs.initial().map_or_else(Vec::new, |initial| {
                let mut outlines = M::outlines(initial);
                outlines.remove(0);
                outlines
            }),
            chained: system.chained,
            by_last_map,
            before,
            maps: (0..count).filter(|&map| firsts[map] == map).collect(),
        }
    }

    /// Returns the number of branches, each with its own objects.
    fn branches(&self) -> usize {
        if self.by_last_map {
            self.ifs.maps().len()
        } else {
            1
        }
    }

    /// Returns the number of outlines inside every map: those of the condensation sets, then the others
    /// of the initial set.
    fn outlines(&self) -> usize {
        self.sets.len() + self.others.len()
    }

    /// Returns the number of objects of a branch: one inside every map, and the outlines inside every
    /// map.
    fn branch(&self) -> usize {
        self.ifs.maps().len() * (1 + self.outlines())
    }

    /// Returns the object inside a map of a branch; object 0 is the whole.
    fn inside(&self, branch: usize, map: usize) -> usize {
        1 + branch * self.branch() + map
    }

    /// Returns the object of an outline inside a map of a branch, or outside all maps.
    fn drawn(&self, place: Option<(usize, usize)>, outline: usize) -> usize {
        let (maps, outlines) = (self.ifs.maps().len(), self.outlines());
        match place {
            Some((branch, map)) => self.inside(branch, maps + map * outlines + outline),
            None => self.inside(self.branches(), outline),
        }
    }

    fn run(mut self) -> Graph<M::Frame> {
        let maps = self.ifs.maps().len();
        let whole = Arc::new(self.successor(None, &self.maps));
        let is_alike = self.ifs.is_alike();
        // The whole is replaced by the same objects, too.
        let as_whole = (is_alike && !self.by_last_map).then(|| Arc::clone(&whole));
        let mut objects = vec![Object {
            replacement: Replacement::Fixed(whole),
            ..self.object(INITIAL, None, None)
        }];
        for branch in 0..self.branches() {
            let last_map = self.by_last_map.then_some(branch);
            let mut known = as_whole.clone();
            for map in 0..maps {
                let new = || Arc::new(self.successor(Some((branch, map)), &self.before[map]));
                let successor = match is_alike {
                    true => Arc::clone(known.get_or_insert_with(new)),
                    false => new(),
                };
                objects.push(Object {
                    replacement: Replacement::Fixed(successor),
                    ..self.object(INITIAL, Some(map), last_map)
                });
            }
            for map in 0..maps {
                objects.extend(self.drawn_objects(Some(map), last_map));
            }
        }
        objects.extend(self.drawn_objects(None, None));
        self.number_behaviours(&mut objects);
        let drawn = self.drawn_with_first();
        let drawn = drawn.map(|outline| instance(self.drawn(None, outline), &M::IDENTITY, 0));
        let root = instance(0, &M::IDENTITY, 0);
        let start = Chain::loose(std::iter::once(root).chain(drawn).collect());
        let mut outlines = vec![M::filling(None)];
        outlines.append(&mut self.sets);
        outlines.append(&mut self.others);
        Graph {
            origins: maps,
            affine: true,
            tints: objects.iter().any(|object| object.tint.is_some()),
            ..Graph::of(objects, outlines, vec![start])
        }
    }

    fn object(
        &self,
        base_element: usize,
        map: Option<usize>,
        last_map: Option<usize>,
    ) -> Object<M::Frame> {
        Object {
            visible: base_element != INITIAL
                || self.sets.is_empty()
                || self.ifs.initial().is_some(),
            origin: map,
            last_map,
            tint: map.and_then(|map| self.ifs.maps()[map].tint),
            ..Object::kept(base_element)
        }
    }

    /// Returns the outlines that are drawn together with the first one inside every map.
    fn drawn_with_first(&self) -> std::ops::Range<usize> {
        match self.ifs.initial() {
            Some(_) => self.sets.len()..self.outlines(),
            None => 0..self.sets.len(),
        }
    }

    fn drawn_objects(
        &self,
        map: Option<usize>,
        last_map: Option<usize>,
    ) -> impl Iterator<Item = Object<M::Frame>> + '_ {
        let vanishes = Arc::new(Successor::default());
        let with_first = self.drawn_with_first();
        // Others are in the objects inside the maps, which have the tints.
        let tint =
            move |outline, tint: Option<Tint>| tint.filter(|_| with_first.contains(&outline));
        (0..self.outlines()).map(move |outline| Object {
            replacement: if outline < self.sets.len() {
                Replacement::Kept
            } else {
                Replacement::Fixed(Arc::clone(&vanishes))
            },
            tint: tint(outline, self.object(1 + outline, map, last_map).tint),
            ..self.object(1 + outline, map, last_map)
        })
    }

    /// Numbers the behaviours: objects with equal replacements share one.
    fn number_behaviours(&self, objects: &mut [Object<M::Frame>]) {
        let maps = self.ifs.maps().len();
        let mut numbers: Vec<(usize, usize)> = Vec::new();
        for (number, object) in objects.iter_mut().enumerate() {
            // Without a digraph, the whole has the same replacement as the set inside a map.
            let key = match (&object.replacement, object.origin) {
                (Replacement::Kept, _) => usize::MAX,
                (Replacement::Fixed(gone), _) if gone.body.instances.is_empty() => usize::MAX - 1,
                (_, Some(map)) if self.ifs.is_recurrent() => map,
                _ => maps,
            };
            let known = numbers.iter().find(|(known, _)| *known == key);
            object.behaviour = match known {
                Some((_, behaviour)) => *behaviour,
                None => {
                    let next = numbers.len();
                    numbers.push((key, next));
                    next
                }
            };
            debug_assert!(number > 0 || object.behaviour == 0);
        }
    }

    /// Returns the successor of the whole or of the set inside a map of a branch: images under some
    /// maps, and the condensation sets.
    fn successor(&self, place: Option<(usize, usize)>, maps: &[usize]) -> Successor<M::Frame> {
        let mut instances = Vec::new();
        // The outermost map determines the branch.
        let branch = |map: usize| match place {
            Some((branch, _)) => branch,
            None if self.by_last_map => map,
            None => 0,
        };
        for (number, &map) in maps.iter().enumerate() {
            let affine = self.ifs.maps()[map].affine;
            let mut instance = instance(self.inside(branch(map), map), &affine, number);
            instance.joined = self.chained && number > 0;
            instances.push(instance);
        }
        let with_first = self.drawn_with_first();
        for set in (0..self.sets.len()).filter(|set| !with_first.contains(set)) {
            let object = self.drawn(place, set);
            instances.push(instance(object, &M::IDENTITY, instances.len()));
        }
        // Outlines that are drawn together with the first one are inside the maps already.
        for outline in with_first {
            for &map in maps {
                let object = self.drawn(Some((branch(map), map)), outline);
                let affine = self.ifs.maps()[map].affine;
                instances.push(instance(object, &affine, instances.len()));
            }
        }
        let meets_frame = [self.chained; 2];
        let body = Chain {
            meets_frame,
            ..Chain::loose(instances)
        };
        body.into()
    }
}
