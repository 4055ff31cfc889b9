//! Laws of box counting.

use kfrac::geometry::{DAffine2, DVec2};
use kfrac::measure::{Bits, BoxCounting, Estimate, Generalised, Points, counts, raster_scales};

use super::{grids, number, picture};

/// Iterates over pseudorandom numbers (Knuth's multiplier).
fn numbers(seed: u64) -> impl Iterator<Item = u64> {
    std::iter::successors(Some(seed), |last| {
        Some(
            last.wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407),
        )
    })
    .map(|state| state >> 33)
    .skip(1)
}

/// Returns points of a dust of dimension log 4 / log 3, by the chaos game.
fn dust(count: usize) -> Vec<DVec2> {
    let mut at = DVec2::ZERO;
    let corners =
        numbers(7).map(|number| DVec2::new((number & 1) as f64, (number >> 1 & 1) as f64));
    let points = corners.map(|corner| {
        at = at / 3.0 + corner * (2.0 / 3.0);
        at
    });
    points.skip(40).take(count).collect()
}

#[test]
fn folding_is_counting_in_boxes() {
    for (side, every) in [(1, 1), (63, 3), (64, 5), (65, 2), (130, 40), (200, 7)] {
        let chance: Vec<u64> = numbers(side as u64).take(side * side).collect();
        let bits = picture(side, |column, row| {
            chance[row * side + column].is_multiple_of(every)
        });
        for shift in [[false, false], [true, false], [false, true], [true, true]] {
            let [left, top] = shift.map(usize::from);
            let folded = bits.folded(shift);
            let mut naive = Bits::new((side + left).div_ceil(2), (side + top).div_ceil(2));
            for row in 0..side {
                for column in (0..side).filter(|&column| bits.get(column, row)) {
                    naive.set((column + left) / 2, (row + top) / 2);
                }
            }
            assert_eq!(folded, naive, "{side} {shift:?}");
            assert_eq!(
                bits.coarser(2, shift.map(usize::from)),
                naive,
                "{side} {shift:?}"
            );
        }
        for size in [3, 5, 64, 100] {
            let coarser = bits.coarser(size, [size / 2, size / 3]);
            let mut naive = Bits::new(
                (side + size / 2).div_ceil(size),
                (side + size / 3).div_ceil(size),
            );
            for row in 0..side {
                for column in (0..side).filter(|&column| bits.get(column, row)) {
                    naive.set((column + size / 2) / size, (row + size / 3) / size);
                }
            }
            assert_eq!(coarser, naive, "{side} {size}");
        }
    }
}

#[test]
fn bytes_are_packed_from_the_threshold_on() {
    let bytes: Vec<u8> = numbers(3)
        .take(70 * 3)
        .map(|number| number.to_le_bytes()[2])
        .collect();
    let bits = Bits::of_bytes(&bytes, 70, 3, 100);
    for (place, &byte) in bytes.iter().enumerate() {
        assert_eq!(bits.get(place % 70, place / 70), byte >= 100, "{place}");
    }
    assert_eq!(
        bits.count(),
        bytes.iter().filter(|&&byte| byte >= 100).count() as u64
    );
}

#[test]
fn sorted_keys_count_as_bits_do() {
    let points = dust(3000);
    let naive = |size: f64| {
        let mut boxes: Vec<_> = points
            .iter()
            .map(|point| (*point / size).floor().to_array())
            .collect();
        boxes.sort_by(|a, b| a.partial_cmp(b).unwrap());
        boxes.dedup();
        boxes.len() as u64
    };
    for level in [10, 18] {
        let boxes = 1usize << level;
        let map = DAffine2::from_scale(DVec2::splat(boxes as f64 * (1.0 - 1e-9)));
        let counts = counts(points.iter().copied(), &map, [boxes, boxes, 1], level);
        for (number, &count) in counts.iter().enumerate() {
            let size = f64::from(1u32 << number) / (boxes as f64 * (1.0 - 1e-9));
            assert_eq!(count, naive(size), "{level} {number}");
        }
    }
}

/// Returns points of a gasket in an upright triangle, by the chaos game.
fn gasket(count: usize) -> Vec<DVec2> {
    let mut at = DVec2::ZERO;
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.75f64.sqrt()]].map(DVec2::from_array);
    let points = numbers(11).map(|number| {
        at = (at + corners[(number % 3) as usize]) / 2.0;
        at
    });
    points.skip(60).take(count).collect()
}

/// Maps a pseudorandom number to the range from 0 to 1.
fn part(number: u64) -> f64 {
    number as f64 / (1u64 << 31) as f64
}

fn of_points(points: Vec<DVec2>, base: usize) -> Estimate {
    let points = Points::new(points).unwrap();
    let sample = points.sample(number(base), &grids(), number(2));
    BoxCounting::of_sample(&sample, 0.0).estimate.unwrap()
}

