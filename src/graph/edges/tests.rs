//! Compares what is found backwards with sets that are iterated until nothing changes.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use std::sync::Arc;

use proptest::collection::vec;
use proptest::prelude::*;

use crate::geometry::Frame2;
use crate::graph::{Chain, Graph, Instance, Object, Replacement, Successor};

/// Returns a graph of objects that are kept or replaced by others, and visible or not. Some share their successors.
fn graph(objects: &[(Option<Vec<usize>>, bool)]) -> Graph {
    let count = objects.len();
    let mut known: Vec<(Vec<usize>, Arc<Successor>)> = Vec::new();
    let objects = objects.iter().map(|(children, visible)| {
        let replacement = match children {
            None => Replacement::Kept,
            Some(children) => {
                let children: Vec<usize> = children.iter().map(|child| child % count).collect();
                let shared = known.iter().find(|(alike, _)| *alike == children);
                let shared = shared.map(|(_, successor)| Arc::clone(successor));
                let successor = shared.unwrap_or_else(|| {
                    let instances = children.iter().enumerate();
                    let instance = |(position, child): (usize, &usize)| {
                        Instance::new(*child, Frame2::UNIT, u32::try_from(position).unwrap())
                    };
                    Arc::new(Successor {
                        body: Chain::loose(instances.map(instance).collect()),
                        ..Successor::default()
                    })
                });
                known.push((children, Arc::clone(&successor)));
                Replacement::Fixed(successor)
            }
        };
        Object {
            visible: *visible,
            replacement,
            ..Object::kept(0)
        }
    });
    let objects = objects.collect();
    Graph::of(objects, [], vec![Chain::loose(Vec::new())])
}

/// Applies a function to a set until it changes nothing.
fn settled(mut set: Vec<bool>, next: impl Fn(usize, &[bool]) -> bool) -> Vec<bool> {
    loop {
        let changed: Vec<bool> = (0..set.len()).map(|object| next(object, &set)).collect();
        if changed == set {
            return set;
        }
        set = changed;
    }
}

proptest! {
    #[test]
    fn sets_are_those_of_iteration(
        objects in vec((proptest::option::weighted(0.8, vec(0usize..100, 0..3)), any::<bool>()), 1..12),
        kind in vec(any::<bool>(), 12),
    ) {
        let graph = graph(&objects);
        let leads = |object: usize, set: &[bool]| {
            graph.children(object).any(|(_, instance)| set[instance.object])
        };
        let of_kind: Vec<bool> = (0..objects.len()).map(|object| kind[object]).collect();
        let leading = settled(of_kind, |object, set| set[object] || leads(object, set));
        prop_assert_eq!(graph.leading_to(|object| kind[object]), leading);
        let lasting = settled(vec![true; objects.len()], |object, set| {
            let of = &graph.objects()[object];
            of.visible && (of.is_kept() || leads(object, set))
        });
        prop_assert_eq!(&graph.alive(false), &lasting);
        let reaching = settled(lasting, |object, set| set[object] || leads(object, set));
        prop_assert_eq!(graph.alive(true), reaching);
    }
}

/// Successors that objects share count once.
#[test]
fn instances_are_those_of_distinct_successors() {
    let alike = || (Some(vec![0, 1, 3]), true);
    let objects = [
        alike(),
        alike(),
        (Some(vec![3]), true),
        (None, true),
        alike(),
    ];
    let graph = graph(&objects);
    let reached = graph.instances().map(|(_, instance)| instance.object);
    assert_eq!(reached.collect::<Vec<_>>(), [0, 1, 3, 3]);
}
