//! Resolution of points, turns and sets in space.

use std::sync::Arc;

use crate::diagnostic::Place;
use crate::document::{
    EllipseDocument, FormDocument, MeshDocument, ShaftDocument, ShapeDocument, SolidDocument,
    TurnDocument, Written, WrittenNumber, WrittenPoint, corners_of_solid,
};
use crate::expression::{AffineOf, Arithmetic, Folding, Program, Scope, degrees};
use crate::geometry::{
    Bounds, DAffine3, DMat3, DVec3, MAX_POINTS, PolygonError, Round, Solid, polygon,
};

use super::{Resolver, whole_number};

/// Largest number of pieces of all polygons of a file: of as many triangles as its values could list.
const MAX_TRIANGLES: usize = 62_500;

impl<K> Resolver<K> {
    /// Compiles a point in space; a third coordinate that is left out is 0.
    pub(super) fn point_in_space(&mut self, point: &WrittenPoint) -> Option<[Program; 3]> {
        let [x, y] = self.point(point)?;
        let z = match &point.z {
            Some(z) => self.constant_program(z),
            None => Program::constant(0.0),
        };
        z.as_constant()?;
        Some([x, y, z])
    }

    /// Compiles a point in a scope; a third coordinate that is left out is 0.
    pub(super) fn point_in_scope(&mut self, point: &WrittenPoint, scope: &Scope) -> [Program; 3] {
        let [x, y] = [&point.x, &point.y].map(|number| self.program(number, scope));
        let z = point.z.as_ref().map(|z| self.program(z, scope));
        [x, y, z.unwrap_or(Program::constant(0.0))]
    }

    /// Compiles the axis of a turn in a scope. Reports an axis without length.
    pub(super) fn axis_in_scope(&mut self, axis: &WrittenPoint, scope: &Scope) -> [Program; 3] {
        let compiled = self.point_in_scope(axis, scope);
        if value(&compiled) == Some(DVec3::ZERO) {
            self.report_no_axis(axis);
        }
        compiled
    }

    fn report_no_axis(&mut self, axis: &WrittenPoint) {
        let message = "an axis has a direction, and this one has no length";
        self.error_with_hint(&axis.place, message, "axis: [0, 1, 0]");
    }

    /// Evaluates a point in space, or takes another where it is left out.
    pub(super) fn constant_in_space(
        &mut self,
        point: Option<&WrittenPoint>,
        absent: DVec3,
    ) -> Option<DVec3> {
        point.map_or(Some(absent), |point| value(&self.point_in_space(point)?))
    }

    /// Resolves a turn about an axis of any length above 0, whose angle is a constant.
    pub(super) fn constant_turn(
        &mut self,
        document: &TurnDocument,
    ) -> Option<AffineOf<Program, 3>> {
        let angle = self.constant_program(&document.angle);
        let turn = self.turn(document, &angle);
        angle.as_constant()?;
        turn
    }

    /// Resolves a turn by an angle, in degrees, about an axis of any length above 0.
    pub(super) fn turn(
        &mut self,
        document: &TurnDocument,
        angle: &Program,
    ) -> Option<AffineOf<Program, 3>> {
        let along = self.constant_in_space(Some(&document.axis), DVec3::ZERO)?;
        let Some(unit) = { along.try_normalize() }.filter(|unit| unit.is_finite()) else {
            self.report_no_axis(&document.axis);
            return None;
        };
        let axis = unit.to_array().map(Program::constant);
        let turn = Folding.turn(angle);
        Some(AffineOf::rotation_about(&mut Folding, &axis, &turn))
    }

    /// Resolves a set in space. Reports mistakes and returns `None`.
    pub(super) fn solids(&mut self, document: &ShapeDocument) -> Option<Arc<[Solid]>> {
        let solids = match document.form.as_ref()? {
            FormDocument::Point(point) => {
                vec![Solid::hull(&[
                    self.constant_in_space(Some(point), DVec3::ZERO)?
                ])]
            }
            FormDocument::Outline {
                points,
                closed: true,
            } => self.polygon(document, points)?,
            FormDocument::Outline { points, .. } => self.polyline(document, points)?,
            FormDocument::Ellipse(ellipse) => vec![self.ellipse(ellipse)?],
            FormDocument::Solid(solid) => match &**solid {
                SolidDocument::Mesh(mesh) => self.mesh(document, mesh)?,
                solid => vec![self.solid(document, solid)?],
            },
            FormDocument::Fractal(fractal) => self.fractal_in_space(fractal)?,
        };
        Some(solids.into())
    }

