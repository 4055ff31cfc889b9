use std::sync::atomic::{AtomicBool, Ordering};

use crate::graph::{Graph, Replacement};

use super::block::{Blocks, Run};
use super::descent::{Descent, Found, Next, PATIENCE, Start};
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

/// A walk may visit so many elements for each that is allowed, those on the way counted, or so many
/// in all if that is more.
const VISITS_AN_ELEMENT: u64 = 20;
const FEW_VISITS: u64 = 1 << 24;

/// A fractal whose seeds are being looked for.
struct Parent<'g> {
    start: Start<'g>,
    /// The approximant whose elements are being replaced, and the walk over it.
    step: u32,
    descent: Descent<'g>,
    /// Whether that approximant has an element that can be replaced.
    is_fertile: bool,
    /// Seeds that are still to be walked, the next one last.
    queue: Vec<Start<'g>>,
}

struct Walk<'g, 'v, V> {
    graph: &'g Graph,
    growth: Growth<'v>,
    visitor: &'v mut V,
    walked: Walked,
    /// The elements that progress has been told of.
    told: u64,
    visited: u64,
    next_look: u64,
    /// Where the visitor takes elements by blocks.
    blocks: Option<Blocks>,
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
    assert!(
        graph.depth().is_none_or(|depth| depth >= growth.steps),
        "the graph is not resolved for {} steps",
        growth.steps
    );
    let blocks = visitor.takes_runs().then(|| Blocks::of(graph));
    let mut walk = Walk {
        graph,
        growth: *growth,
        visitor,
        walked: Walked::default(),
        told: 0,
        visited: 0,
        next_look: PATIENCE,
        blocks,
    };
    walk.run(Start::initiator(growth.seed))?;
    walk.tell_progress();
    Ok(walk.walked)
}

impl<'g, V: Visitor> Walk<'g, '_, V> {
    fn run(&mut self, first: Start<'g>) -> Result<(), WalkError<V::Error>> {
        let mut parents = Vec::new();
        let mut next = Some(first);
        loop {
            if let Some(start) = next.take() {
                self.fractal(&start)?;
                if self.graph.seeds && start.born < self.growth.steps {
                    parents.push(Parent {
                        step: start.born,
                        descent: Descent::new(self.graph, &start, start.born),
                        start,
                        is_fertile: false,
                        queue: Vec::new(),
                    });
                }
            }
            let Some(parent) = parents.last_mut() else {
                return Ok(());
            };
            next = parent.queue.pop();
            if next.is_some() {
                continue;
            }
            let found = parent.descent.next(&parent.start, self.visitor, None)?;
            let visited = std::mem::take(&mut parent.descent.visited);
            match found {
                Next::Element(found) => {
                    if found.level == parent.step && self.replaces(&found) {
                        parent.is_fertile = true;
                        parent.queue = parent.descent.seeds(&found)?;
                        parent.queue.reverse();
                    }
                }
                Next::Run(_) => unreachable!("seeds are looked for without blocks"),
                Next::Pause => {}
                Next::End if parent.is_fertile && parent.step + 1 < self.growth.steps => {
                    parent.is_fertile = false;
                    parent.step += 1;
                    parent.descent = Descent::new(self.graph, &parent.start, parent.step);
                }
                Next::End => {
                    parents.pop();
                }
            }
            self.visit(visited)?;
        }
    }

    /// The elements of one fractal of the last approximant.
    fn fractal(&mut self, start: &Start<'g>) -> Result<(), WalkError<V::Error>> {
        let fractal = Fractal {
            number: self.walked.fractals,
            age: self.growth.steps - start.born,
            is_ring: start.chain(self.graph).is_ring(),
        };
        self.walked.fractals += 1;
        self.visitor.begin(fractal).map_err(WalkError::Visitor)?;
        let mut descent = Descent::new(self.graph, start, self.growth.steps);
        let mut index = 0;
        loop {
            let found = descent.next(start, self.visitor, self.blocks.as_mut())?;
            self.visit(std::mem::take(&mut descent.visited))?;
            match found {
                Next::Element(found) => {
                    index += 1;
                    self.count(1)?;
                    self.visitor
                        .element(&self.element(&found, index))
                        .map_err(WalkError::Visitor)?;
                }
                Next::Run(found) => {
                    self.count(found.block.len())?;
                    let run = Run {
                        block: &found.block,
                        frame: found.frame,
                        length: found.length,
                        born: found.level,
                        index: index + 1,
                        joined: found.joined,
                        graph: self.graph,
                    };
                    self.visitor.run(&run).map_err(WalkError::Visitor)?;
                    index += found.block.len();
                }
                Next::Pause => {}
                Next::End => break,
            }
        }
        self.visitor
            .end(descent.ends_joined())
            .map_err(WalkError::Visitor)
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
        self.graph.counts_index() || self.visitor.enter(&subtree) == Enter::Replace
    }

    fn element(&self, found: &Found, index: u64) -> Element {
        let object = &self.graph.objects()[found.object];
        Element {
            frame: found.standing.frame,
            length: found.standing.length,
            index,
            object: found.object,
            born: found.level,
            fertile: !matches!(object.replacement, Replacement::Kept),
            joined: found.joined,
        }
    }

    /// Counts elements that come next.
    fn count(&mut self, elements: u64) -> Result<(), WalkError<V::Error>> {
        self.walked.elements += elements;
        if self.walked.elements > self.growth.most_elements {
            return Err(WalkError::TooManyElements {
                limit: self.growth.most_elements,
            });
        }
        Ok(())
    }

    fn visit(&mut self, count: u64) -> Result<(), WalkError<V::Error>> {
        self.visited += count;
        if self.visited < self.next_look {
            return Ok(());
        }
        self.next_look = self.visited + PATIENCE;
        self.tell_progress();
        let most = FEW_VISITS.max(self.growth.most_elements.saturating_mul(VISITS_AN_ELEMENT));
        if self.visited > most {
            return Err(WalkError::TooLong { limit: most });
        }
        match self.growth.cancel {
            Some(cancel) if cancel.load(Ordering::Relaxed) => Err(WalkError::Cancelled),
            _ => Ok(()),
        }
    }

    fn tell_progress(&mut self) {
        if let Some(progress) = self.growth.progress {
            progress.count(self.walked.elements - self.told);
            self.told = self.walked.elements;
        }
    }
}
