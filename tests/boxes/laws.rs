//! Laws of box counting.

use kfrac::geometry::{DAffine2, DVec2};
use kfrac::measure::{Bits, BoxCounting, Points, counts, raster_scales};

use super::{grids, number, picture};

/// Numbers that look like chance (Knuth's multiplier).
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

/// Points of a dust of dimension log 4 / log 3, by the chaos game.
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
        let counts = counts(&points, &map, [boxes; 2], level);
        for (number, &count) in counts.iter().enumerate() {
            let size = f64::from(1u32 << number) / (boxes as f64 * (1.0 - 1e-9));
            assert_eq!(count, naive(size), "{level} {number}");
        }
    }
}

#[test]
fn order_and_threads_change_nothing() {
    let points = dust(20_000);
    let mut reversed = points.clone();
    reversed.reverse();
    let of = |points: &[DVec2], threads| {
        Points::new(points.to_vec())
            .unwrap()
            .scales(&grids(), number(threads))
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
    let points = dust(40_000);
    let of = |map: &DAffine2| {
        let moved = points
            .iter()
            .map(|&point| map.transform_point2(point))
            .collect();
        let points = Points::new(moved).unwrap();
        BoxCounting::of_points(&points, &grids(), number(2))
            .estimate
            .unwrap()
    };
    let here = of(&DAffine2::IDENTITY);
    let exact = libm::log(4.0) / libm::log(3.0);
    assert!(
        (here.value - exact).abs() <= 2.0 * here.std_error,
        "{here:?}"
    );
    let moved = of(&DAffine2::from_scale_angle_translation(
        DVec2::splat(1024.0),
        0.0,
        DVec2::new(4096.0, -2048.0),
    ));
    assert!(
        (moved.value - here.value).abs() < 1e-3,
        "{moved:?} {here:?}"
    );
    for angle in [0.3, 1.2, 4.0] {
        let turned = of(&DAffine2::from_scale_angle_translation(
            DVec2::splat(0.003),
            angle,
            DVec2::new(5.0, 7.0),
        ));
        let apart = (turned.value - here.value).abs();
        assert!(
            apart <= 2.0 * (turned.std_error + here.std_error),
            "{turned:?} {here:?}"
        );
    }
}
