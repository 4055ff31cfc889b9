//! Walks on several threads.
//!
//! One thread descends to elements with few descendants, and submits their subtrees to the other threads,
//! grouped into spans. A visitor of a span receives the same elements as in a sequential walk, to the last
//! bit, except for two properties that depend on all preceding spans: the rank of the first element, unless
//! the graph determines it, and whether the preceding element ends where the first one starts. Spans are
//! taken in order, with both.

use std::num::NonZero;
use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::geometry::{Frame, Frame2};
use crate::graph::Graph;
use crate::parallel::{Pipeline, Team, with_team};

use super::block::{Blocks, KeptBlocks, MAX_LEAVES};
use super::census::Census;
use super::colony::{Colony, Taken};
use super::descent::Descent;
use super::found::{FoundElement, Next, Stop};
use super::sizes::Sizes;
use super::span::{Position, Span, SpanItem};
use super::start::Start;
use super::tally::Tally;
use super::walk::{Sink, Visiting, send};
use super::whole::Whole;
use super::{Enter, FractalInfo, Growth, Subtree, Visitor, WalkError, Walked, walk};

/// Number of visits after which a span without elements is submitted, so that the walk can be stopped.
const LONG: u64 = 1 << 16;

/// Properties of a span that depend on the preceding spans.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Seam {
    /// Number to be added to the ranks of the elements up to the beginning of the next fractal.
    pub before: u128,
    /// Whether the first element of the span, if its visitor received it as joined, does join the preceding
    /// element. True if the span begins with a fractal.
    pub joined: bool,
}

impl Seam {
    /// Seam that changes nothing.
    pub(super) const NONE: Self = Self {
        before: 0,
        joined: true,
    };
}

/// Walks over the elements of an approximant as [`walk`] does, on several threads.
///
/// Every span of the walk has its own visitor, created by `fresh` or reused. `take` receives the visitors in
/// order, each with its seam, and resets them for reuse. The sequence of elements does not depend on the
/// number of threads. Spans have about `span` elements, or more if elements come in runs; their limits are
/// unspecified and may lie within a fractal.
///
/// If visitors have a [length of replacement](Visitor::cuts), all of them must decide equally about entering
/// an element, unless the element's subtree no longer matters. One additional visitor decides about the
/// elements above the spans; it is taken last.
///
/// A single visitor receives all elements, and is taken repeatedly, if the walk counts indices or if `span`
/// is `None`.
///
/// # Errors
///
/// Returns an error under the conditions of [`walk`], or if `take` returns one.
///
/// # Panics
///
/// Panics if the graph was compiled for fewer steps, or if a visitor panics.
pub fn walk_in_spans<F: Frame, V: Visitor<F> + Send>(
    graph: &Graph<F>,
    growth: &Growth<'_>,
    threads: NonZero<usize>,
    span: Option<u64>,
    fresh: impl FnMut() -> V,
    take: impl FnMut(&mut V, Seam) -> Result<(), V::Error>,
) -> Result<Walked, WalkError<V::Error>>
where
    V::Error: Send,
{
    with_team(threads, |team| {
        let division = Division {
            span,
            ranks: Ranks::Unknown,
            blocks: None,
        };
        walk_with(team, graph, growth, division, fresh, take)
    })
}

/// Division of a walk into spans.
#[derive(Clone, Copy)]
pub(crate) struct Division<'r, F: Frame = Frame2> {
    /// Approximate number of elements of a span; `None` for a single visitor of the whole walk.
    pub(crate) span: Option<u64>,
    /// Source of the ranks that visitors receive.
    pub(crate) ranks: Ranks<'r>,
    /// Blocks of the graph that other walks share.
    pub(crate) blocks: Option<&'r KeptBlocks<F>>,
}

