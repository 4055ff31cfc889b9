//! Reading of base elements.

use crate::catalogue::Shelf;
use crate::diagnostic::did_you_mean;
use crate::document::ifs::ShapeDocument;
use crate::document::mapping::{FromNode, mapping};
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::rule::PieceDocument;
use crate::document::shape::{Form, KeySet, Shape, alternative, keys};
use crate::document::{Written, WrittenNumber, WrittenPoint};
use crate::style::Colour;

use super::set::{SET, read_set};
use super::space::{InSpace, only_in_space};

mapping! {
    /// A base element as written.
    struct BaseElementDocument: BASE_ELEMENT = "a base element",
        "a name from the library (base_element: triangle), or \
         {points: [[0, 0], [1/2, 1], [1, 0]], closed: true}", &ALTERNATIVES;
    space: InSpace = Form::Whole(2, Some(3)), "3 for a base element in space, 2 or nothing for one in the plane.";
    points as pieces: Option<Vec<PieceDocument>> =
        Form::List(&Form::Either(&[Form::Place, Form::Mapping(&PIECE)]), 2, None),
        "The outline: a point, then points and round pieces. The first and the last point differ.";
    closed: bool = Form::Flag(false),
        "Whether the last point is joined to the first: a polygon, which is filled.";
    surfaces: Option<Vec<SurfaceDocument>> = Form::List(&Form::Mapping(&SURFACE), 1, None),
        "In space, surfaces: polygons in planes of their own.";
    lines: Option<Vec<Vec<WrittenPoint>>> = Form::List(&Form::List(&Form::Place, 2, None), 1, None),
        "In space, lines through points.";
    solid: Option<Written<String>> = Form::Words(&SOLIDS),
        "In space, a solid by its name. Polyhedra have edges of length 1 and lie behind the face that runs from [0, 0, 0] \
         to [1, 0, 0], and round solids about the element.";
    width: Option<WrittenNumber> = Form::Positive,
        "The width of a cylinder, a cone or a bar about the element, or of the tubes that lines are; that of the style, if \
         left out and relative to the element.";
    solids: Option<Vec<ShapeDocument>> = Form::List(&Form::Mapping(&SET), 1, None),
        "In space, sets: boxes, spheres, meshes and others.";
    from: Option<WrittenPoint> = Form::Place,
        "The point of the outline's own coordinates that lies on the element's start; [0, 0] if left out.";
    to: Option<WrittenPoint> = Form::Place,
        "The point of the outline's own coordinates that lies on the element's end; [1, 0] if left out.";
}

/// Keys that define the shape of a base element; those after the first are known in space only and combine.
const ALTERNATIVES: [KeySet; 5] = [
    alternative(&["points"], &["surfaces", "lines", "solid", "solids"]),
    alternative(&["surfaces"], &["points", "closed"]),
    alternative(&["lines"], &["points", "closed"]),
    alternative(&["solid"], &["points", "closed"]),
    alternative(&["solids"], &["points", "closed"]),
];

/// Names of solids about an element.
pub(in crate::document) const SOLIDS: [&str; 9] = [
    "cube",
    "tetrahedron",
    "octahedron",
    "dodecahedron",
    "icosahedron",
    "sphere",
    "cylinder",
    "cone",
    "bar",
];

mapping! {
    /// A surface of a base element as written.
    struct SurfaceDocument: SURFACE = "a surface",
        "{points: [[0, 0, 0], [1, 0, 0], [1, 1, 0]], color: gold}";
    needed points: Vec<WrittenPoint> = Form::List(&Form::Place, 3, None),
        "Its corners, counter-clockwise from outside." => "a surface needs `points`";
    normal: Option<WrittenPoint> = Form::Place,
        "The direction of its front, for shading; across the polygon if left out.";
    color: Option<Colour> = Form::Colour, "Its colour; that of the style if left out.";
    sides: Option<WrittenNumber> = Form::Whole(1, Some(2)),
        "2 if light falls on its back, too; 1 if left out.";
}

impl FromNode for Vec<WrittenPoint> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let hint = "points: [[0, 0, 0], [1, 0, 0], [1, 1, 0]]";
        let list = reader.list(node, "a list of points", hint);
        Some(list.iter().map(|entry| reader.point(entry)).collect())
    }

    fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(Self::new())
    }
}

impl FromNode for Vec<Vec<WrittenPoint>> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let list = reader.filled(
            node,
            "a list of lines",
            "line",
            "lines: [[[0, 0, 0], [1, 0, 0]]]",
        );
        list.iter()
            .map(|line| Vec::from_node(reader, line))
            .collect()
    }
}

impl FromNode for Vec<SurfaceDocument> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let list = reader.filled(node, "a list of surfaces", "surface", SURFACE.hint);
        let surfaces = list
            .iter()
            .filter_map(|it| SurfaceDocument::from_node(reader, it));
        Some(surfaces.collect())
    }
}

impl FromNode for Vec<ShapeDocument> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let hint = "solids: [{box: {from: [0, 0, 0], to: [1, 1, 1]}}]";
        let list = reader.filled(node, "a list of sets", "set", hint);
        let sets = list.iter().filter_map(|node| {
            let fields = reader.fields(node, &SET)?;
            Some(read_set(reader, &fields))
        });
        Some(sets.collect())
    }
}

