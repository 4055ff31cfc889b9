//! A rule: what its keys hold.

use crate::diagnostic::{Diagnostics, Place};
use crate::document::node::{Node, Value};
use crate::document::reader::{Fields, Reader};
use crate::document::rule::{InitiatorDocument, RuleDocument};
use crate::document::shape::Shape;
use crate::document::style::{read_style, read_view};
use crate::rule::Description;

use super::base_element::read_base_element;
use super::elements::read_initiator;
use super::generator::read_generators;
use super::parameters::read_params;
use super::select::read_select;

/// The keys of a rule.
pub(in crate::document) const RULE: Shape = Shape {
    what: "a rule",
    keys: &[
        "title",
        "about",
        "source",
        "tags",
        "format",
        "kind",
        "extends",
        "params",
        "initiator",
        "generator",
        "generators",
        "select",
        "base_element",
        "steps",
        "dimension",
        "hausdorff_dimension",
        "style",
        "view",
    ],
    hint: "a rule is a mapping of keys: `kfrac cat koch` shows a short one",
};

/// The keys that describe a file and have no meaning inside another.
pub(in crate::document) const DESCRIPTION: [&str; 5] =
    ["title", "about", "source", "tags", "format"];

/// Reads a rule with its parents and components in it; `complete` if all of them were found.
pub(in crate::document) fn read(
    node: &Node,
    complete: bool,
    diagnostics: &mut Diagnostics,
) -> Option<RuleDocument> {
    let mut reader = Reader::after(diagnostics);
    let rule = read_rule(&mut reader, node, complete);
    diagnostics.extend(reader.diagnostics);
    rule
}

fn read_rule(reader: &mut Reader, node: &Node, complete: bool) -> Option<RuleDocument> {
    let fields = reader.fields(node, &RULE)?;
    if let Some(format) = fields.take("format")
        && !matches!(format.value, Value::Number(version) if version == 1.0)
    {
        let message = format!(
            "version '{}' of the format is not known",
            format.place.text()
        );
        reader.error_with_hint(&format.place, message, "format: 1");
    }
    let initiator = match fields.take("initiator") {
        Some(node) => read_initiator(reader, node),
        None => {
            let message = "the rule has no initiator";
            reader.error_with_hint(&first_line(fields.place), message, "initiator: segment");
            InitiatorDocument::missing(fields.place)
        }
    };
    Some(RuleDocument {
        description: read_description(reader, &fields),
        params: read_params(reader, fields.take("params")),
        initiator,
        generators: read_generators(reader, &fields),
        select: fields.take("select").map(|node| read_select(reader, node)),
        base_element: fields
            .take("base_element")
            .and_then(|node| read_base_element(reader, node)),
        steps: reader.optional_number(fields.take("steps")),
        dimension: reader.optional_number(fields.take("dimension")),
        hausdorff_dimension: reader.optional_number(fields.take("hausdorff_dimension")),
        style: read_style(reader, fields.take("style")),
        view: read_view(reader, fields.take("view")),
        complete: complete && !reader.names_are_missing,
    })
}

fn read_description(reader: &mut Reader, fields: &Fields<'_>) -> Description {
    let mut text = |key| fields.take(key).and_then(|node| reader.text(node));
    let (title, about, source) = (text("title"), text("about"), text("source"));
    let tags = fields.take("tags").map_or(&[][..], |node| {
        reader.list(node, "a list of tags", "tags: [curve, koch]")
    });
    Description {
        title,
        about,
        source,
        tags: tags.iter().filter_map(|tag| reader.text(tag)).collect(),
    }
}

/// The first line of a place: enough to say which mapping lacks something.
pub(super) fn first_line(place: &Place) -> Place {
    let end = place.text().find(['\n', '\r']);
    place.within(0..end.unwrap_or(usize::MAX))
}
