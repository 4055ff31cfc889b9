//! Depth-first traversal of one fractal at one step.

use crate::geometry::{Direction, Frame, Frame2, Outline};
use crate::graph::{Chain, CompileError, Graph, Replacement, Seed, Successor, is_ring};

use super::block::{Blocks, Run};
use super::census::Census;
use super::evaluator::{Evaluator, ReplacementContext};
use super::found::{FoundElement, FoundSubtree, Next, Stop};
use super::start::{Start, StartChain, TraversalState, birth, seed_placement};
use super::{Enter, Subtree};

/// Number of visits between two opportunities to stop.
pub(super) const PATIENCE: u64 = 1 << 12;

/// Source of the chain of a stack entry.
#[derive(Clone, Copy)]
enum Source<'g, F: Frame> {
    Start,
    Fixed(&'g Chain<F>),
    /// Chain in the pool of evaluated successors.
    Pooled(usize),
}

struct Entry<'g, F: Frame> {
    state: TraversalState<F>,
    source: Source<'g, F>,
    reversed: bool,
    /// Number of instances visited.
    next: usize,
    /// Whether the end of the chain is the end point of all replaced elements that end with it.
    meets_end: bool,
    /// Step of birth of the chain's elements.
    level: u32,
}

/// Depth-first traversal of one fractal of approximant `target`.
pub(super) struct Descent<'g, F: Frame = Frame2> {
    graph: &'g Graph<F>,
    born: u32,
    target: u32,
    stack: Vec<Entry<'g, F>>,
    /// Whether the preceding element ends where the next one starts.
    joined: bool,
    ranks: Ranks,
    /// Census that supplies the number of descendants of elements that are skipped, kept or left to other
    /// descents.
    pub(super) census: Option<&'g Census>,
    /// Number of elements of the fractal so far.
    pub(super) index: u128,
    pool: Vec<Successor<F>>,
    free: Vec<usize>,
    evaluator: Evaluator<F>,
    /// Number of visits since the caller last reset it.
    pub(super) visited: u64,
}

/// Numbers of elements visited so far, by level.
///
/// An infertile element counts at its level and at all later ones: the increment of the later levels is
/// propagated when the walk next enters them.
#[derive(Default)]
struct Ranks {
    counts: Vec<u64>,
    pending: Vec<u64>,
}

impl Ranks {
    /// Counts an element at a level, and returns its rank from 1.
    fn count(&mut self, level: usize, kept: bool) -> u64 {
        self.counts[level] += 1;
        if kept && level + 1 < self.pending.len() {
            self.pending[level + 1] += 1;
        }
        self.counts[level]
    }

    /// Enters a level: applies its pending increment and propagates it to the next level.
    fn enter(&mut self, level: usize) {
        let pending = std::mem::take(&mut self.pending[level]);
        self.counts[level] += pending;
        if let Some(below) = self.pending.get_mut(level + 1) {
            *below += pending;
        }
    }
}

impl<'g, F: Frame> Descent<'g, F> {
    pub(super) fn new(graph: &'g Graph<F>, start: &Start<'g, F>, target: u32) -> Self {
        let levels = if graph.counts_index() {
            (target - start.born) as usize + 1
        } else {
            0
        };
        Self {
            graph,
            born: start.born,
            target,
            stack: vec![Entry {
                state: start.state,
                source: Source::Start,
                reversed: start.state.frame.direction().is_reversed(),
                next: 0,
                meets_end: true,
                level: start.born,
            }],
            joined: is_ring(start.instances()),
            ranks: Ranks {
                counts: vec![0; levels],
                pending: vec![0; levels],
            },
            census: None,
            index: 0,
            pool: Vec::new(),
            free: Vec::new(),
            evaluator: Evaluator::default(),
            visited: 0,
        }
    }

    /// Creates a descent over the expansion of an object in a number of steps, alone in the unit frame, as if
    /// a preceding element ended where the object starts.
    pub(super) fn below(
        graph: &'g Graph<F>,
        object: usize,
        steps: u32,
        direction: Direction,
    ) -> Self {
        let mut start = Start::initiator(graph, steps, 0);
        start.state.frame = start.state.frame.with_direction(direction);
        let mut descent = Self::new(graph, &start, steps);
        descent.stack.clear();
        descent.joined = true;
        if let Replacement::Fixed(_) = graph.objects()[object].replacement {
            // Fixed successors need no evaluation, which could fail.
            let _ = descent.push(start.state, object, 0, 0, true);
        }
        descent
    }

    /// Creates a descent over subtrees that other walks have reached; initially it has none.
    pub(super) fn over_subtrees(graph: &'g Graph<F>, target: u32) -> Self {
        let mut descent = Self::new(graph, &Start::initiator(graph, target, 0), target);
        descent.stack.clear();
        descent
    }

