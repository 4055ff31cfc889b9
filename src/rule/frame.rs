//! Frames of the elements of rules: what production rules of the plane and of space do differently.

use std::fmt::Debug;

use crate::expression::{AffineOf, Arithmetic as _, Doubles, Interval, Program};
use crate::geometry::{
    Affine as _, Attitude, BaseElement, DAffine2, DAffine3, DVec3, Frame, Frame2, Frame3, Point,
};

use crate::tween::{self, Grown as _};

use super::body::Body;
use super::generator::{ListedAttitude, ListedElement, Move};
use super::growing::GrowthStart;

/// Largest difference of numbers up to which a frame is that of the element that is replaced.
pub(super) const SAME: f64 = 1e-9;

/// Box that contains a point; in the plane its third side is 0.
pub(crate) type Place = [Interval; 3];

/// The frame of an element of a production rule, of the plane or of space.
pub trait RuleFrame: Frame {
    /// The expressions of the coordinates of a point.
    type Coordinates: AsRef<[Program]> + Clone + Debug + PartialEq + Send + Sync;
    /// The turns of a move: an angle in the plane; in space turns about axes, of which the first one is applied first.
    type Turns: Clone + Debug + PartialEq + Send + Sync;
    /// Base element: the shape that is drawn for an element.
    type BaseElement: Clone + Debug + PartialEq + Send + Sync;

    /// Whether frames are similarities while they grow.
    const GROWS_SIMILAR: bool;

    /// Returns where an element with a base element begins that grows: by its shape, the place where lines, surfaces of
    /// space, or other shapes do.
    fn start_of_growth(base_element: &Self::BaseElement) -> GrowthStart;

    /// Returns the frame on the way from the element that is replaced, the unit element, by a share from 0 to 1.
    #[must_use]
    fn grown(&self, start: GrowthStart, share: f64) -> Self;

    /// Returns the frame of a listed element; `points` are those of its initiator or generator, followed by the
    /// vectors and angles to which attitudes refer.
    #[must_use]
    fn placed(element: &ListedElement, points: &[Self::Point]) -> Self;

    /// Returns the outlines of base elements.
    #[must_use]
    fn outlines(base_elements: &[Self::BaseElement]) -> Vec<Self::Outline>;

    /// Iterates over the expressions of turns.
    fn programs_of_turns(turns: &Self::Turns) -> Vec<&Program>;

    /// Moves the points that a move names.
    fn move_points(moving: &Move<Self>, slots: &[f64], points: &mut [Self::Point]);

    /// Returns a box of the images of a point under the turns of a move about the origin.
    #[must_use]
    fn turned(turns: &Self::Turns, point: Place, slots: &[Interval]) -> Place;
}

/// Evaluates a point.
#[inline]
pub(crate) fn evaluated<F: RuleFrame>(coordinates: &F::Coordinates, slots: &[f64]) -> F::Point {
    let mut values = [0.0; 3];
    for (value, program) in values.iter_mut().zip(coordinates.as_ref()) {
        *value = program.eval(slots);
    }
    F::Point::of_coordinates(values)
}

/// Returns the value of a point if its coordinates are constants.
pub(crate) fn constant<F: RuleFrame>(coordinates: &F::Coordinates) -> Option<F::Point> {
    let mut values = [0.0; 3];
    for (value, program) in values.iter_mut().zip(coordinates.as_ref()) {
        *value = program.as_constant()?;
    }
    Some(F::Point::of_coordinates(values))
}

impl RuleFrame for Frame2 {
    type Coordinates = [Program; 2];
    type Turns = Program;
    type BaseElement = BaseElement;

    const GROWS_SIMILAR: bool = true;

    fn start_of_growth(base_element: &BaseElement) -> GrowthStart {
        match base_element.is_closed() {
            true => GrowthStart::Element,
            false => GrowthStart::Chord,
        }
    }

