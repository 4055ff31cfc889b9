//! Axis-parallel boxes.

use glam::DVec2;

/// An axis-parallel box; empty until a point is added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    min: DVec2,
    max: DVec2,
}

impl Bounds {
    /// The empty box.
    pub const EMPTY: Self = Self {
        min: DVec2::INFINITY,
        max: DVec2::NEG_INFINITY,
    };

    /// Creates the smallest box that holds two opposite corners.
    #[must_use]
    pub fn new(a: DVec2, b: DVec2) -> Self {
        Self {
            min: a.min(b),
            max: a.max(b),
        }
    }

    /// Returns the lower left corner.
    #[must_use]
    pub fn min(&self) -> DVec2 {
        self.min
    }

    /// Returns the upper right corner.
    #[must_use]
    pub fn max(&self) -> DVec2 {
        self.max
    }

    /// Returns the width and the height; zero in both if the box is empty.
    #[must_use]
    pub fn size(&self) -> DVec2 {
        if self.is_empty() {
            DVec2::ZERO
        } else {
            self.max - self.min
        }
    }

    /// Returns `true` if the box holds no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.min.x > self.max.x || self.min.y > self.max.y
    }

    /// Returns `true` if all four coordinates are finite, which those of an empty box are not.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// Returns `true` if the two boxes have a point in common.
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Extends the box to hold a point.
    #[inline]
    pub fn add(&mut self, point: DVec2) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// Extends the box to hold another box.
    pub fn add_all(&mut self, other: &Self) {
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }
}
