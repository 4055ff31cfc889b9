//! Frames in the plane: a map of the unit frame, and a direction.

use glam::{DAffine2, DMat2, DVec2};

use super::frame::LARGEST_ENTRY;
use super::{BaseElement, Corners2, Direction, Frame, Homothety};

/// The frame of an element in the plane: the map from the unit frame, and the direction along the element's path.
///
/// In the unit frame the element runs from (0, 0) to (1, 0). With the first and last point of traversal p0
/// and p1 and the direction d, the map of a similarity is M(z) = p0 + (p1 − p0)·τ_d(z).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Frame2 {
    map: DAffine2,
    direction: Direction,
}

impl Frame2 {
    /// The unit frame itself.
    pub const UNIT: Self = Self {
        map: DAffine2::IDENTITY,
        direction: Direction::Normal,
    };

    /// Creates a frame from the map of the unit frame to the plane and the product of the directions along
    /// the element's path.
    #[inline]
    #[must_use]
    pub const fn new(map: DAffine2, direction: Direction) -> Self {
        Self { map, direction }
    }

    /// Returns the frame of an element that runs from `from` to `to`, as listed, with a direction: the map is
    /// the similarity z → from + (to − from)·τ_d(z).
    #[must_use]
    pub fn between(from: DVec2, to: DVec2, direction: Direction) -> Self {
        let along = to - from;
        let across = along.perp();
        // A reflection of z does nothing in the plane.
        let [x, y, _] = direction.reflected();
        let (x_axis, origin) = if x { (-along, to) } else { (along, from) };
        let y_axis = if y { -across } else { across };
        let linear = DMat2::from_cols(x_axis, y_axis);
        Self::new(DAffine2::from_mat2_translation(linear, origin), direction)
    }

    /// Returns the map from the unit frame to the plane.
    ///
    /// Only code that is bound to the plane needs it: outlines, drawing, and exact or numeric measures. Other
    /// code asks the frame itself, as for [`apply`](Self::apply), [`origin`](Self::origin) and
    /// [`stretch`](Self::stretch).
    #[inline]
    #[must_use]
    pub fn map(&self) -> &DAffine2 {
        &self.map
    }

    /// Returns the product of the directions along the element's path.
    #[inline]
    #[must_use]
    pub fn direction(&self) -> Direction {
        self.direction
    }

    /// Returns the image of (0, 0).
    #[inline]
    #[must_use]
    pub fn origin(&self) -> DVec2 {
        self.map.translation
    }

    /// Returns the image of a point of the unit frame.
    #[inline]
    #[must_use]
    pub fn apply(&self, point: DVec2) -> DVec2 {
        self.map.transform_point2(point)
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

    /// Returns the frame with another direction and an unchanged map.
    #[inline]
    #[must_use]
    pub fn with_direction(&self, direction: Direction) -> Self {
        Self { direction, ..*self }
    }

    /// Returns the frame translated to another origin.
    #[inline]
    #[must_use]
    pub fn moved_to(&self, origin: DVec2) -> Self {
        Self {
            map: DAffine2::from_mat2_translation(self.map.matrix2, origin),
            ..*self
        }
    }

    /// Returns the frame with the conjugate h M h⁻¹ of its map M; see [`Homothety::around`].
    #[must_use]
    pub fn conjugated(&self, homothety: &Homothety) -> Self {
        Self {
            map: homothety.around(&self.map),
            ..*self
        }
    }

    /// Returns the frame that a homothety h maps to this one: its map is h⁻¹ M.
    #[must_use]
    pub fn preimage(&self, homothety: &Homothety) -> Self {
        let linear = homothety.backwards().matrix2 * self.map.matrix2;
        let origin = homothety.origin_of(self.map.translation);
        Self {
            map: DAffine2::from_mat2_translation(linear, origin),
            ..*self
        }
    }

    /// Returns the image under a map of the plane.
    #[must_use]
    pub(crate) fn mapped(&self, map: &DAffine2) -> Self {
        Self {
            map: *map * self.map,
            ..*self
        }
    }

    /// Returns the image under an isometry. The direction of the image of a similarity is that of its map, unless
    /// `keeps_direction`.
    #[must_use]
    pub(crate) fn image(&self, isometry: &DAffine2, keeps_direction: bool) -> Self {
        let is_mirrored = isometry.matrix2.determinant() < 0.0 && !keeps_direction;
        let across = match is_mirrored {
            true => Direction::YReflected,
            false => Direction::Normal,
        };
        self.mapped(isometry)
            .with_direction(self.direction * across)
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
        let largest = self.map.translation.abs().max_element();
        let linear = self.map.matrix2;
        let largest = largest.max(linear.x_axis.abs().max(linear.y_axis.abs()).max_element());
        // Minima and maxima ignore NaN.
        largest < LARGEST_ENTRY && self.map.is_finite()
    }

    /// Returns `true` if no entry of the map is infinite or NaN.
    #[inline]
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.map.is_finite()
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

    /// Returns the area of the image of the unit square: the factor by which the map changes areas.
    #[inline]
    #[must_use]
    pub fn area(&self) -> f64 {
        self.map.matrix2.determinant().abs()
    }

    /// Returns the largest factor by which the map lengthens a vector: its larger singular value. For a
    /// similarity it is the length.
    #[inline]
    #[must_use]
    pub fn stretch(&self) -> f64 {
        stretch(&self.map.matrix2)
    }
}

impl Frame for Frame2 {
    type Point = DVec2;
    type Map = DAffine2;
    type Outline = BaseElement;
    type Corners = Corners2;

