//! Self-affine carpets, whose box and Hausdorff dimensions differ (Bedford 1984; McMullen 1984; Lalley & Gatzouras
//! 1992).
//!
//! The maps of a carpet scale the axes, all more along one axis than along the other. Images of the box are rectangles that
//! overlap in sides only, in columns along the stronger contraction: two columns are equal or overlap in sides only.
//!
//! With the widths a of columns, and the heights b of rectangles, Σ a^D₁ = 1 over columns defines the dimension of the
//! projection, and Σ a^D₁ b^(D − D₁) = 1 over rectangles the box dimension. The Hausdorff dimension is the largest dimension
//! of a self-affine measure (Lalley & Gatzouras 1992). By Lagrange multipliers, the largest one has probabilities
//! p = a^t Z^θ b^s / Z, where Z = Σ b^s over the rectangle's column, and Σ a^t Z^θ = 1 over columns. For a given s, θ is the
//! one that minimises t; one of these measures has the largest dimension.

use glam::DMat3;

use super::system::GraphDirectedSystem;
use crate::expression::degrees;
use crate::measure::perron::crossing;

/// Dimensions of a carpet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Carpet {
    pub(super) box_dimension: f64,
    pub(super) hausdorff: f64,
    /// Whether all columns have one width and all rectangles one height.
    pub(super) is_grid: bool,
    /// Whether no two rectangles touch.
    pub(super) is_apart: bool,
}

impl Carpet {
    /// Returns the kind of the carpet, with its source.
    pub(super) fn described(&self) -> &'static str {
        match self.is_grid {
            true => "carpet (Bedford 1984; McMullen 1984)",
            false => "carpet (Lalley & Gatzouras 1992)",
        }
    }
}

/// Difference up to which ends of intervals are equal, relative to the box.
const SAME: f64 = 1e-9;

/// Smallest width and height of a rectangle, relative to the box.
const SMALLEST: f64 = 1e-6;

/// A column of rectangles, by the logarithms of its width and of their heights.
struct Column {
    width: f64,
    heights: Vec<f64>,
}

/// An image of the box: intervals along both axes, its factors along them, and whether the first one is mirrored.
#[derive(Clone, Copy)]
struct Rectangle {
    intervals: [[f64; 2]; 2],
    factors: [f64; 2],
    is_mirrored: bool,
}

/// Returns the dimensions of a set, if it is a carpet.
pub(super) fn carpet(part: &GraphDirectedSystem) -> Option<Carpet> {
    const MAX_MAPS: usize = 500;
    if part.space != 2 || part.size != 1 || !(2..=MAX_MAPS).contains(&part.copies.len()) {
        return None;
    }
    let maps = part.copies.iter().map(|copy| copy.map);
    let diagonal = |matrix: DMat3| {
        let [x, y] = [matrix.x_axis, matrix.y_axis];
        let size = x.x.abs().max(y.y.abs());
        let is_diagonal = x.y.abs().max(y.x.abs()) <= 1e-14 * size;
        (is_diagonal && x.x.abs().min(y.y.abs()) > 0.0).then_some([x.x, y.y])
    };
    let axes: Option<Vec<_>> = { maps }
        .map(|map| {
            let factors = diagonal(map.matrix3)?;
            Some([0, 1].map(|axis: usize| (factors[axis], map.translation[axis])))
        })
        .collect();
    let axes = axes?;
    // The first axis is the one along which maps contract less.
    let wide = |of: &[(f64, f64); 2]| of[0].0.abs() > of[1].0.abs() * (1.0 + SAME);
    let axes: Vec<_> = match axes.iter().all(wide) {
        true => axes,
        false => axes.into_iter().map(|[x, y]| [y, x]).collect(),
    };
    if !axes.iter().all(wide) {
        return None;
    }
    let rectangles = rectangles(&axes)?;
    let (columns, is_apart) = columns(&rectangles)?;
    let first = &columns[0];
    let equal = |a: f64, b: f64| (a - b).abs() <= SAME;
    let is_grid = columns.iter().all(|column| {
        let mut heights = column.heights.iter();
        equal(column.width, first.width) && heights.all(|&it| equal(it, first.heights[0]))
    });
    let box_dimension = box_dimension(&columns);
    Some(Carpet {
        box_dimension,
        hausdorff: hausdorff(&columns)
            .unwrap_or(box_dimension)
            .min(box_dimension),
        is_grid,
        is_apart,
    })
}