    #[inline]
    fn grown(&self, start: GrowthStart, share: f64) -> Self {
        let ends = self.ends();
        let [from, to] = match start {
            _ if share >= 1.0 => return *self,
            GrowthStart::Point if self.map().is_near(Self::UNIT.map(), SAME) => return *self,
            GrowthStart::Chord => ends.map(|end| tween::raised(end, share)),
            GrowthStart::Plane => ends,
            GrowthStart::Element => {
                // The side of the element stays the same.
                let [_, is_opposite, _] = self.direction().reflected();
                tween::turned_ends(ends, is_opposite, share)
            }
            GrowthStart::Point => {
                let point = tween::nearer_end(ends);
                ends.map(|end| point.lerp(end, share))
            }
        };
        Self::between(from, to, self.direction())
    }

    #[inline]
    fn placed(element: &ListedElement, points: &[Self::Point]) -> Self {
        Self::between(points[element.from], points[element.to], element.direction)
    }

    fn outlines(base_elements: &[BaseElement]) -> Vec<BaseElement> {
        base_elements.to_vec()
    }

    fn programs_of_turns(turn: &Program) -> Vec<&Program> {
        vec![turn]
    }

    #[inline]
    fn move_points(moving: &Move, slots: &[f64], points: &mut [Self::Point]) {
        let map = moving.map(&mut Doubles, |_, program| program.eval(slots));
        let map = DAffine2::from(map);
        for &number in &*moving.points {
            points[number] = map.transform_point2(points[number]);
        }
    }

    fn turned(turn: &Program, [x, y, z]: Place, slots: &[Interval]) -> Place {
        let angle = turn.range(slots);
        let (sine, cosine) = (angle.sine(), angle.cosine());
        [cosine * x - sine * y, sine * x + cosine * y, z]
    }
}

/// A turn about an axis through the origin, by the right-hand rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// Axis, of any length above 0.
    pub(crate) axis: [Program; 3],
    /// Angle in degrees.
    pub(crate) angle: Program,
}

impl Turn {
    /// Evaluates the turn; an axis without length makes it NaN.
    fn evaluated(&self, slots: &[f64]) -> AffineOf<f64, 3> {
        let [x, y, z] = self.axis.each_ref().map(|program| program.eval(slots));
        let length = DVec3::new(x, y, z).length();
        let axis = [x, y, z].map(|along| along / length);
        let turn = Doubles.turn(&self.angle.eval(slots));
        AffineOf::rotation_about(&mut Doubles, &axis, &turn)
    }

    /// Returns the axis as a unit vector if it is a constant.
    fn fixed_axis(&self) -> Option<DVec3> {
        let [x, y, z] = self.axis.each_ref().map(Program::as_constant);
        DVec3::new(x?, y?, z?).try_normalize()
    }
}

impl RuleFrame for Frame3 {
    type Coordinates = [Program; 3];
    type Turns = Vec<Turn>;
    type BaseElement = Body;

    const GROWS_SIMILAR: bool = false;

    fn start_of_growth(base_element: &Body) -> GrowthStart {
        if base_element.is_closed() {
            GrowthStart::Element
        } else if base_element.face().is_empty() {
            GrowthStart::Chord
        } else {
            GrowthStart::Plane
        }
    }

    fn grown(&self, start: GrowthStart, share: f64) -> Self {
        let map = self.map();
        let map = match start {
            _ if share >= 1.0 => return *self,
            GrowthStart::Point if map.is_near(Self::UNIT.map(), SAME) => return *self,
            GrowthStart::Chord => map.raised(share),
            GrowthStart::Plane => tween::lifted(map, share),
            GrowthStart::Element => tween::shrunk(map, share),
            GrowthStart::Point => tween::out_of(map, tween::nearer_end(self.ends()), share),
        };
        Self::new(map, self.direction())
    }

