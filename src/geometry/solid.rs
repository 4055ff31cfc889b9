//! Convex solids: shapes of elements in space.

mod polyhedron;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec2, DVec3};

use self::polyhedron::{Polyhedron, face};
use super::linear::eigen;
use super::{Bounds, Frame, Frame3, Outline, Round, convex_hull};

/// Largest number of points of which a convex hull is computed; more are enclosed by a box.
pub const MAX_HULL_POINTS: u32 = 100;

/// Tolerance of comparisons, relative to the size of a solid.
const ROUNDING: f64 = 1e-10;

/// A half-space: the points x with normal · x ≤ distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// Vector across the boundary, outwards.
    pub normal: DVec3,
    /// Largest value of normal · x.
    pub distance: f64,
}

/// The front of a flat solid that is a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Vector of length 1 to the front of the surface; it may be given other than across it.
    pub normal: DVec3,
    /// Whether the back is a surface, too: scenes of meshes show it. Pictures show and light the side that is seen.
    pub is_double: bool,
}

/// A convex solid: a polyhedron, or an affine image of a [`Round`] primitive. It may be flat: a polygon, a disk, a
/// segment or a point.
///
/// A flat solid is the image of one with an inside under a singular map, which is kept apart: see
/// [`place`](Self::place).
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    place: DAffine3,
    /// Half-spaces whose intersection, with the round body if there is one, is the solid before it is placed.
    faces: Arc<[HalfSpace]>,
    round: Option<Round>,
    /// Corners of the solid in its place, other than those of round bodies.
    corners: Arc<[DVec3]>,
    /// Surface in its place; of a flat solid, both sides.
    surface: f64,
    /// Volume in its place.
    volume: f64,
    side: Option<Side>,
}

impl Solid {
    /// Returns the image of a round primitive under a map, which may be singular.
    #[must_use]
    pub fn round(primitive: Round, place: DAffine3) -> Self {
        Self {
            place,
            faces: primitive.caps().into(),
            round: Some(primitive),
            corners: Arc::default(),
            surface: primitive.surface(&place.matrix3),
            volume: primitive.volume() * place.matrix3.determinant().abs(),
            side: None,
        }
    }

    /// Returns the box between two opposite corners, which may be flat.
    #[must_use]
    pub fn cuboid(bounds: &Bounds<DVec3>) -> Self {
        let half = bounds.size() / 2.0;
        let place =
            DAffine3::from_mat3_translation(DMat3::from_diagonal(half), bounds.min() + half);
        let sides = [DVec3::X, DVec3::Y, DVec3::Z]
            .into_iter()
            .flat_map(|axis| [axis, -axis]);
        let faces = sides.map(|normal| HalfSpace {
            normal,
            distance: 1.0,
        });
        let ends = [bounds.min(), bounds.max()];
        let corners = (0..8).map(|corner: usize| {
            let [x, y, z] = [corner & 1, corner >> 1 & 1, corner >> 2].map(|end| ends[end]);
            DVec3::new(x.x, y.y, z.z)
        });
        let sides = bounds.size();
        Self {
            place,
            faces: faces.collect(),
            round: None,
            corners: corners.collect(),
            surface: 2.0 * (sides.x * sides.y + sides.y * sides.z + sides.z * sides.x),
            volume: sides.element_product(),
            side: None,
        }
    }

