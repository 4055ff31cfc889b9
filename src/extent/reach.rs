//! Radii of the subtrees of objects, computed from the graph alone, for culling.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use super::bounded::{Bounded, Fineness, Own};
use crate::geometry::{Frame, Outline, Point};
use crate::graph::{Graph, Object, Replacement};

/// Relative change of the radii below which iteration stops.
const TOLERANCE: f64 = 1e-3;

/// Largest ratio for which discs alone give good radii; with weaker contraction they are far too large.
const LITTLE: f64 = 0.75;

/// Limit of the number of sweeps that decrease the radii.
const MAX_SWEEPS: usize = 64;

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
        let ratio = self.longest_edge(&edges);
        let spread = edges.distinct().map(|edge| {
            if self.is_fertile(edge.object) {
                edge.away
            } else {
                edge.away + edge.length * own[edge.object]
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
        for _ in 0..MAX_SWEEPS {
            let mut change = 1.0;
            let mut known = vec![None; edges.lists()];
            // Children have larger numbers than the objects that reach them first.
            for object in (0..own.len()).rev() {
                if unknown[object] {
                    continue;
                }
                let reached = edges.shared(object, &mut known, |edges| {
                    let reached = edges.iter().map(|edge| {
                        // An instance of length 0 draws nothing, even if the radius of its object is
                        // infinite.
                        let own = if edge.length > 0.0 {
                            edge.length * radii[edge.object]
                        } else {
                            0.0
                        };
                        edge.away + own
                    });
                    reached.fold(0.0, f64::max)
                });
                let radius = reached.max(own[object]);
                if radius < radii[object] {
                    change = f64::min(change, radius / radii[object]);
                    radii[object] = radius;
                }
            }
            if change > 1.0 - TOLERANCE {
                break;
            }
        }
        // Polygons of many behaviours take long, but no radius at all lets nothing be culled.
        let is_worth_it = most.is_infinite() || !self.has_many_behaviours();
        if self.affine && ratio > LITTLE && is_worth_it {
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
        if self.no_limit.is_some() || self.resets().contains(&true) {
            return false;
        }
        if self.longest_ratio() * SLACK < 1.0 {
            return true;
        }
        if self.affine {
            return self.contracts();
        }
        // The longest paths grow without end if there is such a cycle.
        self.weights(SLACK.recip(), f64::INFINITY).is_some()
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

    /// Returns the function [`outline_radius`](Self::outline_radius), which measures each base element once.
    pub(crate) fn outline_radii(&self) -> impl Fn(&Object<F>) -> f64 {
        let drawn = vec![OnceCell::new(); self.base_elements().len()];
        let hidden = OnceCell::new();
        move |object| {
            let known = match object.visible {
                true => &drawn[object.base_element],
                false => &hidden,
            };
            *known.get_or_init(|| self.outline_radius(object))
        }
    }

    /// Returns the approximate centre of the subtree of an element, in its unit frame.
    #[must_use]
    pub fn middle(&self) -> F::Point {
        self.middle
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

    /// Returns the number of steps after which all elements are shorter than a length, whose binary logarithm, in
    /// multiples of [`unit`](Self::unit), is `shortest`. `None` where the graph does not determine it with little work.
    ///
    /// It is exact for fixed similarities and an upper bound for other fixed maps, whose longest sides need not lie in
    /// one direction.
    #[must_use]
    pub fn steps_to(&self, shortest: f64) -> Option<u32> {
        const MAX_WORK: usize = 1 << 20;
        let is_random =
            |object: &Object<F>| matches!(object.replacement, Replacement::Evaluated(_));
        if self.objects.iter().any(is_random)
            || self.resets().contains(&true)
            || !self.roots.elements.is_empty()
        {
            return None;
        }
        let mut ratios = BTreeMap::new();
        let edges = self.edges(f64::INFINITY);
        for parent in 0..self.objects.len() {
            let edges = edges.of(parent).iter();
            for edge in edges.filter(|edge| self.is_fertile(edge.object)) {
                let ratio = ratios.entry((parent, edge.object)).or_insert(0.0);
                *ratio = edge.length.max(*ratio);
            }
        }
        let ratios: Vec<_> = { ratios.into_iter() }
            .map(|(objects, ratio)| (objects, libm::log2(ratio)))
            .collect();
        let mut longest = vec![f64::NEG_INFINITY; self.objects.len()];
        for instance in &self.initiator(0).instances {
            if self.is_fertile(instance.object) {
                let longest = &mut longest[instance.object];
                *longest = libm::log2(instance.length).max(*longest);
            }
        }
        let mut next = longest.clone();
        let work = ratios.len() + longest.len();
        for step in 0..=u32::try_from(MAX_WORK / work.max(1)).unwrap_or(u32::MAX) {
            if longest.iter().all(|length| *length < shortest) {
                return Some(step);
            }
            next.fill(f64::NEG_INFINITY);
            for ((parent, child), ratio) in &ratios {
                if longest[*parent] >= shortest {
                    next[*child] = next[*child].max(longest[*parent] + ratio);
                }
            }
            std::mem::swap(&mut longest, &mut next);
        }
        None
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
}