    /// Returns the segments of a line through points.
    fn polyline(&mut self, shape: &ShapeDocument, written: &[WrittenPoint]) -> Option<Vec<Solid>> {
        let points = self.constants_in_space(written)?;
        let segments = points.windows(2).filter(|ends| ends[0] != ends[1]);
        let segments: Vec<Solid> = segments.map(Solid::hull).collect();
        if segments.is_empty() {
            let hint = "its points must not all be the same";
            self.error_with_hint(&shape.place, "this set has no extent", hint);
            return None;
        }
        Some(segments)
    }

    /// Returns an ellipse across the z axis: a cylinder without height.
    fn ellipse(&mut self, document: &EllipseDocument) -> Option<Solid> {
        let centre = self.constant_in_space(document.centre.as_ref(), DVec3::ZERO);
        let axes = document.axes.each_ref();
        let [right, up] = axes.map(|axis| self.radius(Some(axis)));
        let angle = match &document.rotate {
            Some(rotate) => self.constant(rotate)?,
            None => 0.0,
        };
        let (sine, cosine) = (degrees::sin(angle), degrees::cos(angle));
        let right = DVec3::new(cosine, sine, 0.0) * right?;
        // The cylinder's y axis points to the viewer, and its z axis down.
        let down = DVec3::new(sine, -cosine, 0.0) * up?;
        let linear = DMat3::from_cols(right, DVec3::ZERO, down);
        let place = DAffine3::from_mat3_translation(linear, centre?);
        Some(Solid::round(Round::Cylinder, place))
    }

    fn solid(&mut self, shape: &ShapeDocument, document: &SolidDocument) -> Option<Solid> {
        let place = match document {
            SolidDocument::Sphere(sphere) => {
                let centre = self.constant_in_space(sphere.centre.as_ref(), DVec3::ZERO);
                let radius = self.radius(sphere.radius.as_ref())?;
                DAffine3::from_mat3_translation(diagonal(DVec3::splat(radius)), centre?)
            }
            SolidDocument::Ellipsoid(ellipsoid) => {
                let centre = self.constant_in_space(ellipsoid.centre.as_ref(), DVec3::ZERO);
                let axes = ellipsoid
                    .axes
                    .each_ref()
                    .map(|axis| self.radius(Some(axis)));
                let turns = ellipsoid.rotate.iter().flatten();
                let turns: Vec<_> = turns.map(|turn| self.constant_turn(turn)).collect();
                let [x, y, z] = axes;
                let mut linear = diagonal(DVec3::new(x?, y?, z?));
                for turn in turns {
                    linear = turn?.as_constant()?.matrix3 * linear;
                }
                DAffine3::from_mat3_translation(linear, centre?)
            }
            SolidDocument::Cylinder(shaft) => self.shaft(shape, shaft)?,
            SolidDocument::Cone(shaft) => self.shaft(shape, shaft)?,
            SolidDocument::Cuboid(cuboid) => {
                let from = self.constant_in_space(cuboid.from.as_ref(), DVec3::ZERO);
                let to = self.constant_in_space(cuboid.to.as_ref(), DVec3::ONE);
                let bounds = Bounds::new(from?, to?);
                if bounds.size().max_element() <= 0.0 {
                    let message = "this box has no extent";
                    self.error_with_hint(&shape.place, message, "its corners must differ");
                    return None;
                }
                return Some(Solid::cuboid(&bounds));
            }
            SolidDocument::Hull(points) => {
                return Some(Solid::hull(&self.constants_in_space(points)?));
            }
            SolidDocument::Named(name) => return self.solid_of(name),
            // The caller resolves meshes, which are not one solid.
            SolidDocument::Mesh(_) => return None,
        };
        let round = match document {
            SolidDocument::Cylinder(_) => Round::Cylinder,
            SolidDocument::Cone(_) => Round::Cone,
            _ => Round::Ball,
        };
        Some(Solid::round(round, place))
    }

    /// Returns a solid of a known name, which is made once.
    fn solid_of(&mut self, name: &Written<String>) -> Option<Solid> {
        if let Some(solid) = self.solids.get(&name.value) {
            return Some(solid.clone());
        }
        let solid = Solid::hull(&self.constants_in_space(&corners_of_solid(name)?)?);
        self.solids.insert(name.value.clone(), solid.clone());
        Some(solid)
    }

    /// Evaluates a length, which must be above 0; 1 if it is left out.
    fn radius(&mut self, number: Option<&WrittenNumber>) -> Option<f64> {
        let Some(number) = number else {
            return Some(1.0);
        };
        let length = self.constant(number)?;
        if length > 0.0 {
            return Some(length);
        }
        let message = format!("{length} is no radius: it must be above 0");
        self.error(&number.place, message);
        None
    }

