//! Whether maps contract that may not do so one by one, but one after the other.

use crate::geometry::{DAffine2, DVec2};

use super::{Graph, Instance, Replacement};

/// More products than this are not tried.
const MOST_PRODUCTS: usize = 100_000;

/// Products are prolonged until they stretch by less than this; if that takes too many, by less
/// than the next.
const SHORT_ENOUGH: [f64; 3] = [0.5, 0.9, 0.999];

impl Graph {
    /// Whether fertile elements become smaller than any length, by the maps of instances alone or by
    /// their products.
    #[must_use]
    pub fn contracts(&self) -> bool {
        self.longest_ratio() < 1.0 || self.reach_by_products(DVec2::ZERO, 0.0).is_some()
    }

    /// Where single maps do not contract but their products do: the radius about `centre`, in any
    /// object's unit frame, of all that becomes of an object. `own` is the radius of all that
    /// objects draw themselves and that kept instances do. `None` where there is no need to try, or
    /// products are not found that contract.
    ///
    /// Every path of instances begins with a product that stretches by some ratio r < 1 at most. With
    /// s the farthest that a beginning of such a product leads, all lies within s / (1 - r).
    pub(super) fn reach_by_products(&self, centre: DVec2, own: f64) -> Option<f64> {
        if self.longest_ratio() < 1.0 {
            return None;
        }
        if let Some(reach) = self.reach_by_weights(centre, own) {
            return Some(reach);
        }
        if !self.affine {
            return None;
        }
        let reach = SHORT_ENOUGH.map(|enough| move || self.reach_to(centre, own, enough));
        reach.into_iter().find_map(|reach| reach())
    }

    /// The same where every way that leads back to its object shrinks by what its single maps stretch,
    /// as in structures whose objects are drawn to scales of their own: with weights u such that no
    /// instance stretches by more than λ u(o) / u(c) from its object c to the one o that it is in,
    /// λ < 1. They are the largest products of stretches over λ along any way (Bellman 1958).
    fn reach_by_weights(&self, centre: DVec2, own: f64) -> Option<f64> {
        const FACTORS: [f64; 4] = [0.5, 0.9, 0.99, 0.999];
        let fertile = |object: usize| {
            let children = self.children(object).map(|(_, instance)| instance);
            children.filter(|instance| {
                !matches!(self.objects[instance.object].replacement, Replacement::Kept)
            })
        };
        let count = self.objects.len();
        let weights = |factor: f64| {
            let mut weights = vec![1.0f64; count];
            for _ in 0..=count {
                let mut changes = false;
                for object in (0..count).rev() {
                    let grown = fertile(object)
                        .map(|instance| instance.length / factor * weights[instance.object]);
                    let most = grown.fold(weights[object], f64::max);
                    changes |= most > weights[object];
                    weights[object] = most;
                }
                if !changes {
                    return Some((factor, weights));
                }
                if weights.iter().any(|weight| *weight > 1e100) {
                    break;
                }
            }
            None
        };
        let (factor, weights) = FACTORS.into_iter().find_map(weights)?;
        let away = |object: usize| {
            let away = fertile(object)
                .map(|instance| (instance.frame.map.transform_point2(centre) - centre).length());
            away.fold(0.0, f64::max) + own
        };
        let far = (0..count).map(|object| away(object) / weights[object]);
        let longest = weights.iter().copied().fold(0.0, f64::max);
        Some(far.fold(0.0, f64::max) / (1.0 - factor) * longest)
    }

    /// Points of what every object comes to in the limit, if it contracts: a point inside each of the
    /// instances that take its place.
    pub(super) fn limit_points(&self) -> Vec<Vec<DVec2>> {
        /// As long a way leads to a point to the last digit, unless maps contract very little.
        const MOST_STEPS: usize = 2_000;
        let fertile = |object: usize| {
            let children = self.children(object).map(|(_, instance)| instance);
            children.filter(|instance| {
                !matches!(self.objects[instance.object].replacement, Replacement::Kept)
            })
        };
        let mut points = vec![self.middle; self.objects.len()];
        for _ in 0..MOST_STEPS {
            let mut has_moved = false;
            // Children have larger numbers than those that reach them first.
            for object in (0..points.len()).rev() {
                let Some(first) = fertile(object).next() else {
                    continue;
                };
                let point = first.frame.map.transform_point2(points[first.object]);
                has_moved |= point != points[object];
                points[object] = point;
            }
            if !has_moved {
                break;
            }
        }
        let inside = |instance: &Instance| {
            let point = points[instance.object];
            instance.frame.map.transform_point2(point)
        };
        let all = 0..points.len();
        all.map(|object| fertile(object).map(inside).collect())
            .collect()
    }

    fn reach_to(&self, centre: DVec2, own: f64, enough: f64) -> Option<f64> {
        let (mut far, mut longest, mut tried) = (own, 0.0f64, 0);
        let mut open: Vec<(usize, DAffine2)> = self
            .behaviours_by_number()
            .map(|object| (object, DAffine2::IDENTITY))
            .collect();
        while let Some((object, product)) = open.pop() {
            for (_, instance) in self.children(object) {
                tried += 1;
                if tried > MOST_PRODUCTS {
                    return None;
                }
                let replacement = &self.objects[instance.object].replacement;
                if matches!(replacement, Replacement::Kept) {
                    continue;
                }
                let mut frame = instance.frame;
                frame.map = product * frame.map;
                let stretch = frame.stretch();
                let away = (frame.map.transform_point2(centre) - centre).length();
                far = far.max(away + stretch * own);
                if stretch < enough {
                    longest = longest.max(stretch);
                } else {
                    open.push((instance.object, frame.map));
                }
            }
        }
        Some(far / (1.0 - longest))
    }

    /// The number of the first object of every behaviour.
    fn behaviours_by_number(&self) -> impl Iterator<Item = usize> {
        let mut next = 0;
        self.objects
            .iter()
            .enumerate()
            .filter_map(move |(number, object)| {
                let first = object.behaviour == next;
                next += usize::from(first);
                first.then_some(number)
            })
    }
}