/// Source of ranks.
#[derive(Clone, Copy)]
pub(crate) enum Ranks<'r> {
    /// Visited elements are counted.
    Unknown,
    /// [`Seam::before`] of all spans, from an earlier walk with an equal division.
    BySpan(&'r [u128]),
    /// A census, whose counts include elements that are not visited.
    Counted(&'r Census),
}

/// Walks as [`walk_in_spans`] does, with a team that may have other work.
pub(crate) fn walk_with<'w, F: Frame, V: Visitor<F> + Send + 'w>(
    team: &Team<'w>,
    graph: &'w Graph<F>,
    growth: &Growth<'_>,
    division: Division<'w, F>,
    mut fresh: impl FnMut() -> V,
    take: impl FnMut(&mut V, Seam) -> Result<(), V::Error>,
) -> Result<Walked, WalkError<V::Error>>
where
    V::Error: Send + 'w,
{
    let Some(size) = division.span.filter(|_| !graph.counts_index()) else {
        let mut whole = Whole {
            visitor: fresh(),
            take,
            since: 0,
        };
        let walked = walk(graph, growth, &mut whole)?;
        whole.hand_over().map_err(WalkError::Visitor)?;
        return Ok(walked);
    };
    let asked = fresh();
    let (takes_runs, cuts) = (asked.takes_runs(), asked.cuts());
    // Spans at least as long as blocks keep the blocks of a walk that is not divided.
    let size = if takes_runs {
        size.max(MAX_LEAVES.min(asked.longest_run()))
    } else {
        size
    };
    let sizes = Sizes::most(graph, size).down_to(graph, cuts.unwrap_or(0.0), size);
    let census = match division.ranks {
        Ranks::Counted(census) => Some(census),
        Ranks::Unknown | Ranks::BySpan(_) => None,
    };
    let mut spans = Spans {
        graph,
        steps: growth.steps,
        size,
        blocks: takes_runs.then(|| match division.blocks {
            Some(kept) => kept.of(graph, asked.longest_run(), cuts),
            None => Arc::new(Blocks::of(graph, asked.longest_run(), cuts)),
        }),
        asked,
        span: Span::default(),
        ranks: match division.ranks {
            Ranks::BySpan(ranks) => ranks,
            Ranks::Unknown | Ranks::Counted(_) => &[],
        },
        census,
        is_open: false,
        line: team.line(Job::run),
        order: Order {
            tally: Tally::new(growth),
            is_counted: census.is_some(),
            index: 0,
            joined: true,
            take,
        },
        fresh,
        has_failed: false,
    };
    let firsts = (Start::all(graph, growth.steps, growth.seed), true);
    let stop = Stop::AtSubtrees(&sizes);
    let sent = send(graph, growth.steps, firsts, stop, census, &mut spans);
    if !spans.has_failed {
        // Spans submitted before a failure may have failed earlier in the order of the walk.
        spans.finish()?;
    }
    sent?;
    if cuts.is_some() {
        let order = &mut spans.order;
        (order.take)(&mut spans.asked, Seam::NONE).map_err(WalkError::Visitor)?;
    }
    Ok(spans.order.tally.finish())
}

/// Span with its visitor.
struct Job<'w, F: Frame, V: Visitor<F>> {
    graph: &'w Graph<F>,
    blocks: Option<Arc<Blocks<F>>>,
    descent: Descent<'w, F>,
    span: Span<'w, F>,
    visitor: V,
    outcome: Result<Outcome, WalkError<V::Error>>,
}

/// Result of visiting a span.
#[derive(Clone, Copy, Default)]
struct Outcome {
    elements: u64,
    fractals: u64,
    visited: u64,
    /// Rank of the last element in its fractal, as received by the visitor.
    index: u128,
    /// Whether the last element ends where the next one starts, if known.
    joined: Option<bool>,
}

