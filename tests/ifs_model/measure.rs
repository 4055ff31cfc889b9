//! Moments of measures, against closed forms and against all words of a length.

use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::ifs::{Choice, Condensation, Definition, Ifs, Map, Moments, Shape, complex, toward};
use proptest::prelude::*;

use super::{
    assert_near, assert_near_matrix, definition, digraph, edges, map, matrix, recurrent, system,
};

fn cantor(weights: [f64; 2]) -> Vec<Map> {
    let third = 1.0 / 3.0;
    vec![
        map(third, 0.0, 0.0, third, [0.0, 0.0]).weighing(weights[0]),
        map(third, 0.0, 0.0, third, [2.0 * third, 0.0]).weighing(weights[1]),
    ]
}

#[test]
fn cantor_sets_have_the_moments_of_the_reference() {
    let even = system(cantor([1.0, 1.0])).measure().unwrap().moments;
    assert_near(even.mean, DVec2::new(0.5, 0.0), 1e-15);
    assert_near_matrix(
        even.covariance,
        DMat2::from_diagonal(DVec2::new(0.125, 0.0)),
        1e-15,
    );
    let skewed = system(cantor([0.1, 0.9])).measure().unwrap();
    assert_near(skewed.moments.mean, DVec2::new(0.9, 0.0), 1e-15);
    assert!((skewed.by_map[1].weight - 0.9).abs() < 1e-15);
    assert_near(
        skewed.by_map[0].moments.unwrap().mean,
        DVec2::new(0.3, 0.0),
        1e-15,
    );
}

#[test]
fn distant_attractors_lose_no_digits() {
    let vertices = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.75f64.sqrt()]];
    for far in [0.0, 1e8] {
        let maps = vertices.map(|vertex| Map::new(toward(DVec2::from(vertex) + far, 0.5)));
        let moments = system(maps.to_vec()).measure().unwrap().moments;
        let mean = DVec2::new(0.5, 0.75f64.sqrt() / 3.0) + far;
        assert_near(moments.mean, mean, 1e-15 + 2e-16 * far);
        let covariance = DMat2::from_diagonal(DVec2::splat(1.0 / 18.0));
        assert_near_matrix(moments.covariance, covariance, 1e-15 + 1e-16 * far);
    }
}

/// E z z̄ = E z z̄ / 2 + 1 and E z² = s² E z² + 1 with s = (1 + i)/2 give 2 and (4 + 2i)/5.
#[test]
fn the_twindragon_has_the_moments_of_its_equations() {
    let s = DVec2::new(0.5, 0.5);
    let maps = [DVec2::X, -DVec2::X].map(|t| Map::new(complex(s, t)));
    let moments = system(maps.to_vec()).measure().unwrap().moments;
    assert_near(moments.mean, DVec2::ZERO, 1e-15);
    let covariance = DMat2::from_cols_array(&[1.4, 0.2, 0.2, 0.6]);
    assert_near_matrix(moments.covariance, covariance, 1e-15);
}

/// With probability 1/3 a point is drawn anew: v = 2/3 (v + 1)/9.
#[test]
fn condensation_sets_count_with_their_weights() {
    let with = |shape| {
        let set = Condensation {
            shape,
            weight: None,
        };
        let parts = Definition {
            condensation: vec![set],
            ..definition(cantor([1.0, 1.0]))
        };
        Ifs::new(parts).unwrap().measure().unwrap()
    };
    let half = DVec2::new(0.5, 0.0);
    let point = with(Shape::Point(half));
    assert_near(point.moments.mean, half, 1e-15);
    assert!((point.moments.covariance.x_axis.x - 2.0 / 25.0).abs() < 1e-15);
    assert!((point.by_map[0].weight - 1.0 / 3.0).abs() < 1e-15);
    // The segment adds its own variance 1/12: v = 2/3 (v + 1)/9 + 1/36.
    let segment = with(Shape::polyline(&[DVec2::ZERO, DVec2::X]).unwrap());
    let expected = (2.0 / 27.0 + 1.0 / 36.0) * 27.0 / 25.0;
    assert!((segment.moments.covariance.x_axis.x - expected).abs() < 1e-15);
}

