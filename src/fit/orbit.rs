//! The attractor of a candidate, by one point of it for each cell: fast enough for a search.

use crate::Bits;
use crate::geometry::{DAffine2, DMat2, DVec2};

use super::{Candidate, Silhouette};

/// Radii, in cells, at which a candidate is compared with a shape, and their weights.
pub(super) const REACHES: [(usize, f64); 5] = [(0, 1.0), (1, 0.8), (2, 0.5), (4, 0.4), (8, 0.3)];

/// A shape in cells that are larger or smaller than the pixels of its picture, with a margin.
#[derive(Clone, Debug)]
pub(super) struct Level {
    /// Cells in a pixel along an axis.
    scale: f64,
    /// Map from coordinates of the picture to cells, whose rows run from the top.
    there: DAffine2,
    back: DAffine2,
    /// The shape, and the shape dilated by each of [`REACHES`].
    near: Vec<Bits>,
    count: f64,
}

impl Level {
    /// Creates the level at which a picture's long side has at most `side` cells; larger pictures are folded.
    #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
    pub(super) fn new(shape: &Silhouette, side: usize) -> Self {
        let [width, height] = shape.size();
        let factor = width.max(height).div_ceil(side).max(1);
        let scale = 1.0 / factor as f64;
        let inner = [width, height].map(|length| length.div_ceil(factor));
        let margin = inner[0].max(inner[1]) / 4 + 9;
        let mut bits = Bits::new(inner[0] + 2 * margin, inner[1] + 2 * margin);
        for [column, row] in shape.bits().set_boxes() {
            bits.set(column / factor + margin, row / factor + margin);
        }
        let mut near = vec![bits];
        for pair in REACHES.windows(2) {
            let mut next = near[near.len() - 1].clone();
            spread(&mut next, pair[1].0 - pair[0].0);
            near.push(next);
        }
        let there = DAffine2::from_mat2_translation(
            DMat2::from_diagonal(DVec2::new(scale, -scale)),
            DVec2::new(margin as f64, height as f64 * scale + margin as f64),
        );
        Self {
            scale,
            there,
            back: there.inverse(),
            count: near[0].count() as f64,
            near,
        }
    }

    /// Returns the number of cells in a pixel along an axis.
    pub(super) fn scale(&self) -> f64 {
        self.scale
    }

    /// Returns the cells of the shape.
    pub(super) fn cells(&self) -> &Bits {
        &self.near[0]
    }

    /// Returns the map from pixels to cells.
    pub(super) fn there(&self) -> &DAffine2 {
        &self.there
    }

    /// Returns the map from cells to pixels.
    pub(super) fn back(&self) -> &DAffine2 {
        &self.back
    }
}

/// Room for attractors, which is used again for each.
#[derive(Clone, Debug)]
pub(super) struct Orbit {
    cells: Bits,
    spread: Bits,
    queue: Vec<DVec2>,
    /// Number of images outside the cells and their margin.
    lost: usize,
}

impl Orbit {
    /// Creates the room for the attractors of a level.
    pub(super) fn new(level: &Level) -> Self {
        let cells = Bits::new(level.near[0].width(), level.near[0].height());
        Self {
            spread: cells.clone(),
            cells,
            queue: Vec::new(),
            lost: 0,
        }
    }

