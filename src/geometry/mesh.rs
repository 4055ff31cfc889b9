//! Polygon meshes of solids.

use glam::{DAffine3, DVec3};

use super::{Round, Solid};
use crate::expression::degrees;

/// Mesh of polygons with shared corners.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners.
    pub corners: Vec<DVec3>,
    /// Faces: the indices of their corners, counter-clockwise from outside.
    pub faces: Vec<Vec<usize>>,
}

impl Mesh {
    /// Returns the triangles of the faces, which are convex: fans around their first corners.
    #[must_use]
    pub fn triangles(&self) -> Vec<[usize; 3]> {
        let faces = self.faces.iter().flat_map(|face| {
            let others = face[1..].windows(2);
            others.map(|pair| [face[0], pair[0], pair[1]])
        });
        faces.collect()
    }
}

/// Number of sides of a circle.
const SIDES: u32 = 48;

impl From<&Solid> for Mesh {
    /// Returns the surface of a solid. One in a plane has a single face, and one on a line has none. Circles have
    /// 48 sides, with the corners on them.
    fn from(solid: &Solid) -> Self {
        Self::with_sides(solid, SIDES)
    }
}

impl Mesh {
    /// Returns the surface of a solid, whose circles have an even number of sides.
    pub(crate) fn with_sides(solid: &Solid, sides: u32) -> Self {
        if let Some(primitive) = solid.primitive() {
            return Self::round(primitive, solid.place(), sides);
        }
        let mut mesh = Self::default();
        for face in solid.polygons() {
            let mut corner = |point: &DVec3| {
                let known = mesh.corners.iter().position(|known| known == point);
                known.unwrap_or_else(|| mesh.push(*point))
            };
            let face = face.iter().map(&mut corner).collect();
            mesh.faces.push(face);
        }
        mesh
    }

    /// Returns the unit normal of the image of a face under a map.
    pub(crate) fn normal(&self, face: usize, map: &DAffine3) -> DVec3 {
        let corners = { self.faces[face].iter() }.map(|it| map.transform_point3(self.corners[*it]));
        let next = corners.clone().cycle().skip(1);
        let around: DVec3 = corners.zip(next).map(|(from, to)| from.cross(to)).sum();
        around.normalize_or_zero() * map.matrix3.determinant().signum()
    }

    fn push(&mut self, corner: DVec3) -> usize {
        self.corners.push(corner);
        self.corners.len() - 1
    }

    /// Returns the image of a round primitive under a map.
    fn round(primitive: Round, place: &DAffine3, sides: u32) -> Self {
        let mut mesh = Self::default();
        // Circles about the y axis by height and radius, from the bottom to the top; a radius of 0 is a pole.
        let circles: Vec<[f64; 2]> = match primitive {
            Round::Ball => {
                let angles = (0..=sides / 2).map(|part| 360.0 * f64::from(part) / f64::from(sides));
                angles
                    .map(|angle| [-degrees::cos(angle), degrees::sin(angle)])
                    .collect()
            }
            // Without a height, it is a disk.
            Round::Cylinder if place.matrix3.y_axis == DVec3::ZERO => vec![[0.0, 1.0]],
            Round::Cylinder => vec![[0.0, 1.0], [1.0, 1.0]],
            Round::Cone => vec![[0.0, 1.0], [1.0, 0.0]],
        };
        let mut below: Vec<usize> = Vec::new();
        for (number, &[height, radius]) in circles.iter().enumerate() {
            let angles = (0..sides).map(|part| 360.0 * f64::from(part) / f64::from(sides));
            let circle: Vec<usize> = if radius == 0.0 {
                vec![mesh.push(DVec3::Y * height)]
            } else {
                let at = |angle| {
                    DVec3::new(
                        radius * degrees::cos(angle),
                        height,
                        -radius * degrees::sin(angle),
                    )
                };
                angles.map(|angle| mesh.push(at(angle))).collect()
            };
            let sides = circle.len().max(below.len());
            for side in 0..sides {
                let of = |circle: &[usize], side: usize| circle[side % circle.len()];
                if below.is_empty() {
                    break;
                }
                let mut face = vec![
                    of(&below, side),
                    of(&below, side + 1),
                    of(&circle, side + 1),
                    of(&circle, side),
                ];
                face.dedup();
                mesh.faces.push(face);
            }
            // Disks below and above.
            if circle.len() > 1 && number == 0 && circles.len() > 1 {
                mesh.faces.push(circle.iter().rev().copied().collect());
            }
            if circle.len() > 1 && number + 1 == circles.len() {
                mesh.faces.push(circle.clone());
            }
            below = circle;
        }
        for corner in &mut mesh.corners {
            *corner = place.transform_point3(*corner);
        }
        if place.matrix3.determinant() < 0.0 {
            mesh.faces.iter_mut().for_each(|face| face.reverse());
        }
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::DMat3;

    /// Returns the volume, by the divergence theorem.
    fn volume(mesh: &Mesh) -> f64 {
        let triangles = mesh.triangles().into_iter();
        let volume = |[a, b, c]: [usize; 3]| {
            let [a, b, c] = [a, b, c].map(|corner| mesh.corners[corner]);
            a.dot(b.cross(c)) / 6.0
        };
        triangles.map(volume).sum()
    }

    #[test]
    fn round_meshes_are_closed_turn_outwards_and_have_the_volume() {
        let linear = DMat3::from_cols(
            DVec3::new(-2.0, 0.5, 0.0),
            DVec3::Y,
            DVec3::new(0.0, 0.3, 1.0),
        );
        let place = DAffine3::from_mat3_translation(linear, DVec3::new(1.0, 2.0, 3.0));
        let pi = std::f64::consts::PI;
        let all = [
            (Round::Ball, 4.0 * pi / 3.0),
            (Round::Cylinder, pi),
            (Round::Cone, pi / 3.0),
        ];
        for (primitive, unit) in all {
            let mesh = Mesh::from(&Solid::round(primitive, place));
            let expected = unit * linear.determinant().abs();
            let share = volume(&mesh) / expected;
            // An inscribed polygon of 48 sides has 0.997 of the area of its circle.
            assert!((0.99..1.0).contains(&share), "{primitive:?}: {share}");
            let mut edges = std::collections::BTreeSet::new();
            for face in &mesh.faces {
                for (number, &from) in face.iter().enumerate() {
                    assert!(
                        edges.insert([from, face[(number + 1) % face.len()]]),
                        "{primitive:?}"
                    );
                }
            }
            assert!(edges.iter().all(|[from, to]| edges.contains(&[*to, *from])));
        }
    }
}
