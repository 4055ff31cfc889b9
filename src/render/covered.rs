//! Index of the pixels that a layer covers completely, which threads query for occlusion.

use std::ops::Range;
use std::sync::atomic::Ordering::{Acquire, Relaxed, Release};
use std::sync::atomic::{AtomicU64, fence};
use std::sync::{Arc, OnceLock};

use crate::geometry::DVec2;
use crate::parallel::is_too_early;
use crate::saturating::whole;

/// Number of no layer.
const NONE: u64 = 0;

/// Number of the next layer, unique among all pictures.
static NEXT: AtomicU64 = AtomicU64::new(NONE + 1);

/// Maximum side of the boxes that are examined, in pixels.
const LONGEST: f64 = 64.0;

/// Upper bound of the displacement of a round pen's mask from its line, in pixels.
const PAD: f64 = 0.25;

/// Pixels that one layer covers completely while it is being drawn. Anything else that the layer draws there
/// is invisible.
///
/// A layer is drawn with one opaque colour. Some threads draw while others query: recent coverage may not be
/// known yet, but known coverage stays valid as long as the layer does. The number of the layer, which is
/// read before and after the pixels, ensures that (a sequence lock; Boehm, "Can seqlocks get along with
/// programming language memory models?", 2012).
#[derive(Debug)]
pub(crate) struct CoveredPixels {
    /// Width and height of the drawn rows of the picture, in pixels.
    size: [usize; 2],
    /// First drawn row.
    top: f64,
    /// Margin on every side, in pixels.
    margin: usize,
    /// Number of cells per row.
    stride: usize,
    layer: AtomicU64,
    /// Cells of the coverage buffers that have been made. The union of the buffers' bits is all ones for
    /// pixels that are covered completely.
    planes: Box<[OnceLock<Arc<[AtomicU64]>>]>,
}

impl CoveredPixels {
    /// Creates an empty index for `buffers` coverage buffers of some rows of a picture, with a margin on every
    /// side.
    pub(crate) fn new(width: u32, rows: Range<u32>, margin: i64, planes: usize) -> Self {
        let size = [width, rows.end - rows.start].map(|side| side as usize);
        let margin = usize::try_from(margin).unwrap_or(0);
        Self {
            size,
            top: f64::from(rows.start),
            margin,
            stride: size[0] + 2 * margin,
            layer: AtomicU64::new(NONE),
            planes: std::iter::repeat_with(OnceLock::new).take(planes).collect(),
        }
    }

    /// Adds the cells of a coverage buffer, row by row.
    pub(crate) fn add(&self, plane: usize, cells: Arc<[AtomicU64]>) {
        let _ = self.planes[plane].set(cells);
    }

    /// Reserves `count` new layers and returns the number of the first.
    pub(crate) fn layers(count: u64) -> u64 {
        NEXT.fetch_add(count, Relaxed)
    }

    /// Declares that all coverage, present and future, belongs to a layer.
    #[inline]
    pub(crate) fn begin(&self, layer: u64) {
        self.layer.store(layer, Release);
    }

    /// Declares that the coverage buffers are about to be cleared.
    pub(crate) fn end(&self) {
        self.layer.store(NONE, Relaxed);
        fence(Release);
    }

    /// Orders a thread's drawing after the declarations; every thread calls it before it draws.
    pub(crate) fn draw() {
        fence(Release);
    }

