//! Walks that do not go everywhere.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

mod common;
#[path = "laws/rules.rs"]
mod rules;

use std::convert::Infallible;
use std::sync::Arc;

use common::document_of;
use kfrac::document::Document;
use kfrac::geometry::DVec2;
use kfrac::graph::Graph;
use kfrac::grow::{Element, Enter, Fractal, Growth, Subtree, Visitor, walk};
use kfrac::rule::Rule;
use proptest::prelude::*;
use rules::Features;

fn read(text: &str) -> Arc<Rule> {
    let document: Document = document_of(text);
    Arc::new(
        document
            .resolve(&[])
            .unwrap_or_else(|e| panic!("{e}{text}"))
            .0,
    )
}

/// Collects elements down to a length, and what has been replaced on the way.
#[derive(Default)]
struct Cut {
    shortest: f64,
    /// What is skipped, by the sum of birth and object.
    skipped: Option<usize>,
    replaced: Vec<Subtree>,
    fractals: Vec<(Fractal, Vec<Element>, bool)>,
}

impl Cut {
    fn to(shortest: f64) -> Self {
        Self {
            shortest,
            ..Self::default()
        }
    }

    fn walked(mut self, graph: &Graph, steps: u32, seed: u64) -> Self {
        let growth = Growth {
            seed,
            ..Growth::steps(steps)
        };
        walk(graph, &growth, &mut self).unwrap();
        self
    }

    fn elements(&self) -> impl Iterator<Item = &Element> {
        self.fractals.iter().flat_map(|(_, elements, _)| elements)
    }
}

impl Visitor for Cut {
    type Error = Infallible;

    fn begin(&mut self, fractal: Fractal) -> Result<(), Infallible> {
        self.fractals.push((fractal, Vec::new(), false));
        Ok(())
    }

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        let number = subtree.born as usize + subtree.object;
        if self.skipped.is_some_and(|skipped| number % 3 == skipped) {
            return Enter::Skip;
        }
        if subtree.frame.length() < self.shortest {
            return Enter::Keep;
        }
        self.replaced.push(*subtree);
        Enter::Replace
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.fractals.last_mut().unwrap().1.push(*element);
        Ok(())
    }

    fn end(&mut self, joined: bool) -> Result<(), Infallible> {
        self.fractals.last_mut().unwrap().2 = joined;
        Ok(())
    }
}

/// All that elements tell, but their rank.
fn told(elements: &[Element]) -> String {
    let told = |e: &Element| {
        format!(
            "{:?}{}{}{}{}",
            e.frame, e.object, e.born, e.fertile, e.joined
        )
    };
    elements.iter().map(told).collect()
}

fn close(a: DVec2, b: DVec2) -> bool {
    a.distance(b) <= 1e-12 * (1.0 + a.length())
}

/// That what is said to be joined stands together.
fn assert_joined(fractals: &[(Fractal, Vec<Element>, bool)]) {
    for (_, elements, end) in fractals {
        for pair in elements.windows(2).filter(|pair| pair[1].joined) {
            assert!(close(pair[0].frame.ends()[1], pair[1].frame.ends()[0]));
        }
        if let ([first, ..], [.., last], true) = (&elements[..], &elements[..], end) {
            assert!(!first.joined || close(last.frame.ends()[1], first.frame.ends()[0]));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// A detail beyond the depth of a walk changes nothing.
    #[test]
    fn what_is_not_small_is_not_cut(text in rules::rule(Features::ALL), steps in 0..4u32, seed in 0..3u64) {
        let graph = Graph::compile(&read(&text), steps).unwrap();
        let plain = common::grown(&graph, &Growth { seed, ..Growth::steps(steps) });
        let cut = Cut::to(1e-9).walked(&graph, steps, seed);
        prop_assert_eq!(plain.len(), cut.fractals.len());
        for (plain, (fractal, elements, _)) in plain.iter().zip(&cut.fractals) {
            prop_assert_eq!(plain.fractal, *fractal);
            prop_assert_eq!(told(&plain.elements), told(elements));
        }
    }

    /// What is cut stands as it stood in its approximant, and what is small is cut.
    #[test]
    fn what_is_cut_stands_as_in_its_approximant(text in rules::rule(Features::ALL), steps in 1..5u32, seed in 0..3u64) {
        let graph = Graph::compile(&read(&text), steps).unwrap();
        prop_assume!(!graph.counts_index());
        let cut = Cut::to(0.3).walked(&graph, steps, seed);
        for replaced in &cut.replaced {
            prop_assert!(replaced.frame.length() >= 0.3);
        }
        let approximants: Vec<_> = (0..=steps)
            .map(|step| Cut::to(0.0).walked(&graph, step, seed))
            .collect();
        for element in cut.elements() {
            let small = element.frame.length() < 0.3;
            prop_assert!(small || !element.fertile || element.born == steps);
            let mut stood = approximants[element.born as usize].elements();
            prop_assert!(stood.any(|e| (e.frame, e.object, e.born, e.fertile)
                == (element.frame, element.object, element.born, element.fertile)));
        }
        assert_joined(&cut.fractals);
    }

    /// What is skipped leaves a gap: nothing is joined across it, and nothing else is missing.
    #[test]
    fn what_is_skipped_leaves_a_gap(text in rules::rule(Features::ALL), steps in 1..4u32, skipped in 0..3usize) {
        let graph = Graph::compile(&read(&text), steps).unwrap();
        prop_assume!(!graph.counts_index());
        let gaps = Cut { skipped: Some(skipped), ..Cut::default() }.walked(&graph, steps, 0);
        let plain = Cut::default().walked(&graph, steps, 0);
        assert_joined(&gaps.fractals);
        // What is visited comes in the same order, and with the gaps in it everything is there.
        let mut left = plain.elements();
        for element in gaps.elements() {
            prop_assert!(left.any(|e| e.frame == element.frame && e.object == element.object));
        }
    }
}
