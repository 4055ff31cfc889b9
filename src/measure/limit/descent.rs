//! Covers by boxes that are too many to be counted, estimated from a sample of boxes that is refined.
//!
//! Every box is divided into smaller ones, and those of them that copies of the set come near to are divided
//! again. Where there are too many, some are chosen at random and each represents proportionally more of its
//! size: *splitting* (Kahn & Harris 1951), which estimates sums over all boxes without bias. The chosen boxes
//! are spread evenly over the set, one of each run of neighbours.

use std::num::NonZero;

use crate::bits::Bits;
use crate::geometry::Point;
use crate::measure::cover::{Counts, Grid, Scale, least};
use crate::measure::space::Space;
use crate::measure::statistics::{deviation, mean};
use crate::parallel::map;
use crate::random::Pcg;
use crate::saturating::{real, whole};

use super::cover::GRAZED;
use super::{LimitCopy, LimitSet, merge};

/// Number of copies that are examined to refine and to count the boxes of a size, and minimum number of boxes that are
/// refined. Counts are exact as long as there are fewer.
const WORK: usize = 1 << 16;
const FOLLOWED: usize = 1 << 5;

/// Radius, in sides of a box, above which the disc of a copy is divided.
const LARGEST: f64 = 2.0;

/// Maximum number of copies of one size that are examined: where too many overlap, the descent ends.
const MAX_COPIES: usize = 1 << 18;

/// Maximum number of copies that are examined for a raster.
const MAX_RASTER: usize = 1 << 26;

/// Number of copies in a box from which equal ones are removed.
const MANY: usize = 8;

/// Boxes, each as the copies near it, on a scale on which the box is the unit box.
struct Cells<M: Space> {
    copies: Vec<LimitCopy<M>>,
    /// Ends of the boxes' copies, which follow each other.
    ends: Vec<usize>,
}

impl<M: Space> Cells<M> {
    const fn new() -> Self {
        Self {
            copies: Vec::new(),
            ends: Vec::new(),
        }
    }

    fn len(&self) -> usize {
        self.ends.len()
    }

    fn push(&mut self, cell: &[LimitCopy<M>]) {
        self.copies.extend_from_slice(cell);
        self.ends.push(self.copies.len());
    }

    fn get(&self, number: usize) -> &[LimitCopy<M>] {
        let start = number.checked_sub(1).map_or(0, |last| self.ends[last]);
        &self.copies[start..self.ends[number]]
    }

    fn iter(&self) -> impl Iterator<Item = &[LimitCopy<M>]> {
        (0..self.len()).map(|number| self.get(number))
    }
}

/// Number of boxes, and whether it is estimated from a sample.
type Count = (f64, bool);

/// The boxes of the present size that are refined.
struct Descent<'s, M: Space> {
    set: &'s LimitSet<M>,
    cells: Cells<M>,
    /// Boxes of the grid that was entered last, row by row from the lower left, with the copies that come near to them;
    /// and copies that are to be sorted into such boxes.
    entered: Vec<Vec<LimitCopy<M>>>,
    stack: Vec<LimitCopy<M>>,
    /// Number of boxes that each box represents.
    weight: f64,
    random: Pcg,
    looked_at: usize,
    /// Number of larger boxes that these are parts of, and number of copies that were examined to refine and to count them.
    parents: usize,
    examined: usize,
}

impl<'s, M: Space> Descent<'s, M> {
    /// Starts from the boxes of a grid: `start` holds copies on a scale on which boxes have side 1, and
    /// corners at whole numbers from (0, 0) to `boxes`.
    fn new(set: &'s LimitSet<M>, start: Vec<LimitCopy<M>>, boxes: Counts, seed: usize) -> Self {
        let mut descent = Self {
            set,
            cells: Cells::new(),
            entered: Vec::new(),
            stack: start,
            weight: 1.0,
            random: Pcg::new(seed as u64, 0xcafe_f00d_d15e_a5e5),
            looked_at: 0,
            parents: 1,
            examined: 0,
        };
        descent.enter(boxes);
        descent.keep_entered();
        descent
    }

