use crate::geometry::{DAffine2, DMat2, DVec2, Direction, Frame};
use crate::instancing::Thickness;
use crate::lsystem::Compass;

use super::far::Far;

/// Where the turtle stands, from where it was: in steps, with the heading that it had to the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) place: Far,
    /// As its compass has it: exact.
    pub(super) heading: u64,
    pub(super) mirrored: bool,
    /// The length of its steps, as a multiple of what it was; negative if they go backwards.
    pub(super) scale: f64,
    /// How far it has gone at most, and whether place and heading are not known any better.
    pub(super) way: Far,
    pub(super) is_rough: bool,
}

/// How the turtle draws, from how it drew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Look {
    pub(super) width: Thickness,
    pub(super) colour: Shade,
}

/// The index of a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shade {
    /// So many further on.
    Shifted(i64),
    /// This one, whatever it was.
    Set(i64),
}

/// Where the turtle is and how it draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State {
    pub(super) pose: Pose,
    pub(super) look: Look,
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

    /// Whether another pose is the same, however the turtle came there.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        let [a, b] = [self, other];
        (a.place, a.heading, a.mirrored) == (b.place, b.heading, b.mirrored) && !b.is_rough
    }

    /// A vector that is told by where the turtle looks.
    fn turned(&self, compass: Compass, vector: Far) -> Far {
        let along = compass.direction(self.heading);
        let mirrored = self.mirrored;
        vector.turned(|v| along.rotate(if mirrored { DVec2::new(v.x, -v.y) } else { v }))
    }

    /// Goes so many steps ahead.
    pub(super) fn go(&mut self, compass: Compass, steps: f64) {
        let ahead = Far::new(DVec2::X).times(steps).times(self.scale);
        self.place = self.place.plus(self.turned(compass, ahead));
        self.way = self.way.plus(ahead.length());
    }

    /// How far from where it started it is at most.
    pub(super) fn away(&self) -> Far {
        if self.is_rough {
            self.way
        } else {
            self.place.length()
        }
    }

    /// Turns by parts of the compass, counter-clockwise where it is not mirrored.
    pub(super) fn turn(&mut self, compass: Compass, turn: u64) {
        let turn = if self.mirrored {
            compass.back(turn)
        } else {
            turn
        };
        self.heading = compass.sum(self.heading, turn);
    }

    /// Where the turtle is after going on as another pose tells.
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

    /// A place as the turtle sees it from here, in its steps.
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

    /// The frame of what stands here and is so many steps long, where a length is the unit.
    pub(super) fn frame(&self, compass: Compass, steps: Far, unit: Far) -> Frame {
        let x_axis = self.turned(compass, steps.times(self.scale)).over(unit);
        let (y_axis, direction) = if self.mirrored {
            (-x_axis.perp(), Direction::YReflected)
        } else {
            (x_axis.perp(), Direction::Normal)
        };
        let matrix = DMat2::from_cols(x_axis, y_axis);
        Frame {
            map: DAffine2::from_mat2_translation(matrix, self.place.over(unit)),
            direction,
        }
    }
}

impl Look {
    /// Nothing changes.
    pub(super) const SAME: Self = Self {
        width: Thickness::Times(1.0),
        colour: Shade::Shifted(0),
    };

    /// What the turtle starts with.
    pub(super) const START: Self = Self {
        width: Thickness::Set(1.0),
        colour: Shade::Set(0),
    };

    /// How the turtle draws after another change.
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
    /// The index, from what it was.
    pub(super) fn from(self, index: i64) -> i64 {
        match self {
            Self::Shifted(by) => index.saturating_add(by),
            Self::Set(index) => index,
        }
    }
}

impl State {
    /// Nothing changes.
    pub(super) const SAME: Self = Self {
        pose: Pose::START,
        look: Look::SAME,
    };

    /// What another state, told from this one, is.
    pub(super) fn then(&self, compass: Compass, next: &Self) -> Self {
        Self {
            pose: self.pose.then(compass, &next.pose),
            look: self.look.then(next.look),
        }
    }
}
