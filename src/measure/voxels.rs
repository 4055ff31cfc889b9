//! Sets of boxes in the plane and in space as bits.

use super::cover::Counts;
use crate::bits::Bits;

/// Boxes along up to three axes, a bit for each: layers of rows, one below the other.
#[derive(Clone, Debug)]
pub(super) struct Voxels {
    boxes: Counts,
    layers: Bits,
}

impl Voxels {
    /// Creates a set of empty boxes.
    pub(super) fn new(boxes: Counts) -> Self {
        Self {
            boxes,
            layers: Bits::new(boxes[0], boxes[1] * boxes[2]),
        }
    }

    /// Returns the boxes of all layers, one below the other.
    pub(super) fn into_layers(self) -> Bits {
        self.layers
    }

    /// Returns the number of boxes that are set.
    pub(super) fn count(&self) -> u64 {
        self.layers.count()
    }

    /// Sets a box, if it is inside.
    #[inline]
    pub(super) fn mark(&mut self, place: [i64; 3]) {
        if let Some([column, row]) = self.inside(place) {
            self.layers.set(column, row);
        }
    }

    /// Sets a box.
    ///
    /// # Panics
    ///
    /// Panics, or sets another box, if the place is outside.
    #[inline]
    pub(super) fn set(&mut self, [column, row, layer]: [u32; 3]) {
        let row = layer as usize * self.boxes[1] + row as usize;
        self.layers.set(column as usize, row);
    }

    /// Returns the set in boxes twice as large.
    pub(super) fn folded(&self) -> Self {
        if self.boxes[2] == 1 {
            let layers = self.layers.folded([false; 2]);
            let boxes = [layers.width(), layers.height(), 1];
            return Self { boxes, layers };
        }
        let [width, height, layers] = self.boxes;
        let halves = (0..layers.div_ceil(2)).map(|layer| {
            let pair = [2 * layer, 2 * layer + 1];
            let pair = pair.map(|layer| self.layers.rows(layer * height, height));
            Bits::union(width, height, pair).folded([false; 2])
        });
        Self {
            boxes: self.boxes.map(|boxes| boxes.div_ceil(2)),
            layers: Bits::stacked(width.div_ceil(2), halves),
        }
    }

    /// Returns `true` if all boxes from `low` to `high` that are inside are set.
    #[inline]
    pub(super) fn are_marked(&self, low: [i64; 3], high: [i64; 3]) -> bool {
        let is_marked = |place| {
            let inside = self.inside(place);
            inside.is_none_or(|[column, row]| self.layers.get(column, row))
        };
        let [mut layers, rows, columns] = [2, 1, 0].map(|axis| low[axis]..=high[axis]);
        layers.all(|layer| {
            let mut rows = rows.clone();
            rows.all(|row| {
                columns
                    .clone()
                    .all(|column| is_marked([column, row, layer]))
            })
        })
    }

    /// Returns the column and the row, counted over all layers, of a place.
    #[inline]
    fn inside(&self, place: [i64; 3]) -> Option<[usize; 2]> {
        let mut own = [0; 3];
        for (axis, at) in place.into_iter().enumerate() {
            let at = usize::try_from(at).ok();
            own[axis] = at.filter(|at| *at < self.boxes[axis])?;
        }
        Some([own[0], own[2] * self.boxes[1] + own[1]])
    }
}
