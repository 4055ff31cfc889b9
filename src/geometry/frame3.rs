//! Frames in space: a map of the unit frame, and a direction.

use glam::{DAffine3, DMat3, DVec3};

use super::frame::LARGEST_ENTRY;
use super::linear::stretch3;
use super::{Bounds, Corners, Direction, Frame, Solid};
use crate::expression::degrees;

/// Turn of an element's frame about the element.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Attitude {
    /// The frame is that of the least turn that takes the x axis to the element: about the axis across both; for an
    /// element against the x axis, a half turn about the z axis.
    #[default]
    Least,
    /// The z axis lies on the same side of the element as this vector, in the plane of both.
    Normal(DVec3),
    /// The frame of the least turn is turned about the element by an angle in degrees, by the right-hand rule.
    Roll(f64),
}

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

    /// Returns the frame of an element that runs from `from` to `to`, as listed, with a direction: the map is the
    /// similarity of ratio |to − from| after the reflections of the direction.
    ///
    /// In the plane z = 0 the frame of the least turn is that of [`Frame2::between`](super::Frame2::between), to the
    /// last bit. Along a normal, all numbers are NaN.
    #[must_use]
    pub fn between(from: DVec3, to: DVec3, direction: Direction, attitude: Attitude) -> Self {
        let along = to - from;
        let mut linear = turned(along);
        match attitude {
            Attitude::Least => {}
            Attitude::Normal(normal) => {
                let length = along.length();
                let unit = along / length;
                let across = normal.normalize();
                // Twice, because the first difference loses digits where the normal is almost along the element.
                let across = (across - unit * unit.dot(across)).normalize();
                let across = (across - unit * unit.dot(across)).normalize();
                linear.z_axis = across * length;
                linear.y_axis = across.cross(along);
            }
            Attitude::Roll(angle) => {
                let [cosine, sine] = [degrees::cos(angle), degrees::sin(angle)];
                let DMat3 { y_axis, z_axis, .. } = linear;
                linear.y_axis = y_axis * cosine + z_axis * sine;
                linear.z_axis = z_axis * cosine - y_axis * sine;
            }
        }
        Self::reflected(linear, [from, to], direction)
    }

    /// Returns the frame of an element with a direction whose first three corners lie at these points: the map takes
    /// (0, 0, 0), (1, 0, 0) and (x, y, 0), with x and y those of `third`, to them, and (0, 0, 1) to `up`, or else to the normal
    /// of the length of the first side.
    #[must_use]
    pub fn stretched(
        corners: [DVec3; 3],
        third: [f64; 2],
        up: Option<DVec3>,
        direction: Direction,
    ) -> Self {
        let [from, to, other] = corners;
        let along = to - from;
        let across = (other - from - along * third[0]) / third[1];
        let normal = along.cross(across).normalize() * along.length();
        let linear = DMat3::from_cols(along, across, up.unwrap_or(normal));
        Self::reflected(linear, [from, to], direction)
    }

    /// Returns the frame of a map after the reflections of a direction, for an element with these ends.
    fn reflected(linear: DMat3, [from, to]: [DVec3; 2], direction: Direction) -> Self {
        let [x, y, z] = direction.reflected();
        let signed = |is_reflected: bool, axis: DVec3| if is_reflected { -axis } else { axis };
        let linear = DMat3::from_cols(
            signed(x, linear.x_axis),
            signed(y, linear.y_axis),
            signed(z, linear.z_axis),
        );
        let origin = if x { to } else { from };
        Self::new(DAffine3::from_mat3_translation(linear, origin), direction)
    }

    /// Returns the map from the unit frame to space.
    #[inline]
    #[must_use]
    pub fn map(&self) -> &DAffine3 {
        &self.map
    }
}

