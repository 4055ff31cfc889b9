//! Frames: the placement of an element in the plane, as a map of the unit frame and a direction.

use glam::{DAffine2, DMat2, DVec2};

use super::Direction;

/// Message for an element whose frame is not [in range](Frame::is_in_range).
pub const BEYOND: &str = "an element lies beyond the range of numbers";

/// The frame of an element: the map from the unit frame, and the direction along the element's path.
///
/// In the unit frame the element runs from (0, 0) to (1, 0). With the first and last point of traversal p0
/// and p1 and the direction d, the map is M(z) = p0 + (p1 − p0)·τ_d(z).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The map from the unit frame to the plane.
    pub map: DAffine2,
    /// The product of the directions along the path.
    pub direction: Direction,
}

impl Frame {
    /// The unit frame itself.
    pub const UNIT: Self = Self {
        map: DAffine2::IDENTITY,
        direction: Direction::Normal,
    };

    /// Returns the frame of an element that runs from `from` to `to`, as listed, with a direction.
    #[must_use]
    pub fn between(from: DVec2, to: DVec2, direction: Direction) -> Self {
        Self {
            map: placement(from, to, direction),
            direction,
        }
    }

    /// Returns the frame, in the plane, of an element whose frame relative to this one is `inner`.
    #[inline]
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        Self {
            map: self.map * inner.map,
            direction: self.direction * inner.direction,
        }
    }

    /// Returns the first and the last point of traversal, p0 and p1.
    #[inline]
    #[must_use]
    pub fn ends(&self) -> [DVec2; 2] {
        let origin = self.map.translation;
        let unit = origin + self.map.matrix2.x_axis;
        if self.direction.is_reversed() {
            [unit, origin]
        } else {
            [origin, unit]
        }
    }

    /// Returns `true` if the squares of all entries of the map are within the range of doubles, as lengths
    /// and areas need.
    #[inline]
    #[must_use]
    pub fn is_in_range(&self) -> bool {
        const LARGEST: f64 = 1e150;
        let largest = self.map.translation.abs().max_element();
        let linear = self.map.matrix2;
        let largest = largest.max(linear.x_axis.abs().max(linear.y_axis.abs()).max_element());
        // Minima and maxima ignore NaN.
        largest < LARGEST && self.map.is_finite()
    }

    /// Returns |p1 − p0|.
    #[inline]
    #[must_use]
    pub fn length(&self) -> f64 {
        let axis = self.map.matrix2.x_axis;
        let length = axis.length();
        if length.is_finite() {
            length
        } else {
            // The square alone may overflow.
            libm::hypot(axis.x, axis.y)
        }
    }

    /// Returns the largest factor by which the map lengthens a vector: its larger singular value. For a
    /// similarity it is the length.
    #[inline]
    #[must_use]
    pub fn stretch(&self) -> f64 {
        stretch(&self.map.matrix2)
    }
}

/// Returns the larger singular value of a linear map: the largest factor by which it lengthens a vector.
#[inline]
pub(crate) fn stretch(matrix: &DMat2) -> f64 {
    let (x, y) = (matrix.x_axis, matrix.y_axis);
    // The components that preserve and that reverse the sense of rotation; one is zero for a similarity.
    let kept = DVec2::new(x.x + y.y, x.y - y.x).length_squared();
    let reversed = DVec2::new(x.x - y.y, x.y + y.x).length_squared();
    if reversed == 0.0 {
        kept.sqrt() / 2.0
    } else {
        (kept.sqrt() + reversed.sqrt()) / 2.0
    }
}

/// Returns the similarity z → from + (to − from)·τ_d(z) that puts an element of a generator into place.
#[must_use]
pub fn placement(from: DVec2, to: DVec2, direction: Direction) -> DAffine2 {
    let along = to - from;
    let across = along.perp();
    let (x_axis, y_axis, origin) = match direction {
        Direction::Normal => (along, across, from),
        Direction::YReflected => (along, -across, from),
        Direction::XReflected => (-along, across, to),
        Direction::BothReflected => (-along, -across, to),
    };
    DAffine2::from_mat2_translation(DMat2::from_cols(x_axis, y_axis), origin)
}
