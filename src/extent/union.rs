//! Convex hulls of points and of images of convex polygons.

use std::cell::Cell;

use crate::geometry::{DAffine2, DVec2, convex_hull, farthest, rightmost, thinned};
use crate::work;

use super::sectors::{AXES, MANY, Sectors, Support, Whole};

/// Number of points beyond which a hull is computed from directions, however few images have them.
const MANY_POINTS: usize = 4096;

/// Number of directions along which the farthest points are known before a hull is refined.
const DIRECTIONS: u32 = 16;

/// Distance within which the first hull is known, relative to its size, where no other is given.
const FIRST: f64 = 1e-6;

/// Relative rounding error of coordinates.
const ROUNDING: f64 = 1e-15;

/// Relative rounding error of sums of products of coordinates, as a multiple of the sum of their absolute values.
const PRODUCTS: f64 = 4e-15;

/// Number of bounds whose evaluation takes as long as that of a support function.
const BOUNDS_A_SUPPORT: usize = 6;

/// Number of bounds whose evaluation takes as long as a point of a hull.
const BOUNDS_A_POINT: usize = 5;

/// A convex polygon, and images of convex polygons.
pub(super) struct Union<'a> {
    /// Corners of the polygon that is no image, counter-clockwise from the leftmost.
    pub(super) points: &'a [DVec2],
    /// Maps, with the numbers of the polygons to which they are applied.
    pub(super) images: &'a [(DAffine2, usize)],
    /// Corners of the polygons, counter-clockwise from the leftmost.
    pub(super) polygons: &'a [Vec<DVec2>],
    /// Landmarks of the polygons.
    pub(super) landmarks: &'a [Landmarks],
}

/// Rightmost corner of a convex polygon, and a disc about a point of the polygon that contains it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Landmarks {
    pub(super) rightmost: usize,
    centre: DVec2,
    radius: f64,
    /// Upper bound of the distance of the polygon from the origin.
    away: f64,
}

impl Landmarks {
    /// Finds the landmarks of a polygon by its corners, counter-clockwise from the leftmost.
    pub(super) fn of(corners: &[DVec2]) -> Self {
        #[expect(clippy::cast_precision_loss, reason = "corners are held in memory")]
        let share = 1.0 / corners.len().max(1) as f64;
        let centre = corners.iter().map(|corner| *corner * share).sum::<DVec2>();
        let far = corners.iter().map(|corner| corner.distance(centre));
        let radius = far.fold(0.0, f64::max);
        Self {
            rightmost: rightmost(corners),
            centre,
            radius,
            away: centre.length() + radius,
        }
    }

    /// Returns all landmarks of polygons.
    pub(super) fn of_all(polygons: &[Vec<DVec2>]) -> Vec<Self> {
        polygons.iter().map(|corners| Self::of(corners)).collect()
    }

