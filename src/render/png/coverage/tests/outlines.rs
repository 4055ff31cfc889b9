//! Tests of the coverage of outlines: polygons of any shape, rectangles, ellipses.

use proptest::prelude::*;

use super::super::{CoverageBuffer, Position, SAMPLES};
use super::{SIZE, area, samples};

/// Returns the winding number of an outline about a point, from the sides that cross the ray to the right.
fn winding(vertices: &[Position], [x, y]: [f64; 2]) -> i32 {
    let nexts = vertices.iter().cycle().skip(1);
    let sides = vertices.iter().zip(nexts);
    let crossings = sides.map(|(from, to)| {
        let [[a, b], [c, d]] = [from, to].map(|point| point.map(|fine| fine as f64 / 100.0));
        let is_right = (c - a) * (y - b) - (x - a) * (d - b);
        match (b <= y, d <= y) {
            (true, false) if is_right > 0.0 => 1,
            (false, true) if is_right < 0.0 => -1,
            _ => 0,
        }
    });
    crossings.sum()
}

/// Returns outlines that are not convex or are too large for half planes.
fn any_shape() -> impl Strategy<Value = Vec<Position>> {
    let corner = [-300..6700i64, -300..6700i64];
    let near = [2000..2600i64, 2000..2600i64];
    prop_oneof![
        proptest::collection::vec(corner, 3..12),
        proptest::collection::vec(near, 17..40),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 6, ..ProptestConfig::default() })]

    #[test]
    fn areas_cover_the_samples_that_are_wound_around(vertices in any_shape()) {
        let covered = samples(|plane| assert!(plane.area(&vertices)));
        for (pixel, &covered) in covered.iter().enumerate().step_by(7) {
            let [x, y] = [pixel % SIZE as usize, pixel / SIZE as usize].map(|place| place as f64);
            let is_inside = |number: &u32| {
                let [u, v] = super::super::sample(*number);
                winding(&vertices, [x + u, y + v]) != 0
            };
            let expected = (0..SAMPLES).filter(is_inside).count();
            // A side may pass through a sample, within rounding.
            prop_assert!((expected as i64 - i64::from(covered)).abs() <= 1, "{covered} instead of {expected}");
        }
    }

    #[test]
    fn both_ways_to_cover_a_polygon_agree(
        corner in [500..5000i64, 500..5000],
        turn in 0.0..6.3f64,
        radius in 100.0..350.0f64,
    ) {
        let vertices = [0, 1, 2, 3, 4].map(|number| {
            let (sine, cosine) = (turn + f64::from(number) * std::f64::consts::TAU / 5.0).sin_cos();
            [corner[0] + (radius * cosine) as i64, corner[1] + (radius * sine) as i64]
        });
        let soon = samples(|plane| assert!(plane.polygon_of::<5>(&vertices)));
        let exact = samples(|plane| assert!(plane.area(&vertices)));
        // Half planes have discrete directions.
        let differences = soon.iter().zip(&exact).map(|(a, b)| a.abs_diff(*b));
        prop_assert!(differences.clone().all(|difference| difference <= 6));
        let off = area(&soon) - area(&exact);
        prop_assert!(off.abs() <= 0.01 * radius / 10.0, "{off}");
    }

    /// Positions are rounded, so that the outlines of small discs turn in both directions.
    #[test]
    fn rounded_polygons_are_covered_as_convex_ones(
        corner in [500..5000i64, 500..5000],
        turn in 0.0..6.3f64,
        radius in 3.0..60.0f64,
        count in 5..=12u32,
    ) {
        let vertices: Vec<Position> = (0..count).map(|number| {
            let turn = turn + f64::from(number) * std::f64::consts::TAU / f64::from(count);
            let place = |part: f64| (radius * part + 0.5).floor() as i64;
            [corner[0] + place(turn.cos()), corner[1] + place(turn.sin())]
        }).collect();
        let soon = samples(|plane| assert!(plane.polygon(&vertices)));
        let exact = samples(|plane| assert!(plane.area(&vertices)));
        let off = area(&soon) - area(&exact);
        prop_assert!(off.abs() <= 0.03 + 0.0025 * radius, "{off}");
        // In the other direction, and from another vertex.
        let backwards: Vec<Position> = vertices.iter().rev().copied().collect();
        prop_assert!(soon == samples(|plane| assert!(plane.polygon(&backwards))));
    }
}

