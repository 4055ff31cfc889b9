//! Frames of elements that turtles draw: what turtles of the plane and of space do differently.

use std::fmt::Debug;

use crate::expression::degrees;
use crate::geometry::{
    DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3, Direction, Frame as _, Frame2, Frame3, Solid,
    triangulated,
};
use crate::rule::{BaseElement, Body, Piece, RuleFrame};
use crate::style::Tube;

use super::{Compass, LSystem, LSystemInSpace, NoGraph, Stretch, TubePart};

/// Axis about which a turtle turns, by the right-hand rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The heading H.
    Heading,
    /// The direction L to the left.
    Left,
    /// The direction U upwards from the turtle's back.
    Up,
}

/// The frame of an element that a turtle of the plane or of space draws.
pub trait TurtleFrame: RuleFrame {
    /// The L-system, with all that its turtle needs.
    type System: Clone + Debug + PartialEq + Send + Sync + 'static;
    /// The heading of a turtle, relative to another.
    type Heading: Copy + Debug + PartialEq + Send + Sync;

    /// The heading itself: no turn.
    const AHEAD: Self::Heading;

    /// Returns the symbols, words and productions of a system.
    fn words(system: &Self::System) -> &LSystem;

    /// Returns numbers that are the same for headings that differ by rounding errors only.
    fn key(compass: Compass, heading: Self::Heading) -> [i64; 6];

    /// Returns the start heading.
    fn start(system: &Self::System, compass: Compass) -> Self::Heading;

    /// Returns the base elements that the turtle places by number.
    fn stamps(system: &Self::System) -> &[Self::BaseElement];

    /// Returns whether the drawing of a word depends on more of the turtle's state than its frame: on the second heading,
    /// on the mirrored flag, or on directions in space.
    fn depends_on_the_way(system: &Self::System) -> bool;

    /// Returns the tubes that lines are drawn as.
    fn tube(system: &Self::System) -> Option<Tube>;

    /// Returns the part of a tube as a base element.
    fn tube_part(tube: Tube, part: TubePart) -> Self::BaseElement;

    /// Returns the frame stretched along its element and across it.
    #[must_use]
    fn stretched(&self, by: Stretch) -> Self;

    /// Returns a turn about an axis by an angle in degrees. The plane has turns about [`Axis::Up`] only.
    fn turn(compass: Compass, axis: Axis, angle: f64) -> Self::Heading;

    /// Returns a heading after a turn relative to it. Mirrored turtles turn as seen in the mirror, which exchanges left
    /// and right.
    fn after_turn(
        compass: Compass,
        heading: Self::Heading,
        turn: Self::Heading,
        mirrored: bool,
    ) -> Self::Heading;

    /// Converts a vector from the coordinates of the turtle to those in which it has a heading.
    fn outward(
        compass: Compass,
        heading: Self::Heading,
        mirrored: bool,
        vector: Self::Point,
    ) -> Self::Point;

    /// Converts a vector to the coordinates of the turtle: the inverse of [`outward`](Self::outward).
    fn inward(
        compass: Compass,
        heading: Self::Heading,
        mirrored: bool,
        vector: Self::Point,
    ) -> Self::Point;

    /// Returns the frame of an element that runs along a multiple of the heading from a point.
    fn along(
        compass: Compass,
        heading: Self::Heading,
        mirrored: bool,
        from: Self::Point,
        along: Self::Point,
    ) -> Self;

    /// Returns the heading after a roll that levels L: see [`Action::Level`](super::Action::Level).
    fn levelled(compass: Compass, heading: Self::Heading) -> Self::Heading;

    /// Returns the heading after a line, which the tropism of the system has bent.
    fn bent(system: &Self::System, compass: Compass, heading: Self::Heading) -> Self::Heading;

    /// Returns the line of length 1 along the x axis.
    fn line() -> Self::BaseElement;

    /// Returns the line from the origin to a point; `None` without an extent.
    fn line_to(end: Self::Point) -> Option<Self::BaseElement>;

    /// Returns the polygon with some corners; `None` without an extent.
    fn polygon(corners: &[Self::Point]) -> Option<Self::BaseElement>;

