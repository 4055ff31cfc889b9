//! Exact counts of boxes by their states, where there are finitely many.
//!
//! The state of a box is the list of copies that enter it, on a scale on which the box is the unit box. Boxes of one
//! state are divided alike: the numbers of boxes of each state among the parts of a state are found once, and the
//! counts of all sizes follow from a product of matrices. Where the maps of a set and the sides of boxes are
//! commensurable, states are finitely many. A box meets the set if its parts do, and theirs, without end: states
//! without an infinite path of parts are left out.
//!
//! A copy enters a box if their bounding boxes have interior points in common. A copy that is flat along an axis and
//! lies in the common side of two boxes enters the one behind it. Boxes that the set only touches from outside are
//! therefore not counted, and the boxes that are counted cover the set.

use crate::digraph::on_infinite_paths;
use crate::fast_hash::FastMap;
use crate::geometry::{Bounds, Point};
use crate::measure::cover::Counts;
use crate::measure::space::Space;
use crate::saturating::{real, whole};

use super::{EXACT, LimitCopy, LimitSet, MAX_WORK, NEGLIGIBLE};

/// Maximum number of states, of copies that are examined, and of linear parts of maps.
const MAX_STATES: usize = 1 << 13;
const MAX_COPIES: usize = 1 << 19;
const MAX_SHAPES: usize = 1 << 8;

/// Length, in sides of a box, below which differences are rounding.
const SAME: f64 = 1e-6;

/// Numbers of a map in units of [`SAME`], with the number of its object.
type Key = [i64; 13];

/// A box, as the copies that enter it.
type Cell<M> = Vec<LimitCopy<M>>;

/// The states that have been found.
struct States<'s, M: Space> {
    set: &'s LimitSet<M>,
    numbers: FastMap<Vec<Key>, usize>,
    cells: Vec<Cell<M>>,
    /// Bounding boxes of objects under the linear parts of maps.
    shapes: FastMap<Key, Bounds<M::Point>>,
    left: usize,
}

impl<M: Space> LimitSet<M> {
    /// Counts the boxes with sides of the extent divided by base, base² … that the set meets, on the grid along the
    /// axes from the corner of its bounding box on; `None` where the states are too many.
    pub(super) fn counts_by_states(&self, base: usize, sizes: usize) -> Option<Vec<u64>> {
        if !self.has_few_shapes(base) {
            return None;
        }
        let extent = self.bounds.size().max_element();
        let unit = LimitCopy::new(M::IDENTITY, 0);
        // The plane of a slice lies in the middle of its layer.
        let height = if self.is_layer { 0.5 } else { 0.0 };
        let middle = M::Point::of_coordinates([0.0, 0.0, height]);
        let start = self.start.iter().map(|copy| {
            let mut copy = unit.compose(copy).moved(-self.bounds.min());
            copy.grow(1.0 / extent);
            copy.moved(middle)
        });
        let mut states = States {
            set: self,
            numbers: FastMap::default(),
            cells: Vec::new(),
            shapes: FastMap::default(),
            left: MAX_COPIES,
        };
        let start = states.number(start.collect())?;
        let mut parts: Vec<Vec<usize>> = Vec::new();
        while let Some(cell) = states.cells.get(parts.len()).cloned() {
            parts.push(states.divided(cell, base)?);
        }
        // States that are the start of an infinite path.
        let lasting = on_infinite_paths(&parts);
        let mut boxes = vec![0u64; parts.len()];
        boxes[start] = 1;
        let mut counts = Vec::new();
        for _ in 0..sizes {
            let mut next = vec![0u64; parts.len()];
            for (count, parts) in boxes.iter().zip(&parts) {
                for &part in parts.iter().filter(|&&part| lasting[part]) {
                    next[part] = next[part].checked_add(*count)?;
                }
            }
            boxes = next;
            counts.push(
                boxes
                    .iter()
                    .try_fold(0u64, |sum, count| sum.checked_add(*count))?,
            );
        }
        Some(counts)
    }

    /// Returns `false` if copies have more than [`MAX_SHAPES`] linear parts that differ by more than a power of the base:
    /// their states are too many.
    fn has_few_shapes(&self, base: usize) -> bool {
        let mut known = FastMap::default();
        let mut open = self.start.clone();
        while let Some(copy) = open.pop() {
            if copy.scale <= NEGLIGIBLE {
                continue;
            }
            // The largest linear part that is no larger than the unit.
            let mut copy = copy.moved(-copy.map.translation());
            let levels = (libm::log(copy.scale) / libm::log(real(base)) - SAME).ceil();
            copy.grow(libm::pow(real(base), -levels));
            if known.insert(key(&copy.map, copy.object), ()).is_some() {
                continue;
            }
            if known.len() > MAX_SHAPES {
                return false;
            }
            let children = self.objects[copy.object].children.iter();
            open.extend(children.map(|inner| copy.compose(inner)));
        }
        true
    }
}

