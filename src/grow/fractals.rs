//! The fractals of an approximant, depth-first, and the search for the seeds from which they grow.

use std::ops::RangeInclusive;
use std::vec;

use crate::geometry::Frame;
use crate::graph::{Graph, Instance, Object, Replacement, is_ring};

use super::colony::{Colony, Taken};
use super::descent::Descent;
use super::found::{FoundElement, Next, Stop};
use super::start::Start;
use super::walk::Sink;
use super::{Enter, FractalInfo, Subtree};

/// A fractal whose seeds are being looked for.
struct Parent<'g, F: Frame> {
    start: Start<'g, F>,
    /// The approximant whose elements are being replaced, and the walk over it.
    step: u32,
    descent: Descent<'g, F>,
    /// Whether that approximant has an element whose place others take that may seed.
    is_fertile: bool,
    /// Seeds that are still to be walked, the next one last.
    queue: Vec<Start<'g, F>>,
}

impl<'g, F: Frame> Parent<'g, F> {
    fn new(graph: &'g Graph<F>, start: Start<'g, F>) -> Self {
        Self {
            step: start.born,
            descent: Descent::new(graph, &start, start.born),
            start,
            is_fertile: false,
            queue: Vec::new(),
        }
    }

    /// Queues fractals that were seeded earlier by elements of the approximant before those of a root.
    fn take_seeded(&mut self, graph: &'g Graph<F>, root: u32) {
        while let Some(number) = self.start.seeded.clone().next() {
            let seeded = &graph.roots.seeded[number];
            if seeded.born > self.step + 1 || seeded.before > root {
                break;
            }
            self.start.seeded.start += 1;
            self.queue.push(Start::seeded(graph, number));
        }
    }

    /// Proceeds to the next approximant that may have elements to replace before a number of steps;
    /// returns whether there is one.
    fn go_on(&mut self, graph: &'g Graph<F>, steps: u32) -> bool {
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

/// Iterates over the fractals of an approximant, depth-first: every fractal is followed by those that it
/// seeds.
pub(super) struct Fractals<'g, F: Frame> {
    graph: &'g Graph<F>,
    steps: u32,
    /// Ages of the fractals that are visited.
    ages: RangeInclusive<u32>,
    /// By object, whether seeds may come of it; empty if the graph has none.
    leads_to_seeds: Vec<bool>,
    /// By object, whether they may after its own.
    goes_on: Vec<bool>,
    /// The next fractal, if it is known.
    next: Option<Start<'g, F>>,
    /// The fractals that none of the others seeds, which are still to be visited.
    firsts: vec::IntoIter<Start<'g, F>>,
    /// The fractals whose seeds are being looked for, the innermost one last.
    parents: Vec<Parent<'g, F>>,
    count: u64,
}

impl<'g, F: Frame> Fractals<'g, F> {
    pub(super) fn new(
        graph: &'g Graph<F>,
        steps: u32,
        ages: RangeInclusive<u32>,
        firsts: Vec<Start<'g, F>>,
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
        let leads = |instance: &Instance<F>| leads_to_seeds[instance.object];
        let goes_on = |object: &Object<F>| match &object.replacement {
            Replacement::Fixed(successor) => successor.body.instances.iter().any(leads),
            _ => true,
        };
        let objects = graph.objects().iter().filter(|_| graph.seeds);
        Self {
            graph,
            steps,
            ages,
            goes_on: objects.map(goes_on).collect(),
            leads_to_seeds,
            next: None,
            firsts: firsts.into_iter(),
            parents: Vec::new(),
            count: 0,
        }
    }

