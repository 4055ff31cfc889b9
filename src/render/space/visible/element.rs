//! Faces of elements as polygons on a picture.

use crate::geometry::{DAffine3, DMat3, DVec2, DVec3, HalfSpace, Mesh, Solid, convex_hull};

use super::super::camera::{Placement, Projection};
use super::polygon::{Corner, Polygon, clip};
use crate::style::{Light, Shade};

/// Cosine of the angle between faces of a round body from which their common edge is not drawn.
const SMOOTH: f64 = 0.9;

/// Share of the largest nearness that is a rounding error.
const TOLERANCE: f64 = 1e-8;

/// Tolerance of the corners of a section, relative to its size.
const ROUNDING: f64 = 1e-9;

/// Numbers of sides of circles, and the radii in pixels up to which they have so many: a circle is at most a tenth
/// of a pixel from its polygon, but for large ones.
const SIDES: [(u32, f64); 4] = [(6, 0.75), (12, 2.9), (24, 11.7), (48, f64::INFINITY)];

/// Surface of the elements of a base element, with the sides of circles that fit their sizes.
pub(super) struct Shape {
    /// Radii of the circles of a round body before it is mapped, as vectors.
    radii: [DVec3; 2],
    /// Surfaces by number of sides; a single one of other bodies.
    surfaces: Vec<Surface>,
}

impl Shape {
    pub(super) fn new(solid: &Solid) -> Self {
        let matrix = solid.place().matrix3;
        let sides = match solid.primitive() {
            Some(_) => &SIDES[..],
            None => &SIDES[..1],
        };
        Self {
            radii: [matrix.x_axis, matrix.z_axis],
            surfaces: sides
                .iter()
                .map(|(sides, _)| Surface::new(solid, *sides))
                .collect(),
        }
    }

    /// Returns the surface under a map to pixels.
    fn surface(&self, map: &DMat3, scale: f64) -> &Surface {
        let radii = self.radii.map(|radius| (*map * radius).length() * scale);
        let radius = radii[0].max(radii[1]);
        let fits = SIDES.iter().position(|(_, most)| radius <= *most);
        let last = self.surfaces.len() - 1;
        &self.surfaces[fits.unwrap_or(last).min(last)]
    }
}

/// Surface of a body.
struct Surface {
    mesh: Mesh,
    /// For every edge of every face, the face beyond it if lines do not show the edge between the two.
    smooth: Vec<Vec<Option<usize>>>,
    /// Whether the faces enclose a body.
    is_closed: bool,
}

impl Surface {
    fn new(solid: &Solid, sides: u32) -> Self {
        let mut mesh = Mesh::with_sides(solid, sides);
        if mesh.faces.is_empty() {
            mesh.corners = solid.corners().to_vec();
        }
        let is_round = solid.primitive().is_some();
        let normals: Vec<DVec3> = (mesh.faces.iter())
            .map(|face| normal(face.iter().map(|corner| mesh.corners[*corner])).normalize_or_zero())
            .collect();
        let smooth = mesh.faces.iter().enumerate().map(|(number, face)| {
            let edges = face.iter().zip(face.iter().cycle().skip(1));
            let beyond = edges.map(|(from, to)| {
                let is_other = |other: &Vec<usize>| {
                    let mut ends = other.iter().zip(other.iter().cycle().skip(1));
                    ends.any(|(a, b)| a == to && b == from)
                };
                let other = mesh.faces.iter().position(is_other).filter(|_| is_round)?;
                (normals[number].dot(normals[other]) > SMOOTH).then_some(other)
            });
            beyond.collect()
        });
        Self {
            smooth: smooth.collect(),
            is_closed: mesh.faces.len() > 1,
            mesh,
        }
    }
}

/// Returns the vector across a polygon, twice as long as its area is large (Newell's method, after Sutherland,
/// Sproull & Schumacker 1974).
fn normal(corners: impl Iterator<Item = DVec3> + Clone) -> DVec3 {
    let next = corners.clone().cycle().skip(1);
    let pairs = corners.zip(next);
    pairs.map(|(from, to)| from.cross(to)).sum()
}

