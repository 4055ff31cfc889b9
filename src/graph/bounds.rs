//! The box of an approximant and of the limit set, from the graph alone.
//!
//! The support function h(u) = max x·u is carried down the graph for the four directions of the
//! axes. An instance with linear part L and shift t turns the direction into Lᵀu and adds t·u, so
//! a state is an object with a vector and an offset. States that are equal but for the offset are
//! merged to the one that reaches farthest, and states that cannot reach the best one are dropped;
//! what is left stays small (finitely many directions where turns are rational).

use std::collections::HashMap;

use crate::geometry::{Bounds, DVec2};
use crate::rule::Placement;

use super::{Graph, Instance, Replacement};

/// More states than this at one level are given up.
const MOST_STATES: usize = 100_000;

/// More levels than this are given up.
const MOST_LEVELS: u32 = 20_000;

/// What is smaller than this multiple of the whole adds nothing to a double.
const NEGLIGIBLE: f64 = 1e-17;

struct State {
    object: usize,
    vector: DVec2,
    offset: f64,
    /// What rounding has taken from the offset.
    lost: f64,
}

/// What the search needs to know of the graph.
struct Reach {
    /// The radius around its origin, in its own unit frame, of all that an object ever draws.
    radius: f64,
    /// Objects that surely draw something.
    alive: Vec<bool>,
}

impl Graph {
    /// The box of what approximant `steps` draws, without stroke width.
    ///
    /// Exact to some 15 digits. `None` where nothing is drawn, where the graph does not tell (random
    /// and irregular rules, seeds placed as the initiator, generators that do not shrink), or where
    /// the graph was compiled for fewer steps.
    #[must_use]
    pub fn bounds(&self, steps: u32) -> Option<Bounds> {
        if self.depth.is_some_and(|depth| depth < steps) {
            return None;
        }
        self.bounds_at(Some(steps))
    }

    /// The box of the limit set: of the limit of the approximants as drawn, to which infertile
    /// visible elements belong.
    ///
    /// Exact to some 15 digits. `None` where there is none or the graph does not tell.
    #[must_use]
    pub fn limit_bounds(&self) -> Option<Bounds> {
        if self.depth.is_some() || self.longest_ratio() >= 1.0 {
            return None;
        }
        self.bounds_at(None)
    }

    fn bounds_at(&self, steps: Option<u32>) -> Option<Bounds> {
        let resets = self
            .instances()
            .any(|(placement, _)| placement == Placement::SeedsAsInitiator);
        if !self.is_plain() || !self.is_regular() || resets {
            return None;
        }
        let reach = Reach {
            radius: self.radius()?,
            alive: self.alive(steps.is_none()),
        };
        let support = |direction| self.support(direction, steps, &reach);
        let max = DVec2::new(support(DVec2::X)?, support(DVec2::Y)?);
        let min = -DVec2::new(support(-DVec2::X)?, support(-DVec2::Y)?);
        let bounds = Bounds::new(min + 0.0, max + 0.0);
        bounds.is_finite().then_some(bounds)
    }

    /// All instances of fixed productions, with how they are placed.
    fn instances(&self) -> impl Iterator<Item = (Placement, &Instance)> {
        self.objects.iter().flat_map(|object| {
            let production = match &object.replacement {
                Replacement::Fixed(production) => Some(production),
                _ => None,
            };
            production.into_iter().flat_map(|production| {
                let body = production
                    .body
                    .instances
                    .iter()
                    .map(|instance| (Placement::Stays, instance));
                let seeds = production.seeds.iter().flat_map(|seed| {
                    let instances = seed.chain.instances.iter();
                    instances.map(move |instance| (seed.placement, instance))
                });
                body.chain(seeds)
            })
        })
    }

    /// Whether a replacement makes copies that are not smaller: there is no limit set then.
    #[must_use]
    pub fn shrinks(&self) -> bool {
        self.longest_ratio() < 1.0
    }

    /// The largest ratio of a fertile instance.
    fn longest_ratio(&self) -> f64 {
        let kept = |object: usize| matches!(self.objects[object].replacement, Replacement::Kept);
        let fertile = self
            .instances()
            .filter(|(_, instance)| !kept(instance.object));
        fertile
            .map(|(_, instance)| instance.length)
            .fold(0.0, f64::max)
    }

    /// The radius of all that is ever drawn from any object: the solution of
    /// R = max(shapes, |t| + ratio·R), from above.
    fn radius(&self) -> Option<f64> {
        let ratio = self.longest_ratio();
        if ratio >= 1.0 {
            return None;
        }
        let shape = |object: usize| {
            let base_element = &self.base_elements()[self.objects[object].base_element];
            let axes = [DVec2::X, -DVec2::X, DVec2::Y, -DVec2::Y];
            axes.iter()
                .map(|&axis| base_element.support(axis))
                .map(f64::abs)
                .fold(0.0, f64::max)
                * std::f64::consts::SQRT_2
        };
        let mut constant = (0..self.objects.len()).map(shape).fold(0.0, f64::max);
        for (_, instance) in self.instances() {
            let shift = instance.frame.map.translation.length();
            let kept = matches!(self.objects[instance.object].replacement, Replacement::Kept);
            let own = if kept {
                instance.length * shape(instance.object)
            } else {
                0.0
            };
            constant = constant.max(shift + own);
        }
        let radius = constant / (1.0 - ratio);
        radius.is_finite().then_some(radius)
    }

