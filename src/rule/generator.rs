use std::sync::Arc;

use crate::diagnostic::Place;
use crate::document::Point;
use crate::expression::{Dependence, Program, degrees};
use crate::geometry::{DAffine2, DMat2, DVec2, Direction};

use super::draw::{Path, Variable};

/// What the expressions of a generator and of a selection see of the element that is replaced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The element's rank in its fractal, from 1.
    pub index: f64,
    /// The age of its fractal.
    pub age: f64,
    /// The number of the approximant that is being replaced.
    pub step: f64,
    /// Its length, as a multiple of the initiator element's that it descends from.
    pub length: f64,
}

impl Moment {
    /// The names that expressions know the fields by, in the order of their slots.
    pub const NAMES: [&'static str; 4] = ["i", "age", "step", "length"];
    /// The slot of `i`.
    pub const INDEX: usize = 0;
    /// The slot of `age`.
    pub const AGE: usize = 1;
    /// The slot of `step`.
    pub const STEP: usize = 2;
    /// The slot of `length`.
    pub const LENGTH: usize = 3;

    /// The values, in the order of their slots.
    #[must_use]
    pub fn slots(&self) -> [f64; 4] {
        [self.index, self.age, self.step, self.length]
    }
}

/// A part of a random function: moves points of the generator (Kaandorp 1987, figure 4).
///
/// Points are scaled and turned about a centre, then shifted. Angles are degrees, positive
/// counter-clockwise; lengths are those of the unit frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Move {
    pub(crate) rotate: Program,
    pub(crate) scale: [Program; 2],
    pub(crate) shift: [Program; 2],
    pub(crate) about: [Program; 2],
    /// The points that move, by their number. Moves of the same points share them.
    pub(crate) points: Arc<[usize]>,
}

impl Move {
    /// Its expressions.
    pub(super) fn programs(&self) -> impl Iterator<Item = &Program> {
        let pairs = [&self.scale, &self.shift, &self.about].into_iter();
        std::iter::once(&self.rotate).chain(pairs.flatten())
    }

    fn map(&self, slots: &[f64]) -> DAffine2 {
        let vector = |[x, y]: &[Program; 2]| DVec2::new(x.eval(slots), y.eval(slots));
        let angle = self.rotate.eval(slots);
        let (sine, cosine) = (degrees::sin(angle), degrees::cos(angle));
        let scale = vector(&self.scale);
        let turn = DMat2::from_cols(DVec2::new(cosine, sine), DVec2::new(-sine, cosine));
        let about = vector(&self.about);
        let linear = turn * DMat2::from_diagonal(scale);
        DAffine2::from_mat2_translation(linear, about - linear * about + vector(&self.shift))
    }
}

/// Where the elements of a part go (Kaandorp 1987, step E1 of the algorithm, and figure 6).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// They take the replaced element's place.
    Stays,
    /// They start a new fractal in the replaced element's frame.
    Seeds,
    /// They start a new fractal with the linear part of the initiator element that the replaced
    /// element descends from, and with its origin at the replaced element's first point.
    SeedsAsInitiator,
}

impl Placement {
    /// Whether a new fractal starts.
    #[must_use]
    pub fn seeds(self) -> bool {
        self != Self::Stays
    }
}

/// An element as an initiator or a generator lists it.
#[derive(Clone, Debug, PartialEq)]
pub struct ListedElement {
    /// The number of the point that it runs from.
    pub from: usize,
    /// The number of the point that it runs to.
    pub to: usize,
    /// Its direction.
    pub direction: Direction,
    /// Whether it is replaced in the next step.
    pub fertile: bool,
    /// Whether it is drawn.
    pub visible: bool,
    /// Whether it joins the element listed before it (the first one: the last, in a closed chain).
    pub joined: bool,
    /// The generator that it names for its replacement.
    pub generator: Option<usize>,
    /// Its base element, by number.
    pub base_element: usize,
}

/// A list of elements that stand together: an initiator, or a part of a generator.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Where the elements go.
    pub placement: Placement,
    /// The elements in the order of listing.
    pub elements: Vec<ListedElement>,
    /// Whether the first element is written to start at (0, 0) and the last to end at (1, 0).
    pub meets_frame: [bool; 2],
}

/// How a generator or an initiator was written: for messages about what shows only when it is
/// evaluated, and for what needs more digits than a double has.
#[derive(Clone, Debug)]
pub(crate) struct Origin {
    pub(crate) name: Place,
    /// Its points.
    pub(crate) points: Vec<Point>,
}

