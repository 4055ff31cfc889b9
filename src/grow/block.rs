//! Blocks: the elements that an object becomes in its last steps, worked out once and moved into
//! place by a single map wherever the object stands.

use std::convert::Infallible;
use std::rc::Rc;

use crate::geometry::{DAffine2, DVec2, Direction, Frame};
use crate::graph::{CompileError, Graph, Replacement};

use super::descent::{Descent, Next};
use super::{Element, Fractal, Visitor};

/// A block has this many elements at most: they stay in the fastest memory.
const MOST_LEAVES: u64 = 512;

/// All blocks together have no more elements than this.
const MOST_MEMORY: usize = 1 << 16;

/// Steps of a block.
const MOST_LEVELS: usize = 64;

/// Graphs with more objects than this are walked without blocks.
const MOST_OBJECTS: usize = 4_096;

/// An element of a block, as seen from the object whose place it takes.
#[derive(Clone, Copy, Debug)]
struct Leaf {
    map: DAffine2,
    direction: Direction,
    length: f64,
    object: usize,
    /// The step of its birth, from that of the object.
    born: u32,
    /// Whether it joins the leaf before; the first one: what was drawn before the block.
    joined: bool,
}

/// An element that is a line.
#[derive(Clone, Copy, Debug)]
pub struct Stick {
    /// Where it starts and ends, in the order of traversal.
    pub ends: [DVec2; 2],
    /// The logarithm to base 2 of its length.
    pub octave: f64,
    /// Whether it joins the element before.
    pub joined: bool,
}

/// What an object becomes in a number of steps.
#[derive(Debug)]
pub(super) struct Block {
    leaves: Vec<Leaf>,
    /// The leaves as lines in the object's unit frame, if all of them are visible lines.
    sticks: Option<Vec<Stick>>,
    /// Where they end, if each joins the one before.
    line: Option<Vec<DVec2>>,
    /// Whether the last leaf reaches the end of the object.
    pub(super) meets_end: bool,
}

impl Block {
    pub(super) fn len(&self) -> u64 {
        self.leaves.len() as u64
    }
}

/// Elements in a row that come as one: a block in its place.
pub struct Run<'b> {
    pub(super) block: &'b Block,
    /// Where the object stood.
    pub(super) frame: Frame,
    pub(super) length: f64,
    /// The step of its birth.
    pub(super) born: u32,
    /// The rank of the first element.
    pub(super) index: u64,
    /// Whether what was drawn before reaches the object.
    pub(super) joined: bool,
    pub(super) graph: &'b Graph,
}

impl Run<'_> {
    /// The number of elements.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.block.len()
    }

    /// The first element.
    #[must_use]
    pub fn first(&self) -> Option<Element> {
        self.elements().next()
    }

    /// The last element.
    #[must_use]
    pub fn last(&self) -> Option<Element> {
        self.elements().next_back()
    }

    /// The elements in order of traversal.
    pub fn elements(&self) -> impl DoubleEndedIterator<Item = Element> {
        let unit = unit(self.frame.direction.is_reversed());
        let leaves = self.block.leaves.iter().enumerate();
        leaves.map(move |(number, leaf)| Element {
            frame: Frame {
                map: self.frame.map * leaf.map,
                direction: self.frame.direction * unit * leaf.direction,
            },
            length: self.length * leaf.length,
            index: self.index + number as u64,
            object: leaf.object,
            born: self.born + leaf.born,
            fertile: !matches!(
                self.graph.objects()[leaf.object].replacement,
                Replacement::Kept
            ),
            joined: leaf.joined && (number > 0 || self.joined),
        })
    }

    /// Where the elements end, one after another, in the unit frame of [`Run::map`], if all are
    /// visible lines of which each joins the one before.
    #[must_use]
    pub fn line(&self) -> Option<&[DVec2]> {
        self.block.line.as_deref()
    }

    /// The elements as lines, in the unit frame of [`Run::map`], if all are visible lines. Whether
    /// the first one joins what was drawn before is told by [`Run::first`].
    #[must_use]
    pub fn sticks(&self) -> Option<&[Stick]> {
        self.block.sticks.as_deref()
    }

    /// The map from the block's unit frame to the plane.
    #[must_use]
    pub fn map(&self) -> &DAffine2 {
        &self.frame.map
    }
}

/// The direction of the frame that a block is worked out in.
fn unit(reversed: bool) -> Direction {
    if reversed {
        Direction::XReflected
    } else {
        Direction::Normal
    }
}