    /// Objects that draw something at every later level (or, for the limit, in it).
    fn alive(&self, limit: bool) -> Vec<bool> {
        let mut alive: Vec<bool> = self
            .objects
            .iter()
            .map(|object| object.visible || limit)
            .collect();
        loop {
            let mut changed = false;
            for (number, object) in self.objects.iter().enumerate() {
                if !alive[number] {
                    continue;
                }
                let stays = match &object.replacement {
                    Replacement::Kept => object.visible,
                    Replacement::Fixed(production) => {
                        let seeds = production
                            .seeds
                            .iter()
                            .flat_map(|seed| &seed.chain.instances);
                        let mut all = production.body.instances.iter().chain(seeds);
                        all.any(|instance| alive[instance.object])
                    }
                    _ => object.visible,
                };
                if !stays {
                    alive[number] = false;
                    changed = true;
                }
            }
            if !changed {
                return alive;
            }
        }
    }

    fn support(&self, direction: DVec2, steps: Option<u32>, reach: &Reach) -> Option<f64> {
        let start = self.initiator.instances.iter();
        let mut states = merged(start.map(|instance| child(instance, direction, 0.0, 0.0)));
        let mut best = f64::NEG_INFINITY;
        for level in 0..=MOST_LEVELS {
            let last = steps == Some(level);
            let mut next = Vec::new();
            let mut certain = best;
            for state in &states {
                let object = &self.objects[state.object];
                let kept = matches!(object.replacement, Replacement::Kept);
                if (kept || last) && object.visible {
                    let base_element = &self.base_elements()[object.base_element];
                    let reached = base_element.support(state.vector) + state.lost;
                    best = best.max(state.offset + reached);
                }
                let size = state.vector.length() * reach.radius;
                if reach.alive[state.object] {
                    certain = certain.max(state.offset - size);
                }
            }
            if last {
                return best.is_finite().then_some(best);
            }
            certain = certain.max(best);
            for state in states {
                let size = state.vector.length() * reach.radius;
                let hopeless = state.offset + size < certain;
                let dead = steps.is_none() && !reach.alive[state.object];
                if hopeless || dead {
                    continue;
                }
                if let Replacement::Fixed(production) = &self.objects[state.object].replacement {
                    if size <= NEGLIGIBLE * (1.0 + state.offset.abs()) {
                        if reach.alive[state.object] {
                            best = best.max(state.offset + state.lost);
                        }
                        continue;
                    }
                    let seeds = production
                        .seeds
                        .iter()
                        .flat_map(|seed| &seed.chain.instances);
                    let all = production.body.instances.iter().chain(seeds);
                    next.extend(
                        all.map(|instance| child(instance, state.vector, state.offset, state.lost)),
                    );
                }
            }
            if next.is_empty() {
                return best.is_finite().then_some(best);
            }
            states = merged(next.into_iter());
            if states.len() > MOST_STATES {
                return None;
            }
        }
        None
    }
}

fn child(instance: &Instance, vector: DVec2, offset: f64, lost: f64) -> State {
    let map = &instance.frame.map;
    let shift = vector.dot(map.translation);
    // Knuth's exact sum of two doubles (TwoSum): errors of many levels do not add up.
    let sum = offset + shift;
    let rounded = sum - offset;
    let error = (offset - (sum - rounded)) + (shift - rounded);
    State {
        object: instance.object,
        vector: map.matrix2.transpose() * vector,
        offset: sum,
        lost: lost + error,
    }
}

/// Keeps the farthest of the states that are equal but for the offset.
fn merged(states: impl Iterator<Item = State>) -> Vec<State> {
    let mut kept: Vec<State> = Vec::new();
    let mut numbers = HashMap::new();
    for state in states {
        let length = state.vector.length();
        let unit = state.vector / length;
        let key = [unit.x, unit.y, libm::log(length)].map(rounded);
        match numbers.get(&(state.object, key)) {
            Some(&number) => {
                let known: &mut State = &mut kept[number];
                if (known.offset, known.lost) < (state.offset, state.lost) {
                    (known.offset, known.lost) = (state.offset, state.lost);
                }
            }
            None => {
                numbers.insert((state.object, key), kept.len());
                kept.push(state);
            }
        }
    }
    kept
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate"
)]
fn rounded(value: f64) -> i64 {
    (value * 1e10).round() as i64
}
