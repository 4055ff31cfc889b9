//! Parameters.

use crate::document::heading::ParameterDocument;
use crate::document::node::{Key, Node, Value};
use crate::document::reader::Reader;
use crate::document::shape::{Form, Member, Needed, Shape, key};
use crate::document::{Number, Written};
use crate::expression::Expression;

pub(in crate::document) const PARAMETER: Shape = Shape {
    what: "a parameter",
    keys: &[&[
        Member {
            needed: Needed::Alone,
            ..key(
                "value",
                Form::Number,
                "Its value, where nothing else is set. It may use the parameters above it.",
            )
        },
        key(
            "min",
            Form::Number,
            "The least value that it may be set to.",
        ),
        key(
            "max",
            Form::Number,
            "The largest value that it may be set to.",
        ),
        key("about", Form::Text, "What it means."),
    ]],
    ways: &[],
    hint: "angle: {value: 45, min: 5, max: 85, about: \"what it means\"}",
};

/// The parameters of a rule or component.
pub(in crate::document) const PARAMS: Member = key(
    "params",
    Form::Names(&Form::Either(&[Form::Number, Form::Mapping(&PARAMETER)]), 0),
    "Parameters by name: a value, or a value with its limits and meaning. Formulas use them, and \
     `--set NAME=VALUE` changes them.",
);

pub(super) fn read_params(reader: &mut Reader, node: Option<&Node>) -> Vec<ParameterDocument> {
    let Some(node) = node else { return Vec::new() };
    let Value::Mapping(entries) = &node.value else {
        reader.mismatch(node, "a mapping of parameters", "params: {angle: 45}");
        reader.names_are_missing = true;
        return Vec::new();
    };
    entries
        .iter()
        .map(|(key, node)| read_param(reader, key, node))
        .collect()
}

fn read_param(reader: &mut Reader, key: &Key, node: &Node) -> ParameterDocument {
    let mut parameter = ParameterDocument {
        name: written(key),
        value: unknown(key),
        min: None,
        max: None,
        about: None,
    };
    if !matches!(node.value, Value::Mapping(_)) {
        parameter.value = reader.number(node);
        return parameter;
    }
    let Some(fields) = reader.fields(node, &PARAMETER) else {
        return parameter;
    };
    match fields.take("value") {
        Some(value) => parameter.value = reader.number(value),
        None => {
            let message = format!("parameter '{}' has no value", key.name);
            reader.error_with_hint(&key.place, message, PARAMETER.hint);
        }
    }
    parameter.min = reader.optional_number(fields.take("min"));
    parameter.max = reader.optional_number(fields.take("max"));
    parameter.about = fields.take("about").and_then(|node| reader.text(node));
    parameter
}

/// A key as the name of what it holds.
pub(super) fn written(key: &Key) -> Written<String> {
    Written {
        value: key.name.clone(),
        place: key.place.clone(),
    }
}

fn unknown(key: &Key) -> Number {
    Written {
        value: Expression::unknown(),
        place: key.place.clone(),
    }
}
