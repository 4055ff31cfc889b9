//! A shape with the distances that copies are judged by.

use std::cell::Cell;
use std::num::NonZero;

use crate::Bits;
use crate::geometry::{DAffine2, DVec2};
use crate::morphology::{DistanceMap, NoDistances, SkeletonPoint};
use crate::saturating::{real, whole};

use super::super::{Disk, shape};
use super::copy::ShapeCopy;

/// Distance in pixels within which two boundaries are the same.
const NEAR: f64 = 1.5;

/// Share of a copy's boundary that may lie farther outside the shape.
const MAX_OUTSIDE: f64 = 0.04;

/// A shape, its boundary and distances.
pub(super) struct Ground<'a> {
    pub(super) bits: &'a Bits,
    pub(super) threads: NonZero<usize>,
    /// Centres of the pixels of the shape with a neighbour outside.
    pub(super) boundary: Vec<DVec2>,
    /// Distances to the boundary.
    edge: DistanceMap,
    /// Distances to the shape.
    inside: DistanceMap,
    /// Centres of the pixels outside with a neighbour inside.
    rim: Vec<DVec2>,
    /// Number of copies whose gain was computed.
    pub(super) evaluations: Cell<usize>,
    /// Corners of the box of the shape.
    extent: [DVec2; 2],
}

impl<'a> Ground<'a> {
    pub(super) fn new(bits: &'a Bits, threads: NonZero<usize>) -> Result<Self, NoDistances> {
        let (width, height) = (bits.width(), bits.height());
        let roomy = bits.window([-1, -1], width + 2, height + 2);
        let beside = |bits: &Bits| {
            let mut all = Bits::new(width + 2, height + 2);
            for step in [[-1, 0], [1, 0], [0, -1], [0, 1]] {
                all.add(&bits.window(step, width + 2, height + 2));
            }
            all
        };
        let mut boundary = beside(&roomy.complement());
        boundary.keep(&roomy);
        let mut rim = beside(&roomy);
        rim.remove(&roomy);
        let points = |bits: &Bits| {
            let points = bits.set_boxes().map(|[column, row]| {
                DVec2::new(real(column) - 0.5, real(height) - real(row) + 0.5)
            });
            points.collect()
        };
        let boundary_points: Vec<DVec2> = points(&boundary);
        let all = boundary_points.iter().copied();
        let extent = [
            all.clone().fold(DVec2::INFINITY, DVec2::min) - 0.5,
            all.fold(DVec2::NEG_INFINITY, DVec2::max) + 0.5,
        ];
        // A shape that fills the picture has a boundary all the same.
        let edge = boundary.window([1, 1], width, height);
        Ok(Self {
            bits,
            threads,
            boundary: boundary_points,
            edge: DistanceMap::to(&edge, threads)?,
            inside: DistanceMap::to(bits, threads)?,
            rim: points(&rim),
            evaluations: Cell::new(0),
            extent,
        })
    }

    /// Returns the corners of the box of a copy, at whole pixels.
    pub(super) fn bounds(&self, map: &DAffine2) -> [DVec2; 2] {
        let [low, high] = self.extent;
        let corners = [
            low,
            high,
            DVec2::new(low.x, high.y),
            DVec2::new(high.x, low.y),
        ];
        let images = corners.map(|corner| map.transform_point2(corner));
        let least = images.into_iter().fold(DVec2::INFINITY, DVec2::min);
        let most = images.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        [least.floor(), most.ceil()]
    }

    /// Returns half the diagonal of the shape's box.
    pub(super) fn radius(&self) -> f64 {
        (self.extent[1] - self.extent[0]).length() / 2.0
    }

    /// Returns the pixel at a position.
    pub(super) fn pixel(&self, point: DVec2) -> Option<[usize; 2]> {
        let [x, y] = [point.x, real(self.bits.height()) - point.y];
        let is_inside = x >= 0.0 && y > 0.0;
        let [column, row] = [whole(x), whole(y)];
        let is_inside = is_inside && column < self.bits.width() && row < self.bits.height();
        is_inside.then_some([column, row])
    }

