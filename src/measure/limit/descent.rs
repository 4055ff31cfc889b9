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

/// Number of copies, in the boxes of a size, that are refined, and minimum number of such boxes, in the plane and in
/// space, where more copies come near to a box. Counts are exact as long as there are fewer.
const FOLLOWED_COPIES: usize = 1 << 14;
const FOLLOWED: [usize; 2] = [1 << 11, 1 << 9];

/// Radius, in sides of a box, above which the disc of a copy is divided.
const LARGEST: f64 = 2.0;

/// Maximum number of copies of one size that are examined: where too many overlap, the descent ends.
const MAX_COPIES: usize = 1 << 22;

/// Maximum number of copies that are examined for a raster.
const MAX_RASTER: usize = 1 << 26;

/// Number of copies in a box from which equal ones are removed.
const MANY: usize = 8;

/// A box, as the copies near it, on a scale on which the box is the unit box.
type Cell<M> = Vec<LimitCopy<M>>;

/// Number of boxes, and whether it is estimated from a sample.
type Count = (f64, bool);

/// The boxes of the present size that are refined.
struct Descent<'s, M: Space> {
    set: &'s LimitSet<M>,
    cells: Vec<Cell<M>>,
    /// Number of boxes that each box represents.
    weight: f64,
    random: Pcg,
    looked_at: usize,
}

impl<'s, M: Space> Descent<'s, M> {
    /// Starts from the boxes of a grid: `start` holds copies on a scale on which boxes have side 1, and
    /// corners at whole numbers from (0, 0) to `boxes`.
    fn new(set: &'s LimitSet<M>, start: Vec<LimitCopy<M>>, boxes: Counts, seed: usize) -> Self {
        let mut descent = Self {
            set,
            cells: Vec::new(),
            weight: 1.0,
            random: Pcg::new(seed as u64, 0xcafe_f00d_d15e_a5e5),
            looked_at: 0,
        };
        descent.cells = descent.divided(start, boxes);
        descent
    }

    /// Returns the number of boxes that the set meets; `None` where too many copies overlap.
    fn count(&self) -> Option<Count> {
        if self.looked_at > MAX_COPIES {
            return None;
        }
        let mut left = MAX_COPIES;
        let mut met = 0usize;
        for cell in &self.cells {
            met += usize::from(self.set.meets(cell, &mut left)?);
        }
        (met > 0).then_some((real(met) * self.weight, self.weight > 1.0))
    }

    /// Continues with boxes smaller by the factor `base`.
    fn go_down(&mut self, base: usize) {
        self.choose();
        self.looked_at = 0;
        let scale = real(base);
        let layer = self.set.to_layer(base);
        let mut cells = Vec::new();
        for mut cell in std::mem::take(&mut self.cells) {
            for copy in &mut cell {
                copy.grow(scale);
                *copy = copy.moved(layer);
            }
            cells.append(&mut self.divided(cell, self.set.parts(base)));
            if self.looked_at > MAX_COPIES {
                break;
            }
        }
        self.cells = cells;
    }

    /// Keeps one box of each run of neighbours, if there are too many.
    fn choose(&mut self) {
        let copies: usize = self.cells.iter().map(Vec::len).sum();
        let most = (self.cells.len() * FOLLOWED_COPIES / copies.max(1))
            .max(FOLLOWED[M::Point::DIMENSION - 2]);
        if self.cells.len() <= most {
            return;
        }
        let run = real(self.cells.len()) / real(most);
        self.weight *= run;
        let places = (0..most).map(|number| whole((real(number) + self.random.unit()) * run));
        let places: Vec<usize> = places.collect();
        // A box that two runs share may be chosen twice.
        let chosen = places.iter().map(|&place| self.cells[place].clone());
        self.cells = chosen.collect();
    }

    /// Returns the boxes of a grid that copies come near to, row by row from the lower left.
    fn divided(&mut self, copies: Vec<LimitCopy<M>>, boxes: Counts) -> Vec<Cell<M>> {
        let mut cells = self.entered(copies, boxes);
        cells.retain(|cell| !cell.is_empty());
        cells
    }

    /// Returns all boxes of a grid, row by row from the lower left, with the copies that come near to them.
    fn entered(&mut self, mut copies: Vec<LimitCopy<M>>, boxes: Counts) -> Vec<Cell<M>> {
        let mut cells = vec![Cell::new(); boxes.iter().product()];
        while let Some(copy) = copies.pop() {
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
                    copies.extend(children.map(|inner| copy.compose(inner)));
                }
                continue;
            }
            for layer in layers {
                for row in rows.clone() {
                    for column in columns.clone() {
                        let corner = M::Point::of_coordinates([column, row, layer].map(real));
                        if from_box(middle - corner) <= radius * radius {
                            let number = (layer * boxes[1] + row) * boxes[0] + column;
                            cells[number].push(copy.moved(-corner));
                        }
                    }
                }
            }
        }
        for cell in cells.iter_mut().filter(|cell| cell.len() >= MANY) {
            merge(cell, |copy| copy, |_, _| {});
        }
        cells
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
        let mut open: Vec<_> = descent
            .cells
            .drain(..)
            .map(|cell| (cell, [0; 2], side))
            .collect();
        while let Some((mut cell, [column, row], side)) = open.pop() {
            left = left.checked_sub(cell.len())?;
            if side == 1 {
                if self.meets(&cell, &mut left)? {
                    bits.set(column, row);
                }
                continue;
            }
            let layer = self.to_layer(base);
            for copy in &mut cell {
                copy.grow(real(base));
                *copy = copy.moved(layer);
            }
            descent.looked_at = 0;
            let parts = descent.entered(cell, self.parts(base));
            let side = side / base;
            let parts = parts.into_iter().enumerate();
            let parts = parts.filter(|(_, part)| !part.is_empty());
            open.extend(parts.map(|(number, part)| {
                let corner = [column + number % base * side, row + number / base * side];
                (part, corner, side)
            }));
        }
        Some((bits, extent / real(base.pow(levels))))
    }

    /// Returns `true` if the unit box holds a point of the set; `copies` are those near it. Returns `None`
    /// where more than `left` copies would have to be examined.
    fn meets(&self, copies: &[LimitCopy<M>], left: &mut usize) -> Option<bool> {
        let lies_in = |copy: &LimitCopy<M>| {
            let point = copy.map.apply(self.objects[copy.object].point);
            let mut coordinates = point.coordinates().into_iter();
            coordinates.all(|at| (0.0..1.0).contains(&at))
        };
        if copies.iter().any(lies_in) {
            return Some(true);
        }
        let mut stack = copies.to_vec();
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
