//! Convex polygons that contain the subtrees of objects: tight even where maps contract little, or only
//! in products.

use std::cell::OnceCell;

use crate::digraph::components;
use crate::geometry::{
    Bounds, DAffine2, DMat2, DVec2, Frame2, convex_hull, farthest, hausdorff_distance, thinned,
};
use crate::ifs::Shrinking;

use super::bounded::{Bounded, Fineness, Hulls, Own};
use super::contract::{Products, distinct};
use super::policy::followed;
use super::sectors::{MANY, Sectors, Support, Whole};
use super::union::{Landmarks, Union};
use crate::graph::{Graph, Instance};

/// Relative rounding error of coordinates.
const ROUNDING: f64 = 1e-14;

/// Number of rounds before which the limit of the number of mapped corners is twice as high.
const MIN_ROUNDS: usize = 4;
/// Factor by which the error of polygons exceeds the one for which they are thinned.
const FAR: f64 = 64.0;
/// Factor by which the error of polygons must fall before images are dropped, and dropped again.
const NEAR: f64 = 4.0;
/// Number of rounds after which corners are followed to their limits.
const FEW_ROUNDS: usize = 4;
/// Number of mapped corners that take as long as the rest of the work on a polygon in a round.
const OVERHEAD: usize = 16;

/// Polygons that approximate the convex hulls of subtrees.
struct Polygons {
    /// Number of each object's polygon: that of its behaviour, or its own if the object is not replaced.
    of: Vec<usize>,
    /// Corners of the polygons, counter-clockwise; none for an empty subtree.
    corners: Vec<Vec<DVec2>>,
    /// Landmarks of the polygons.
    landmarks: Vec<Landmarks>,
    /// Error of each polygon: the distance within which it contains the subtree; in the limit, the
    /// Hausdorff distance from the hull.
    within: Vec<f64>,
    /// Instances of the behaviours that reach farthest, as far as they were asked for.
    sectors: Vec<OnceCell<Sectors>>,
}

impl Hulls<Frame2> for Polygons {
    fn along(&self, object: usize, vector: DVec2) -> [f64; 2] {
        self.reach(self.of[object], vector)
    }