/// The viewer: placement and light.
pub(super) struct Viewer<'a> {
    pub(super) placement: &'a Placement,
    /// Half-spaces to which the picture is confined, in the coordinates of the projection.
    pub(super) cuts: Vec<HalfSpace>,
    /// Half-space whose boundary is the plane of a section, if there is one.
    pub(super) section: Option<HalfSpace>,
    pub(super) shade: Shade,
    pub(super) light: Light,
    /// Map of normals in the coordinates of the projection to space.
    pub(super) normals: DMat3,
    /// Samples a pixel.
    pub(super) samples: f64,
}

/// Part of an element on the picture.
pub(super) enum Part {
    /// A face, the intensity of its colour, and its unit normal towards the viewer.
    Face(Polygon, f64, DVec3),
    /// An element that is a line, or the section of a flat one, and the intensity of its colour.
    Line([DVec3; 2], f64),
}

impl Viewer<'_> {
    /// Calls `give` for the faces of an element of a shape that look at the viewer, for the element if it is a line, or for
    /// its section.
    pub(super) fn faces(&self, shape: &Shape, map: &DAffine3, mut give: impl FnMut(Part)) {
        let map = self.placement.map * *map;
        let surface = shape.surface(&map.matrix3, self.scale(map.translation.z));
        let corners: Vec<DVec3> = { surface.mesh.corners.iter() }
            .map(|corner| map.transform_point3(*corner))
            .collect();
        let is_beyond = |cut: &HalfSpace| {
            let mut values = corners.iter().map(|it| cut.normal.dot(*it) - cut.distance);
            values.all(|value| value >= 0.0)
        };
        if self.cuts.iter().any(is_beyond) {
            return;
        }
        if let Some(plane) = &self.section {
            let section = section(surface, &corners, plane);
            self.give(section, plane.normal, None, &mut give);
            return;
        }
        if surface.mesh.faces.is_empty() {
            let ends = corners.iter().map(|at| Corner {
                at: *at,
                is_edge: true,
            });
            self.give(ends.collect(), DVec3::Z, None, &mut give);
            return;
        }
        // Mirrored faces run the other way about.
        let side = map.matrix3.determinant();
        let outward: Vec<DVec3> = { surface.mesh.faces.iter() }
            .map(|face| normal(face.iter().map(|corner| corners[*corner])) * side.signum())
            .collect();
        let faces_viewer = |face: usize| {
            let first = corners[surface.mesh.faces[face][0]];
            self.faces_viewer(outward[face], first)
        };
        // A flat image of a body has two sides.
        let has_back = surface.is_closed && side != 0.0;
        for (number, face) in surface.mesh.faces.iter().enumerate() {
            let is_front = faces_viewer(number);
            if has_back && !is_front {
                continue;
            }
            let edges = face.iter().zip(&surface.smooth[number]);
            let around = edges.map(|(corner, beyond)| Corner {
                at: corners[*corner],
                is_edge: beyond.is_none_or(|beyond| !faces_viewer(beyond)),
            });
            self.give(around.collect(), outward[number], None, &mut give);
        }
        if has_back {
            for (number, cut) in self.cuts.iter().enumerate() {
                let section = section(surface, &corners, cut);
                if section
                    .first()
                    .is_some_and(|it| self.faces_viewer(cut.normal, it.at))
                {
                    self.give(section, cut.normal, Some(number), &mut give);
                }
            }
        }
    }

    /// Returns whether a face with an outward normal is seen from its outer side.
    fn faces_viewer(&self, outward: DVec3, point: DVec3) -> bool {
        match self.placement.projection {
            Projection::Parallel => outward.z > 0.0,
            Projection::Central { .. } => outward.dot(point) < 0.0,
        }
    }

    /// Gives the part of a face that the cuts leave, other than one in whose plane it lies.
    fn give(
        &self,
        mut corners: Vec<Corner>,
        outward: DVec3,
        own: Option<usize>,
        give: &mut impl FnMut(Part),
    ) {
        let is_line = corners.len() == 2;
        for (number, cut) in self.cuts.iter().enumerate() {
            if own != Some(number) {
                corners = clip(&corners, true, |at| cut.normal.dot(at) - cut.distance);
            }
        }
        let Some(first) = corners.first() else {
            return;
        };
        let side = if self.faces_viewer(outward, first.at) {
            1.0
        } else {
            -1.0
        };
        let normal = (self.normals * outward * side).normalize_or_zero();
        let intensity = self.intensity(&corners, Some(normal).filter(|_| !is_line));
        for corner in &mut corners {
            corner.at = self.seen(corner.at);
        }
        if is_line {
            let (from, to) = (corners[0].at, corners[corners.len() / 2].at);
            give(Part::Line([from, to], intensity));
        } else if let Some(polygon) = Polygon::new(corners) {
            give(Part::Face(polygon, intensity, normal));
        }
    }

    /// Returns the number of pixels a unit at a z.
    fn scale(&self, z: f64) -> f64 {
        match self.placement.projection {
            Projection::Parallel => 1.0 / self.samples,
            Projection::Central { focus, .. } => focus / -z / self.samples,
        }
    }

    /// Returns position and nearness of a point.
    fn seen(&self, point: DVec3) -> DVec3 {
        match self.placement.projection {
            Projection::Parallel => point / self.samples,
            Projection::Central { focus, middle } => {
                let away = -point.z;
                let at = DVec2::from(middle) + point.truncate() * focus / away;
                (at / self.samples).extend(1.0 / away)
            }
        }
    }

    /// Returns the largest difference of nearness that is a rounding error.
    pub(super) fn tolerance(&self) -> f64 {
        let [far, near] = self.placement.range;
        let [width, height] = self.placement.size.map(f64::from);
        let largest = match self.placement.projection {
            Projection::Parallel => (far.abs() + near.abs()) / self.samples + width + height,
            Projection::Central { .. } => 1.0 / near.abs(),
        };
        TOLERANCE * largest
    }

    /// Returns the intensity of a face with a normal, or of a line, with the depth of the mean of its corners.
    fn intensity(&self, corners: &[Corner], normal: Option<DVec3>) -> f64 {
        let mut intensity = 1.0;
        if self.shade.cues_depth() {
            let [far, near] = self.placement.range;
            #[expect(clippy::cast_precision_loss, reason = "faces have few corners")]
            let mean =
                { corners.iter() }.map(|corner| corner.at.z).sum::<f64>() / corners.len() as f64;
            if near > far {
                intensity *= ((mean - far) / (near - far)).clamp(0.0, 1.0);
            }
        }
        if let Some(normal) = normal.filter(|_| self.shade.has_relief(false)) {
            intensity *= self.light.intensity(normal.dot(self.light.towards()));
        }
        intensity
    }
}

