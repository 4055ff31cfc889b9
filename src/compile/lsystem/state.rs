//! States of the turtle relative to an earlier state.

use crate::geometry::{Frame2, Point as _};
use crate::instancing::Thickness;
use crate::lsystem::{Axis, Compass, TurtleFrame};

use super::far::Far;

/// Pose of the turtle relative to an earlier one: in its steps, with its former heading along the x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose<F: TurtleFrame = Frame2> {
    pub(super) place: Far<F::Point>,
    /// Heading: exact in the plane.
    pub(super) heading: F::Heading,
    pub(super) mirrored: bool,
    /// Length of its steps relative to the former length; negative if they go backwards.
    pub(super) scale: f64,
    /// Bound on the distance that it has covered.
    pub(super) way: Far<F::Point>,
    /// Whether draws leave position and heading unknown: only the bound holds then.
    pub(super) is_rough: bool,
}

/// Stroke attributes relative to earlier ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StrokeAttributes {
    pub(super) width: Thickness,
    pub(super) colour: Shade,
}

/// Colour index relative to an earlier one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shade {
    /// Earlier index plus a number.
    Shifted(i64),
    /// Index regardless of the earlier one.
    Set(i64),
}

/// Beginning of the next tube relative to an earlier state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Joint {
    pub(super) tip: Tip,
    /// Whether the turtle has turned since the last line; `None` if as before.
    pub(super) bent: Option<bool>,
}

/// Width at the end of the line that ends where the turtle is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Tip {
    /// As before.
    Kept,
    /// No line of the branch ends there.
    Free,
    /// Width relative to the earlier one.
    Ends(Thickness),
}

/// Pose and stroke attributes of the turtle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TurtleState<F: TurtleFrame = Frame2> {
    pub(super) pose: Pose<F>,
    pub(super) attributes: StrokeAttributes,
    pub(super) joint: Joint,
}

impl<F: TurtleFrame> Pose<F> {
    const START: Self = Self {
        place: Far::ZERO,
        heading: F::AHEAD,
        mirrored: false,
        scale: 1.0,
        way: Far::ZERO,
        is_rough: false,
    };

    /// Returns whether another pose is known to be equal, regardless of the distance covered.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let [a, b] = [self, other];
        (a.place, a.heading, a.mirrored) == (b.place, b.heading, b.mirrored) && !b.is_rough
    }

    /// Converts a vector from the turtle's coordinates to those of the earlier pose, without scaling.
    fn turned(&self, compass: Compass, vector: Far<F::Point>) -> Far<F::Point> {
        vector.turned(|v| F::outward(compass, self.heading, self.mirrored, v))
    }

    /// Moves a number of steps ahead.
    pub(super) fn go(&mut self, compass: Compass, steps: f64) {
        let ahead = Far::new(F::Point::AXES[0]).times(steps).times(self.scale);
        self.place = self.place.plus(self.turned(compass, ahead));
        self.way = self.way.plus(ahead.length());
    }

    /// Returns a bound on the distance from the start.
    pub(super) fn away(&self) -> Far<F::Point> {
        if self.is_rough {
            self.way
        } else {
            self.place.length()
        }
    }

    /// Turns about an axis by an angle in degrees.
    pub(super) fn turn(&mut self, compass: Compass, axis: Axis, angle: f64) {
        self.turn_by(compass, F::turn(compass, axis, angle));
    }

    fn turn_by(&mut self, compass: Compass, turn: F::Heading) {
        self.heading = F::after_turn(compass, self.heading, turn, self.mirrored);
    }

    /// Composes the pose with another relative to it.
    pub(super) fn then(mut self, compass: Compass, next: &Self) -> Self {
        let way = self.turned(compass, next.place.times(self.scale));
        self.place = self.place.plus(way);
        self.turn_by(compass, next.heading);
        self.mirrored ^= next.mirrored;
        self.way = self.way.plus(next.away().times(self.scale).length());
        self.is_rough |= next.is_rough;
        self.scale *= next.scale;
        self
    }

    /// Returns a position in the coordinates of the turtle, in its steps.
    pub(super) fn seen(&self, compass: Compass, place: Far<F::Point>) -> F::Point {
        let from = place.plus(self.place.times(-1.0));
        let v = from.over(Far::of_length(self.scale)) * self.scale.signum();
        F::inward(compass, self.heading, self.mirrored, v)
    }

    /// Returns the frame, in multiples of `unit`, of an object at this pose whose length is `steps`.
    pub(super) fn frame(&self, compass: Compass, steps: Far<F::Point>, unit: Far<F::Point>) -> F {
        let along = self.turned(compass, steps.times(self.scale)).over(unit);
        let place = self.place.over(unit);
        F::along(compass, self.heading, self.mirrored, place, along)
    }
}

impl StrokeAttributes {
    /// Identity: attributes are unchanged.
    pub(super) const SAME: Self = Self {
        width: Thickness::Times(1.0),
        colour: Shade::Shifted(0),
    };

    /// Initial attributes.
    pub(super) const START: Self = Self {
        width: Thickness::Set(1.0),
        colour: Shade::Set(0),
    };

    /// Composes the attributes with others relative to them.
    pub(super) fn then(self, next: Self) -> Self {
        let width = composed(self.width, next.width);
        let colour = match (self.colour, next.colour) {
            (Shade::Shifted(a), Shade::Shifted(b)) => Shade::Shifted(a.saturating_add(b)),
            (Shade::Set(a), Shade::Shifted(b)) => Shade::Set(a.saturating_add(b)),
            (_, set) => set,
        };
        Self { width, colour }
    }
}

impl Shade {
    /// Returns the index, given the earlier one.
    pub(super) fn from(self, index: i64) -> i64 {
        match self {
            Self::Shifted(by) => index.saturating_add(by),
            Self::Set(index) => index,
        }
    }
}

impl Joint {
    /// Identity: as before.
    pub(super) const SAME: Self = Self {
        tip: Tip::Kept,
        bent: None,
    };

    /// Joint of the turtle at the start.
    pub(super) const START: Self = Self {
        tip: Tip::Free,
        bent: Some(false),
    };

    /// Composes the joint, where the turtle has a width, with another relative to it.
    fn then(self, width: Thickness, next: Self) -> Self {
        Self {
            tip: match next.tip {
                Tip::Kept => self.tip,
                Tip::Free => Tip::Free,
                Tip::Ends(end) => Tip::Ends(composed(width, end)),
            },
            bent: next.bent.or(self.bent),
        }
    }
}

/// Composes a change of width with another relative to it.
fn composed(first: Thickness, next: Thickness) -> Thickness {
    match (first, next) {
        (Thickness::Times(a), Thickness::Times(b)) => Thickness::Times(a * b),
        (Thickness::Set(a), Thickness::Times(b)) => Thickness::Set(a * b),
        (_, set) => set,
    }
}

impl<F: TurtleFrame> TurtleState<F> {
    /// Identity: pose and attributes are unchanged.
    pub(super) const SAME: Self = Self {
        pose: Pose::START,
        attributes: StrokeAttributes::SAME,
        joint: Joint::SAME,
    };

    /// Composes the state with another relative to it.
    pub(super) fn then(&self, compass: Compass, next: &Self) -> Self {
        Self {
            pose: self.pose.then(compass, &next.pose),
            attributes: self.attributes.then(next.attributes),
            joint: self.joint.then(self.attributes.width, next.joint),
        }
    }
}
