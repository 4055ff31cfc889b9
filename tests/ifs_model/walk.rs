//! The walk of random iteration: states, probabilities and stationary weights.

use kfrac::geometry::DVec2;
use kfrac::ifs::{Choice, Condensation, Definition, Ifs, Map, Shape};

use super::{definition, edges, map, recurrent, system};

fn halves(count: usize) -> Vec<Map> {
    (0..count)
        .map(|_| map(0.5, 0.0, 0.0, 0.5, [0.0, 0.0]))
        .collect()
}

#[track_caller]
fn assert_stationary(system: &Ifs, expected: &[f64]) {
    let found = system.walk().stationary().unwrap();
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-15, "{found}, not {expected}");
    }
}

#[test]
fn without_a_digraph_there_is_one_state() {
    let maps = halves(2).into_iter().zip([1.0, 3.0]);
    let maps = maps.map(|(map, weight)| map.weighing(weight)).collect();
    let system = system(maps);
    let walk = system.walk();
    let [steps] = walk.states() else {
        panic!("{walk:?}");
    };
    let taken: Vec<_> = steps
        .iter()
        .map(|step| (step.choice, step.probability, step.to))
        .collect();
    assert_eq!(
        taken,
        [(Choice::Map(0), 0.25, 0), (Choice::Map(1), 0.75, 0)]
    );
    assert_stationary(&system, &[1.0]);
}

/// Edges point forward: 1 follows 0 only, 2 follows 1 only. If they pointed backwards, 2 would follow 0.
#[test]
fn an_edge_points_to_what_comes_after() {
    let system = recurrent(halves(3), &[(0, 0), (0, 1), (1, 2), (2, 0)]);
    let walk = system.walk();
    let from_1 = &walk.states()[1];
    assert_eq!(
        (from_1.len(), from_1[0].choice, from_1[0].to),
        (1, Choice::Map(2), 2)
    );
    assert_stationary(&system, &[0.5, 0.25, 0.25]);
}

#[test]
fn periodic_walks_and_those_with_one_end_have_stationary_weights() {
    assert_stationary(&recurrent(halves(2), &[(0, 1), (1, 0)]), &[0.5, 0.5]);
    let end = recurrent(halves(3), &[(0, 0), (0, 1), (1, 2), (2, 1)]);
    assert_stationary(&end, &[0.0, 0.5, 0.5]);
    let ends = recurrent(halves(3), &[(0, 0), (0, 1), (0, 2), (1, 1), (2, 2)]);
    assert_eq!(ends.walk().stationary(), None);
    assert_eq!(ends.measure(), None);
}

#[test]
fn any_map_may_follow_a_condensation_set() {
    let set = Condensation {
        shape: Shape::Point(DVec2::ZERO),
        weight: Some(1.0),
    };
    let maps = halves(2).into_iter().map(|map| map.weighing(0.5)).collect();
    let system = Ifs::new(Definition {
        edges: edges(&[(0, 0), (1, 1)]),
        condensation: vec![set],
        ..definition(maps)
    });
    let system = system.unwrap();
    // Half of all steps draw anew.
    assert_stationary(&system, &[0.25, 0.25, 0.5]);
    let walk = system.walk();
    let after: Vec<_> = walk.states()[2]
        .iter()
        .map(|step| (step.probability, step.to))
        .collect();
    assert_eq!(after, [(0.25, 0), (0.25, 1), (0.5, 2)]);
    for steps in walk.states() {
        assert_eq!(steps.iter().map(|step| step.probability).sum::<f64>(), 1.0);
    }
}