    /// Returns the number of boxes that the set meets; `None` where too many copies overlap.
    fn count(&mut self) -> Option<Count> {
        if self.looked_at > MAX_COPIES {
            return None;
        }
        let mut left = MAX_COPIES;
        let mut met = 0usize;
        let mut stack = Vec::new();
        for cell in self.cells.iter() {
            met += usize::from(self.set.meets(cell, &mut stack, &mut left)?);
        }
        self.examined = self.looked_at + self.cells.copies.len() + (MAX_COPIES - left);
        (met > 0).then_some((real(met) * self.weight, self.weight > 1.0))
    }

    /// Continues with boxes smaller by the factor `base`.
    fn go_down(&mut self, base: usize) {
        self.choose();
        self.parents = self.cells.len();
        self.looked_at = 0;
        let cells = std::mem::replace(&mut self.cells, Cells::new());
        for cell in cells.iter() {
            self.magnify(cell, base);
            self.keep_entered();
            if self.looked_at > MAX_COPIES {
                break;
            }
        }
    }

    /// Divides a box into those that are smaller by the factor `base`: [`entered`](Self::entered).
    fn magnify(&mut self, cell: &[LimitCopy<M>], base: usize) {
        let (scale, layer) = (real(base), self.set.to_layer(base));
        let larger = cell.iter().map(|&copy| {
            let mut copy = copy;
            copy.grow(scale);
            copy.moved(layer)
        });
        self.stack.clear();
        self.stack.extend(larger);
        self.enter(self.set.parts(base));
    }

    /// Keeps one box of each run of neighbours, if there are too many.
    fn choose(&mut self) {
        let cost = real(self.examined) / real(self.parents);
        let most = whole(real(WORK) / cost).max(FOLLOWED);
        if self.cells.len() <= most {
            return;
        }
        let run = real(self.cells.len()) / real(most);
        self.weight *= run;
        let mut chosen = Cells::new();
        for number in 0..most {
            // A box that two runs share may be chosen twice.
            let place = whole((real(number) + self.random.unit()) * run);
            chosen.push(self.cells.get(place));
        }
        self.cells = chosen;
    }

    /// Keeps the boxes that were entered last and that copies come near to.
    fn keep_entered(&mut self) {
        let met = self.entered.iter().filter(|cell| !cell.is_empty());
        met.for_each(|cell| self.cells.push(cell));
    }

    /// Sorts the copies of the [`stack`](Self::stack) into the boxes of a grid, [`entered`](Self::entered).
    fn enter(&mut self, boxes: Counts) {
        let Self { entered, stack, .. } = self;
        entered.iter_mut().for_each(Vec::clear);
        entered.resize_with(boxes.iter().product(), Vec::new);
        while let Some(copy) = stack.pop() {
            let part = &self.set.objects[copy.object];
            let middle = copy.map.apply(part.middle);
            let radius = part.reach * copy.scale;
            self.looked_at += 1;
            let at = middle.coordinates();
            let [columns, rows, layers] = [0, 1, 2].map(|axis| {
                let (low, high) = (at[axis] - radius, at[axis] + radius);
                whole(low)..whole(high + 1.0).min(boxes[axis])
            });
            if self.looked_at > MAX_COPIES {
                break;
            }
            if radius > LARGEST {
                if !columns.is_empty() && !rows.is_empty() && !layers.is_empty() {
                    let children = part.children.iter().rev();
                    stack.extend(children.map(|inner| copy.compose(inner)));
                }
                continue;
            }
            for layer in layers {
                for row in rows.clone() {
                    for column in columns.clone() {
                        let corner = M::Point::of_coordinates([column, row, layer].map(real));
                        if from_box(middle - corner) <= radius * radius {
                            let number = (layer * boxes[1] + row) * boxes[0] + column;
                            entered[number].push(copy.moved(-corner));
                        }
                    }
                }
            }
        }
        for cell in entered.iter_mut().filter(|cell| cell.len() >= MANY) {
            merge(cell, |copy| copy, |_, _| {});
        }
    }
}

