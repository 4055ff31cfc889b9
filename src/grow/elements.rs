//! Elements of an approximant as an iterator.

use std::convert::Infallible;

use crate::geometry::{Frame, Frame2};
use crate::graph::Graph;

use super::descent::Descent;
use super::found::{FoundElement, Next, Stop};
use super::fractals::Fractals;
use super::start::Start;
use super::tally::Tally;
use super::walk::Sink;
use super::{Element, Enter, FractalInfo, Growth, WalkError};

impl<F: Frame> Element<F> {
    #[inline]
    pub(super) fn found(graph: &Graph<F>, found: &FoundElement<F>) -> Self {
        Self {
            frame: found.state.frame,
            length: found.state.length,
            appearance: found.state.appearance,
            index: found.index,
            object: found.object,
            born: found.level,
            fertile: graph.is_fertile(found.object),
            visible: graph.objects()[found.object].visible,
            joined: found.joined,
        }
    }
}

/// Iterator over the elements of an approximant with their fractals, in the order of [`walk`](super::walk).
///
/// Memory is proportional to the number of steps. After an error the iterator is exhausted.
#[must_use = "iterators are lazy"]
pub struct Elements<'g, F: Frame = Frame2> {
    graph: &'g Graph<F>,
    fractals: Fractals<'g, F>,
    steps: u32,
    current: Option<Current<'g, F>>,
    counts: Counts<'g>,
    has_ended: bool,
}

/// The fractal whose elements are being visited.
struct Current<'g, F: Frame> {
    fractal: FractalInfo,
    start: Start<'g, F>,
    descent: Descent<'g, F>,
}

impl<'g, F: Frame> Elements<'g, F> {
    /// Returns the elements of approximant `growth.steps`.
    ///
    /// # Panics
    ///
    /// If the graph was compiled for fewer steps.
    pub fn of(graph: &'g Graph<F>, growth: &Growth<'g>) -> Self {
        let firsts = Start::all(graph, growth.steps, growth.seed);
        Self {
            graph,
            fractals: Fractals::new(graph, growth.steps, 0..=u32::MAX, firsts),
            steps: growth.steps,
            current: None,
            counts: Counts(Tally::new(growth)),
            has_ended: false,
        }
    }

    fn advance(&mut self) -> Result<Option<(FractalInfo, Element<F>)>, WalkError<Infallible>> {
        loop {
            let current = match &mut self.current {
                Some(current) => current,
                none => {
                    let Some(start) = self.fractals.next(&mut self.counts)? else {
                        return Ok(None);
                    };
                    none.insert(Current {
                        fractal: self.fractals.number(&start),
                        descent: Descent::new(self.graph, &start, self.steps),
                        start,
                    })
                }
            };
            let Current {
                fractal,
                start,
                descent,
            } = current;
            let found = descent.next(start, |_| Enter::Replace, Stop::Nowhere)?;
            self.counts.0.visit(std::mem::take(&mut descent.visited))?;
            match found {
                Next::Element(found) => {
                    self.counts.0.count(1)?;
                    return Ok(Some((*fractal, Element::found(self.graph, &found))));
                }
                Next::Pause => {}
                Next::End => {
                    if let Some(done) = self.current.take() {
                        self.fractals.follow(done.start);
                    }
                }
                Next::Run(_) | Next::Subtree(_) => unreachable!("nothing is left out"),
            }
        }
    }
}

impl<F: Frame> Iterator for Elements<'_, F> {
    type Item = Result<(FractalInfo, Element<F>), WalkError<Infallible>>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.has_ended {
            return None;
        }
        let next = self.advance().transpose();
        self.has_ended = !matches!(next, Some(Ok(_)));
        next
    }
}

impl<F: Frame> std::iter::FusedIterator for Elements<'_, F> {}

/// A sink that counts, for limits and cancelling.
struct Counts<'g>(Tally<'g>);

impl<'g, F: Frame> Sink<'g, F> for Counts<'_> {
    type Error = WalkError<Infallible>;

    fn visit(&mut self, count: u64) -> Result<(), Self::Error> {
        self.0.visit(count)
    }
}

#[cfg(test)]
mod tests {
    use std::convert::Infallible;

    use crate::catalogue::{Catalogue, Shelf};
    use crate::document::Document;
    use crate::grow::{Element, Elements, FractalInfo, Growth, Visitor, walk};

    #[derive(Default)]
    struct Listed {
        fractal: FractalInfo,
        all: Vec<String>,
    }

    impl Visitor for Listed {
        type Error = Infallible;

        fn begin(&mut self, fractal: FractalInfo) -> Result<(), Infallible> {
            self.fractal = fractal;
            Ok(())
        }

        fn element(&mut self, element: &Element) -> Result<(), Infallible> {
            self.all.push(format!("{:?}", (self.fractal, element)));
            Ok(())
        }
    }

    #[test]
    fn elements_are_those_of_a_walk() {
        let catalogue = Catalogue::embedded();
        for entry in catalogue.entries() {
            if !Shelf::grown().contains(&entry.shelf) {
                continue;
            }
            let source = catalogue.open(&entry).expect("it is there");
            let document = Document::read(&source, &catalogue).expect("it is read");
            let (model, _) = document.resolve(&[]).expect("it is right");
            if model.is_in_space() {
                continue;
            }
            let growth = Growth {
                seed: 7,
                max_elements: 3_000,
                ..Growth::steps(3)
            };
            let graph = model.compile_for(3, 7, 50_000_000).expect("it is compiled");
            let mut listed = Listed::default();
            let walked = walk(&graph, &growth, &mut listed);
            let mut elements = Elements::of(&graph, &growth);
            let all: Vec<_> = elements.by_ref().collect();
            let ended = all.iter().find_map(|item| item.as_ref().err().cloned());
            assert_eq!(ended, walked.err(), "{}", entry.name);
            let all: Vec<_> = all.iter().flatten().map(|it| format!("{it:?}")).collect();
            assert!(all == listed.all, "{}", entry.name);
            assert!(elements.next().is_none());
        }
    }
}
