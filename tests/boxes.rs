//! Box counting: known dimensions are measured, and sets that cannot be measured are refused.

mod bad;
mod laws;
mod pictures;
mod space;

use std::num::NonZero;

use crate::common;
use kfrac::catalogue::Catalogue;
use kfrac::document::Document;
use kfrac::extent::NoLimit;
use kfrac::measure::{Bits, BoxCounting, Estimate, Generalised, Grid, LimitSet, Masses};

fn number(number: usize) -> NonZero<usize> {
    NonZero::new(number).unwrap()
}

fn grids() -> Vec<Grid> {
    Grid::spread(number(8))
}

/// Returns a square picture from a predicate of column and row.
fn picture(side: usize, is_set: impl Fn(usize, usize) -> bool) -> Bits {
    let mut bits = Bits::new(side, side);
    for row in 0..side {
        for column in (0..side).filter(|&column| is_set(column, row)) {
            bits.set(column, row);
        }
    }
    bits
}

fn measured(pixels: &Bits) -> Estimate {
    let counting = BoxCounting::of_pixels(pixels, None, &grids(), number(2));
    counting.estimate.unwrap()
}

fn assert_is(estimate: &Estimate, dimension: f64, tolerance: f64) {
    let off = (estimate.value - dimension).abs();
    assert!(off <= tolerance, "{estimate:?}");
    assert!(off <= 2.0 * estimate.std_error + 1e-9, "{estimate:?}");
}

#[test]
fn a_filled_square_has_dimension_2() {
    assert_is(&measured(&picture(1024, |_, _| true)), 2.0, 0.005);
}

#[test]
fn lines_have_dimension_1() {
    assert_is(&measured(&picture(1024, |_, row| row == 300)), 1.0, 0.005);
    assert_is(
        &measured(&picture(1024, |column, _| column == 511)),
        1.0,
        0.005,
    );
    assert_is(
        &measured(&picture(1024, |column, row| column == row)),
        1.0,
        0.005,
    );
}

#[test]
fn a_gasket_has_its_dimension() {
    let gasket = picture(4096, |column, row| column & row == 0);
    let counted = measured(&gasket);
    assert_is(&counted, libm::log(3.0) / libm::log(2.0), 0.01);
    let orders = [1.0, 2.0, 3.5];
    for generalised in Generalised::of_pixels(&gasket, Some(counted), &orders, &grids(), number(2))
    {
        assert_is(
            &generalised.estimate.unwrap(),
            libm::log(3.0) / libm::log(2.0),
            0.01,
        );
    }
}

#[test]
fn a_disc_has_dimension_2() {
    let disc = picture(2048, |column, row| {
        let away = |place: usize| (place as i64 - 1000).pow(2);
        away(column) + away(row) < 900 * 900
    });
    assert_is(&measured(&disc), 2.0, 0.02);
}

#[test]
fn a_pixel_has_dimension_0() {
    let pixel = picture(256, |column, row| (column, row) == (100, 30));
    assert_is(&measured(&pixel), 0.0, 0.0);
}

#[test]
fn boxes_of_other_sizes_measure_the_same() {
    let carpet = picture(729, |mut column, mut row| {
        while column > 0 && row > 0 {
            if column % 3 == 1 && row % 3 == 1 {
                return false;
            }
            (column, row) = (column / 3, row / 3);
        }
        true
    });
    let counting = BoxCounting::of_pixels(&carpet, Some(number(3)), &grids(), number(1));
    assert_eq!(
        counting.boxes.iter().map(|it| it.size).fold(0.0, f64::max),
        729.0
    );
    let estimate = counting.estimate.unwrap();
    assert_is(&estimate, libm::log(8.0) / libm::log(3.0), 0.01);
}

#[test]
fn a_uniform_set_is_not_lacunar_and_a_gasket_is() {
    let uniform = Masses::of_pixels(&picture(256, |_, _| true), [0; 2]).lacunarity();
    assert!(
        uniform.iter().all(|it| (it.value - 1.0).abs() < 1e-12),
        "{uniform:?}"
    );
    let gasket = picture(256, |column, row| column & row == 0);
    let gasket = Masses::of_pixels(&gasket, [0; 2]).lacunarity();
    // With one box of one pixel, ⟨m²⟩ / ⟨m⟩² is 1 / the share of set pixels.
    assert!((gasket[0].value - (4.0f64 / 3.0).powi(8)).abs() < 1e-9);
    assert!(gasket.is_sorted_by(|a, b| a.value >= b.value), "{gasket:?}");
}

