//! Parameters.

use crate::document::node::{Key, Node, Value};
use crate::document::reader::Reader;
use crate::document::rule::ParameterDocument;
use crate::document::shape::Shape;
use crate::document::{Number, Written};
use crate::expression::Expression;

const PARAMETER: Shape = Shape {
    what: "a parameter",
    keys: &["value", "min", "max", "about"],
    hint: "angle: {value: 45, min: 5, max: 85, about: \"what it means\"}",
};

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