/// Returns the polygon in which a plane cuts a convex body, or the two ends of a line.
fn section(surface: &Surface, corners: &[DVec3], cut: &HalfSpace) -> Vec<Corner> {
    let value = |at: DVec3| cut.normal.dot(at) - cut.distance;
    let mut points = Vec::new();
    for face in &surface.mesh.faces {
        for (from, to) in face.iter().zip(face.iter().cycle().skip(1)) {
            let [from, to] = [corners[*from], corners[*to]];
            let [here, there] = [value(from), value(to)];
            if here == 0.0 {
                points.push(from);
            } else if (here < 0.0) != (there < 0.0) && there != 0.0 {
                points.push(from.lerp(to, here / (here - there)));
            }
        }
    }
    let Some(&origin) = points.first() else {
        return Vec::new();
    };
    let (right, up) = cut.normal.normalize_or(DVec3::Z).any_orthonormal_pair();
    let flat = |point: &DVec3| {
        let away = *point - origin;
        DVec2::new(away.dot(right), away.dot(up))
    };
    let flat: Vec<DVec2> = points.iter().map(flat).collect();
    let size = flat.iter().map(|it| it.length()).fold(0.0, f64::max);
    let around = convex_hull(flat, ROUNDING * size);
    let corner = |it: &DVec2| Corner {
        at: origin + right * it.x + up * it.y,
        is_edge: true,
    };
    around.iter().map(corner).collect()
}