    /// Returns the convex hull of points, or their box where they are more than 100; a point at the origin if
    /// there are none.
    #[must_use]
    pub fn hull(points: &[DVec3]) -> Self {
        let mut bounds = Bounds::EMPTY;
        points.iter().for_each(|point| bounds.add(*point));
        if points.is_empty() {
            return Self::cuboid(&Bounds::new(DVec3::ZERO, DVec3::ZERO));
        }
        let size = bounds.size().max_element();
        if points.len() > MAX_HULL_POINTS as usize {
            return Self::cuboid(&bounds);
        }
        if size <= 0.0 {
            return Self {
                corners: [bounds.min()].into(),
                ..Self::cuboid(&bounds)
            };
        }
        let middle = bounds.min() + bounds.size() / 2.0;
        let near: Vec<DVec3> = points
            .iter()
            .map(|point| (*point - middle) / size)
            .collect();
        let (axes, rank) = main_axes(&near);
        let polyhedron = (rank == 3).then(|| Self::polyhedron(&near)).flatten();
        let solid = match rank {
            0 | 1 => Self::segment(&near, axes.x_axis),
            _ => polyhedron.unwrap_or_else(|| Self::polygon(&near, axes)),
        };
        let place =
            DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::splat(size)), middle);
        let corners = solid
            .corners
            .iter()
            .map(|corner| place.transform_point3(*corner));
        Self {
            place: place * solid.place,
            corners: corners.collect(),
            surface: solid.surface * size * size,
            volume: solid.volume * size * size * size,
            faces: solid.faces,
            round: None,
            side: None,
        }
    }

    /// Returns the hull of points that do not lie in a plane; `None` if they do.
    fn polyhedron(points: &[DVec3]) -> Option<Self> {
        let hull = Polyhedron::of(points)?;
        Some(Self {
            place: DAffine3::IDENTITY,
            faces: hull.faces.into(),
            round: None,
            corners: hull.corners.into(),
            surface: hull.surface,
            volume: hull.volume,
            side: None,
        })
    }

    /// Returns the hull of points in a plane: a prism without height. The last axis is across the plane.
    fn polygon(points: &[DVec3], axes: DMat3) -> Self {
        let origin = points[0];
        let flat = points.iter().map(|point| {
            let away = *point - origin;
            DVec2::new(away.dot(axes.x_axis), away.dot(axes.y_axis))
        });
        let around = convex_hull(flat.collect(), ROUNDING);
        let place = |point: DVec2| origin + axes.x_axis * point.x + axes.y_axis * point.y;
        let mut faces = vec![DVec3::Z, DVec3::NEG_Z]
            .into_iter()
            .map(|normal| HalfSpace {
                normal,
                distance: 1.0,
            })
            .collect::<Vec<_>>();
        let mut area = 0.0;
        for (number, &from) in around.iter().enumerate() {
            let to = around[(number + 1) % around.len()];
            let outward = -(to - from).perp().normalize_or_zero();
            let normal = outward.extend(0.0);
            faces.push(HalfSpace {
                normal,
                distance: outward.dot(from),
            });
            area += from.perp_dot(to) / 2.0;
        }
        let linear = DMat3::from_cols(axes.x_axis, axes.y_axis, DVec3::ZERO);
        Self {
            place: DAffine3::from_mat3_translation(linear, origin),
            faces: faces.into(),
            round: None,
            corners: around.iter().map(|point| place(*point)).collect(),
            surface: 2.0 * area,
            volume: 0.0,
            side: None,
        }
    }

    /// Returns the hull of points along a line.
    fn segment(points: &[DVec3], axis: DVec3) -> Self {
        let along = |point: &DVec3| point.dot(axis);
        let origin = points[0] - axis * along(&points[0]);
        let ends = [f64::min, f64::max].map(|pick: fn(f64, f64) -> f64| {
            points.iter().map(along).reduce(pick).unwrap_or_default()
        });
        let [from, to] = ends.map(|end| origin + axis * end);
        let unit = Self::cuboid(&Bounds::new(DVec3::NEG_ONE, DVec3::ONE));
        let linear = DMat3::from_cols((to - from) / 2.0, DVec3::ZERO, DVec3::ZERO);
        Self {
            place: DAffine3::from_mat3_translation(linear, (from + to) / 2.0),
            faces: unit.faces,
            round: None,
            corners: vec![from, to].into(),
            surface: 0.0,
            volume: 0.0,
            side: None,
        }
    }

    /// Returns the image under an affine map, without a front.
    #[must_use]
    pub fn image(&self, map: &DAffine3) -> Self {
        if let Some(round) = self.round {
            return Self::round(round, *map * self.place);
        }
        let corners = { self.corners.iter() }.map(|corner| map.transform_point3(*corner));
        let image = Self::hull(&corners.collect::<Vec<_>>());
        let front = self.side.map(|side| side.normal).or_else(|| self.across());
        match front {
            // A vector across a plane is mapped by the cofactors; the outside of an inside stays outside.
            Some(front) => {
                let DMat3 {
                    x_axis,
                    y_axis,
                    z_axis,
                } = map.matrix3;
                let cofactors = [
                    y_axis.cross(z_axis),
                    z_axis.cross(x_axis),
                    x_axis.cross(y_axis),
                ];
                let [x, y, z] = cofactors;
                let sign = map.matrix3.determinant().signum();
                image.facing(DMat3::from_cols(x, y, z) * front * sign)
            }
            None => image,
        }
    }

    /// Returns the image under a similarity.
    #[must_use]
    pub fn transformed(&self, map: &DAffine3) -> Self {
        let linear = map.matrix3;
        let ratio = linear.x_axis.length();
        let mut corners: Vec<DVec3> = { self.corners.iter() }
            .map(|corner| map.transform_point3(*corner))
            .collect();
        if linear.determinant() < 0.0 && self.across().is_some() {
            corners.reverse();
        }
        Self {
            place: *map * self.place,
            faces: Arc::clone(&self.faces),
            round: self.round,
            corners: corners.into(),
            surface: self.surface * ratio * ratio,
            volume: self.volume * ratio * ratio * ratio,
            side: self.side.map(|side| Side {
                normal: linear * side.normal / ratio * linear.determinant().signum(),
                ..side
            }),
        }
    }

    /// Returns a flat solid as a surface with a front.
    #[must_use]
    pub fn with_side(self, side: Side) -> Self {
        Self {
            side: Some(side),
            ..self
        }
    }

    /// Returns a polygon with its corners counter-clockwise from where a vector points.
    pub(super) fn facing(self, front: DVec3) -> Self {
        match self.across() {
            Some(across) if across.dot(front) < 0.0 => Self {
                corners: self.corners.iter().rev().copied().collect(),
                ..self
            },
            _ => self,
        }
    }

    /// Returns a vector across a polygon, to where its corners are counter-clockwise; `None` for another solid.
    fn across(&self) -> Option<DVec3> {
        let is_polygon = self.round.is_none() && self.dimension() == 2.0;
        is_polygon.then(|| across(&self.corners))
    }

    /// Returns the front of a surface; `None` for a solid with an inside, and for a flat one both sides of which are
    /// alike.
    #[must_use]
    pub fn side(&self) -> Option<Side> {
        self.side
    }

    /// Returns the map that places the intersection of the [faces](Self::faces) and the [round
    /// primitive](Self::primitive); it is singular for a flat solid.
    #[must_use]
    pub fn place(&self) -> &DAffine3 {
        &self.place
    }

    /// Returns half-spaces whose intersection is the solid before it is [placed](Self::place): together with the
    /// [round primitive](Self::primitive), if there is one. It is bounded and has an inside.
    #[must_use]
    pub fn faces(&self) -> &[HalfSpace] {
        &self.faces
    }

    /// Returns the primitive that is [placed](Self::place); `None` for a polyhedron.
    #[must_use]
    pub fn primitive(&self) -> Option<Round> {
        self.round
    }

    /// Returns the corners of a polyhedron; a round solid has none.
    #[must_use]
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// Returns whether all numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.place.is_finite() && self.corners.iter().all(|corner| corner.is_finite())
    }

    /// Returns the bounding box of the image under a map.
    #[must_use]
    pub fn bounds(&self, map: &DAffine3) -> Bounds<DVec3> {
        let mut bounds = Bounds::EMPTY;
        match self.round {
            None => { self.corners.iter() }.for_each(|it| bounds.add(map.transform_point3(*it))),
            Some(round) => {
                let place = *map * self.place;
                let rows = place.matrix3.transpose();
                let rows = [rows.x_axis, rows.y_axis, rows.z_axis];
                bounds.add(place.translation + DVec3::from(rows.map(|row| round.support(row))));
                bounds.add(place.translation - DVec3::from(rows.map(|row| round.support(-row))));
            }
        }
        bounds
    }

    /// Returns the faces: the corners of each, counter-clockwise from outside. A solid in a plane has one face,
    /// counter-clockwise from its [front](Self::side), or else as its corners are listed, and one on a line none.
    #[must_use]
    pub fn polygons(&self) -> Vec<Vec<DVec3>> {
        let hull = Self::hull(&self.corners);
        let size = hull.place.matrix3.x_axis.x;
        let near = |corner: &DVec3| (*corner - hull.place.translation) / size;
        match hull.corners.len() {
            0..3 => Vec::new(),
            _ if hull.place.matrix3.determinant() == 0.0 => {
                let mut face = hull.corners.to_vec();
                let front = self.side.map(|side| side.normal).or_else(|| self.across());
                if front.is_some_and(|front| front.dot(across(&face)) < 0.0) {
                    face.reverse();
                }
                vec![face]
            }
            _ => {
                let corners: Vec<DVec3> = self.corners.iter().map(near).collect();
                let around = |it: &HalfSpace| {
                    let face = face(&corners, it.normal, it.distance).into_iter();
                    face.map(|corner| self.corners[corner]).collect()
                };
                hull.faces.iter().map(around).collect()
            }
        }
    }
}

