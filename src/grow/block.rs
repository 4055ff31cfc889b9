//! Blocks: expansions of objects over their last steps, computed once and placed by a single map wherever
//! the object is instanced.
//!
//! If elements below a cutoff length are not replaced, the length of the object determines the number of its
//! last steps: an object then has one block for each range of lengths with the same expansion.

mod cut;
mod kept;
mod made;
#[cfg(test)]
mod tests;

pub(crate) use kept::KeptBlocks;
pub(super) use made::{Blocks, MAX_LEAVES};

use std::ops::{Range, RangeInclusive};

use crate::geometry::{Bounds, Corners, DAffine2, DVec2, Direction, Frame, Frame2, Outline};
use crate::graph::Graph;
use crate::instancing::Appearance;

use super::Element;

/// Element of a block, relative to the object that the block replaces.
#[derive(Clone, Copy, Debug)]
struct Leaf<F> {
    /// Frame relative to the object's.
    frame: F,
    length: f64,
    appearance: Appearance,
    object: usize,
    /// Step of its birth, relative to that of the object.
    born: u32,
    /// Whether it joins the preceding leaf; for the first leaf, whether it can join the element before the
    /// block.
    joined: bool,
}

/// Element that is a line.
#[derive(Clone, Copy, Debug)]
pub struct LineElement<P = DVec2> {
    /// First and last point, in order of traversal.
    pub ends: [P; 2],
    /// Base-2 logarithm of its length.
    pub octave: f64,
    /// Whether it joins the preceding element.
    pub joined: bool,
}

/// Expansion of an object over a number of steps.
#[derive(Debug)]
pub(super) struct Block<F: Frame = Frame2> {
    /// Unique number of the block.
    number: u64,
    leaves: Vec<Leaf<F>>,
    /// Leaves as lines in the object's unit frame, if all are visible lines.
    sticks: Option<Vec<LineElement<F::Point>>>,
    /// End points of the lines, if each joins the one before.
    line: Option<Vec<F::Point>>,
    /// Corners of the outlines, if these have no curves.
    corners: Option<F::Corners>,
    /// Numbers of the leaves' objects, each once.
    objects: Vec<usize>,
    /// Number of steps after which no element is replaced.
    steps: u32,
    /// Number of fertile leaves.
    fertile: u64,
    /// Sum of the leaves' lengths.
    length: f64,
    /// Numbers of the leaves, sorted by birth step.
    by_birth: Vec<u32>,
    /// Number of leaves born before each step.
    births: Vec<usize>,
    /// Whether the last leaf reaches the end point of the object.
    pub(super) meets_end: bool,
}

impl<F: Frame> Block<F> {
    pub(super) fn len(&self) -> u64 {
        self.leaves.len() as u64
    }
}

/// Consecutive elements that a visitor receives at once: a block placed by a map.
pub struct Run<'b, F: Frame = Frame2> {
    pub(super) block: &'b Block<F>,
    pub(super) object: usize,
    /// Frame of the object that the block replaces.
    pub(super) frame: F,
    pub(super) length: f64,
    /// Appearance of the object.
    pub(super) appearance: Appearance,
    /// Step of the object's birth.
    pub(super) born: u32,
    /// Rank of the first element.
    pub(super) index: u128,
    /// Whether the preceding element ends where the object starts.
    pub(super) joined: bool,
    pub(super) graph: &'b Graph<F>,
}

