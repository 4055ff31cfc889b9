//! How a set's mass is spread: generalised dimensions and lacunarity.

use crate::geometry::{DAffine2, DVec2};

use super::bits::Bits;
use super::limit::LimitSet;
use super::points::Points;
use super::regression::{Estimate, Reading, estimate};

/// Boxes in a row of the finest grid, at most.
const MOST_BOXES: usize = 2048;

/// The mass in every box of a grid.
#[derive(Clone, Debug)]
pub struct Masses {
    width: usize,
    height: usize,
    /// The side of a box, in the units of the set.
    size: f64,
    masses: Vec<u32>,
}

/// A dimension of the spectrum D_q (Hentschel & Procaccia 1983), and its evidence.
#[derive(Clone, Debug)]
pub struct Generalised {
    /// The order: 0 counts boxes, 1 is the information dimension, 2 the correlation dimension.
    pub order: f64,
    /// The dimension; none if there are fewer than three sizes.
    pub estimate: Option<Estimate>,
    /// By the side of the boxes, from the largest on: ln Σ p^q / (1 − q), or −Σ p ln p for q = 1,
    /// where p are the parts of the mass in the boxes.
    pub entropies: Vec<(f64, f64)>,
}

/// Lacunarity for boxes of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lacunarity {
    /// The side of the gliding box, in the units of the set.
    pub size: f64,
    /// ⟨m²⟩ / ⟨m⟩² over all places of the box in the grid, where m is the mass in it; at least 1.
    pub value: f64,
    /// The number of places.
    pub places: u64,
}

impl Masses {
    /// Of a picture: every set pixel has a mass of 1.
    #[must_use]
    pub fn of_pixels(pixels: &Bits) -> Self {
        let longest = pixels.width().max(pixels.height());
        let side = longest.div_ceil(MOST_BOXES).next_power_of_two();
        let (width, height) = (
            pixels.width().div_ceil(side),
            pixels.height().div_ceil(side),
        );
        #[expect(clippy::cast_precision_loss, reason = "pictures are smaller than that")]
        let mut grid = Self::empty(width, height, side as f64);
        for row in 0..pixels.height() {
            let masses = &mut grid.masses[row / side * width..][..width];
            for (number, &word) in pixels.row(row).iter().enumerate() {
                let mut left = word;
                while left != 0 {
                    let bit = left.trailing_zeros() as usize;
                    // All bits of a box that lie in this word.
                    let column = (64 * number + bit) / side;
                    let end = (column + 1) * side - 64 * number;
                    let mask = if end >= 64 { u64::MAX } else { (1 << end) - 1 };
                    masses[column] += (left & mask).count_ones();
                    left &= !mask;
                }
            }
        }
        grid
    }

    /// Of points: every one has a mass of 1.
    #[must_use]
    pub fn of_points(points: &Points) -> Self {
        let bounds = points.bounds();
        // As many boxes as there may be points in them.
        let few = (points.len() / 4).clamp(4, MOST_BOXES).next_power_of_two();
        let (map, mut grid) = Self::over(bounds.min(), bounds.size(), few.min(MOST_BOXES));
        for &point in points.as_slice() {
            let number = grid.number(map.transform_point2(point));
            grid.masses[number] = grid.masses[number].saturating_add(1);
        }
        grid
    }

    /// Of a limit set: every box of the finest grid that the set meets has a mass of 1.
    #[must_use]
    pub fn of_limit(set: &LimitSet) -> Self {
        const BOXES: usize = 1024;
        let bounds = set.bounds();
        let (map, mut grid) = Self::over(bounds.min(), bounds.size(), BOXES);
        let bits = set.cover(&map, [grid.width, grid.height]);
        for row in 0..grid.height {
            for column in 0..grid.width {
                grid.masses[row * grid.width + column] = u32::from(bits.get(column, row));
            }
        }
        grid
    }

    fn empty(width: usize, height: usize, size: f64) -> Self {
        Self {
            width,
            height,
            size,
            masses: vec![0; width * height],
        }
    }

