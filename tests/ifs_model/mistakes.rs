//! Errors of definitions, and default weights.

use kfrac::geometry::DVec2;
use kfrac::ifs::{Condensation, Definition, Edge, Ifs, IfsError, Map, Shape, WeightOwner};

use super::{definition, edges, map};

fn half() -> Map {
    map(0.5, 0.0, 0.0, 0.5, [0.0, 0.0])
}

fn errors(definition: Definition) -> Vec<IfsError> {
    Ifs::new(definition).unwrap_err()
}

#[test]
fn a_system_has_maps_and_they_are_finite() {
    assert_eq!(errors(Definition::default()), [IfsError::NoMaps]);
    let maps = vec![half(), map(f64::INFINITY, 0.0, 0.0, 0.5, [0.0, 0.0])];
    assert_eq!(
        errors(definition(maps)),
        [IfsError::MapNotFinite { map: 1 }]
    );
}

#[test]
fn all_weights_are_positive_and_all_errors_come_at_once() {
    let point = |weight| Condensation {
        shape: Shape::Point(DVec2::ONE),
        weight: Some(weight),
    };
    let flat = Shape::polygon(&[DVec2::ZERO, DVec2::X, 2.0 * DVec2::X]).unwrap();
    let flat = Condensation {
        shape: flat,
        weight: None,
    };
    let maps = vec![half().weighing(0.0), half(), half().weighing(-2.0)];
    let mut edges = edges(&[(0, 1), (1, 2), (2, 0)]).unwrap();
    edges[1].weight = Some(f64::INFINITY);
    let found = errors(Definition {
        maps,
        edges: Some(edges),
        condensation: vec![point(1.0), point(f64::MIN_POSITIVE), point(-0.0), flat],
        initial: Some(Shape::Point(DVec2::new(0.0, f64::NAN))),
    });
    let weight = |of, weight| IfsError::Weight { of, weight };
    let expected = [
        weight(WeightOwner::Map(0), 0.0),
        IfsError::WeightMissing { map: 1 },
        weight(WeightOwner::Map(2), -2.0),
        weight(WeightOwner::Edge(1), f64::INFINITY),
        weight(WeightOwner::Condensation(2), -0.0),
        IfsError::NoExtent { condensation: 3 },
        IfsError::InitialNotFinite,
    ];
    assert_eq!(found, expected);
    let messages: Vec<String> = found.iter().map(ToString::to_string).collect();
    assert_eq!(
        messages[2],
        "map 3 has the weight -2; weights are positive numbers"
    );
    assert_eq!(
        messages[1],
        "map 2 has no weight; all maps have one, or none"
    );
    assert_eq!(messages[5], "condensation set 4 has no extent");
}

#[test]
fn every_map_of_a_digraph_is_entered_and_left() {
    let of = |pairs: &[(usize, usize)]| {
        errors(Definition {
            edges: edges(pairs),
            ..definition(vec![half(), half(), half()])
        })
    };
    let enters = |map| IfsError::NothingEnters { map };
    let leaves = |map| IfsError::NothingLeaves { map };
    assert_eq!(of(&[(0, 1), (1, 1), (1, 2)]), [enters(0), leaves(2)]);
    assert_eq!(of(&[(0, 1), (1, 0)]), [enters(2), leaves(2)]);
    let (edge, map, maps) = (1, 3, 3);
    let unknown = IfsError::NoSuchMap { edge, map, maps };
    assert_eq!(of(&[(0, 1), (1, 3), (2, 0), (1, 2)]), [unknown]);
    assert_eq!(
        unknown.to_string(),
        "edge 2 names map 4, but there are only 3"
    );
    let twice = IfsError::EdgeTwice { edge: 3, first: 0 };
    assert_eq!(of(&[(0, 1), (1, 2), (2, 0), (0, 1)]), [twice]);
    // A digraph need not be strongly connected.
    let parts = Definition {
        edges: edges(&[(0, 0), (0, 1), (1, 1), (1, 2), (2, 2)]),
        ..definition(vec![half(), half(), half()])
    };
    assert!(Ifs::new(parts).is_ok());
}

#[test]
fn weights_are_by_determinants_unless_given() {
    let fern = Definition {
        condensation: vec![Condensation {
            shape: Shape::Point(DVec2::ZERO),
            weight: None,
        }],
        ..definition(vec![
            map(0.0, 0.0, 0.0, 0.16, [0.0, 0.0]),
            map(0.85, 0.04, -0.04, 0.85, [0.0, 1.6]),
            map(0.2, -0.26, 0.23, 0.22, [0.0, 1.6]),
            map(-0.15, 0.28, 0.26, 0.24, [0.0, 0.44]),
        ])
    };
    let system = Ifs::new(fern.clone()).unwrap();
    assert!(system.has_default_weights());
    // Determinants 0, 0.7241, 0.1038 and −0.1088; a twentieth of their mean is 0.01170875.
    let sum = 0.7241 + 0.1038 + 0.1088 + 0.01170875;
    for (weight, area) in system
        .weights()
        .iter()
        .zip([0.01170875, 0.7241, 0.1038, 0.1088])
    {
        assert!((weight - area / sum).abs() < 1e-15);
    }
    assert!((system.condensation_weights()[0] - 0.25).abs() < 1e-15);
    let maps = fern.maps.into_iter().zip([1.0, 85.0, 7.0, 7.0]);
    let maps = maps.map(|(map, weight)| map.weighing(weight)).collect();
    let edge = |from, to, weight| Edge { from, to, weight };
    let given = Ifs::new(Definition {
        edges: Some(vec![
            edge(0, 1, None),
            edge(1, 2, Some(3.0)),
            edge(2, 3, None),
            edge(3, 0, None),
        ]),
        ..definition(maps)
    });
    let given = given.unwrap();
    assert!(!given.has_default_weights());
    assert_eq!(given.weights(), [1.0, 85.0, 7.0, 7.0]);
    let weights: Vec<f64> = given.edges().unwrap().map(|(_, weight)| weight).collect();
    assert_eq!(weights, [85.0, 3.0, 7.0, 1.0]);
    let flat = definition(vec![map(0.0, 0.0, 0.0, 0.5, [0.0, 0.0]); 4]);
    assert_eq!(Ifs::new(flat).unwrap().weights(), [0.25; 4]);
    let vast = definition(vec![map(1e200, 0.0, 0.0, 1e200, [0.0, 0.0]), half()]);
    assert_eq!(Ifs::new(vast).unwrap().weights(), [0.5; 2]);
}