    fn at_most(&self, object: usize, vector: DVec2) -> f64 {
        self.at_most(self.of[object], vector)
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
        if instances.len() < MANY {
            return None;
        }
        let behaviour = self.of[object];
        let image = |number: u32| {
            let Instance { object, frame, .. } = &instances[number as usize];
            (frame.map(), self.of[*object])
        };
        let reach = |number, vector| self.reach_of(image(number), vector);
        let at_most = |number, vector| self.at_most_of(image(number), vector);
        let whole = self.whole(behaviour, &reach, &at_most);
        let sectors = self.sectors.get(behaviour)?;
        let sectors = sectors.get_or_init(|| Sectors::of(distinct(instances), &whole));
        sectors.along(vector, &whole)
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
    /// Returns an upper bound of x·u over what a polygon stands for, u being the vector, and a lower bound of its maximum in
    /// the limit.
    fn reach(&self, polygon: usize, vector: DVec2) -> [f64; 2] {
        let corners = &self.corners[polygon];
        let along = match farthest(corners, self.landmarks[polygon].rightmost, vector) {
            Some(corner) => corners[corner].dot(vector),
            None => f64::NEG_INFINITY,
        };
        let within = vector.length() * self.within[polygon];
        [along + within, along - within]
    }

    /// Returns the hull that a behaviour's polygon stands for.
    fn whole<'a>(
        &'a self,
        behaviour: usize,
        reach: Support<'a>,
        at_most: Support<'a>,
    ) -> Whole<'a> {
        Whole {
            corners: &self.corners[behaviour],
            within: self.within[behaviour],
            reach,
            at_most,
        }
    }

    /// Returns an upper bound of x·u over the image of what a polygon stands for.
    fn reach_of(&self, (map, polygon): (&DAffine2, usize), vector: DVec2) -> f64 {
        let [most, _] = self.reach(polygon, map.matrix2.transpose() * vector);
        vector.dot(map.translation) + most
    }

    /// Returns an upper bound of x·u over what a polygon stands for, faster than [`reach`](Self::reach) does, and larger.
    fn at_most(&self, polygon: usize, vector: DVec2) -> f64 {
        self.landmarks[polygon].at_most(vector) + vector.length() * self.within[polygon]
    }

    /// Returns that bound over the image of what a polygon stands for.
    fn at_most_of(&self, (map, polygon): (&DAffine2, usize), vector: DVec2) -> f64 {
        let most = self.at_most(polygon, map.matrix2.transpose() * vector);
        vector.dot(map.translation) + most
    }

    /// Drops images that reach farthest along no direction: hulls are those of the others.
    fn drop_inner(&self, images: &mut [Vec<(DAffine2, usize)>]) {
        for (behaviour, images) in images.iter_mut().enumerate() {
            if images.len() < MANY {
                continue;
            }
            let contending = {
                let image = |number: u32| {
                    let (map, polygon) = &images[number as usize];
                    (map, *polygon)
                };
                let reach = |number, vector| self.reach_of(image(number), vector);
                let at_most = |number, vector| self.at_most_of(image(number), vector);
                let whole = self.whole(behaviour, &reach, &at_most);
                Sectors::of((0..).take(images.len()).collect(), &whole).anywhere(&whole)
            };
            let kept = { contending.into_iter() }.map(|number| images[number as usize]);
            *images = kept.collect();
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
        let max_corners = fineness.corners_from_below(images);
        let mut landmarks = Landmarks::of_all(&self.corners);
        for behaviour in order {
            let images = &images[behaviour];
            let leads_to_itself = || images.iter().any(|(_, inner)| *inner == behaviour);
            if sizes[component[behaviour]] > 1 || leads_to_itself() {
                continue;
            }
            let union = Union {
                points: &points[behaviour],
                images,
                polygons: &self.corners,
                landmarks: &landmarks,
            };
            let hull = union.hull(0.0);
            work += hull.work;
            let mut corners = hull.corners;
            let mut bounds = Bounds::EMPTY;
            corners.iter().for_each(|corner| bounds.add(*corner));
            let mut tolerance = fineness.tolerance * bounds.size().max_element();
            while corners.len() > max_corners {
                corners = thinned(&corners, tolerance);
                tolerance *= 2.0;
            }
            landmarks[behaviour] = Landmarks::of(&corners);
            self.corners[behaviour] = corners;
        }
        work
    }

    /// Finds the landmarks of all polygons.
    fn find_landmarks(&mut self) {
        self.landmarks = Landmarks::of_all(&self.corners);
    }
}

