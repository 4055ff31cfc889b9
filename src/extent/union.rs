//! Convex hulls of points and of images of convex polygons.

use std::cell::Cell;

use crate::geometry::{DAffine2, DVec2, convex_hull, thinned};

use super::policy::{farthest, rightmost};
use super::sectors::{MANY, Sectors, Whole};

/// Number of points beyond which a hull is computed from directions, however few images have them.
const MANY_POINTS: usize = 4096;

/// Number of directions along which the farthest points are known before a hull is refined.
const DIRECTIONS: u32 = 16;

/// Distance within which the first hull is known, relative to its size, where no other is given.
const FIRST: f64 = 1e-6;

/// Relative rounding error of coordinates.
const ROUNDING: f64 = 1e-15;

/// Number of support functions whose evaluation takes as long as a point of a hull.
const EVALUATIONS: usize = 8;

/// A convex polygon, and images of convex polygons.
pub(super) struct Union<'a> {
    /// Corners of the polygon that is no image, counter-clockwise from the leftmost.
    pub(super) points: &'a [DVec2],
    /// Maps, with the numbers of the polygons to which they are applied.
    pub(super) images: &'a [(DAffine2, usize)],
    /// Corners of the polygons, counter-clockwise from the leftmost.
    pub(super) polygons: &'a [Vec<DVec2>],
    /// Numbers of the rightmost corners of the polygons.
    pub(super) rightmost: &'a [usize],
}

/// A polygon that approximates a convex hull from inside.
pub(super) struct Hull {
    /// Corners, counter-clockwise from the leftmost.
    pub(super) corners: Vec<DVec2>,
    /// Distance within which the polygon contains the hull.
    pub(super) lost: f64,
    /// Number of points that were looked at, or as much work.
    pub(super) work: usize,
}

impl Union<'_> {
    /// Computes the convex hull to within `tolerance`. If that is 0, the hull of many images is known to a millionth of its
    /// size.
    pub(super) fn hull(&self, tolerance: f64) -> Hull {
        let corners = self
            .images
            .iter()
            .map(|(_, polygon)| self.polygons[*polygon].len());
        if self.images.len() >= MANY || corners.sum::<usize>() > MANY_POINTS {
            return self.hull_by_directions(tolerance);
        }
        let mut all = self.points.to_vec();
        for (map, polygon) in self.images {
            let corners = self.polygons[*polygon].iter();
            all.extend(corners.map(|corner| map.transform_point2(*corner)));
        }
        Hull {
            work: all.len(),
            corners: thinned(&convex_hull(all, 0.0), tolerance),
            lost: tolerance,
        }
    }

    /// Computes the hull from farthest points along directions: two neighbours are joined if no point is farther than
    /// `tolerance` beyond their chord, and otherwise the farthest one comes between them (the sandwich algorithm with the
    /// chord rule, Rote 1992).
    fn hull_by_directions(&self, tolerance: f64) -> Hull {
        let farthest = Farthest::of(self);
        let known = &farthest.known;
        let size = known.iter().map(|corner| corner.distance(known[0]));
        let size = size.fold(0.0, f64::max);
        let away = known.iter().map(|corner| corner.length());
        let lost = match tolerance > 0.0 {
            true => tolerance,
            false => FIRST * size,
        };
        let lost = lost.max(ROUNDING * away.fold(0.0, f64::max));
        let mut corners = Vec::new();
        let mut ends: Vec<DVec2> = known.iter().rev().copied().collect();
        let mut last = known.last().copied();
        while let (Some(from), Some(to)) = (last, ends.last().copied()) {
            let outward = -(to - from).normalize_or_zero().perp();
            let beyond = { (outward != DVec2::ZERO).then(|| farthest.along(outward)) }.flatten();
            let beyond = beyond.map(|reached| reached.point);
            match beyond.filter(|point| (point - from).dot(outward) > lost) {
                Some(point) => ends.push(point),
                None => {
                    corners.push(to);
                    last = ends.pop();
                }
            }
        }
        Hull {
            corners: convex_hull(corners, 0.0),
            lost,
            work: farthest.work.get() / EVALUATIONS,
        }
    }

    /// Returns the farthest point of the polygon and of some images along a direction; `None` if there is none.
    fn reached(
        &self,
        images: impl Iterator<Item = u32>,
        right: usize,
        direction: DVec2,
    ) -> Option<Reached> {
        let own = farthest(self.points, right, direction).map(|corner| Reached {
            point: self.points[corner],
            from: None,
        });
        let of_images = images.filter_map(|number| self.reached_by(number, direction));
        let mut best = None;
        let mut most = f64::NEG_INFINITY;
        for reached in own.into_iter().chain(of_images) {
            let along = reached.point.dot(direction);
            if along > most {
                (best, most) = (Some(reached), along);
            }
        }
        best
    }

    /// Returns the farthest point of an image along a direction.
    fn reached_by(&self, number: u32, direction: DVec2) -> Option<Reached> {
        let (map, polygon) = self.images[number as usize];
        let corners = &self.polygons[polygon];
        let along = map.matrix2.transpose() * direction;
        let corner = farthest(corners, self.rightmost[polygon], along)?;
        Some(Reached {
            point: map.transform_point2(corners[corner]),
            from: Some((number, corner)),
        })
    }
}

