//! Fractal interpolation, against Barnsley's coefficients in the reference and against known curves.

use kfrac::geometry::DVec2;
use kfrac::ifs::{
    InterpolationError, Verdict, interpolate, interpolation_dimension, scale_of_dimension,
};
use proptest::prelude::*;

use super::{assert_near, system};

const CLASSIC: [[f64; 2]; 4] = [[0.0, 0.0], [30.0, 50.0], [60.0, 40.0], [100.0, 10.0]];
const TENT: [[f64; 2]; 3] = [[0.0, 0.0], [0.5, 0.5], [1.0, 0.0]];
const ZIGZAG: [[f64; 2]; 5] = [
    [0.0, 0.0],
    [0.25, 0.5],
    [0.5, -0.25],
    [0.75, 0.5],
    [1.0, 0.0],
];

fn points(list: &[[f64; 2]]) -> Vec<DVec2> {
    list.iter().copied().map(DVec2::from).collect()
}

/// Asserts that the maps have the coefficients a, b, c, d, e, f of (a x + b y + e, c x + d y + f).
#[track_caller]
fn assert_maps(list: &[[f64; 2]], scales: &[f64], expected: &[[f64; 6]]) {
    let maps = interpolate(&points(list), scales).unwrap();
    assert_eq!(maps.len(), expected.len());
    for (map, &[a, b, c, d, e, f]) in maps.iter().zip(expected) {
        let affine = map.affine;
        assert_near(affine.matrix2.x_axis, DVec2::new(a, c), 1e-14);
        assert_eq!(affine.matrix2.y_axis, DVec2::new(b, d));
        assert_near(affine.translation, DVec2::new(e, f), 1e-14);
        assert!((map.weight.unwrap() - a).abs() < 1e-15);
    }
}

#[test]
fn maps_have_the_coefficients_of_the_reference() {
    let classic = [
        [0.3, 0.0, 0.45, 0.5, 0.0, 0.0],
        [0.3, 0.0, -0.05, -0.5, 30.0, 50.0],
        [0.4, 0.0, -0.323, 0.23, 60.0, 40.0],
    ];
    assert_maps(&CLASSIC, &[0.5, -0.5, 0.23], &classic);
    let smooth = [
        [0.3, 0.0, 0.47, 0.3, 0.0, 0.0],
        [0.3, 0.0, -0.13, 0.3, 30.0, 50.0],
        [0.4, 0.0, -0.33, 0.3, 60.0, 40.0],
    ];
    assert_maps(&CLASSIC, &[0.3], &smooth);
    let blancmange = [
        [0.5, 0.0, 0.5, 0.5, 0.0, 0.0],
        [0.5, 0.0, -0.5, 0.5, 0.5, 0.5],
    ];
    assert_maps(&TENT, &[0.5], &blancmange);
    let parabola = [
        [0.5, 0.0, 0.5, 0.25, 0.0, 0.0],
        [0.5, 0.0, -0.5, 0.25, 0.5, 0.5],
    ];
    assert_maps(&TENT, &[0.25, 0.25], &parabola);
    let zigzag = [
        [0.25, 0.0, 0.5, 0.5, 0.0, 0.0],
        [0.25, 0.0, -0.75, 0.5, 0.25, 0.5],
        [0.25, 0.0, 0.75, -0.5, 0.5, -0.25],
        [0.25, 0.0, -0.5, 0.5, 0.75, 0.5],
    ];
    assert_maps(&ZIGZAG, &[0.5, 0.5, -0.5, 0.5], &zigzag);
}

/// The parabola 2x(1 − x) with x uniform has mean 1/3 and variance 4(1/30) − 1/9 = 1/45.
#[test]
fn a_parabola_has_the_moments_of_a_parabola() {
    let measure = system(interpolate(&points(&TENT), &[0.25]).unwrap())
        .measure()
        .unwrap();
    assert_near(measure.moments.mean, DVec2::new(0.5, 1.0 / 3.0), 1e-15);
    let covariance = measure.moments.covariance;
    assert_near(covariance.x_axis, DVec2::new(1.0 / 12.0, 0.0), 1e-15);
    assert_near(covariance.y_axis, DVec2::new(0.0, 1.0 / 45.0), 1e-15);
}

