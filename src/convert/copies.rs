//! Straight shapes as unions of smaller copies of themselves.
//!
//! A line is two lines of half its length, a triangle is four triangles, and a point is a smaller point.
//! Shapes that cannot be condensation sets of a system, since those follow every map, thereby become maps.

use crate::geometry::{DAffine2, DMat2, DVec2};
use crate::rule::{BaseElement, Piece};

use super::Refusal;
use super::shape::is_point;
use super::structure::{PlacedObject, Structure};

/// Returns the structure with its straight shapes replaced by instances of a line, a triangle and a point:
/// three additional objects that instance themselves.
///
/// # Errors
///
/// Returns [`Refusal::ShapesInPart`] if a shape is curved, or a polygon crosses itself.
pub(super) fn with_copies(structure: &Structure) -> Result<Structure, Refusal> {
    let line = structure.objects.len();
    let (triangle, point) = (line + 1, line + 2);
    let replaced = |all: &[PlacedObject]| -> Result<Vec<PlacedObject>, Refusal> {
        let mut made = Vec::new();
        for placed in all {
            if placed.object.is_some() {
                made.push(placed.clone());
                continue;
            }
            let instance = |map: DAffine2, object: usize| PlacedObject {
                map: placed.map * map,
                object: Some(object),
                ..placed.clone()
            };
            let outline = &structure.shapes[placed.shape];
            let corners = corners(outline)?;
            if is_point(outline) {
                let at = placed.map.transform_point2(outline.start());
                made.push(PlacedObject {
                    map: DAffine2::from_translation(at),
                    object: Some(point),
                    ..placed.clone()
                });
            } else if outline.is_closed() {
                let triangles = triangles(&corners).ok_or(Refusal::ShapesInPart)?;
                made.extend(
                    triangles
                        .into_iter()
                        .map(|[a, b, c]| instance(DAffine2::from_cols(b - a, c - a, a), triangle)),
                );
            } else {
                made.extend(corners.windows(2).map(|ends| {
                    let along = ends[1] - ends[0];
                    instance(DAffine2::from_cols(along, along.perp(), ends[0]), line)
                }));
            }
        }
        Ok(made)
    };
    let objects = structure.objects.iter().map(|object| replaced(object));
    let mut objects = objects.collect::<Result<Vec<_>, _>>()?;
    let copy = |object: usize, factor: f64, shift: [f64; 2]| PlacedObject {
        map: DAffine2::from_mat2_translation(
            DMat2::from_diagonal(DVec2::splat(factor)),
            shift.into(),
        ),
        shape: 0,
        visible: false,
        tint: None,
        object: Some(object),
    };
    objects.push(vec![
        copy(line, 0.5, [0.0, 0.0]),
        copy(line, 0.5, [0.5, 0.0]),
    ]);
    objects.push(vec![
        copy(triangle, 0.5, [0.0, 0.0]),
        copy(triangle, 0.5, [0.5, 0.0]),
        copy(triangle, 0.5, [0.0, 0.5]),
        copy(triangle, -0.5, [0.5, 0.5]),
    ]);
    objects.push(vec![copy(point, 0.5, [0.0, 0.0])]);
    Ok(Structure {
        shapes: structure.shapes.clone(),
        objects,
        scene: replaced(&structure.scene)?,
        words: structure.words,
        names: Vec::new(),
    })
}

/// Returns the corners of an outline without repeating the first one of a closed outline.
fn corners(outline: &BaseElement) -> Result<Vec<DVec2>, Refusal> {
    let mut corners = vec![outline.start()];
    for piece in outline.pieces() {
        match piece {
            Piece::Line(end) => corners.push(*end),
            Piece::Cubic(..) => return Err(Refusal::ShapesInPart),
        }
    }
    if outline.is_closed() {
        corners.pop();
    }
    corners.dedup();
    Ok(corners)
}

/// Returns a triangulation of a polygon that does not cross itself, by ear clipping (Meisters 1975); `None`
/// if no ear is found.
fn triangles(corners: &[DVec2]) -> Option<Vec<[DVec2; 3]>> {
    let area = |[a, b, c]: [DVec2; 3]| (b - a).perp_dot(c - a);
    let mut left = corners.to_vec();
    let around = left.windows(2).map(|side| side[0].perp_dot(side[1]));
    let whole = around.sum::<f64>() + left.last()?.perp_dot(left[0]);
    if whole < 0.0 {
        left.reverse();
    }
    let mut triangles = Vec::new();
    while left.len() > 2 {
        let count = left.len();
        let corner = |at: usize| left[at % count];
        let is_ear = |at: &usize| {
            let ear = [corner(*at), corner(at + 1), corner(at + 2)];
            let [a, b, c] = ear;
            let inside = |point: &DVec2| {
                let sides = [[a, b], [b, c], [c, a]];
                !ear.contains(point) && sides.iter().all(|&[d, e]| area([d, e, *point]) >= 0.0)
            };
            area(ear) >= 0.0 && !left.iter().any(inside)
        };
        let at = (0..count).find(is_ear)?;
        let ear = [corner(at), corner(at + 1), corner(at + 2)];
        if area(ear) > 0.0 {
            triangles.push(ear);
        }
        left.remove((at + 1) % count);
    }
    Some(triangles)
}
