//! Similar copies of a shape that lie inside it.

use std::collections::BTreeSet;

use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::parallel;

use super::ground::Ground;

/// A copy of the shape that lies nearly inside it, in the cells of a [`Ground`].
#[derive(Clone, Debug)]
pub(in crate::fit) struct Copy {
    pub(in crate::fit) map: DAffine2,
    /// Number of its ratio in [`ratios`].
    pub(in crate::fit) ratio: usize,
    /// Cells of the sample that it covers, as bits.
    pub(in crate::fit) covered: Vec<u64>,
    /// Cost by itself, as a number of points of the sample: of the error, and of the points covered, which breaks ties.
    pub(in crate::fit) price: f64,
}

impl Copy {
    #[expect(clippy::cast_precision_loss, reason = "samples are small")]
    fn new(ground: &Ground, map: DAffine2, error: f64, ratio: usize) -> Self {
        let covered = covered(ground, &map);
        let own: u32 = covered.iter().map(|word| word.count_ones()).sum();
        let excess = (error - 0.3).max(0.0);
        let price = f64::from(own) * (0.05 + 0.35 * excess) + 0.001 * ground.points().len() as f64;
        Self {
            map,
            ratio,
            covered,
            price,
        }
    }
}

/// Returns maximal disks of the shape, the largest first: each is a copy of the unit disk under a map of factor and shift.
#[expect(clippy::cast_precision_loss, reason = "samples are small")]
pub(in crate::fit) fn disks(ground: &Ground) -> Vec<Copy> {
    const DISKS: usize = 150;
    let points = ground.points();
    let mut radii: Vec<(f64, DVec2)> = { points.iter() }
        .map(|&point| (ground.depth(point), point))
        .collect();
    radii.sort_by(|a, b| b.0.total_cmp(&a.0));
    radii.truncate(DISKS);
    let copy = |(radius, centre): (f64, DVec2)| {
        let mut covered = vec![0; points.len().div_ceil(64)];
        for (number, point) in points.iter().enumerate() {
            if point.distance(centre) <= radius + 0.7 {
                covered[number / 64] |= 1 << (number % 64);
            }
        }
        let map = DAffine2::from_mat2_translation(DMat2::IDENTITY * radius, centre);
        let price = 0.001 * points.len() as f64;
        Copy {
            map,
            ratio: usize::MAX,
            covered,
            price,
        }
    };
    radii.into_iter().map(copy).collect()
}

/// Mean distance, in cells, up to which a copy counts as inside.
const MOST_ERROR: f64 = 1.6;
/// Largest number of copies of one ratio.
const COPIES: usize = 120;
/// Number of cells from which on positions are judged in a fifth of them.
const MANY: usize = 500;
/// Number of points by which positions are judged.
const SAMPLE: usize = 128;
/// Largest number of positions of one linear part.
const POSITIONS: usize = 6;

/// Returns the ratios of copies that are searched: those of known systems, and a geometric sequence.
pub(in crate::fit) fn ratios() -> Vec<f64> {
    let golden = (libm::sqrt(5.0) - 1.0) / 2.0;
    let mut ratios = vec![
        1.0 / 2.0,
        1.0 / 3.0,
        1.0 / 4.0,
        1.0 / 5.0,
        2.0 / 3.0,
        3.0 / 4.0,
    ];
    ratios.extend([2.0, 3.0, 5.0, 7.0].map(|square| 1.0 / libm::sqrt(square)));
    ratios.extend([golden, golden * golden]);
    let mut ratio = 0.2;
    while ratio < 0.93 {
        ratios.push(ratio);
        ratio *= 1.07;
    }
    ratios
}

/// Returns the angles of copies that are searched, in degrees: multiples of 5, 18 and 22.5.
fn angles() -> Vec<f64> {
    let tenths = |step: u32| (0..3600).step_by(step as usize);
    let all: BTreeSet<u32> = tenths(50).chain(tenths(180)).chain(tenths(225)).collect();
    all.into_iter()
        .map(|tenth| f64::from(tenth) / 10.0)
        .collect()
}

/// Returns the similar copies of a shape inside it, on any number of threads.
pub(in crate::fit) fn copies(ground: &Ground, threads: usize) -> Vec<Copy> {
    let ratios = ratios();
    let angles = angles();
    let found = parallel::map(&ratios, threads, |number, &ratio| {
        let mut copies = Vec::new();
        for &angle in &angles {
            for flip in [1.0, -1.0] {
                let turned = ratio * DVec2::from_angle(angle.to_radians());
                let matrix = DMat2::from_cols(turned, flip * turned.perp());
                positions(ground, matrix, &mut copies);
            }
        }
        copies.sort_by(|a: &(f64, DAffine2), b| a.0.total_cmp(&b.0));
        let mut kept: Vec<Copy> = Vec::new();
        for (error, map) in copies {
            if kept.len() == COPIES {
                break;
            }
            if kept
                .iter()
                .all(|other| apart(ground, &other.map, &map) > 2.5)
            {
                kept.push(Copy::new(ground, map, error, number));
            }
        }
        kept
    });
    found.into_iter().flatten().collect()
}

