//! Systems whose dimensions are known in closed form, or as the root of Moran's equation.

use kfrac::geometry::{DAffine2, DMat2, DVec2};

use crate::common::Draws;

/// System of contractions with a known box dimension.
pub(super) struct Known {
    pub(super) name: String,
    pub(super) maps: Vec<DAffine2>,
    /// Probabilities of the maps in random iteration.
    pub(super) weights: Vec<f64>,
    pub(super) dimension: f64,
}

impl Known {
    /// Returns the system as a document.
    pub(super) fn text(&self) -> String {
        let line = |map: &DAffine2| {
            let [[a, c], [b, d]] = map.matrix2.to_cols_array_2d();
            let [e, f] = map.translation.to_array();
            format!("  - {{matrix: [[{a}, {b}], [{c}, {d}]], translate: [{e}, {f}]}}\n")
        };
        let maps: String = self.maps.iter().map(line).collect();
        format!("kind: ifs\nmaps:\n{maps}")
    }
}

/// Returns the root of Σ r^s = 1 (Moran 1946), by bisection.
fn moran(ratios: &[f64]) -> f64 {
    let (mut low, mut high) = (0.0, 2.0);
    for _ in 0..100 {
        let middle = f64::midpoint(low, high);
        let sum: f64 = ratios.iter().map(|ratio| ratio.powf(middle)).sum();
        if sum > 1.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

fn similarity(ratio: f64, degrees: f64, at: DVec2) -> DAffine2 {
    let turn = DMat2::from_angle(degrees.to_radians());
    DAffine2::from_mat2_translation(turn * ratio, at)
}

/// Returns similarities whose images do not overlap.
fn separated(name: String, maps: Vec<DAffine2>) -> Known {
    let ratios = maps
        .iter()
        .map(|map| map.matrix2.determinant().abs().sqrt());
    let ratios: Vec<f64> = ratios.collect();
    let dimension = moran(&ratios);
    Known {
        name,
        maps,
        weights: ratios.iter().map(|ratio| ratio.powf(dimension)).collect(),
        dimension,
    }
}

fn alike(name: &str, maps: Vec<DAffine2>, dimension: f64) -> Known {
    Known {
        name: name.into(),
        weights: vec![1.0; maps.len()],
        maps,
        dimension,
    }
}

/// Returns parts of the unit interval with gaps of one length between them.
fn dust(ratios: &[f64]) -> Known {
    let gap = (1.0 - ratios.iter().sum::<f64>()) / (ratios.len() - 1) as f64;
    let mut left = 0.0;
    let map = |&ratio: &f64| {
        let map = similarity(ratio, 0.0, DVec2::new(left, 0.0));
        left += ratio + gap;
        map
    };
    let maps = ratios.iter().map(map).collect();
    separated(format!("dust {ratios:.3?}"), maps)
}

/// Returns copies of the unit disc in it, along its rim, that do not touch and are turned by arbitrary angles.
fn turned(number: usize, draws: &mut Draws) -> Known {
    let copies = 3 + number % 3;
    let ratio = 0.2 + 0.1 * draws.unit();
    let map = |copy: usize| {
        let own = 0.16 + 0.14 * draws.unit();
        let ratio = if number.is_multiple_of(2) { ratio } else { own };
        let degrees = 360.0 / copies as f64 * copy as f64 + 10.0 * draws.unit();
        let at = DVec2::from_angle(degrees.to_radians()) * (1.0 - ratio);
        similarity(ratio, 360.0 * draws.unit(), at)
    };
    let maps: Vec<_> = (0..copies).map(map).collect();
    separated(format!("turned {number}"), maps)
}

/// Returns numbers with digits in a base: copies may coincide.
fn digits(base: f64, digits: &[f64], dimension: f64) -> Known {
    let map = |digit: &f64| similarity(1.0 / base, 0.0, DVec2::new(digit / base, 0.0));
    let maps = digits.iter().map(map).collect();
    alike(
        &format!("base {base:.3}, digits {digits:?}"),
        maps,
        dimension,
    )
}

/// Returns Koch's curve with another angle than 60 degrees.
fn koch(degrees: f64) -> Known {
    let ratio = 0.5 / (1.0 + degrees.to_radians().cos());
    let mut at = DVec2::ZERO;
    let map = |turn: f64| {
        let map = similarity(ratio, turn, at);
        at += map.matrix2 * DVec2::X;
        map
    };
    let maps = [0.0, degrees, -degrees, 0.0].map(map).into();
    separated(format!("Koch's curve of {degrees} degrees"), maps)
}

/// Returns a carpet of rectangles in `columns` of a grid, row by row: log s / log m + log (N / s) / log n is its box
/// dimension, with s rows of m that are not empty, n columns and N rectangles (Bedford 1984; McMullen 1984).
fn carpet(of: usize, rows: &[&[usize]]) -> Known {
    let (n, m) = (of as f64, rows.len() as f64);
    let size = DMat2::from_diagonal(DVec2::new(1.0 / n, 1.0 / m));
    let (mut maps, mut weights) = (Vec::new(), Vec::new());
    for (row, columns) in rows.iter().enumerate() {
        for &column in *columns {
            weights.push(1.0 / columns.len() as f64);
            let at = DVec2::new(column as f64 / n, row as f64 / m);
            maps.push(DAffine2::from_mat2_translation(size, at));
        }
    }
    let filled = rows.iter().filter(|row| !row.is_empty()).count() as f64;
    let dimension = filled.ln() / m.ln() + (maps.len() as f64 / filled).ln() / n.ln();
    Known {
        name: format!("carpet {of} by {}", rows.len()),
        maps,
        weights,
        dimension,
    }
}

/// Returns the systems: with gaps, turned by angles that are no parts of a full turn, with exact overlaps, and
/// self-affine.
pub(super) fn all() -> Vec<Known> {
    let third = 1.0 / 3.0;
    let dusts: [&[f64]; 18] = [
        &[third; 2],
        &[0.25; 2],
        &[0.45; 2],
        &[0.2; 3],
        &[0.3; 3],
        &[1.0 / 7.0; 4],
        &[0.11; 6],
        &[0.5, 0.25],
        &[0.6, 0.36],
        &[0.5, third],
        &[0.4, 0.3],
        &[third, 1.0 / 7.0],
        &[0.6, 0.3],
        &[0.2, 0.3, 0.4],
        &[0.15, 0.2, 0.33],
        &[0.7, 0.2],
        &[0.1, 0.8],
        &[0.25, 0.25, 0.4],
    ];
    let golden = f64::midpoint(1.0, 5f64.sqrt());
    let mut draws = Draws(1987);
    let mut all: Vec<Known> = dusts.iter().map(|ratios| dust(ratios)).collect();
    all.extend((0..12).map(|number| turned(number, &mut draws)));
    all.extend([koch(60.0), koch(80.0)]);
    // The numbers of distinct copies of one size are those of Fibonacci with every second left out.
    all.push(digits(
        3.0,
        &[0.0, 1.0, 3.0],
        (golden * golden).ln() / 3f64.ln(),
    ));
    all.push(digits(2.0, &[0.0, 1.0, 2.0], 1.0));
    all.push(digits(golden, &[0.0, golden - 1.0], 1.0));
    all.extend([
        carpet(3, &[&[0, 2], &[1]]),
        carpet(4, &[&[0, 3], &[1, 2]]),
        carpet(4, &[&[0], &[], &[1, 3]]),
        carpet(5, &[&[0, 4], &[2], &[1, 3]]),
        carpet(5, &[&[0, 2, 4], &[1]]),
        carpet(7, &[&[0, 6], &[3], &[]]),
    ]);
    all
}