/// Returns the images of the box of the set, in units of the box; `None` for a set in a line.
fn rectangles(axes: &[[(f64, f64); 2]]) -> Option<Vec<Rectangle>> {
    const MAX_ROUNDS: u32 = 100_000;
    let hull = |axis: usize| {
        let (mut low, mut high) = (0.0f64, 0.0f64);
        for _ in 0..MAX_ROUNDS {
            let ends = axes.iter().map(|map| {
                let (factor, shift) = map[axis];
                let [a, b] = [factor * low + shift, factor * high + shift];
                [a.min(b), a.max(b)]
            });
            let [next_low, next_high] = ends
                .reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
                .unwrap_or_default();
            if next_low == low && next_high == high {
                return Some([low, high]);
            }
            (low, high) = (next_low, next_high);
        }
        None
    };
    let box_of_set = [hull(0)?, hull(1)?];
    let [width, height] = box_of_set.map(|[low, high]| high - low);
    let size = width.max(height);
    if !(size.is_finite() && width.min(height) > SAME * size) {
        return None;
    }
    let rectangle = |map: &[(f64, f64); 2]| Rectangle {
        intervals: [0, 1].map(|axis: usize| {
            let ([low, high], (factor, shift)) = (box_of_set[axis], map[axis]);
            let [a, b] = [low, high].map(|end| (factor * end + shift - low) / (high - low));
            [a.min(b), a.max(b)]
        }),
        factors: map.map(|(factor, _)| factor.abs()),
        is_mirrored: map[0].0 < 0.0,
    };
    let rectangles: Vec<_> = axes.iter().map(rectangle).collect();
    let mut factors = rectangles.iter().flat_map(|it| it.factors);
    factors
        .all(|factor| factor > SMALLEST)
        .then_some(rectangles)
}

/// Returns the columns of rectangles, and whether no two rectangles touch, or `None` if columns or rectangles overlap.
fn columns(rectangles: &[Rectangle]) -> Option<(Vec<Column>, bool)> {
    let mut sorted = rectangles.to_vec();
    let is_same = |a: [f64; 2], b: [f64; 2]| (0..2).all(|end| (a[end] - b[end]).abs() <= SAME);
    sorted.sort_by(|a, b| a.intervals[0][0].total_cmp(&b.intervals[0][0]));
    let mut columns: Vec<Vec<Rectangle>> = Vec::new();
    let mut gaps: Vec<f64> = Vec::new();
    for rectangle in sorted {
        match columns.last_mut() {
            Some(column) if is_same(column[0].intervals[0], rectangle.intervals[0]) => {
                column.push(rectangle);
            }
            last => {
                let gap = last.map(|it| rectangle.intervals[0][0] - it[0].intervals[0][1]);
                gaps.extend(gap);
                columns.push(vec![rectangle]);
            }
        }
    }
    let column = |mut of: Vec<Rectangle>| {
        if of.iter().any(|it| it.is_mirrored != of[0].is_mirrored) {
            return None;
        }
        of.sort_by(|a, b| a.intervals[1][0].total_cmp(&b.intervals[1][0]));
        let pairs = of.windows(2);
        gaps.extend(pairs.map(|pair| pair[1].intervals[1][0] - pair[0].intervals[1][1]));
        let heights = of.iter().map(|it| libm::log(it.factors[1]));
        Some(Column {
            width: libm::log(of[0].factors[0]),
            heights: heights.collect(),
        })
    };
    let columns = columns
        .into_iter()
        .map(column)
        .collect::<Option<Vec<_>>>()?;
    let least = gaps.into_iter().fold(f64::INFINITY, f64::min);
    (least >= -SAME).then_some((columns, least > SAME))
}

/// Returns the exponent at which a sum of powers of numbers below 1 is 1; 0 if it is below 1 there.
fn exponent(sum: impl Fn(f64) -> f64) -> f64 {
    if sum(0.0) <= 1.0 {
        return 0.0;
    }
    let mut high = 1.0;
    while sum(high) > 1.0 {
        high *= 2.0;
    }
    crossing(high, 0.0, sum)
}