impl Bounded for Frame2 {
    const HAS_HULLS: bool = true;

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
    /// point. Let S be the sum, over all n, of the largest stretch of products of n maps. Polygons that one
    /// round changes by ε are within S ε of the fixed point (Banach), regardless of how they were found, and
    /// what they become is within (S − 1) ε: between rounds corners are [followed] to their limits. The hulls
    /// of a round are known to within a distance that adds to ε.
    ///
    /// Images that are certain to fall short of the hull along all directions are dropped: those that are left
    /// have the same fixed point.
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
        let mut images = self.images(is_drawn);
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
        let (mut asked, mut dropped) = (0, f64::INFINITY);
        let (mut tolerance, mut coarse, mut is_fine) = (0.0, 0.25, false);
        for round in 0.. {
            let polygons = &hulls.corners[..images.len()];
            let landmarks = Landmarks::of_all(polygons);
            let mut lost = tolerance;
            let next = points.iter().zip(&images).map(|(points, images)| {
                let union = Union {
                    points,
                    images,
                    polygons,
                    landmarks: &landmarks,
                };
                let hull = union.hull(tolerance);
                work += OVERHEAD + hull.work;
                lost = lost.max(hull.lost);
                hull.corners
            });
            let next: Vec<Vec<DVec2>> = next.collect();
            let ends =
                work > fineness.max_work && round >= MIN_ROUNDS || work > 2 * fineness.max_work;
            let max_corners = fineness.corners_of(&images);
            if next.iter().any(|corners| corners.len() > max_corners) {
                coarse *= 1.5;
                tolerance *= 1.5;
            }
            let is_asked = ends || round == asked;
            let changes = { next.iter().zip(polygons) }.map(|(a, b)| hausdorff_distance(a, b));
            let changes: Vec<f64> = changes
                .take(if is_asked { usize::MAX } else { 0 })
                .collect();
            hulls.corners.splice(..images.len(), next);
            if is_asked {
                asked += 1 + round / 4;
                // The remaining change is that of thinning.
                let settled = is_fine && changes.iter().all(|it| *it <= 2.0 * lost);
                let change = changes.iter().zip(&behaviours);
                let change = change.map(|(change, weight)| (change + lost) / weight);
                let change = change.fold(0.0, f64::max);
                // Where nothing is known yet, nothing is known of images either.
                let change = match change.is_finite() {
                    true => (sum - 1.0) * change,
                    false => change,
                };
                for (within, weight) in hulls.within.iter_mut().zip(&behaviours) {
                    *within = change * weight + lost;
                }
                let corners = || hulls.corners[..images.len()].iter().flatten();
                let size = corners().map(|corner| corner.distance(self.middle));
                let away = corners().map(|corner| corner.length());
                let [size, away] = [size.fold(0.0, f64::max), away.fold(0.0, f64::max)];
                let wanted = fineness.tolerance * size + ROUNDING * away;
                let within = &hulls.within[..images.len()];
                let error = within.iter().copied().fold(0.0, f64::max);
                let is_known = within.iter().all(|it| it.is_finite());
                let is_close = within.iter().all(|within| *within <= wanted);
                hulls.find_landmarks();
                if ends || settled || is_close {
                    return is_known.then_some(hulls);
                }
                // Polygons far from the hulls need few corners.
                is_fine = error / FAR <= wanted;
                tolerance = coarse * (error / FAR).max(wanted) / sum;
                if error <= size / NEAR && error <= dropped / NEAR {
                    dropped = error;
                    hulls.drop_inner(&mut images);
                }
            }
            if round >= FEW_ROUNDS {
                let polygons = &hulls.corners[..images.len()];
                work += followed_work(polygons, &images, &points);
                let followed = followed(polygons, &images, &points).into_iter();
                let joined = polygons.iter().zip(followed).map(|(corners, others)| {
                    let all = [&corners[..], &others].concat();
                    thinned(&convex_hull(all, 0.0), tolerance)
                });
                let joined: Vec<Vec<DVec2>> = joined.collect();
                hulls.corners.splice(..images.len(), joined);
            }
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
            landmarks: Vec::new(),
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
        let points = self.base_elements()[self.objects[object].base_element].hull_points();
        if pad > 0.0 {
            points.flat_map(|point| around(point, pad)).collect()
        } else {
            points.collect()
        }
    }
}

/// Returns the number of points of hulls that take as long as following the corners of polygons.
fn followed_work<I, P>(polygons: &[Vec<DVec2>], images: &[Vec<I>], points: &[Vec<P>]) -> usize {
    /// Number of origins that take as long as a point.
    const ORIGINS: usize = 4;
    let origins = images
        .iter()
        .zip(points)
        .map(|(images, points)| images.len() + points.len());
    let works = polygons.iter().zip(origins);
    works
        .map(|(corners, origins)| corners.len() * origins)
        .sum::<usize>()
        / ORIGINS
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

#[cfg(test)]
mod tests;
