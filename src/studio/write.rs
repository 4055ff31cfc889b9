//! Values of parameters, written into the text.

use std::ops::Range;
use std::sync::Arc;

use crate::cli::family;
use crate::diagnostic::Source;
use crate::document::node::{Node, Value};

use super::answer::Refusal;
use super::good::{Checked, ParameterState, Reader};

/// Returns the text in which a parameter has another value: nothing else is changed, and the new text, when it is read,
/// has that value.
pub(super) fn write(
    reader: &Reader,
    text: &Arc<str>,
    name: &str,
    value: &str,
) -> Result<Checked, Refusal> {
    let old = reader.source(text);
    let node = Node::parse(&old).map_err(|_| Refusal::wrong("the text has mistakes"))?;
    let (place, path) = place(&node, &old, name)?;
    // The reader leaves out a byte order mark.
    let mark = text.len() - old.text().len();
    let place = place.start + mark..place.end + mark;
    let quoted = format!("\"{value}\"");
    let new = [value, &quoted].into_iter().find_map(|written| {
        let mut new = text.to_string();
        new.replace_range(place.clone(), written);
        let source = reader.source(&new);
        let read = Node::parse(&source).ok()?;
        is_same_but(&node, &read, &path).then_some(())?;
        let checked = reader.check(new.into());
        let good = checked.good.as_ref()?;
        has_value(&good.parameters, name, value).then_some(checked)
    });
    new.ok_or_else(|| {
        Refusal::wrong(format!(
            "{name} = {value} cannot be written into the text: change it by hand"
        ))
    })
}

/// Returns the place of the value of a parameter in a source, and the keys that lead to it.
fn place<'a>(
    node: &Node,
    source: &Arc<Source>,
    name: &'a str,
) -> Result<(Range<usize>, Vec<&'a str>), Refusal> {
    let mut path = vec!["params", name];
    let parameter = node.get("params").and_then(|all| all.get(name));
    let parameter = parameter.filter(|it| Arc::ptr_eq(it.place.source(), source));
    let missing = || Refusal::wrong(format!("the value of {name} is not in this file"));
    let mut value = parameter.ok_or_else(missing)?;
    if let Value::Mapping(_) = value.value {
        path.push("value");
        value = value.get("value").ok_or_else(missing)?;
    }
    Ok((value.place.range(), path))
}

/// Returns whether two nodes have equal values, but for the one to which a path leads.
fn is_same_but(a: &Node, b: &Node, path: &[&str]) -> bool {
    let [first, rest @ ..] = path else {
        return true;
    };
    let (Value::Mapping(a), Value::Mapping(b)) = (&a.value, &b.value) else {
        return false;
    };
    a.len() == b.len()
        && a.iter().zip(b).all(|((key, a), (other, b))| {
            key.name == other.name
                && match key.name == *first {
                    true => is_same_but(a, b, rest),
                    false => a.same_value(b),
                }
        })
}

/// Returns whether a parameter has a value, which may be an expression, or a list of two for a complex one.
fn has_value(parameters: &[ParameterState], name: &str, value: &str) -> bool {
    let is = |parameter: &ParameterState, text: &str| {
        family::value(text.trim()).is_ok_and(|value| value == parameter.value)
    };
    let own: Vec<_> = { parameters.iter() }
        .filter(|it| it.whole.as_deref().unwrap_or(&it.name) == name)
        .collect();
    match own[..] {
        [one] => is(one, value),
        [re, im] => {
            let parts = value.trim().trim_start_matches('[').trim_end_matches(']');
            parts
                .split_once(',')
                .is_some_and(|(first, second)| is(re, first) && is(im, second))
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::Catalogue;

    fn written(text: &str, name: &str, value: &str) -> Result<String, String> {
        let reader = Reader {
            catalogue: Catalogue::embedded(),
            name: "a.yaml".into(),
        };
        let found = write(&reader, &text.into(), name, value);
        found.map(|it| it.text.to_string()).map_err(|it| it.message)
    }

    const REST: &str = "initiator: segment # a\r\ngenerator: [[0, 0], [1/2, x/100], [1, 0]]\r\n";

    #[test]
    fn only_the_value_changes() {
        let text = |value: &str| {
            format!("\u{feff}params: {{x: {{value: {value}, min: 1}}}} # x\r\n{REST}")
        };
        assert_eq!(written(&text("20"), "x", "25/2"), Ok(text("25/2")));
        assert_eq!(
            written(&text("20"), "x", "atan2(1, 2)"),
            Ok(text("\"atan2(1, 2)\""))
        );
        let text = |value: &str| format!("params:\n  x:   {value}   # x\n{REST}");
        assert_eq!(written(&text("20"), "x", "-1.5"), Ok(text("-1.5")));
        let pair = |value: &str| format!("params: {{z: {value}, x: 20}}\n{REST}");
        assert_eq!(
            written(&pair("[0.5, 0.25]"), "z", "[0.1,-0.2]"),
            Ok(pair("[0.1,-0.2]"))
        );
    }

    #[test]
    fn what_is_no_value_is_refused() {
        let text = format!("params: {{x: {{value: 20, min: 1, max: 30}}}}\n{REST}");
        for value in ["31", "a", "", "1}, y: {value: 2", "1 # 2", "[1, 2]"] {
            assert!(written(&text, "x", value).is_err(), "{value}");
        }
        let missing = written(&text, "y", "1").unwrap_err();
        assert!(missing.contains("not in this file"), "{missing}");
    }
}