impl PartialEq for Origin {
    /// Two generators are the same wherever they were written.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A generator: what replaces a fertile element.
///
/// The coordinates of its points are those of the unit frame, in which the replaced element runs
/// from (0, 0) to (1, 0).
#[derive(Clone, Debug, PartialEq)]
pub struct Generator {
    pub(crate) origin: Origin,
    pub(crate) name: String,
    pub(crate) variables: Vec<Variable>,
    pub(crate) points: Vec<[Program; 2]>,
    pub(crate) moves: Vec<Move>,
    pub(crate) parts: Vec<Part>,
}

impl Generator {
    /// The name that selections and elements call it by.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The variables of its random function.
    #[must_use]
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// The first coordinate that is not finite at a moment, before points move: where it is
    /// written, and what it depends on. None if it depends on draws or becomes infinite as it moves.
    pub(crate) fn infinite_coordinate(
        &self,
        moment: &Moment,
    ) -> Option<(&Place, Vec<(&'static str, f64)>)> {
        let slots = moment.slots();
        let written = self.points.iter().flatten();
        let places = self.origin.points.iter();
        let places = places.flat_map(|point| [&point.x.place, &point.y.place]);
        let mut written = written.zip(places);
        let (program, place) = written
            .find(|(program, _)| !program.eval(&slots).is_finite())
            .filter(|_| !self.is_random())?;
        let depends = |slot: &usize| program.dependence(*slot) != Dependence::None;
        let slots = (0..slots.len()).filter(depends);
        let values = slots.map(|slot| (Moment::NAMES[slot], moment.slots()[slot]));
        Some((place, values.collect()))
    }

    /// Its parts, in the order of listing.
    #[must_use]
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// All elements, in the order of listing, across parts.
    pub fn elements(&self) -> impl Iterator<Item = &ListedElement> {
        self.parts.iter().flat_map(|part| &part.elements)
    }

    /// Whether the points depend on draws.
    #[must_use]
    pub fn is_random(&self) -> bool {
        !self.variables.is_empty()
    }

    /// What the expressions of its points see: the moment, and what is drawn for a path.
    pub(crate) fn slots(&self, moment: &Moment, path: Path) -> Vec<f64> {
        let mut slots = moment.slots().to_vec();
        for variable in &self.variables {
            slots.push(variable.draw(path, &slots));
        }
        slots
    }

    /// All expressions of the generator.
    pub(crate) fn programs(&self) -> impl Iterator<Item = &Program> {
        let moves = self.moves.iter().flat_map(Move::programs);
        let drawn = self.variables.iter().flat_map(Variable::programs);
        self.points.iter().flatten().chain(moves).chain(drawn)
    }

    /// The points for one replacement: drawn, evaluated, moved.
    ///
    /// `scratch` and `points` are overwritten: their memory is used again, so nothing is allocated
    /// in a walk. The points may be infinite or NaN where an expression is.
    pub fn evaluate(
        &self,
        moment: &Moment,
        path: Path,
        scratch: &mut Vec<f64>,
        points: &mut Vec<DVec2>,
    ) {
        let draw = |variable: &Variable, slots: &[f64]| variable.draw(path, slots);
        self.evaluate_with(moment, draw, scratch, points);
    }

    /// The points for draws that stand for all (see [`Variable::typical`]).
    #[must_use]
    pub fn typical(&self, moment: &Moment) -> Vec<DVec2> {
        let (mut scratch, mut points) = (Vec::new(), Vec::new());
        self.evaluate_with(moment, Variable::typical, &mut scratch, &mut points);
        points
    }

    /// The points for draws of one's own, of each variable in the order of listing.
    #[inline]
    pub(crate) fn evaluate_with(
        &self,
        moment: &Moment,
        draw: impl Fn(&Variable, &[f64]) -> f64,
        scratch: &mut Vec<f64>,
        points: &mut Vec<DVec2>,
    ) {
        scratch.clear();
        scratch.extend(moment.slots());
        for variable in &self.variables {
            let value = draw(variable, scratch);
            scratch.push(value);
        }
        points.clear();
        points.extend(
            self.points
                .iter()
                .map(|[x, y]| DVec2::new(x.eval(scratch), y.eval(scratch))),
        );
        for moving in &self.moves {
            let map = moving.map(scratch);
            for &number in &*moving.points {
                points[number] = map.transform_point2(points[number]);
            }
        }
    }
}
