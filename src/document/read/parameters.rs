//! Reading of parameters.

use std::collections::BTreeSet;

use crate::document::metadata::ParameterDocument;
use crate::document::node::{Key, Node, Value};
use crate::document::reader::Reader;
use crate::document::shape::{Form, Member, Shape, key, keys};
use crate::document::{Written, WrittenNumber, WrittenPoint};
use crate::expression::{Expression, PARTS};

/// A real or complex number.
const NUMBER: Form = Form::Either(&[Form::Number, Form::Point]);

pub(in crate::document) const PARAMETER: Shape = Shape {
    what: "a parameter",
    keys: &[&keys![
        alone value: NUMBER,
            "Its value, where nothing else is set. It may use the parameters above it. A list of two \
             is a complex number, as are its limits then: [real part, imaginary part]; so is a formula with i or another complex parameter, 1/(2 - i).";
        min: NUMBER, "The least value that it may be set to.";
        max: NUMBER, "The largest value that it may be set to.";
        about: Form::Text, "What it means.";
    ]],
    alternatives: &[],
    hint: "angle: {value: 45, min: 5, max: 85, about: \"what it means\"}",
};

/// The key for the parameters of a rule or component.
pub(in crate::document) const PARAMS: Member = key(
    "params",
    Form::Names(
        &Form::Either(&[Form::Number, Form::Point, Form::Mapping(&PARAMETER)]),
        0,
    ),
    "Parameters by name: a value, or a value with its limits and meaning. Formulas use them, and \
     other values can be set from outside. A complex one is [real part, imaginary part].",
);

pub(super) fn read_params(reader: &mut Reader, node: Option<&Node>) -> Vec<ParameterDocument> {
    let Some(node) = node else { return Vec::new() };
    let entries = reader.names(node, "a mapping of parameters", "params: {angle: 45}");
    let mut complex = BTreeSet::new();
    let mut params = Vec::new();
    for (key, node) in entries {
        let read = read_param(reader, key, node, &|name| complex.contains(name));
        if read.iter().any(|it| it.whole.is_some()) {
            complex.insert(key.name.clone());
        }
        params.extend(read);
    }
    params
}

/// Returns whether a value is a complex number: a list, or a formula with the imaginary unit or with a complex parameter.
pub(super) fn is_complex(node: &Node, is_known: &dyn Fn(&str) -> bool) -> bool {
    match &node.value {
        Value::Sequence(_) => true,
        Value::Text(text) => Expression::parse(text).is_ok_and(|it| it.is_complex(is_known)),
        _ => false,
    }
}

/// Reads a parameter, or the two parts of a complex parameter; `is_known` returns whether a name is that of one above it.
fn read_param(
    reader: &mut Reader,
    key: &Key,
    node: &Node,
    is_known: &dyn Fn(&str) -> bool,
) -> Vec<ParameterDocument> {
    let is_complex = |node: &Node| is_complex(node, is_known);
    let mut parameter = ParameterDocument {
        name: written(key),
        whole: None,
        value: unknown(key),
        min: None,
        max: None,
        about: None,
    };
    if is_complex(node) {
        let value = reader.point(node);
        return parts(parameter, value, [None, None]);
    }
    if !matches!(node.value, Value::Mapping(_)) {
        parameter.value = reader.number(node);
        return vec![parameter];
    }
    let Some(fields) = reader.fields(node, &PARAMETER) else {
        return vec![parameter];
    };
    parameter.about = fields.optional(reader, "about");
    let limits = ["min", "max"].map(|name| fields.take(name));
    let Some(value) = fields.take("value") else {
        let message = format!("parameter '{}' has no value", key.name);
        reader.error_with_hint(&key.place, message, PARAMETER.hint);
        return vec![parameter];
    };
    // A complex value requires complex limits, and a complex limit a complex value.
    let complex = |reader: &mut Reader, node: &Node, what: &str| {
        if !is_complex(node) && matches!(node.value, Value::Number(_) | Value::Text(_)) {
            let message = format!("'{}' is complex, and this {what} of it is real", key.name);
            let hint = "write [real part, imaginary part]";
            reader.error_with_hint(&node.place, message, hint);
            return WrittenPoint::unknown(&node.place);
        }
        reader.point(node)
    };
    if is_complex(value) || limits.iter().flatten().any(|node| is_complex(node)) {
        let value = complex(reader, value, "value");
        let limits = limits.map(|node| node.map(|node| complex(reader, node, "limit")));
        return parts(parameter, value, limits);
    }
    parameter.value = reader.number(value);
    [parameter.min, parameter.max] = limits.map(|node| node.map(|node| reader.number(node)));
    vec![parameter]
}

/// Splits a complex parameter with its value and limits into its two parts.
fn parts(
    whole: ParameterDocument,
    value: WrittenPoint,
    [min, max]: [Option<WrittenPoint>; 2],
) -> Vec<ParameterDocument> {
    let sides: [fn(WrittenPoint) -> WrittenNumber; 2] = [|point| point.x, |point| point.y];
    let both = PARTS.into_iter().zip(["real", "imaginary"]).zip(sides);
    both.map(|((suffix, which), side)| {
        let name = &whole.name.value;
        let about = whole.about.as_ref();
        let about = about.map_or_else(String::new, |about| format!(": {}", about.trim()));
        ParameterDocument {
            name: Written {
                value: format!("{name}{suffix}"),
                place: whole.name.place.clone(),
            },
            whole: Some(whole.name.clone()),
            value: side(value.clone()),
            min: min.clone().map(side),
            max: max.clone().map(side),
            about: Some(format!("the {which} part of {name}{about}")),
        }
    })
    .collect()
}

/// Returns a key as a name with its source span.
pub(super) fn written(key: &Key) -> Written<String> {
    Written {
        value: key.name.clone(),
        place: key.place.clone(),
    }
}

fn unknown(key: &Key) -> WrittenNumber {
    Written {
        value: Expression::unknown(),
        place: key.place.clone(),
    }
}
