//! Contraction of products of maps, for graphs whose single maps do not all contract.

use std::hash::Hasher as _;

use super::bounded::Bounded;
use crate::digraph::longest_paths;
use crate::fast_hash::{FastHasher, FastMap};
use crate::geometry::{Affine, Frame, Point};
use crate::graph::{Graph, Instance};

/// Bound on the stretch of products of maps: with weights u of the objects, the product over n instances
/// that leads from an object c to an object o whose subtree contains it stretches at most by N(n) u(o) /
/// u(c).
pub(crate) struct Products {
    /// Upper bound of the sum of N(n) over all n.
    pub(crate) sum: f64,
    /// Weights by object, at least 1.
    pub(crate) weights: Vec<f64>,
}

impl<F: Bounded> Graph<F> {
    /// Returns whether fertile elements become smaller than any length, by the maps of single instances
    /// or by their products.
    #[must_use]
    pub fn contracts(&self) -> bool {
        self.products().is_some()
    }

    /// Returns a bound on the stretch of products, or `None` if no bound is found by which they contract.
    pub(crate) fn products(&self) -> Option<Products> {
        if self.no_limit.is_some() {
            return None;
        }
        let ratio = self.longest_ratio();
        let even = |sum| Products {
            sum,
            weights: vec![1.0; self.objects.len()],
        };
        if ratio < 1.0 {
            return Some(even(1.0 / (1.0 - ratio)));
        }
        self.products_by_weights()
            .or_else(|| self.products_of_maps().map(even))
    }

    /// Returns the radius about `centre`, in any object's unit frame, that contains the subtree of an
    /// object, if single maps do not contract but products do. `own` is the radius that contains what
    /// objects and kept instances draw themselves. `None` if single maps contract, or if no products are
    /// found that do.
    pub(super) fn reach_by_products(&self, centre: F::Point, own: f64) -> Option<f64> {
        if self.longest_ratio() < 1.0 {
            return None;
        }
        let Products { sum, weights } = self.products()?;
        let away = |object: usize| {
            let away = self
                .fertile(object)
                .map(|instance| (instance.frame.apply(centre) - centre).length());
            away.fold(0.0, f64::max) + own
        };
        let far = weights.iter().enumerate();
        let far = far.map(|(object, weight)| away(object) / weight);
        let longest = weights.iter().copied().fold(0.0, f64::max);
        Some(far.fold(0.0, f64::max) * sum * longest)
    }

    /// Returns the sum, over all n, of the largest stretch of products of n maps; `None` if no bound is found.
    fn products_of_maps(&self) -> Option<f64> {
        if !self.affine || !self.is_plain() {
            return None;
        }
        let images = self.images(|_| true);
        let linear = images.iter().map(|images| {
            let linear = images.iter().map(|(map, inner)| (map.linear(), *inner));
            linear.collect()
        });
        F::products(&linear.collect::<Vec<_>>())
    }

    /// Finds weights such that no instance stretches by more than λ u(o) / u(c), λ < 1. These exist if
    /// every cycle contracts although single maps expand, as in structures whose objects are drawn to
    /// different scales.
    fn products_by_weights(&self) -> Option<Products> {
        const FACTORS: [f64; 8] = [0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999];
        /// Limit of weights beyond which a cycle is taken not to contract.
        const MOST: f64 = 1e100;
        let stretches = Stretches::of(self);
        FACTORS.into_iter().find_map(|factor| {
            let weights = stretches.weights(factor, MOST)?;
            let sum = 1.0 / (1.0 - factor);
            Some(Products { sum, weights })
        })
    }

    /// Returns, for every object, the largest product of stretches over a factor along any path of fertile
    /// instances, at least 1. `None` if a product grows along a cycle, or beyond `most`, or if that takes too long to
    /// decide.
    pub(super) fn weights(&self, factor: f64, most: f64) -> Option<Vec<f64>> {
        Stretches::of(self).weights(factor, most)
    }