fn box_dimension(columns: &[Column]) -> f64 {
    let projection = exponent(|exponent| {
        let widths = columns.iter();
        widths
            .map(|column| libm::exp(exponent * column.width))
            .sum()
    });
    let rest = exponent(|rest| {
        let column = |column: &Column| libm::exp(projection * column.width) * column.sum(rest);
        columns.iter().map(column).sum()
    });
    projection + rest
}

impl Column {
    /// Returns the sum of powers of the heights.
    fn sum(&self, exponent: f64) -> f64 {
        let powers = self
            .heights
            .iter()
            .map(|height| libm::exp(exponent * height));
        powers.sum()
    }
}

/// Returns the Hausdorff dimension; `None` if it is the box dimension, since all columns have one dimension.
fn hausdorff(columns: &[Column]) -> Option<f64> {
    // Between the smallest and the largest of the dimensions of columns, Σ q log Z = 0 has a solution.
    let roots = columns.iter().map(|column| exponent(|s| column.sum(s)));
    let (low, high) = roots.fold((f64::INFINITY, 0.0f64), |(low, high), root| {
        (low.min(root), high.max(root))
    });
    if high - low <= 1e-12 {
        return None;
    }
    // Several measures may be locally the largest (Barral & Feng 2011): each maximum of a table, denser at the ends, is
    // refined.
    const PLACES: u32 = 96;
    let place = |number: u32| {
        let angle = 180.0 * f64::from(number) / f64::from(PLACES);
        low + (high - low) * (1.0 - degrees::cos(angle)) / 2.0
    };
    let dimension = |s: f64| measure_dimension(columns, s);
    let table: Vec<f64> = (0..=PLACES)
        .map(|number| dimension(place(number)))
        .collect();
    let mut largest = table.iter().copied().fold(0.0, f64::max);
    for (number, values) in (1..).zip(table.windows(3)) {
        if values[1] >= values[0].max(values[2]) {
            let range = [number - 1, number + 1].map(place);
            largest = largest.max(maximum(range, dimension));
        }
    }
    Some(largest)
}

/// Returns the maximum of a function with one maximum in a range, by golden-section search (Kiefer 1953). It finds the
/// place to half of the digits, and so the value to all.
fn maximum([mut from, mut to]: [f64; 2], value: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    const ROUNDS: u32 = 40;
    let place = |from: f64, to: f64, share: f64| from + (to - from) * share;
    let mut inner = [1.0 - GOLDEN, GOLDEN].map(|share| place(from, to, share));
    let mut values = inner.map(&value);
    for _ in 0..ROUNDS {
        if values[0] < values[1] {
            from = inner[0];
            inner = [inner[1], place(from, to, GOLDEN)];
            values = [values[1], value(inner[1])];
        } else {
            to = inner[1];
            inner = [place(from, to, 1.0 - GOLDEN), inner[0]];
            values = [value(inner[0]), values[0]];
        }
    }
    values[0].max(values[1])
}

/// Returns the dimension of the self-affine measure for an exponent of heights, by the formula of Ledrappier and Young.
fn measure_dimension(columns: &[Column], s: f64) -> f64 {
    let sums = columns.iter().map(|column| libm::log(column.sum(s)));
    let sums: Vec<f64> = sums.collect();
    // Σ q log Z rises with θ, and is 0 at the θ that minimises t.
    let mean = |theta: f64| {
        let shares = shares(columns, &sums, theta);
        shares.iter().zip(&sums).map(|(q, z)| q * z).sum::<f64>()
    };
    let mut reach = 1.0;
    while reach < 1e6 && !(mean(-reach) < 0.0 && mean(reach) > 0.0) {
        reach *= 2.0;
    }
    let theta = crossing(-reach, reach, |theta| 1.0 + mean(theta));
    let shares = shares(columns, &sums, theta);
    let (mut widths, mut heights, mut projected, mut inside) = (0.0, 0.0, 0.0, 0.0);
    for ((column, q), z) in columns.iter().zip(&shares).zip(&sums) {
        widths -= q * column.width;
        if *q > 0.0 {
            projected -= q * libm::log(*q);
        }
        for height in &column.heights {
            let logarithm = s * height - z;
            let share = q * libm::exp(logarithm);
            heights -= share * height;
            inside -= share * logarithm;
        }
    }
    projected / widths + inside / heights
}