/// Reports keys of a base element that do not go together, or with the space of the file.
fn check(reader: &mut Reader, document: &BaseElementDocument, node: &Node) {
    const IN_SPACE: [&str; 5] = ["surfaces", "lines", "solid", "solids", "width"];
    let there: Vec<&str> = IN_SPACE
        .into_iter()
        .filter(|key| node.get(key).is_some())
        .collect();
    for key in &there {
        only_in_space(reader, node, key);
    }
    let shapes = there.iter().filter(|key| **key != "width");
    match (&document.pieces, shapes.clone().next()) {
        (None, None) => {
            let message = "a base element needs `points`";
            reader.error_with_hint(&node.place.first_line(), message, BASE_ELEMENT.hint);
        }
        (Some(_), Some(key)) => {
            let message = format!("`points` does not go with `{key}`");
            let place = node.get("points").map_or(&node.place, |node| &node.place);
            let hint = "an outline is one of the surfaces, or one of the lines";
            reader.error_with_hint(&place.first_line(), message, hint);
        }
        (None, Some(key)) => {
            if let Some(closed) = node.get("closed") {
                let message = format!("`closed` does not go with `{key}`");
                let hint = "`closed` makes a polygon of `points`";
                reader.error_with_hint(&closed.place, message, hint);
            }
        }
        (Some(_), None) => {}
    }
    if let Some(name) = &document.solid
        && !SOLIDS.contains(&name.value.as_str())
    {
        let hint = did_you_mean(&name.value, SOLIDS)
            .unwrap_or_else(|| format!("one of: {}", SOLIDS.join(", ")));
        reader.error_with_hint(&name.place, format!("'{}' is no solid", name.value), hint);
    }
    let is_thick = { document.solid.as_ref() }
        .is_some_and(|name| ["cylinder", "cone", "bar"].contains(&name.value.as_str()))
        || document.lines.is_some();
    if let Some(width) = &document.width
        && !is_thick
    {
        let message = "only lines, a cylinder, a cone and a bar have a width";
        reader.error_with_hint(&width.place, message, "{solid: bar, width: 0.1}");
    }
}

impl FromNode for Box<BaseElementDocument> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let document = BaseElementDocument::from_node(reader, node)?;
        check(reader, &document, node);
        Some(Self::new(document))
    }
}

pub(super) const BASE_ELEMENT_OF: Form = Form::Either(&[
    Form::File(Shelf::BaseElements),
    Form::Mapping(&BASE_ELEMENT),
]);

const PIECE: Shape = Shape {
    what: "a piece of a base element",
    keys: &[&keys![
        arc: Form::Point, "A circular arc to this point, through another.";
        through: Form::Point, "A point on the arc.";
        curve: Form::Point, "A Bézier curve to this point.";
        control: Form::List(&Form::Point, 1, Some(2)),
            "The control points of the curve: one of a quadratic curve, two of a cubic one.";
    ]],
    alternatives: &[ARC, CURVE],
    hint: "a piece is a point, {arc: [x, y], through: [x, y]} or \
           {curve: [x, y], control: [[x, y]]}",
};

const ARC: KeySet = alternative(&["arc", "through"], &["curve", "control"]);

const CURVE: KeySet = alternative(&["curve", "control"], &["arc", "through"]);

impl FromNode for Vec<PieceDocument> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        let list = reader.list(node, "a list of points", BASE_ELEMENT.hint);
        if matches!(node.value, Value::Sequence(_)) && list.len() < 2 {
            let message = "a base element needs two points or more";
            reader.error_with_hint(&node.place, message, "points: [[0, 0], [1, 0]]");
        }
        let pieces = list.iter().filter_map(|entry| read_piece(reader, entry));
        Some(pieces.collect())
    }
}

fn read_piece(reader: &mut Reader, node: &Node) -> Option<PieceDocument> {
    if let Some(point) = reader.complex(node) {
        return Some(PieceDocument::Line(point));
    }
    if let Value::Sequence(_) = node.value {
        return Some(PieceDocument::Line(reader.point(node)));
    }
    let fields = reader.fields(node, &PIECE)?;
    if let Some(to) = fields.take("arc") {
        exclude(reader, &fields, &ARC, "an arc");
        let to = reader.point(to);
        let Some(through) = fields.optional(reader, "through") else {
            let message = "an arc needs a point that it goes through";
            reader.error_with_hint(&node.place.first_line(), message, PIECE.hint);
            return None;
        };
        Some(PieceDocument::Arc { to, through })
    } else if let Some(to) = fields.take("curve") {
        exclude(reader, &fields, &CURVE, "a curve");
        let to = reader.point(to);
        let control = fields.take("control");
        let points = control.map_or(&[][..], |node| {
            reader.list(node, "a list of control points", PIECE.hint)
        });
        let is_list = control.is_none_or(|node| matches!(node.value, Value::Sequence(_)));
        if is_list && !(1..=2).contains(&points.len()) {
            let place = control
                .map_or(&node.place, |control| &control.place)
                .first_line();
            let message = "a curve has one control point or two";
            reader.error_with_hint(&place, message, PIECE.hint);
        }
        let control = points.iter().map(|node| reader.point(node)).collect();
        Some(PieceDocument::Curve { to, control })
    } else {
        let message = "this piece has no end";
        reader.error_with_hint(&node.place.first_line(), message, PIECE.hint);
        None
    }
}

/// Reports the keys that the chosen alternative excludes.
fn exclude(reader: &mut Reader, fields: &Fields<'_>, keys: &KeySet, what: &str) {
    for other in keys.excludes {
        if fields.take(other).is_some() {
            let message = format!("`{other}` does not belong to {what}");
            reader.error_with_hint(fields.place_of(other), message, PIECE.hint);
        }
    }
}