impl<M: Space> LimitSet<M> {
    /// Covers the set by boxes whose sides are fractions of its extent, each smaller than the one before by
    /// the factor `base`, down to the resolution of doubles. Boxes that are too many to be counted are
    /// estimated from a sample.
    ///
    /// A sample gives the growth of counts: from the last smallest cover that was counted, the count grows by
    /// the mean over all grids. The sizes end where too many copies overlap. In space, the boxes along the axes are
    /// counted exactly where their states are finitely many.
    ///
    /// # Panics
    ///
    /// Panics if the base is 1.
    #[must_use]
    pub fn sampled_scales(
        &self,
        base: NonZero<usize>,
        grids: &[Grid<M>],
        threads: NonZero<usize>,
    ) -> Vec<Scale> {
        let base = base.get();
        assert!(base > 1, "boxes get smaller");
        let extent = self.bounds.size().max_element();
        if extent <= 0.0 {
            return Vec::new();
        }
        // There, doubles still resolve six digits of a box, and counts fit 64 bits.
        let finest = libm::exp2(-f64::from(M::LEVELS));
        let smaller = |size: &f64| size / real(base);
        let first = smaller(&(extent * (1.0 + 2e-9)));
        let sizes = std::iter::successors(Some(first), |size| Some(smaller(size)));
        let sizes: Vec<f64> = sizes.take_while(|size| *size > finest * extent).collect();
        let exact = M::COUNTS_STATES
            .then(|| self.counts_by_states(base, sizes.len()))
            .flatten();
        if let Some(exact) = exact {
            let sizes: Vec<f64> = sizes.iter().map(|size| size / (1.0 + 2e-9)).collect();
            return least(&sizes, &[Grid::ALONG], threads, |_: &Grid<M>| exact.clone());
        }
        let counts = map(grids, threads.get(), |number, grid| {
            let on_grid = grid.map(&self.turned_bounds(grid), first, extent / 2.0);
            let (start, boxes) = self.on_grid(on_grid);
            let mut descent = Descent::new(self, start, boxes, number);
            let mut counts = Vec::new();
            for _ in &sizes {
                if !counts.is_empty() {
                    descent.go_down(base);
                }
                let Some(count) = descent.count() else {
                    break;
                };
                counts.push(count);
            }
            counts
        });
        joined(&sizes, &counts)
    }

    /// Returns the copies that the set is made of on a grid, and its boxes: for a slice, those of one layer.
    fn on_grid(&self, (map, mut boxes): (M, Counts)) -> (Vec<LimitCopy<M>>, Counts) {
        let mut map = LimitCopy::new(map, 0);
        if self.is_layer {
            // The plane of the slice lies in the middle of the layer.
            let up = 0.5 - map.map.translation().coordinates()[2];
            map = map.moved(M::Point::of_coordinates([0.0, 0.0, up]));
            boxes[2] = 1;
        }
        let start = self.start.iter().map(|copy| map.compose(copy));
        (start.collect(), boxes)
    }

    /// Returns the boxes of a plane set or a slice with the extent divided by `base` to the power of `levels` as sides
    /// that the set meets, row by row from the lower left, and their side. Returns `None` where too many copies overlap.
    pub(super) fn raster(&self, base: NonZero<usize>, levels: u32) -> Option<(Bits, f64)> {
        let base = base.get();
        let extent = self.bounds.size().max_element() * (1.0 + 4e-9);
        let (start, boxes) = self.on_grid(Grid::ALONG.map(&self.bounds, extent, 0.0));
        let side = base.pow(levels);
        let mut bits = Bits::new(side, side);
        let mut left = MAX_RASTER;
        let mut descent = Descent::new(self, start, boxes, 0);
        let start = descent.cells.iter();
        let mut open: Vec<_> = start.map(|cell| (cell.to_vec(), [0; 2], side)).collect();
        let mut stack = Vec::new();
        while let Some((cell, [column, row], side)) = open.pop() {
            left = left.checked_sub(cell.len())?;
            if side == 1 {
                if self.meets(&cell, &mut stack, &mut left)? {
                    bits.set(column, row);
                }
                continue;
            }
            descent.looked_at = 0;
            descent.magnify(&cell, base);
            let side = side / base;
            let parts = std::mem::take(&mut descent.entered).into_iter().enumerate();
            let parts = parts.filter(|(_, part)| !part.is_empty());
            open.extend(parts.map(|(number, part)| {
                let corner = [column + number % base * side, row + number / base * side];
                (part, corner, side)
            }));
        }
        Some((bits, extent / real(base.pow(levels))))
    }

