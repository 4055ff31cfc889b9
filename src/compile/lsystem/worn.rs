//! State that an object inherits from the objects around it, as far as its drawing depends on it.

use crate::instancing::Thickness;
use crate::lsystem::{TubeLine, TurtleFrame};

use super::reader::DrawnPart;
use super::state::Tip;

/// Colour, and what tubes depend on: numbers by their bits.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Worn {
    pub(super) colour: i64,
    /// Length of a step.
    step: u64,
    width: u64,
    /// Width at the end of the line before, if there is one.
    tip: Option<u64>,
    is_bent: bool,
}

impl Worn {
    /// State of the turtle at the start; the length of its steps is in its pose.
    pub(super) const START: Self = Self {
        colour: 0,
        step: 1f64.to_bits(),
        width: 1f64.to_bits(),
        tip: None,
        is_bent: false,
    };

    /// Returns the length of a step.
    pub(super) fn step(&self) -> f64 {
        f64::from_bits(self.step).abs()
    }

    fn width(&self, of: Thickness) -> f64 {
        match of {
            Thickness::Times(factor) => f64::from_bits(self.width) * factor,
            Thickness::Set(width) => width,
        }
    }

    /// Returns the state of the subtree that is a part of an object with this state, apart from its colour.
    pub(super) fn inside<F: TurtleFrame>(&self, part: &DrawnPart<F>) -> Self {
        Self {
            colour: 0,
            step: (f64::from_bits(self.step) * part.pose.scale).to_bits(),
            width: self.width(part.attributes.width).to_bits(),
            tip: match part.joint.tip {
                Tip::Kept => self.tip,
                Tip::Free => None,
                Tip::Ends(width) => Some(self.width(width).to_bits()),
            },
            is_bent: part.joint.bent.unwrap_or(self.is_bent),
        }
    }

    /// Returns the line that is a part of an object with this state, for a tube.
    pub(super) fn line<F: TurtleFrame>(&self, part: &DrawnPart<F>) -> TubeLine {
        let Self {
            step,
            width,
            tip,
            is_bent,
            ..
        } = self.inside(part);
        let width = f64::from_bits(width);
        TubeLine {
            length: f64::from_bits(step).abs(),
            widths: [tip.map_or(width, f64::from_bits), width],
            is_bent,
        }
    }
}