    /// Returns the map of a primitive along the y axis from 0 to 1 to its ends.
    fn shaft(&mut self, shape: &ShapeDocument, document: &ShaftDocument) -> Option<DAffine3> {
        let from = self.constant_in_space(document.from.as_ref(), DVec3::ZERO);
        let to = self.constant_in_space(document.to.as_ref(), DVec3::Y);
        let radius = self.radius(document.radius.as_ref());
        let (from, to) = (from?, to?);
        let Some(along) = (to - from).try_normalize() else {
            let message = "this set has no axis: `from` and `to` are the same point";
            let hint = "{from: [0, 0, 0], to: [0, 1, 0], radius: 1}";
            self.error_with_hint(&shape.place, message, hint);
            return None;
        };
        let (right, back) = along.any_orthonormal_pair();
        let radius = radius?;
        let linear = DMat3::from_cols(right * radius, to - from, back * radius);
        Some(DAffine3::from_mat3_translation(linear, from))
    }

    pub(super) fn constants_in_space(&mut self, points: &[WrittenPoint]) -> Option<Vec<DVec3>> {
        let points = points.iter();
        let points = points.map(|it| self.constant_in_space(Some(it), DVec3::ZERO));
        // All mistakes are reported.
        let points: Vec<_> = points.collect();
        points.into_iter().collect()
    }

    fn polygon(&mut self, shape: &ShapeDocument, written: &[WrittenPoint]) -> Option<Vec<Solid>> {
        let error = match polygon(&self.constants_in_space(written)?) {
            Ok(pieces) => {
                self.count_triangles(pieces.len(), &shape.place)?;
                return Some(pieces);
            }
            Err(error) => error,
        };
        let (place, message, hint) = match error {
            PolygonError::NotFlat(number) => (
                &written[number].place,
                error.to_string(),
                "write several polygons, each in a plane".to_owned(),
            ),
            PolygonError::Crosses => (
                &shape.place,
                error.to_string(),
                format!(
                    "list its points in the order of its sides; a polygon that is not convex has at most \
                     {MAX_POINTS}"
                ),
            ),
            _ => (
                &shape.place,
                "this set has no extent".to_owned(),
                "its points must not all be the same, or on one line".to_owned(),
            ),
        };
        self.error_with_hint(place, message, hint);
        None
    }

    /// Counts pieces of polygons. Reports too many and returns `None`.
    fn count_triangles(&mut self, count: usize, place: &Place) -> Option<()> {
        self.triangles += count;
        if self.triangles <= MAX_TRIANGLES {
            return Some(());
        }
        let message =
            "the polygons and the meshes of the file are cut into more than 62,500 triangles";
        let hint = "a face that is not convex, or has more than 100 corners, is cut into as many triangles as it has \
                    corners, less two: write fewer, or simpler faces";
        self.error_with_hint(place, message, hint);
        None
    }

    /// Returns the faces of a mesh; those without extent are left out.
    fn mesh(&mut self, shape: &ShapeDocument, document: &MeshDocument) -> Option<Vec<Solid>> {
        let points = self.constants_in_space(&document.points)?;
        let last = u32::try_from(points.len().saturating_sub(1)).unwrap_or(u32::MAX);
        let mut solids = Vec::new();
        for face in &document.faces {
            let mut corners = Vec::new();
            for number in face {
                let value = self.constant(number)?;
                let Some(corner) = whole_number(value, last) else {
                    let message = format!("there is no point {value} in this mesh");
                    let hint = format!("its points are numbered from 0 to {last}");
                    self.error_with_hint(&number.place, message, hint);
                    return None;
                };
                // That there are no points was reported.
                corners.push(*points.get(corner as usize)?);
            }
            let place = face.first().map_or(&shape.place, |number| &number.place);
            match polygon(&corners) {
                Ok(pieces) => {
                    self.count_triangles(pieces.len(), place)?;
                    solids.extend(pieces);
                }
                Err(PolygonError::NoExtent) => {}
                // A face that is bent is a fan of triangles.
                Err(_) => {
                    self.count_triangles(corners.len().saturating_sub(2), place)?;
                    let others = corners.get(1..).unwrap_or_default().windows(2);
                    let fan = others.map(|pair| polygon(&[corners[0], pair[0], pair[1]]));
                    solids.extend(fan.flat_map(Result::unwrap_or_default));
                }
            }
        }
        if solids.is_empty() {
            let hint = "its faces must not all be lines or points";
            self.error_with_hint(&shape.place, "this set has no extent", hint);
            return None;
        }
        Some(solids)
    }
}

fn diagonal(factors: DVec3) -> DMat3 {
    DMat3::from_diagonal(factors)
}

/// Returns the value of a point if its coordinates are constants.
pub(super) fn value([x, y, z]: &[Program; 3]) -> Option<DVec3> {
    Some(DVec3::new(
        x.as_constant()?,
        y.as_constant()?,
        z.as_constant()?,
    ))
}