/// Returns the probabilities a^t Z^θ of columns, where t is chosen so that their sum is 1.
fn shares(columns: &[Column], sums: &[f64], theta: f64) -> Vec<f64> {
    const MAX_ROUNDS: u32 = 100;
    let mut t = 1.0;
    let mut shares = vec![0.0; columns.len()];
    for _ in 0..MAX_ROUNDS {
        // Newton's method on the logarithm of the sum, which is convex in t.
        let powers = columns.iter().zip(sums);
        let powers = powers.map(|(column, z)| t * column.width + theta * z);
        let largest = powers.clone().fold(f64::NEG_INFINITY, f64::max);
        for (share, power) in shares.iter_mut().zip(powers) {
            *share = libm::exp(power - largest);
        }
        let sum: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share /= sum);
        let slope: f64 = { shares.iter().zip(columns) }
            .map(|(share, column)| share * column.width)
            .sum();
        let step = (largest + libm::log(sum)) / slope;
        t -= step;
        if step.abs() <= 1e-14 * (1.0 + t.abs()) {
            break;
        }
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{DAffine2, DMat2, DVec2};

    fn of(maps: &[[f64; 4]]) -> Option<Carpet> {
        let maps = maps.iter().map(|&[a, b, x, y]| {
            let linear = DMat2::from_diagonal(DVec2::new(a, b));
            (
                0,
                0,
                DAffine2::from_mat2_translation(linear, DVec2::new(x, y)),
            )
        });
        carpet(&GraphDirectedSystem::plane(maps)?)
    }

    /// Bedford–McMullen carpets: log_m Σ t^(log_n m) and log_m c + log_n (N/c), with t of N rectangles in each of c columns.
    #[test]
    fn grids_have_closed_forms() {
        for (columns, rows, cells) in [
            (2, 3, vec![[0, 0], [1, 1], [0, 2]]),
            (3, 5, vec![[0, 0], [0, 1], [0, 4], [2, 2], [1, 1], [1, 3]]),
            (
                4,
                9,
                vec![[3, 0], [3, 8], [0, 8], [1, 8], [1, 0], [1, 3], [1, 5]],
            ),
        ] {
            let (m, n) = (f64::from(columns), f64::from(rows));
            let maps = cells
                .iter()
                .map(|&[x, y]| [1.0 / m, 1.0 / n, f64::from(x) / m, f64::from(y) / n]);
            let maps: Vec<_> = maps.collect();
            let counts: Vec<f64> = (0..columns)
                .map(|column| cells.iter().filter(|cell| cell[0] == column).count() as f64)
                .filter(|count| *count > 0.0)
                .collect();
            let power = m.ln() / n.ln();
            let hausdorff = counts.iter().map(|t| t.powf(power)).sum::<f64>().ln() / m.ln();
            let used = counts.len() as f64;
            let boxes = used.ln() / m.ln() + (cells.len() as f64 / used).ln() / n.ln();
            let found = of(&maps).unwrap();
            assert!(
                (found.hausdorff - hausdorff).abs() < 1e-12,
                "{found:?} {hausdorff}"
            );
            assert!(
                (found.box_dimension - boxes).abs() < 1e-12,
                "{found:?} {boxes}"
            );
            assert!(found.is_grid);
            // The other axis, mirrored maps and another place make no difference.
            let turned: Vec<_> = maps
                .iter()
                .map(|&[a, b, x, y]| [-b, a, 5.0 - y, x - 2.0])
                .collect();
            let again = of(&turned).unwrap();
            assert!((again.hausdorff - hausdorff).abs() < 1e-12, "{again:?}");
            assert!((again.box_dimension - boxes).abs() < 1e-12, "{again:?}");
        }
    }

    /// No self-affine measure has a larger dimension, and the best one is approached by those near it.
    #[test]
    fn no_measure_has_a_larger_dimension() {
        let maps = [
            [0.5, 0.2, 0.0, 0.0],
            [0.5, 0.3, 0.0, 0.7],
            [0.3, 0.1, 0.6, 0.0],
            [0.3, 0.15, 0.6, 0.3],
            [0.3, 0.05, 0.6, 0.9],
        ];
        let found = of(&maps).unwrap();
        assert!(!found.is_grid && found.hausdorff < found.box_dimension);
        let dimension = |weights: &[f64]| {
            let total: f64 = weights.iter().sum();
            let p: Vec<f64> = weights.iter().map(|weight| weight / total).collect();
            let q = [p[0] + p[1], p[2] + p[3] + p[4]];
            let entropy = |shares: &[f64]| -shares.iter().map(|p| p * p.ln()).sum::<f64>();
            let b: f64 = p.iter().zip(maps).map(|(p, map)| -p * map[1].ln()).sum();
            let a: f64 = -(q[0] * 0.5f64.ln() + q[1] * 0.3f64.ln());
            entropy(&p) / b + entropy(&q) * (1.0 / a - 1.0 / b)
        };
        let mut random = crate::random::Pcg::new(3, 5);
        let (mut best, mut weights) = (0.0, vec![1.0; 5]);
        for round in 0..200_000 {
            let size = libm::pow(0.5, f64::from(round / 8000));
            let next: Vec<f64> = weights
                .iter()
                .map(|weight: &f64| weight * (size * (random.unit() - 0.5)).exp())
                .collect();
            let value = dimension(&next);
            assert!(value <= found.hausdorff + 1e-12, "{value} {found:?}");
            if value > best {
                (best, weights) = (value, next);
            }
        }
        assert!(found.hausdorff - best < 1e-9, "{best} {found:?}");
    }

    /// Of two measures that are locally the largest, the larger one counts.
    #[test]
    fn several_measures_may_be_locally_the_largest() {
        let maps = [
            [0.5, 0.499999, 0.0, 0.0],
            [0.5, 0.499999, 0.0, 0.500001],
            [0.5, 1e-4, 0.5, 0.3],
        ];
        let found = of(&maps).unwrap();
        let dimension = |q: f64| {
            let entropy = -q * q.ln() - (1.0 - q) * (1.0 - q).ln();
            let heights = -q * 0.499999f64.ln() - (1.0 - q) * 1e-4f64.ln();
            entropy / 2f64.ln() + q * 2f64.ln() / heights
        };
        let best = (1..10_000)
            .map(|q| dimension(f64::from(q) / 10_000.0))
            .fold(0.0, f64::max);
        assert!((found.hausdorff - best).abs() < 1e-6, "{found:?} {best}");
        assert!(found.box_dimension > best + 0.05 && !found.is_apart);
    }

    #[test]
    fn others_are_no_carpets() {
        let grid = [
            [0.5, 0.25, 0.0, 0.0],
            [0.5, 0.25, 0.5, 0.5],
            [0.5, 0.25, 0.0, 0.75],
        ];
        assert!(of(&grid).is_some());
        let with = |number: usize, map: [f64; 4]| {
            let mut maps = grid;
            maps[number] = map;
            of(&maps)
        };
        // Columns and rectangles that overlap, similarities, and columns of mirrored and other maps.
        assert!(with(2, [0.5, 0.25, 0.25, 0.75]).is_none());
        assert!(with(2, [0.5, 0.3, 0.0, 0.1]).is_none());
        assert!(with(1, [0.5, 0.5, 0.5, 0.5]).is_none());
        assert!(with(2, [-0.5, 0.25, 0.5, 0.75]).is_none());
        assert!(of(&grid[..1]).is_none());
        assert!(with(2, [0.5, 1e-9, 0.0, 0.75]).is_none());
        // Gaps between all rectangles.
        let apart = of(&[
            [0.4, 0.2, 0.0, 0.0],
            [0.4, 0.2, 0.6, 0.0],
            [0.4, 0.2, 0.0, 0.8],
        ]);
        assert!(apart.unwrap().is_apart && !of(&grid).unwrap().is_apart);
    }
}
