//! The walk on one thread: the fractals of an approximant, and the elements of each.

use std::ops::RangeInclusive;
use std::sync::atomic::AtomicBool;

use crate::geometry::Frame;
use crate::graph::{CompileError, Graph};
use crate::work;

use super::block::{Blocks, Run};
use super::census::Census;
use super::colony::{Colony, Taken};
use super::descent::Descent;
use super::found::{FoundElement, Next, Stop};
use super::fractals::Fractals;
use super::start::Start;
use super::tally::Tally;
use super::{Element, Enter, FractalInfo, Progress, Subtree, Visitor, WalkError};

/// [Work](work) of an element.
const ELEMENT: usize = 8;

/// Number of steps, seed and limits of growth.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Growth<'a> {
    /// The number of steps; the graph must be compiled for at least as many.
    pub steps: u32,
    /// Seed of random draws, which depend on the path as well.
    pub seed: u64,
    /// The walk ends with an error once it has more elements than this.
    pub max_elements: u64,
    /// The walk ends soon after this is set.
    pub cancel: Option<&'a AtomicBool>,
    /// Counter of the walk's progress.
    pub progress: Option<&'a Progress>,
}

setters!(Growth<'a> {
    seed: u64,
    max_elements: u64,
    cancel: Option<&'a AtomicBool>,
    progress: Option<&'a Progress>,
});

impl Growth<'_> {
    /// Growth by a number of steps with seed 0 and the default limit of 50 million elements.
    #[must_use]
    pub fn steps(steps: u32) -> Self {
        Self {
            steps,
            seed: 0,
            max_elements: 50_000_000,
            cancel: None,
            progress: None,
        }
    }
}

/// Numbers of a walk.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Walked {
    /// The number of elements.
    pub elements: u64,
    /// The number of fractals that have been started, those without elements included.
    pub fractals: u64,
}

/// Receiver of the elements of a walk.
pub(super) trait Sink<'g, F: Frame> {
    type Error: From<CompileError>;

    /// As [`Visitor::enter`].
    fn enter(&mut self, _: &Subtree<F>) -> Enter {
        Enter::Replace
    }
    /// Returns [`Visitor::ages`].
    fn ages(&self) -> RangeInclusive<u32> {
        0..=u32::MAX
    }
    /// Begins a fractal that was born in a step.
    fn begin(&mut self, _: FractalInfo, _: u32) -> Result<(), Self::Error> {
        Ok(())
    }
    /// Receives elements of the fractal, or a block or subtree in their place.
    fn found(&mut self, _: Next<'_, F>) -> Result<(), Self::Error> {
        Ok(())
    }
    /// Ends the fractal.
    fn end(&mut self, _: bool) -> Result<(), Self::Error> {
        Ok(())
    }
    /// As [`Visitor::takes`].
    fn takes(&self, _: &Colony<'_, F>) -> Taken {
        Taken::Nothing
    }
    /// Receives a colony in place of the part that is taken of it.
    fn colony(&mut self, _: Colony<'g, F>, _: Taken) -> Result<(), Self::Error> {
        Ok(())
    }
    /// Counts elements that were visited on the way.
    fn visit(&mut self, count: u64) -> Result<(), Self::Error>;
}

/// Walks over the elements of an approximant, fractal by fractal.
///
/// Fractals come depth-first: a fractal's own elements in order of traversal, then its seeds in
/// the order of birth step, index and part, each followed by its own seeds.
///
/// # Errors
///
/// If there are more elements than allowed, if a generator yields points that are not finite, if
/// the walk is cancelled, or if the visitor returns an error.
///
/// # Panics
///
/// If the graph was compiled for fewer steps.
pub fn walk<F: Frame, V: Visitor<F>>(
    graph: &Graph<F>,
    growth: &Growth<'_>,
    visitor: &mut V,
) -> Result<Walked, WalkError<V::Error>> {
    let blocks = visitor
        .takes_runs()
        .then(|| Blocks::of(graph, visitor.longest_run(), visitor.cuts()));
    let stop = blocks.as_ref().map_or(Stop::Nowhere, Stop::AtBlocks);
    let mut sink = Direct {
        visiting: Visiting::new(graph, visitor),
        tally: Tally::new(growth),
    };
    let firsts = Start::all(graph, growth.steps, growth.seed);
    send(graph, growth.steps, (firsts, true), stop, None, &mut sink)?;
    let walked = sink.tally.finish();
    work::count(ELEMENT.saturating_mul(usize::try_from(walked.elements).unwrap_or(usize::MAX)));
    Ok(walked)
}