    /// Returns the corners of a polygon.
    fn corners(polygon: &Self::BaseElement) -> Vec<Self::Point>;

    /// Returns the frame of an element that runs between two points, after the least turn of this one.
    #[must_use]
    fn spanning(&self, ends: [Self::Point; 2]) -> Self;
}

impl TurtleFrame for Frame2 {
    type System = LSystem;
    type Heading = u64;

    const AHEAD: u64 = 0;

    fn words(system: &LSystem) -> &LSystem {
        system
    }

    fn key(_: Compass, heading: u64) -> [i64; 6] {
        [heading.cast_signed(), 0, 0, 0, 0, 0]
    }

    fn start(system: &LSystem, compass: Compass) -> u64 {
        compass.of_degrees(system.start)
    }

    fn stamps(system: &LSystem) -> &[BaseElement] {
        &system.stamps
    }

    fn depends_on_the_way(system: &LSystem) -> bool {
        system.depends_on_the_way()
    }

    fn tube(_: &LSystem) -> Option<Tube> {
        None
    }

    fn tube_part(_: Tube, _: TubePart) -> BaseElement {
        BaseElement::line()
    }

    fn stretched(&self, [along, across]: Stretch) -> Self {
        let map = *self.map() * DAffine2::from_scale(DVec2::new(along, across));
        Self::new(map, self.direction())
    }

    fn turn(compass: Compass, axis: Axis, angle: f64) -> u64 {
        match axis {
            Axis::Up => compass.of_degrees(angle),
            Axis::Heading | Axis::Left => 0,
        }
    }

    fn after_turn(compass: Compass, heading: u64, turn: u64, mirrored: bool) -> u64 {
        let turn = if mirrored { compass.back(turn) } else { turn };
        compass.sum(heading, turn)
    }

    fn outward(compass: Compass, heading: u64, mirrored: bool, v: DVec2) -> DVec2 {
        let along = compass.direction(heading);
        along.rotate(if mirrored { DVec2::new(v.x, -v.y) } else { v })
    }

    fn inward(compass: Compass, heading: u64, mirrored: bool, v: DVec2) -> DVec2 {
        let along = compass.direction(heading);
        let v = DVec2::new(along.x, -along.y).rotate(v);
        if mirrored { DVec2::new(v.x, -v.y) } else { v }
    }

    fn along(_: Compass, _: u64, mirrored: bool, from: DVec2, along: DVec2) -> Self {
        let (y_axis, direction) = match mirrored {
            true => (-along.perp(), Direction::YReflected),
            false => (along.perp(), Direction::Normal),
        };
        let matrix = DMat2::from_cols(along, y_axis);
        Self::new(DAffine2::from_mat2_translation(matrix, from), direction)
    }

    fn levelled(_: Compass, heading: u64) -> u64 {
        heading
    }

    fn bent(_: &LSystem, _: Compass, heading: u64) -> u64 {
        heading
    }

    fn line() -> BaseElement {
        BaseElement::line()
    }

    fn line_to(end: DVec2) -> Option<BaseElement> {
        BaseElement::new(DVec2::ZERO, vec![Piece::Line(end)], false)
    }

    fn polygon(corners: &[DVec2]) -> Option<BaseElement> {
        let (first, others) = corners.split_first()?;
        let pieces = others.iter().copied().map(Piece::Line);
        BaseElement::new(*first, pieces.collect(), true)
    }

    fn corners(polygon: &BaseElement) -> Vec<DVec2> {
        polygon.corners(&DAffine2::IDENTITY, 1)
    }

    fn spanning(&self, [from, to]: [DVec2; 2]) -> Self {
        Self::between(from, to, self.direction())
    }
}

/// Heading in space: a turn, and then one about U by units of the compass, which adds up exactly.
///
/// Headings of words that turn about U alone are those of the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heading3 {
    /// Rotation whose columns are H, L and U.
    turned: DMat3,
    about_up: u64,
}

impl Heading3 {
    /// Creates a heading from a rotation whose columns are H, L and U.
    pub(crate) fn of(turned: DMat3) -> Self {
        Self {
            turned,
            about_up: 0,
        }
    }

