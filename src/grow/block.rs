//! Blocks: the elements that an object becomes in its last steps, worked out once and moved into
//! place by a single map wherever the object stands. Where no element is replaced that is shorter than
//! a length, its last steps are those that its own length allows: it has a block for every range of
//! lengths that become the same.

mod cut;
mod made;
#[cfg(test)]
mod tests;

pub(super) use made::{Blocks, MOST_LEAVES};

use std::ops::{Range, RangeInclusive};

use crate::geometry::{Bounds, DAffine2, DVec2, Direction, Frame};
use crate::graph::{Graph, Replacement};
use crate::instancing::Coat;
use crate::rule::Piece;

use super::Element;

/// An element of a block, as seen from the object whose place it takes.
#[derive(Clone, Copy, Debug)]
struct Leaf {
    map: DAffine2,
    direction: Direction,
    length: f64,
    coat: Coat,
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
    /// Its own.
    number: u64,
    leaves: Vec<Leaf>,
    /// The leaves as lines in the object's unit frame, if all of them are visible lines.
    sticks: Option<Vec<Stick>>,
    /// Where they end, if each joins the one before.
    line: Option<Vec<DVec2>>,
    /// The corners of what is drawn, if it has no curves.
    corners: Option<Corners>,
    /// The number of fertile leaves.
    fertile: u64,
    /// The lengths of all leaves together.
    length: f64,
    /// The numbers of the leaves, sorted by the steps of their birth,
    by_birth: Vec<u32>,
    /// and how many of them are born before each.
    births: Vec<usize>,
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
    pub(super) object: usize,
    /// Where the object stood.
    pub(super) frame: Frame,
    pub(super) length: f64,
    /// What the object was tinted with.
    pub(super) coat: Coat,
    /// The step of its birth.
    pub(super) born: u32,
    /// The rank of the first element.
    pub(super) index: u128,
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

    /// The object that they take the place of.
    #[must_use]
    pub fn object(&self) -> usize {
        self.object
    }

    /// A number that tells the run from others that are not the same but for their places.
    pub(crate) fn number(&self) -> u64 {
        self.block.number
    }

    /// Where the object stood.
    pub(crate) fn frame(&self) -> Frame {
        self.frame
    }

    /// The step in which the object was born.
    pub(crate) fn born(&self) -> u32 {
        self.born
    }

    /// The same run in another place, with as many elements backwards.
    pub(crate) fn moved_to(&self, map: DAffine2) -> Self {
        let frame = Frame { map, ..self.frame };
        Self { frame, ..*self }
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
        let leaves = self.block.leaves.iter().enumerate();
        leaves.map(|(number, leaf)| self.element(number, leaf, self.frame.map * leaf.map))
    }

    /// The elements as [`Run::elements`] tells them, but all in the place of the run.
    pub(crate) fn elements_in_place(&self) -> impl DoubleEndedIterator<Item = Element> {
        let leaves = self.block.leaves.iter().enumerate();
        leaves.map(|(number, leaf)| self.element(number, leaf, self.frame.map))
    }

    /// The elements that a test chooses by all but their places, and their numbers from 0.
    pub(crate) fn chosen(
        &self,
        test: impl Fn(&Element) -> bool,
    ) -> impl Iterator<Item = (usize, Element)> {
        let elements = self.elements_in_place().enumerate();
        let chosen = elements.filter(move |(_, element)| test(element));
        chosen.map(|(number, element)| {
            let map = self.frame.map * self.block.leaves[number].map;
            let frame = Frame {
                map,
                ..element.frame
            };
            (number, Element { frame, ..element })
        })
    }

    /// The elements that are born in some steps, and their numbers from 0, step by step and in order
    /// of traversal in each.
    pub(crate) fn born_in(
        &self,
        steps: RangeInclusive<u32>,
    ) -> impl Iterator<Item = (usize, Element)> {
        let range = self.births(&steps);
        self.block.by_birth[range].iter().map(|&number| {
            let leaf = &self.block.leaves[number as usize];
            let map = self.frame.map * leaf.map;
            (number as usize, self.element(number as usize, leaf, map))
        })
    }

    /// How many elements are born in some steps.
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

