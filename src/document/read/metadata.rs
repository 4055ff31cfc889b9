//! Reading of metadata, which files of all kinds have.

use std::collections::BTreeSet;

use crate::diagnostic::Diagnostics;
use crate::document::animation::{ANIMATION, read_animation};
use crate::document::density::{DENSITY, read_density};
use crate::document::metadata::MetadataDocument;
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::shape::{Form, Member, Shape, keys};
use crate::document::style::STYLE;
use crate::document::symmetry::{SYMMETRY_OF, read_symmetry};
use crate::document::view::{VIEW, read_view};
use crate::metadata::Description;
use crate::metadata::MAX_STEPS;

use super::parameters::read_params;

/// Keys that describe a file and are not inlined with a component.
pub(in crate::document) const DESCRIPTION: [Member; 5] = keys![
    title: Form::Text, "A title, in a few words.";
    about: Form::Text, "A few sentences on what it is.";
    source: Form::Text, "Where it comes from: who published it, and when.";
    tags: Form::List(&Form::Text, 0, None), "Words by which `kfrac list WORD` finds it.";
    format: Form::Exactly(FORMAT), "The version of this format; may be left out.";
];

/// Version of the file format.
const FORMAT: u32 = 1;

/// Keys for the defaults of growing and drawing, and for published properties.
pub(super) const LIKING: [Member; 8] = keys![
    steps: Form::Whole(0, Some(MAX_STEPS)),
        "The number of steps, unless another is asked for.";
    dimension: Form::Number, "The published similarity dimension. It does not change the picture.";
    hausdorff_dimension: Form::Number,
        "The published dimension of the set itself, where it is smaller because copies overlap.";
    symmetry: SYMMETRY_OF,
        "The rotations and reflections under which the picture is repeated, in the plane. It does not change the \
         similarity dimension; `none` takes back that of a parent.";
    style: Form::Mapping(&STYLE), "How it is drawn.";
    view: Form::Mapping(&VIEW), "Which part of the plane is drawn, or how a set in space is seen.";
    density: Form::Mapping(&DENSITY), "How often the pixels of a PNG are hit, by elements or by random iteration, as tones.";
    animation: Form::Mapping(&ANIMATION), "How `kfrac animate` makes a film of it, unless other options are given.";
];

/// Reads the metadata of a file. The caller sets `complete`.
pub(in crate::document) fn read_metadata(
    reader: &mut Reader,
    fields: &Fields<'_>,
) -> MetadataDocument {
    let mut entries = fields.in_order();
    let in_space = entries.any(|(key, node)| key == "space" && node.value != Value::Number(2.0));
    let view = fields.take("view");
    let view = view.map(|node| read_view(reader, node, in_space));
    let (view, space) = view.unwrap_or_default();
    MetadataDocument {
        description: read_description(reader, fields),
        params: read_params(reader, fields.take("params")),
        steps: fields.optional(reader, "steps"),
        dimension: fields.optional(reader, "dimension"),
        hausdorff_dimension: fields.optional(reader, "hausdorff_dimension"),
        sets_colours: fields
            .take("style")
            .is_some_and(|style| style.get("color_by").is_some()),
        symmetry: read_symmetry(reader, fields, in_space),
        style: fields.read(reader, "style").unwrap_or_default(),
        view,
        space,
        density: read_density(reader, fields, in_space),
        animation: { fields.take("animation") }
            .map(|node| read_animation(reader, node))
            .unwrap_or_default(),
        used_by_ranges: BTreeSet::new(),
        complete: false,
        place: fields.place.clone(),
    }
}

/// Reports mistakes in the description of a component, whose values are not used.
pub(in crate::document) fn check_description(node: &Node, diagnostics: &mut Diagnostics) {
    const DESCRIBED: Shape = Shape {
        what: "a description",
        keys: &[&DESCRIPTION],
        alternatives: &[],
        hint: "title: Koch curve",
    };
    let mut reader = Reader::after(diagnostics, node);
    if let Some(fields) = reader.fields(node, &DESCRIBED) {
        read_description(&mut reader, &fields);
    }
    diagnostics.extend(reader.diagnostics);
}

fn read_description(reader: &mut Reader, fields: &Fields<'_>) -> Description {
    if let Some(format) = fields.take("format")
        && !matches!(format.value, Value::Number(version) if version == f64::from(FORMAT))
    {
        let message = format!(
            "version '{}' of the format is not known",
            format.place.text()
        );
        reader.error_with_hint(&format.place, message, "format: 1");
    }
    let tags = fields.take("tags").map_or(&[][..], |node| {
        reader.list(node, "a list of tags", "tags: [curve, koch]")
    });
    Description {
        title: fields.optional(reader, "title"),
        about: fields.optional(reader, "about"),
        source: fields.optional(reader, "source"),
        tags: tags.iter().filter_map(|tag| reader.text(tag)).collect(),
    }
}