impl<F: Frame, V: Visitor<F>> Job<'_, F, V> {
    fn run(&mut self) {
        self.outcome = self.walk();
    }

    fn walk(&mut self) -> Result<Outcome, WalkError<V::Error>> {
        let start = Start::initiator(self.graph, 0, 0);
        let blocks = self.blocks.as_deref();
        let stop = blocks.map_or(Stop::Nowhere, Stop::AtBlocks);
        let mut outcome = Outcome::default();
        let from = self.span.from;
        let (mut born, mut joined) = (from.born, true);
        if self.span.goes_on() {
            self.visitor.go_on(from.fractal);
        }
        let mut visiting = Visiting::new(self.graph, &mut self.visitor);
        self.descent.index = from.before;
        for item in &self.span.items {
            match item {
                SpanItem::Begin(fractal, step) => {
                    outcome.fractals += 1;
                    born = *step;
                    self.descent.index = 0;
                    visiting.begin(*fractal)?;
                }
                SpanItem::Element(found) => {
                    let joined = joined && found.joined;
                    let index = self.descent.come_to(found);
                    visiting.element(&FoundElement {
                        joined,
                        index,
                        ..*found
                    })?;
                }
                SpanItem::Subtree(subtree) => {
                    let joined = joined && subtree.root.joined;
                    let mut is_run = || {
                        let root = subtree.root.subtree();
                        visiting.visitor.enter(&root) == Enter::Replace
                    };
                    let whole = blocks.filter(|_| is_run());
                    let run = self.descent.enter(subtree, born, joined, whole)?;
                    run.iter().try_for_each(|run| visiting.run(run))?;
                    loop {
                        let enter = |subtree: &Subtree<F>| visiting.visitor.enter(subtree);
                        match self.descent.next(&start, enter, stop)? {
                            Next::Element(found) => visiting.element(&found)?,
                            Next::Run(found) => visiting.run(&found)?,
                            Next::Subtree(_) => unreachable!("a subtree is walked to its end"),
                            Next::Pause => {}
                            Next::End => break,
                        }
                        outcome.visited += std::mem::take(&mut self.descent.visited);
                    }
                }
                SpanItem::Colony(colony, taken) => {
                    outcome.fractals += taken.walked().fractals;
                    visiting.colony(colony, *taken)?;
                }
                SpanItem::End(meets_end) => visiting.end(joined && *meets_end)?,
            }
            joined = match item {
                SpanItem::Subtree(_) => self.descent.ends_joined(),
                // The next item has its own flag.
                _ => true,
            };
            outcome.joined = Some(joined);
        }
        outcome.visited += std::mem::take(&mut self.descent.visited);
        outcome.elements = visiting.seen;
        outcome.index = self.descent.index;
        Ok(outcome)
    }
}

/// Consumer of finished spans, in order.
struct Order<'v, T> {
    tally: Tally<'v>,
    /// Whether visitors receive final ranks.
    is_counted: bool,
    /// Number of elements of the fractal so far; unused if ranks are final.
    index: u128,
    joined: bool,
    take: T,
}

impl<T> Order<'_, T> {
    fn take<F: Frame, V: Visitor<F>>(
        &mut self,
        job: &mut Job<'_, F, V>,
    ) -> Result<(), WalkError<V::Error>>
    where
        T: FnMut(&mut V, Seam) -> Result<(), V::Error>,
    {
        let span = &job.span;
        self.tally.visit(span.visited)?;
        let outcome = std::mem::replace(&mut job.outcome, Ok(Outcome::default()))?;
        self.tally.visit(outcome.visited)?;
        self.tally.count(outcome.elements)?;
        self.tally.begin(outcome.fractals);
        let mut seam = Seam::NONE;
        if span.goes_on() {
            if !self.is_counted {
                // Ranks are undefined if fewer elements are visited than in the earlier walk.
                seam.before = self.index.wrapping_sub(span.from.before);
            }
            seam.joined = self.joined;
        }
        self.index = outcome.index;
        if outcome.fractals == 0 {
            self.index = self.index.wrapping_add(seam.before);
        }
        self.joined = outcome.joined.unwrap_or(self.joined);
        (self.take)(&mut job.visitor, seam).map_err(WalkError::Visitor)
    }
}

/// Sink that collects a walk into spans and submits them.
struct Spans<'t, 'w, 'v, F: Frame, V: Visitor<F>, N, T> {
    graph: &'w Graph<F>,
    steps: u32,
    /// Approximate number of elements of a span.
    size: u64,
    blocks: Option<Arc<Blocks<F>>>,
    /// Visitor that decides about elements above the subtrees.
    asked: V,
    span: Span<'w, F>,
    /// [`Seam::before`] of the remaining spans, if known from an earlier walk.
    ranks: &'w [u128],
    /// Census for ranks that include elements that are not visited.
    census: Option<&'w Census>,
    /// Whether a fractal has begun and not ended.
    is_open: bool,
    line: Pipeline<'t, 'w, Job<'w, F, V>>,
    order: Order<'v, T>,
    fresh: N,
    /// Whether `take` or the work of a span has failed.
    has_failed: bool,
}