impl<M: Space> States<'_, M> {
    /// Returns the number of the state of a box.
    fn number(&mut self, mut cell: Cell<M>) -> Option<usize> {
        let mut keyed: Vec<(Key, LimitCopy<M>)> = Vec::new();
        for copy in cell.drain(..) {
            keyed.push((key(&copy.map, copy.object), copy));
        }
        keyed.sort_by_key(|(key, _)| *key);
        keyed.dedup_by(|a, b| a.0 == b.0);
        let (keys, cell): (Vec<Key>, Cell<M>) = keyed.into_iter().unzip();
        let new = self.cells.len();
        let number = *self.numbers.entry(keys).or_insert(new);
        if number == new {
            if new == MAX_STATES {
                return None;
            }
            self.cells.push(cell);
        }
        Some(number)
    }

    /// Returns the states of the boxes into which a box is divided, without empty ones.
    fn divided(&mut self, cell: Cell<M>, base: usize) -> Option<Vec<usize>> {
        let boxes: Counts = self.set.parts(base);
        let layer = self.set.to_layer(base);
        let mut parts = vec![Cell::new(); boxes.iter().product()];
        let mut copies = cell;
        for copy in &mut copies {
            copy.grow(real(base));
            *copy = copy.moved(layer);
        }
        while let Some(copy) = copies.pop() {
            self.left = self.left.checked_sub(1)?;
            let bounds = self.bounds_of(&copy)?;
            let (low, high) = (bounds.min().coordinates(), bounds.max().coordinates());
            let ranges = [0, 1, 2].map(|axis| entered(low[axis], high[axis], boxes[axis]));
            if ranges.iter().any(|range| range.is_empty()) {
                continue;
            }
            if bounds.size().max_element() > 1.0 + SAME {
                let children = self.set.objects[copy.object].children.iter();
                copies.extend(children.map(|inner| copy.compose(inner)));
                continue;
            }
            let [columns, rows, layers] = ranges;
            for layer in layers {
                for row in rows.clone() {
                    for column in columns.clone() {
                        let corner = M::Point::of_coordinates([column, row, layer].map(real));
                        let number = (layer * boxes[1] + row) * boxes[0] + column;
                        parts[number].push(copy.moved(-corner));
                    }
                }
            }
        }
        let parts = parts.into_iter().filter(|part| !part.is_empty());
        parts.map(|part| self.number(part)).collect()
    }

    /// Returns the bounding box of a copy.
    fn bounds_of(&mut self, copy: &LimitCopy<M>) -> Option<Bounds<M::Point>> {
        let at = copy.map.translation();
        let linear = copy.moved(-at);
        let shapes = self.shapes.len();
        let objects = &self.set.objects;
        let shape = match self.shapes.entry(key(&linear.map, linear.object)) {
            std::collections::hash_map::Entry::Occupied(known) => *known.get(),
            std::collections::hash_map::Entry::Vacant(_) if shapes == MAX_SHAPES => return None,
            std::collections::hash_map::Entry::Vacant(new) => {
                *new.insert(LimitSet::extent(objects, &[linear], EXACT, MAX_WORK))
            }
        };
        Some(Bounds::new(shape.min() + at, shape.max() + at))
    }
}

/// Returns the boxes along an axis that an interval enters.
fn entered(low: f64, high: f64, boxes: usize) -> std::ops::Range<usize> {
    let (first, last) = if high - low <= SAME {
        let at = f64::midpoint(low, high) + SAME;
        (at, at.floor() + 1.0)
    } else {
        (low + SAME, (high - SAME).ceil())
    };
    if last <= 0.0 {
        return 0..0;
    }
    whole(first)..whole(last).min(boxes)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "casts from floats saturate, and equal keys need equal maps only"
)]
fn key<M: Space>(map: &M, object: usize) -> Key {
    let map = map.in_space();
    let mut key = [0; 13];
    for (own, value) in key.iter_mut().zip(map.to_cols_array()) {
        *own = (value / SAME).round() as i64;
    }
    key[12] = object as i64;
    key
}
