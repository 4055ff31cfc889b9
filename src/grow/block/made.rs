//! Blocks of a graph, computed on first use.

use std::cell::Cell;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::geometry::{Frame, Frame2, Outline};
use crate::graph::{CompileError, Graph};

use super::cut::Cuts;
use super::{Block, Leaf, LineElement, births, unit};
use crate::grow::descent::Descent;
use crate::grow::found::{Next, Stop};
use crate::grow::sizes::Sizes;
use crate::grow::start::Start;
use crate::grow::{Enter, Subtree};

/// Maximum number of elements of a block, so that it stays in the first-level cache.
pub(in crate::grow) const MAX_LEAVES: u64 = 1024;

/// Maximum number of elements of all blocks of a graph.
const MAX_MEMORY: u64 = 1 << 17;

/// Number of the next block.
static NEXT: AtomicU64 = AtomicU64::new(0);

/// Blocks of a graph, computed by whichever thread first uses them.
///
/// The set of possible blocks is determined beforehand: the output of a walk, to the last bit, does not
/// depend on the order in which they are computed.
pub(in crate::grow) struct Blocks<F: Frame = Frame2> {
    known: Known,
    /// Whether all maps are similarities and no object changes its appearance. Otherwise blocks hold no lines,
    /// because shear and appearance change stroke widths.
    are_plain: bool,
    /// Blocks by object, direction, and number of steps or range of lengths.
    made: Vec<[Slots<F>; 2]>,
}

/// Blocks of an object in one direction, by number of steps or range of lengths.
type Slots<F> = Vec<OnceLock<Option<Block<F>>>>;

/// Sizes of all possible blocks.
enum Known {
    /// By number of steps: numbers of elements.
    BySteps(Sizes),
    /// By length: ranges of lengths, and the length below which elements are not replaced.
    ByLength(Vec<Cuts>, f64),
}

impl<F: Frame> Blocks<F> {
    /// Determines the possible blocks of at most `longest` elements. If `shortest` is given, elements below
    /// this length are not replaced.
    pub(in crate::grow) fn of(graph: &Graph<F>, longest: u64, shortest: Option<f64>) -> Self {
        let known = |most: u64| match shortest.filter(|&shortest| shortest > 0.0) {
            None => Known::BySteps(Sizes::fixed(graph, most)),
            Some(shortest) => Known::ByLength(Cuts::of(graph, most), shortest),
        };
        let mut most = if graph.counts_index() {
            0
        } else {
            MAX_LEAVES.min(longest)
        };
        let mut all = known(most);
        // A block is computed for either direction.
        while most > 0 && 2 * all.sum() > MAX_MEMORY {
            most /= 2;
            all = known(most);
        }
        let none = |slots: usize| std::iter::repeat_with(OnceLock::new).take(slots).collect();
        let both = |slots: usize| [none(slots), none(slots)];
        Self {
            made: all.slots().into_iter().map(both).collect(),
            known: all,
            are_plain: graph.is_similar() && !graph.has_appearances(),
        }
    }

    /// Returns the expansion of an element over at most `steps` steps, if it is one of the blocks.
    #[inline]
    pub(in crate::grow) fn get(
        &self,
        graph: &Graph<F>,
        object: usize,
        steps: u32,
        frame: &F,
    ) -> Option<&Block<F>> {
        let reversed = frame.direction().is_reversed();
        let (slot, steps, length) = match &self.known {
            Known::BySteps(sizes) => {
                sizes.get(object, steps)?;
                (sizes.slot(steps), steps, f64::INFINITY)
            }
            Known::ByLength(cuts, shortest) => {
                let cuts = cuts.get(object)?;
                let number = cuts.number(frame.stretch() / shortest)?;
                let cut = &cuts.all[number];
                // With fewer steps left, the expansion ends before all elements are short.
                if cut.steps > steps {
                    return None;
                }
                (number, cut.steps, cut.length)
            }
        };
        let slot = &self.made[object][usize::from(reversed)][slot];
        // Points that are not finite are reported by the walk itself.
        slot.get_or_init(|| self.made(graph, object, steps, length, reversed).ok())
            .as_ref()
    }