impl<'w, F, V, N, T> Spans<'_, 'w, '_, F, V, N, T>
where
    F: Frame,
    V: Visitor<F> + Send + 'w,
    V::Error: Send + 'w,
    N: FnMut() -> V,
    T: FnMut(&mut V, Seam) -> Result<(), V::Error>,
{
    fn hand_on(&mut self) -> Result<(), WalkError<V::Error>> {
        let mut job = self.line.spare().unwrap_or_else(|| Job {
            graph: self.graph,
            blocks: self.blocks.clone(),
            descent: Descent::over_subtrees(self.graph, self.steps).counting(self.census),
            span: Span::default(),
            visitor: (self.fresh)(),
            outcome: Ok(Outcome::default()),
        });
        std::mem::swap(&mut job.span, &mut self.span);
        self.span.follow(&job.span);
        if let Some((&before, later)) = self.ranks.split_first() {
            job.span.from.before = before;
            self.ranks = later;
        }
        let order = &mut self.order;
        let handed = self.line.hand_on(job, &mut |job| order.take(job));
        self.has_failed = handed.is_err();
        handed
    }

    /// Submits the span if it is full.
    fn make_room(&mut self) -> Result<(), WalkError<V::Error>> {
        if self.span.size < self.size {
            return Ok(());
        }
        self.hand_on()
    }

    fn finish(&mut self) -> Result<(), WalkError<V::Error>> {
        self.hand_on()?;
        let order = &mut self.order;
        self.line.finish(&mut |job| order.take(job))
    }
}

impl<'w, F, V, N, T> Sink<'w, F> for Spans<'_, 'w, '_, F, V, N, T>
where
    F: Frame,
    V: Visitor<F> + Send + 'w,
    V::Error: Send + 'w,
    N: FnMut() -> V,
    T: FnMut(&mut V, Seam) -> Result<(), V::Error>,
{
    type Error = WalkError<V::Error>;

    fn enter(&mut self, subtree: &Subtree<F>) -> Enter {
        self.asked.enter(subtree)
    }

    fn ages(&self) -> RangeInclusive<u32> {
        self.asked.ages()
    }

    fn begin(&mut self, fractal: FractalInfo, born: u32) -> Result<(), Self::Error> {
        self.make_room()?;
        self.is_open = true;
        self.span.to = Position {
            fractal,
            born,
            before: 0,
        };
        self.span.push(SpanItem::Begin(fractal, born), 1);
        Ok(())
    }

    fn found(&mut self, next: Next<'_, F>) -> Result<(), Self::Error> {
        self.make_room()?;
        let (item, size, rank) = match next {
            Next::Element(found) => (SpanItem::Element(found), 1, found.index),
            Next::Subtree(subtree) => {
                let (size, rank) = (1 + subtree.size, subtree.root.index);
                (SpanItem::Subtree(subtree), size, rank)
            }
            Next::Run(_) | Next::Pause | Next::End => unreachable!("blocks are left to spans"),
        };
        if self.census.is_some() && self.span.items.is_empty() {
            self.span.from.before = rank - 1;
        }
        self.span.push(item, size);
        Ok(())
    }

    /// Ends the fractal in the span of its last item.
    fn end(&mut self, joined: bool) -> Result<(), Self::Error> {
        self.is_open = false;
        self.span.push(SpanItem::End(joined), 0);
        Ok(())
    }

    fn takes(&self, colony: &Colony<'_, F>) -> Taken {
        self.asked.takes(colony)
    }

    fn colony(&mut self, colony: Colony<'w, F>, taken: Taken) -> Result<(), Self::Error> {
        self.make_room()?;
        self.span.push(SpanItem::Colony(colony, taken), 1);
        Ok(())
    }

    fn visit(&mut self, count: u64) -> Result<(), Self::Error> {
        self.span.visited += count;
        if self.span.visited >= LONG && !self.is_open {
            return self.hand_on();
        }
        Ok(())
    }
}
