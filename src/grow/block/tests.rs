use std::convert::Infallible;

use super::Run;
use crate::catalogue::{Catalogue, Shelf};
use crate::document::Document;
use crate::graph::Graph;
use crate::grow::{Element, Fractal, Growth, Visitor, walk};

/// Asks runs for some of their elements.
#[derive(Default)]
struct Asking {
    asked: usize,
}

impl Visitor for Asking {
    type Error = Infallible;

    fn begin(&mut self, _: Fractal) -> Result<(), Infallible> {
        Ok(())
    }

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

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}

#[test]
fn some_elements_of_a_run_are_those_among_all() {
    let catalogue = Catalogue::embedded();
    for name in ["h-tree", "pythagoras-30", "koch", "t-square", "dragon"] {
        let source = catalogue.component(Shelf::Rules, name).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let graph = Graph::compile(&rule, 6).unwrap();
        let mut asking = Asking::default();
        walk(&graph, &Growth::steps(6), &mut asking).unwrap();
        assert!(asking.asked > 50, "{name}: {}", asking.asked);
    }
}
