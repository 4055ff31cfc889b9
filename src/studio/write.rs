//! Values of parameters, written into the text.

use std::sync::Arc;

use crate::cli::family;
use crate::diagnostic::Source;
use crate::document::node::{Node, Value};
use crate::edit::{Edit, PathStep, edit, find};
use crate::expression::{Expression, PARTS};

use super::answer::Refusal;
use super::good::{Checked, Good, ParameterState, Reader};
use super::session::Session;

impl Session {
    /// Writes the value of a parameter that is set into the text.
    pub(super) fn write_value(&mut self, name: &str) -> Result<(), Refusal> {
        let before = self.look.set.clone();
        let Some(value) = before.get(name) else {
            return Err(Refusal::wrong(format!("{name} is not set")));
        };
        let checked = write(&self.reader(), self.text(), name, value)?;
        let revision = self.revision;
        self.set_text(checked, revision)?;
        self.look.set.remove(name);
        if self.revision != revision {
            self.note_written(before);
        }
        Ok(())
    }
}

/// Returns the text in which a parameter has another value: nothing else is changed, and the new text, when it is read,
/// has that value.
fn write(reader: &Reader, text: &Arc<str>, name: &str, value: &str) -> Result<Checked, Refusal> {
    let old = reader.source(text);
    let node = Node::parse(&old).map_err(|_| Refusal::wrong("the text has mistakes"))?;
    let missing = || Refusal::wrong(format!("the value of {name} is not in this file"));
    let at = place(&node, &old, name).ok_or_else(missing)?;
    let new = edit(text, &[Edit::set(at, value)]).ok();
    let checked = new.map(|new| reader.check(new.into()));
    let has_value = |checked: &Checked| {
        let good = checked.good.as_ref();
        good.is_some_and(|good| has_value(&good.parameters, name, value))
    };
    checked.filter(has_value).ok_or_else(|| {
        Refusal::wrong(format!(
            "{name} = {value} cannot be written into the text: change it by hand"
        ))
    })
}

/// Returns the steps to the value of a parameter that is written in a source.
fn place(node: &Node, source: &Arc<Source>, name: &str) -> Option<Vec<PathStep>> {
    let mut at = vec![PathStep::from("params"), PathStep::from(name)];
    let parameter = find(node, &at).filter(|it| Arc::ptr_eq(it.place.source(), source))?;
    if let Value::Mapping(_) = parameter.value {
        parameter.get("value")?;
        at.push("value".into());
    }
    Some(at)
}

/// Returns the steps to the number of a parameter, which may be a part of a complex one.
fn number(good: &Good, name: &str) -> Option<Vec<PathStep>> {
    let parts = PARTS.iter().enumerate();
    let whole = parts
        .filter_map(|(part, end)| Some((part, name.strip_suffix(end)?)))
        .next();
    match whole {
        None => place(good.node(), &good.source, name),
        Some((part, whole)) => {
            let mut at = place(good.node(), &good.source, whole)?;
            at.push(part.into());
            Some(at)
        }
    }
}

/// Returns whether the value of a parameter is a number that is written in the text, not a formula of others.
pub(super) fn is_number(good: &Good, parameter: &ParameterState) -> bool {
    let node = number(good, &parameter.name).and_then(|at| find(good.node(), &at));
    let parsed = node.and_then(Node::written).map(Expression::parse);
    parsed.is_some_and(|it| it.is_ok_and(|it| it.names().is_empty()))
}

/// Returns the edit that gives a parameter a value.
pub(super) fn parameter(good: &Good, name: &str, value: &str) -> Option<Edit> {
    number(good, name).map(|at| Edit::set(at, value))
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
            Ok(pair("[0.1, -0.2]"))
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