    /// Returns whether a layer covers all pixels that meet a box, as far as they lie in these rows of the
    /// picture. The box extends by `reach` to both sides of its centre; larger boxes than are examined are
    /// not full.
    pub(crate) fn is_full(&self, layer: u64, middle: DVec2, reach: [f64; 2]) -> bool {
        let reach = reach.map(|reach| reach + PAD);
        let is_small = reach.iter().all(|reach| 2.0 * reach <= LONGEST);
        if !is_small || self.layer.load(Acquire) != layer || is_too_early() {
            return false;
        }
        let middle = DVec2::new(middle.x, middle.y - self.top);
        let [columns, rows] = [0, 1].map(|axis| {
            let most = self.size[axis] as f64;
            let end = |place: f64| whole(place.clamp(0.0, most));
            let [from, to] = [middle[axis] - reach[axis], middle[axis] + reach[axis]];
            // Casts round down non-negative numbers.
            let past = end(to) + usize::from(to >= 0.0);
            end(from) + self.margin..past.min(self.size[axis]) + self.margin
        });
        let is_full = rows.into_iter().all(|row| {
            let start = row * self.stride;
            (start + columns.start..start + columns.end).all(|cell| self.is_covered(cell))
        });
        fence(Acquire);
        is_full && self.layer.load(Relaxed) == layer
    }

    #[inline]
    fn is_covered(&self, cell: usize) -> bool {
        let planes = self.planes.iter().filter_map(OnceLock::get);
        planes.fold(0, |all, cells| all | cells[cell].load(Relaxed)) == u64::MAX
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::AtomicU64;
    use std::sync::atomic::Ordering::Relaxed;

    use super::CoveredPixels;
    use crate::geometry::DVec2;

    /// Returns an index of 8 by 8 pixels and two coverage buffers. Pixels 2 to 5 of both axes are covered,
    /// half of each on either buffer.
    fn filled() -> (CoveredPixels, Vec<Arc<[AtomicU64]>>) {
        let filled = CoveredPixels::new(8, 0..8, 1, 3);
        let half = |mask: u64| -> Arc<[AtomicU64]> {
            let cells = (0..100).map(|cell: usize| {
                let inside = |place: usize| (3..7).contains(&place);
                let is_covered = inside(cell / 10) && inside(cell % 10);
                AtomicU64::new(if is_covered { mask } else { 0 })
            });
            cells.collect()
        };
        let planes = vec![half(u64::from(u32::MAX)), half(!u64::from(u32::MAX))];
        (0..)
            .zip(&planes)
            .for_each(|(number, cells)| filled.add(number, Arc::clone(cells)));
        (filled, planes)
    }

    #[test]
    fn a_box_is_full_if_all_its_pixels_are() {
        let (filled, planes) = filled();
        filled.begin(7);
        let middle = DVec2::splat(4.0);
        assert!(filled.is_full(7, middle, [1.7; 2]));
        assert!(!filled.is_full(7, middle, [1.8; 2]));
        assert!(!filled.is_full(7, middle, [1.7, 1.8]));
        assert!(!filled.is_full(7, middle, [1.8, 0.1]));
        assert!(!filled.is_full(7, DVec2::new(4.0, 4.5), [1.7; 2]));
        assert!(!filled.is_full(7, middle, [f64::NAN; 2]));
        planes[0][44].store(0, Relaxed);
        assert!(!filled.is_full(7, middle, [1.0; 2]));
    }

    #[test]
    fn what_lies_outside_does_not_show() {
        let (filled, planes) = filled();
        filled.begin(7);
        assert!(filled.is_full(7, DVec2::new(-20.0, 4.0), [3.0; 2]));
        assert!(!filled.is_full(7, DVec2::new(9.0, 4.0), [3.0; 2]));
        planes
            .iter()
            .for_each(|cells| cells.iter().for_each(|cell| cell.store(u64::MAX, Relaxed)));
        assert!(filled.is_full(7, DVec2::new(9.0, 4.0), [3.0; 2]));
    }

    #[test]
    fn only_the_layer_that_is_drawn_is_known() {
        let (filled, _) = filled();
        let middle = DVec2::splat(4.0);
        assert!(!filled.is_full(7, middle, [1.0; 2]));
        filled.begin(7);
        assert!(filled.is_full(7, middle, [1.0; 2]));
        assert!(!filled.is_full(8, middle, [1.0; 2]));
        filled.end();
        assert!(!filled.is_full(7, middle, [1.0; 2]));
    }
}
