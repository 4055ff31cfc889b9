//! Resolution of base elements in space.

use crate::diagnostic::Place;
use crate::document::{BaseElementDocument, SurfaceDocument};
use crate::expression::degrees;
use crate::geometry::{
    Attitude, Bounds, DAffine3, DMat3, DVec3, Direction, Frame3, PolygonError, Round, Side, Solid,
    polygon,
};
use crate::resolve::{Resolver, whole_number};
use crate::rule::{BaseElement, Body, Surface, newell};

/// Number of chords of a curve of an outline in space.
const CHORDS: u32 = 16;

/// Largest number of surfaces, solids and lines of a base element.
const MAX_SURFACES: usize = 2000;

/// Largest number of points of surfaces that are tried as those of one convex solid.
const MAX_CORNERS: usize = 40;

/// Parts of a base element that are read so far.
#[derive(Default)]
struct Pieces {
    surfaces: Vec<Surface>,
    /// Corners of the polygons as listed.
    faces: Vec<Vec<DVec3>>,
    has_lines: bool,
    is_closed: bool,
    /// Width of the tubes that lines are, in the base element's own coordinates.
    tube: Option<f64>,
}

impl<K> Resolver<K> {
    /// Resolves a base element in space. Lines are tubes of a width, as a multiple of the element's length, if one is given.
    /// Reports mistakes and returns `None`.
    pub(in crate::resolve) fn body(
        &mut self,
        document: &BaseElementDocument,
        tube: Option<f64>,
    ) -> Option<Body> {
        let before = self.mistakes;
        let mut pieces = Pieces {
            tube: self.tube(document, tube),
            ..Pieces::default()
        };
        if document.pieces.is_some() {
            self.outline_in_space(document, &mut pieces);
        }
        for surface in document.surfaces.iter().flatten() {
            self.surface(surface, &mut pieces);
        }
        for line in document.lines.iter().flatten() {
            let Some(points) = self.constants_in_space(line) else {
                continue;
            };
            if points.len() < 2 {
                let message = "a line has two points or more";
                let place = line.first().map_or(&document.place, |point| &point.place);
                self.error_with_hint(
                    &place.first_line(),
                    message,
                    "lines: [[[0, 0, 0], [1, 0, 0]]]",
                );
            }
            pieces.add_lines(&points);
        }
        for set in document.solids.iter().flatten() {
            if let Some(solids) = self.solids(set) {
                pieces.is_closed |= solids.iter().all(|solid| solid.faces().len() > 1);
                let solids = solids.iter().cloned();
                pieces.surfaces.extend(solids.map(Surface::from));
            }
        }
        if let Some(name) = &document.solid {
            self.named_solid(&name.value, document, &mut pieces);
        }
        let frame = self.frame_of_body(document);
        if self.mistakes > before {
            return None;
        }
        let back = frame?.map().inverse();
        pieces.join();
        self.check_surfaces(pieces.surfaces.len(), &document.place)?;
        let surfaces = pieces.surfaces.iter().map(|it| transformed(it, &back));
        let face = pieces.faces.first().map_or(&[][..], Vec::as_slice);
        let face = face.iter().map(|corner| back.transform_point3(*corner));
        let is_reported = pieces.surfaces.is_empty() && document.pieces.is_none();
        let body = Body::new(surfaces.collect(), face.collect(), pieces.is_closed);
        // A base element without a shape was reported when the file was read.
        if body.is_none() && !is_reported {
            let hint = "its points must not all be the same";
            self.error_with_hint(&document.place, "this base element has no extent", hint);
        }
        body
    }

    /// Reports a base element of too many surfaces and returns `None`.
    pub(in crate::resolve) fn check_surfaces(&mut self, count: usize, place: &Place) -> Option<()> {
        if count <= MAX_SURFACES {
            return Some(());
        }
        let message = format!(
            "a base element has no more than {MAX_SURFACES} surfaces, and this one has {count}"
        );
        self.error(place, message);
        None
    }

    /// Returns the width of lines, in the base element's own coordinates: its own, or that of a `tube`.
    fn tube(&mut self, document: &BaseElementDocument, tube: Option<f64>) -> Option<f64> {
        let own = self.optional(document.width.as_ref()).flatten();
        if let Some(width) = own.filter(|_| document.lines.is_some()) {
            return Some(width).filter(|width| *width > 0.0);
        }
        let width = tube?;
        let from = self.constant_in_space(document.from.as_ref(), DVec3::ZERO)?;
        let to = self.constant_in_space(document.to.as_ref(), DVec3::X)?;
        Some(width * from.distance(to))
    }