    /// Fills the cells that hold a point of a candidate's attractor.
    ///
    /// A point is kept for each cell, and the images of a point stand for those of all points of its cell: every cell
    /// that is filled holds a point of the attractor, and every point of the attractor lies within a cell's diagonal
    /// over one less the contraction of a filled cell.
    pub(super) fn fill(&mut self, candidate: &Candidate, level: &Level) {
        self.cells.clear();
        self.queue.clear();
        self.lost = 0;
        for point in candidate.fixed_points() {
            self.add(level.there.transform_point2(point));
        }
        for disk in &candidate.disks {
            let centre = level.there.transform_point2(disk.centre);
            self.add_disk(centre, disk.radius * level.scale);
        }
        let maps: Vec<DAffine2> = { candidate.maps.iter() }
            .map(|map| level.there * *map * level.back)
            .collect();
        let mut next = 0;
        while let Some(&point) = self.queue.get(next) {
            next += 1;
            for map in &maps {
                self.add(map.matrix2 * point + map.translation);
            }
        }
    }

    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "cells outside are compared with the size"
    )]
    fn add(&mut self, point: DVec2) {
        let [column, row] = [point.x as i64 as usize, point.y as i64 as usize];
        if column >= self.cells.width()
            || row >= self.cells.height()
            || point.x < 0.0
            || point.y < 0.0
        {
            self.lost += 1;
        } else if self.cells.insert(column, row) {
            self.queue.push(point);
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "disks are small")]
    fn add_disk(&mut self, centre: DVec2, radius: f64) {
        self.add(centre);
        let radius = radius.min(1e4);
        let reach = radius.ceil() as i64;
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                #[expect(clippy::cast_precision_loss, reason = "disks are small")]
                let offset = DVec2::new(dx as f64, dy as f64);
                if offset.length_squared() <= radius * radius {
                    self.add(centre + offset);
                }
            }
        }
    }

    /// Returns how far the attractor of a candidate is from the shape: the mean, weighted by [`REACHES`], of one less
    /// the quotient of intersection and union, where cells within the reach of the other set count as common.
    ///
    /// It is 0 if the cells are the same.
    pub(super) fn loss(&mut self, candidate: &Candidate, level: &Level) -> f64 {
        self.fill(candidate, level);
        #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
        let lost = self.lost as f64;
        self.spread.copy(&self.cells);
        let (mut sum, mut weights, mut before) = (0.0, 0.0, 0);
        for (&(reach, weight), near) in REACHES.iter().zip(&level.near) {
            spread(&mut self.spread, reach - before);
            before = reach;
            let missed = outside(&level.near[0], &self.spread);
            let strayed = outside(&self.cells, near) + lost;
            sum += weight * (missed + strayed) / (level.count + strayed);
            weights += weight;
        }
        sum / weights
    }

    /// Returns the number of cells of the attractor and of the shape that are not next to a cell of the other.
    pub(super) fn misfit(&mut self, candidate: &Candidate, level: &Level) -> f64 {
        self.fill(candidate, level);
        #[expect(clippy::cast_precision_loss, reason = "pictures are small")]
        let lost = self.lost as f64;
        self.spread.copy(&self.cells);
        spread(&mut self.spread, REACHES[1].0);
        outside(&level.near[0], &self.spread) + outside(&self.cells, &level.near[1]) + lost
    }

    /// Returns intersection over union of the cells of the attractor and the shape.
    pub(super) fn iou(&mut self, candidate: &Candidate, level: &Level) -> f64 {
        self.fill(candidate, level);
        let missed = outside(&level.near[0], &self.cells);
        let strayed = outside(&self.cells, &level.near[0]);
        (level.count - missed) / (level.count + strayed)
    }
}

/// Returns the number of cells of one set that another of the same size lacks.
#[expect(clippy::cast_precision_loss, reason = "pictures are small")]
pub(super) fn outside(one: &Bits, other: &Bits) -> f64 {
    let words = one.words().iter().zip(other.words());
    let count: u64 = words.map(|(a, b)| u64::from((a & !b).count_ones())).sum();
    count as f64
}

/// Unites a set, which stays in its frame, with its copies at the offsets of −`by`, 0 and `by` < 64 along each axis: if it
/// is dilated by squares of at least `by` cells already, these grow by `by` on all sides.
fn spread(bits: &mut Bits, by: usize) {
    if by == 0 {
        return;
    }
    let stride = bits.stride();
    let last = bits.last_word();
    let words = bits.words_mut();
    for row in words.chunks_exact_mut(stride) {
        let mut before = 0;
        for column in 0..stride {
            let word = row[column];
            let after = row.get(column + 1).copied().unwrap_or(0);
            let right = word << by | before >> (64 - by);
            let left = word >> by | after << (64 - by);
            before = word;
            row[column] |= right | left;
        }
        row[stride - 1] &= last;
    }
    let rows = words.len() / stride;
    // Upwards in place, with the rows as they were kept for as long as they are read.
    let mut kept: Vec<u64> = Vec::with_capacity(by * stride);
    for row in 0..rows {
        let place = row % by * stride;
        for column in 0..stride {
            let index = row * stride + column;
            let own = words[index];
            let below = if row + by < rows {
                words[index + by * stride]
            } else {
                0
            };
            let above = if row >= by { kept[place + column] } else { 0 };
            words[index] = own | below | above;
            if row >= by {
                kept[place + column] = own;
            } else {
                kept.push(own);
            }
        }
    }
}
