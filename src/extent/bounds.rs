//! Bounding boxes of approximants and of the limit set, computed from the graph alone.
//!
//! The support function h(u) = max x·u is propagated down the graph for the four directions of the axes.
//! An instance with linear part L and translation t maps the direction to Lᵀu and adds t·u, so a state is
//! an object with a vector and an offset. Of states that are equal but for the offset only the farthest
//! is kept, and states that cannot exceed the best one are dropped; the number of states stays small
//! (where rotations are rational, directions are finitely many).

use std::cell::Cell;

use crate::fast_hash::FastMap;
use crate::geometry::{Bounds, Frame, Frame2, Outline, Point};
use crate::rule::Placement;

use super::bounded::{Bounded, Fineness, Hulls, Own};
use super::terms::{Merged, SupportTerm, child, falls_short};
use crate::graph::{Graph, Instance, Object, Successor};
use crate::work;

/// Limit of the number of states at one level.
const MAX_STATES: usize = 20_000;
/// Limit of the number of states at all levels together.
const MAX_WORK: usize = 1_000_000;

/// Limit of the work of a search: of states that are looked at, with what follows.
const MAX_LOOKED: usize = 8 * MAX_WORK;

/// Limit of that work where other bounds are tried afterwards.
const MAX_LOOKED_AT_FIRST: usize = 2 * MAX_WORK;

/// Work of comparing a state with others, beside looking at it.
const COMPARED: usize = 2;

/// Work of bounding a state closely, beside comparing it.
const BOUNDED: usize = 2;

/// Limit of the number of states at one level while others may still drop them.
const MAX_NEXT: usize = MAX_WORK / 4;

/// Limit of the number of levels.
const MAX_LEVELS: u32 = 20_000;

/// Relative size of terms that do not change a double.
const NEGLIGIBLE: f64 = 1e-17;

/// Relative size of terms that are neglected where polygons bound the subtrees: maps may be affine there,
/// and vectors of equal states differ by rounding, so fewer states merge.
const ROUNDING: f64 = 1e-15;

/// Bounds on the subtrees of objects, on which the search relies.
pub(super) struct Reach<F: Frame> {
    spread: f64,
    ratio: f64,
    /// Radii about the origins of objects that contain their subtrees, where ratios give no bound for all levels.
    radii: Option<Vec<f64>>,
    /// Polygons that contain the subtrees of objects, and their fineness, where ratios give no bound.
    hulls: Option<(Box<dyn Hulls<F>>, Fineness)>,
    /// Objects that are certain to draw something.
    alive: Vec<bool>,
    /// Object that stands for each: in the limit, the first of those that draw nothing themselves and have its behaviour.
    alike: Vec<usize>,
    /// Padding around every object, as a multiple of its length.
    pads: Vec<f64>,
    /// Share of its extent by which a box may be too large, if it is not one by polygons.
    share: f64,
    /// Whether a search may take long, because no other bounds follow.
    pub(super) is_patient: bool,
    /// Number of states that were looked at.
    pub(super) looked: Cell<usize>,
}

/// Bounding boxes of approximants, without stroke width: see [`Graph::bounds`].
pub struct ApproximantBounds<'g, F: Frame = Frame2> {
    graph: &'g Graph<F>,
    reach: Reach<F>,
}

impl<F: Frame> Reach<F> {
    /// Returns an upper bound of x·u over the points x that a state draws, and a lower bound that holds
    /// if it draws anything: of the least x·u, or in the limit with polygons, of the greatest.
    fn span(&self, state: &SupportTerm<F>, levels: Option<u32>) -> [f64; 2] {
        let Some((hulls, _)) = &self.hulls else {
            let size = state.vector.length() * self.radius(state.object, levels);
            return [state.offset + size, state.offset - size];
        };
        let [farthest, surely] = hulls.along(state.object, state.vector);
        let least = match levels {
            None => surely,
            Some(_) => -hulls.along(state.object, -state.vector)[0],
        };
        [state.offset + farthest, state.offset + least]
    }

