use std::ops::Range;
use std::sync::atomic::Ordering::{Acquire, Relaxed, Release};
use std::sync::atomic::{AtomicU64, fence};
use std::sync::{Arc, OnceLock};

use crate::geometry::DVec2;
use crate::parallel::is_too_early;
use crate::whole::whole;

/// No layer: pixels of none are asked for.
const NONE: u64 = 0;

/// What no layer of any picture has been yet.
static NEXT: AtomicU64 = AtomicU64::new(NONE + 1);

/// Boxes with longer sides, in pixels, are not looked at.
const LONGEST: f64 = 64.0;

/// Prints of pens lie as much beside their lines, in pixels, and to spare.
const PAD: f64 = 0.25;

/// Which pixels one layer covers all over, while it is being drawn: what else it draws there does not
/// show.
///
/// A layer is drawn with one opaque colour. While some threads draw, others ask: what is drawn late
/// is not known yet, but what is known stays so as long as the layer does. That is told by its
/// number, before and after the pixels are looked at (a sequence lock; Boehm, "Can seqlocks get
/// along with programming language memory models?", 2012).
#[derive(Debug)]
pub(crate) struct Filled {
    /// Width and height of the rows of the picture that are drawn, and the first of them.
    size: [usize; 2],
    top: f64,
    /// The pixels of margin on every side, and the cells of a row.
    margin: usize,
    stride: usize,
    layer: AtomicU64,
    /// The cells of planes, once there are any; a pixel that is covered all over has all bits set in
    /// some.
    planes: Box<[OnceLock<Arc<[AtomicU64]>>]>,
}

impl Filled {
    /// Nothing, of so many planes of some rows of a picture, with a margin on every side.
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

    /// The cells of a plane, by rows.
    pub(crate) fn add(&self, plane: usize, cells: Arc<[AtomicU64]>) {
        let _ = self.planes[plane].set(cells);
    }

    /// The number of the first of so many new layers.
    pub(crate) fn layers(count: u64) -> u64 {
        NEXT.fetch_add(count, Relaxed)
    }

    /// What is drawn from now on, and what the planes hold, is of a layer.
    #[inline]
    pub(crate) fn begin(&self, layer: u64) {
        self.layer.store(layer, Release);
    }

    /// What the planes hold is about to be taken from them.
    pub(crate) fn end(&self) {
        self.layer.store(NONE, Relaxed);
        fence(Release);
    }

    /// To be called by each thread before it draws.
    pub(crate) fn draw() {
        fence(Release);
    }

    /// Whether a layer covers all pixels that a box meets which reaches so far to both sides of its
    /// middle, in so far as they lie in these rows of the picture.
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
            end(from.floor()) + self.margin..end(to.floor() + 1.0) + self.margin
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

    use super::Filled;
    use crate::geometry::DVec2;

    /// A picture of 8 by 8 pixels whose pixels from 2 to 5 are covered, half of each on either of
    /// two planes.
    fn filled() -> (Filled, Vec<Arc<[AtomicU64]>>) {
        let filled = Filled::new(8, 0..8, 1, 3);
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
