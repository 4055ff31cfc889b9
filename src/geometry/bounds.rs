//! Axis-parallel boxes.

use glam::DVec2;

/// A box with sides along the axes; empty until a point is added.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    min: DVec2,
    max: DVec2,
}

impl Bounds {
    /// The box of no points.
    pub const EMPTY: Self = Self {
        min: DVec2::INFINITY,
        max: DVec2::NEG_INFINITY,
    };

    /// The box between two corners.
    #[must_use]
    pub fn new(a: DVec2, b: DVec2) -> Self {
        Self {
            min: a.min(b),
            max: a.max(b),
        }
    }

    /// The lower left corner.
    #[must_use]
    pub fn min(&self) -> DVec2 {
        self.min
    }

    /// The upper right corner.
    #[must_use]
    pub fn max(&self) -> DVec2 {
        self.max
    }

    /// Width and height; zero in both if the box is empty.
    #[must_use]
    pub fn size(&self) -> DVec2 {
        if self.is_empty() {
            DVec2::ZERO
        } else {
            self.max - self.min
        }
    }

    /// Whether no point has been added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.min.x > self.max.x || self.min.y > self.max.y
    }

    /// Whether all four coordinates are finite numbers and the box holds a point.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// Whether two boxes have a point in common.
    #[must_use]
    pub fn meets(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Makes room for a point.
    #[inline]
    pub fn add(&mut self, point: DVec2) {
        self.min = self.min.min(point);
        self.max = self.max.max(point);
    }

    /// Makes the box as large as it must be to hold another one.
    pub fn add_all(&mut self, other: &Self) {
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }
}
