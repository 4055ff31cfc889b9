//! Boxes that a limit set meets: a descent to copies that lie in a box, or hardly enter one.

use std::num::NonZero;

use crate::geometry::{DAffine2, Point};

use super::super::cover::{Counts, Grid, Scale, least};
use super::super::space::Space;
use super::super::voxels::Voxels;
use super::{LimitCopy, LimitSet};
use crate::bits::Bits;

/// Radius, in units of a box's side, of the copies that are not examined further: a box that the set enters
/// by no more than twice this length may be missed.
pub(super) const GRAZED: f64 = 1.0 / 8.0;

/// Maximum number of copies that a cover examines.
const MAX_LOOKED_AT: usize = 1 << 23;

/// Maximum number of copies that are examined for the boxes of one size, of several.
const MAX_OF_SCALES: usize = 1 << 20;

/// The boxes of a cover, and the number of copies that it may still examine.
struct Marking {
    boxes: Voxels,
    left: usize,
}

impl<M: Space> LimitSet<M> {
    /// Covers the set by boxes whose sides are fractions of its extent, each smaller than the one before by
    /// the factor `base`, down to about `most` boxes (or 2^14 in a row, 2^9 in space), or to where too many copies would
    /// have to be examined.
    ///
    /// # Panics
    ///
    /// Panics if the base is not above 1.
    #[must_use]
    pub fn scales(
        &self,
        base: f64,
        most: u64,
        grids: &[Grid<M>],
        threads: NonZero<usize>,
    ) -> Vec<Scale> {
        assert!(base > 1.0, "boxes get smaller");
        let finest = libm::exp2(-f64::from(M::FILLED_LEVELS));
        let extent = self.bounds.size().max_element();
        if extent <= 0.0 || self.is_layer {
            return Vec::new();
        }
        let largest = extent / 2.0;
        let mut sizes = Vec::new();
        let mut size = extent * (1.0 + 2e-9) / base;
        while size >= finest * extent {
            let (map, boxes) = Grid::ALONG.map(&self.bounds, size, largest);
            let Some(cover) = self.covered(&map, boxes, MAX_OF_SCALES) else {
                break;
            };
            sizes.push(size);
            if cover.count() > most {
                break;
            }
            size /= base;
        }
        least(&sizes, grids, threads, |grid| {
            let turned = self.turned_bounds(grid);
            let count = |&size: &f64| {
                let (map, boxes) = grid.map(&turned, size, largest);
                Some(self.covered(&map, boxes, MAX_OF_SCALES)?.count())
            };
            sizes.iter().map_while(count).collect()
        })
    }

    /// Returns the boxes that the set meets, on the grid that `map` leads to: its boxes have side 1 and
    /// corners at whole numbers from (0, 0) to `boxes`. Parts of the set outside the grid are ignored.
    /// Returns `None` where more than `most` copies would have to be examined: long ones that lie side by side, or
    /// copies that overlap.
    ///
    /// Every box that is marked holds a point of the set. A box that the set enters by no more than a quarter
    /// of its side may be missed.
    pub(in crate::measure) fn covered(
        &self,
        map: &M,
        boxes: Counts,
        most: usize,
    ) -> Option<Voxels> {
        let grid = LimitCopy::new(*map, 0);
        let mut stack: Vec<_> = self.start.iter().map(|copy| grid.compose(copy)).collect();
        let mut marking = Marking {
            boxes: Voxels::new(boxes),
            left: most,
        };
        // A box that one copy hardly enters is mostly met by another. When such copies are examined later,
        // the boxes of most of them are marked already.
        let mut later = Vec::new();
        while !stack.is_empty() {
            self.mark(&mut stack, Some(&mut later), &mut marking)?;
            self.mark(&mut later, None, &mut marking)?;
        }
        Some(marking.boxes)
    }

    /// Marks the boxes that copies meet. Copies in no more than two columns and rows of boxes, some of which
    /// are not marked, are moved to `later` until this is full; without `later`, they are divided further.
    fn mark(
        &self,
        stack: &mut Vec<LimitCopy<M>>,
        mut later: Option<&mut Vec<LimitCopy<M>>>,
        marking: &mut Marking,
    ) -> Option<()> {
        const WIDEST: i64 = 8;
        const MAX_LATER: usize = 1 << 18;
        while let Some(copy) = stack.pop() {
            marking.left = marking.left.checked_sub(1)?;
            let part = &self.objects[copy.object];
            let point = copy.map.apply(part.point);
            let radius = part.radius * copy.scale;
            let around = M::Point::splat(radius);
            let [low, high] = [point - around, point + around].map(boxed);
            let spans = low.iter().zip(&high).map(|(low, high)| high - low);
            let span = spans.fold(0, i64::max);
            if span <= 1 {
                marking.boxes.mark(boxed(point));
            }
            // Where copies overlap, all boxes of a large one may be marked already.
            if span <= WIDEST && marking.boxes.are_marked(low, high) {
                continue;
            }
            if span <= 1 {
                if let Some(later) = later.as_deref_mut() {
                    later.push(copy);
                    if later.len() == MAX_LATER {
                        return Some(());
                    }
                    continue;
                }
                if radius <= GRAZED {
                    continue;
                }
            }
            stack.extend(part.children.iter().map(|inner| copy.compose(inner)));
        }
        Some(())
    }
}

impl LimitSet {
    /// Returns the boxes that the set meets, on the grid that `map` leads to: its boxes have side 1 and
    /// corners at whole numbers from (0, 0) to `boxes`. Parts of the set outside the grid are ignored.
    /// Returns `None` where too many copies would have to be examined: long ones that lie side by side, or
    /// copies that overlap.
    ///
    /// Every box that is marked holds a point of the set. A box that the set enters by no more than a quarter
    /// of its side may be missed.
    #[must_use]
    pub fn cover(&self, map: &DAffine2, [columns, rows]: [usize; 2]) -> Option<Bits> {
        let covered = self.covered(map, [columns, rows, 1], MAX_LOOKED_AT)?;
        Some(covered.into_layers())
    }
}

/// Returns the box that a point lies in.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_precision_loss,
    reason = "casts from floats saturate, and boxes are few"
)]
fn boxed<P: Point>(point: P) -> [i64; 3] {
    point.coordinates().map(|at| {
        // Rounding down is a call where the processor is not known to have an instruction for it.
        let towards_zero = at as i64;
        towards_zero.saturating_sub(i64::from(at < towards_zero as f64))
    })
}
