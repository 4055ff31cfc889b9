//! Radii of the subtrees of objects, computed from the graph alone, for culling.

use std::collections::BTreeMap;

use crate::expression::Interval;
use crate::geometry::{Frame, Outline, Point};
use crate::rule::Placement;

use super::bounded::{Bounded, Fineness, Own};
use super::{Graph, Instance, Object, Replacement};

/// Relative change of the radii below which iteration stops.
const TOLERANCE: f64 = 1e-3;

/// Largest ratio for which discs alone give good radii; with weaker contraction they are far too large.
const LITTLE: f64 = 0.75;

/// Limit of the number of sweeps that decrease the radii.
const MOST_SWEEPS: usize = 64;

/// Object in the place of another one, or seeded by it.
pub(super) struct Edge {
    pub(super) object: usize,
    /// Largest distance of its middle from the middle of the parent's frame, as a multiple of the
    /// parent's length.
    pub(super) away: f64,
    /// Largest length, as a multiple of the parent's.
    pub(super) length: f64,
}

impl<F: Bounded> Graph<F> {
    /// Returns, for every object, the radius of a disc about the [middle](Graph::middle) of its unit
    /// frame that contains it and its subtree, seeds included, at every step and for all draws; infinite
    /// where the graph gives no bound: if seeds are placed as the initiator, or if the subtree is not
    /// certain to shrink.
    ///
    /// `own` returns the radius of what an object draws itself, about the same point. The result may be
    /// larger than the smallest disc, but not smaller, except for rounding.
    ///
    /// The smallest radii solve r(o) = max(own(o), |m − m(c)| + ratio(c) · r(c)) over the instances c in
    /// the object's place, with m the middles. The iteration approaches them from above, from the sum of
    /// a geometric series or from infinity. For random instances, the largest distance and the largest
    /// length are used.
    #[must_use]
    pub fn reaches(&self, own: impl Fn(&Object<F>) -> f64) -> Vec<f64> {
        let own: Vec<f64> = self.objects.iter().map(own).collect();
        let edges = self.edges(f64::INFINITY);
        let kept = |object: usize| matches!(self.objects[object].replacement, Replacement::Kept);
        let ratio = self.longest_edge(&edges);
        let spread = edges.iter().flatten().map(|edge| {
            if kept(edge.object) {
                edge.away + edge.length * own[edge.object]
            } else {
                edge.away
            }
        });
        let spread = spread.chain(own.iter().copied()).fold(0.0, f64::max);
        let most = if ratio < 1.0 {
            spread / (1.0 - ratio)
        } else {
            self.reach_by_products(self.middle, spread)
                .unwrap_or(f64::INFINITY)
        };
        let unknown = self.resets();
        let mut radii: Vec<f64> = (0..own.len())
            .map(|object| match &self.objects[object].replacement {
                _ if unknown[object] => f64::INFINITY,
                Replacement::Fixed(_) | Replacement::Evaluated(_) => most,
                _ => own[object],
            })
            .collect();
        for _ in 0..MOST_SWEEPS {
            let mut change = 1.0;
            // Children have larger numbers than the objects that reach them first.
            for object in (0..own.len()).rev() {
                if unknown[object] {
                    continue;
                }
                let reached = edges[object].iter().map(|edge| {
                    // An instance of length 0 draws nothing, even if the radius of its object is
                    // infinite.
                    let own = if edge.length > 0.0 {
                        edge.length * radii[edge.object]
                    } else {
                        0.0
                    };
                    edge.away + own
                });
                let radius = reached.fold(own[object], f64::max);
                if radius < radii[object] {
                    change = f64::min(change, radius / radii[object]);
                    radii[object] = radius;
                }
            }
            if change > 1.0 - TOLERANCE {
                break;
            }
        }
        if self.affine && ratio > LITTLE {
            self.narrow(&mut radii, &own);
        }
        radii
    }

    /// Decreases the radii to those of the polygons that contain the subtrees.
    fn narrow(&self, radii: &mut [f64], own: &[f64]) {
        if let Some(hulls) = F::hulls(self, &Own::Discs(own), None, Fineness::COARSE) {
            for (object, radius) in radii.iter_mut().enumerate() {
                *radius = radius.min(hulls.radius(object, self.middle));
            }
        }
    }