/// The blocks of a graph, made as they are reached.
#[derive(Default)]
pub(super) struct Blocks {
    /// Of every object, the largest number of steps that makes a block.
    levels: Vec<usize>,
    /// By object, direction and number of steps.
    made: Vec<[Vec<Option<Rc<Block>>>; 2]>,
    /// The number of elements in all of them.
    memory: usize,
}

impl Blocks {
    /// What there is to know before blocks are made.
    pub(super) fn of(graph: &Graph) -> Self {
        if graph.counts_index() || graph.objects().len() > MOST_OBJECTS {
            return Self::default();
        }
        let levels = levels(graph);
        let none = |&levels: &usize| [vec![None; levels + 1], vec![None; levels + 1]];
        Self {
            made: levels.iter().map(none).collect(),
            levels,
            memory: 0,
        }
    }

    /// What an object becomes in a number of steps, if that makes a block.
    #[inline]
    pub(super) fn get(
        &mut self,
        graph: &Graph,
        object: usize,
        steps: u32,
        reversed: bool,
    ) -> Option<Rc<Block>> {
        let steps = steps as usize;
        if self.levels.get(object).is_none_or(|most| steps > *most) {
            return None;
        }
        if let Some(block) = &self.made[object][usize::from(reversed)][steps] {
            return Some(Rc::clone(block));
        }
        if self.memory > MOST_MEMORY {
            return None;
        }
        // What is not finite is for the walk itself to report.
        let block = Rc::new(made(graph, object, steps, reversed).ok()?);
        self.memory += block.leaves.len();
        self.made[object][usize::from(reversed)][steps] = Some(Rc::clone(&block));
        Some(block)
    }
}

/// Of every object, the largest number of steps in which it becomes no more than [`MOST_LEAVES`],
/// by fixed instances; 0 for those that are not replaced by any.
fn levels(graph: &Graph) -> Vec<usize> {
    let objects = graph.objects();
    let mut counts = vec![1u64; objects.len()];
    let mut levels = vec![0; objects.len()];
    for level in 1..=MOST_LEVELS {
        let count = |object: &crate::graph::Object| match &object.replacement {
            Replacement::Kept => 1,
            Replacement::Fixed(production) => {
                let instances = production.body.instances.iter();
                let sum = instances.map(|instance| counts[instance.object]);
                sum.fold(0, u64::saturating_add)
            }
            Replacement::Evaluated(_) | Replacement::Beyond => u64::MAX,
        };
        let next: Vec<_> = objects.iter().map(count).collect();
        let mut grows = false;
        for (object, &count) in next.iter().enumerate() {
            let fixed = matches!(objects[object].replacement, Replacement::Fixed(_));
            if fixed && levels[object] + 1 == level && count <= MOST_LEAVES {
                levels[object] = level;
                grows = true;
            }
        }
        if !grows {
            break;
        }
        counts = next;
    }
    levels
}

/// Who wants to see everything.
struct Everything;

impl Visitor for Everything {
    type Error = Infallible;

    fn begin(&mut self, _: Fractal) -> Result<(), Infallible> {
        Ok(())
    }

    fn element(&mut self, _: &Element) -> Result<(), Infallible> {
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}

fn made(graph: &Graph, object: usize, steps: usize, reversed: bool) -> Result<Block, CompileError> {
    let steps = u32::try_from(steps).unwrap_or(u32::MAX);
    let start = super::descent::Start::initiator(0);
    let mut descent = Descent::below(graph, object, steps, unit(reversed));
    let mut leaves = Vec::new();
    let mut sticks = Some(Vec::new());
    loop {
        let found = match descent.next(&start, &mut Everything, None)? {
            Next::Element(found) => found,
            Next::Pause => {
                descent.visited = 0;
                continue;
            }
            Next::Run(_) => unreachable!("blocks are not made of blocks"),
            Next::End => break,
        };
        let object = &graph.objects()[found.object];
        if object.visible && graph.base_elements()[object.base_element].is_line() {
            let frame = found.standing.frame;
            sticks.iter_mut().for_each(|sticks| {
                sticks.push(Stick {
                    ends: frame.ends(),
                    octave: libm::log2(frame.length()),
                    joined: found.joined,
                });
            });
        } else {
            sticks = None;
        }
        leaves.push(Leaf {
            map: found.standing.frame.map,
            direction: found.standing.frame.direction,
            length: found.standing.length,
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
    Ok(Block {
        line: line.map(|sticks| sticks.iter().map(|stick| stick.ends[1]).collect()),
        sticks,
        leaves,
        meets_end: descent.ends_joined(),
    })
}