fn limit(name: &str) -> Result<LimitSet, NoLimit> {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule(name).unwrap();
    let (model, _) = Document::read(&source, &catalogue)
        .unwrap()
        .resolve(&[])
        .unwrap();
    LimitSet::of(&model.compile(20).unwrap())
}

/// Measures a limit set at sizes for which a debug build is quick.
fn of_limit(set: &LimitSet, base: f64) -> Estimate {
    let window = kfrac::measure::Window {
        finest: 0.0,
        coarsest: set.bounds().size().max_element() / 2.0,
        min_boxes: 9,
    };
    let scales = set.scales(base, 2_000, &grids(), number(2));
    BoxCounting::of(&scales, &window).estimate.unwrap()
}

#[test]
fn limit_sets_are_measured_without_a_picture() {
    for (name, period, dimension) in [
        ("koch", 3.0, libm::log(4.0) / libm::log(3.0)),
        ("carpet", 3.0, libm::log(8.0) / libm::log(3.0)),
        ("sierpinski-triangles", 2.0, libm::log(3.0) / libm::log(2.0)),
        ("hilbert", 2.0, 2.0),
    ] {
        let set = limit(name).unwrap();
        assert!((set.period().unwrap() - period).abs() < 1e-9, "{name}");
        assert_is(&of_limit(&set, period), dimension, 0.03);
    }
}

#[test]
fn a_sample_tells_what_is_counted() {
    for (name, base, dimension) in [
        ("carpet", 3, libm::log(8.0) / libm::log(3.0)),
        ("koch", 3, libm::log(4.0) / libm::log(3.0)),
    ] {
        let set = limit(name).unwrap();
        let along = [Grid::ALONG];
        let sampled = set.sampled_scales(number(base), &along, number(1));
        assert_eq!(sampled, set.sampled_scales(number(base), &along, number(2)));
        let counted = set.scales(base as f64, 10_000, &along, number(1));
        for (sample, scale) in sampled.iter().zip(&counted) {
            assert!((sample.size / scale.size - 1.0).abs() < 1e-9, "{name}");
            if sample.sampled {
                let off = sample.count as f64 / scale.count as f64 - 1.0;
                assert!(off.abs() < 0.1, "{name}: {sample:?} {scale:?}");
            } else {
                assert_eq!(sample.count, scale.count, "{name}");
            }
        }
        // Boxes of 10⁻⁹ of the extent: counts grow over 9 decades with the dimension.
        let (first, last) = (sampled[2], sampled[sampled.len() - 1]);
        assert!(last.sampled && last.size < 3e-9 * first.size * 27.0);
        let slope =
            libm::log(last.count as f64 / first.count as f64) / libm::log(first.size / last.size);
        assert!((slope - dimension).abs() < 0.03, "{name}: {slope}");
    }
}

#[test]
fn a_limit_set_lies_in_its_box_and_is_met_by_what_is_counted() {
    let set = limit("koch").unwrap();
    let (min, max) = (set.bounds().min(), set.bounds().max());
    assert!(min.length() < 1e-9, "{min}");
    assert!(
        (max - kfrac::geometry::DVec2::new(1.0, 12f64.sqrt().recip())).length() < 1e-9,
        "{max}"
    );
    // The trunks of a tree do not belong to the limit set of its fertile elements.
    let tree = limit("binary-tree").unwrap();
    assert!(tree.bounds().min().x > 0.9, "{:?}", tree.bounds());
}

#[test]
fn a_limit_that_is_a_point_has_dimension_0() {
    let spiral = limit("spiral").unwrap();
    assert_eq!(spiral.bounds().size().max_element(), 0.0);
    let estimate = BoxCounting::of_limit(&spiral, None, &grids(), number(1)).estimate;
    assert_eq!(estimate.unwrap().value, 0.0);
}

#[test]
fn maps_that_are_no_similarities_are_as_long_as_their_product() {
    // The norms of the two maps are 0.73, but products of n maps have lengths of about 2^-n.
    let parabola = limit("parabola").unwrap();
    let scales = parabola.sampled_scales(number(2), &grids()[..2], number(2));
    let (first, last) = (scales[4], scales[scales.len() - 1]);
    assert!(last.size < 1e-7 * first.size, "{last:?}");
    let slope =
        libm::log(last.count as f64 / first.count as f64) / libm::log(first.size / last.size);
    assert!((slope - 1.0).abs() < 0.03, "{slope}");
}

#[test]
fn what_has_no_limit_set_says_so() {
    assert_eq!(limit("random-tree").unwrap_err(), NoLimit::Draws);
    assert_eq!(limit("snow-crystal").unwrap_err(), NoLimit::Endless);
}