/// Walks over fractals, each followed by all that it seeds in turn if `is_whole`, and sends elements to a sink. With a
/// census, ranks count elements that are not visited.
pub(super) fn send<'g: 's, 's, F: Frame, S: Sink<'g, F>>(
    graph: &'g Graph<F>,
    steps: u32,
    (firsts, is_whole): (Vec<Start<'g, F>>, bool),
    stop: Stop<'s, F>,
    census: Option<&'g Census>,
    sink: &mut S,
) -> Result<(), S::Error> {
    let mut fractals = Fractals::new(graph, steps, sink.ages(), firsts);
    while let Some(start) = fractals.next(sink)? {
        let fractal = fractals.number(&start);
        let descent = Descent::new(graph, &start, steps).counting(census);
        send_fractal(fractal, &start, descent, stop, sink)?;
        if !is_whole {
            break;
        }
        fractals.follow(start);
    }
    Ok(())
}

/// Walks over a fractal that has been seeded, and over all that it seeds in turn if `is_whole`.
pub(super) fn walk_over<F: Frame, V: Visitor<F>>(
    graph: &Graph<F>,
    steps: u32,
    start: Start<'_, F>,
    is_whole: bool,
    visitor: &mut V,
) -> Result<Walked, WalkError<V::Error>> {
    let mut sink = Direct {
        visiting: Visiting::new(graph, visitor),
        tally: Tally::new(&Growth::steps(steps)),
    };
    send(
        graph,
        steps,
        (vec![start], is_whole),
        Stop::Nowhere,
        None,
        &mut sink,
    )?;
    Ok(sink.tally.finish())
}

/// Sends the elements of one fractal of the last approximant to a sink.
fn send_fractal<'g: 's, 's, F: Frame, S: Sink<'g, F>>(
    fractal: FractalInfo,
    start: &Start<'g, F>,
    mut descent: Descent<'g, F>,
    stop: Stop<'s, F>,
    sink: &mut S,
) -> Result<(), S::Error> {
    sink.begin(fractal, start.born)?;
    loop {
        let enter = |subtree: &Subtree<F>| sink.enter(subtree);
        let found = descent.next(start, enter, stop)?;
        sink.visit(std::mem::take(&mut descent.visited))?;
        match found {
            Next::End => return sink.end(descent.ends_joined()),
            Next::Pause => {}
            found => sink.found(found)?,
        }
    }
}

/// Visitor with the number of elements that it has seen.
pub(super) struct Visiting<'g, 'v, F: Frame, V> {
    graph: &'g Graph<F>,
    pub(super) visitor: &'v mut V,
    pub(super) seen: u64,
}

impl<'g, 'v, F: Frame, V: Visitor<F>> Visiting<'g, 'v, F, V> {
    pub(super) fn new(graph: &'g Graph<F>, visitor: &'v mut V) -> Self {
        Self {
            graph,
            visitor,
            seen: 0,
        }
    }

    pub(super) fn begin(&mut self, fractal: FractalInfo) -> Result<(), WalkError<V::Error>> {
        self.visitor.begin(fractal).map_err(WalkError::Visitor)
    }

    #[inline]
    pub(super) fn element(&mut self, found: &FoundElement<F>) -> Result<(), WalkError<V::Error>> {
        self.seen += 1;
        let element = Element::found(self.graph, found);
        self.visitor.element(&element).map_err(WalkError::Visitor)
    }

    #[inline]
    pub(super) fn run(&mut self, run: &Run<'_, F>) -> Result<(), WalkError<V::Error>> {
        self.seen += run.count();
        self.visitor.run(run).map_err(WalkError::Visitor)
    }

    pub(super) fn colony(
        &mut self,
        colony: &Colony<'_, F>,
        taken: Taken,
    ) -> Result<(), WalkError<V::Error>> {
        self.seen += taken.walked().elements;
        let visited = self.visitor.colony(colony, taken);
        visited.map_err(WalkError::Visitor)
    }

    pub(super) fn end(&mut self, joined: bool) -> Result<(), WalkError<V::Error>> {
        self.visitor.end(joined).map_err(WalkError::Visitor)
    }
}

/// Sink that shows elements to a visitor at once.
struct Direct<'g, 'v, F: Frame, V> {
    visiting: Visiting<'g, 'v, F, V>,
    tally: Tally<'v>,
}

impl<'g, F: Frame, V: Visitor<F>> Sink<'g, F> for Direct<'_, '_, F, V> {
    type Error = WalkError<V::Error>;

    #[inline]
    fn enter(&mut self, subtree: &Subtree<F>) -> Enter {
        self.visiting.visitor.enter(subtree)
    }

    fn ages(&self) -> RangeInclusive<u32> {
        self.visiting.visitor.ages()
    }

    fn begin(&mut self, fractal: FractalInfo, _: u32) -> Result<(), Self::Error> {
        self.tally.begin(1);
        self.visiting.begin(fractal)
    }

    #[inline]
    fn found(&mut self, next: Next<'_, F>) -> Result<(), Self::Error> {
        match next {
            Next::Element(found) => {
                self.tally.count(1)?;
                self.visiting.element(&found)
            }
            Next::Run(run) => {
                self.tally.count(run.count())?;
                self.visiting.run(&run)
            }
            Next::Subtree(_) | Next::Pause | Next::End => unreachable!("nothing is left out"),
        }
    }

    fn end(&mut self, joined: bool) -> Result<(), Self::Error> {
        self.visiting.end(joined)
    }

    fn takes(&self, colony: &Colony<'_, F>) -> Taken {
        self.visiting.visitor.takes(colony)
    }

    fn colony(&mut self, colony: Colony<'g, F>, taken: Taken) -> Result<(), Self::Error> {
        let Walked { elements, fractals } = taken.walked();
        self.tally.begin(fractals);
        self.tally.count(elements)?;
        self.visiting.colony(&colony, taken)
    }

    #[inline]
    fn visit(&mut self, count: u64) -> Result<(), Self::Error> {
        self.tally.visit(count)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::convert::Infallible;
    use std::ops::RangeInclusive;

    use super::{Growth, walk};
    use crate::catalogue::Catalogue;
    use crate::document::Document;
    use crate::grow::{Element, Enter, FractalInfo, Subtree, Visitor};

    /// Records the elements of fractals of some ages, by age, and the number of calls of `enter`.
    struct Aged {
        ages: RangeInclusive<u32>,
        age: u32,
        seen: BTreeMap<u32, Vec<String>>,
        asked: u64,
    }

    impl Visitor for Aged {
        type Error = Infallible;

        fn ages(&self) -> RangeInclusive<u32> {
            self.ages.clone()
        }

        fn begin(&mut self, fractal: FractalInfo) -> Result<(), Infallible> {
            self.age = fractal.age;
            Ok(())
        }

        fn enter(&mut self, _: &Subtree) -> Enter {
            self.asked += 1;
            Enter::Replace
        }

        fn element(&mut self, element: &Element) -> Result<(), Infallible> {
            let seen = self.seen.entry(self.age).or_default();
            seen.push(format!("{element:?}"));
            Ok(())
        }

        fn end(&mut self, _: bool) -> Result<(), Infallible> {
            Ok(())
        }
    }

    /// Fractals of other ages are not looked at.
    #[test]
    fn fractals_of_one_age_are_those_of_all() {
        let catalogue = Catalogue::embedded();
        for name in [
            "self-seeding-square",
            "self-seeding-square-adjacent",
            "koch",
        ] {
            let source = catalogue.rule(name).unwrap();
            let document = Document::read(&source, &catalogue).unwrap();
            let graph = document.resolve(&[]).unwrap().0.compile(5).unwrap();
            let of = |ages: RangeInclusive<u32>| {
                let mut aged = Aged {
                    ages,
                    age: 0,
                    seen: BTreeMap::new(),
                    asked: 0,
                };
                walk(&graph, &Growth::steps(5), &mut aged).unwrap();
                aged
            };
            let all = of(0..=u32::MAX);
            let mut asked = 0;
            for age in 0..=6 {
                let one = of(age..=age);
                assert!(one.seen.keys().all(|&seen| seen == age), "{name} at {age}");
                assert_eq!(one.seen.get(&age), all.seen.get(&age), "{name} at {age}");
                asked += one.asked;
            }
            assert!(asked <= 2 * all.asked, "{name}: {asked} for {}", all.asked);
            let young = of(0..=2);
            assert!(young.seen.iter().eq(all.seen.range(..=2)), "{name}");
        }
    }
}