    /// Returns an upper bound as [`span`](Self::span) does, but faster, and larger, where polygons bound the subtrees; infinite
    /// where `span` is as fast.
    fn at_most(&self, state: &SupportTerm<F>) -> f64 {
        self.hulls.as_ref().map_or(f64::INFINITY, |(hulls, _)| {
            state.offset + hulls.at_most(state.object, state.vector)
        })
    }

    /// Returns the contribution of a state to its offset in the limit, if polygons determine it to within
    /// `negligible`.
    fn rest(&self, state: &SupportTerm<F>, negligible: f64) -> Option<f64> {
        let (hulls, _) = self.hulls.as_ref()?;
        let [farthest, surely] = hulls.along(state.object, state.vector);
        (farthest - surely <= negligible).then(|| f64::midpoint(farthest, surely))
    }

    /// Returns the numbers of those instances in the place of a state's object that may reach farthest in the limit; `None` if
    /// they are not known.
    fn contenders(&self, state: &SupportTerm<F>, successor: &Successor<F>) -> Option<&[u32]> {
        let (hulls, _) = self.hulls.as_ref()?;
        let instances = &successor.body.instances;
        let has_seeds = !successor.seeds.is_empty();
        (!has_seeds).then(|| hulls.contenders(state.object, instances, state.vector))?
    }

    /// Returns a bound on the distance, along the vector of a state, of all that it draws from its
    /// origin.
    fn size(&self, state: &SupportTerm<F>, levels: Option<u32>) -> f64 {
        match &self.hulls {
            Some((hulls, _)) => {
                let along = [state.vector, -state.vector];
                let along = along.map(|vector| hulls.along(state.object, vector)[0]);
                along[0].max(along[1])
            }
            None => state.vector.length() * self.radius(state.object, levels),
        }
    }

    /// Returns the length by which the box of some instances may fall short, or else be too large.
    fn spared(&self, start: &[Instance<F>], steps: Option<u32>) -> f64 {
        match &self.hulls {
            Some((hulls, fineness)) if fineness.spared > 0.0 => hulls.spared(start, *fineness),
            None if self.share > 0.0 => {
                let radius = |it: &Instance<F>| it.length * self.radius(it.object, steps);
                self.share * start.iter().map(radius).fold(0.0, f64::max)
            }
            _ => 0.0,
        }
    }

    /// Returns the relative tolerance for dropping states: with polygons, lower bounds are so tight that
    /// rounding could drop all states that reach farthest.
    fn slack(&self) -> f64 {
        self.hulls.as_ref().map_or(0.0, |_| ROUNDING)
    }

    /// Returns the relative size of terms that are neglected.
    fn negligible(&self) -> f64 {
        self.hulls.as_ref().map_or(NEGLIGIBLE, |_| ROUNDING)
    }

    /// Returns the radius about the origin of an object's unit frame that contains all that it draws
    /// within a number of levels, or in all levels: its own if it is known, otherwise the sum of a geometric series.
    fn radius(&self, object: usize, levels: Option<u32>) -> f64 {
        if let Some(radii) = &self.radii {
            return radii[object];
        }
        if self.ratio < 1.0 {
            return self.spread / (1.0 - self.ratio);
        }
        let Some(levels) = levels else {
            return f64::INFINITY;
        };
        let longest = libm::pow(self.ratio, f64::from(levels));
        self.spread * (f64::from(levels) + 1.0) * longest
    }
}

impl<F: Bounded> Graph<F> {
    /// Returns the bounding box of approximant `steps` without stroke width, in the graph's coordinates.
    ///
    /// Exact to some 15 digits. `None` if nothing is drawn, if the graph does not determine the box
    /// (random and irregular rules, seeds placed as the initiator, too many directions), or if the graph
    /// was compiled for fewer steps.
    #[must_use]
    pub fn bounds(&self, steps: u32) -> Option<Bounds<F::Point>> {
        self.padded_bounds(steps, |_| 0.0)
    }