    fn element(&self, number: usize, leaf: &Leaf, map: DAffine2) -> Element {
        let unit = unit(self.frame.direction.is_reversed());
        Element {
            frame: Frame {
                map,
                direction: self.frame.direction * unit * leaf.direction,
            },
            length: self.length * leaf.length,
            coat: self.coat.over(leaf.coat),
            index: self.index + number as u128,
            object: leaf.object,
            born: self.born + leaf.born,
            fertile: !matches!(
                self.graph.objects()[leaf.object].replacement,
                Replacement::Kept
            ),
            joined: leaf.joined && (number > 0 || self.joined),
        }
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

    /// The number of elements that are replaced in the next step.
    #[must_use]
    pub fn fertile(&self) -> u64 {
        self.block.fertile
    }

    /// The lengths |p1 − p0| of all elements together.
    #[must_use]
    pub fn length(&self) -> f64 {
        if self.graph.is_affine() {
            let lengths = self.elements().map(|element| element.frame.length());
            lengths.sum()
        } else {
            self.frame.length() * self.block.length
        }
    }

    /// Adds what is drawn, without strokes, to a box.
    pub fn add_to(&self, bounds: &mut Bounds) {
        if let Some(corners) = &self.block.corners {
            corners.add_to(bounds, &self.frame.map);
            return;
        }
        for element in self.elements() {
            let object = &self.graph.objects()[element.object];
            if object.visible {
                let base_element = &self.graph.base_elements()[object.base_element];
                base_element.add_to(bounds, &element.frame.map, 0.0);
            }
        }
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

/// How many leaves are born before each step from the object's, up to where all are.
fn births(leaves: &[Leaf]) -> Vec<usize> {
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

/// The corners of outlines, by coordinate, so that many are moved at once.
#[derive(Debug, Default)]
struct Corners {
    xs: Vec<f64>,
    ys: Vec<f64>,
}

/// So many corners are moved at once: with their boxes they fit into the registers.
const LANES: usize = 4;

impl Corners {
    /// With those of another outline; `None` if it has curves.
    fn with(mut self, start: DVec2, pieces: &[Piece], map: &DAffine2) -> Option<Self> {
        self.add(map.transform_point2(start));
        for piece in pieces {
            let Piece::Line(end) = *piece else {
                return None;
            };
            self.add(map.transform_point2(end));
        }
        Some(self)
    }

    fn add(&mut self, corner: DVec2) {
        // Where a line goes on its corner is there already.
        if self.xs.last() != Some(&corner.x) || self.ys.last() != Some(&corner.y) {
            self.xs.push(corner.x);
            self.ys.push(corner.y);
        }
    }

    /// Moves all corners and adds them to a box.
    fn add_to(&self, bounds: &mut Bounds, map: &DAffine2) {
        let [x, y] = [map.matrix2.row(0), map.matrix2.row(1)];
        let mut wide = [[f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]];
        let mut high = wide;
        let (xs, ys) = (self.xs.as_chunks(), self.ys.as_chunks());
        for (xs, ys) in xs.0.iter().zip(ys.0) {
            stretch(&mut wide, xs, ys, x);
            stretch(&mut high, xs, ys, y);
        }
        let lanes = if xs.0.is_empty() { 0 } else { LANES };
        for lane in 0..lanes {
            for [x, y] in [0, 1].map(|end| [wide[end][lane], high[end][lane]]) {
                bounds.add(map.translation + DVec2::new(x, y));
            }
        }
        for (&x, &y) in xs.1.iter().zip(ys.1) {
            bounds.add(map.transform_point2(DVec2::new(x, y)));
        }
    }
}

/// Makes room for one coordinate of moved corners.
#[inline]
fn stretch(range: &mut [[f64; LANES]; 2], xs: &[f64; LANES], ys: &[f64; LANES], row: DVec2) {
    let [low, high] = range;
    for lane in 0..LANES {
        let value = row.x * xs[lane] + row.y * ys[lane];
        // In this form it is one instruction.
        low[lane] = if value < low[lane] { value } else { low[lane] };
        high[lane] = if value > high[lane] {
            value
        } else {
            high[lane]
        };
    }
}
