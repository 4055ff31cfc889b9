//! Numbers and points as written in files, with their places.

use crate::diagnostic::Place;
use crate::expression::Expression;

/// A value with its source span.
#[derive(Clone, Debug)]
pub struct Written<T> {
    /// The value.
    pub value: T,
    /// Source span of the value.
    pub place: Place,
}

/// A number as written: an expression.
pub type WrittenNumber = Written<Expression>;

/// A point as written.
#[derive(Clone, Debug)]
pub struct WrittenPoint {
    /// First coordinate, to the right.
    pub x: WrittenNumber,
    /// Second coordinate, upwards.
    pub y: WrittenNumber,
    /// Third coordinate, towards the viewer; `None` in the plane, and where it is left out.
    pub z: Option<Box<WrittenNumber>>,
    /// Source span of the point.
    pub place: Place,
}

impl WrittenPoint {
    /// Returns a placeholder for a point that cannot be read.
    pub(crate) fn unknown(place: &Place) -> Self {
        let unknown = || Written {
            value: Expression::unknown(),
            place: place.clone(),
        };
        Self {
            x: unknown(),
            y: unknown(),
            z: None,
            place: place.clone(),
        }
    }

    /// Returns whether the expressions of all coordinates are written alike; a third one that is left out is 0.
    #[must_use]
    pub fn is_written_like(&self, other: &Self) -> bool {
        let third = match (&self.z, &other.z) {
            (None, None) => true,
            (Some(z), None) | (None, Some(z)) => z.value == Expression::number(0.0),
            (Some(own), Some(other)) => own.value == other.value,
        };
        third && self.x.value == other.x.value && self.y.value == other.y.value
    }
}