    /// Returns `true` if the unit box holds a point of the set; `copies` are those near it. Returns `None`
    /// where more than `left` copies would have to be examined. The stack is memory that is used again.
    fn meets(
        &self,
        copies: &[LimitCopy<M>],
        stack: &mut Vec<LimitCopy<M>>,
        left: &mut usize,
    ) -> Option<bool> {
        let lies_in = |copy: &LimitCopy<M>| {
            let point = copy.map.apply(self.objects[copy.object].point);
            let mut coordinates = point.coordinates().into_iter();
            coordinates.all(|at| (0.0..1.0).contains(&at))
        };
        if copies.iter().any(lies_in) {
            return Some(true);
        }
        stack.clear();
        stack.extend_from_slice(copies);
        while let Some(copy) = stack.pop() {
            *left = left.checked_sub(1)?;
            let part = &self.objects[copy.object];
            let middle = copy.map.apply(part.middle);
            let radius = part.reach * copy.scale;
            if radius <= GRAZED || from_box(middle) > radius * radius {
                continue;
            }
            for inner in &part.children {
                let inner = copy.compose(inner);
                if lies_in(&inner) {
                    return Some(true);
                }
                stack.push(inner);
            }
        }
        Some(false)
    }
}

/// Returns the square of the distance of a point from the unit box.
fn from_box<P: Point>(point: P) -> f64 {
    let away = point - point.max(P::ZERO).min(P::splat(1.0));
    away.dot(away)
}

/// Replaces the variances of growths that are estimated from samples, on few grids, by their means with the
/// average variance of all such sizes.
fn pooled(scales: &mut [Scale]) {
    let sampled = scales.iter().skip(1).filter(|scale| scale.sampled);
    let squares = sampled.map(|scale| scale.growth_error * scale.growth_error);
    let squares: Vec<f64> = squares.collect();
    if squares.is_empty() {
        return;
    }
    let all = mean(&squares);
    for scale in scales.iter_mut().skip(1).filter(|scale| scale.sampled) {
        let own = scale.growth_error * scale.growth_error;
        scale.growth_error = f64::midpoint(own, all).sqrt();
    }
}

/// Returns the smallest counts of all grids, and their mean growth where they are estimated from samples.
fn joined(sizes: &[f64], counts: &[Vec<Count>]) -> Vec<Scale> {
    let levels = counts.iter().map(Vec::len).min().unwrap_or_default();
    let logs = |level: usize| counts.iter().map(move |counts| libm::log(counts[level].0));
    let mut log = 0.0;
    let mut scales = Vec::new();
    for level in 0..levels {
        let growth: Vec<f64> = match level.checked_sub(1) {
            Some(last) => logs(level)
                .zip(logs(last))
                .map(|(log, last)| log - last)
                .collect(),
            None => Vec::new(),
        };
        let error = deviation(growth.iter().copied());
        let sampled = counts.iter().any(|counts| counts[level].1);
        let last = log;
        log = if sampled {
            last + mean(&growth)
        } else {
            logs(level).fold(f64::INFINITY, f64::min)
        };
        scales.push(Scale {
            size: sizes[level],
            count: rounded(log),
            scatter: deviation(logs(level)),
            growth: if level > 0 { log - last } else { 0.0 },
            growth_error: if sampled {
                error / real(counts.len()).sqrt()
            } else {
                error
            },
            sampled,
        });
    }
    pooled(&mut scales);
    scales
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "casts from floats saturate"
)]
fn rounded(log: f64) -> u64 {
    libm::exp(log).round() as u64
}
