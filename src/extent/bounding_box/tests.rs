//! Tests that a search and a walk find equal bounding boxes.

use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::catalogue::{Catalogue, Shelf};
use crate::diagnostic::Source;
use crate::document::Document;
use crate::grow::{Element, Subtree, Visitor};
use crate::random_rules as rules;
use crate::rule::Rule;

fn read(source: &Arc<Source>) -> Arc<Rule> {
    let document = Document::read(source, &Catalogue::embedded()).unwrap();
    document.resolve(&[]).unwrap().0.into_rule().unwrap()
}

/// Asserts that a search finds the bounding box of a walk; returns whether the search was possible.
fn compare(rule: &Arc<Rule>, steps: u32, seed: u64, shortest: f64) -> bool {
    let graph = Graph::compile(rule, steps).unwrap();
    let growth = Growth {
        seed,
        ..Growth::steps(steps)
    };
    let enter = |subtree: &Subtree| {
        if subtree.frame.length() < shortest {
            Enter::Keep
        } else {
            Enter::Replace
        }
    };
    let pads = vec![0.25; graph.objects().len()];
    let reaches = Reaches {
        all: &graph.reaches(|object| graph.outline_radius(object) + 0.25),
        pads: &pads,
    };
    let Some(searched) = search(&graph, &growth, &reaches, Limits::DRAWING, enter) else {
        return false;
    };
    // A search that holds few elements finds the same box, or none.
    for few in [100, 400, 1_600] {
        let limits = Limits::instead_of(few);
        let found = search(&graph, &growth, &reaches, limits, enter);
        assert_eq!(found.unwrap_or(searched), searched, "{few} elements");
    }
    let mut walked = Walked {
        graph: &graph,
        bounds: Bounds::EMPTY,
        enter,
    };
    walk(&graph, &growth, &mut walked).unwrap();
    assert_eq!(searched, walked.bounds, "{steps} steps, seed {seed}");
    true
}

/// Visitor of all elements that are not too short, with padding around each.
struct Walked<'g, E> {
    graph: &'g Graph,
    bounds: Bounds,
    enter: E,
}

impl<E: Fn(&Subtree) -> Enter> Visitor for Walked<'_, E> {
    type Error = Infallible;

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        (self.enter)(subtree)
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        if let Some(base_element) = self.graph.drawn(element.object) {
            let pad = 0.25 * element.frame.length();
            base_element.add_to(&mut self.bounds, &element.frame, pad);
        }
        Ok(())
    }
}

#[test]
fn a_search_finds_the_box_that_a_walk_finds() {
    let catalogue = Catalogue::embedded();
    let entries = catalogue.entries();
    let mut searched = Vec::new();
    for entry in entries.iter().filter(|entry| entry.shelf == Shelf::RULES) {
        let source = catalogue.open(entry).unwrap();
        if source.text().contains("\nspace: 3\n") {
            continue;
        }
        let rule = read(&source);
        for seed in 0..if rule.is_random() { 8 } else { 1 } {
            for (steps, shortest) in [(0, 0.0), (1, 0.0), (3, 0.0), (6, 0.1)] {
                if compare(&rule, steps, seed, shortest) && steps == 6 {
                    searched.push((entry.name.clone(), seed));
                }
            }
        }
    }
    for (name, seed) in [
        ("random-tree", 7),
        ("sea-fan", 7),
        ("fern", 7),
        ("cut-sheets", 7),
        ("dragon", 0),
    ] {
        let known = searched.contains(&(name.into(), seed));
        assert!(known, "{name} is walked: {searched:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_search_finds_the_box_of_random_rules(
        text in rules::rule(rules::Features { free_index: false, ..rules::Features::ALL }),
        steps in 0..5u32,
        seed in 0..9u64,
        shortest in prop_oneof![Just(0.0), Just(0.2)],
    ) {
        compare(&read(&Source::new("random.yaml", text)), steps, seed, shortest);
    }
}
