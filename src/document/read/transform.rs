//! Reading of transforms, in the order in which they are written.

use crate::document::instancing::TransformDocument;
use crate::document::node::Node;
use crate::document::reader::{Fields, Reader};
use crate::document::shape::{Form, Member, Shape, key, keys};

use super::ifs::read_matrix;

/// Keys that transform.
pub(super) const TRANSFORMS: [Member; 5] = keys![
    =SCALE;
    =ROTATE;
    =TRANSLATE;
    =MATRIX;
    transform: Form::List(&Form::Mapping(&TRANSFORM), 1, None),
        "Transforms one after the other, where one of them is needed twice.";
];

const SCALE: Member = key(
    "scale",
    Form::Either(&[Form::Number, Form::Point]),
    "A factor, or one along x and one along y. Transforms are done in the order in which they are \
     written.",
);

const ROTATE: Member = key(
    "rotate",
    Form::Number,
    "An angle about [0, 0] in degrees, counter-clockwise.",
);

const TRANSLATE: Member = key("translate", Form::Point, "A shift: [x, y].");

const MATRIX: Member = key(
    "matrix",
    Form::List(&Form::Point, 2, Some(2)),
    "The rows of a matrix: [[a, b], [c, d]] maps [x, y] to [a x + b y, c x + d y].",
);

const TRANSFORM: Shape = Shape {
    what: "a transform",
    keys: &[&keys![
        =SCALE;
        =ROTATE;
        =TRANSLATE;
        =MATRIX;
    ]],
    ways: &[],
    hint: "{rotate: 30}, {scale: 1/2} or {translate: [1, 0]}",
};

/// Reads the transforms among the keys of a mapping.
pub(super) fn read_transforms(reader: &mut Reader, fields: &Fields<'_>) -> Vec<TransformDocument> {
    let mut transforms = Vec::new();
    for (name, node) in fields.in_order() {
        let transform = match name {
            "scale" => TransformDocument::Scale(reader.pair(node)),
            "rotate" => TransformDocument::Rotate(reader.number(node)),
            "translate" => TransformDocument::Translate(reader.point(node)),
            "matrix" => match read_matrix(reader, node) {
                Some(matrix) => TransformDocument::Matrix(matrix),
                None => continue,
            },
            "transform" => {
                transforms.extend(read_list(reader, node));
                continue;
            }
            _ => continue,
        };
        transforms.push(transform);
    }
    transforms
}

fn read_list(reader: &mut Reader, node: &Node) -> Vec<TransformDocument> {
    let list = reader.filled(node, "a list of transforms", "transform", TRANSFORM.hint);
    let mut transforms = Vec::new();
    for node in list {
        if let Some(fields) = reader.fields(node, &TRANSFORM) {
            transforms.extend(read_transforms(reader, &fields));
        }
    }
    transforms
}
