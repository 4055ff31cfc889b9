//! Axis-parallel boxes.

use super::{DVec2, Point};

/// An axis-parallel box in the plane or in space; empty until a point is added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<P = DVec2> {
    min: P,
    max: P,
}

impl<P: Point> Bounds<P> {
    /// The empty box.
    pub const EMPTY: Self = Self {
        min: P::INFINITY,
        max: P::NEG_INFINITY,
    };

    /// Creates the smallest box that holds two opposite corners.
    #[must_use]
    pub fn new(a: P, b: P) -> Self {
        Self {
            min: a.min(b),
            max: a.max(b),
        }
    }

    /// Returns the corner of the least coordinates: in the plane, the lower left one.
    #[must_use]
    pub fn min(&self) -> P {
        self.min
    }

    /// Returns the corner of the largest coordinates: in the plane, the upper right one.
    #[must_use]
    pub fn max(&self) -> P {
        self.max
    }

    /// Returns the lengths of the sides: in the plane, width and height; all zero if the box is empty.
    #[must_use]
    pub fn size(&self) -> P {
        if self.is_empty() {
            P::ZERO
        } else {
            self.max - self.min
        }
    }

    /// Returns the centre of the box; not finite if the box is empty.
    #[must_use]
    pub fn centre(&self) -> P {
        (self.min + self.max) / 2.0
    }

    /// Returns `true` if the box holds no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        let [min, max] = [self.min, self.max].map(P::coordinates);
        min.iter().zip(max).any(|(min, max)| *min > max)
    }

    /// Returns `true` if all coordinates are finite, which those of an empty box are not.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// Returns `true` if the two boxes have a point in common.
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        let at_most = |a: P, b: P| {
            let (a, b) = (a.coordinates(), b.coordinates());
            a.iter().zip(b).all(|(a, b)| *a <= b)
        };
        at_most(self.min, other.max) && at_most(other.min, self.max)
    }

    /// Returns `true` if the box holds all of another box.
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        let mut all = *self;
        all.add_all(other);
        all == *self
    }

    /// Returns the box of the points that lie in both boxes.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        Self {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        }
    }

    /// Extends the box to hold a point.
    #[inline]
    pub fn add(&mut self, point: P) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// Extends the box to hold another box.
    pub fn add_all(&mut self, other: &Self) {
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }
}
