//! One fractal at one step: its elements in order of traversal, depth-first.

use crate::geometry::{Direction, Frame};
use crate::graph::{Chain, CompileError, Graph, Production, Replacement, Seed};
use crate::instancing::Coat;

use super::block::{Block, Blocks};
use super::census::Census;
use super::evaluator::{Evaluator, Moment};
use super::sizes::Sizes;
use super::start::{Standing, Start, StartChain, birth, planted};
use super::{Enter, Subtree};

/// An element that a descent has found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) standing: Standing,
    pub(super) object: usize,
    /// The step of its birth.
    pub(super) level: u32,
    pub(super) joined: bool,
    /// Its rank at its level, where ranks are counted; else 0.
    pub(super) rank: u64,
    /// Its rank in its fractal, from 1; of an element that is replaced, that of the first one that comes
    /// of it.
    pub(super) index: u128,
}

/// A block that a descent has come to instead of its elements.
pub(super) struct FoundRun<'b> {
    pub(super) block: &'b Block,
    pub(super) object: usize,
    pub(super) frame: Frame,
    pub(super) length: f64,
    pub(super) coat: Coat,
    /// The step of birth of the object that became the block.
    pub(super) level: u32,
    /// Whether the pen stands where the object starts.
    pub(super) joined: bool,
    /// The rank of the first element.
    pub(super) index: u128,
}

/// An element that a descent has come to and leaves to another one.
#[derive(Clone, Copy, Debug)]
pub(super) struct FoundSubtree {
    /// The element; it is joined if the pen stands where it starts.
    pub(super) root: Found,
    /// How many elements may come of it at most.
    pub(super) size: u64,
    /// Whether what ends it ends what ends with it.
    pub(super) meets_end: bool,
    /// The rank of the last element that comes of it, where that is known.
    pub(super) last: u128,
}

/// What a descent comes to.
pub(super) enum Next<'b> {
    /// An element of the approximant.
    Element(Found),
    /// Elements in a row, where it stops at blocks.
    Run(FoundRun<'b>),
    /// An element that is replaced, where it stops at those. Whatever follows is taken to be joined
    /// to it.
    Subtree(FoundSubtree),
    /// Elements that have been replaced, many of them: a chance to stop.
    Pause,
    /// The end of the fractal.
    End,
}

/// Where a descent stops short of the elements.
#[derive(Clone, Copy)]
pub(super) enum Stop<'b> {
    Nowhere,
    /// Where a block stands for them.
    AtBlocks(&'b Blocks),
    /// Where they are few.
    AtSubtrees(&'b Sizes),
}

/// Visits between two chances to stop.
pub(super) const PATIENCE: u64 = 1 << 12;

/// The chain that a level of the stack goes through.
#[derive(Clone, Copy)]
enum Source<'g> {
    Start,
    Fixed(&'g Chain),
    /// In the pool of evaluated productions.
    Pooled(usize),
}

struct Entry<'g> {
    standing: Standing,
    source: Source<'g>,
    reversed: bool,
    /// How many instances have been visited.
    next: usize,
    /// Whether what ends this chain ends all the elements that were replaced on the way to it.
    meets_end: bool,
    /// The step of birth of the chain's elements.
    level: u32,
}

/// A depth-first walk over one fractal of approximant `target`.
pub(super) struct Descent<'g> {
    graph: &'g Graph,
    born: u32,
    target: u32,
    stack: Vec<Entry<'g>>,
    /// Whether the pen stands at the end of the element before, free to go on.
    joined: bool,
    ranks: Ranks,
    /// What tells how many elements come of those that are left out or left to others, if it is to.
    pub(super) census: Option<&'g Census>,
    /// The number of elements of the fractal so far.
    pub(super) index: u128,
    pool: Vec<Production>,
    free: Vec<usize>,
    evaluator: Evaluator,
    /// The number of visits since the caller has last taken it.
    pub(super) visited: u64,
}

/// The numbers of elements of every level that have been visited so far.
///
/// An infertile element counts at its level and at all later ones: what it adds there is passed
/// down when the walk next goes there.
#[derive(Default)]
struct Ranks {
    counts: Vec<u64>,
    pending: Vec<u64>,
}

impl Ranks {
    /// Counts an element at a level, and tells its rank from 1.
    fn count(&mut self, level: usize, kept: bool) -> u64 {
        self.counts[level] += 1;
        if kept && level + 1 < self.pending.len() {
            self.pending[level + 1] += 1;
        }
        self.counts[level]
    }

