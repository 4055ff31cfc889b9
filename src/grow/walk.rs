use std::ops::RangeInclusive;
use std::sync::atomic::AtomicBool;

use crate::graph::{CompileError, Graph, Instance, Object, Replacement};

use super::block::{Blocks, Run};
use super::census::Census;
use super::colony::{Colony, Taken};
use super::descent::{Descent, Found, FoundRun, Next, Stop};
use super::start::Start;
use super::tally::Tally;
use super::{Element, Enter, Fractal, Progress, Subtree, Visitor, WalkError};

/// How far to grow, and within what limits.
#[derive(Clone, Copy, Debug)]
pub struct Growth<'a> {
    /// The number of steps; the graph must be compiled for at least as many.
    pub steps: u32,
    /// What random draws depend on, beside the path.
    pub seed: u64,
    /// The walk ends with an error once it has more elements than this.
    pub most_elements: u64,
    /// The walk ends soon after this is set.
    pub cancel: Option<&'a AtomicBool>,
    /// Where the walk tells how far it is.
    pub progress: Option<&'a Progress>,
}

impl Growth<'_> {
    /// Growth by a number of steps with seed 0 and the default limit of 50 million elements.
    #[must_use]
    pub fn steps(steps: u32) -> Self {
        Self {
            steps,
            seed: 0,
            most_elements: 50_000_000,
            cancel: None,
            progress: None,
        }
    }
}

/// What a walk has met.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Walked {
    /// The number of elements.
    pub elements: u64,
    /// The number of fractals that have been started, those without elements included.
    pub fractals: u64,
}

/// A fractal whose seeds are being looked for.
struct Parent<'g> {
    start: Start<'g>,
    /// The approximant whose elements are being replaced, and the walk over it.
    step: u32,
    descent: Descent<'g>,
    /// Whether that approximant has an element that is replaced by others that may seed.
    is_fertile: bool,
    /// Seeds that are still to be walked, the next one last.
    queue: Vec<Start<'g>>,
}

impl<'g> Parent<'g> {
    fn new(graph: &'g Graph, start: Start<'g>) -> Self {
        Self {
            step: start.born,
            descent: Descent::new(graph, &start, start.born),
            start,
            is_fertile: false,
            queue: Vec::new(),
        }
    }

    /// What has been seeded before by elements of the approximant that come before those of a root.
    fn take_sown(&mut self, graph: &'g Graph, root: u32) {
        while let Some(number) = self.start.sown.clone().next() {
            let sown = &graph.roots.sown[number];
            if sown.born > self.step + 1 || sown.before > root {
                break;
            }
            self.start.sown.start += 1;
            self.queue.push(Start::sown(graph, number));
        }
    }

    /// Goes on to the next approximant that may have anything to be replaced before a number of steps;
    /// tells whether there is one.
    fn go_on(&mut self, graph: &'g Graph, steps: u32) -> bool {
        let next = if self.is_fertile {
            Some(self.step + 1)
        } else {
            self.start.next_after(graph, self.step)
        };
        let Some(step) = next.filter(|&step| step < steps) else {
            return false;
        };
        self.is_fertile = false;
        self.step = step;
        self.descent = Descent::new(graph, &self.start, step);
        true
    }
}