    const UNIT: Self = Self::UNIT;

    forward! {
        compose(&self, inner: &Self) -> Self;
        direction(&self) -> Direction;
        with_direction(&self, direction: Direction) -> Self;
        origin(&self) -> DVec2;
        moved_to(&self, origin: DVec2) -> Self;
        apply(&self, point: DVec2) -> DVec2;
        ends(&self) -> [DVec2; 2];
        length(&self) -> f64;
        stretch(&self) -> f64;
        area(&self) -> f64;
        is_in_range(&self) -> bool;
    }

    #[inline]
    fn map(&self) -> &DAffine2 {
        &self.map
    }

    #[inline]
    fn pullback(&self, functional: DVec2) -> DVec2 {
        self.map.matrix2.transpose() * functional
    }

    #[inline]
    fn is_similarity(&self, ratio: f64) -> bool {
        const ROUNDING: f64 = 1e-12;
        let square = ratio * ratio;
        (self.area() - square).abs() <= ROUNDING * square
    }
}

impl From<DAffine2> for Frame2 {
    /// Creates a frame from a map, with the direction [`Normal`](Direction::Normal).
    #[inline]
    fn from(map: DAffine2) -> Self {
        Self::new(map, Direction::Normal)
    }
}

/// Least stretch that is computed from sums of squares, of which none that matters underflows.
const MIN_BY_SQUARES: f64 = 1e-140;

/// Returns the larger singular value of a linear map: the largest factor by which it lengthens a vector.
#[inline]
pub(crate) fn stretch(matrix: &DMat2) -> f64 {
    let (x, y) = (matrix.x_axis, matrix.y_axis);
    // The components that preserve and that reverse the sense of rotation; one is zero for a similarity.
    let kept = DVec2::new(x.x + y.y, x.y - y.x).length_squared();
    let reversed = DVec2::new(x.x - y.y, x.y + y.x).length_squared();
    let stretch = if reversed == 0.0 {
        kept.sqrt() / 2.0
    } else {
        (kept.sqrt() + reversed.sqrt()) / 2.0
    };
    if (MIN_BY_SQUARES..f64::INFINITY).contains(&stretch) {
        stretch
    } else {
        scaled_stretch(matrix)
    }
}

/// Returns the stretch of a matrix of which the squares of entries may leave the range of doubles.
#[cold]
fn scaled_stretch(matrix: &DMat2) -> f64 {
    let (x, y) = (matrix.x_axis, matrix.y_axis);
    (libm::hypot(x.x + y.y, x.y - y.x) + libm::hypot(x.x - y.y, x.y + y.x)) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_reach_to_the_ends_of_the_range() {
        for size in [1e-300, 1e-160, 1.0, 1e160, 1e300] {
            let turned = DMat2::from_angle(0.7) * size;
            let sheared = DMat2::from_cols_array(&[size, 0.0, size, size]);
            let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
            for (matrix, expected) in [(turned, 1.0), (sheared, golden)] {
                let ratio = stretch(&matrix) / size;
                assert!((ratio - expected).abs() < 1e-14, "{size}: {ratio}");
            }
        }
        assert_eq!(stretch(&DMat2::ZERO), 0.0);
    }
}
