//! States of the turtle relative to an earlier state.

use crate::geometry::{DAffine2, DMat2, DVec2, Direction, Frame2};
use crate::instancing::Thickness;
use crate::lsystem::Compass;

use super::far::Far;

/// Pose of the turtle relative to an earlier one: in its steps, with its former heading along the x axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) place: Far,
    /// Heading in units of the compass: exact.
    pub(super) heading: u64,
    pub(super) mirrored: bool,
    /// Length of its steps relative to the former length; negative if they go backwards.
    pub(super) scale: f64,
    /// Bound on the distance that it has covered.
    pub(super) way: Far,
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

/// Pose and stroke attributes of the turtle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TurtleState {
    pub(super) pose: Pose,
    pub(super) attributes: StrokeAttributes,
}

impl Pose {
    const START: Self = Self {
        place: Far::ZERO,
        heading: 0,
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
    fn turned(&self, compass: Compass, vector: Far) -> Far {
        let along = compass.direction(self.heading);
        let mirrored = self.mirrored;
        vector.turned(|v| along.rotate(if mirrored { DVec2::new(v.x, -v.y) } else { v }))
    }

    /// Moves a number of steps ahead.
    pub(super) fn go(&mut self, compass: Compass, steps: f64) {
        let ahead = Far::new(DVec2::X).times(steps).times(self.scale);
        self.place = self.place.plus(self.turned(compass, ahead));
        self.way = self.way.plus(ahead.length());
    }

    /// Returns a bound on the distance from the start.
    pub(super) fn away(&self) -> Far {
        if self.is_rough {
            self.way
        } else {
            self.place.length()
        }
    }

    /// Turns by units of the compass, counter-clockwise unless mirrored.
    pub(super) fn turn(&mut self, compass: Compass, turn: u64) {
        let turn = if self.mirrored {
            compass.back(turn)
        } else {
            turn
        };
        self.heading = compass.sum(self.heading, turn);
    }

    /// Composes the pose with another relative to it.
    pub(super) fn then(mut self, compass: Compass, next: &Self) -> Self {
        let way = self.turned(compass, next.place.times(self.scale));
        self.place = self.place.plus(way);
        self.turn(compass, next.heading);
        self.mirrored ^= next.mirrored;
        self.way = self.way.plus(next.away().times(self.scale).length());
        self.is_rough |= next.is_rough;
        self.scale *= next.scale;
        self
    }

    /// Returns a position in the coordinates of the turtle, in its steps.
    pub(super) fn seen(&self, compass: Compass, place: Far) -> DVec2 {
        let along = compass.direction(self.heading);
        let back = DVec2::new(along.x, -along.y);
        let from = place.plus(self.place.times(-1.0));
        let v = from.over(Far::of_length(self.scale)) * self.scale.signum();
        let v = back.rotate(v);
        if self.mirrored {
            DVec2::new(v.x, -v.y)
        } else {
            v
        }
    }

    /// Returns the frame, in multiples of `unit`, of an object at this pose whose length is `steps`.
    pub(super) fn frame(&self, compass: Compass, steps: Far, unit: Far) -> Frame2 {
        let x_axis = self.turned(compass, steps.times(self.scale)).over(unit);
        let (y_axis, direction) = if self.mirrored {
            (-x_axis.perp(), Direction::YReflected)
        } else {
            (x_axis.perp(), Direction::Normal)
        };
        let matrix = DMat2::from_cols(x_axis, y_axis);
        let map = DAffine2::from_mat2_translation(matrix, self.place.over(unit));
        Frame2::new(map, direction)
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
        let width = match (self.width, next.width) {
            (Thickness::Times(a), Thickness::Times(b)) => Thickness::Times(a * b),
            (Thickness::Set(a), Thickness::Times(b)) => Thickness::Set(a * b),
            (_, set) => set,
        };
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

impl TurtleState {
    /// Identity: pose and attributes are unchanged.
    pub(super) const SAME: Self = Self {
        pose: Pose::START,
        attributes: StrokeAttributes::SAME,
    };

    /// Composes the state with another relative to it.
    pub(super) fn then(&self, compass: Compass, next: &Self) -> Self {
        Self {
            pose: self.pose.then(compass, &next.pose),
            attributes: self.attributes.then(next.attributes),
        }
    }
}