/// Who gets what a walk comes to.
pub(super) trait Sink<'g> {
    type Error: From<CompileError>;

    /// As [`Visitor::enter`].
    fn enter(&mut self, subtree: &Subtree) -> Enter;
    /// Returns [`Visitor::ages`].
    fn ages(&self) -> RangeInclusive<u32>;
    /// A fractal begins that was born in a step.
    fn begin(&mut self, fractal: Fractal, born: u32) -> Result<(), Self::Error>;
    /// Elements of the fractal, or what stands for them.
    fn found(&mut self, next: Next<'_>) -> Result<(), Self::Error>;
    /// The fractal ends.
    fn end(&mut self, joined: bool) -> Result<(), Self::Error>;
    /// Returns [`Visitor::takes`].
    fn takes(&self, colony: &Colony<'_>) -> Taken;
    /// Receives a colony of which a part is taken.
    fn colony(&mut self, colony: Colony<'g>, taken: Taken) -> Result<(), Self::Error>;
    /// So many elements have been visited on the way.
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
/// the walk is cancelled, or if the visitor says so.
///
/// # Panics
///
/// If the graph was compiled for fewer steps.
pub fn walk<V: Visitor>(
    graph: &Graph,
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
    send(graph, growth, stop, None, &mut sink)?;
    Ok(sink.tally.finish())
}

/// Walks and sends what is found to a sink. With a census ranks count what is not visited.
pub(super) fn send<'g, S: Sink<'g>>(
    graph: &'g Graph,
    growth: &Growth<'_>,
    stop: Stop<'_>,
    census: Option<&'g Census>,
    sink: &mut S,
) -> Result<(), S::Error> {
    let mut walk = Walk::new(graph, growth.steps, stop, census, sink);
    walk.run(Start::initiator(graph, growth.steps, growth.seed))
}

/// Visits a seeded fractal, with all its descendant fractals if `is_whole`.
pub(super) fn walk_over<V: Visitor>(
    graph: &Graph,
    steps: u32,
    start: Start<'_>,
    is_whole: bool,
    visitor: &mut V,
) -> Result<Walked, WalkError<V::Error>> {
    let mut sink = Direct {
        visiting: Visiting::new(graph, visitor),
        tally: Tally::new(&Growth::steps(steps)),
    };
    let mut walk = Walk::new(graph, steps, Stop::Nowhere, None, &mut sink);
    if is_whole {
        walk.run(start)?;
    } else {
        let age = steps.saturating_sub(start.born);
        walk.fractal(&start, age)?;
    }
    Ok(sink.tally.finish())
}

struct Walk<'g, 'v, S> {
    graph: &'g Graph,
    steps: u32,
    /// Whether an object may lead to seeds, by object; empty if there are none.
    leads_to_seeds: Vec<bool>,
    /// Whether the elements that replace an object may lead to seeds, likewise.
    goes_on: Vec<bool>,
    stop: Stop<'v>,
    census: Option<&'g Census>,
    /// Ages of the fractals that are visited.
    ages: RangeInclusive<u32>,
    sink: &'v mut S,
    fractals: u64,
}

impl<'g, 'v, S: Sink<'g>> Walk<'g, 'v, S> {
    fn new(
        graph: &'g Graph,
        steps: u32,
        stop: Stop<'v>,
        census: Option<&'g Census>,
        sink: &'v mut S,
    ) -> Self {
        assert!(
            graph.depth().is_none_or(|depth| depth >= steps),
            "the graph is not resolved for {steps} steps",
        );
        let leads_to_seeds = if graph.seeds {
            graph.leads_to_seeds()
        } else {
            Vec::new()
        };
        let leads = |instance: &Instance| leads_to_seeds[instance.object];
        let goes_on = |object: &Object| match &object.replacement {
            Replacement::Fixed(production) => production.body.instances.iter().any(leads),
            _ => true,
        };
        let objects = graph.objects().iter().filter(|_| graph.seeds);
        Self {
            graph,
            steps,
            goes_on: objects.map(goes_on).collect(),
            leads_to_seeds,
            stop,
            census,
            ages: sink.ages(),
            sink,
            fractals: 0,
        }
    }

    fn run(&mut self, first: Start<'g>) -> Result<(), S::Error> {
        let mut parents = Vec::new();
        let mut next = Some(first);
        // Later seeds are too young.
        let last_birth = self.steps.saturating_sub(*self.ages.start());
        loop {
            if let Some(start) = next.take() {
                // Nothing may be left of what has been seeded before.
                let age = self.steps.saturating_sub(start.born);
                let taken = self.taken(&start)?;
                if taken == Taken::Nothing && self.ages.contains(&age) {
                    self.fractal(&start, age)?;
                }
                let is_whole = matches!(taken, Taken::Whole(_) | Taken::Unseen);
                if self.graph.seeds && start.born < last_birth && !is_whole {
                    parents.push(Parent::new(self.graph, start));
                }
            }
            let Some(parent) = parents.last_mut() else {
                return Ok(());
            };
            next = parent.queue.pop();
            if next.is_some() {
                continue;
            }
            let step = parent.step;
            let enter = |subtree: &Subtree| {
                // Roots may not stand yet.
                if subtree.born <= step && self.leads_to_seeds[subtree.object] {
                    self.sink.enter(subtree)
                } else {
                    Enter::Skip
                }
            };
            let found = parent.descent.next(&parent.start, enter, Stop::Nowhere)?;
            let visited = std::mem::take(&mut parent.descent.visited);
            match found {
                Next::Element(found) => {
                    if found.level == parent.step && self.replaces(&found) {
                        parent.is_fertile |= self.goes_on[found.object];
                        parent.take_sown(self.graph, found.standing.root);
                        parent.queue.extend(parent.descent.seeds(&found)?);
                        parent.queue.reverse();
                    }
                }
                Next::Run(_) | Next::Subtree(_) => unreachable!("seeds are looked for one by one"),
                Next::Pause => {}
                Next::End => {
                    parent.take_sown(self.graph, u32::MAX);
                    parent.queue.reverse();
                    if parent.queue.is_empty() && !parent.go_on(self.graph, last_birth) {
                        parents.pop();
                    }
                }
            }
            self.sink.visit(visited)?;
        }
    }

    /// Passes a colony to the sink and returns the part that the sink takes.
    fn taken(&mut self, start: &Start<'g>) -> Result<Taken, S::Error> {
        let Some(colony) = Colony::of(self.graph, start, self.steps) else {
            return Ok(Taken::Nothing);
        };
        let taken = self.sink.takes(&colony);
        if !matches!(taken, Taken::Nothing | Taken::Unseen) {
            self.fractals += taken.walked().fractals;
            self.sink.colony(colony, taken)?;
            self.sink.visit(1)?;
        }
        Ok(taken)
    }

    /// The elements of one fractal of the last approximant.
    fn fractal(&mut self, start: &Start<'g>, age: u32) -> Result<(), S::Error> {
        let fractal = Fractal {
            number: self.fractals,
            age,
            is_ring: start.chain().is_ring(),
        };
        self.fractals += 1;
        self.sink.begin(fractal, start.born)?;
        let mut descent = Descent::new(self.graph, start, self.steps).counting(self.census);
        loop {
            let enter = |subtree: &Subtree| self.sink.enter(subtree);
            let found = descent.next(start, enter, self.stop)?;
            self.sink.visit(std::mem::take(&mut descent.visited))?;
            match found {
                Next::End => return self.sink.end(descent.ends_joined()),
                Next::Pause => {}
                found => self.sink.found(found)?,
            }
        }
    }

    /// Whether an element of an approximant that is not the last is replaced.
    fn replaces(&mut self, found: &Found) -> bool {
        let object = &self.graph.objects()[found.object];
        if matches!(object.replacement, Replacement::Kept) {
            return false;
        }
        let subtree = Subtree {
            frame: found.standing.frame,
            object: found.object,
            born: found.level,
        };
        self.graph.counts_index()
            || self.leads_to_seeds[found.object] && self.sink.enter(&subtree) == Enter::Replace
    }
}

/// A visitor, and how many elements it has seen.
pub(super) struct Visiting<'g, 'v, V> {
    graph: &'g Graph,
    pub(super) visitor: &'v mut V,
    pub(super) seen: u64,
}

impl<'g, 'v, V: Visitor> Visiting<'g, 'v, V> {
    pub(super) fn new(graph: &'g Graph, visitor: &'v mut V) -> Self {
        Self {
            graph,
            visitor,
            seen: 0,
        }
    }

    pub(super) fn begin(&mut self, fractal: Fractal) -> Result<(), WalkError<V::Error>> {
        self.visitor.begin(fractal).map_err(WalkError::Visitor)
    }

    #[inline]
    pub(super) fn element(&mut self, found: &Found) -> Result<(), WalkError<V::Error>> {
        self.seen += 1;
        let object = &self.graph.objects()[found.object];
        let element = Element {
            frame: found.standing.frame,
            length: found.standing.length,
            coat: found.standing.coat,
            index: found.index,
            object: found.object,
            born: found.level,
            fertile: !matches!(object.replacement, Replacement::Kept),
            joined: found.joined,
        };
        self.visitor.element(&element).map_err(WalkError::Visitor)
    }

    #[inline]
    pub(super) fn run(&mut self, found: &FoundRun<'_>) -> Result<(), WalkError<V::Error>> {
        let run = Run {
            block: found.block,
            object: found.object,
            frame: found.frame,
            length: found.length,
            coat: found.coat,
            born: found.level,
            index: found.index,
            joined: found.joined,
            graph: self.graph,
        };
        self.seen += found.block.len();
        self.visitor.run(&run).map_err(WalkError::Visitor)
    }

    pub(super) fn colony(
        &mut self,
        colony: &Colony<'_>,
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

/// Shows a visitor what is found at once.
struct Direct<'g, 'v, V> {
    visiting: Visiting<'g, 'v, V>,
    tally: Tally<'v>,
}

impl<'g, V: Visitor> Sink<'g> for Direct<'_, '_, V> {
    type Error = WalkError<V::Error>;

    #[inline]
    fn enter(&mut self, subtree: &Subtree) -> Enter {
        self.visiting.visitor.enter(subtree)
    }

    fn ages(&self) -> RangeInclusive<u32> {
        self.visiting.visitor.ages()
    }

    fn begin(&mut self, fractal: Fractal, _: u32) -> Result<(), Self::Error> {
        self.tally.begin(1);
        self.visiting.begin(fractal)
    }

    #[inline]
    fn found(&mut self, next: Next<'_>) -> Result<(), Self::Error> {
        match next {
            Next::Element(found) => {
                self.tally.count(1)?;
                self.visiting.element(&found)
            }
            Next::Run(found) => {
                self.tally.count(found.block.len())?;
                self.visiting.run(&found)
            }
            Next::Subtree(_) | Next::Pause | Next::End => unreachable!("nothing is left out"),
        }
    }

    fn end(&mut self, joined: bool) -> Result<(), Self::Error> {
        self.visiting.end(joined)
    }

    fn takes(&self, colony: &Colony<'_>) -> Taken {
        self.visiting.visitor.takes(colony)
    }

    fn colony(&mut self, colony: Colony<'g>, taken: Taken) -> Result<(), Self::Error> {
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
    use crate::grow::{Element, Enter, Fractal, Subtree, Visitor};

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

        fn begin(&mut self, fractal: Fractal) -> Result<(), Infallible> {
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
