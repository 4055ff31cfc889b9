//! Contraction on average.

use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::ifs::{Condensation, Definition, Edge, Ifs, Map, Shape};

fn similar(ratio: f64, turn: f64, weight: f64) -> Map {
    let linear = DMat2::from_scale_angle(DVec2::splat(ratio), turn);
    Map::new(DAffine2::from_mat2_translation(linear, DVec2::X)).weighing(weight)
}

fn of(definition: Definition) -> Ifs {
    Ifs::new(definition).unwrap()
}

fn system(maps: Vec<Map>) -> Ifs {
    of(Definition {
        maps,
        ..Definition::default()
    })
}

/// For similarities, the exponent is the mean of the logarithms of the ratios.
#[test]
fn ratios_have_a_mean() {
    for (ratios, weights) in [
        ([0.5, 1.25], [1.0, 1.0]),
        ([0.3, 3.0], [2.0, 1.0]),
        ([0.5, 1.0], [1.0, 7.0]),
    ] {
        let maps = [0, 1].map(|it| similar(ratios[it], 1.0, weights[it]));
        let exponent = system(maps.into()).lyapunov_exponent().unwrap();
        let total: f64 = weights.iter().sum();
        let mean = (0..2)
            .map(|it| weights[it] / total * f64::ln(ratios[it]))
            .sum::<f64>();
        assert!(
            exponent.is_exact && (exponent.upper - mean).abs() < 1e-12,
            "{exponent:?}"
        );
        assert_eq!(exponent.is_negative(), mean < 0.0);
    }
}

/// A digraph decides how often maps are applied: in a cycle, equally often whatever their weights are.
#[test]
fn a_cycle_applies_its_maps_equally_often() {
    let edge = |from, to| Edge {
        from,
        to,
        weight: None,
    };
    let exponent = of(Definition {
        maps: vec![similar(0.5, 0.0, 1.0), similar(1.8, 0.3, 100.0)],
        edges: Some(vec![edge(0, 1), edge(1, 0)]),
        ..Definition::default()
    });
    let exponent = exponent.lyapunov_exponent().unwrap();
    assert!((exponent.upper - 0.5 * f64::ln(0.9)).abs() < 1e-12);
}

/// For matrices that commute, the exponent is the largest of the means for their axes; bounds from longer products
/// approach it from above.
#[test]
fn bounds_approach_the_exponent() {
    let diagonal =
        |x, y| Map::new(DAffine2::from_mat2(DMat2::from_diagonal(DVec2::new(x, y)))).weighing(1.0);
    let exponent = system(vec![diagonal(2.0, 0.25), diagonal(0.25, 2.0)])
        .lyapunov_exponent()
        .unwrap();
    let mean = 0.5 * f64::ln(0.5);
    assert!(!exponent.is_exact && exponent.is_negative(), "{exponent:?}");
    assert!(exponent.upper > mean && exponent.length > 8, "{exponent:?}");
}

/// Points that are drawn anew forget everything.
#[test]
fn condensation_sets_end_all_products() {
    let exponent = of(Definition {
        maps: vec![similar(2.0, 0.0, 1.0)],
        condensation: vec![Condensation {
            shape: Shape::Point(DVec2::ZERO),
            weight: Some(1.0),
        }],
        ..Definition::default()
    });
    assert_eq!(
        exponent.lyapunov_exponent().unwrap().upper,
        f64::NEG_INFINITY
    );
}
