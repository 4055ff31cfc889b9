//! Reading of sets in space: solids.

use crate::document::ifs::{MeshDocument, SolidDocument, TurnDocument};
use crate::document::mapping::{FromNode, mapping};
use crate::document::node::{Node, Value};
use crate::document::reader::Reader;
use crate::document::shape::{Form, Shape, keys};
use crate::document::{WrittenNumber, WrittenPoint};

use super::space::{TURN, read_factors, read_name_of_solid, read_turns};

mapping! {
    /// A ball as written.
    struct SphereDocument: SPHERE = "a sphere", "sphere: {centre: [0, 0, 0], radius: 1}";
    centre: Option<WrittenPoint> = Form::Place, "Its centre; [0, 0, 0] if left out.";
    radius: Option<WrittenNumber> = Form::Positive, "Its radius, above 0; 1 if left out.";
}

mapping! {
    /// An ellipsoid as written.
    struct EllipsoidDocument: ELLIPSOID = "an ellipsoid",
        "ellipsoid: {centre: [0, 0, 0], axes: [3, 1, 2], rotate: {y: 30}}";
    centre: Option<WrittenPoint> = Form::Place, "Its centre; [0, 0, 0] if left out.";
    needed axes: [WrittenNumber; 3] = Form::Either(&[Form::Number, Form::Place]),
        "Its half axes, along x, y and z."
        => "an ellipsoid needs its half axes";
    rotate: Option<Vec<TurnDocument>> =
        Form::Either(&[Form::Mapping(&TURN), Form::List(&Form::Mapping(&TURN), 1, None)]),
        "How it is turned about its centre: a turn, or a list of turns in order.";
}

mapping! {
    /// A cylinder or a cone as written.
    struct ShaftDocument: SHAFT = "a cylinder or a cone", "{from: [0, 0, 0], to: [0, 1, 0], radius: 1}";
    from: Option<WrittenPoint> = Form::Place, "The centre of its base; [0, 0, 0] if left out.";
    to: Option<WrittenPoint> = Form::Place, "The other end of its axis; [0, 1, 0] if left out.";
    radius: Option<WrittenNumber> = Form::Positive, "The radius of its base, above 0; 1 if left out.";
}

mapping! {
    /// A box as written.
    struct CuboidDocument: CUBOID = "a box", "box: {from: [0, 0, 0], to: [1, 1, 1]}";
    from: Option<WrittenPoint> = Form::Place, "A corner; [0, 0, 0] if left out.";
    to: Option<WrittenPoint> = Form::Place, "The opposite corner; [1, 1, 1] if left out.";
}

pub(super) const MESH: Shape = Shape {
    what: "a mesh",
    keys: &[&keys![
        needed points: Form::List(&Form::Place, 3, None), "The points."
            => "a mesh needs `points`";
        needed faces: Form::List(&Form::List(&Form::Whole(0, None), 3, None), 1, None),
            "The faces: lists of the numbers of their points, from 0, in order."
            => "a mesh needs `faces`";
    ]],
    alternatives: &[],
    hint: "mesh: shape.obj, or mesh: {points: [[x, y, z], ...], faces: [[0, 1, 2], ...]}",
};

impl FromNode for [WrittenNumber; 3] {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        read_factors(reader, node, "half axes", "axes: [3, 1, 2]")
    }
}

impl FromNode for Vec<TurnDocument> {
    fn from_node(reader: &mut Reader, node: &Node) -> Option<Self> {
        read_turns(reader, node)
    }
}

/// Reads a mesh, whose file has been inlined in place of its name.
fn read_mesh(reader: &mut Reader, node: &Node) -> Option<MeshDocument> {
    if let Value::Text(_) = &node.value {
        // Mistakes in the file have been reported.
        return None;
    }
    let fields = reader.fields(node, &MESH)?;
    let [points, faces] = ["points", "faces"].map(|key| fields.take(key));
    let points = reader.filled(points?, "a list of points", "point", MESH.hint);
    let faces = reader.filled(faces?, "a list of faces", "face", MESH.hint);
    let points = points.iter().map(|point| reader.point(point)).collect();
    let mut read = Vec::new();
    for node in faces {
        let corners = reader.list(node, "a list of numbers of points", MESH.hint);
        if corners.len() < 3 && matches!(node.value, Value::Sequence(_)) {
            let message = format!("a face has three corners or more, not {}", corners.len());
            reader.error_with_hint(&node.place, message, MESH.hint);
        }
        read.push(corners.iter().map(|corner| reader.number(corner)).collect());
    }
    Some(MeshDocument {
        points,
        faces: read,
    })
}

/// Reads a set that is the value of a key.
pub(super) fn read_solid_set(reader: &mut Reader, key: &str, node: &Node) -> Option<SolidDocument> {
    Some(match key {
        "sphere" => SolidDocument::Sphere(SphereDocument::from_node(reader, node)?),
        "ellipsoid" => SolidDocument::Ellipsoid(EllipsoidDocument::from_node(reader, node)?),
        "cylinder" => SolidDocument::Cylinder(ShaftDocument::from_node(reader, node)?),
        "cone" => SolidDocument::Cone(ShaftDocument::from_node(reader, node)?),
        "mesh" => SolidDocument::Mesh(read_mesh(reader, node)?),
        "box" => SolidDocument::Cuboid(CuboidDocument::from_node(reader, node)?),
        _ => SolidDocument::Named(read_name_of_solid(reader, node)?),
    })
}