    /// Computes the expansion of an object of a length over a number of steps, where elements shorter than 1
    /// are not replaced.
    fn made(
        &self,
        graph: &Graph<F>,
        object: usize,
        steps: u32,
        length: f64,
        reversed: bool,
    ) -> Result<Block<F>, CompileError> {
        // The object itself is replaced in the first step.
        let settled = Cell::new(1);
        let enter = |subtree: &Subtree<F>| {
            if subtree.frame.stretch() * length < 1.0 {
                Enter::Keep
            } else {
                settled.set(settled.get().max(subtree.born + 1));
                Enter::Replace
            }
        };
        let start = Start::initiator(graph, steps, 0);
        let unit = unit(reversed);
        let mut descent = Descent::below(graph, object, steps, unit);
        let mut leaves = Vec::new();
        let mut sticks = Some(Vec::new());
        let mut corners = Some(F::Corners::default());
        let mut fertile = 0;
        let mut all = 0.0;
        loop {
            let found = match descent.next(&start, enter, Stop::Nowhere)? {
                Next::Element(found) => found,
                Next::Pause => {
                    descent.visited = 0;
                    continue;
                }
                Next::Run(_) | Next::Subtree(_) => unreachable!("blocks are not made of blocks"),
                Next::End => break,
            };
            let frame = found.state.frame;
            let drawn = graph.drawn(found.object);
            if drawn.is_some_and(Outline::is_line) && self.are_plain {
                sticks.iter_mut().for_each(|sticks| {
                    sticks.push(LineElement {
                        ends: frame.ends(),
                        octave: libm::log2(frame.length()),
                        joined: found.joined,
                    });
                });
            } else {
                sticks = None;
            }
            if let Some(outline) = drawn {
                corners = corners
                    .and_then(|mut all| outline.add_corners(&mut all, &frame).then_some(all));
            }
            fertile += u64::from(graph.is_fertile(found.object));
            all += frame.length();
            leaves.push(Leaf {
                frame: frame.with_direction(unit * frame.direction()),
                length: found.state.length,
                appearance: found.state.appearance,
                object: found.object,
                born: found.level,
                joined: found.joined,
            });
        }
        let sticks = sticks.filter(|sticks| !sticks.is_empty());
        let line = sticks.as_ref().filter(|sticks| {
            let mut later = sticks[1..].iter();
            later.all(|stick| stick.joined)
        });
        let mut objects: Vec<usize> = leaves.iter().map(|leaf| leaf.object).collect();
        objects.sort_unstable();
        objects.dedup();
        let births = births(&leaves);
        let mut by_birth: Vec<u32> = (0..).take(leaves.len()).collect();
        by_birth.sort_by_key(|&number| leaves[number as usize].born);
        Ok(Block {
            number: NEXT.fetch_add(1, Ordering::Relaxed),
            by_birth,
            births,
            line: line.map(|sticks| sticks.iter().map(|stick| stick.ends[1]).collect()),
            sticks,
            leaves,
            objects,
            steps: settled.get(),
            corners,
            fertile,
            length: all,
            meets_end: descent.ends_joined(),
        })
    }
}

impl Known {
    /// Returns the number of elements of all blocks.
    fn sum(&self) -> u64 {
        match self {
            Self::BySteps(sizes) => sizes.sum(),
            Self::ByLength(cuts, _) => {
                let cuts = cuts.iter().flat_map(|cuts| &cuts.all);
                cuts.map(|cut| cut.count).sum()
            }
        }
    }

    /// Returns, for every object, the maximum number of blocks for each direction.
    fn slots(&self) -> Vec<usize> {
        match self {
            Self::BySteps(sizes) => sizes.slots().collect(),
            Self::ByLength(cuts, _) => cuts.iter().map(|cuts| cuts.all.len()).collect(),
        }
    }
}