    /// Returns the frame that `from` and `to` define in the base element's own coordinates.
    fn frame_of_body(&mut self, document: &BaseElementDocument) -> Option<Frame3> {
        let from = self.constant_in_space(document.from.as_ref(), DVec3::ZERO)?;
        let to = self.constant_in_space(document.to.as_ref(), DVec3::X)?;
        if from == to {
            self.report_no_base(document);
        }
        Some(Frame3::between(
            from,
            to,
            Direction::Normal,
            Attitude::Least,
        ))
    }

    /// Adds an outline: lines and polygons in space, or with curves in the plane z = 0.
    fn outline_in_space(&mut self, document: &BaseElementDocument, pieces: &mut Pieces) {
        let written = document.pieces.as_deref().unwrap_or_default();
        let ends: Vec<_> = written.iter().map(|piece| piece.end().clone()).collect();
        let has_depth = ends.iter().any(|end| end.z.is_some());
        let corners = if has_depth {
            if let Some(curve) = written.iter().find(|piece| piece.is_curved()) {
                let message = "curves lie in the plane z = 0, and this outline does not";
                let hint = "write all of its points with two numbers, or straight lines only";
                self.error_with_hint(&curve.end().place, message, hint);
                return;
            }
            self.constants_in_space(&ends)
        } else {
            let outline = self.outline(document);
            outline.and_then(|(start, pieces)| {
                let outline = BaseElement::new(start, pieces, document.closed)?;
                let corners = outline.corners(&crate::geometry::DAffine2::IDENTITY, CHORDS);
                Some(
                    corners
                        .into_iter()
                        .map(|corner| corner.extend(0.0))
                        .collect(),
                )
            })
        };
        let Some(mut corners) = corners else { return };
        if !document.closed {
            pieces.add_lines(&corners);
            return;
        }
        if corners.first() == corners.last() {
            corners.pop();
        }
        let front = match has_depth {
            true => newell(corners.iter().copied()),
            false => DVec3::Z,
        };
        if let Err(error) = pieces.add_polygon(&corners, front, None, true) {
            self.error_with_hint(
                &document.place,
                error.to_string(),
                "a surface is a polygon in a plane",
            );
        }
    }

    fn surface(&mut self, document: &SurfaceDocument, pieces: &mut Pieces) {
        let corners = self.constants_in_space(&document.points);
        let given = document
            .normal
            .as_ref()
            .map(|it| self.constant_in_space(Some(it), DVec3::Z));
        let sides = self.optional(document.sides.as_ref());
        if let (Some(number), Some(Some(value))) = (&document.sides, sides)
            && whole_number(value, 2).is_none_or(|sides| sides == 0)
        {
            let message = "a surface has one side or two";
            self.error_with_hint(
                &number.place,
                message,
                "sides: 2 lets meshes show its back, too",
            );
        }
        let (Some(corners), Some(sides)) = (corners, sides) else {
            return;
        };
        let across = newell(corners.iter().copied());
        let front = match given {
            None => across,
            Some(None) => return,
            Some(Some(normal)) => normal,
        };
        if front == DVec3::ZERO && across != DVec3::ZERO {
            let place = document
                .normal
                .as_ref()
                .map_or(&document.place, |normal| &normal.place);
            self.error_with_hint(place, "this normal has no length", "normal: [0, 0, 1]");
            return;
        }
        let color = document.color;
        match pieces.add_polygon(&corners, front, color, sides == Some(2.0)) {
            Ok(()) => {}
            Err(PolygonError::NotFlat(number)) => {
                let message =
                    "the points of this surface do not lie in a plane: it is drawn as triangles";
                let hint = "write several surfaces, each in a plane";
                self.warn(&document.points[number].place, message, hint);
                let ends = corners[1..].windows(2);
                for pair in ends {
                    let triangle = [corners[0], pair[0], pair[1]];
                    let front = given.flatten().unwrap_or(newell(triangle.into_iter()));
                    // A triangle without extent is none.
                    let _ = pieces.add_polygon(&triangle, front, color, sides == Some(2.0));
                }
            }
            Err(error) => {
                let hint = "its points are the corners of a polygon, in order";
                self.error_with_hint(&document.place, error.to_string(), hint);
            }
        }
    }