    /// Iterates over the fertile instances of an object.
    fn fertile(&self, object: usize) -> impl Iterator<Item = &Instance<F>> {
        let children = self.children(object).map(|(_, instance)| instance);
        children.filter(|instance| self.is_fertile(instance.object))
    }
}

/// Largest stretches of fertile instances, by the replacements of objects.
struct Stretches {
    /// Number of the replacement of each object.
    of: Vec<usize>,
    /// Replacements of the fertile children of each replacement, with the logarithms of their largest stretches.
    children: Vec<Vec<(usize, f64)>>,
}

impl Stretches {
    fn of<F: Bounded>(graph: &Graph<F>) -> Self {
        let (of, firsts) = graph.replacements();
        let children = firsts.into_iter().map(|object| {
            let children = graph.fertile(object);
            let mut children: Vec<_> = children.map(|it| (of[it.object], it.length)).collect();
            children.sort_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)));
            children.dedup_by_key(|(child, _)| *child);
            let logarithms = children.into_iter();
            logarithms
                .map(|(child, length)| (child, libm::log(length)))
                .collect()
        });
        Self {
            children: children.collect(),
            of,
        }
    }

    /// Returns the weights of objects: see [`Graph::weights`].
    fn weights(&self, factor: f64, most: f64) -> Option<Vec<f64>> {
        let longest = longest_paths(&self.children, -libm::log(factor), libm::log(most))?;
        Some(self.of.iter().map(|of| libm::exp(longest[*of])).collect())
    }
}

impl<F: Frame> Graph<F> {
    /// Returns, for each behaviour, the maps of its replaced children with the children's behaviours.
    pub(super) fn images(&self, counts: impl Fn(usize) -> bool) -> Vec<Vec<(F::Map, usize)>> {
        let mut images: Vec<Vec<_>> = vec![Vec::new(); self.behaviours().count()];
        for (number, object) in self.behaviours_by_number() {
            let images = &mut images[object.behaviour];
            let mut met = Met::default();
            for (_, instance) in self.children(number) {
                if !self.is_replaced(instance.object) || !counts(instance.object) {
                    continue;
                }
                let image = (
                    *instance.frame.map(),
                    self.objects[instance.object].behaviour,
                );
                if met.is_new(&image) {
                    images.push(image);
                }
            }
        }
        images
    }

    pub(super) fn is_replaced(&self, object: usize) -> bool {
        self.objects[object].successor().is_some()
    }
}

/// Returns the numbers of instances without those that equal an earlier one in object and map, in rising order.
pub(super) fn distinct<F: Frame>(instances: &[Instance<F>]) -> Vec<u32> {
    let mut met = Met::default();
    let is_new = |number: &u32| {
        let instance = &instances[*number as usize];
        met.is_new(&(*instance.frame.map(), instance.object))
    };
    (0..).take(instances.len()).filter(is_new).collect()
}

/// Images that were met: maps, with numbers of what they are applied to.
struct Met<M>(FastMap<u64, Vec<(M, usize)>>);

impl<M> Default for Met<M> {
    fn default() -> Self {
        Self(FastMap::default())
    }
}

impl<M: Affine> Met<M> {
    /// Returns whether no equal image was met before.
    fn is_new(&mut self, image: &(M, usize)) -> bool {
        let alike = self.0.entry(hash(image)).or_default();
        let is_new = !alike.contains(image);
        if is_new {
            alike.push(*image);
        }
        is_new
    }
}

/// Returns a hash of an image: equal images have equal ones.
fn hash<M: Affine>((map, inner): &(M, usize)) -> u64 {
    let mut hasher = FastHasher::default();
    hasher.write_usize(*inner);
    let axes = M::Point::AXES
        .iter()
        .step_by(2)
        .map(|axis| map.apply(*axis));
    for point in axes.chain([map.translation()]) {
        // Negative zero is zero.
        let coordinates = point.coordinates().map(|it| (it + 0.0).to_bits());
        coordinates.into_iter().for_each(|it| hasher.write_u64(it));
    }
    hasher.finish()
}