    /// Returns whether all fertile elements shrink below any length: no object leads back to itself at
    /// its own size or larger, and no seed is placed as the initiator.
    ///
    /// Random instances are assumed to shrink.
    #[must_use]
    pub fn shrinks(&self) -> bool {
        // Ratios are rounded; an object that returns at its own size must not seem to shrink.
        const SLACK: f64 = 1.0 + 1e-9;
        if self.resets().contains(&true) {
            return false;
        }
        if self.longest_ratio() * SLACK < 1.0 {
            return true;
        }
        if self.affine {
            return self.contracts();
        }
        // The longest paths (Bellman 1958) grow without end if and only if there is such a cycle.
        let mut longest = vec![1.0; self.objects.len()];
        for _ in 0..=longest.len() {
            let mut grows = false;
            for object in 0..longest.len() {
                for (_, instance) in self.children(object) {
                    let fertile =
                        !matches!(self.objects[instance.object].replacement, Replacement::Kept);
                    let length = longest[object] * instance.length * SLACK;
                    if fertile && length > longest[instance.object] {
                        longest[instance.object] = length;
                        grows = true;
                    }
                }
            }
            if !grows {
                return true;
            }
        }
        false
    }
}

impl<F: Frame> Graph<F> {
    /// Returns the radius, about the middle of the unit frame, of a disc that contains the outline of an
    /// object, if it is drawn, and its unit frame.
    pub(crate) fn outline_radius(&self, object: &Object<F>) -> f64 {
        // Invisible elements have a position nevertheless; in systems it is a point.
        let frame = if self.affine {
            0.0
        } else {
            self.middle.length()
        };
        if object.visible {
            let base_element = &self.base_elements()[object.base_element];
            base_element.radius_about(self.middle).max(frame)
        } else {
            frame
        }
    }

    /// Returns, for every object, the objects that may take its place or that it may seed, including all
    /// random alternatives, with upper bounds of their lengths as multiples of its length.
    pub(crate) fn ratios(&self) -> Vec<Vec<(usize, f64)>> {
        let of = |edges: Vec<Edge>| {
            edges
                .iter()
                .map(|edge| (edge.object, edge.length))
                .collect()
        };
        self.edges(f64::INFINITY).into_iter().map(of).collect()
    }