    /// The walk goes down to a level.
    fn enter(&mut self, level: usize) {
        let pending = std::mem::take(&mut self.pending[level]);
        self.counts[level] += pending;
        if let Some(below) = self.pending.get_mut(level + 1) {
            *below += pending;
        }
    }
}

impl<'g> Descent<'g> {
    pub(super) fn new(graph: &'g Graph, start: &Start<'g>, target: u32) -> Self {
        let chain = start.chain();
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
                standing: start.standing,
                source: Source::Start,
                reversed: start.standing.frame.direction.is_reversed(),
                next: 0,
                meets_end: true,
                level: start.born,
            }],
            joined: chain.is_ring(),
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

    /// A walk over what an object becomes in a number of steps, alone in the unit frame. The pen
    /// stands where the object starts.
    pub(super) fn below(graph: &'g Graph, object: usize, steps: u32, direction: Direction) -> Self {
        let mut start = Start::initiator(graph, steps, 0);
        start.standing.frame.direction = direction;
        let mut descent = Self::new(graph, &start, steps);
        descent.stack.clear();
        descent.joined = true;
        if let Replacement::Fixed(_) = graph.objects()[object].replacement {
            // Fixed productions are there without being worked out.
            let _ = descent.push(start.standing, object, 0, 0, true);
        }
        descent
    }

    /// A walk over what comes of other walks' subtrees, one after another, with nothing to begin
    /// with.
    pub(super) fn over_subtrees(graph: &'g Graph, target: u32) -> Self {
        let mut descent = Self::new(graph, &Start::initiator(graph, target, 0), target);
        descent.stack.clear();
        descent
    }

    /// The same with a census of the approximant, so that ranks count what is not visited.
    pub(super) fn counting(self, census: Option<&'g Census>) -> Self {
        Self { census, ..self }
    }

    /// Comes to an element that another walk has found, and tells its rank: as the other walk has it
    /// where that counts what is not visited.
    pub(super) fn come_to(&mut self, found: &Found) -> u128 {
        self.index = match self.census {
            Some(_) => found.index,
            None => self.index + 1,
        };
        self.index
    }

    /// Goes down into a subtree of a fractal that was born in a step, once the one before is done.
    /// `joined` tells whether the pen stands where it starts.
    pub(super) fn enter<'b>(
        &mut self,
        subtree: &FoundSubtree,
        born: u32,
        joined: bool,
        blocks: Option<&'b Blocks>,
    ) -> Result<Option<FoundRun<'b>>, CompileError> {
        let Found {
            standing,
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
            blocks.and_then(|blocks| self.run(&standing, object, level, meets_end, blocks))
        {
            return Ok(Some(run));
        }
        self.push(standing, object, level, rank, meets_end)?;
        Ok(None)
    }

    /// The block that stands for what comes of an element, if there is one.
    #[inline]
    fn run<'b>(
        &mut self,
        standing: &Standing,
        object: usize,
        level: u32,
        meets_end: bool,
        blocks: &'b Blocks,
    ) -> Option<FoundRun<'b>> {
        let block = blocks.get(self.graph, object, self.target - level, &standing.frame)?;
        let joined = std::mem::replace(&mut self.joined, block.meets_end && meets_end);
        self.visited += block.len();
        let index = self.index + 1;
        self.index += u128::from(block.len());
        Some(FoundRun {
            block,
            object,
            frame: standing.frame,
            length: standing.length,
            coat: standing.coat,
            level,
            joined,
            index,
        })
    }

    /// Whether the last element joins the first one of a ring; to be asked at the end.
    pub(super) fn ends_joined(&self) -> bool {
        self.joined
    }

    /// Goes on to the next element of approximant `target`, or to where it stops; `enter` is asked
    /// before an element is replaced.
    #[inline]
    pub(super) fn next<'b>(
        &mut self,
        start: &Start<'g>,
        mut enter: impl FnMut(&Subtree) -> Enter,
        stop: Stop<'b>,
    ) -> Result<Next<'b>, CompileError> {
        loop {
            if self.visited >= PATIENCE {
                return Ok(Next::Pause);
            }
            let Some(entry) = self.stack.last_mut() else {
                return Ok(Next::End);
            };
            let chain = match entry.source {
                Source::Start => start.chain(),
                Source::Fixed(chain) => chain,
                Source::Pooled(number) => &self.pool[number].body,
            };
            let count = chain.instances.len();
            if entry.next == count {
                // Only an empty chain is still on the stack when it is done.
                self.joined = false;
                self.pop();
                continue;
            }
            let listed = if entry.reversed {
                count - 1 - entry.next
            } else {
                entry.next
            };
            let instance = &chain.instances[listed];
            if entry.next > 0 {
                let link = if entry.reversed { listed + 1 } else { listed };
                self.joined &= chain.instances[link].joined;
            }
            entry.next += 1;
            let is_root = matches!(entry.source, Source::Start)
                && matches!(start.chain, StartChain::Initiator(_));
            let standing = if is_root {
                entry.standing.root(self.graph, instance)
            } else {
                entry.standing.child(self.graph, instance)
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
                frame: standing.frame,
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
                return Ok(Next::Element(Found {
                    standing,
                    object,
                    level,
                    joined: joined && goes_on,
                    rank,
                    index,
                }));
            }
            if last {
                // The chain is done: what follows the child's last element follows the chain's.
                self.pop();
            }
            if entered == Enter::Skip {
                self.joined = false;
                self.index += self.census.map_or(0, |census| census.becomes(&subtree));
                continue;
            }
            match stop {
                Stop::AtBlocks(blocks) => {
                    if let Some(run) = self.run(&standing, object, level, meets_end, blocks) {
                        return Ok(Next::Run(run));
                    }
                }
                Stop::AtSubtrees(sizes) => {
                    let length = standing.frame.stretch();
                    if let Some(size) = sizes.cut(object, self.target - level, length) {
                        let joined = std::mem::replace(&mut self.joined, true);
                        self.index += self.census.map_or(0, |census| census.becomes(&subtree));
                        return Ok(Next::Subtree(FoundSubtree {
                            root: Found {
                                standing,
                                object,
                                level,
                                joined,
                                rank,
                                index,
                            },
                            size,
                            meets_end,
                            last: self.index,
                        }));
                    }
                }
                Stop::Nowhere => {}
            }
            self.push(standing, object, level, rank, meets_end)?;
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

    /// Goes down into what replaces an element.
    fn push(
        &mut self,
        standing: Standing,
        object: usize,
        level: u32,
        rank: u64,
        meets_end: bool,
    ) -> Result<(), CompileError> {
        let source = match &self.graph.objects()[object].replacement {
            Replacement::Fixed(production) => Source::Fixed(&production.body),
            _ => Source::Pooled(self.evaluate(&standing, object, level, rank)?),
        };
        let chain = match source {
            Source::Fixed(chain) => chain,
            Source::Pooled(number) => &self.pool[number].body,
            Source::Start => unreachable!("a start is never pushed"),
        };
        let reversed = standing.frame.direction.is_reversed();
        let [mut first, mut end] = chain.meets_frame;
        if reversed {
            (first, end) = (end, first);
        }
        self.joined &= first;
        if self.graph.counts_index() {
            self.ranks.enter((level + 1 - self.born) as usize);
        }
        self.stack.push(Entry {
            standing,
            source,
            reversed,
            next: 0,
            meets_end: end && meets_end,
            level: level + 1,
        });
        Ok(())
    }

    /// Works out the production of an object where it stands, into the pool.
    fn evaluate(
        &mut self,
        standing: &Standing,
        object: usize,
        level: u32,
        rank: u64,
    ) -> Result<usize, CompileError> {
        let number = self.free.pop().unwrap_or_else(|| {
            self.pool.push(Production::default());
            self.pool.len() - 1
        });
        let moment = Moment {
            born: self.born,
            level,
            rank,
        };
        let production = &mut self.pool[number];
        self.evaluator
            .evaluate(self.graph, standing, object, moment, production)?;
        Ok(number)
    }

    /// The fractals that an element of approximant `target` seeds when it is replaced.
    pub(super) fn seeds(&mut self, found: &Found) -> Result<Vec<Start<'g>>, CompileError> {
        let standing = found.standing;
        let graph = self.graph;
        let start = |seed: &Seed, chain| Start {
            chain,
            standing: planted(graph, &standing, seed.placement),
            born: found.level + 1,
            sown: 0..0,
        };
        match &graph.objects()[found.object].replacement {
            Replacement::Kept => Ok(Vec::new()),
            Replacement::Fixed(production) => Ok(production
                .seeds
                .iter()
                .map(|seed| start(seed, StartChain::Fixed(&seed.chain)))
                .collect()),
            _ => {
                let number = self.evaluate(&standing, found.object, found.level, found.rank)?;
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