    fn named_solid(&mut self, name: &str, document: &BaseElementDocument, pieces: &mut Pieces) {
        let width = self.optional(document.width.as_ref());
        let Some(width) = width else { return };
        if let (Some(number), Some(width)) = (&document.width, width)
            && width <= 0.0
        {
            self.error(
                &number.place,
                format!("{width} is no width: it must be above 0"),
            );
            return;
        }
        pieces.is_closed = true;
        let half = width.unwrap_or(if name == "bar" { 0.25 } else { 1.0 }) / 2.0;
        let round = |primitive, linear| {
            let place = DAffine3::from_mat3_translation(linear, DVec3::ZERO);
            Solid::round(primitive, place)
        };
        // The y axis of the primitives lies along the element.
        let shaft = DMat3::from_cols(DVec3::NEG_Y * half, DVec3::X, DVec3::Z * half);
        let solid = match name {
            "sphere" => {
                let linear = DMat3::from_diagonal(DVec3::splat(0.5));
                let place = DAffine3::from_mat3_translation(linear, DVec3::X / 2.0);
                Solid::round(Round::Ball, place)
            }
            "cylinder" => round(Round::Cylinder, shaft),
            "cone" => round(Round::Cone, shaft),
            "bar" => Solid::cuboid(&Bounds::new(
                DVec3::new(0.0, -half, -half),
                DVec3::new(1.0, half, half),
            )),
            "cube" => {
                pieces.faces.push(regular_polygon(4));
                Solid::cuboid(&Bounds::new(DVec3::NEG_Z, DVec3::new(1.0, 1.0, 0.0)))
            }
            _ => {
                let Some((sides, corners)) = behind_face(name) else {
                    // An unknown name was reported when the file was read.
                    return;
                };
                pieces.faces.push(regular_polygon(sides));
                Solid::hull(&corners)
            }
        };
        pieces.surfaces.push(solid.into());
    }
}

impl Pieces {
    fn add_lines(&mut self, points: &[DVec3]) {
        self.has_lines = true;
        if let Some(width) = self.tube {
            self.surfaces.extend(tube(points, width));
            return;
        }
        let pairs = points.windows(2).filter(|pair| pair[0] != pair[1]);
        self.surfaces
            .extend(pairs.map(|pair| Solid::hull(pair).into()));
    }

    fn add_polygon(
        &mut self,
        corners: &[DVec3],
        front: DVec3,
        color: Option<crate::style::Colour>,
        is_double: bool,
    ) -> Result<(), PolygonError> {
        let side = Side {
            normal: front.normalize_or_zero(),
            is_double,
        };
        let solids = polygon(corners)?;
        let surfaces = solids.into_iter().map(|solid| Surface {
            solid: solid.with_side(side),
            color,
        });
        self.surfaces.extend(surfaces);
        self.faces.push(corners.to_vec());
        Ok(())
    }

    /// Replaces surfaces that enclose a convex solid by that, if they have no colours and no normals of their own.
    fn join(&mut self) {
        let is_plain =
            |surface: &Surface| surface.color.is_none() && surface.solid.side().is_some();
        if self.has_lines
            || self.is_closed
            || self.faces.len() < 4
            || !self.surfaces.iter().all(is_plain)
        {
            return;
        }
        self.is_closed = is_closed(&self.faces);
        let mut corners: Vec<DVec3> = Vec::new();
        for corner in self.faces.iter().flatten() {
            if !corners.contains(corner) {
                corners.push(*corner);
            }
        }
        if !self.is_closed || corners.len() > MAX_CORNERS {
            return;
        }
        let hull = Solid::hull(&corners);
        let size = hull.place().matrix3.x_axis.length();
        let bounds_all = self.faces.iter().all(|face| {
            let across = newell(face.iter().copied()).normalize_or_zero();
            let beyond = |corner: &DVec3| across.dot(*corner - face[0]) > 1e-9 * size;
            !corners.iter().any(beyond)
        });
        let is_across = |surface: &Surface, face: &Vec<DVec3>| {
            let across = newell(face.iter().copied()).normalize_or_zero();
            surface
                .solid
                .side()
                .is_some_and(|side| side.normal.dot(across) > 1.0 - 1e-9)
        };
        let own_normals = self.surfaces.len() == self.faces.len()
            && self
                .surfaces
                .iter()
                .zip(&self.faces)
                .all(|(surface, face)| is_across(surface, face));
        if bounds_all && own_normals {
            self.surfaces = vec![hull.into()];
        }
    }
}

/// Returns a tube along a line: cylinders between its points, and balls about them.
pub(super) fn tube(points: &[DVec3], width: f64) -> Vec<Surface> {
    let half = width / 2.0;
    let pairs = points.windows(2).filter(|pair| pair[0] != pair[1]);
    let shafts = pairs.map(|pair| {
        let along = pair[1] - pair[0];
        let (right, front) = along.normalize().any_orthonormal_pair();
        let linear = DMat3::from_cols(right * half, along, front * half);
        Solid::round(
            Round::Cylinder,
            DAffine3::from_mat3_translation(linear, pair[0]),
        )
    });
    let ball = DMat3::from_diagonal(DVec3::splat(half));
    let balls = points
        .iter()
        .map(|point| Solid::round(Round::Ball, DAffine3::from_mat3_translation(ball, *point)));
    shafts.chain(balls).map(Surface::from).collect()
}

