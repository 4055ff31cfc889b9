//! Maps on the way from a replaced element to their places.

use crate::geometry::{DAffine2, DAffine3, DMat2, DMat3, DVec2, DVec3, Point};
use crate::ifs::{AffineMap, PointOf};

use super::maps::Tweened;
use super::{Tween, TweenBy};

/// Step of a model that is drawn while it grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Growing {
    /// Number of steps.
    pub(crate) steps: u32,
    /// Share of the way that has been covered, from 0 to 1.
    pub(crate) share: f64,
}

/// Returns the place of a point on the way from its foot on the unit element: the nearest point of that with the same x
/// coordinate, or the end of it.
pub(crate) fn raised<P: Point>(point: P, share: f64) -> P {
    let [x, y, z] = point.coordinates();
    let foot = x.clamp(0.0, 1.0);
    P::of_coordinates([foot + share * (x - foot), share * y, share * z])
}

/// Affine map that grows.
pub(crate) trait Grown: AffineMap {
    /// Returns the map on the way from the x axis: the ends of the unit element are [raised], and lengths across it
    /// increase with the share.
    fn raised(&self, share: f64) -> Self;

    /// Returns the map between the identity and this map, in a polar tween.
    fn since_identity(&self, share: f64) -> Self;

    /// Returns the map on the way from a point: the image of the origin.
    fn out_of_point(&self, share: f64) -> Self;

    /// Returns the map on the way from the identity. It turns about its fixed point, or moves straight if there is none.
    fn turned(&self, share: f64) -> Self {
        if share >= 1.0 {
            return *self;
        }
        let map = self.since_identity(share);
        self.fixed_point().map_or(map, |point| {
            let linear = Self::new(map.linear(), PointOf::<Self>::ZERO);
            Self::new(map.linear(), point - linear.apply(point))
        })
    }
}

/// Returns a share of a polar tween.
fn polar(share: f64) -> Tween {
    let by = TweenBy::Polar;
    Tween { share, by }
}

impl Grown for DAffine2 {
    fn raised(&self, share: f64) -> Self {
        let [x_axis, y_axis] = [self.matrix2.x_axis, self.matrix2.y_axis];
        let from = raised(self.translation, share);
        let to = raised(self.translation + x_axis, share);
        Self::from_mat2_translation(DMat2::from_cols(to - from, y_axis * share), from)
    }

    fn since_identity(&self, share: f64) -> Self {
        Self::between(polar(share), [&Self::IDENTITY, self])
    }

    fn out_of_point(&self, share: f64) -> Self {
        self.shrunk(share, DVec2::ZERO)
    }
}

impl Grown for DAffine3 {
    fn raised(&self, share: f64) -> Self {
        let DMat3 {
            x_axis,
            y_axis,
            z_axis,
        } = self.matrix3;
        let from = raised(self.translation, share);
        let to = raised(self.translation + x_axis, share);
        let linear = DMat3::from_cols(to - from, y_axis * share, z_axis * share);
        Self::from_mat3_translation(linear, from)
    }

    fn since_identity(&self, share: f64) -> Self {
        Self::between(polar(share), [&Self::IDENTITY, self])
    }

    fn out_of_point(&self, share: f64) -> Self {
        self.shrunk(share, DVec3::ZERO)
    }
}

/// Returns the map on the way from the plane z = 0, for a surface that grows out of the one that it replaces.
pub(crate) fn lifted(map: &DAffine3, share: f64) -> DAffine3 {
    let flat = DAffine3::from_scale(DVec3::new(1.0, 1.0, share));
    flat * *map
}

/// Returns the map on the way from the identity, for a solid that begins as the one that it replaces. Its linear part
/// turns about one axis, and the middle of the unit element moves straight.
pub(crate) fn shrunk(map: &DAffine3, share: f64) -> DAffine3 {
    if share >= 1.0 {
        return *map;
    }
    let mut between = map.since_identity(share);
    let middle = DVec3::X / 2.0;
    let place = middle.lerp(map.transform_point3(middle), share);
    between.translation = place - between.matrix3 * middle;
    between
}

/// Returns the end that is nearer to the middle of the unit element.
pub(crate) fn nearer_end<P: Point>([from, to]: [P; 2]) -> P {
    let middle = P::AXES[0] * 0.5;
    match (to - middle).length() < (from - middle).length() {
        true => to,
        false => from,
    }
}

/// Returns the map on the way from a point: the image of a point.
pub(crate) fn out_of(map: &DAffine3, place: DVec3, share: f64) -> DAffine3 {
    let translation = place + (map.translation - place) * share;
    DAffine3::from_mat3_translation(map.matrix3 * share, translation)
}

