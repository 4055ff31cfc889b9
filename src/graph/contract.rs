//! Whether maps contract that may not do so one by one, but one after the other.

use crate::geometry::DVec2;
use crate::ifs::Shrinking;

use super::{Graph, Instance, Replacement};

/// How much products of maps stretch: with objects' weights u, one from an object c to one o that it is
/// in, over n instances, no more than N(n) u(o) / u(c).
pub(crate) struct Products {
    /// No less than the sum of N(n) over all n.
    pub(crate) sum: f64,
    /// By object, 1 or more.
    pub(crate) weights: Vec<f64>,
}

impl Graph {
    /// Whether fertile elements become smaller than any length, by the maps of instances alone or by
    /// their products.
    #[must_use]
    pub fn contracts(&self) -> bool {
        self.products().is_some()
    }

    /// How much products stretch; `None` if they are not found to contract.
    pub(crate) fn products(&self) -> Option<Products> {
        let ratio = self.longest_ratio();
        let even = |sum| Products {
            sum,
            weights: vec![1.0; self.objects.len()],
        };
        if ratio < 1.0 {
            return Some(even(1.0 / (1.0 - ratio)));
        }
        self.products_by_weights()
            .or_else(|| self.products_by_hulls().map(even))
    }

    /// Where single maps do not contract but their products do: the radius about `centre`, in any
    /// object's unit frame, of all that becomes of an object. `own` is the radius of all that
    /// objects draw themselves and that kept instances do. `None` where there is no need to try, or
    /// products are not found that contract.
    pub(super) fn reach_by_products(&self, centre: DVec2, own: f64) -> Option<f64> {
        if self.longest_ratio() < 1.0 {
            return None;
        }
        let Products { sum, weights } = self.products()?;
        let away = |object: usize| {
            let away = self
                .fertile(object)
                .map(|instance| (instance.frame.map.transform_point2(centre) - centre).length());
            away.fold(0.0, f64::max) + own
        };
        let far = weights.iter().enumerate();
        let far = far.map(|(object, weight)| away(object) / weight);
        let longest = weights.iter().copied().fold(0.0, f64::max);
        Some(far.fold(0.0, f64::max) * sum * longest)
    }

    /// Where every way that leads back to its object shrinks by what its single maps stretch, as in
    /// structures whose objects are drawn to scales of their own: weights such that no instance stretches
    /// by more than λ u(o) / u(c), λ < 1. They are the largest products of stretches over λ along any way
    /// (Bellman 1958).
    fn products_by_weights(&self) -> Option<Products> {
        const FACTORS: [f64; 8] = [0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999];
        let count = self.objects.len();
        let weights = |factor: f64| {
            let mut weights = vec![1.0f64; count];
            for _ in 0..=count {
                let mut changes = false;
                for object in (0..count).rev() {
                    let grown = self
                        .fertile(object)
                        .map(|instance| instance.length / factor * weights[instance.object]);
                    let most = grown.fold(weights[object], f64::max);
                    changes |= most > weights[object];
                    weights[object] = most;
                }
                if !changes {
                    let sum = 1.0 / (1.0 - factor);
                    return Some(Products { sum, weights });
                }
                if weights.iter().any(|weight| *weight > 1e100) {
                    break;
                }
            }
            None
        };
        FACTORS.into_iter().find_map(weights)
    }

    /// The sum of the most that products of n maps stretch anything, over all n.
    fn products_by_hulls(&self) -> Option<f64> {
        if !self.affine || !self.is_plain() {
            return None;
        }
        let images = self.images(|_| true);
        let linear = images.iter().map(|images| {
            let linear = images.iter().map(|(map, inner)| (map.matrix2, *inner));
            linear.collect()
        });
        let shrinking = Shrinking::found(&linear.collect::<Vec<_>>())?;
        Some(shrinking.sum)
    }

    /// The instances of an object that may be replaced.
    fn fertile(&self, object: usize) -> impl Iterator<Item = &Instance> {
        let children = self.children(object).map(|(_, instance)| instance);
        children.filter(|instance| {
            !matches!(self.objects[instance.object].replacement, Replacement::Kept)
        })
    }
}
