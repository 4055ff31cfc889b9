//! Laws of random systems of maps.

use std::f64::consts::TAU;

use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::random::Pcg;

use super::maps::Drawable;

/// Draws affine maps by their singular values, as Anderson & Farrell do ("Improving fractal pre-training", WACV 2022,
/// section 3): A = U diag(s1, s2) V with orthogonal U and V, each a rotation by a uniform angle after random reflections of
/// the axes; 1 > s1 ≥ s2 > 0; Σ (s1 + 2 s2) over the n maps is uniform from (5 + n)/2 to (6 + n)/2; translations are uniform on
/// [-1, 1)².
///
/// All maps contract, and the limited sum keeps attractors from being dust or filled areas.
pub(super) fn anderson(random: &mut Pcg, maps: u32) -> Vec<DAffine2> {
    let count = f64::from(maps);
    let sum = uniform(random, (5.0 + count) / 2.0, (6.0 + count) / 2.0);
    let values = singular_values(random, maps, sum);
    let map = |values: DVec2| {
        let left = orthogonal(random);
        let right = orthogonal(random);
        let shift = DVec2::new(uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0));
        let linear = left * DMat2::from_diagonal(values) * right;
        DAffine2::from_mat2_translation(linear, shift)
    };
    values.into_iter().map(map).collect()
}

/// Draws affine maps whose coefficients are uniform on [-1, 1): six in the plane, as the search for FractalDB does (Kataoka et
/// al., "Pre-training without natural images", ACCV 2020), or twelve in space (Yamada et al., "MV-FractalDB", IROS 2021). Not
/// all of them contract.
pub(super) fn by_coefficients<M: Drawable>(random: &mut Pcg, maps: u32) -> Vec<M> {
    let mut map = || {
        let coefficients = (0..M::COEFFICIENTS).map(|_| uniform(random, -1.0, 1.0));
        M::of_coefficients(&coefficients.collect::<Vec<_>>())
    };
    (0..maps).map(|_| map()).collect()
}

/// Draws pairs of singular values s1 ≥ s2 in [0, 1] with Σ (s1 + 2 s2) = `sum`, one after the other: each is uniform on the
/// interval that leaves the rest a solution.
fn singular_values(random: &mut Pcg, maps: u32, sum: f64) -> Vec<DVec2> {
    let mut left = sum;
    let mut pairs = Vec::new();
    for after in (0..maps).rev() {
        // The pairs after this one have from 0 to 3 each.
        let least = left - 3.0 * f64::from(after);
        let pair = if after == 0 {
            let small = uniform(random, ((left - 1.0) / 2.0).max(0.0), left / 3.0);
            DVec2::new(left - 2.0 * small, small)
        } else {
            let large = uniform(random, (least / 3.0).max(0.0), left.min(1.0));
            let rest = left - large;
            let least = (least - large) / 2.0;
            DVec2::new(
                large,
                uniform(random, least.max(0.0), large.min(rest / 2.0)),
            )
        };
        left -= pair.x + 2.0 * pair.y;
        pairs.push(pair);
    }
    pairs
}

/// Draws a rotation after random reflections of both axes.
fn orthogonal(random: &mut Pcg) -> DMat2 {
    let mut sign = || if random.unit() < 0.5 { -1.0 } else { 1.0 };
    let signs = DVec2::new(sign(), sign());
    let (sine, cosine) = libm::sincos(TAU * random.unit());
    let rotation = DMat2::from_cols(DVec2::new(cosine, sine), DVec2::new(-sine, cosine));
    rotation * DMat2::from_diagonal(signs)
}

/// Draws a number from an interval.
pub(super) fn uniform(random: &mut Pcg, low: f64, high: f64) -> f64 {
    low + (high - low) * random.unit()
}

/// Draws a whole number from 0 to `count` − 1.
pub(super) fn below(random: &mut Pcg, count: u32) -> u32 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the number is below a count"
    )]
    let drawn = (random.unit() * f64::from(count)) as u32;
    drawn.min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn singular(map: &DAffine2) -> DVec2 {
        let [a, b, c, d] = map.matrix2.to_cols_array();
        let (sum, det) = (a * a + b * b + c * c + d * d, (a * d - b * c).abs());
        let [plus, minus] = [(sum + 2.0 * det).sqrt(), (sum - 2.0 * det).max(0.0).sqrt()];
        DVec2::new(plus + minus, plus - minus) / 2.0
    }

    #[test]
    fn singular_values_have_their_sum() {
        let mut random = Pcg::new(1, 2);
        let mut mean = 0.0;
        for round in 0..2000 {
            let count = 2 + round % 6;
            let maps = anderson(&mut random, count);
            assert_eq!(maps.len(), count as usize);
            let values: Vec<_> = maps.iter().map(singular).collect();
            assert!(values.iter().all(|it| it.x <= 1.0 + 1e-9 && it.y >= -1e-9));
            let sum: f64 = values.iter().map(|it| it.x + 2.0 * it.y).sum();
            let least = (5.0 + f64::from(count)) / 2.0;
            assert!(
                sum > least - 1e-9 && sum < least + 0.5 + 1e-9,
                "{count}: {sum}"
            );
            mean += (sum - least) / 2000.0;
            assert!(
                maps.iter()
                    .all(|map| map.translation.abs().max_element() <= 1.0)
            );
        }
        // The mean of a uniform number, within 4 standard errors.
        assert!(
            (mean - 0.25).abs() < 4.0 * 0.5 / (12.0 * 2000.0_f64).sqrt(),
            "{mean}"
        );
    }

    #[test]
    fn angles_and_reflections_are_uniform() {
        let mut random = Pcg::new(3, 4);
        let maps: Vec<_> = (0..500).flat_map(|_| anderson(&mut random, 4)).collect();
        let reflected = maps.iter().filter(|map| map.matrix2.determinant() < 0.0);
        // 1,000 of 2,000, within 4 standard deviations of 22.
        assert!(reflected.count().abs_diff(1000) < 90);
        let mean: DVec2 = maps.iter().map(|map| map.matrix2.x_axis.normalize()).sum();
        assert!(mean.length() / 2000.0 < 4.0 / 2000.0_f64.sqrt());
    }
}