/// Returns the sum of the vectors across the triangles of a fan around the first corner.
fn across(corners: &[DVec3]) -> DVec3 {
    let Some((first, others)) = corners.split_first() else {
        return DVec3::ZERO;
    };
    let triangles = others.windows(2);
    let triangles = triangles.map(|pair| (pair[0] - *first).cross(pair[1] - *first));
    triangles.sum()
}

/// Returns orthonormal axes along which points extend from the most to the least, and the number of those
/// along which they extend at all. The points lie in the unit box around the origin.
fn main_axes(points: &[DVec3]) -> (DMat3, usize) {
    let origin = points[0];
    let mut square = DMat3::ZERO;
    for point in points {
        let away = *point - origin;
        square += DMat3::from_cols(away * away.x, away * away.y, away * away.z);
    }
    let (values, vectors) = eigen(&square);
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
    let axes = order.map(|axis| vectors.col(axis));
    let extends = |axis: &DVec3| {
        let away = points
            .iter()
            .map(|point| (*point - origin).dot(*axis).abs());
        away.fold(0.0, f64::max) > ROUNDING
    };
    let rank = axes.iter().take_while(|axis| extends(axis)).count();
    let [x, y, z] = axes;
    (DMat3::from_cols(x, y, z), rank)
}

impl Outline<Frame3> for Solid {
    /// Returns `false` for a segment, which is a line.
    fn is_closed(&self) -> bool {
        self.round.is_some() || self.corners.len() != 2
    }