    /// Attaches a census of the approximant, so that ranks include elements that are not visited.
    pub(super) fn counting(self, census: Option<&'g Census>) -> Self {
        Self { census, ..self }
    }

    /// Takes over an element from another descent, and returns its rank: the other descent's, if a census
    /// counts the elements that are not visited.
    pub(super) fn come_to(&mut self, found: &FoundElement<F>) -> u128 {
        self.index = match self.census {
            Some(_) => found.index,
            None => self.index + 1,
        };
        self.index
    }

    /// Enters a subtree of a fractal born in step `born`, after the preceding subtree is exhausted. `joined`
    /// is whether the preceding element ends where it starts.
    pub(super) fn enter<'b>(
        &mut self,
        subtree: &FoundSubtree<F>,
        born: u32,
        joined: bool,
        blocks: Option<&'b Blocks<F>>,
    ) -> Result<Option<Run<'b, F>>, CompileError>
    where
        'g: 'b,
    {
        let FoundElement {
            state,
            object,
            level,
            rank,
            ..
        } = subtree.root;
        (self.born, self.joined) = (born, joined);
        if self.census.is_some() {
            self.index = subtree.root.index - 1;
        }
        let meets_end = subtree.meets_end;
        if let Some(run) =
            blocks.and_then(|blocks| self.run(&state, object, level, meets_end, blocks))
        {
            return Ok(Some(run));
        }
        self.push(state, object, level, rank, meets_end)?;
        Ok(None)
    }

    /// Returns the block that replaces an element, if there is one.
    #[inline]
    fn run<'b>(
        &mut self,
        state: &TraversalState<F>,
        object: usize,
        level: u32,
        meets_end: bool,
        blocks: &'b Blocks<F>,
    ) -> Option<Run<'b, F>>
    where
        'g: 'b,
    {
        let block = blocks.get(self.graph, object, self.target - level, &state.frame)?;
        let joined = std::mem::replace(&mut self.joined, block.meets_end && meets_end);
        self.visited += block.len();
        let index = self.index + 1;
        self.index += u128::from(block.len());
        Some(Run {
            block,
            object,
            frame: state.frame,
            length: state.length,
            appearance: state.appearance,
            born: level,
            joined,
            index,
            graph: self.graph,
        })
    }

    /// Returns whether the last element reaches the end of the fractal's chain; valid at the end only.
    pub(super) fn ends_joined(&self) -> bool {
        self.joined
    }

    /// Advances to the next element of approximant `target`, or to where the descent stops; `enter` is called
    /// before an element is replaced.
    #[inline]
    pub(super) fn next<'b>(
        &mut self,
        start: &Start<'g, F>,
        mut enter: impl FnMut(&Subtree<F>) -> Enter,
        stop: Stop<'b, F>,
    ) -> Result<Next<'b, F>, CompileError>
    where
        'g: 'b,
    {
        loop {
            if self.visited >= PATIENCE {
                return Ok(Next::Pause);
            }
            let Some(entry) = self.stack.last_mut() else {
                return Ok(Next::End);
            };
            let instances = match entry.source {
                Source::Start => start.instances(),
                Source::Fixed(chain) => &chain.instances,
                Source::Pooled(number) => &self.pool[number].body.instances,
            };
            let count = instances.len();
            if entry.next == count {
                // An empty chain is the only one still on the stack when it is exhausted.
                self.joined = false;
                self.pop();
                continue;
            }
            let listed = if entry.reversed {
                count - 1 - entry.next
            } else {
                entry.next
            };
            let instance = &instances[listed];
            if entry.next > 0 {
                let link = if entry.reversed { listed + 1 } else { listed };
                self.joined &= instances[link].joined;
            }
            entry.next += 1;
            let is_root = matches!(entry.source, Source::Start)
                && matches!(start.chain, StartChain::Initiator(_));
            let state = if is_root {
                entry.state.root(self.graph, instance)
            } else {
                entry.state.child(self.graph, instance)
            };
            let born = if is_root {
                birth(self.graph, instance)
            } else {
                None
            };
            let level = born.unwrap_or(entry.level);
            let object = instance.object;
            let last = entry.next == count;
            let meets_end = !last || entry.meets_end;
            self.visited += 1;

            let replacement = &self.graph.objects()[object].replacement;
            let kept = matches!(replacement, Replacement::Kept);
            let rank = if self.graph.counts_index() {
                self.ranks.count((level - self.born) as usize, kept)
            } else {
                0
            };
            let subtree = Subtree {
                frame: state.frame,
                object,
                born: level,
            };
            let ends = kept || level == self.target;
            let entered = if ends {
                Enter::Keep
            } else if self.graph.counts_index() {
                Enter::Replace
            } else {
                enter(&subtree)
            };
            let index = self.index + 1;
            if entered == Enter::Keep {
                let joined = self.joined;
                let leaf = &self.graph.objects()[object];
                let is_open = !self.graph.base_elements()[leaf.base_element].is_closed();
                let goes_on = leaf.visible && is_open;
                self.joined = goes_on && meets_end;
                if last {
                    self.pop();
                }
                self.index += match self.census {
                    Some(census) if !ends => census.becomes(&subtree),
                    _ => 1,
                };
                return Ok(Next::Element(FoundElement {
                    state,
                    object,
                    level,
                    joined: joined && goes_on,
                    rank,
                    index,
                }));
            }
            if last {
                // The chain is exhausted: the successor of the child's last element is that of the chain.
                self.pop();
            }
            if entered == Enter::Skip {
                self.joined = false;
                self.index += self.census.map_or(0, |census| census.becomes(&subtree));
                continue;
            }
            match stop {
                Stop::AtBlocks(blocks) if entered == Enter::Replace => {
                    if let Some(run) = self.run(&state, object, level, meets_end, blocks) {
                        return Ok(Next::Run(run));
                    }
                }
                Stop::AtSubtrees(sizes) => {
                    let length = state.frame.stretch();
                    if let Some(size) = sizes.cut(object, self.target - level, length) {
                        let joined = std::mem::replace(&mut self.joined, true);
                        self.index += self.census.map_or(0, |census| census.becomes(&subtree));
                        return Ok(Next::Subtree(FoundSubtree {
                            root: FoundElement {
                                state,
                                object,
                                level,
                                joined,
                                rank,
                                index,
                            },
                            size,
                            meets_end,
                        }));
                    }
                }
                Stop::AtBlocks(_) | Stop::Nowhere => {}
            }
            self.push(state, object, level, rank, meets_end)?;
        }
    }

    fn pop(&mut self) {
        if let Some(Entry {
            source: Source::Pooled(number),
            ..
        }) = self.stack.pop()
        {
            self.free.push(number);
        }
    }

    /// Enters the successor that replaces an element.
    fn push(
        &mut self,
        state: TraversalState<F>,
        object: usize,
        level: u32,
        rank: u64,
        meets_end: bool,
    ) -> Result<(), CompileError> {
        let source = match &self.graph.objects()[object].replacement {
            Replacement::Fixed(successor) => Source::Fixed(&successor.body),
            _ => Source::Pooled(self.evaluate(&state, object, level, rank)?),
        };
        let chain = match source {
            Source::Fixed(chain) => chain,
            Source::Pooled(number) => &self.pool[number].body,
            Source::Start => unreachable!("a start is never pushed"),
        };
        let reversed = state.frame.direction().is_reversed();
        let [mut first, mut end] = chain.meets_frame;
        if reversed {
            (first, end) = (end, first);
        }
        self.joined &= first;
        if self.graph.counts_index() {
            self.ranks.enter((level + 1 - self.born) as usize);
        }
        self.stack.push(Entry {
            state,
            source,
            reversed,
            next: 0,
            meets_end: end && meets_end,
            level: level + 1,
        });
        Ok(())
    }

    /// Computes the successor of an element into the pool, and returns its number there.
    fn evaluate(
        &mut self,
        state: &TraversalState<F>,
        object: usize,
        level: u32,
        rank: u64,
    ) -> Result<usize, CompileError> {
        let number = self.free.pop().unwrap_or_else(|| {
            self.pool.push(Successor::default());
            self.pool.len() - 1
        });
        let moment = ReplacementContext {
            born: self.born,
            level,
            rank,
        };
        let successor = &mut self.pool[number];
        self.evaluator
            .evaluate(self.graph, state, object, moment, successor)?;
        Ok(number)
    }

    /// Returns the fractals that an element of approximant `target` seeds when it is replaced.
    pub(super) fn seeds(
        &mut self,
        found: &FoundElement<F>,
    ) -> Result<Vec<Start<'g, F>>, CompileError> {
        let state = found.state;
        let graph = self.graph;
        let start = |seed: &Seed<F>, chain| Start {
            chain,
            state: seed_placement(graph, &state, seed.placement),
            born: found.level + 1,
            seeded: 0..0,
        };
        match &graph.objects()[found.object].replacement {
            Replacement::Kept => Ok(Vec::new()),
            Replacement::Fixed(successor) => Ok(successor
                .seeds
                .iter()
                .enumerate()
                .map(|(number, seed)| {
                    let chain = &seed.chain;
                    let seed_of = [found.object, number];
                    start(
                        seed,
                        StartChain::Fixed {
                            chain,
                            seed: seed_of,
                        },
                    )
                })
                .collect()),
            _ => {
                let number = self.evaluate(&state, found.object, found.level, found.rank)?;
                let starts = self.pool[number]
                    .seeds
                    .iter()
                    .map(|seed| start(seed, StartChain::Evaluated(seed.chain.clone())))
                    .collect();
                self.free.push(number);
                Ok(starts)
            }
        }
    }
}
