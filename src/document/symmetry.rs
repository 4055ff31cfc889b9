//! Symmetry groups of pictures as written.

use crate::symmetry::MOST_TURNS;

use super::mapping::mapping;
use super::node::Value;
use super::reader::{Fields, Reader};
use super::shape::{Form, alternative};
use super::{WrittenNumber, WrittenPoint};

mapping! {
    /// Cyclic or dihedral group of isometries about a centre, as written.
    struct SymmetryDocument: SYMMETRY = "a symmetry", "symmetry: {rotate: 6, mirror: true}",
        &[alternative(&["rotate"], &[]), alternative(&["mirror"], &["rotate"])];
    rotate: Option<WrittenNumber> = Form::Whole(1, Some(MOST_TURNS)),
        "The number of rotations, by equal parts of a full turn; 1 if left out.";
    mirror: bool = Form::Flag(false),
        "Whether the picture is mirrored as well: in as many lines through the centre as there are rotations.";
    centre: Option<WrittenPoint> = Form::Point, "The centre; the origin if left out.";
    axis: Option<WrittenNumber> = Form::Number,
        "With `mirror`: the angle of a mirror line to the x axis, in degrees counter-clockwise; 90, an upright \
         line, if left out.";
}

/// Type of the values of `symmetry`.
pub(super) const SYMMETRY_OF: Form =
    Form::Either(&[Form::Mapping(&SYMMETRY), Form::Words(&["none"])]);

/// Reads the symmetry of a file. It is an error in space.
pub(super) fn read_symmetry(
    reader: &mut Reader,
    fields: &Fields<'_>,
    in_space: bool,
) -> Option<SymmetryDocument> {
    let node = fields.take("symmetry")?;
    if node.value == Value::Text("none".into()) {
        return None;
    }
    if in_space {
        let message = "`symmetry` is for pictures of the plane, and this file lies in space";
        let hint = "in space, copies are maps of a system or objects of a scene";
        reader.error_with_hint(fields.place_of("symmetry"), message, hint);
        return None;
    }
    let symmetry: SymmetryDocument = fields.optional(reader, "symmetry")?;
    if symmetry.rotate.is_none() && !symmetry.mirror {
        let message = "the symmetry has neither rotations nor mirrors";
        let hint = "write `rotate: 6`, `mirror: true` or both; `symmetry: none` for no symmetry";
        reader.error_with_hint(&symmetry.place.first_line(), message, hint);
        return None;
    }
    if let Some(axis) = symmetry.axis.as_ref().filter(|_| !symmetry.mirror) {
        let message = "`axis` is the angle of a mirror line, and the symmetry has none";
        reader.error_with_hint(
            &axis.place,
            message,
            "write `mirror: true`, or leave it out",
        );
    }
    Some(symmetry)
}
