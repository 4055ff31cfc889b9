//! Tests that runs agree with the same elements visited one by one.

use std::convert::Infallible;
use std::sync::Arc;

use super::{KeptBlocks, Run};
use crate::catalogue::{Catalogue, Shelf};
use crate::document::Document;
use crate::graph::Graph;
use crate::grow::{Element, Enter, Growth, Subtree, Visitor, walk};

/// Visitor that compares selections of a run's elements with filters over all of them.
#[derive(Default)]
struct Asking {
    asked: usize,
}

impl Visitor for Asking {
    type Error = Infallible;

    fn takes_runs(&self) -> bool {
        true
    }

    fn element(&mut self, _: &Element) -> Result<(), Infallible> {
        Ok(())
    }

    fn run(&mut self, run: &Run<'_>) -> Result<(), Infallible> {
        let of = |test: &dyn Fn(&Element) -> bool| -> Vec<String> {
            let elements = run.elements().enumerate();
            let chosen = elements.filter(|(_, element)| test(element));
            chosen.map(|chosen| format!("{chosen:?}")).collect()
        };
        let even = |element: &Element| element.object.is_multiple_of(2);
        let chosen: Vec<_> = run
            .chosen(even)
            .map(|chosen| format!("{chosen:?}"))
            .collect();
        assert_eq!(chosen, of(&even));
        for steps in [0..=3, 4..=4, 5..=6, 0..=u32::MAX, 9..=20] {
            let mut born: Vec<_> = run.born_in(steps.clone()).collect();
            assert!(born.is_sorted_by_key(|(number, element)| (element.born, *number)));
            assert_eq!(born.len() as u64, run.count_born_in(&steps));
            born.sort_by_key(|(number, _)| *number);
            let born: Vec<_> = born.iter().map(|born| format!("{born:?}")).collect();
            assert_eq!(born, of(&|element| steps.contains(&element.born)));
            self.asked += born.len();
        }
        Ok(())
    }
}

#[test]
fn some_elements_of_a_run_are_those_among_all() {
    let catalogue = Catalogue::embedded();
    for name in ["h-tree", "pythagoras-30", "koch", "t-square", "dragon"] {
        let source = catalogue.component(Shelf::RULES, name).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let graph = Graph::compile(&rule, 6).unwrap();
        let mut asking = Asking::default();
        walk(&graph, &Growth::steps(6), &mut asking).unwrap();
        assert!(asking.asked > 50, "{name}: {}", asking.asked);
    }
}

/// Visitor that keeps elements below a length, and collects elements one by one or from runs.
struct Cutting {
    shortest: f64,
    takes_runs: bool,
    runs: u64,
    elements: Vec<Element>,
}

impl Visitor for Cutting {
    type Error = Infallible;

    fn takes_runs(&self) -> bool {
        self.takes_runs
    }

    fn longest_run(&self) -> u64 {
        100
    }

    fn cuts(&self) -> Option<f64> {
        Some(self.shortest)
    }

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        if subtree.frame.stretch() < self.shortest {
            Enter::Keep
        } else {
            Enter::Replace
        }
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.elements.push(*element);
        Ok(())
    }

    fn run(&mut self, run: &Run<'_>) -> Result<(), Infallible> {
        assert!(run.count() <= self.longest_run());
        self.runs += 1;
        self.elements.extend(run.elements());
        Ok(())
    }
}

#[test]
fn runs_down_to_a_length_are_the_elements_one_by_one() {
    let catalogue = Catalogue::embedded();
    let mut runs = 0;
    for entry in catalogue.entries() {
        if !matches!(entry.shelf, Shelf::RULES | Shelf::IFS) {
            continue;
        }
        let source = catalogue.open(&entry).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let model = document.resolve(&[]).unwrap().0;
        if model.is_in_space() {
            continue;
        }
        let graph = model.compile(20).unwrap();
        if !graph.shrinks() {
            continue;
        }
        // The second pair of values reaches the limit of steps as well.
        for (steps, shortest) in [(20, 0.04), (5, 0.01)] {
            let grown = |takes_runs| {
                let mut cutting = Cutting {
                    shortest,
                    takes_runs,
                    runs: 0,
                    elements: Vec::new(),
                };
                walk(&graph, &Growth::steps(steps), &mut cutting).unwrap();
                cutting
            };
            let [one_by_one, by_runs] = [false, true].map(grown);
            let what = format!("{} at {steps}", entry.name);
            assert_eq!(one_by_one.runs, 0);
            assert_eq!(one_by_one.elements.len(), by_runs.elements.len(), "{what}");
            for (a, b) in one_by_one.elements.iter().zip(&by_runs.elements) {
                let near = a.frame.map().abs_diff_eq(*b.frame.map(), 1e-9);
                assert!(
                    near && (a.length - b.length).abs() < 1e-9,
                    "{what}: {a:?} {b:?}"
                );
                let rest = |element: &Element| {
                    let Element {
                        index,
                        object,
                        born,
                        fertile,
                        joined,
                        ..
                    } = *element;
                    (
                        index,
                        object,
                        born,
                        fertile,
                        joined,
                        element.frame.direction(),
                    )
                };
                assert_eq!(rest(a), rest(b), "{what}");
            }
            runs += by_runs.runs;
        }
    }
    assert!(runs > 10_000, "{runs}");
}

#[test]
fn blocks_are_kept_by_their_limits() {
    let catalogue = Catalogue::embedded();
    let document = Document::read(&catalogue.rule("koch").unwrap(), &catalogue).unwrap();
    let graph = document.resolve(&[]).unwrap().0.compile(8).unwrap();
    let kept = KeptBlocks::default();
    let of = |longest, shortest| kept.of(&graph, longest, shortest);
    let first = of(64, None);
    assert!(Arc::ptr_eq(&first, &of(64, None)));
    assert!(!Arc::ptr_eq(&first, &of(32, None)));
    assert!(!Arc::ptr_eq(&first, &of(64, Some(0.01))));
    assert!(Arc::ptr_eq(&first, &of(64, None)));
    for longest in 1..8 {
        of(longest, None);
    }
    assert!(!Arc::ptr_eq(&first, &of(64, None)));
}
