//! Convex polygons that contain the subtrees of objects: tight even where maps contract little, or only
//! in products.

use std::cell::OnceCell;

use crate::digraph::components;
use crate::geometry::{
    Bounds, DAffine2, DMat2, DVec2, Frame2, convex_hull, hausdorff_distance, thinned,
};
use crate::ifs::Shrinking;

use super::bounded::{Bounded, Fineness, Hulls, Own};
use super::contract::Products;
use super::policy::{farthest, followed, rightmost};
use super::sectors::Sectors;
use crate::graph::{Graph, Instance};

/// Relative rounding error of coordinates.
const ROUNDING: f64 = 1e-14;

/// Number of rounds before which the limit of the number of mapped corners is twice as high.
const MIN_ROUNDS: usize = 4;
/// Factor by which the error of polygons exceeds the one for which they are thinned.
const FAR: f64 = 64.0;
/// Number of rounds after which corners are followed to their limits.
const FEW_ROUNDS: usize = 4;

/// Polygons that approximate the convex hulls of subtrees.
struct Polygons {
    /// Number of each object's polygon: that of its behaviour, or its own if the object is not replaced.
    of: Vec<usize>,
    /// Corners of the polygons, counter-clockwise; none for an empty subtree.
    corners: Vec<Vec<DVec2>>,
    /// Number of the rightmost corner of each polygon; the leftmost corner is the first.
    rightmost: Vec<usize>,
    /// Error of each polygon: the distance within which it contains the subtree; in the limit, the
    /// Hausdorff distance from the hull.
    within: Vec<f64>,
    /// Instances of the behaviours that reach farthest, as far as they were asked for; `None` where they are few.
    sectors: Vec<OnceCell<Option<Sectors>>>,
}

impl Hulls<Frame2> for Polygons {
    fn along(&self, object: usize, vector: DVec2) -> [f64; 2] {
        let along = self.farthest(object, vector);
        let within = vector.length() * self.within[self.of[object]];
        [along + within, along - within]
    }

    fn radius(&self, object: usize, centre: DVec2) -> f64 {
        let corners = self.corners(object).iter();
        let far = corners.map(|corner| corner.distance(centre));
        far.fold(0.0, f64::max) + self.within[self.of[object]]
    }

    fn corners(&self, object: usize) -> &[DVec2] {
        &self.corners[self.of[object]]
    }

    fn contenders(&self, object: usize, instances: &[Instance], vector: DVec2) -> Option<&[u32]> {
        let behaviour = self.of[object];
        let within = self.within[behaviour];
        let sectors = self.sectors.get(behaviour)?;
        let sectors = sectors.get_or_init(|| Sectors::of(self, object, within, instances));
        sectors.as_ref()?.along(vector)
    }

    fn spared(&self, instances: &[Instance], fineness: Fineness) -> f64 {
        let extents = instances.iter().map(|instance| {
            let mut bounds = Bounds::EMPTY;
            for corner in self.corners(instance.object) {
                bounds.add(instance.frame.apply(*corner));
            }
            let within = self.within[self.of[instance.object]];
            bounds.size().max_element() - 2.0 * instance.length * within
        });
        fineness.spared * extents.fold(0.0, f64::max)
    }
}

impl Polygons {
    fn farthest(&self, object: usize, vector: DVec2) -> f64 {
        let corners = self.corners(object);
        let right = self.rightmost[self.of[object]];
        match farthest(corners, right, vector) {
            Some(corner) => corners[corner].dot(vector),
            None => f64::NEG_INFINITY,
        }
    }

    /// Replaces the polygons of behaviours that do not lead back to themselves by the hulls of their parts, from the bottom
    /// up; returns the number of corners that are mapped.
    fn start_from_below(
        &mut self,
        images: &[Vec<(DAffine2, usize)>],
        points: &[Vec<DVec2>],
        fineness: Fineness,
    ) -> usize {
        let targets = images
            .iter()
            .map(|images| images.iter().map(|it| it.1).collect());
        let component = components(&targets.collect::<Vec<_>>());
        let mut sizes = vec![0; images.len()];
        component.iter().for_each(|part| sizes[*part] += 1);
        let mut order: Vec<usize> = (0..images.len()).collect();
        order.sort_by_key(|behaviour| component[*behaviour]);
        let mut work = 0;
        for behaviour in order {
            let images = &images[behaviour];
            let leads_to_itself = || images.iter().any(|(_, inner)| *inner == behaviour);
            if sizes[component[behaviour]] > 1 || leads_to_itself() {
                continue;
            }
            let mut all = points[behaviour].clone();
            for (map, inner) in images {
                let corners = self.corners[*inner].iter();
                all.extend(corners.map(|corner| map.transform_point2(*corner)));
            }
            work += all.len();
            let mut corners = convex_hull(all, 0.0);
            let mut bounds = Bounds::EMPTY;
            corners.iter().for_each(|corner| bounds.add(*corner));
            let mut tolerance = fineness.tolerance * bounds.size().max_element();
            while corners.len() > fineness.max_corners {
                corners = thinned(&corners, tolerance);
                tolerance *= 2.0;
            }
            self.corners[behaviour] = corners;
        }
        work
    }

