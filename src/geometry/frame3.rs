//! Frames in space: a map of the unit frame, and a direction.

use glam::{DAffine3, DMat3, DVec3};

use super::linear::stretch3;
use super::{Bounds, Corners, Direction, Frame, Solid};

/// The frame of an element in space: the map from the unit frame, and the direction along the element's path.
///
/// x points to the right, y up and z towards the viewer. In the unit frame the element runs from (0, 0, 0) to
/// (1, 0, 0).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame3 {
    map: DAffine3,
    direction: Direction,
}

impl Frame3 {
    /// The unit frame itself.
    pub const UNIT: Self = Self {
        map: DAffine3::IDENTITY,
        direction: Direction::Normal,
    };

    /// Creates a frame from the map of the unit frame to space and the product of the directions along the
    /// element's path.
    #[must_use]
    pub const fn new(map: DAffine3, direction: Direction) -> Self {
        Self { map, direction }
    }

    /// Returns the map from the unit frame to space.
    #[inline]
    #[must_use]
    pub fn map(&self) -> &DAffine3 {
        &self.map
    }
}

impl Frame for Frame3 {
    type Point = DVec3;
    type Map = DAffine3;
    type Outline = Solid;
    type Corners = Vec<DVec3>;

    const UNIT: Self = Self::UNIT;

    #[inline]
    fn compose(&self, inner: &Self) -> Self {
        Self {
            map: self.map * inner.map,
            direction: self.direction * inner.direction,
        }
    }

    #[inline]
    fn map(&self) -> &DAffine3 {
        &self.map
    }

    #[inline]
    fn direction(&self) -> Direction {
        self.direction
    }

    #[inline]
    fn with_direction(&self, direction: Direction) -> Self {
        Self { direction, ..*self }
    }

    #[inline]
    fn origin(&self) -> DVec3 {
        self.map.translation
    }

    #[inline]
    fn moved_to(&self, origin: DVec3) -> Self {
        let map = DAffine3::from_mat3_translation(self.map.matrix3, origin);
        Self { map, ..*self }
    }

    #[inline]
    fn apply(&self, point: DVec3) -> DVec3 {
        self.map.transform_point3(point)
    }

    #[inline]
    fn pullback(&self, functional: DVec3) -> DVec3 {
        self.map.matrix3.transpose() * functional
    }

    fn ends(&self) -> [DVec3; 2] {
        let origin = self.map.translation;
        let unit = origin + self.map.matrix3.x_axis;
        if self.direction.is_reversed() {
            [unit, origin]
        } else {
            [origin, unit]
        }
    }

    fn length(&self) -> f64 {
        self.map.matrix3.x_axis.length()
    }

    fn stretch(&self) -> f64 {
        stretch3(&self.map.matrix3)
    }

    fn area(&self) -> f64 {
        let linear = self.map.matrix3;
        linear.x_axis.cross(linear.y_axis).length()
    }

    fn is_similarity(&self, ratio: f64) -> bool {
        const ROUNDING: f64 = 1e-12;
        let square = ratio * ratio;
        let linear = self.map.matrix3;
        let own = linear.transpose() * linear;
        own.abs_diff_eq(DMat3::IDENTITY * square, ROUNDING * square)
    }

    fn is_in_range(&self) -> bool {
        const LARGEST: f64 = 1e150;
        let linear = self.map.matrix3;
        let all = [
            linear.x_axis,
            linear.y_axis,
            linear.z_axis,
            self.map.translation,
        ];
        // Minima and maxima ignore NaN.
        all.iter()
            .all(|vector| vector.abs().max_element() < LARGEST)
            && self.map.is_finite()
    }
}

impl From<DAffine3> for Frame3 {
    /// Creates a frame from a map, with the direction [`Normal`](Direction::Normal).
    fn from(map: DAffine3) -> Self {
        Self::new(map, Direction::Normal)
    }
}

impl Corners<Frame3> for Vec<DVec3> {
    fn add(&mut self, corner: DVec3) {
        self.push(corner);
    }

    fn add_to(&self, bounds: &mut Bounds<DVec3>, frame: &Frame3) {
        for corner in self {
            bounds.add(frame.apply(*corner));
        }
    }
}
