//! Reads values out of nodes, and notes what is wrong instead of giving up.

use crate::diagnostic::{Diagnostic, Diagnostics, Place, did_you_mean};
use crate::expression::Expression;
use crate::style::Named;

use super::node::{Node, Value};
use super::{Number, Point, Written};

/// Collects what is wrong while values are read.
#[derive(Default)]
pub(super) struct Reader {
    pub(super) diagnostics: Diagnostics,
}

/// A mapping whose keys are taken one by one; those left over are unknown.
pub(super) struct Fields<'n> {
    pub(super) place: &'n Place,
    entries: Vec<(&'n super::node::Key, &'n Node)>,
    /// The keys that have been asked for.
    known: Vec<&'static str>,
}

impl<'n> Fields<'n> {
    /// The value of a key, once.
    pub(super) fn take(&mut self, key: &'static str) -> Option<&'n Node> {
        self.known.push(key);
        let index = self.entries.iter().position(|(name, _)| name.name == key)?;
        Some(self.entries.remove(index).1)
    }

    /// The value of a key, without taking it.
    pub(super) fn has(&self, key: &str) -> bool {
        self.entries.iter().any(|(name, _)| name.name == key)
    }
}

impl Reader {
    pub(super) fn error(&mut self, place: &Place, message: impl Into<String>) {
        self.diagnostics.push(Diagnostic::error(message).at(place));
    }

    pub(super) fn error_with_hint(
        &mut self,
        place: &Place,
        message: impl Into<String>,
        hint: impl Into<String>,
    ) {
        self.diagnostics
            .push(Diagnostic::error(message).at(place).hint(hint));
    }

    /// Something else stands where `expected` should.
    pub(super) fn mismatch(&mut self, node: &Node, expected: &str, hint: &str) {
        let message = format!("{expected} is needed here, this is {}", node.kind());
        let mut diagnostic = Diagnostic::error(message).at(&node.place);
        if !hint.is_empty() {
            diagnostic = diagnostic.hint(hint);
        }
        self.diagnostics.push(diagnostic);
    }

    pub(super) fn fields<'n>(
        &mut self,
        node: &'n Node,
        what: &str,
        hint: &str,
    ) -> Option<Fields<'n>> {
        let Value::Mapping(entries) = &node.value else {
            self.mismatch(node, what, hint);
            return None;
        };
        Some(Fields {
            place: &node.place,
            entries: entries.iter().map(|(key, value)| (key, value)).collect(),
            known: Vec::new(),
        })
    }

    /// Reports the keys that nobody asked for.
    pub(super) fn finish(&mut self, fields: Fields<'_>, what: &str) {
        for (key, _) in fields.entries {
            let known = fields.known.iter().copied();
            let hint = did_you_mean(&key.name, known.clone()).unwrap_or_else(|| {
                format!("{what} may have: {}", known.collect::<Vec<_>>().join(", "))
            });
            let message = format!("unknown key '{}' in {what}", key.name);
            self.error_with_hint(&key.place, message, hint);
        }
    }

    pub(super) fn text(&mut self, node: &Node) -> Option<String> {
        match &node.value {
            Value::Text(text) => Some(text.clone()),
            Value::Number(_) => node.written().map(Into::into),
            _ => {
                self.mismatch(node, "text", "");
                None
            }
        }
    }

    pub(super) fn flag(&mut self, node: Option<&Node>, default: bool) -> bool {
        match node.map(|node| (&node.value, node)) {
            None => default,
            Some((Value::Bool(flag), _)) => *flag,
            Some((_, node)) => {
                self.mismatch(node, "true or false", "");
                default
            }
        }
    }

    /// An expression. Where it is wrong, that is noted and 0 stands in for it.
    pub(super) fn number(&mut self, node: &Node) -> Number {
        let expression = match &node.value {
            Value::Number(value) => Expression::number(*value),
            Value::Text(text) => Expression::parse(text).unwrap_or_else(|error| {
                let place = node.within(error.range.clone());
                let mut diagnostic = Diagnostic::error(error.message).at(&place);
                if let Some(hint) = error.hint {
                    diagnostic = diagnostic.hint(hint);
                }
                self.diagnostics.push(diagnostic);
                Expression::number(0.0)
            }),
            _ => {
                self.mismatch(
                    node,
                    "a number",
                    "a number or an expression such as 1/3 or sqrt(3)/6",
                );
                Expression::number(0.0)
            }
        };
        for warning in expression.warnings() {
            let place = node.within(warning.range.clone());
            let mut diagnostic = Diagnostic::warning(warning.message).at(&place);
            if let Some(hint) = warning.hint {
                diagnostic = diagnostic.hint(hint);
            }
            self.diagnostics.push(diagnostic);
        }
        Written {
            value: expression,
            place: node.place.clone(),
        }
    }

    pub(super) fn optional_number(&mut self, node: Option<&Node>) -> Option<Number> {
        node.map(|node| self.number(node))
    }

    /// A list of exactly two numbers.
    pub(super) fn point(&mut self, node: &Node) -> Option<Point> {
        let hint = "a point is written [x, y]";
        let Value::Sequence(entries) = &node.value else {
            self.mismatch(node, "a point", hint);
            return None;
        };
        let numbers: Vec<_> = entries.iter().map(|entry| self.number(entry)).collect();
        let count = numbers.len();
        if let Ok([x, y]) = <[Number; 2]>::try_from(numbers) {
            return Some(Point {
                x,
                y,
                place: node.place.clone(),
            });
        }
        let s = if count == 1 { "" } else { "s" };
        self.error_with_hint(
            &node.place,
            format!("a point has two coordinates, this one has {count} number{s}"),
            hint,
        );
        None
    }

    pub(super) fn list<'n>(&mut self, node: &'n Node, what: &str, hint: &str) -> &'n [Node] {
        if let Value::Sequence(entries) = &node.value {
            entries
        } else {
            self.mismatch(node, what, hint);
            &[]
        }
    }

    /// One of the names of an enumeration.
    pub(super) fn variant<T: Named>(&mut self, node: &Node, what: &str) -> Option<T> {
        let name = match &node.value {
            Value::Text(name) => name.as_str(),
            // YAML reads an unquoted `none` as text, but `null` and `~` as nothing.
            Value::Null => "none",
            _ => node.place.text(),
        };
        let found = T::from_name(name);
        if found.is_none() {
            let names = T::NAMES.iter().map(|(name, _)| *name);
            let hint = did_you_mean(name, names.clone())
                .unwrap_or_else(|| format!("one of: {}", names.collect::<Vec<_>>().join(", ")));
            self.error_with_hint(&node.place, format!("'{name}' is no {what}"), hint);
        }
        found
    }
}