    fn sorted(mut self) -> Self {
        self.rightmost = { self.corners.iter() }.map(|it| rightmost(it)).collect();
        self
    }
}

impl Bounded for Frame2 {
    fn hulls(
        graph: &Graph,
        own: &Own<'_>,
        drawn: Option<&[bool]>,
        fineness: Fineness,
    ) -> Option<Box<dyn Hulls<Self>>> {
        let points = |object: usize| match own {
            Own::Outlines(pads) => graph.corners(object, pads[object]),
            Own::Discs(radii) => around(graph.middle, radii[object]).collect(),
        };
        let polygons = graph.polygons(&points, drawn, fineness)?;
        Some(Box::new(polygons))
    }

    fn products(linear: &[Vec<(DMat2, usize)>]) -> Option<f64> {
        let shrinking = Shrinking::found(linear)?;
        Some(shrinking.sum)
    }
}

/// Function that returns points whose convex hull contains an object by itself.
type Points<'a> = dyn Fn(usize) -> Vec<DVec2> + 'a;

impl Graph {
    /// Returns polygons that contain the subtrees of objects: at every step, or in the limit if `drawn`
    /// states which objects are drawn there.
    ///
    /// The hulls K(o) = conv(own(o) ∪ ⋃ f(K(c))) over the instances c in the place of o are a fixed
    /// point. Polygons that one round changes by ε are within ε times the sum of the stretches of
    /// products of maps of that fixed point (Banach), regardless of how they were found: between rounds
    /// corners are [followed] to their limits.
    ///
    /// `None` if no products are found that contract, and for graphs that are not plain.
    fn polygons(
        &self,
        own: &Points<'_>,
        drawn: Option<&[bool]>,
        fineness: Fineness,
    ) -> Option<Polygons> {
        if !self.is_plain() || self.resets().contains(&true) {
            return None;
        }
        let Products { sum, weights } = self.products()?;
        let is_drawn = |object: usize| drawn.is_none_or(|drawn| drawn[object]);
        let images = self.images(is_drawn);
        let (mut hulls, points) = self.points_of_hulls(own, drawn, images.len());
        let mut behaviours = vec![1.0; images.len()];
        for (object, weight) in self.objects.iter().zip(weights) {
            behaviours[object.behaviour] = weight;
        }
        for (behaviour, corners) in hulls.corners[..images.len()].iter_mut().enumerate() {
            // The initial polygon is arbitrary: it vanishes in the limit.
            let is_empty = points[behaviour].is_empty() && images[behaviour].is_empty();
            corners.extend((!is_empty).then_some(self.middle));
        }
        let mut work = hulls.start_from_below(&images, &points, fineness);
        let mut asked = 0;
        let (mut tolerance, mut coarse, mut is_fine) = (0.0, 0.25, false);
        for round in 0.. {
            let polygons = &hulls.corners[..images.len()];
            let next = points.iter().zip(&images).map(|(points, images)| {
                let images = images.iter().flat_map(|(map, behaviour)| {
                    let corners = polygons[*behaviour].iter();
                    corners.map(|corner| map.transform_point2(*corner))
                });
                let points: Vec<DVec2> = points.iter().copied().chain(images).collect();
                work += points.len();
                thinned(&convex_hull(points, 0.0), tolerance)
            });
            let next: Vec<Vec<DVec2>> = next.collect();
            let ends =
                work > fineness.max_work && round >= MIN_ROUNDS || work > 2 * fineness.max_work;
            if next
                .iter()
                .any(|corners| corners.len() > fineness.max_corners)
            {
                coarse *= 1.5;
                tolerance *= 1.5;
            }
            if ends || round == asked {
                asked += 1 + round / 4;
                let changes: Vec<f64> = { next.iter().zip(polygons) }
                    .map(|(a, b)| hausdorff_distance(a, b))
                    .collect();
                // The remaining change is that of thinning.
                let settled = is_fine && changes.iter().all(|it| *it <= 2.0 * tolerance);
                let change = changes.iter().zip(&behaviours);
                let change = change.map(|(change, weight)| (change + tolerance) / weight);
                let change = sum * change.fold(0.0, f64::max);
                for (within, weight) in hulls.within.iter_mut().zip(&behaviours) {
                    *within = change * weight;
                }
                let corners = || next.iter().flatten();
                let size = corners().map(|corner| corner.distance(self.middle));
                let away = corners().map(|corner| corner.length());
                let [size, away] = [size.fold(0.0, f64::max), away.fold(0.0, f64::max)];
                let wanted = fineness.tolerance * size + ROUNDING * away;
                let within = &hulls.within[..images.len()];
                if ends || settled || within.iter().all(|within| *within <= wanted) {
                    let is_known = within.iter().all(|it| it.is_finite());
                    return is_known.then(|| hulls.sorted());
                }
                // Polygons far from the hulls need few corners.
                let error = within.iter().copied().fold(0.0, f64::max) / FAR;
                is_fine = error <= wanted;
                tolerance = coarse * error.max(wanted) / sum;
            }
            let next = if round < FEW_ROUNDS {
                next
            } else {
                let followed = followed(&next, &images, &points);
                let joined = next.into_iter().zip(followed);
                joined
                    .map(|(corners, others)| {
                        thinned(&convex_hull([corners, others].concat(), 0.0), tolerance)
                    })
                    .collect()
            };
            hulls.corners.splice(..images.len(), next);
        }
        None
    }