    fn placed(element: &ListedElement, points: &[DVec3]) -> Self {
        let attitude = match &element.attitude {
            ListedAttitude::Least => Attitude::Least,
            ListedAttitude::Normal(number) => Attitude::Normal(points[*number]),
            ListedAttitude::Roll(number) => Attitude::Roll(points[*number].x),
            ListedAttitude::Face(numbers) => {
                Attitude::Normal(newell(numbers.iter().map(|it| points[*it])))
            }
            ListedAttitude::Corners {
                points: corners,
                third,
                up,
            } => {
                let corners = corners.map(|it| points[it]);
                let up = up.map(|it| points[it]);
                return Self::stretched(corners, *third, up, element.direction);
            }
        };
        Self::between(
            points[element.from],
            points[element.to],
            element.direction,
            attitude,
        )
    }

    fn outlines(base_elements: &[Body]) -> Vec<Self::Outline> {
        base_elements
            .iter()
            .map(|body| body.hull().clone())
            .collect()
    }

    fn programs_of_turns(turns: &Vec<Turn>) -> Vec<&Program> {
        let turns = turns.iter();
        turns
            .flat_map(|turn| turn.axis.iter().chain([&turn.angle]))
            .collect()
    }

    fn move_points(moving: &Move<Self>, slots: &[f64], points: &mut [DVec3]) {
        let of = &mut Doubles;
        let value = |coordinates: &[Program; 3]| coordinates.each_ref().map(|it| it.eval(slots));
        let mut map = AffineOf::scaling(of, value(&moving.scale));
        for turn in &moving.rotate {
            map = turn.evaluated(slots).after(of, &map);
        }
        let (about, shift) = (value(&moving.about), value(&moving.shift));
        let map = map.about(of, &about);
        let origin = [0, 1, 2].map(|row: usize| map.origin[row] + shift[row]);
        let map = DAffine3::from(map.moved_to(origin));
        for &number in &*moving.points {
            points[number] = map.transform_point3(points[number]);
        }
        // Normals move by the cofactor matrix.
        let [x, y, z] = [map.matrix3.x_axis, map.matrix3.y_axis, map.matrix3.z_axis];
        for &number in &*moving.normals {
            let normal = points[number];
            points[number] = y.cross(z) * normal.x + z.cross(x) * normal.y + x.cross(y) * normal.z;
        }
    }

    /// Turns about a constant axis are Rodrigues' formula in interval arithmetic; other turns keep the distance from
    /// the origin.
    fn turned(turns: &Vec<Turn>, point: Place, slots: &[Interval]) -> Place {
        turns.iter().fold(point, |point, turn| {
            let farthest = DVec3::from(point.map(Interval::magnitude)).length();
            let ball = [Interval::new(-farthest, farthest); 3];
            let Some(axis) = turn.fixed_axis() else {
                return ball;
            };
            let angle = turn.angle.range(slots);
            let (sine, cosine) = (angle.sine(), angle.cosine());
            let rest = Interval::point(1.0) - cosine;
            let axis = axis.to_array().map(Interval::point);
            let dot = axis[0] * point[0] + axis[1] * point[1] + axis[2] * point[2];
            [0, 1, 2].map(|row: usize| {
                let (next, last) = ((row + 1) % 3, (row + 2) % 3);
                let across = axis[next] * point[last] - axis[last] * point[next];
                point[row] * cosine + across * sine + axis[row] * (dot * rest)
            })
        })
    }
}

/// Returns the normal of a polygon, of twice the length of its area, by Newell's formula: the sum of the cross
/// products of neighbouring corners. It points to where the polygon runs counter-clockwise.
pub(crate) fn newell(corners: impl Iterator<Item = DVec3> + Clone) -> DVec3 {
    let Some(first) = corners.clone().next() else {
        return DVec3::ZERO;
    };
    let away = corners.map(|corner| corner - first);
    let next = away.clone().skip(1);
    away.zip(next)
        .fold(DVec3::ZERO, |sum, (from, to)| sum + from.cross(to))
}
