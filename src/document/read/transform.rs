//! Reading of transforms, in the order in which they are written.

use crate::document::instancing::TransformDocument;
use crate::document::node::Node;
use crate::document::reader::{Fields, Reader};
use crate::document::shape::{Form, Member, Shape, key, keys};

use super::ifs::read_matrix;
use super::space::{self, FACTORS_HINT, TURN};

/// Keys that transform.
pub(in crate::document) const TRANSFORMS: [Member; 6] = keys![
    =SCALE;
    =ROTATE;
    =TRANSLATE;
    =SHIFT;
    =MATRIX;
    transform: Form::List(&Form::Mapping(&TRANSFORM), 1, None),
        "Transforms one after the other, where one of them is needed twice.";
];

const SCALE: Member = key(
    "scale",
    Form::Either(&[Form::Number, Form::Place]),
    "A factor, or one along each axis. Transforms are done in the order in which they are written.",
);

const ROTATE: Member = key(
    "rotate",
    Form::Either(&[
        Form::Number,
        Form::Mapping(&TURN),
        Form::List(&Form::Mapping(&TURN), 1, None),
    ]),
    "An angle about [0, 0] in degrees, counter-clockwise; in space a turn about an axis, {y: 30} or \
     {axis: [1, 1, 0], angle: 30}, or a list of turns in order.",
);

const TRANSLATE: Member = key(
    "translate",
    Form::Either(&[Form::Number, Form::Place]),
    "A translation: [x, y], or x for [x, 0].",
);

const SHIFT: Member = key(
    "shift",
    Form::Either(&[Form::Number, Form::Place]),
    "Another name of `translate`.",
);

const MATRIX: Member = key(
    "matrix",
    Form::List(&Form::Place, 2, Some(3)),
    "The rows of a matrix: [[a, b], [c, d]] maps [x, y] to [a x + b y, c x + d y]; in space there are \
     three rows of three numbers.",
);

const TRANSFORM: Shape = Shape {
    what: "a transform",
    keys: &[&keys![
        =SCALE;
        =ROTATE;
        =TRANSLATE;
        =SHIFT;
        =MATRIX;
    ]],
    alternatives: &[],
    hint: "{rotate: 30}, {scale: 1/2} or {translate: [1, 0]}",
};

/// Reads the transforms among the keys of a mapping.
pub(super) fn read_transforms(reader: &mut Reader, fields: &Fields<'_>) -> Vec<TransformDocument> {
    let mut transforms = Vec::new();
    for (name, node) in fields.in_order() {
        match name {
            "transform" => transforms.extend(read_list(reader, node)),
            "translate" | "shift" => {
                transforms.push(TransformDocument::Translate(reader.complex_number(node)))
            }
            _ if reader.is_in_space => transforms.extend(read_in_space(reader, name, node)),
            _ => transforms.extend(read_in_plane(reader, name, node)),
        }
    }
    // Transforms are large, and most lists are short.
    transforms.shrink_to_fit();
    transforms
}

fn read_in_plane(reader: &mut Reader, name: &str, node: &Node) -> Option<TransformDocument> {
    Some(match name {
        "scale" => TransformDocument::Scale(reader.pair(node)),
        "rotate" if space::is_turn(node) => {
            let message = "a turn about an axis lies in space";
            let hint = "write an angle in the plane, or `space: 3` at the top";
            reader.error_with_hint(&node.place, message, hint);
            return None;
        }
        "rotate" => TransformDocument::Rotate(reader.number(node)),
        "matrix" => TransformDocument::Matrix(read_matrix(reader, node)?),
        _ => return None,
    })
}

fn read_in_space(reader: &mut Reader, name: &str, node: &Node) -> Option<TransformDocument> {
    Some(match name {
        "scale" => {
            let factors = space::read_factors(reader, node, "factors", FACTORS_HINT)?;
            TransformDocument::ScaleInSpace(factors)
        }
        "rotate" => TransformDocument::Turns(space::read_turns(reader, node)?),
        "matrix" => TransformDocument::MatrixInSpace(space::read_matrix(reader, node)?),
        _ => return None,
    })
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