    /// Returns an upper bound of x·u, rounded, over the points x of the polygon, u being the vector. Much faster than to seek
    /// the farthest corner, and larger.
    pub(super) fn at_most(&self, vector: DVec2) -> f64 {
        let length = vector.length();
        self.centre.dot(vector) + (self.radius + PRODUCTS * self.away) * length
    }
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
        let work = farthest.work.get();
        work::count(work);
        Hull {
            corners: convex_hull(corners, 0.0),
            lost,
            work: work / BOUNDS_A_POINT,
        }
    }

    /// Returns the farthest point of the polygon and of some images along a direction; `None` if there is none; and the number
    /// of bounds that were evaluated, or as much work.
    fn reached(
        &self,
        images: impl Iterator<Item = u32>,
        right: usize,
        direction: DVec2,
    ) -> (Option<Reached>, usize) {
        let mut work = 0;
        let own = farthest(self.points, right, direction).map(|corner| Reached {
            point: self.points[corner],
            from: None,
        });
        let mut best = own;
        let mut most = own.map_or(f64::NEG_INFINITY, |reached| reached.point.dot(direction));
        for number in images {
            work += 1;
            if self.at_most(number, direction) < most {
                continue;
            }
            work += BOUNDS_A_SUPPORT;
            let Some(reached) = self.reached_by(number, direction) else {
                continue;
            };
            let along = reached.point.dot(direction);
            if along > most {
                (best, most) = (Some(reached), along);
            }
        }
        (best, work)
    }

    /// Returns an upper bound of how far an image reaches along a direction, rounded: see [`Landmarks::at_most`].
    fn at_most(&self, number: u32, direction: DVec2) -> f64 {
        let (map, polygon) = &self.images[number as usize];
        let landmarks = &self.landmarks[*polygon];
        let shift = map.translation.dot(direction);
        let most = landmarks.at_most(map.matrix2.transpose() * direction);
        let matrix = map.matrix2.x_axis.abs() + map.matrix2.y_axis.abs();
        let terms = matrix.element_sum() * landmarks.away + map.translation.abs().element_sum();
        shift + most + PRODUCTS * terms * direction.abs().element_sum()
    }

    /// Returns the farthest point of an image along a direction.
    fn reached_by(&self, number: u32, direction: DVec2) -> Option<Reached> {
        let (map, polygon) = self.images[number as usize];
        let corners = &self.polygons[polygon];
        let along = map.matrix2.transpose() * direction;
        let corner = farthest(corners, self.landmarks[polygon].rightmost, along)?;
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
    /// Number of bounds that were evaluated, or as much work.
    work: Cell<usize>,
}

impl<'u> Farthest<'u> {
    /// Finds the farthest points along some directions.
    pub(super) fn of(union: &'u Union<'u>) -> Self {
        let all = || (0..).take(union.images.len());
        let right = rightmost(union.points);
        let mut work = 0;
        // The farthest image of one direction reaches far along the next one.
        let mut before = None;
        let starts = (0..DIRECTIONS).filter_map(|number| {
            let angle = std::f64::consts::TAU * f64::from(number) / f64::from(DIRECTIONS);
            let direction = DVec2::new(libm::cos(angle), libm::sin(angle));
            let images = before.into_iter().chain(all());
            let (reached, evaluated) = union.reached(images, right, direction);
            work += evaluated;
            let reached = reached?;
            before = reached.from.map(|(number, _)| number);
            Some(reached.point)
        });
        let mut farthest = Self {
            known: convex_hull(starts.collect(), 0.0),
            union,
            right,
            sectors: None,
            work: Cell::new(work),
        };
        if union.images.len() >= MANY {
            let evaluated = Cell::new(0);
            let reach = |number, direction| {
                evaluated.set(evaluated.get() + BOUNDS_A_SUPPORT);
                farthest.reach(number, direction)
            };
            let at_most = |number, direction| union.at_most(number, direction);
            let whole = farthest.whole(&reach, &at_most);
            let sectors = Sectors::of(all().collect(), &whole);
            let bounds = AXES.len() * union.images.len();
            farthest.work.set(work + bounds + evaluated.get());
            farthest.sectors = Some(sectors);
        }
        farthest
    }

    /// Returns the farthest point along a direction; `None` if there is none.
    pub(super) fn along(&self, direction: DVec2) -> Option<Reached> {
        let reach = |number, direction| self.reach(number, direction);
        let at_most = |number, direction| self.union.at_most(number, direction);
        let whole = self.whole(&reach, &at_most);
        let contenders = { self.sectors.as_ref() }.and_then(|it| it.along(direction, &whole));
        let (reached, work) = match contenders {
            Some(contenders) => {
                let contenders = contenders.iter().copied();
                self.union.reached(contenders, self.right, direction)
            }
            None => {
                let all = (0..).take(self.union.images.len());
                self.union.reached(all, self.right, direction)
            }
        };
        self.work.set(self.work.get() + work);
        reached
    }

    fn whole<'a>(&'a self, reach: Support<'a>, at_most: Support<'a>) -> Whole<'a> {
        Whole {
            corners: &self.known,
            within: 0.0,
            at_most,
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
