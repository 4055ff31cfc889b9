//! Generators: the elements that replace a fertile element, with their random functions and placements.

use std::sync::Arc;

use crate::diagnostic::Place;
use crate::expression::{AffineOf, Dependence, Evaluation, Program};
use crate::geometry::{Direction, Frame2};
use crate::instancing::Tint;
use crate::written::WrittenPoint;

use crate::draws::{Corner, Path, Variable};

use super::frame::{RuleFrame, evaluated};

/// Values that the expressions of a generator and of a selection see of the element that is replaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementContext {
    /// Index of the element in its fractal, from 1 in the order of traversal.
    pub index: f64,
    /// Age of its fractal, in steps.
    pub age: f64,
    /// Number of the approximant that is replaced.
    pub step: f64,
    /// Length of the element, as a multiple of the length of the initiator element from which it
    /// descends.
    pub length: f64,
}

impl ElementContext {
    /// Names of the fields in expressions, in the order of their slots.
    pub const NAMES: [&'static str; 4] = ["i", "age", "step", "length"];
    /// Slot of `i`.
    pub const INDEX: usize = 0;
    /// Slot of `age`.
    pub const AGE: usize = 1;
    /// Slot of `step`.
    pub const STEP: usize = 2;
    /// Slot of `length`.
    pub const LENGTH: usize = 3;

    /// Returns the values in the order of their slots.
    #[must_use]
    pub fn slots(&self) -> [f64; 4] {
        [self.index, self.age, self.step, self.length]
    }
}

/// Component of a random function: moves points of the generator (Kaandorp 1987, figure 4).
///
/// Points are scaled and rotated about a centre, then translated. Angles are in degrees, positive
/// counter-clockwise; lengths are in units of the unit frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Move<F: RuleFrame = Frame2> {
    pub(crate) rotate: F::Turns,
    pub(crate) scale: F::Coordinates,
    pub(crate) shift: F::Coordinates,
    pub(crate) about: F::Coordinates,
    /// Numbers of the points that move; moves of equal points share the allocation.
    pub(crate) points: Arc<[usize]>,
    /// Numbers of the normals that move: those of elements both ends of which move.
    pub(crate) normals: Arc<[usize]>,
}

impl<F: RuleFrame> Move<F> {
    /// Iterates over the expressions of the move.
    pub(super) fn programs(&self) -> impl Iterator<Item = &Program> {
        let vectors = [&self.scale, &self.shift, &self.about].into_iter();
        let vectors = vectors.flat_map(|vector| vector.as_ref());
        F::programs_of_turns(&self.rotate)
            .into_iter()
            .chain(vectors)
    }
}

impl Move {
    /// Evaluates the map of the points.
    #[inline]
    pub(crate) fn map<A: Evaluation>(
        &self,
        of: &mut A,
        mut value: impl FnMut(&mut A, &Program) -> A::Number,
    ) -> AffineOf<A::Number> {
        let mut pair = |of: &mut A, [x, y]: &[Program; 2]| [value(of, x), value(of, y)];
        let scale = pair(of, &self.scale);
        let (about, shift) = (pair(of, &self.about), pair(of, &self.shift));
        let angle = value(of, &self.rotate);
        let turn = of.turn(&angle);
        let map = AffineOf::turned_axes(of, &scale, [&turn; 2]).about(of, &about);
        let origin = [0, 1].map(|row| of.add(&map.origin[row], &shift[row]));
        map.moved_to(origin)
    }
}

/// Placement of the elements of a part (Kaandorp 1987, step E1 of the algorithm, and figure 6).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// The elements take the place of the replaced element.
    Stays,
    /// The elements start a new fractal in the frame of the replaced element.
    Seeds,
    /// The elements start a new fractal with the linear part of the initiator element from which the
    /// replaced element descends, and with the origin at the first point of the replaced element.
    SeedsAsInitiator,
}

impl Placement {
    /// Returns whether the part is a seed part: whether it starts a new fractal.
    #[must_use]
    pub fn seeds(self) -> bool {
        self != Self::Stays
    }
}

/// Turn of a listed element about itself; in the plane there is none.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ListedAttitude {
    /// The frame is that of the least turn.
    #[default]
    Least,
    /// The z axis of the frame lies on the side of the vector of this number, among the points.
    Normal(usize),
    /// The frame of the least turn is turned by an angle in degrees: the first coordinate of the point of this number.
    Roll(usize),
    /// The z axis of the frame lies on the side of the normal of the polygon with these points.
    Face(Vec<usize>),
    /// The frame is that of the affine map that takes the first three corners of the base element to these points.
    Corners {
        /// Numbers of the points.
        points: [usize; 3],
        /// Coordinates x and y of the third corner of the base element; the first two are the ends of the unit element.
        third: [f64; 2],
        /// Number of the vector to which the map takes the z axis, among the points; the normal of the length of the
        /// element if there is none.
        up: Option<usize>,
    },
}

/// Element as listed in an initiator or a generator.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedElement {
    /// Number of its first point.
    pub from: usize,
    /// Number of its last point.
    pub to: usize,
    /// Direction.
    pub direction: Direction,
    /// Turn about itself.
    pub attitude: ListedAttitude,
    /// Origins of the first three corners of its surface, if draws belong to edges.
    pub corners: Option<[Corner; 3]>,
    /// Whether the element is fertile: replaced in the next step.
    pub fertile: bool,
    /// Whether the element is drawn.
    pub visible: bool,
    /// Whether the element joins the one listed before it (the first joins the last, in a closed chain).
    pub joined: bool,
    /// Number of the generator that the element names for its replacement.
    pub generator: Option<usize>,
    /// Number of its base element.
    pub base_element: usize,
    /// Tint of the element and of all that replaces it.
    pub tint: Option<Tint>,
}

