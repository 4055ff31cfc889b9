//! How far what becomes of an object reaches, from the graph alone, so that it need not be grown
//! where it cannot be seen.

use std::collections::BTreeMap;

use crate::expression::Interval;
use crate::geometry::DVec2;
use crate::rule::Placement;

use super::hull::{Fineness, around};
use super::{Evaluated, Graph, Instance, Object, Replacement};

/// Radii that still change by less than this multiple are good enough.
const TOLERANCE: f64 = 1e-3;

/// Where maps contract less than this, radii of discs one after the other are far too large.
const LITTLE: f64 = 0.75;

/// So many times, at most, all radii are made smaller.
const MOST_SWEEPS: usize = 64;

/// An object that may come of another one.
pub(super) struct Edge {
    pub(super) object: usize,
    /// The most that its middle lies from that of the other one's frame,
    pub(super) away: f64,
    /// and that it is long, as multiples of the other one's length.
    pub(super) length: f64,
}

impl Graph {
    /// For every object, the radius of a disc about the [middle](Graph::middle) of its unit frame that
    /// holds it and all that becomes of it, seeds included, at every step, whatever is drawn; infinite
    /// where the graph does not tell: where seeds are placed as the initiator, and where what becomes of
    /// the object does not surely shrink.
    ///
    /// `own` is the radius of an object that is drawn itself, about the same point. The result may
    /// be larger than the smallest disc, never smaller but by rounding.
    ///
    /// The smallest radii solve r(o) = max(own(o), |m − m(c)| + ratio(c) · r(c)) over the instances
    /// c in the object's place, with m the middles. They are approached from above, from the sum of
    /// a geometric series or from infinity. Of instances that are drawn, what is farthest and what
    /// is longest counts.
    #[must_use]
    pub fn reaches(&self, own: impl Fn(&Object) -> f64) -> Vec<f64> {
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
            // Children have larger numbers than those that reach them first.
            for object in (0..own.len()).rev() {
                if unknown[object] {
                    continue;
                }
                let reached = edges[object].iter().map(|edge| {
                    // What has no length draws nothing, however far it would reach.
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

    /// Takes smaller radii where polygons about what becomes of objects tell them.
    fn narrow(&self, radii: &mut [f64], own: &[f64]) {
        let disc = |object: usize| around(self.middle, own[object]).collect();
        if let Some(hulls) = self.hulls(&disc, None, Fineness::COARSE) {
            for (object, radius) in radii.iter_mut().enumerate() {
                *radius = radius.min(hulls.radius(object, self.middle));
            }
        }
    }

    /// The radius of a disc that holds the outline of an object, where it is drawn, and its unit
    /// frame, about the middle of the latter.
    pub(crate) fn outline_radius(&self, object: &Object) -> f64 {
        // Elements that are not drawn have a place nevertheless; in systems that is a point.
        let frame = if self.affine { 0.0 } else { self.middle.x };
        if object.visible {
            let base_element = &self.base_elements()[object.base_element];
            base_element.radius_about(self.middle).max(frame)
        } else {
            frame
        }
    }

    /// For every object, those that may take its place or be seeded by it, all at once where it
    /// depends on draws which; and the most that they are long, as multiples of its length.
    pub(crate) fn ratios(&self) -> Vec<Vec<(usize, f64)>> {
        let of = |edges: Vec<Edge>| {
            edges
                .iter()
                .map(|edge| (edge.object, edge.length))
                .collect()
        };
        self.edges(f64::INFINITY).into_iter().map(of).collect()
    }

    /// What may come of every object: as far and as long as it may be or, of a finite power, as that of
    /// the mean of the powers is (see [`Generator::means`](crate::rule::Generator)).
    pub(super) fn edges(&self, power: f64) -> Vec<Vec<Edge>> {
        let mut extents = BTreeMap::new();
        let edges = |object: usize| {
            let Replacement::Evaluated(alternatives) = &self.objects[object].replacement else {
                let edge = |(_, instance): (_, &Instance)| Edge {
                    object: instance.object,
                    away: (instance.frame.map.transform_point2(self.middle) - self.middle).length(),
                    length: instance.length,
                };
                return self.children(object).map(edge).collect();
            };
            let mut edges = Vec::new();
            for alternative in alternatives.iter() {
                let generator = alternative.generator;
                let extents = extents
                    .entry(generator)
                    .or_insert_with(|| match self.evaluated() {
                        Evaluated::Rule(rule) if power.is_infinite() => {
                            rule.generators()[generator].extents(&self.moments())
                        }
                        Evaluated::Rule(rule) => {
                            rule.generators()[generator].means(power, &self.moments())
                        }
                        Evaluated::Words(words) => words.extents(generator).to_vec(),
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
        (0..self.objects.len()).map(edges).collect()
    }

    /// All that expressions may see of an element.
    fn moments(&self) -> [Interval; 4] {
        let time = Interval::new(0.0, self.depth.map_or(f64::INFINITY, f64::from));
        let index = Interval::new(1.0, f64::INFINITY);
        let length = Interval::new(0.0, f64::INFINITY);
        [index, time, time, length]
    }

    /// About where, in the unit frame of an element, what becomes of it lies.
    #[must_use]
    pub fn middle(&self) -> DVec2 {
        self.middle
    }

    /// Whether an object leads to seeds that are placed as the initiator, by object. However small
    /// the object is, what becomes of it is not.
    #[must_use]
    pub fn resets(&self) -> Vec<bool> {
        self.leading_to(|object| self.places_as_initiator(object))
    }

    /// Whether an object leads to seeds, by object.
    pub(crate) fn leads_to_seeds(&self) -> Vec<bool> {
        self.leading_to(|object| match &self.objects[object].replacement {
            Replacement::Fixed(production) => !production.seeds.is_empty(),
            Replacement::Evaluated(alternatives) => alternatives.iter().any(|alternative| {
                let parts = self.parts(alternative);
                parts.iter().any(|part| part.placement.seeds())
            }),
            Replacement::Kept => false,
            Replacement::Beyond => true,
        })
    }

    /// The objects of a kind, and those that such may come of.
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

    /// The most that an element is long which is born in the last of so many steps; infinite where
    /// the graph does not tell.
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

    /// The most that what may be replaced is long, as a multiple of the element's length that it comes
    /// of; infinite where the graph does not tell.
    #[must_use]
    pub fn longest_child(&self) -> f64 {
        if self.resets().contains(&true) {
            return f64::INFINITY;
        }
        self.longest_edge(&self.edges(f64::INFINITY))
    }

    /// The largest ratio of what may be fertile.
    fn longest_edge(&self, edges: &[Vec<Edge>]) -> f64 {
        let kept = |object: usize| matches!(self.objects[object].replacement, Replacement::Kept);
        let fertile = edges.iter().flatten().filter(|edge| !kept(edge.object));
        fertile.map(|edge| edge.length).fold(0.0, f64::max)
    }

    /// The length that all fertile elements of the initiator have, and the ratio of all fertile
    /// instances, if there is one of each, the graph is plain and all begins in step 0: elements are
    /// replaced down to a length in so many steps then.
    #[must_use]
    pub fn even_lengths(&self) -> Option<[f64; 2]> {
        if !self.is_plain() || !self.is_similar() || self.is_levelled() {
            return None;
        }
        if !self.roots.elements.is_empty() || self.resets().contains(&true) {
            return None;
        }
        let fertile = |instance: &&Instance| {
            !matches!(self.objects[instance.object].replacement, Replacement::Kept)
        };
        let start = self.initiator(0).instances.iter().filter(fertile);
        let later = self.instances().map(|(_, instance)| instance);
        let start = one_length(start)?;
        Some([start * self.unit, one_length(later.filter(fertile))?])
    }

    /// Whether all that is replaced again and again becomes smaller than any length: no object
    /// comes back to itself at its own size or larger, and no seed is placed as the initiator.
    ///
    /// What depends on draws is taken to shrink.
    #[must_use]
    pub fn shrinks(&self) -> bool {
        // Ratios are rounded; what comes back at its own size must not seem to shrink.
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
        // The longest paths (Bellman 1958): they go on growing if and only if there is such a cycle.
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

    /// The fixed instances that take an object's place or start what it seeds.
    pub(crate) fn children(&self, object: usize) -> impl Iterator<Item = (Placement, &Instance)> {
        let production = match &self.objects[object].replacement {
            Replacement::Fixed(production) => Some(production),
            _ => None,
        };
        production
            .into_iter()
            .flat_map(|production| production.placed_instances())
    }

    /// The objects that an object may become or seed.
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
            Replacement::Kept | Replacement::Beyond => false,
        }
    }
}

/// The length of all instances, if they have one.
fn one_length<'g>(mut instances: impl Iterator<Item = &'g Instance>) -> Option<f64> {
    // Rounding makes equal sides a little unequal.
    const ROUNDING: f64 = 1e-12;
    let length = instances.next()?.length;
    let same = |instance: &Instance| (instance.length - length).abs() <= ROUNDING * length;
    instances.all(same).then_some(length)
}
