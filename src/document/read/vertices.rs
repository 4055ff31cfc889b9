//! Reading of vertices, towards which the maps of a system contract.

use crate::document::ifs::{MapsDocument, ScatterDocument, VerticesDocument};
use crate::document::node::{Node, Value};
use crate::document::reader::Reader;
use crate::document::shape::{Form, Shape, alternative, keys};

use super::ifs::read_points;
use super::space::{self, SOLIDS};

/// Keys of vertices.
pub(super) const VERTICES: Shape = Shape {
    what: "vertices",
    keys: &[&keys![
        points: Form::List(&Form::Place, 1, None), "The vertices: a map towards each.";
        solid: Form::Words(&SOLIDS), "In place of `points`, in space: the corners of a solid.";
        scatter: Form::Mapping(&SCATTER), "In place of `points`: points at random places.";
        needed shrink: Form::Number,
            "What is left of the way to a vertex: 1/2 goes half the way, 1/3 two thirds of it."
            => "vertices need `shrink`: what is left of the way to one";
    ]],
    alternatives: &[
        alternative(&["points"], &["solid", "scatter"]),
        alternative(&["solid"], &["points", "scatter"]),
        alternative(&["scatter"], &["points", "solid"]),
    ],
    hint: "vertices: {points: [[0, 0], [1, 0], [1/2, 1]], shrink: 1/2}",
};

const SCATTER: Shape = Shape {
    what: "a scatter",
    keys: &[&keys![
        needed ellipsoid: Form::Place,
            "Half the lengths of the axes, along x, y and z, of an ellipsoid about the origin, or of an \
             ellipse in the plane: the points lie in it, everywhere as likely."
            => "a scatter needs `ellipsoid`: half the lengths of its axes";
        needed count: Form::Whole(1, Some(1000)), "The number of points."
            => "a scatter needs `count`: the number of points";
        seed: Form::Whole(0, None), "What the places depend on; 0 if left out.";
    ]],
    alternatives: &[],
    hint: "scatter: {ellipsoid: [3, 1, 2], count: 24}",
};

pub(super) fn read_vertices(reader: &mut Reader, node: &Node) -> Option<MapsDocument> {
    let fields = reader.fields(node, &VERTICES)?;
    let alternatives = ["points", "solid", "scatter"];
    let mut there = alternatives.iter().filter(|key| fields.take(key).is_some());
    let key = there.next();
    let mut points = match (key, key.and_then(|key| fields.take(key))) {
        (Some(&"points"), _) => {
            read_points(reader, &fields, VERTICES.hint).map(VerticesDocument::Listed)
        }
        (Some(&"solid"), Some(node)) if reader.is_in_space => {
            let name = space::read_name_of_solid(reader, node);
            { name.as_ref() }
                .and_then(space::corners_of_solid)
                .map(VerticesDocument::Listed)
        }
        (Some(&"solid"), _) => {
            let message = "a solid lies in space";
            reader.error_with_hint(fields.place_of("solid"), message, "write `space: 3`");
            None
        }
        (_, Some(node)) => read_scatter(reader, node),
        (_, None) => {
            let place = node.place.first_line();
            reader.error_with_hint(&place, "there are no `points`", VERTICES.hint);
            None
        }
    };
    for other in there {
        let message = format!("`{other}` stands in place of `{}`", key.unwrap_or(other));
        reader.error_with_hint(fields.place_of(other), message, "write one of them");
        points = None;
    }
    let shrink = fields.optional(reader, "shrink");
    Some(MapsDocument::Vertices {
        points: points?,
        shrink: shrink?,
    })
}

fn read_scatter(reader: &mut Reader, node: &Node) -> Option<VerticesDocument> {
    let fields = reader.fields(node, &SCATTER)?;
    let ellipsoid = fields.take("ellipsoid");
    if let Some(node) = ellipsoid
        && reader.is_in_space
        && matches!(&node.value, Value::Sequence(entries) if entries.len() == 2)
    {
        let message = "an ellipsoid has three axes, this one has 2";
        reader.error_with_hint(&node.place, message, SCATTER.hint);
        return None;
    }
    let ellipsoid = ellipsoid.map(|node| reader.point(node));
    let (count, seed) = (
        fields.optional(reader, "count"),
        fields.optional(reader, "seed"),
    );
    Some(VerticesDocument::Scattered(Box::new(ScatterDocument {
        ellipsoid: ellipsoid?,
        count: count?,
        seed,
    })))
}