    fn complexity(&self) -> usize {
        self.corners.len()
    }

    /// Returns the number of axes along which the solid extends.
    fn dimension(&self) -> f64 {
        let linear = self.place.matrix3;
        let axes = [linear.x_axis, linear.y_axis, linear.z_axis];
        axes.into_iter()
            .filter(|axis| *axis != DVec3::ZERO)
            .map(|_| 1.0)
            .sum()
    }

    fn is_line(&self) -> bool {
        self.ends_meet_frame() == [true; 2]
    }

    fn ends_meet_frame(&self) -> [bool; 2] {
        [DVec3::ZERO, DVec3::X].map(|end| !self.is_closed() && self.corners.contains(&end))
    }

    /// Returns the area of the surface; of a flat solid, that of one side.
    fn signed_area(&self) -> f64 {
        let sides = if self.dimension() < 3.0 { 2.0 } else { 1.0 };
        self.surface / sides
    }

    fn volume(&self) -> f64 {
        self.volume
    }

    fn support(&self, direction: DVec3) -> f64 {
        if let Some(round) = self.round {
            let inside = self.place.matrix3.transpose() * direction;
            return self.place.translation.dot(direction) + round.support(inside);
        }
        let along = self.corners.iter().map(|corner| corner.dot(direction));
        along.fold(f64::NEG_INFINITY, f64::max)
    }

    fn add_to(&self, bounds: &mut Bounds<DVec3>, frame: &Frame3, pad: f64) {
        let own = self.bounds(frame.map());
        if !own.is_empty() {
            bounds.add(own.min() - pad);
            bounds.add(own.max() + pad);
        }
    }

    fn add_corners(&self, corners: &mut Vec<DVec3>, frame: &Frame3) -> bool {
        corners.extend(self.corners.iter().map(|corner| frame.apply(*corner)));
        self.round.is_none()
    }
}