#[test]
fn order_and_threads_change_nothing() {
    let points = dust(20_000);
    let mut reversed = points.clone();
    reversed.reverse();
    let of = |points: &[DVec2], threads| {
        let points = Points::new(points.to_vec()).unwrap();
        points.sample(number(2), &grids(), number(threads)).scales()
    };
    let once = of(&points, 1);
    assert_eq!(once, of(&reversed, 1));
    assert_eq!(once, of(&points, 5));
    let gasket = picture(256, |column, row| column & row == 0);
    let scales = |threads| raster_scales(&gasket, number(2), &grids(), number(threads));
    assert_eq!(scales(1), scales(3));
}

#[test]
fn a_similarity_changes_no_dimension() {
    for points in [dust(40_000), gasket(40_000)] {
        let of = |scale: f64, angle: f64, shift: [f64; 2]| {
            let map = DAffine2::from_scale_angle_translation(
                DVec2::splat(scale),
                angle,
                DVec2::from_array(shift),
            );
            let moved = points.iter().map(|&point| map.transform_point2(point));
            of_points(moved.collect(), 2)
        };
        let here = of(1.0, 0.0, [0.0; 2]);
        for moved in [
            of(1024.0, 0.0, [4096.0, -2048.0]),
            of(0.003, 0.3, [5.0, 7.0]),
            of(0.003, 1.2, [5.0, 7.0]),
            of(17.0, 4.0, [0.0, 1.0]),
        ] {
            let apart = (moved.value - here.value).abs();
            assert!(apart < 1e-3, "{moved:?} {here:?}");
        }
    }
}

#[test]
fn neither_scale_nor_place_changes_what_boxes_hold() {
    // Multiples of 2⁻²⁰ stay exact under all translations.
    let whole = |point: DVec2| (point * 1_048_576.0).round() / 1_048_576.0;
    let points: Vec<DVec2> = gasket(3_000).into_iter().map(whole).collect();
    let of = |scale: f64, shift: [f64; 2]| {
        let shift = DVec2::from_array(shift);
        of_points(points.iter().map(|&it| (it + shift) * scale).collect(), 2)
    };
    let here = of(1.0, [0.0; 2]);
    let far = 2f64.powi(32);
    for (scale, shift) in [
        (1.0, [far, -far]),
        (2f64.powi(-990), [0.0, far]),
        (2f64.powi(990), [far, 0.0]),
    ] {
        let moved = of(scale, shift);
        assert!(
            (moved.value - here.value).abs() < 1e-9,
            "{moved:?} {here:?}"
        );
        assert_eq!(moved.sizes, here.sizes);
    }
}

#[test]
fn points_are_boxed_however_far_away_they_lie() {
    // Doubles resolve nanoseconds since 1970 in steps of 256: no point lies exactly where it was written.
    for (offset, step) in [
        (1.7e18, 1.0),
        (1.7e18, 700.0),
        (-1e15, 0.3),
        (3e-290, 1e-302),
    ] {
        let at = |number: u32| offset + step * f64::from(number);
        let row = |number: u32| DVec2::new(at(number * number), step * f64::from(number % 7));
        let points = Points::new((0..40).map(row).collect()).unwrap();
        let scales = points.sample(number(2), &grids(), number(1)).scales();
        assert!(scales.iter().all(|scale| scale.count <= 40), "{scales:?}");
    }
}

#[test]
fn what_a_sample_misses_is_made_up_for() {
    let gasket_has = 3f64.log2();
    let dust_has = 4f64.ln() / 3f64.ln();
    let filled = |count: usize| -> Vec<DVec2> {
        let parts: Vec<f64> = numbers(5).take(2 * count).map(part).collect();
        parts.chunks(2).map(DVec2::from_slice).collect()
    };
    let line = |count: usize| -> Vec<DVec2> {
        let parts = numbers(5).take(count).map(part);
        parts.map(|part| DVec2::new(0.8, 0.6) * part).collect()
    };
    for (points, base, dimension, tolerance) in [
        (gasket(10_000), 2, gasket_has, 0.03),
        (gasket(100_000), 2, gasket_has, 0.02),
        (dust(10_000), 2, dust_has, 0.06),
        (dust(100_000), 2, dust_has, 0.03),
        (dust(100_000), 3, dust_has, 0.03),
        (filled(10_000), 2, 2.0, 0.08),
        (filled(100_000), 2, 2.0, 0.02),
        (line(10_000), 2, 1.0, 0.02),
        (line(100_000), 2, 1.0, 0.02),
    ] {
        super::assert_is(&of_points(points, base), dimension, tolerance);
    }
}

#[test]
fn points_that_come_often_are_no_more_points_of_the_set() {
    let points = gasket(5_000);
    let once = of_points(points.clone(), 2);
    let often = of_points(points.repeat(20), 2);
    assert!(
        (once.value - often.value).abs() < 1e-9,
        "{once:?} {often:?}"
    );
    assert_eq!(once.sizes, often.sizes);
}

#[test]
fn the_measure_of_a_gasket_has_one_dimension_of_all_orders() {
    let points = Points::new(gasket(100_000)).unwrap();
    let sample = points.sample(number(2), &grids(), number(2));
    for it in Generalised::of_sample(&sample, &[0.5, 1.0, 2.0, 3.0], 0.0) {
        super::assert_is(&it.estimate.unwrap(), 3f64.log2(), 0.03);
    }
}
