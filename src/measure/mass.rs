//! The distribution of a set's mass over boxes, and its lacunarity.

use crate::geometry::{Bounds, DAffine2, DVec2};
use crate::saturating::{real, whole};

use super::bits::Bits;
use super::cover::Grid;
use super::limit::LimitSet;
use super::points::Points;
use super::sample::histogram;

/// Maximum number of boxes in a row of the finest grid.
const MAX_BOXES: usize = 2048;

/// Numbers of boxes in a row of grids for limit sets, in the order of trial: where a grid cannot be filled,
/// the next one is tried.
pub const FINENESS: [usize; 4] = [1024, 512, 256, 128];

/// Side of the largest boxes from which a spectrum is computed, as a fraction of the extent.
pub(super) const COARSEST: f64 = 1.0 / 4.0;

/// Mass in every box of a grid.
#[derive(Clone, Debug)]
pub struct Masses {
    width: usize,
    height: usize,
    /// Side of a box, in the units of the set.
    size: f64,
    masses: Vec<u32>,
}

/// Lacunarity for boxes of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lacunarity {
    /// Side of the gliding box, in the units of the set.
    pub size: f64,
    /// ⟨m²⟩ / ⟨m⟩² over all positions of the box in the grid, where m is the mass in it; at least 1.
    pub value: f64,
    /// Number of positions.
    pub places: u64,
}

impl Masses {
    /// Computes the masses of a picture, in which every set pixel has a mass of 1. The grid begins `before`
    /// pixels left of the picture and `above` pixels above it.
    #[must_use]
    pub fn of_pixels(pixels: &Bits, [before, above]: [usize; 2]) -> Self {
        let longest = pixels.width().max(pixels.height());
        let side = longest.div_ceil(MAX_BOXES).next_power_of_two();
        let (width, height) = (
            (pixels.width() + before).div_ceil(side),
            (pixels.height() + above).div_ceil(side),
        );
        let mut grid = Self::empty(width, height, real(side));
        for row in 0..pixels.height() {
            let masses = &mut grid.masses[(row + above) / side * width..][..width];
            for (number, &word) in pixels.row(row).iter().enumerate() {
                let mut left = word;
                while left != 0 {
                    let bit = left.trailing_zeros() as usize;
                    // All bits of a box that lie in this word.
                    let column = (64 * number + bit + before) / side;
                    let end = (column + 1) * side - before - 64 * number;
                    let mask = if end >= 64 { u64::MAX } else { (1 << end) - 1 };
                    masses[column] += (left & mask).count_ones();
                    left &= !mask;
                }
            }
        }
        grid
    }

    /// Computes the masses of points, each of which has a mass of 1.
    #[must_use]
    pub fn of_points(points: &Points) -> Self {
        // The number of boxes in a row is a quarter of the number of places, from 4 to 2048, rounded up to a
        // power of two.
        let few = (points.places().count() / 4).clamp(4, MAX_BOXES);
        let (own, turned) = points.own(&Grid::ALONG);
        let (map, mut grid) = Self::over(&own, &turned, few.next_power_of_two().min(MAX_BOXES));
        for (at, points) in points.places() {
            let number = grid.number(map.transform_point2(at));
            grid.masses[number] = grid.masses[number].saturating_add(points);
        }
        grid.size *= points.extent();
        grid
    }

    /// Computes the masses of a limit set: every box that the set meets, on a grid with `boxes` boxes along
    /// its longer side, has a mass of 1. Returns `None` where the set cannot be covered by boxes of this
    /// size.
    #[must_use]
    pub fn of_limit(set: &LimitSet, grid: &Grid, boxes: usize) -> Option<Self> {
        let (map, mut masses) = Self::over(grid, &set.turned_bounds(grid), boxes);
        let bits = set.cover(&map, [masses.width, masses.height])?;
        for row in 0..masses.height {
            for column in 0..masses.width {
                masses.masses[row * masses.width + column] = u32::from(bits.get(column, row));
            }
        }
        Some(masses)
    }

    fn empty(width: usize, height: usize, size: f64) -> Self {
        Self {
            width,
            height,
            size,
            masses: vec![0; width * height],
        }
    }

    /// Creates an empty grid with `boxes` boxes along the longer side of a turned box, and the map to it.
    fn over(grid: &Grid, turned: &Bounds, boxes: usize) -> (DAffine2, Self) {
        let extent = turned.size().max_element();
        let size = extent * (1.0 + 4e-9) / real(boxes);
        let (map, [width, height]) = grid.map(turned, size, extent * COARSEST);
        (map, Self::empty(width, height, size))
    }

    fn number(&self, at: DVec2) -> usize {
        let [column, row] = at.to_array().map(whole);
        row.min(self.height - 1) * self.width + column.min(self.width - 1)
    }

    /// Returns the masses in boxes twice as large.
    pub(super) fn folded(&self) -> Self {
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

    /// Returns the side of a box, in the units of the set.
    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// Computes the Rényi entropies of the masses for several orders (Rényi 1961), in nats.
    pub(super) fn entropies(&self, orders: &[f64]) -> Vec<f64> {
        let total: f64 = self.masses.iter().map(|&mass| f64::from(mass)).sum();
        // There are few distinct masses where there are many boxes.
        let masses = self.masses.iter().copied();
        let masses = histogram(masses.filter(|&mass| mass > 0));
        let of = |&order: &f64| {
            let information = (order - 1.0).abs() < 1e-9;
            let parts = masses.iter().map(|&(mass, times)| {
                let part = f64::from(mass) / total;
                let times = f64::from(times);
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
        };
        orders.iter().map(of).collect()
    }

    /// Computes the lacunarity by gliding boxes (Allain & Cloitre 1991) with sides of 1, 2, 4 … boxes of the
    /// grid.
    #[must_use]
    pub fn lacunarity(&self) -> Vec<Lacunarity> {
        let stride = self.width + 1;
        // The sums of the masses left of and above every corner.
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
            let places = columns * rows;
            Lacunarity {
                size: real(side) * self.size,
                value: second * real(places) / (first * first),
                places: places as u64,
            }
        };
        sides.take_while(|&side| side <= shortest).map(of).collect()
    }
}
