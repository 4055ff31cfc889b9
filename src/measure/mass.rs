//! The distribution of a set's mass over boxes, and its lacunarity.

use crate::bits::Bits;
use crate::geometry::{Bounds, Point};
use crate::saturating::{real, whole};

use super::cover::{Counts, Grid};
use super::limit::LimitSet;
use super::points::Points;
use super::sample::histogram;
use super::space::Space;

/// Maximum number of boxes in a row of the finest grid.
const MAX_BOXES: usize = 2048;

/// Maximum number of copies that are examined for the masses of a limit set.
const MAX_COPIES: usize = 1 << 20;

/// Side of the largest boxes from which a spectrum is computed, as a fraction of the extent.
pub(super) const COARSEST: f64 = 1.0 / 4.0;

/// Mass in every box of a grid.
#[derive(Clone, Debug)]
pub struct Masses {
    /// Number of axes, and numbers of boxes along these.
    dimension: usize,
    boxes: Counts,
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
        let mut grid = Self::empty(2, [width, height, 1], real(side));
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
    pub fn of_points<M: Space>(points: &Points<M>) -> Self {
        // The number of boxes in a row is a quarter of the number of places, from 4 to 2048 (64 in space), rounded up to a
        // power of two.
        let most = M::FINENESS[0].saturating_mul(2);
        let few = (points.places().count() / 4).clamp(4, most);
        let (own, turned) = points.own(&Grid::ALONG);
        let (map, mut grid) = Self::over(&own, &turned, few.next_power_of_two().min(most));
        for (at, points) in points.places() {
            let number = grid.number(map.apply(at));
            grid.masses[number] = grid.masses[number].saturating_add(points);
        }
        grid.size *= points.extent();
        grid
    }

    /// Computes the masses of a limit set: every box that the set meets, on a grid with `boxes` boxes along
    /// its longer side, has a mass of 1. Returns `None` where the set cannot be covered by boxes of this
    /// size.
    #[must_use]
    pub fn of_limit<M: Space>(set: &LimitSet<M>, grid: &Grid<M>, boxes: usize) -> Option<Self> {
        let (map, mut masses) = Self::over(grid, &set.turned_bounds(grid), boxes);
        let bits = set.covered(&map, masses.boxes, MAX_COPIES)?.into_layers();
        let width = masses.boxes[0];
        for (row, masses) in masses.masses.chunks_exact_mut(width).enumerate() {
            for (column, mass) in masses.iter_mut().enumerate() {
                *mass = u32::from(bits.get(column, row));
            }
        }
        Some(masses)
    }

    fn empty(dimension: usize, boxes: Counts, size: f64) -> Self {
        Self {
            dimension,
            boxes,
            size,
            masses: vec![0; boxes.iter().product()],
        }
    }

    /// Creates an empty grid with `boxes` boxes along the longer side of a turned box, and the map to it.
    fn over<M: Space>(grid: &Grid<M>, turned: &Bounds<M::Point>, boxes: usize) -> (M, Self) {
        let extent = turned.size().max_element();
        let size = extent * (1.0 + 4e-9) / real(boxes);
        let (map, boxes) = grid.map(turned, size, extent * COARSEST);
        (map, Self::empty(M::Point::DIMENSION, boxes, size))
    }

    fn number<P: Point>(&self, at: P) -> usize {
        let axes = at.coordinates().into_iter().zip(self.boxes);
        { axes.rev() }.fold(0, |number, (at, boxes)| {
            number * boxes + whole(at).min(boxes - 1)
        })
    }

    /// Returns the masses in boxes twice as large.
    pub(super) fn folded(&self) -> Self {
        let boxes = self.boxes.map(|boxes| boxes.div_ceil(2));
        let [width, height, _] = boxes;
        let mut folded = Self::empty(self.dimension, boxes, 2.0 * self.size);
        for (number, masses) in self.masses.chunks_exact(self.boxes[0]).enumerate() {
            let (layer, row) = (number / self.boxes[1], number % self.boxes[1]);
            let sums = &mut folded.masses[(layer / 2 * height + row / 2) * width..][..width];
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
        let sums = self.sums();
        let [across, down, _] = self.boxes.map(|boxes| boxes + 1);
        let used = self.boxes[..self.dimension].iter();
        let shortest = used.copied().min().unwrap_or(1);
        let sides = std::iter::successors(Some(1), |side| Some(2 * side));
        let of = |side: usize| {
            let (mut first, mut second) = (0.0, 0.0);
            // The layer of the plane is one box thick.
            let sides = self.boxes.map(|boxes| side.min(boxes));
            let [columns, rows, layers] = [0, 1, 2].map(|axis| self.boxes[axis] - sides[axis] + 1);
            for layer in 0..layers {
                for row in 0..rows {
                    let corner = |layer: usize, row: usize| &sums[(layer * down + row) * across..];
                    let [near, far] = [layer, layer + sides[2]]
                        .map(|layer| [row, row + sides[1]].map(|row| corner(layer, row)));
                    for column in 0..columns {
                        let end = column + sides[0];
                        let [[a, b], [c, d]] = [near, far]
                            .map(|both| both.map(|sums| sums[end].wrapping_sub(sums[column])));
                        let mass = d.wrapping_sub(c).wrapping_sub(b.wrapping_sub(a));
                        #[expect(clippy::cast_precision_loss, reason = "a mean is rounded")]
                        let mass = mass as f64;
                        first += mass;
                        second += mass * mass;
                    }
                }
            }
            let places = columns * rows * layers;
            Lacunarity {
                size: real(side) * self.size,
                value: second * real(places) / (first * first),
                places: places as u64,
            }
        };
        sides.take_while(|&side| side <= shortest).map(of).collect()
    }

    /// Returns the sums of the masses before every corner of the boxes, along all axes.
    fn sums(&self) -> Vec<u64> {
        let [across, down, deep] = self.boxes.map(|boxes| boxes + 1);
        let mut sums = vec![0u64; across * down * deep];
        for (number, masses) in self.masses.chunks_exact(self.boxes[0]).enumerate() {
            let (layer, row) = (number / self.boxes[1], number % self.boxes[1]);
            let at = |layer: usize, row: usize| (layer * down + row) * across;
            let mut along = 0;
            for (column, &mass) in masses.iter().enumerate() {
                along += u64::from(mass);
                let [behind, above, both] =
                    [at(layer, row + 1), at(layer + 1, row), at(layer, row)]
                        .map(|row| sums[row + column + 1]);
                sums[at(layer + 1, row + 1) + column + 1] = along + behind + above - both;
            }
        }
        sums
    }
}