    fn about_up(about_up: u64) -> Self {
        Self {
            turned: DMat3::IDENTITY,
            about_up,
        }
    }

    /// Returns the rotation whose columns are H, L and U.
    pub(crate) fn rotation(&self, compass: Compass) -> DMat3 {
        let DVec2 { x, y } = compass.direction(self.about_up);
        let about_up = DMat3::from_cols(DVec3::new(x, y, 0.0), DVec3::new(-y, x, 0.0), DVec3::Z);
        match self.turned == DMat3::IDENTITY {
            true => about_up,
            false if self.about_up == 0 => self.turned,
            false => self.turned * about_up,
        }
    }

    /// Returns the turn as seen in a mirror that exchanges left and right.
    fn mirrored(&self, compass: Compass) -> Self {
        let flip = DMat3::from_diagonal(DVec3::new(1.0, -1.0, 1.0));
        Self {
            turned: flip * self.turned * flip,
            about_up: compass.back(self.about_up),
        }
    }
}

/// Returns the rotation near a product of rotations, whose rounding errors would double with every product of equal ones.
fn rotation_near(product: DMat3) -> DMat3 {
    const ROUNDING: f64 = 1e-13;
    let square = product.transpose() * product;
    match square.abs_diff_eq(DMat3::IDENTITY, ROUNDING) {
        true => product,
        // A step of Newton's method for the polar decomposition (Higham 1986).
        false => product * (DMat3::IDENTITY * 3.0 - square) * 0.5,
    }
}

/// Returns the vector with the opposite y coordinate if `mirrored`.
fn flipped(v: DVec3, mirrored: bool) -> DVec3 {
    if mirrored {
        DVec3::new(v.x, -v.y, v.z)
    } else {
        v
    }
}

impl TurtleFrame for Frame3 {
    type System = LSystemInSpace;
    type Heading = Heading3;

    const AHEAD: Heading3 = Heading3 {
        turned: DMat3::IDENTITY,
        about_up: 0,
    };

    fn words(system: &LSystemInSpace) -> &LSystem {
        &system.words
    }

    fn key(compass: Compass, heading: Heading3) -> [i64; 6] {
        const PARTS: f64 = 1e8;
        let rotation = heading.rotation(compass).to_cols_array();
        #[expect(clippy::cast_possible_truncation, reason = "entries are at most 1")]
        let key = |number: usize| (rotation[number] * PARTS).round() as i64;
        [0, 1, 2, 3, 4, 5].map(key)
    }

    fn start(system: &LSystemInSpace, compass: Compass) -> Heading3 {
        match system.start {
            Some(rotation) => Heading3::of(rotation),
            None => Heading3::about_up(compass.of_degrees(system.words.start)),
        }
    }

    fn stamps(system: &LSystemInSpace) -> &[Body] {
        &system.stamps
    }

    fn depends_on_the_way(system: &LSystemInSpace) -> bool {
        system.walked().is_some_and(|why| why != NoGraph::Contexts)
    }

    fn tube(system: &LSystemInSpace) -> Option<Tube> {
        system.tube()
    }

    fn tube_part(tube: Tube, part: TubePart) -> Body {
        tube.body(part)
    }

    fn stretched(&self, [along, across]: Stretch) -> Self {
        let map = *self.map() * DAffine3::from_scale(DVec3::new(along, across, across));
        Self::new(map, self.direction())
    }

    fn turn(compass: Compass, axis: Axis, angle: f64) -> Heading3 {
        let (cosine, sine) = (degrees::cos(angle), degrees::sin(angle));
        Heading3::of(match axis {
            Axis::Up => return Heading3::about_up(compass.of_degrees(angle)),
            Axis::Left => DMat3::from_cols(
                DVec3::new(cosine, 0.0, -sine),
                DVec3::Y,
                DVec3::new(sine, 0.0, cosine),
            ),
            Axis::Heading => DMat3::from_cols(
                DVec3::X,
                DVec3::new(0.0, cosine, sine),
                DVec3::new(0.0, -sine, cosine),
            ),
        })
    }