    /// A grid over an extent that is not 0, and the map to it.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "grids are small"
    )]
    fn over(corner: DVec2, extent: DVec2, boxes: usize) -> (DAffine2, Self) {
        const HAIR: f64 = 1.0 + 1e-9;
        let size = extent.max_element() * HAIR / boxes as f64;
        let map =
            DAffine2::from_scale(DVec2::splat(1.0 / size)) * DAffine2::from_translation(-corner);
        let side = |extent: f64| ((extent / size) as usize + 1).min(boxes);
        (map, Self::empty(side(extent.x), side(extent.y), size))
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "points lie on the grid, and casts from floats saturate"
    )]
    fn number(&self, at: DVec2) -> usize {
        let (column, row) = (at.x as usize, at.y as usize);
        row.min(self.height - 1) * self.width + column.min(self.width - 1)
    }

    /// The masses in boxes twice as large.
    fn folded(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut folded = Self::empty(width, height, 2.0 * self.size);
        for (row, masses) in self.masses.chunks_exact(self.width).enumerate() {
            let sums = &mut folded.masses[row / 2 * width..][..width];
            for (sum, pair) in sums.iter_mut().zip(masses.chunks(2)) {
                *sum += pair.iter().sum::<u32>();
            }
        }
        folded
    }

    /// The spectrum of dimensions for orders q, each by a regression over all sizes of boxes that
    /// are at least `finest` and at most a quarter of the grid.
    #[must_use]
    pub fn spectrum(&self, orders: &[f64], finest: f64) -> Vec<Generalised> {
        let mut grids = vec![self.clone()];
        while let Some(last) = grids.last()
            && last.width.max(last.height) > 4
        {
            grids.push(last.folded());
        }
        grids.retain(|grid| grid.size >= finest);
        grids.reverse();
        let of = |&order: &f64| {
            let entropies: Vec<_> = grids
                .iter()
                .map(|grid| (grid.size, grid.entropy(order)))
                .collect();
            let readings = entropies.iter().map(|&(size, entropy)| Reading {
                size,
                log: entropy,
                scatter: 0.0,
                growth_error: 0.0,
            });
            Generalised {
                order,
                estimate: estimate(&readings.collect::<Vec<_>>()),
                entropies,
            }
        };
        orders.iter().map(of).collect()
    }

    /// The Rényi entropy of the masses (Rényi 1961), in nats.
    fn entropy(&self, order: f64) -> f64 {
        let total: f64 = self.masses.iter().map(|&mass| f64::from(mass)).sum();
        // Few masses are different where there are many boxes.
        let mut masses: Vec<u32> = self
            .masses
            .iter()
            .copied()
            .filter(|&mass| mass > 0)
            .collect();
        masses.sort_unstable();
        let runs = masses.chunk_by(|a, b| a == b);
        let information = (order - 1.0).abs() < 1e-9;
        let parts = runs.map(|run| {
            let part = f64::from(run[0]) / total;
            #[expect(clippy::cast_precision_loss, reason = "grids are small")]
            let times = run.len() as f64;
            if information {
                -times * part * libm::log(part)
            } else {
                times * libm::pow(part, order)
            }
        });
        let sum: f64 = parts.sum();
        if information {
            sum
        } else {
            libm::log(sum) / (1.0 - order)
        }
    }

    /// Lacunarity by gliding boxes (Allain & Cloitre 1991), of 1, 2, 4 … boxes of the grid.
    #[must_use]
    pub fn lacunarity(&self) -> Vec<Lacunarity> {
        let stride = self.width + 1;
        // Sums over all that is left of and above a corner.
        let mut sums = vec![0u64; stride * (self.height + 1)];
        for (row, masses) in self.masses.chunks_exact(self.width).enumerate() {
            let mut along = 0;
            for (column, &mass) in masses.iter().enumerate() {
                along += u64::from(mass);
                sums[(row + 1) * stride + column + 1] = sums[row * stride + column + 1] + along;
            }
        }
        let shortest = self.width.min(self.height);
        let sides = std::iter::successors(Some(1), |side| Some(2 * side));
        let of = |side: usize| {
            let (mut first, mut second) = (0.0, 0.0);
            let (columns, rows) = (self.width - side + 1, self.height - side + 1);
            for row in 0..rows {
                let [above, below] = [row, row + side].map(|row| &sums[row * stride..][..stride]);
                for column in 0..columns {
                    let mass =
                        below[column + side] + above[column] - below[column] - above[column + side];
                    #[expect(clippy::cast_precision_loss, reason = "a mean is rounded")]
                    let mass = mass as f64;
                    first += mass;
                    second += mass * mass;
                }
            }
            let places = (columns * rows) as u64;
            #[expect(clippy::cast_precision_loss, reason = "grids are small")]
            let (count, larger) = (places as f64, side as f64);
            Lacunarity {
                size: larger * self.size,
                value: second * count / (first * first),
                places,
            }
        };
        sides.take_while(|&side| side <= shortest).map(of).collect()
    }
}
