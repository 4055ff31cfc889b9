//! Reads values out of nodes, and notes what is wrong instead of giving up.

use std::collections::HashSet;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Diagnostics, Place, Severity, Source, did_you_mean};
use crate::expression::{Expression, is_name};
use crate::style::Named;

use super::node::{Node, Value};
use super::shape::{Form, Member, Shape};
use super::{Number, Point, Written};

/// Collects what is wrong while values are read.
#[derive(Default)]
pub(super) struct Reader {
    pub(super) diagnostics: Diagnostics,
    /// Whether something could not be read that may give names a meaning.
    pub(super) names_are_missing: bool,
    /// The places of mistakes of syntax that have been mended.
    mended: HashSet<(*const Source, usize, usize)>,
    /// The places of errors that were found before anything was read.
    errors: Arc<[Place]>,
}

/// The value of a key, and where the key is written.
#[derive(Clone, Copy)]
struct Field<'n> {
    key: &'n Place,
    value: &'n Node,
}

/// A mapping whose keys are taken one by one.
pub(super) struct Fields<'n> {
    pub(super) place: &'n Place,
    shape: &'static Shape,
    entries: Vec<(&'static str, Field<'n>)>,
}

impl<'n> Fields<'n> {
    /// The value of a key.
    pub(super) fn take(&self, key: &'static str) -> Option<&'n Node> {
        self.field(key).map(|field| field.value)
    }

    /// The keys with their values, in the order in which they are written.
    pub(super) fn in_order(&self) -> impl Iterator<Item = (&'static str, &'n Node)> {
        self.entries
            .iter()
            .map(|(name, field)| (*name, field.value))
    }

    /// Where a key is written; the mapping where it is not there.
    pub(super) fn place_of(&self, key: &'static str) -> &'n Place {
        self.field(key).map_or(self.place, |field| field.key)
    }

    /// What its shape says of a key.
    fn member(&self, key: &'static str) -> Option<&'static Member> {
        self.shape.members().find(|member| member.name == key)
    }

    fn field(&self, key: &'static str) -> Option<Field<'n>> {
        debug_assert!(
            self.member(key).is_some(),
            "{} has no key '{key}'",
            self.shape.what
        );
        let found = self.entries.iter().find(|(name, _)| *name == key);
        found.map(|(_, field)| *field)
    }
}

impl Reader {
    /// A reader of what has these mistakes.
    pub(super) fn after(diagnostics: &Diagnostics) -> Self {
        let places = diagnostics.iter().filter_map(Diagnostic::place);
        let is_error = |found: &&Diagnostic| found.severity() == Severity::Error;
        let errors = diagnostics.iter().filter(is_error);
        Self {
            mended: places.map(identity).collect(),
            errors: errors.filter_map(Diagnostic::place).cloned().collect(),
            ..Self::default()
        }
    }

    /// A reader of a file that stands inside the one that is read.
    pub(super) fn inside(&self) -> Self {
        Self {
            mended: self.mended.clone(),
            errors: Arc::clone(&self.errors),
            ..Self::default()
        }
    }

    /// Whether nothing was wrong with a node before it was read, nor with what has been read by this
    /// reader.
    pub(super) fn is_sound(&self, node: &Node) -> bool {
        !self.diagnostics.has_errors() && !self.errors.iter().any(|place| node.holds(place))
    }

    /// Whether a mistake at the very place of this node has been reported.
    fn is_mended(&self, node: &Node) -> bool {
        self.mended.contains(&identity(&node.place))
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
        } else if node.value == Value::Null {
            diagnostic = diagnostic.hint("write it behind the ':', or leave the key out");
        }
        self.diagnostics.push(diagnostic);
    }

    /// The keys of a mapping; those that are not known are reported, and taken for what they mean.
    pub(super) fn fields<'n>(
        &mut self,
        node: &'n Node,
        shape: &'static Shape,
    ) -> Option<Fields<'n>> {
        let Value::Mapping(entries) = &node.value else {
            self.mismatch(node, shape.what, shape.hint);
            return None;
        };
        let keys = entries.iter().map(|(key, _)| key);
        let meant = shape.meant(keys, |diagnostic| self.diagnostics.push(diagnostic));
        let mut known = Vec::new();
        for (name, (key, value)) in meant.into_iter().zip(entries) {
            let key = &key.place;
            match name {
                Some(name) => known.push((name, Field { key, value })),
                None => self.names_are_missing |= matches!(value.value, Value::Mapping(_)),
            }
        }
        Some(Fields {
            place: &node.place,
            shape,
            entries: known,
        })
    }

    /// Whether this is a component by name: one that another mistake kept from being put in.
    pub(super) fn is_component(&self, node: &Node) -> bool {
        matches!(node.value, Value::Text(_)) && self.diagnostics.has_errors()
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

    /// A flag; where it is left out or cannot be read, what its shape says.
    pub(super) fn flag(&mut self, fields: &Fields<'_>, key: &'static str) -> bool {
        let default = fields
            .member(key)
            .is_some_and(|member| matches!(member.holds, Form::Flag(true)));
        match fields.take(key).map(|node| (&node.value, node)) {
            None => default,
            Some((Value::Bool(flag), _)) => *flag,
            Some((_, node)) => {
                let hint = match node.written().map(str::to_lowercase).as_deref() {
                    Some("yes" | "on" | "true") => "write true",
                    Some("no" | "off" | "false") => "write false",
                    _ => "write true or false, without quotes",
                };
                self.mismatch(node, "true or false", hint);
                default
            }
        }
    }

    /// A name that something is called by.
    pub(super) fn name(&mut self, node: &Node) -> Option<Written<String>> {
        self.text(node).map(|value| Written {
            value,
            place: node.place.clone(),
        })
    }

    /// An expression. Where it is wrong, that is noted and an unknown one stands in for it.
    pub(super) fn number(&mut self, node: &Node) -> Number {
        let expression = match &node.value {
            Value::Number(value) => Expression::number(*value),
            Value::Text(text) => Expression::parse(text).unwrap_or_else(|error| {
                if self.is_mended(node) {
                    return Expression::unknown();
                }
                let place = node.within(error.range.clone());
                let mut diagnostic = Diagnostic::error(error.message).at(&place);
                if let Some(hint) = error.hint {
                    diagnostic = diagnostic.hint(hint);
                }
                self.diagnostics.push(diagnostic);
                Expression::unknown()
            }),
            _ => {
                self.mismatch(
                    node,
                    "a number",
                    "a number or an expression such as 1/3 or sqrt(3)/6",
                );
                Expression::unknown()
            }
        };
        let expression = if self.is_mended(node) && expression.as_call().is_some() {
            // Whether a distribution belongs here is said when the comma is mended.
            Expression::unknown()
        } else {
            expression
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
    pub(super) fn point(&mut self, node: &Node) -> Point {
        let hint = "a point is written [x, y]";
        let mut point = Point::unknown(&node.place);
        let Value::Sequence(entries) = &node.value else {
            self.mismatch(node, "a point", hint);
            return point;
        };
        if let [entry] = entries.as_slice()
            && let Value::Text(text) = &entry.value
            && let Some(at) = text.find(';')
        {
            let place = entry.within(at..at + 1);
            self.error_with_hint(&place, "';' does not belong in a point", hint);
            return point;
        }
        for (index, entry) in entries.iter().enumerate() {
            let number = self.number(entry);
            match index {
                0 => point.x = number,
                1 => point.y = number,
                _ => {}
            }
        }
        let count = entries.len();
        if count == 2 {
            return point;
        }
        if !entries.iter().any(|entry| self.is_mended(entry)) {
            let s = if count == 1 { "" } else { "s" };
            let message = format!("a point has two coordinates, this one has {count} number{s}");
            let hint = match count {
                3 => {
                    "fractals lie in the plane: a point is written [x, y], decimals with a point: 0.5"
                }
                4.. => "a point is written [x, y], decimals with a point: 0.5",
                _ => hint,
            };
            self.error_with_hint(&node.place, message, hint);
        }
        Point::unknown(&node.place)
    }

    /// The same, or the name of a complex parameter.
    pub(super) fn optional_complex(&mut self, node: Option<&Node>) -> Option<Point> {
        let node = node?;
        match &node.value {
            Value::Text(name) if is_name(name) => Some(Point::named(name, &node.place)),
            Value::Text(text) => {
                let message = format!("'{text}' is neither a point nor a name");
                let hint = "write [x, y], or the name of a complex parameter";
                self.error_with_hint(&node.place, message, hint);
                Some(Point::unknown(&node.place))
            }
            _ => Some(self.point(node)),
        }
    }

    pub(super) fn optional_point(&mut self, node: Option<&Node>) -> Option<Point> {
        node.map(|node| self.point(node))
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

/// What tells a place from others.
fn identity(place: &Place) -> (*const Source, usize, usize) {
    let range = place.range();
    (Arc::as_ptr(place.source()), range.start, range.end)
}