/// Returns the largest distance of the images of the shape's rim under two maps, in cells.
pub(in crate::fit) fn apart(ground: &Ground, one: &DAffine2, other: &DAffine2) -> f64 {
    let (middle, radius) = (ground.middle(), ground.radius());
    let offset = one.transform_point2(middle) - other.transform_point2(middle);
    let turned = one.matrix2 - other.matrix2;
    offset.length() + radius * (turned.x_axis.length() + turned.y_axis.length()) / 2.0
}

/// Adds the positions at which a linear image of the shape lies inside the shape.
fn positions(ground: &Ground, matrix: DMat2, found: &mut Vec<(f64, DAffine2)>) {
    let points: Vec<DVec2> = ground
        .points()
        .iter()
        .take(SAMPLE)
        .map(|&point| matrix * point)
        .collect();
    let Some((&first, others)) = points.split_first() else {
        return;
    };
    let mut own: Vec<(f64, DVec2)> = Vec::new();
    let is_large = ground.cells().len() > MANY;
    let most = MOST_ERROR + if is_large { 0.4 } else { 0.0 };
    let targets = ground.cells().iter();
    for &target in targets.filter(|cell| !is_large || is_on_sublattice(**cell)) {
        let shift = target - first;
        if let Some(error) = error_of(ground, others, shift, most) {
            own.push((error, shift));
        }
    }
    own.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept: Vec<DVec2> = Vec::new();
    for (_, shift) in own {
        if kept.len() == POSITIONS {
            break;
        }
        if kept.iter().any(|other| other.distance(shift) < 3.0) {
            continue;
        }
        kept.push(shift);
        let (error, shift) = settled(ground, &points, shift);
        if error <= MOST_ERROR {
            found.push((error, DAffine2::from_mat2_translation(matrix, shift)));
        }
    }
}

/// Returns whether a cell belongs to a lattice of a fifth of all cells, one of which is the cell or beside it.
fn is_on_sublattice(cell: DVec2) -> bool {
    (cell.x.floor() + 2.0 * cell.y.floor()).rem_euclid(5.0) == 0.0
}

/// Returns the mean distance of points from the shape; `None` once it is more than `most`.
#[inline]
#[expect(clippy::cast_precision_loss, reason = "samples are small")]
fn error_of(ground: &Ground, points: &[DVec2], shift: DVec2, most: f64) -> Option<f64> {
    const EARLY: usize = 12;
    let mut sum = 0.0;
    for &point in points.iter().take(EARLY) {
        sum += ground.distance(point + shift).min(10.0);
        if sum > 1.5 * most * EARLY as f64 {
            return None;
        }
    }
    for &point in points.iter().skip(EARLY) {
        sum += ground.distance(point + shift).min(10.0);
        if sum > most * points.len() as f64 {
            return None;
        }
    }
    Some(sum / points.len() as f64)
}

/// Moves points into the shape, and returns their mean distance from it with the shift.
#[expect(clippy::cast_precision_loss, reason = "samples are small")]
fn settled(ground: &Ground, points: &[DVec2], mut shift: DVec2) -> (f64, DVec2) {
    let mean = |shift: DVec2| {
        let sum: f64 = points
            .iter()
            .map(|&point| ground.distance(point + shift))
            .sum();
        sum / points.len() as f64
    };
    let mut best = (mean(shift), shift);
    for _ in 0..4 {
        let offsets = points
            .iter()
            .map(|&point| ground.nearest(point + shift) - point - shift);
        shift += 1.5 * offsets.sum::<DVec2>() / points.len() as f64;
        let error = mean(shift);
        if error < best.0 {
            best = (error, shift);
        }
    }
    best
}

/// Returns which cells of the sample a copy of the shape covers, within a cell.
pub(in crate::fit) fn covered(ground: &Ground, map: &DAffine2) -> Vec<u64> {
    let points = ground.points();
    let mut covered = vec![0; points.len().div_ceil(64)];
    let ratio = libm::sqrt(map.matrix2.determinant().abs());
    if ratio < 1e-6 {
        return covered;
    }
    let back = map.inverse();
    for (number, &point) in points.iter().enumerate() {
        if ground.distance(back.transform_point2(point)) * ratio <= 1.0 {
            covered[number / 64] |= 1 << (number % 64);
        }
    }
    covered
}