    /// Returns the polygons of objects that are not replaced, numbered after those of the behaviours, and
    /// for each behaviour the points that are not images of polygons: those of children that are not
    /// replaced and, at every step, those of the objects themselves.
    fn points_of_hulls(
        &self,
        own: &Points<'_>,
        drawn: Option<&[bool]>,
        behaviours: usize,
    ) -> (Polygons, Vec<Vec<DVec2>>) {
        let mut hulls = Polygons {
            of: Vec::new(),
            corners: vec![Vec::new(); behaviours],
            rightmost: Vec::new(),
            within: vec![f64::INFINITY; behaviours],
            sectors: (0..behaviours).map(|_| OnceCell::new()).collect(),
        };
        for (number, object) in self.objects.iter().enumerate() {
            if self.is_replaced(number) {
                hulls.of.push(object.behaviour);
                continue;
            }
            hulls.of.push(hulls.corners.len());
            let is_drawn = drawn.is_none_or(|drawn| drawn[number]);
            let points = is_drawn.then(|| own(number));
            hulls
                .corners
                .push(convex_hull(points.unwrap_or_default(), 0.0));
            hulls.within.push(0.0);
        }
        let mut points = vec![Vec::new(); behaviours];
        for (number, object) in self.behaviours_by_number() {
            for (_, instance) in self.children(number) {
                if !self.is_replaced(instance.object) {
                    let corners = hulls.corners(instance.object).iter();
                    let frame = instance.frame;
                    points[object.behaviour].extend(corners.map(|corner| frame.apply(*corner)));
                }
            }
        }
        if drawn.is_none() {
            for (number, object) in self.objects.iter().enumerate() {
                if self.is_replaced(number) {
                    points[object.behaviour].extend(own(number));
                }
            }
        }
        let points = points.into_iter().map(|points| convex_hull(points, 0.0));
        (hulls, points.collect())
    }

    /// Returns points whose convex hull contains an object's outline with padding.
    fn corners(&self, object: usize, pad: f64) -> Vec<DVec2> {
        let points = self.base_elements()[self.objects[object].base_element].control_points();
        if pad > 0.0 {
            points.flat_map(|point| around(point, pad)).collect()
        } else {
            points.collect()
        }
    }
}

/// Iterates over the corners of a polygon around a disc.
fn around(centre: DVec2, radius: f64) -> impl Iterator<Item = DVec2> {
    const CORNERS: u32 = 32;
    let turn = std::f64::consts::TAU / f64::from(CORNERS);
    let far = radius / libm::cos(turn / 2.0);
    (0..CORNERS).map(move |corner| {
        let angle = turn * f64::from(corner);
        centre + far * DVec2::new(libm::cos(angle), libm::sin(angle))
    })
}
