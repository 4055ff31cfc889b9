//! The collage of a shape, and its difference from the shape.

use crate::Bits;
use crate::geometry::{Bounds, DVec2};
use crate::saturating::{real, whole};

use super::certificate::distance;
use super::score::iou;
use super::shape::centre;
use super::{Candidate, Silhouette};

/// Difference of a shape from its collage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollageError {
    /// Intersection over union of shape and collage.
    pub iou: f64,
    /// Hausdorff distance of shape and collage, both as sets of the centres of pixels, in pixels.
    pub distance: f64,
}

impl Candidate {
    /// Returns the collage of a shape: the pixels whose centres lie in a disk, or in an image of the shape as a union of
    /// squares. Images under singular maps have no area, and no pixels.
    #[must_use]
    pub fn collage(&self, shape: &Silhouette) -> Bits {
        let [width, height] = shape.size();
        let mut collage = Bits::new(width, height);
        let own = shape.bits();
        for map in &self.maps {
            let back = map.inverse();
            if !back.is_finite() {
                continue;
            }
            let [low, high] = [shape.bounds().min() - 0.5, shape.bounds().max() + 0.5];
            let mut image = Bounds::EMPTY;
            for corner in [
                low,
                DVec2::new(high.x, low.y),
                high,
                DVec2::new(low.x, high.y),
            ] {
                image.add(map.transform_point2(corner));
            }
            let columns =
                whole(image.min().x.max(0.0))..whole(image.max().x.max(0.0) + 1.0).min(width);
            let top = real(height) - image.max().y;
            let bottom = real(height) - image.min().y;
            for row in whole(top.max(0.0))..whole(bottom.max(0.0) + 1.0).min(height) {
                for column in columns.clone() {
                    let from = back.transform_point2(centre([column, row], height));
                    let (x, y) = (from.x, real(height) - from.y);
                    let is_inside = x >= 0.0 && y >= 0.0 && x < real(width) && y < real(height);
                    if is_inside && own.get(whole(x), whole(y)) {
                        collage.set(column, row);
                    }
                }
            }
        }
        for disk in &self.disks {
            let is_in =
                |row, column| centre([column, row], height).distance(disk.centre) <= disk.radius;
            for row in 0..height {
                let inside = (0..width).filter(|&column| is_in(column, row));
                inside.for_each(|column| collage.set(column, row));
            }
        }
        collage
    }

    /// Compares a shape with its collage.
    #[must_use]
    pub fn collage_error(&self, shape: &Silhouette) -> CollageError {
        CollageError {
            iou: iou(shape.bits(), &self.collage(shape)),
            distance: distance(shape, self),
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::{DAffine2, DMat2};
    use crate::ifs::about;

    use super::*;
    use crate::fit::Disk;

    fn halves(corners: &[(f64, f64)]) -> Candidate {
        let half = DMat2::from_diagonal(DVec2::splat(0.5));
        let maps = corners.iter().map(|&(x, y)| about(half, DVec2::new(x, y)));
        Candidate::of_maps(maps.collect())
    }

    fn square(side: usize) -> Silhouette {
        Silhouette::new(Bits::of(side, side, |column, row| {
            (1..=side - 2).contains(&column) && (1..=side - 2).contains(&row)
        }))
        .unwrap()
    }

    #[test]
    fn a_square_is_its_collage_of_quarters() {
        let shape = square(66);
        let four = halves(&[(1.0, 1.0), (65.0, 1.0), (1.0, 65.0), (65.0, 65.0)]);
        assert_eq!(four.collage(&shape), *shape.bits());
        let found = four.collage_error(&shape);
        assert_eq!(found.iou, 1.0);
        // Images of centres lie between centres.
        assert!(found.distance < 0.71, "{found:?}");
        let three = halves(&[(1.0, 1.0), (65.0, 1.0), (1.0, 65.0)]);
        let found = three.collage_error(&shape);
        assert_eq!(found.iou, 0.75);
        // From the corner of the square to that of the missing quarter.
        assert!((found.distance - 32.0).abs() < 1.0, "{found:?}");
    }

    #[test]
    fn what_lies_outside_or_has_no_area_is_left_out() {
        let shape = square(66);
        let away = DAffine2::from_translation(DVec2::new(1000.0, -1000.0));
        let flat = DAffine2::from_scale(DVec2::new(0.5, 0.0));
        let mut candidate = Candidate::of_maps(vec![away, flat]);
        assert!(candidate.collage(&shape).is_empty());
        assert_eq!(candidate.collage_error(&shape).iou, 0.0);
        let (centre, radius) = (DVec2::splat(33.0), 16.0);
        candidate.disks.push(Disk { centre, radius });
        let inked = candidate.collage(&shape).count() as f64;
        let area = std::f64::consts::PI * radius * radius;
        assert!((inked / area - 1.0).abs() < 0.01, "{inked}");
    }

    #[test]
    fn a_reduced_shape_has_reduced_errors() {
        let shape = Silhouette::new(Bits::of(640, 640, |column, row| {
            (20..620).contains(&column) && (20..620).contains(&row)
        }))
        .unwrap();
        let (small, factor) = shape.reduced(64);
        assert_eq!((small.size(), factor), ([64, 64], 0.1));
        let three = halves(&[(20.0, 20.0), (620.0, 20.0), (20.0, 620.0)]);
        let there = DAffine2::from_scale(DVec2::splat(factor));
        let (all, some) = (
            three.collage_error(&shape),
            three.moved(&there).collage_error(&small),
        );
        assert!((all.iou - some.iou).abs() < 0.02, "{all:?} {some:?}");
        assert!(
            (all.distance - some.distance / factor).abs() < 15.0,
            "{all:?} {some:?}"
        );
        assert_eq!(small.reduced(64).1, 1.0);
        // Nothing but the shape is left of a thin margin.
        assert_eq!(square(640).reduced(64).1, 1.0);
    }
}