    /// Returns the next fractal whose elements are visited, to be [followed](Self::follow) when they have been.
    /// Elements on the way to seeds are shown to `sink`, and colonies that it takes are given to it.
    pub(super) fn next<S: Sink<'g, F>>(
        &mut self,
        sink: &mut S,
    ) -> Result<Option<Start<'g, F>>, S::Error> {
        loop {
            if let Some(start) = self.next.take() {
                let taken = self.take_colony(&start, sink)?;
                if taken == Taken::Nothing && self.ages.contains(&self.age(&start)) {
                    return Ok(Some(start));
                }
                if !matches!(taken, Taken::Whole(_) | Taken::Unseen) {
                    self.follow(start);
                }
            }
            let last_birth = self.last_birth();
            let Some(parent) = self.parents.last_mut() else {
                self.next = self.firsts.next();
                if self.next.is_none() {
                    return Ok(None);
                }
                continue;
            };
            self.next = parent.queue.pop();
            if self.next.is_some() {
                continue;
            }
            let (graph, leads_to_seeds, step) = (self.graph, &self.leads_to_seeds, parent.step);
            let enter = |subtree: &Subtree<F>| {
                // Roots may not stand yet.
                if subtree.born <= step && leads_to_seeds[subtree.object] {
                    sink.enter(subtree)
                } else {
                    Enter::Skip
                }
            };
            let found = parent.descent.next(&parent.start, enter, Stop::Nowhere)?;
            let visited = std::mem::take(&mut parent.descent.visited);
            match found {
                Next::Element(found) => {
                    if found.level == step && replaces(graph, leads_to_seeds, &found, sink) {
                        parent.is_fertile |= self.goes_on[found.object];
                        parent.take_seeded(graph, found.state.root);
                        parent.queue.extend(parent.descent.seeds(&found)?);
                        parent.queue.reverse();
                    }
                }
                Next::Run(_) | Next::Subtree(_) => unreachable!("seeds are looked for one by one"),
                Next::Pause => {}
                Next::End => {
                    parent.take_seeded(graph, u32::MAX);
                    parent.queue.reverse();
                    if parent.queue.is_empty() && !parent.go_on(graph, last_birth) {
                        self.parents.pop();
                    }
                }
            }
            sink.visit(visited)?;
        }
    }

    /// Gives a sink the part that it takes of a colony, and returns which part that is.
    fn take_colony<S: Sink<'g, F>>(
        &mut self,
        start: &Start<'g, F>,
        sink: &mut S,
    ) -> Result<Taken, S::Error> {
        let Some(colony) = Colony::of(self.graph, start, self.steps) else {
            return Ok(Taken::Nothing);
        };
        let taken = sink.takes(&colony);
        if !matches!(taken, Taken::Nothing | Taken::Unseen) {
            self.count += taken.walked().fractals;
            sink.colony(colony, taken)?;
            sink.visit(1)?;
        }
        Ok(taken)
    }

    /// Numbers a fractal that begins.
    pub(super) fn number(&mut self, start: &Start<'g, F>) -> FractalInfo {
        let number = self.count;
        self.count += 1;
        FractalInfo {
            number,
            age: self.age(start),
            is_ring: is_ring(start.instances()),
        }
    }

    /// Proceeds to the seeds of a fractal whose elements have been visited.
    pub(super) fn follow(&mut self, start: Start<'g, F>) {
        if self.graph.seeds && start.born < self.last_birth() {
            self.parents.push(Parent::new(self.graph, start));
        }
    }

    /// Returns the age of a fractal in the approximant.
    fn age(&self, start: &Start<'g, F>) -> u32 {
        // Elements that were seeded before may all be gone.
        self.steps.saturating_sub(start.born)
    }

    /// Returns the step after which seeds are younger than all fractals that are visited.
    fn last_birth(&self) -> u32 {
        self.steps.saturating_sub(*self.ages.start())
    }
}

/// Returns whether an element of an approximant that is not the last is replaced.
fn replaces<'g, F: Frame, S: Sink<'g, F>>(
    graph: &Graph<F>,
    leads_to_seeds: &[bool],
    found: &FoundElement<F>,
    sink: &mut S,
) -> bool {
    if !graph.is_fertile(found.object) {
        return false;
    }
    let mut enters = || matches!(sink.enter(&found.subtree()), Enter::Replace | Enter::Divide);
    graph.counts_index() || leads_to_seeds[found.object] && enters()
}