/// Farthest point of a union along a direction.
#[derive(Clone, Copy)]
pub(super) struct Reached {
    pub(super) point: DVec2,
    /// Number of the image to which it belongs, and of the corner of its polygon; `None` if it belongs to none.
    pub(super) from: Option<(u32, usize)>,
}

/// Search for the farthest points of a union, which looks at few of many images.
pub(super) struct Farthest<'u> {
    union: &'u Union<'u>,
    /// Number of the rightmost corner of the polygon that is no image.
    right: usize,
    /// Corners of the hull of farthest points along evenly spaced directions.
    known: Vec<DVec2>,
    /// The images, if they are many.
    sectors: Option<Sectors>,
    /// Number of support functions that were evaluated.
    work: Cell<usize>,
}

impl<'u> Farthest<'u> {
    /// Finds the farthest points along some directions.
    pub(super) fn of(union: &'u Union<'u>) -> Self {
        let all = || (0..).take(union.images.len());
        let right = rightmost(union.points);
        let starts = (0..DIRECTIONS).filter_map(|number| {
            let angle = std::f64::consts::TAU * f64::from(number) / f64::from(DIRECTIONS);
            let direction = DVec2::new(libm::cos(angle), libm::sin(angle));
            Some(union.reached(all(), right, direction)?.point)
        });
        let mut farthest = Self {
            union,
            right,
            known: convex_hull(starts.collect(), 0.0),
            sectors: None,
            work: Cell::new(union.images.len() * (DIRECTIONS as usize + 4)),
        };
        if union.images.len() >= MANY {
            let reach = |number, direction| farthest.reach(number, direction);
            let sectors = Sectors::of(all().collect(), &farthest.whole(&reach));
            farthest.sectors = Some(sectors);
        }
        farthest
    }

    /// Returns the farthest point along a direction; `None` if there is none.
    pub(super) fn along(&self, direction: DVec2) -> Option<Reached> {
        let reach = |number, direction| self.reach(number, direction);
        let whole = self.whole(&reach);
        let contenders = { self.sectors.as_ref() }.and_then(|it| it.along(direction, &whole));
        let count = contenders.map_or(self.union.images.len(), <[u32]>::len);
        self.work.set(self.work.get() + count);
        match contenders {
            Some(contenders) => {
                let contenders = contenders.iter().copied();
                self.union.reached(contenders, self.right, direction)
            }
            None => {
                let all = (0..).take(self.union.images.len());
                self.union.reached(all, self.right, direction)
            }
        }
    }

    fn whole<'a>(&'a self, reach: &'a dyn Fn(u32, DVec2) -> f64) -> Whole<'a> {
        Whole {
            corners: &self.known,
            within: 0.0,
            reach,
        }
    }

    fn reach(&self, number: u32, direction: DVec2) -> f64 {
        let reached = self.union.reached_by(number, direction);
        reached.map_or(f64::NEG_INFINITY, |reached| reached.point.dot(direction))
    }
}

#[cfg(test)]
mod tests;