/// Returns the similarity whose rotation is the least turn that takes the x axis to the direction of a vector, and
/// whose ratio is the length of the vector.
fn turned(along: DVec3) -> DMat3 {
    let length = along.length();
    let DVec3 { x, y, z } = along;
    if z == 0.0 {
        return DMat3::from_cols(along, DVec3::new(-y, x, 0.0), DVec3::Z * length);
    }
    // 1 / (length + x), without cancellation.
    let share = match x < 0.0 {
        true => (length - x) / (y * y + z * z),
        false => 1.0 / (length + x),
    };
    let mixed = -y * z * share;
    DMat3::from_cols(
        along,
        DVec3::new(-y, x + z * z * share, mixed),
        DVec3::new(-z, mixed, x + y * y * share),
    )
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

    fn volume(&self) -> f64 {
        self.map.matrix3.determinant().abs()
    }

    fn is_similarity(&self, ratio: f64) -> bool {
        const ROUNDING: f64 = 1e-12;
        let square = ratio * ratio;
        let linear = self.map.matrix3;
        let own = linear.transpose() * linear;
        own.abs_diff_eq(DMat3::IDENTITY * square, ROUNDING * square)
    }

    fn is_in_range(&self) -> bool {
        let linear = self.map.matrix3;
        let all = [
            linear.x_axis,
            linear.y_axis,
            linear.z_axis,
            self.map.translation,
        ];
        // Minima and maxima ignore NaN.
        all.iter()
            .all(|vector| vector.abs().max_element() < LARGEST_ENTRY)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{DVec2, Frame2, rotation};

    fn random(state: &mut u64) -> f64 {
        *state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        #[expect(clippy::cast_precision_loss, reason = "53 bits are left")]
        let value = (*state >> 11) as f64;
        value / 4_503_599_627_370_496.0 - 1.0
    }

    #[test]
    fn frames_in_the_plane_are_those_of_the_plane_to_the_last_bit() {
        let mut state = 1;
        let mut frames = (Frame2::UNIT, Frame3::UNIT);
        for number in 0..2000 {
            let mut point = || DVec2::new(random(&mut state), random(&mut state));
            let (from, to) = match number % 8 {
                0 => (DVec2::X, DVec2::ZERO),
                1 => (DVec2::ZERO, DVec2::Y),
                _ => (point(), point()),
            };
            let direction = Direction::ALL[number % 4];
            let plane = Frame2::between(from, to, direction);
            let space =
                Frame3::between(from.extend(0.0), to.extend(0.0), direction, Attitude::Least);
            frames = match number % 20 {
                0 => (plane, space),
                _ => (frames.0.compose(&plane), frames.1.compose(&space)),
            };
            for (plane, space) in [(plane, space), frames] {
                let linear = space.map.matrix3;
                let own = plane.map().matrix2;
                assert_eq!(linear.x_axis, own.x_axis.extend(0.0));
                assert_eq!(linear.y_axis, own.y_axis.extend(0.0));
                assert_eq!(linear.z_axis.truncate(), DVec2::ZERO);
                assert_eq!(space.origin(), plane.origin().extend(0.0));
                assert_eq!(space.length(), plane.length());
                assert_eq!(space.ends(), plane.ends().map(|end| end.extend(0.0)));
            }
        }
    }

    #[test]
    fn frames_are_similarities_with_the_attitude_that_is_asked_for() {
        let mut state = 7;
        for number in 0..2000 {
            let mut point =
                || DVec3::new(random(&mut state), random(&mut state), random(&mut state));
            let (from, mut along, normal) = (point(), point(), point());
            if number % 4 == 0 {
                // Almost against the x axis.
                along = DVec3::new(-1.0, along.y * 1e-9, along.z * 1e-9);
            }
            let to = from + along;
            // The sum is rounded.
            let along = to - from;
            let ratio = along.length();
            let least = Frame3::between(from, to, Direction::Normal, Attitude::Least);
            // The axis across x and the element stays where it is.
            let axis = DVec3::X.cross(along).normalize();
            let turned = least.map.matrix3 * axis;
            let error = (turned - axis * ratio).length();
            assert!(error < 1e-6 * ratio, "{along}: {error}");
            for (attitude, direction) in [
                (Attitude::Least, Direction::Normal),
                (Attitude::Normal(normal), Direction::Normal),
                (Attitude::Roll(37.0), Direction::Normal),
                (Attitude::Normal(normal), Direction::ALL[number % 8]),
            ] {
                let frame = Frame3::between(from, to, direction, attitude);
                let linear = frame.map.matrix3 / ratio;
                let square = linear.transpose() * linear;
                assert!(square.abs_diff_eq(DMat3::IDENTITY, 1e-12), "{linear}");
                assert_eq!(linear.determinant() < 0.0, direction.is_mirrored());
                let ends = frame.ends();
                assert!((ends[0] - from).length() < 1e-14 && (ends[1] - to).length() < 1e-14);
                if let (Attitude::Normal(normal), Direction::Normal) = (attitude, direction) {
                    assert!(linear.z_axis.dot(normal) > 0.0);
                    let across = linear.x_axis.cross(linear.z_axis);
                    assert!(across.dot(normal).abs() < 1e-12);
                }
                if let Attitude::Roll(angle) = attitude {
                    let roll = rotation(along, degrees::cos(angle), degrees::sin(angle));
                    let rolled = roll * least.map.matrix3 / ratio;
                    assert!(linear.abs_diff_eq(rolled, 1e-12));
                }
            }
        }
    }
}
