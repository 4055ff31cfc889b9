//! Reading of base elements.

use crate::catalogue::Shelf;
use crate::document::WrittenPoint;
use crate::document::mapping::{FromNode, mapping};
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::rule::PieceDocument;
use crate::document::shape::{Form, Shape, Way, keys, way};

mapping! {
    /// A base element as written.
    struct BaseElementDocument: BASE_ELEMENT = "a base element",
        "a name from the library (base_element: triangle), or \
         {points: [[0, 0], [1/2, 1], [1, 0]], closed: true}";
    needed points as pieces: Vec<PieceDocument> =
        Form::List(&Form::Either(&[Form::Point, Form::Mapping(&PIECE)]), 2, None),
        "The outline: a point, then points and round pieces. The first and the last point differ."
        => "a base element needs `points`";
    closed: bool = Form::Flag(false),
        "Whether the last point is joined to the first: a polygon, which is filled.";
    from: Option<WrittenPoint> = Form::Point,
        "The point of the outline's plane that lies on the element's start; [0, 0] if left out.";
    to: Option<WrittenPoint> = Form::Point,
        "The point of the outline's plane that lies on the element's end; [1, 0] if left out.";
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
    ways: &[ARC, CURVE],
    hint: "a piece is a point, {arc: [x, y], through: [x, y]} or \
           {curve: [x, y], control: [[x, y]]}",
};

const ARC: Way = way(&["arc", "through"], &["curve", "control"]);

const CURVE: Way = way(&["curve", "control"], &["arc", "through"]);

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

    fn absent(_: &Fields<'_>, _: &'static str) -> Option<Self> {
        Some(Self::new())
    }
}

fn read_piece(reader: &mut Reader, node: &Node) -> Option<PieceDocument> {
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
fn exclude(reader: &mut Reader, fields: &Fields<'_>, way: &Way, what: &str) {
    for other in way.excludes {
        if fields.take(other).is_some() {
            let message = format!("`{other}` does not belong to {what}");
            reader.error_with_hint(fields.place_of(other), message, PIECE.hint);
        }
    }
}