impl ListedElement {
    /// Returns whether its frame is an affine map, which need not be a similarity.
    pub(crate) fn is_stretched(&self) -> bool {
        matches!(self.attitude, ListedAttitude::Corners { .. })
    }
}

/// List of elements with one placement: an initiator, or a part of a generator.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Placement of the elements.
    pub placement: Placement,
    /// Elements in the order of listing.
    pub elements: Vec<ListedElement>,
    /// Whether the first element is written to start at (0, 0), and whether the last is written to end at
    /// (1, 0).
    pub meets_frame: [bool; 2],
}

/// Source of a generator, for diagnostics of evaluation and for texts.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    pub(crate) name: Place,
    /// Points as written, and the vectors and angles to which attitudes refer.
    pub(crate) points: Vec<WrittenPoint>,
}

impl PartialEq for Origin {
    /// Returns true: generators are compared regardless of their source.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Generator: the elements that replace a fertile element.
///
/// The coordinates of its points are those of the unit frame, in which the replaced element runs from (0,
/// 0) to (1, 0).
#[derive(Clone, Debug, PartialEq)]
pub struct Generator<F: RuleFrame = Frame2> {
    pub(crate) origin: Origin,
    pub(crate) name: String,
    pub(crate) variables: Vec<Variable>,
    /// Points, followed by the vectors and angles to which attitudes refer.
    pub(crate) points: Vec<F::Coordinates>,
    pub(crate) moves: Vec<Move<F>>,
    pub(crate) parts: Vec<Part>,
}

impl<F: RuleFrame> Generator<F> {
    /// Returns the name by which selections and elements refer to the generator.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the variables of the random function.
    #[must_use]
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// Returns the first coordinate that is not finite at a moment, before points move: its source place,
    /// and the names and values on which it depends. `None` if the generator is random or all coordinates
    /// are finite before the moves.
    pub(crate) fn infinite_coordinate(
        &self,
        moment: &ElementContext,
    ) -> Option<(&Place, Vec<(&'static str, f64)>)> {
        let slots = moment.slots();
        let points = self.points.iter().zip(&self.origin.points);
        let mut written = points.flat_map(|(point, written)| {
            let third = written.z.as_ref().map_or(&written.place, |z| &z.place);
            let places = [&written.x.place, &written.y.place, third];
            point.as_ref().iter().zip(places)
        });
        let (program, place) = written
            .find(|(program, _)| !program.eval(&slots).is_finite())
            .filter(|_| !self.is_random())?;
        let depends = |slot: &usize| program.dependence(*slot) != Dependence::None;
        let slots = (0..slots.len()).filter(depends);
        let values = slots.map(|slot| (ElementContext::NAMES[slot], moment.slots()[slot]));
        Some((place, values.collect()))
    }

    /// Returns the parts in the order of listing.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Iterates over all elements in the order of listing, across parts.
    pub fn elements(&self) -> impl Iterator<Item = &ListedElement> {
        self.parts.iter().flat_map(|part| &part.elements)
    }

    /// Returns whether the generator has random variables.
    #[must_use]
    pub fn is_random(&self) -> bool {
        !self.variables.is_empty()
    }

    /// Returns the values that the expressions of the points see: those of the moment, and the draws for
    /// a path.
    pub(crate) fn slots(&self, moment: &ElementContext, path: Path) -> Vec<f64> {
        let mut slots = moment.slots().to_vec();
        for variable in &self.variables {
            slots.push(variable.draw(path, &slots));
        }
        slots
    }

    /// Iterates over all expressions of the generator.
    pub(crate) fn programs(&self) -> impl Iterator<Item = &Program> {
        let moves = self.moves.iter().flat_map(Move::programs);
        let drawn = self.variables.iter().flat_map(Variable::programs);
        let points = self.points.iter().flat_map(|point| point.as_ref());
        points.chain(moves).chain(drawn)
    }

    /// Evaluates the points for one replacement: draws the variables, evaluates the coordinates, applies
    /// the moves.
    ///
    /// `scratch` and `points` are overwritten and their memory is reused: a walk does not allocate. A
    /// point is infinite or NaN where an expression is.
    pub fn evaluate(
        &self,
        moment: &ElementContext,
        path: Path,
        scratch: &mut Vec<f64>,
        points: &mut Vec<F::Point>,
    ) {
        let draw = |variable: &Variable, slots: &[f64]| variable.draw(path, slots);
        self.evaluate_with(moment, draw, scratch, points);
    }

    /// Returns the points for representative draws (see [`Variable::typical`]).
    #[must_use]
    pub fn typical(&self, moment: &ElementContext) -> Vec<F::Point> {
        let (mut scratch, mut points) = (Vec::new(), Vec::new());
        self.evaluate_with(moment, Variable::typical, &mut scratch, &mut points);
        points
    }

    /// Evaluates the points with the draws of the function `draw`, called for each variable in the order
    /// of listing.
    #[inline]
    pub(crate) fn evaluate_with(
        &self,
        moment: &ElementContext,
        draw: impl Fn(&Variable, &[f64]) -> f64,
        scratch: &mut Vec<f64>,
        points: &mut Vec<F::Point>,
    ) {
        scratch.clear();
        scratch.extend(moment.slots());
        for variable in &self.variables {
            let value = draw(variable, scratch);
            scratch.push(value);
        }
        points.clear();
        points.extend(self.points.iter().map(|it| evaluated::<F>(it, scratch)));
        for moving in &self.moves {
            F::move_points(moving, scratch, points);
        }
    }
}