    /// Returns the bounding boxes of approximants, which share the computations that do not depend on the
    /// step. `None` if the graph determines none of them.
    #[must_use]
    pub fn boxes(&self) -> Option<ApproximantBounds<'_, F>> {
        self.boxes_with(|_| 0.0)
    }

    /// Returns the bounding box of approximant `steps` with padding around every object: `pad` returns it
    /// as a multiple of the object's length.
    pub(crate) fn padded_bounds(
        &self,
        steps: u32,
        pad: impl Fn(&Object<F>) -> f64,
    ) -> Option<Bounds<F::Point>> {
        self.boxes_with(pad)?.at(steps)
    }

    /// Returns whether hulls are tried before ratios of lengths: where ratios do not bound subtrees, or only loosely, unless
    /// there are many subtrees of similarities.
    pub(super) fn prefers_hulls(&self) -> bool {
        let is_loose = || self.affine && !(self.has_many_behaviours() && self.is_similar());
        F::HAS_HULLS && (self.longest_ratio() >= 1.0 || is_loose())
    }

    /// Returns whether there are so many behaviours that a hull, or cells, of each take long.
    pub(crate) fn has_many_behaviours(&self) -> bool {
        const MANY: usize = 1_000;
        self.behaviours().nth(MANY).is_some()
    }

    /// Returns the bounding box of approximant `steps` as [`bounds`](Self::bounds) does, but each side may lie outside of the
    /// set by a share of its extent.
    pub(crate) fn bounds_within(&self, steps: u32, share: f64) -> Option<Bounds<F::Point>> {
        let mut reach = Reach {
            share,
            ..self.reach_within(false, None, |_| 0.0)?
        };
        if self.depth == Some(steps) {
            // In the last step, all is drawn that objects lead to.
            reach.alive = self.alive(true);
        }
        ApproximantBounds { graph: self, reach }.at(steps)
    }

    /// Returns the boxes of approximants.
    fn boxes_with(&self, pad: impl Fn(&Object<F>) -> f64) -> Option<ApproximantBounds<'_, F>> {
        // Hulls of many objects take little only if no cycles lead through them.
        let is_much = self.has_many_behaviours() && !self.is_time_indexed();
        let by_hulls = (self.prefers_hulls() && !is_much).then_some(Fineness::COARSE);
        let reach = by_hulls.and_then(|fineness| self.reach_within(false, Some(fineness), &pad));
        let reach = reach.or_else(|| self.reach_within(false, None, &pad))?;
        Some(ApproximantBounds { graph: self, reach })
    }

    /// Returns bounds for boxes of approximants, or of the limit, by polygons of a fineness, or else by ratios; `None` if these
    /// bound nothing.
    pub(super) fn reach_within(
        &self,
        limit: bool,
        fineness: Option<Fineness>,
        pad: impl Fn(&Object<F>) -> f64,
    ) -> Option<Reach<F>> {
        let resets = self
            .instances()
            .any(|(placement, _)| placement == Placement::SeedsAsInitiator);
        if !self.is_plain() || !self.is_regular() || resets {
            return None;
        }
        let (spread, ratio) = (self.spread(&pad), self.longest_ratio());
        let alive = self.alive(limit);
        let pads: Vec<f64> = self.objects.iter().map(&pad).collect();
        let own = Own::Outlines(&pads);
        let drawn = limit.then_some(&alive[..]);
        let hulls = match fineness {
            Some(fineness) => Some((F::hulls(self, &own, drawn, fineness)?, fineness)),
            None if limit && ratio >= 1.0 => return None,
            None => None,
        };
        let radii = (fineness.is_none() && ratio >= 1.0).then(|| {
            let outline = self.outline_radii();
            let radii = self.reaches(|object| outline(object) + pad(object));
            let about_origin = |radius| radius + self.middle.length();
            radii.into_iter().map(about_origin).collect()
        });
        Some(Reach {
            spread,
            ratio,
            radii,
            share: 0.0,
            is_patient: true,
            looked: Cell::new(0),
            hulls,
            alive,
            alike: self.alike(limit),
            pads,
        })
    }

    /// Returns the object that stands for each in boxes of approximants, or of the limit.
    fn alike(&self, limit: bool) -> Vec<usize> {
        let mut first = FastMap::default();
        let objects = self.objects.iter().enumerate();
        let alike = objects.map(|(number, object)| match limit && !object.is_kept() {
            true => *first.entry(object.behaviour).or_insert(number),
            false => number,
        });
        alike.collect()
    }

    /// Returns the largest distance from an object's origin at which it draws something or places an
    /// instance.
    fn spread(&self, pad: impl Fn(&Object<F>) -> f64) -> f64 {
        let shape = |object: usize| {
            let base_element = &self.base_elements()[self.objects[object].base_element];
            let axes = F::Point::AXES.iter();
            axes.map(|&axis| base_element.support(axis))
                .map(f64::abs)
                .fold(0.0, f64::max)
                * F::Point::splat(1.0).length()
                + pad(&self.objects[object])
        };
        let shapes: Vec<f64> = (0..self.objects.len()).map(shape).collect();
        let mut constant = shapes.iter().copied().fold(0.0, f64::max);
        for (_, instance) in self.instances() {
            let shift = instance.frame.origin().length();
            let own = if self.is_fertile(instance.object) {
                0.0
            } else {
                instance.length * shapes[instance.object]
            };
            constant = constant.max(shift + own);
        }
        constant
    }

    /// Returns the bounding box of what becomes of some instances: after so many steps, or in the limit.
    pub(super) fn box_by(
        &self,
        reach: &Reach<F>,
        start: &[Instance<F>],
        steps: Option<u32>,
    ) -> Option<Bounds<F::Point>> {
        let spared = reach.spared(start, steps);
        let [max, min] = ends(|axis| self.support(axis, start, steps, (reach, spared)))?;
        // Coordinates below the rounding error are replaced by zero.
        let nothing = reach.slack() * min.abs().max(max.abs()).max_element();
        let rounded = |value: f64| if value.abs() <= nothing { 0.0 } else { value };
        let bounds = Bounds::new(min.map(rounded), max.map(rounded));
        bounds.is_finite().then_some(bounds)
    }

    /// Returns the greatest value of a linear functional on what some instances draw, after so many steps or in the limit. It
    /// may fall short, or be too large, by the length that is spared.
    fn support(
        &self,
        direction: F::Point,
        start: &[Instance<F>],
        steps: Option<u32>,
        (reach, spared): (&Reach<F>, f64),
    ) -> Option<f64> {
        let start = start.iter();
        let start = start.map(|instance| SupportTerm {
            object: reach.alike[instance.object],
            ..child(instance, direction, 0.0, 0.0)
        });
        let mut states = Merged::from_iter(start).reaching(f64::NEG_INFINITY);
        let mut best = f64::NEG_INFINITY;
        let (mut work, mut looked) = (0, 0);
        let max_looked = match reach.is_patient {
            true => MAX_LOOKED,
            false => MAX_LOOKED_AT_FIRST,
        };
        for level in 0..=MAX_LEVELS {
            let last = steps == Some(level);
            let levels = steps.map(|steps| steps - level);
            let mut certain = best;
            let mut spans = Vec::with_capacity(states.len());
            for state in &states {
                let object = &self.objects[state.object];
                let kept = object.is_kept();
                if (kept || last) && object.visible {
                    let base_element = &self.base_elements()[object.base_element];
                    let pad = reach.pads[state.object] * state.vector.length();
                    let reached = base_element.support(state.vector) + state.lost + pad;
                    best = best.max(state.offset + reached);
                }
                let span @ [_, surely] = reach.span(state, levels);
                if reach.alive[state.object] {
                    certain = certain.max(surely);
                }
                spans.push(span);
            }
            if last {
                return best.is_finite().then_some(best);
            }
            certain = certain.max(best);
            // Rounding drops no state that reaches as far as the farthest one.
            let with_slack = |certain: f64| certain - reach.slack() * (1.0 + certain.abs());
            let mut certain = with_slack(certain);
            let left = levels.map(|levels| levels - 1);
            // The farthest states are looked at first: their children drop most of the others.
            let mut order: Vec<usize> = (0..states.len()).collect();
            order.sort_by(|a, b| spans[*b][0].total_cmp(&spans[*a][0]));
            let mut next = Merged::default();
            for number in order {
                let state = &states[number];
                let is_short = falls_short(spans[number][0], certain);
                let is_dead = steps.is_none() && !reach.alive[state.object];
                if is_short || is_dead {
                    continue;
                }
                if let Some(successor) = self.objects[state.object].successor() {
                    // A state that is not certain to draw at this step is followed to its end.
                    let known = reach.alive[state.object] || steps.is_none();
                    let negligible = reach.negligible() * (1.0 + state.offset.abs());
                    let negligible = negligible.max(spared);
                    let rest = if steps.is_none() && reach.hulls.is_some() {
                        reach.rest(state, negligible)
                    } else {
                        let size = reach.size(state, levels);
                        let rest = if reach.share > 0.0 { size } else { 0.0 };
                        (size <= negligible).then_some(rest)
                    };
                    if let Some(rest) = rest.filter(|_| known) {
                        if reach.alive[state.object] {
                            best = best.max(state.offset + (state.lost + rest));
                        }
                        continue;
                    }
                    #[expect(clippy::cast_possible_truncation, reason = "states are limited")]
                    let parent = number as u32;
                    let mut look = |instance| {
                        let mut spend = |amount| {
                            looked += amount;
                            work::count(amount);
                        };
                        spend(1);
                        reach.looked.set(reach.looked.get() + 1);
                        let mut child = child(instance, state.vector, state.offset, state.lost);
                        child.object = reach.alike[child.object];
                        child.parent = parent;
                        if falls_short(reach.at_most(&child), certain) {
                            return;
                        }
                        spend(COMPARED);
                        let Some(slot) = next.slot(&child) else {
                            return;
                        };
                        spend(BOUNDED);
                        let [most, surely] = reach.span(&child, left);
                        if falls_short(most, certain) {
                            return;
                        }
                        if reach.alive[child.object] {
                            certain = certain.max(with_slack(surely));
                        }
                        child.most = most;
                        next.put(&slot, child);
                    };
                    let is_limit = steps.is_none();
                    let contenders = is_limit.then(|| reach.contenders(state, successor));
                    match contenders.flatten() {
                        Some(numbers) => {
                            let instances = &successor.body.instances;
                            numbers.iter().for_each(|it| look(&instances[*it as usize]));
                        }
                        None => { successor.placed_instances() }.for_each(|(_, it)| look(it)),
                    }
                    if next.len() > MAX_NEXT {
                        next.drop_short(certain);
                        if next.len() > MAX_NEXT / 2 {
                            return None;
                        }
                    }
                    if looked > max_looked {
                        return None;
                    }
                }
            }
            states = next.reaching(certain);
            if states.is_empty() {
                return best.is_finite().then_some(best);
            }
            work += states.len();
            if states.len() > MAX_STATES || work > MAX_WORK {
                return None;
            }
        }
        None
    }
}

/// Returns the greatest and the least corner of a box, by the greatest values along the directions of the axes.
pub(super) fn ends<P: Point>(mut farthest: impl FnMut(P) -> Option<f64>) -> Option<[P; 2]> {
    let mut ends = [P::ZERO; 2];
    for (number, &axis) in P::AXES.iter().enumerate() {
        ends[number % 2] = ends[number % 2] + axis * farthest(axis)?;
    }
    Some(ends)
}

impl<F: Bounded> ApproximantBounds<'_, F> {
    /// Returns the number of states that were looked at for all boxes so far.
    #[cfg(feature = "cli")]
    pub(crate) fn looked(&self) -> usize {
        self.reach.looked.get()
    }

    /// Returns the bounding box of approximant `steps`.
    #[must_use]
    pub fn at(&self, steps: u32) -> Option<Bounds<F::Point>> {
        let is_resolved = self.graph.depth.is_none_or(|depth| depth >= steps);
        let start = &self.graph.initiator(steps).instances;
        is_resolved.then(|| self.graph.box_by(&self.reach, start, Some(steps)))?
    }
}

#[cfg(test)]
mod tests;