/// The digraph is not symmetric: map 1 follows map 0 only, and map 2 follows map 1 only.
#[test]
fn parts_of_recurrent_systems_follow_the_digraph() {
    let maps = vec![
        map(0.5, 0.0, 0.0, 0.5, [0.0, 0.0]),
        map(0.5, 0.0, 0.0, 0.5, [1.0, 0.0]),
        map(0.5, 0.0, 0.0, 0.5, [0.0, 7.0]),
    ];
    let system = recurrent(maps, &[(0, 0), (0, 1), (1, 2), (2, 0)]);
    let measure = system.measure().unwrap();
    let mean = |map: usize| measure.by_map[map].moments.unwrap().mean;
    let image = |map: usize, of: usize| system.maps()[map].affine.transform_point2(mean(of));
    assert_near(mean(1), image(1, 0), 1e-15);
    assert_near(mean(2), image(2, 1), 1e-14);
    // Map 0 is entered from itself and from map 2 equally often.
    assert_near(mean(0), (image(0, 0) + image(0, 2)) / 2.0, 1e-14);
    let whole: DVec2 = measure
        .by_map
        .iter()
        .map(|part| part.weight * part.moments.unwrap().mean)
        .sum();
    assert_near(measure.moments.mean, whole, 1e-14);
}

#[test]
fn parts_that_are_left_for_ever_have_no_moments() {
    let maps = vec![
        map(0.5, 0.0, 0.0, 0.5, [1.0, 0.0]),
        map(0.5, 0.0, 0.0, 0.5, [0.0, 1.0]),
    ];
    let measure = recurrent(maps, &[(0, 0), (0, 1), (1, 1)])
        .measure()
        .unwrap();
    assert_eq!(
        (measure.by_map[0].weight, measure.by_map[0].moments),
        (0.0, None)
    );
    assert_near(measure.moments.mean, DVec2::new(0.0, 2.0), 1e-14);
    assert_near_matrix(measure.moments.covariance, DMat2::ZERO, 1e-14);
}

/// A map that doubles lengths is harmless if it is rare: second moments are finite while Σ p r² < 1.
#[test]
fn there_are_moments_where_second_ones_are_finite() {
    let doubling = |weight: f64| {
        system(vec![
            map(0.5, 0.0, 0.0, 0.5, [1.0, 0.0]).weighing(1.0 - weight),
            map(2.0, 0.0, 0.0, 2.0, [0.0, 0.0]).weighing(weight),
        ])
    };
    // Σ p r² = 1 at p = 0.2.
    assert_eq!(doubling(0.21).measure(), None);
    let moments = doubling(0.1).measure().unwrap().moments;
    // m = 0.65 m + 0.9; E x² = 0.625 E x² + 0.9 m + 0.9.
    let mean = 0.9 / 0.35;
    let square = 0.9 * (mean + 1.0) / 0.375;
    assert_near(moments.mean, DVec2::new(mean, 0.0), 1e-14);
    assert!((moments.covariance.x_axis.x - (square - mean * mean)).abs() < 1e-12);
    assert_eq!(
        system(vec![map(3.0, 0.0, 0.0, 0.1, [1.0, 1.0])]).measure(),
        None
    );
    assert_eq!(
        system(vec![map(1.0, 0.0, 0.0, 1.0, [1.0, 1.0])]).measure(),
        None
    );
}

/// Returns the moments of all points that a number of steps reaches from the origin in every state, by the
/// probabilities of the walk.
fn by_force(system: &Ifs, steps: u32) -> Moments {
    let walk = system.walk();
    // Powers of the lazy walk, which rests half of the time and is therefore not periodic.
    let states = walk.states();
    let mut weights = vec![1.0; states.len()];
    for _ in 0..2000 {
        let mut next: Vec<f64> = weights.iter().map(|weight| weight / 2.0).collect();
        for (weight, steps) in weights.iter().zip(states) {
            for step in steps {
                next[step.to] += weight * step.probability / 2.0;
            }
        }
        let sum: f64 = next.iter().sum();
        weights = next.iter().map(|weight| weight / sum).collect();
    }
    let starts = weights.into_iter().enumerate();
    let mut points: Vec<(usize, f64, DVec2)> = starts
        .map(|(state, weight)| (state, weight, DVec2::ZERO))
        .collect();
    for _ in 0..steps {
        let mut next = Vec::new();
        for (state, weight, point) in points {
            for step in &states[state] {
                let weight = weight * step.probability;
                match step.choice {
                    Choice::Map(map) => {
                        let image = system.maps()[map].affine.transform_point2(point);
                        next.push((step.to, weight, image));
                    }
                    Choice::Condensation(set) => {
                        for point in representatives(&system.condensation()[set].shape) {
                            next.push((step.to, weight / 2.0, point));
                        }
                    }
                }
            }
        }
        points = next;
    }
    let mean: DVec2 = points
        .iter()
        .map(|&(_, weight, point)| weight * point)
        .sum();
    let mut covariance = DMat2::ZERO;
    for (_, weight, point) in points {
        let off = point - mean;
        covariance += DMat2::from_cols(off * off.x, off * off.y) * weight;
    }
    Moments { mean, covariance }
}