impl<F: Frame> Run<'_, F> {
    /// Returns the number of elements.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.block.len()
    }

    /// Returns the number of the object that the elements replace.
    #[must_use]
    pub fn object(&self) -> usize {
        self.object
    }

    /// Returns the number of the block; runs of equal blocks differ only in frame, appearance, birth and
    /// rank.
    pub(crate) fn number(&self) -> u64 {
        self.block.number
    }

    /// Returns the frame of the object that the elements replace.
    pub(crate) fn frame(&self) -> F {
        self.frame
    }

    /// Returns the run placed in the unit frame, with its direction.
    pub(crate) fn in_unit_frame(&self) -> Self {
        let frame = F::UNIT.with_direction(self.frame.direction());
        Self { frame, ..*self }
    }

    /// Returns the step in which the object was born.
    pub(crate) fn born(&self) -> u32 {
        self.born
    }

    /// Returns the first element.
    #[must_use]
    pub fn first(&self) -> Option<Element<F>> {
        self.elements().next()
    }

    /// Returns the last element.
    #[must_use]
    pub fn last(&self) -> Option<Element<F>> {
        self.elements().next_back()
    }

    /// Iterates over the elements in order of traversal.
    pub fn elements(&self) -> impl DoubleEndedIterator<Item = Element<F>> {
        let leaves = self.block.leaves.iter().enumerate();
        leaves.map(|(number, leaf)| self.element(number, leaf, self.frame.compose(&leaf.frame)))
    }

    /// Iterates over the elements as [`Run::elements`] does, but with the run's map instead of their own.
    pub(crate) fn elements_in_place(&self) -> impl DoubleEndedIterator<Item = Element<F>> {
        let leaves = self.block.leaves.iter().enumerate();
        leaves.map(|(number, leaf)| {
            let direction = self.frame.direction() * leaf.frame.direction();
            self.element(number, leaf, self.frame.with_direction(direction))
        })
    }

    /// Iterates over the elements that pass a test, with their numbers from 0. The test sees the run's map
    /// instead of the elements'.
    pub(crate) fn chosen(
        &self,
        test: impl Fn(&Element<F>) -> bool,
    ) -> impl Iterator<Item = (usize, Element<F>)> {
        let elements = self.elements_in_place().enumerate();
        let chosen = elements.filter(move |(_, element)| test(element));
        chosen.map(|(number, element)| {
            let frame = self.frame.compose(&self.block.leaves[number].frame);
            (number, Element { frame, ..element })
        })
    }

    /// Iterates over the elements born in a range of steps, with their numbers from 0: ordered by step, then
    /// by traversal.
    pub(crate) fn born_in(
        &self,
        steps: RangeInclusive<u32>,
    ) -> impl Iterator<Item = (usize, Element<F>)> {
        let range = self.births(&steps);
        self.block.by_birth[range].iter().map(|&number| {
            let leaf = &self.block.leaves[number as usize];
            let frame = self.frame.compose(&leaf.frame);
            (number as usize, self.element(number as usize, leaf, frame))
        })
    }

    /// Returns the number of elements born in a range of steps.
    pub(crate) fn count_born_in(&self, steps: &RangeInclusive<u32>) -> u64 {
        self.births(steps).len() as u64
    }

    fn births(&self, steps: &RangeInclusive<u32>) -> Range<usize> {
        let births = &self.block.births;
        let before = |step: u32| {
            let step = step.saturating_sub(self.born) as usize;
            births.get(step).or(births.last()).copied().unwrap_or(0)
        };
        before(*steps.start())..before(steps.end().saturating_add(1))
    }

    fn element(&self, number: usize, leaf: &Leaf<F>, frame: F) -> Element<F> {
        Element {
            frame,
            length: self.length * leaf.length,
            appearance: self.appearance.over(leaf.appearance),
            index: self.index + number as u128,
            object: leaf.object,
            born: self.born + leaf.born,
            fertile: self.graph.is_fertile(leaf.object),
            visible: self.graph.objects()[leaf.object].visible,
            joined: leaf.joined && (number > 0 || self.joined),
        }
    }

    /// Returns the end points of the elements in order of traversal, in the unit frame of [`Run::map`], if
    /// all elements are visible lines and each joins the one before.
    #[must_use]
    pub fn line(&self) -> Option<&[F::Point]> {
        self.block.line.as_deref()
    }

    /// Returns the elements as lines in the unit frame of [`Run::map`], if all are visible lines. Whether the
    /// first one joins the preceding element is a field of [`Run::first`].
    #[must_use]
    pub fn sticks(&self) -> Option<&[LineElement<F::Point>]> {
        self.block.sticks.as_deref()
    }

    /// Returns the numbers of the elements' objects, each once.
    pub(crate) fn objects(&self) -> &[usize] {
        &self.block.objects
    }

    /// Returns the step after which no element is replaced any more, of those that have led to the run.
    pub(crate) fn settled(&self) -> u32 {
        self.born + self.block.steps
    }

    /// Returns the number of elements that are replaced in the next step.
    #[must_use]
    pub fn fertile(&self) -> u64 {
        self.block.fertile
    }

    /// Returns the sum of |p1 − p0| over all elements.
    #[must_use]
    pub fn length(&self) -> f64 {
        if self.graph.is_affine() {
            let lengths = self.elements().map(|element| element.frame.length());
            lengths.sum()
        } else {
            self.frame.length() * self.block.length
        }
    }

    /// Extends a box by the outlines of all visible elements, without strokes.
    pub fn add_to(&self, bounds: &mut Bounds<F::Point>) {
        if let Some(corners) = &self.block.corners {
            corners.add_to(bounds, &self.frame);
            return;
        }
        for element in self.elements() {
            if let Some(base_element) = self.graph.drawn(element.object) {
                base_element.add_to(bounds, &element.frame, 0.0);
            }
        }
    }
}

impl Run<'_> {
    /// Returns the run placed by another map, with the direction unchanged.
    pub(crate) fn moved_to(&self, map: DAffine2) -> Self {
        let frame = Frame2::new(map, self.frame.direction());
        Self { frame, ..*self }
    }

    /// Returns the map from the block's unit frame to the plane.
    #[must_use]
    pub fn map(&self) -> &DAffine2 {
        self.frame.map()
    }
}

/// Returns the direction of the frame in which a block is computed.
fn unit(reversed: bool) -> Direction {
    if reversed {
        Direction::XReflected
    } else {
        Direction::Normal
    }
}

/// Returns the number of leaves born before each step, counted from the object's birth, up to the step by
/// which all are born.
fn births<F>(leaves: &[Leaf<F>]) -> Vec<usize> {
    let last = leaves.iter().map(|leaf| leaf.born).max().unwrap_or(0);
    let mut births = vec![0; last as usize + 2];
    for leaf in leaves {
        births[leaf.born as usize + 1] += 1;
    }
    for step in 1..births.len() {
        births[step] += births[step - 1];
    }
    births
}