/// Returns whether every edge of polygons is one of two of them, in opposite directions.
fn is_closed(faces: &[Vec<DVec3>]) -> bool {
    let edges = || {
        faces.iter().flat_map(|face| {
            let next = face.iter().cycle().skip(1);
            face.iter().copied().zip(next.copied())
        })
    };
    let count = |from: DVec3, to: DVec3| edges().filter(|edge| *edge == (from, to)).count();
    edges().count() <= MAX_SURFACES
        && edges().all(|(from, to)| count(from, to) == 1 && count(to, from) == 1)
}

/// Returns the regular polygon that runs counter-clockwise in the plane z = 0, with its first side from (0, 0, 0) to
/// (1, 0, 0).
fn regular_polygon(sides: u32) -> Vec<DVec3> {
    let turn = 360.0 / f64::from(sides);
    let mut at = DVec3::ZERO;
    let corners = (0..sides).map(|side| {
        let corner = at;
        let angle = turn * f64::from(side);
        at += DVec3::new(degrees::cos(angle), degrees::sin(angle), 0.0);
        corner
    });
    corners.collect()
}

/// Returns the number of sides of a face of a Platonic solid with edges of length 1, and the corners of the solid behind
/// its face that is [regular polygon](regular_polygon).
fn behind_face(name: &str) -> Option<(u32, Vec<DVec3>)> {
    // Corners about the origin, by their coordinates on the axes of the golden rectangles (Coxeter, "Regular
    // Polytopes", 3.7), and the squared length of edges.
    let phi = f64::midpoint(1.0, 5.0_f64.sqrt());
    let signs = [1.0, -1.0];
    let cyclic = |a: f64, b: f64| {
        let pairs = signs
            .into_iter()
            .flat_map(move |s| signs.map(move |t| (s * a, t * b)));
        pairs.flat_map(|(a, b)| {
            [
                DVec3::new(0.0, a, b),
                DVec3::new(b, 0.0, a),
                DVec3::new(a, b, 0.0),
            ]
        })
    };
    let cube = || {
        let corners = signs
            .into_iter()
            .flat_map(move |x| signs.map(move |y| (x, y)));
        corners.flat_map(move |(x, y)| signs.map(move |z| DVec3::new(x, y, z)))
    };
    let (sides, edge, corners): (u32, f64, Vec<DVec3>) = match name {
        "tetrahedron" => {
            let even = cube().filter(|it| it.x * it.y * it.z > 0.0);
            (3, 8.0_f64.sqrt(), even.collect())
        }
        "octahedron" => {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z];
            let corners = axes.into_iter().flat_map(|axis| [axis, -axis]);
            (3, 2.0_f64.sqrt(), corners.collect())
        }
        "icosahedron" => (3, 2.0, cyclic(1.0, phi).collect()),
        "dodecahedron" => (5, 2.0 / phi, cube().chain(cyclic(1.0 / phi, phi)).collect()),
        _ => return None,
    };
    // The first corner, one of its neighbours, and the corner of a face after these.
    let is_edge = |a: DVec3, b: DVec3| ((a - b).length() - edge).abs() < 1e-9;
    let first = corners[0];
    let second = *corners.iter().find(|it| is_edge(first, **it))?;
    let angle = 180.0 - 360.0 / f64::from(sides);
    let third = corners.iter().find(|it| {
        let cosine = (first - second).dot(**it - second) / (edge * edge);
        is_edge(second, **it) && **it != first && (cosine - degrees::cos(angle)).abs() < 1e-9
    });
    let normal = (second - first).cross(*third? - second);
    // The solid lies behind the face: the face is away from the middle.
    let (from, to, normal) = match normal.dot(first) > 0.0 {
        true => (first, second, normal),
        false => (second, first, -normal),
    };
    let frame = Frame3::between(from, to, Direction::Normal, Attitude::Normal(normal));
    let back = frame.map().inverse();
    let corners = corners.iter().map(|corner| back.transform_point3(*corner));
    // Coordinates that are 0 and 1 but for rounding.
    let exact = |value: f64| {
        let near = value.round();
        if (value - near).abs() < 1e-12 {
            near + 0.0
        } else {
            value
        }
    };
    Some((sides, corners.map(|it| it.map(exact)).collect()))
}

/// Returns the image of a surface under a similarity.
fn transformed(surface: &Surface, map: &DAffine3) -> Surface {
    if *map == DAffine3::IDENTITY {
        return surface.clone();
    }
    let solid = surface.solid.transformed(map);
    Surface {
        solid,
        color: surface.color,
    }
}
