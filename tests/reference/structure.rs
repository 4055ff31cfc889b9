//! The listed elements of rules, and their connection.

use std::collections::BTreeSet;

use kfrac::geometry::DVec2;
use kfrac::graph::{Chain, Graph, Replacement, Successor};
use kfrac::grow::Growth;

use super::common::grown;
use super::data::{Entry, Listed, reference};
use super::{CLOSE, deepest};

fn is_like(graph: &Graph, chain: &Chain, listed: &[&Listed]) -> bool {
    chain.instances.len() == listed.len()
        && chain
            .instances
            .iter()
            .zip(listed)
            .all(|(instance, listed)| {
                let [from, to] = instance.frame.ends();
                let kept = matches!(
                    graph.objects()[instance.object].replacement,
                    Replacement::Kept
                );
                from.abs_diff_eq(DVec2::new(listed.0, listed.1), CLOSE)
                    && to.abs_diff_eq(DVec2::new(listed.2, listed.3), CLOSE)
                    && instance.frame.direction().number() == listed.4
                    && listed.is_fertile() != kept
            })
}

fn is_production(graph: &Graph, production: &Successor, generator: &[Listed]) -> bool {
    let part = |number| -> Vec<&Listed> {
        generator
            .iter()
            .filter(|e| usize::from(e.6) == number)
            .collect()
    };
    let seeds = &production.seeds;
    is_like(graph, &production.body, &part(0))
        && seeds.len() == usize::from(generator.iter().map(|e| e.6).max().unwrap())
        && (1..)
            .zip(seeds)
            .all(|(number, seed)| is_like(graph, &seed.chain, &part(number)))
}

#[test]
fn every_rule_lists_the_elements_of_the_reference() {
    for entry in reference().rules.iter().filter(|entry| !entry.is_random()) {
        let id = &entry.id;
        let graph = entry.graph(3);
        let initiator: Vec<_> = entry.initiator.iter().collect();
        assert!(
            is_like(&graph, graph.initiator(0), &initiator),
            "{id}: initiator"
        );
        let mut used = BTreeSet::new();
        for object in graph.objects() {
            if let Replacement::Fixed(production) = &object.replacement {
                let generator = entry
                    .generators
                    .iter()
                    .position(|g| is_production(&graph, production, g));
                used.insert(generator.unwrap_or_else(|| panic!("{id}: {production:#?}")));
            }
        }
        assert_eq!(
            used.len(),
            entry.generators.len(),
            "{id}: generators that are used"
        );
    }
}

#[test]
fn every_base_element_is_that_of_the_reference() {
    for entry in reference().rules {
        let rule = entry.rule();
        let [base_element] = rule.base_elements() else {
            panic!("{}: one base element", entry.id)
        };
        let ends = base_element.pieces().iter().map(|piece| piece.end());
        let mut points: Vec<_> = std::iter::once(base_element.start()).chain(ends).collect();
        if base_element.is_closed() {
            points.pop();
        }
        assert_eq!(
            base_element.is_closed(),
            entry.base_element.closed,
            "{}",
            entry.id
        );
        assert_eq!(
            points.len(),
            entry.base_element.points.len(),
            "{}",
            entry.id
        );
        for (point, &expected) in points.iter().zip(&entry.base_element.points) {
            assert!(
                point.abs_diff_eq(expected.into(), CLOSE),
                "{}: {point}",
                entry.id
            );
        }
    }
}

#[test]
fn elements_of_a_connected_rule_share_their_end_points() {
    let placed = |entry: &&Entry| entry.counts.is_none();
    for entry in reference().rules.iter().filter(placed) {
        let graph = entry.graph(4);
        let joins = entry.connected && !entry.base_element.closed;
        for n in 0..=deepest(&graph) {
            for grown in grown(&graph, &Growth::steps(n)) {
                let what = format!("{} at {n}, fractal {}", entry.id, grown.fractal.number);
                for (k, pair) in grown.elements.windows(2).enumerate() {
                    let [[_, end], [start, _]] =
                        [pair[0], pair[1]].map(|element| element.frame.ends());
                    assert_eq!(pair[1].joined, joins, "{what}: element {}", k + 2);
                    assert!(
                        !entry.connected || end.abs_diff_eq(start, CLOSE),
                        "{what}: element {}",
                        k + 2
                    );
                }
                // The fractals seeded by the library's rules are closed, too.
                let (first, last) = (&grown.elements[0], grown.elements.last().unwrap());
                assert_eq!(grown.is_ring, joins && entry.closed, "{what}");
                assert_eq!(first.joined, joins && entry.closed, "{what}");
                let [[start, _], [_, end]] = [first, last].map(|element| element.frame.ends());
                assert!(!grown.is_ring || end.abs_diff_eq(start, CLOSE), "{what}");
            }
        }
    }
}