    fn after_turn(compass: Compass, heading: Heading3, turn: Heading3, mirrored: bool) -> Heading3 {
        let turn = if mirrored {
            turn.mirrored(compass)
        } else {
            turn
        };
        if turn.turned == DMat3::IDENTITY {
            let about_up = compass.sum(heading.about_up, turn.about_up);
            return Heading3 {
                about_up,
                ..heading
            };
        }
        Heading3 {
            turned: rotation_near(heading.rotation(compass) * turn.turned),
            about_up: turn.about_up,
        }
    }

    fn outward(compass: Compass, heading: Heading3, mirrored: bool, v: DVec3) -> DVec3 {
        heading.rotation(compass) * flipped(v, mirrored)
    }

    fn inward(compass: Compass, heading: Heading3, mirrored: bool, v: DVec3) -> DVec3 {
        flipped(heading.rotation(compass).transpose() * v, mirrored)
    }

    fn along(
        compass: Compass,
        heading: Heading3,
        mirrored: bool,
        from: DVec3,
        along: DVec3,
    ) -> Self {
        let rotation = heading.rotation(compass);
        let length = along.length();
        // An element that runs against the heading is turned about U.
        let ahead = length.copysign(rotation.x_axis.dot(along));
        let (left, direction) = match mirrored {
            true => (-ahead, Direction::YReflected),
            false => (ahead, Direction::Normal),
        };
        let linear = DMat3::from_cols(along, rotation.y_axis * left, rotation.z_axis * length);
        Self::new(DAffine3::from_mat3_translation(linear, from), direction)
    }

    fn levelled(compass: Compass, heading: Heading3) -> Heading3 {
        /// Sine of the angle to the vertical up to which a turtle is upright, but for the rounding of its turns.
        const UPRIGHT: f64 = 1e-12;
        let ahead = heading.rotation(compass).x_axis;
        // The y axis points up, against gravity.
        let left = DVec3::Y.cross(ahead);
        match left.try_normalize().filter(|_| left.length() > UPRIGHT) {
            Some(left) => Heading3::of(DMat3::from_cols(ahead, left, ahead.cross(left))),
            None => heading,
        }
    }

    fn bent(system: &LSystemInSpace, compass: Compass, heading: Heading3) -> Heading3 {
        match &system.tropism {
            Some(tropism) => {
                let rotation = heading.rotation(compass);
                let turn = tropism.turn(rotation.x_axis);
                if turn == DMat3::IDENTITY {
                    return heading;
                }
                Heading3::of(turn * rotation)
            }
            None => heading,
        }
    }

    fn line() -> Body {
        Body::line()
    }

    fn line_to(end: DVec3) -> Option<Body> {
        let line = Solid::hull(&[DVec3::ZERO, end]);
        Body::new(vec![line.into()], Vec::new(), false)
    }

    fn polygon(corners: &[DVec3]) -> Option<Body> {
        let surfaces = triangulated(corners).into_iter().map(Into::into);
        Body::new(surfaces.collect(), corners.to_vec(), false)
    }

    fn corners(polygon: &Body) -> Vec<DVec3> {
        polygon.face().to_vec()
    }

    fn spanning(&self, [from, to]: [DVec3; 2]) -> Self {
        let linear = self.map().matrix3;
        let along = to - from;
        let [own, other] = [linear.x_axis, along].map(DVec3::normalize_or_zero);
        let scale = along.length() / linear.x_axis.length();
        let (axis, cosine) = (own.cross(other), own.dot(other));
        // Rodrigues' formula; half a turn is one about the y axis of the frame.
        let turned = |v: DVec3| v + axis.cross(v) + axis.cross(axis.cross(v)) / (1.0 + cosine);
        let [left, up] = match cosine > -1.0 + 1e-9 {
            true => [linear.y_axis, linear.z_axis].map(turned),
            false => [linear.y_axis, -linear.z_axis],
        };
        let linear = DMat3::from_cols(along, left * scale, up * scale);
        Self::new(
            DAffine3::from_mat3_translation(linear, from),
            self.direction(),
        )
    }
}