#[test]
fn dimensions_are_those_of_closed_forms() {
    let dimension =
        |list: &[[f64; 2]], scales: &[f64]| interpolation_dimension(&points(list), scales).unwrap();
    assert!((dimension(&ZIGZAG, &[0.5, 0.5, -0.5, 0.5]) - 1.5).abs() < 1e-15);
    assert_eq!(dimension(&TENT, &[0.5]), 1.0);
    assert_eq!(dimension(&TENT, &[0.25]), 1.0);
    assert_eq!(
        dimension(&[[0.0, 1.0], [1.0, 2.0], [3.0, 4.0]], &[0.9]),
        1.0
    );
    assert_eq!(scale_of_dimension(&points(&TENT), 1.0), Ok(0.5));
    assert_eq!(scale_of_dimension(&points(&ZIGZAG), 1.5), Ok(0.5));
}

#[test]
fn mistakes_are_told() {
    use InterpolationError as E;
    let one = points(&[[0.0, 1.0]]);
    assert_eq!(
        interpolate(&one, &[0.5]),
        Err(E::TooFewPoints { points: 1 })
    );
    assert_eq!(interpolate(&[], &[0.5]), Err(E::TooFewPoints { points: 0 }));
    let back = points(&[[0.0, 1.0], [2.0, 0.0], [2.0, 1.0]]);
    assert_eq!(
        interpolate(&back, &[0.5]),
        Err(E::NotIncreasing { point: 2 })
    );
    let endless = points(&[[0.0, 1.0], [2.0, f64::NAN], [3.0, 1.0]]);
    assert_eq!(
        interpolate(&endless, &[0.5]),
        Err(E::PointNotFinite { point: 1 })
    );
    let tent = points(&TENT);
    let (scales, pieces) = (3, 2);
    assert_eq!(
        interpolate(&tent, &[0.1; 3]),
        Err(E::NumberOfScales { scales, pieces })
    );
    assert_eq!(
        interpolate(&tent, &[0.5, -1.0]),
        Err(E::Scale {
            number: 1,
            scale: -1.0
        })
    );
    assert!(matches!(
        interpolate(&tent, &[f64::NAN]),
        Err(E::Scale { number: 0, .. })
    ));
    for dimension in [0.9, 2.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            scale_of_dimension(&tent, dimension),
            Err(E::Dimension { .. })
        ));
    }
    let line = points(&[[0.0, 1.0], [0.1, 1.1], [0.3, 1.3]]);
    assert_eq!(scale_of_dimension(&line, 1.5), Err(E::OnALine));
    assert_eq!(
        E::NotIncreasing { point: 2 }.to_string(),
        "point 3 does not lie to the right of the one before"
    );
}

proptest! {
    #[test]
    fn curves_go_through_their_points_with_their_dimension(
        widths in prop::collection::vec(0.1..10.0f64, 2..12),
        heights in prop::collection::vec(-100.0..100.0f64, 13),
        dimension in 1.0..1.99f64,
    ) {
        let mut x = heights[0];
        let mut data = vec![DVec2::new(x, heights[1])];
        for (width, &y) in widths.iter().zip(&heights[2..]) {
            x += width;
            data.push(DVec2::new(x, y));
        }
        let scale = scale_of_dimension(&data, dimension).unwrap();
        let found = interpolation_dimension(&data, &[-scale]).unwrap();
        prop_assert!((found - dimension).abs() < 1e-9, "{found}, not {dimension}");
        let maps = interpolate(&data, &[scale]).unwrap();
        for (map, ends) in maps.iter().zip(data.windows(2)) {
            assert_near(map.affine.transform_point2(data[0]), ends[0], 1e-11);
            assert_near(map.affine.transform_point2(data[data.len() - 1]), ends[1], 1e-11);
        }
        let contraction = system(maps).contraction();
        let widest = widths.iter().copied().fold(0.0, f64::max) / widths.iter().sum::<f64>();
        let expected = scale.max(widest);
        prop_assert_eq!(contraction.verdict, Verdict::Contracts);
        prop_assert!((contraction.lower / expected - 1.0).abs() < 1e-12);
        prop_assert!(contraction.upper < expected * 1.002, "{:?}", contraction);
    }
}
