//! Tests of runs in windows.

use std::convert::Infallible;
use std::num::NonZero;

use super::Culling;
use crate::catalogue::{Catalogue, Shelf};
use crate::document::Document;
use crate::geometry::Bounds;
use crate::grow::{Element, Enter, Growth, Run, Subtree, Visitor, walk, walk_in_spans};

/// Visitor of the elements that a sight does not cut, one by one or as runs.
#[derive(Clone)]
struct Seen {
    culling: Culling,
    takes_runs: bool,
    runs: u64,
    elements: Vec<Element>,
}

impl Visitor for Seen {
    type Error = Infallible;

    fn enter(&mut self, subtree: &Subtree) -> Enter {
        self.culling.enter(subtree)
    }

    fn cuts(&self) -> Option<f64> {
        self.culling.shortest()
    }

    fn takes_runs(&self) -> bool {
        self.takes_runs
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.elements.push(*element);
        Ok(())
    }

    fn run(&mut self, run: &Run<'_>) -> Result<(), Infallible> {
        self.runs += 1;
        self.elements.extend(run.elements());
        Ok(())
    }
}

/// A window is walked over by runs that lie within it, and by the elements of others: all are those that are found one by one.
#[test]
fn runs_in_windows_are_the_elements_one_by_one() {
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
        let graph = model.compile(12).unwrap();
        let Some(bounds) = graph
            .bounds(12)
            .filter(|it| graph.shrinks() && !it.is_empty())
        else {
            continue;
        };
        let part = |share: f64| bounds.min() + bounds.size() * share;
        let window = Bounds::new(part(0.2), part(0.55));
        let style = &model.metadata().style;
        for (steps, share) in [(5, 0.0), (12, 0.01)] {
            let growth = Growth::steps(steps);
            let shortest = share * bounds.size().max_element();
            let culling = Culling::to_length(&graph, shortest);
            let culling = culling.within(&window, &graph, &growth, style, false);
            let seen = |takes_runs| Seen {
                culling: culling.clone(),
                takes_runs,
                runs: 0,
                elements: Vec::new(),
            };
            let [one_by_one, by_runs] = [false, true].map(|takes_runs| {
                let mut seen = seen(takes_runs);
                walk(&graph, &growth, &mut seen).unwrap();
                seen
            });
            let name = &entry.name;
            assert_eq!(one_by_one.elements.len(), by_runs.elements.len(), "{name}");
            for (a, b) in one_by_one.elements.iter().zip(&by_runs.elements) {
                assert!(a.frame.map().abs_diff_eq(*b.frame.map(), 1e-9), "{name}");
                let rest = |it: &Element| (it.index, it.object, it.born, it.joined, it.fertile);
                assert_eq!(rest(a), rest(b), "{name}");
            }
            let in_spans = |threads: usize| {
                let mut all = Vec::new();
                let threads = NonZero::new(threads).unwrap();
                let fresh = || seen(true);
                walk_in_spans(&graph, &growth, threads, Some(64), fresh, |seen, _| {
                    let frames = seen.elements.drain(..).map(|it| it.frame);
                    all.extend(frames);
                    Ok(())
                })
                .unwrap();
                all
            };
            let on_three = in_spans(3);
            assert_eq!(on_three, in_spans(1), "{name}");
            assert_eq!(on_three.len(), by_runs.elements.len(), "{name}");
            runs += by_runs.runs;
        }
    }
    assert!(runs > 1_000, "{runs}");
}