/// The shortcut for rectangles covers the same samples as half planes do.
#[test]
fn rectangles_are_covered_as_other_polygons_are() {
    for number in 0..2000i64 {
        let least = [1000 + number * 37 % 100, 1000 + number * 7919 % 100];
        let size = [number * 61 % 780 + 21, number * 104_729 % 777 + 21];
        let most = [0, 1].map(|axis| least[axis] + size[axis]);
        let corners = [
            least,
            [most[0], least[1]],
            most,
            [least[0], most[1]],
            // The repeated vertex selects the general code.
            [least[0], most[1]],
        ];
        let other = samples(|plane| assert!(plane.polygon_of::<5>(&corners)));
        assert!(samples(|plane| assert!(plane.rectangle(least, most))) == other);
        for turned in [[0, 1, 2, 3], [3, 2, 1, 0], [1, 2, 3, 0]] {
            let turned = turned.map(|corner| corners[corner]);
            let covered = samples(|plane| assert!(plane.polygon(&turned)));
            assert!(covered == other, "{turned:?}");
        }
    }
}

#[test]
fn small_ellipses_and_bars_have_their_ink_on_average() {
    let round = [3.0, 8.0, 12.0, 20.0, 40.0].map(|radius| [radius; 2]);
    let narrow = [
        [20.0, 4.0],
        [40.0, 3.0],
        [60.0, 6.0],
        [150.0, 8.0],
        [150.0, 14.0],
    ];
    let ellipses = round.into_iter().chain(narrow).map(|shape| (8, shape));
    for (corners, [along, across]) in ellipses.chain(narrow.map(|shape| (4, shape))) {
        let shape = |number: i64| {
            // Centres are spread evenly.
            let middle = [number * 61 % 100, number * 8747 % 10_000 / 100];
            let corner = |corner: i64| {
                // Corners of a bar lie half way between those of the ellipse.
                let turn = (corner as f64 + if corners == 4 { 0.5 } else { 0.0 })
                    * std::f64::consts::TAU
                    / corners as f64;
                let [x, y] = [along * turn.cos(), across * turn.sin()];
                let (sine, cosine) = f64::from((number % 97) as i32).sin_cos();
                let turned = [x * cosine - y * sine, x * sine + y * cosine];
                [0, 1].map(|axis| 3000 + middle[axis] + (turned[axis] + 0.5).floor() as i64)
            };
            (0..corners).map(corner).collect::<Vec<Position>>()
        };
        let shapes = || (0..1000).map(shape);
        let sum = |draw: fn(&mut CoverageBuffer, &[Position]) -> bool| {
            let covered =
                shapes().map(|shape| area(&samples(|plane| assert!(draw(plane, &shape)))));
            covered.sum::<f64>()
        };
        let (soon, exact) = (sum(CoverageBuffer::polygon), sum(CoverageBuffer::area));
        assert!(
            (soon / exact - 1.0).abs() <= 0.02,
            "{soon} instead of {exact}: {corners} corners, {along}, {across}"
        );
    }
}

/// Polygons that are not convex, by more than rounding, are covered exactly.
#[test]
fn small_stars_keep_their_notches() {
    for radius in [20, 60, 150] {
        let star: Vec<Position> = (0..8)
            .map(|number| {
                let turn = f64::from(number) * std::f64::consts::FRAC_PI_4;
                let far = f64::from(if number % 2 == 0 { radius } else { radius / 3 });
                [turn.cos(), turn.sin()].map(|part| 3000 + (far * part) as i64)
            })
            .collect();
        let covered = samples(|plane| assert!(plane.polygon(&star)));
        assert!(covered == samples(|plane| assert!(plane.area(&star))));
    }
}

#[test]
fn neighbours_of_any_shape_leave_no_gap_and_do_not_overlap() {
    let zigzag: Vec<Position> = (0..30)
        .map(|n| [3000 + n % 2 * 777 + 5 * n, 100 + 203 * n])
        .collect();
    let closed = |x: i64| {
        let mut outline = zigzag.clone();
        outline.extend([[x, 5987], [x, 100]]);
        outline
    };
    let [left, right] = [1000, 5000].map(|x| samples(|plane| assert!(plane.area(&closed(x)))));
    let whole = samples(|plane| {
        assert!(plane.area(&[[1000, 100], [5000, 100], [5000, 5987], [1000, 5987]]));
    });
    for ((left, right), whole) in left.iter().zip(&right).zip(whole) {
        assert_eq!(left + right, whole);
    }
}

#[test]
fn what_is_large_is_left_to_others() {
    let large = [[0, 0], [20_000, 0], [0, 12_000]];
    let many: Vec<Position> = (0..5000)
        .map(|number| [number, number * 7 % 1000])
        .collect();
    for polygon in [&large[..], &many] {
        let covered = samples(|plane| assert!(!plane.polygon(polygon)));
        assert_eq!(area(&covered), 0.0);
    }
}

#[test]
fn polygons_without_an_inside_cover_nothing() {
    for polygon in [
        &[[5, 5]][..],
        &[[5, 5], [90, 70]],
        &[[5, 5], [90, 90], [205, 205]],
    ] {
        assert_eq!(area(&samples(|plane| assert!(plane.polygon(polygon)))), 0.0);
    }
}