    /// Returns whether the shape has a position.
    pub(super) fn holds(&self, point: DVec2) -> bool {
        self.pixel(point)
            .is_some_and(|[column, row]| self.bits.get(column, row))
    }

    /// Returns the pixels of the picture whose centres lie in the image of the shape.
    pub(super) fn image(&self, map: &DAffine2) -> Bits {
        let (back, height) = (map.inverse(), self.bits.height());
        Bits::of(self.bits.width(), height, |column, row| {
            self.holds(back.transform_point2(shape::centre([column, row], height)))
        })
    }

    /// Returns the distance of a position in a map; infinite outside the picture.
    fn distance(&self, map: &DistanceMap, point: DVec2) -> f64 {
        let pixel = self.pixel(point);
        pixel.map_or(f64::INFINITY, |[column, row]| {
            f64::from(map.squared()[row * map.width() + column]).sqrt()
        })
    }

    /// Returns the boundary points that lie on the boundary of a copy; none if the copy leaves the shape.
    pub(super) fn explained(&self, copy: &ShapeCopy) -> Vec<bool> {
        let outside = self.boundary.iter().filter(|&&point| {
            let image = copy.apply(point);
            self.distance(&self.inside, image) > NEAR
        });
        if real(outside.count()) > MAX_OUTSIDE * real(self.boundary.len()) {
            return vec![false; self.boundary.len()];
        }
        let back = copy.inverse();
        let ratio = copy.ratio();
        let explained = self.boundary.iter().map(|&point| {
            let source = back.transform_point2(point);
            self.distance(&self.edge, source) * ratio <= NEAR
        });
        explained.collect()
    }

    /// Returns the largest disk in the shape about a position within a pixel of one, to an eighth of a pixel.
    pub(super) fn deepest(&self, near: DVec2) -> Disk {
        const STEPS: i32 = 8;
        let radius = |centre: DVec2| {
            let squares = self.rim.iter().map(|point| point.distance_squared(centre));
            squares.fold(f64::INFINITY, f64::min).sqrt() - 0.5
        };
        let places = (-STEPS..=STEPS).flat_map(|x| (-STEPS..=STEPS).map(move |y| [x, y]));
        let disks = places.map(|[x, y]| {
            let centre = near + DVec2::new(f64::from(x), f64::from(y)) / f64::from(STEPS);
            Disk {
                centre,
                radius: radius(centre),
            }
        });
        let deepest = disks.max_by(|one, other| {
            let away = |disk: &Disk| disk.centre.distance_squared(near);
            let radii = one.radius.total_cmp(&other.radius);
            radii.then(away(other).total_cmp(&away(one)))
        });
        deepest.unwrap_or(Disk {
            centre: near,
            radius: radius(near),
        })
    }

    /// Returns the pixels of the shape that no copy comes within a pixel of.
    pub(super) fn uncovered(&self, maps: &[DAffine2]) -> Bits {
        let backs: Vec<DAffine2> = maps.iter().map(DAffine2::inverse).collect();
        let height = self.bits.height();
        let mut bare = self.bits.clone();
        for [column, row] in self.bits.set_boxes() {
            let point = shape::centre([column, row], height);
            let is_covered = backs.iter().zip(maps).any(|(back, map)| {
                let ratio = map.matrix2.determinant().abs().sqrt();
                self.distance(&self.inside, back.transform_point2(point)) * ratio <= 1.0
            });
            if is_covered {
                bare.assign(column, row, false);
            }
        }
        bare
    }
}

/// Returns the pixels of a set that lie outside a disk.
pub(super) fn without(bits: &Bits, disk: &Disk) -> Bits {
    let mut rest = bits.clone();
    let height = bits.height();
    let reach = disk.radius + 1.0;
    for [column, row] in bits.set_boxes() {
        let point = shape::centre([column, row], height);
        if point.distance(disk.centre) <= reach {
            rest.assign(column, row, false);
        }
    }
    rest
}

/// Returns the position of a skeleton point.
pub(super) fn centre(point: &SkeletonPoint, height: usize) -> DVec2 {
    shape::centre([point.column, point.row], height)
}