/// Returns the ends of an element on the way from the unit element, or from that in the opposite direction: the line between
/// them turns evenly, by the smaller angle, and its middle moves straight.
pub(crate) fn turned_ends([from, to]: [DVec2; 2], is_opposite: bool, share: f64) -> [DVec2; 2] {
    let side = if is_opposite { -1.0 } else { 1.0 };
    let along = (to - from) * side;
    let length = 1.0 + share * (along.length() - 1.0);
    let angle = share * libm::atan2(along.y, along.x);
    let half = DVec2::new(libm::cos(angle), libm::sin(angle)) * (side * length / 2.0);
    let middle = (DVec2::X / 2.0).lerp((from + to) / 2.0, share);
    [middle - half, middle + half]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Affine as _;

    #[test]
    fn points_grow_from_their_feet() {
        let place = |x, y, share| raised(DVec2::new(x, y), share);
        assert_eq!(place(0.5, 0.6, 0.5), DVec2::new(0.5, 0.3));
        assert_eq!(place(1.5, -1.0, 0.5), DVec2::new(1.25, -0.5));
        assert_eq!(place(1.5, -1.0, 0.0), DVec2::new(1.0, 0.0));
        assert_eq!(place(-0.25, 1.0, 1.0), DVec2::new(-0.25, 1.0));
        let solid = raised(DVec3::new(0.25, 2.0, -4.0), 0.25);
        assert_eq!(solid, DVec3::new(0.25, 0.5, -1.0));
    }

    #[test]
    fn maps_grow_from_the_element_that_they_replace() {
        let turn = DMat2::from_angle(1.0) * 0.5;
        let map = DAffine2::from_mat2_translation(turn, DVec2::new(3.0, -1.0));
        let fixed = map.apply(DVec2::ZERO) - DVec2::new(3.0, -1.0);
        assert_eq!(fixed, DVec2::ZERO);
        assert!(map.turned(0.0).abs_diff_eq(DAffine2::IDENTITY, 1e-14));
        assert_eq!(map.turned(1.0), map);
        let half = map.turned(0.5);
        let scale = half.matrix2.determinant().sqrt();
        assert!((scale - 0.75).abs() < 1e-14 && !half.translation.is_nan());
        let point = map.fixed_point().unwrap_or_default();
        assert!((half.apply(point) - point).length() < 1e-13);
        // A translation has no fixed point.
        let shift = DAffine2::from_translation(DVec2::new(2.0, 4.0));
        assert_eq!(shift.turned(0.25).translation, DVec2::new(0.5, 1.0));
        let grown = map.out_of_point(0.5);
        assert_eq!(grown.translation, map.translation);
        assert_eq!(grown.matrix2, map.matrix2 * 0.5);
        // Neighbours of a chain meet at every share.
        let other = DAffine2::from_mat2_translation(turn * 2.0, map.apply(DVec2::X));
        let ends = [
            map.raised(0.3).apply(DVec2::X),
            other.raised(0.3).apply(DVec2::ZERO),
        ];
        assert!((ends[0] - ends[1]).length() < 1e-15);
    }

    #[test]
    fn ends_turn_from_the_unit_element() {
        let ends = [DVec2::new(0.25, 1.0), DVec2::new(0.25, 0.5)];
        let at = |is_opposite, share| turned_ends(ends, is_opposite, share);
        let near =
            |a: [DVec2; 2], b: [DVec2; 2]| (0..2).all(|end| a[end].abs_diff_eq(b[end], 1e-15));
        assert!(near(at(false, 0.0), [DVec2::ZERO, DVec2::X]));
        assert!(near(at(true, 0.0), [DVec2::X, DVec2::ZERO]));
        assert!(near(at(false, 1.0), ends) && near(at(true, 1.0), ends));
        let [from, to] = at(false, 0.5);
        assert!(((to - from).length() - 0.75).abs() < 1e-15);
        assert_eq!(nearer_end(ends), ends[1]);
    }

    #[test]
    fn maps_of_space_grow_from_the_element_that_they_replace() {
        let turn = DMat3::from_rotation_y(0.7) * 0.5;
        let map = DAffine3::from_mat3_translation(turn, DVec3::new(0.2, 0.4, 0.6));
        assert!(shrunk(&map, 0.0).abs_diff_eq(DAffine3::IDENTITY, 1e-14));
        assert_eq!(shrunk(&map, 1.0), map);
        let middle = DVec3::X / 2.0;
        let half = shrunk(&map, 0.5).transform_point3(middle);
        let expected = (middle + map.transform_point3(middle)) / 2.0;
        assert!((half - expected).length() < 1e-14);
        let bud = out_of(&map, map.translation, 0.5);
        assert_eq!(bud.translation, map.translation);
        assert_eq!(bud.matrix3, map.matrix3 * 0.5);
        assert_eq!(lifted(&map, 0.0).transform_point3(DVec3::ONE).z, 0.0);
        assert!(lifted(&map, 1.0).abs_diff_eq(map, 0.0));
        assert_eq!(map.raised(0.0).transform_point3(DVec3::Z).z, 0.0);
    }
}