    /// Returns the edges to the possible children of every object: with upper bounds of distance and
    /// length or, for a finite power, with upper bounds of their power means (see `Generator::means`).
    pub(super) fn edges(&self, power: f64) -> Vec<Vec<Edge>> {
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
                let extents = extents
                    .entry(generator)
                    .or_insert_with(|| self.source().extents(generator, power, &self.moments()));
                let drawn = alternative.objects.iter().zip(extents);
                edges.extend(drawn.map(|(&object, extent)| Edge {
                    object,
                    away: extent.away,
                    length: extent.length,
                }));
            }
            edges
        };
        (0..self.objects.len()).map(edges).collect()
    }

    /// Returns the ranges of all values that expressions see of an element.
    fn moments(&self) -> [Interval; 4] {
        let time = Interval::new(0.0, self.depth.map_or(f64::INFINITY, f64::from));
        let index = Interval::new(1.0, f64::INFINITY);
        let length = Interval::new(0.0, f64::INFINITY);
        [index, time, time, length]
    }

    /// Returns the approximate centre of the subtree of an element, in its unit frame.
    #[must_use]
    pub fn middle(&self) -> F::Point {
        self.middle
    }

    /// Returns, for every object, whether it leads to seeds that are placed as the initiator. The subtree
    /// of such an object does not shrink with the object.
    #[must_use]
    pub fn resets(&self) -> Vec<bool> {
        self.leading_to(|object| self.places_as_initiator(object))
    }

    /// Returns, for every object, whether it leads to seeds.
    pub(crate) fn leads_to_seeds(&self) -> Vec<bool> {
        self.leading_to(|object| match &self.objects[object].replacement {
            Replacement::Fixed(production) => !production.seeds.is_empty(),
            Replacement::Evaluated(alternatives) => alternatives.iter().any(|alternative| {
                let parts = self.parts(alternative);
                parts.iter().any(|part| part.placement.seeds())
            }),
            Replacement::Kept => false,
            Replacement::Unresolved => true,
        })
    }

    /// Returns, for every object, whether it is of a kind or may lead to an object of the kind.
    pub(crate) fn leading_to(&self, kind: impl Fn(usize) -> bool) -> Vec<bool> {
        let mut leading: Vec<bool> = (0..self.objects.len()).map(kind).collect();
        let mut changes = leading.contains(&true);
        while changes {
            changes = false;
            for object in (0..leading.len()).rev() {
                if !leading[object] && self.successors(object).any(|child| leading[child]) {
                    leading[object] = true;
                    changes = true;
                }
            }
        }
        leading
    }

    /// Returns an upper bound of the length of elements that are created in the last of `steps` steps;
    /// infinite where the graph gives none.
    #[must_use]
    pub fn longest_after(&self, steps: u32) -> f64 {
        if self.resets().contains(&true) {
            return f64::INFINITY;
        }
        let start = self.initiator(steps).instances.iter();
        let longest = start.map(|instance| instance.length).fold(0.0, f64::max);
        let edges = self.edges(f64::INFINITY);
        longest * libm::pow(self.longest_edge(&edges), f64::from(steps))
    }

    /// Returns an upper bound of the length of a fertile child, as a multiple of its parent's length;
    /// infinite where the graph gives none.
    #[must_use]
    pub fn longest_child(&self) -> f64 {
        if self.resets().contains(&true) {
            return f64::INFINITY;
        }
        self.longest_edge(&self.edges(f64::INFINITY))
    }

    /// Returns the largest ratio of edges to objects that may be fertile.
    fn longest_edge(&self, edges: &[Vec<Edge>]) -> f64 {
        let kept = |object: usize| matches!(self.objects[object].replacement, Replacement::Kept);
        let fertile = edges.iter().flatten().filter(|edge| !kept(edge.object));
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
        let fertile = |instance: &&Instance<F>| {
            !matches!(self.objects[instance.object].replacement, Replacement::Kept)
        };
        let start = self.initiator(0).instances.iter().filter(fertile);
        let later = self.instances().map(|(_, instance)| instance);
        let start = one_length(start)?;
        Some([start * self.unit, one_length(later.filter(fertile))?])
    }

    /// Iterates over the fixed instances that take an object's place or that it seeds.
    pub(crate) fn children(
        &self,
        object: usize,
    ) -> impl Iterator<Item = (Placement, &Instance<F>)> {
        let production = match &self.objects[object].replacement {
            Replacement::Fixed(production) => Some(production),
            _ => None,
        };
        production
            .into_iter()
            .flat_map(|production| production.placed_instances())
    }

    /// Iterates over all instances of fixed productions, with their placements.
    pub(super) fn instances(&self) -> impl Iterator<Item = (Placement, &Instance<F>)> {
        (0..self.objects.len()).flat_map(|object| self.children(object))
    }

    /// Returns the largest ratio of a fertile instance.
    pub(super) fn longest_ratio(&self) -> f64 {
        let kept = |object: usize| matches!(self.objects[object].replacement, Replacement::Kept);
        let fertile = self
            .instances()
            .filter(|(_, instance)| !kept(instance.object));
        fertile
            .map(|(_, instance)| instance.length)
            .fold(0.0, f64::max)
    }

    /// Iterates over the objects that may take an object's place or that it may seed.
    fn successors(&self, object: usize) -> impl Iterator<Item = usize> {
        let alternatives = match &self.objects[object].replacement {
            Replacement::Evaluated(alternatives) => Some(alternatives),
            _ => None,
        };
        let drawn = alternatives.into_iter().flat_map(|all| all.iter());
        let fixed = self.children(object).map(|(_, instance)| instance.object);
        fixed.chain(drawn.flat_map(|alternative| alternative.objects.iter().copied()))
    }

    fn places_as_initiator(&self, object: usize) -> bool {
        match &self.objects[object].replacement {
            Replacement::Fixed(production) => production
                .seeds
                .iter()
                .any(|seed| seed.placement == Placement::SeedsAsInitiator),
            Replacement::Evaluated(alternatives) => alternatives.iter().any(|alternative| {
                let mut parts = self.parts(alternative).iter();
                parts.any(|part| part.placement == Placement::SeedsAsInitiator)
            }),
            Replacement::Kept | Replacement::Unresolved => false,
        }
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