/// Returns two points with the moments of a segment or a point.
fn representatives(shape: &Shape) -> [DVec2; 2] {
    match shape {
        Shape::Point(point) => [*point; 2],
        Shape::Outline(line) => {
            let (from, to) = (line.start(), line.pieces()[0].end());
            let share = 0.5 - 1.0 / 12f64.sqrt();
            [from.lerp(to, share), to.lerp(from, share)]
        }
        Shape::Union(_) => unreachable!("none is made here"),
    }
}

fn shift() -> impl Strategy<Value = DVec2> {
    prop::array::uniform2(-1.0..1.0f64).prop_map(DVec2::from)
}

prop_compose! {
    /// Generates systems of three maps that shrink lengths to less than 0.2.
    fn shrinking()(
        maps in prop::collection::vec((matrix(0.1), shift(), 0.1..1.0f64), 3),
        pairs in prop::option::of(digraph(3)),
        sets in prop::collection::vec((shift(), prop::option::of(shift()), 0.1..1.0f64), 0..2),
    ) -> Ifs {
        let maps = maps.into_iter().map(|(linear, shift, weight)| {
            Map::new(DAffine2::from_mat2_translation(linear, shift)).weighing(weight)
        });
        let condensation = sets.into_iter().map(|(from, to, weight)| Condensation {
            shape: to.and_then(|to| Shape::polyline(&[from, to])).unwrap_or(Shape::Point(from)),
            weight: Some(weight),
        });
        Ifs::new(Definition {
            edges: pairs.as_deref().and_then(edges),
            condensation: condensation.collect(),
            ..definition(maps.collect())
        }).unwrap()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: ProptestConfig::default().failure_persistence, ..crate::common::cases(32) })]

    #[test]
    fn moments_are_those_of_all_words(system in shrinking()) {
        let moments = system.measure().unwrap().moments;
        let expected = by_force(&system, 7);
        assert_near(moments.mean, expected.mean, 4e-5);
        assert_near_matrix(moments.covariance, expected.covariance, 4e-5);
    }

    #[test]
    fn moments_go_with_coordinates(
        system in shrinking(),
        linear in matrix(2.0).prop_filter("singular", |m| m.determinant().abs() > 0.3),
        shift in shift(),
    ) {
        let coordinates = DAffine2::from_mat2_translation(linear, shift);
        let back = coordinates.inverse();
        let maps = system.maps().iter().zip(system.weights());
        let maps = maps.map(|(map, &weight)| Map::new(coordinates * map.affine * back).weighing(weight));
        let sets = system.condensation().iter().zip(system.condensation_weights());
        let sets = sets.map(|(set, &weight)| Condensation {
            shape: match &set.shape {
                Shape::Point(point) => Shape::Point(coordinates.transform_point2(*point)),
                Shape::Outline(line) => Shape::polyline(
                    &[line.start(), line.pieces()[0].end()].map(|p| coordinates.transform_point2(p)),
                ).unwrap(),
                Shape::Union(_) => unreachable!("none is made here"),
            },
            weight: Some(weight),
        });
        let turned = Ifs::new(Definition {
            edges: system.edges().map(|edges| edges.map(|(edge, _)| edge).collect()),
            condensation: sets.collect(),
            ..definition(maps.collect())
        }).unwrap();
        let (given, turned) = (system.measure().unwrap(), turned.measure().unwrap());
        let expected = given.moments.transformed(&coordinates);
        assert_near(turned.moments.mean, expected.mean, 1e-12);
        assert_near_matrix(turned.moments.covariance, expected.covariance, 1e-12);
        for (given, turned) in given.by_map.iter().zip(&turned.by_map) {
            prop_assert!((given.weight - turned.weight).abs() < 1e-12);
        }
    }
}
