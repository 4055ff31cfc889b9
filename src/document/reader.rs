//! Reading of typed values from nodes. Mistakes are collected as diagnostics, and reading continues.

mod numbers;

use std::collections::HashSet;
use std::sync::Arc;

use crate::diagnostic::{Diagnostic, Diagnostics, Place, Severity, Source, did_you_mean};
use crate::style::Named;

use super::Written;
use super::node::{Key, Node, Value};
use super::shape::{Form, Member, Shape};
use super::yaml::Size;

/// A reader of values, which collects diagnostics.
#[derive(Default)]
pub(super) struct Reader {
    pub(super) diagnostics: Diagnostics,
    /// Whether an unreadable part of the file may define names. Unknown names are not reported then.
    pub(super) names_are_missing: bool,
    /// Whether points have three coordinates.
    pub(super) is_in_space: bool,
    /// Whether files of the kind that is read may lie in space.
    pub(super) may_lie_in_space: bool,
    /// Places of the diagnostics that precede reading, such as repaired mistakes of syntax.
    mended: HashSet<(*const Source, usize, usize)>,
    /// Places of the errors that precede reading.
    errors: Arc<[Place]>,
    /// Number of values of the file, and of operations of the formulas that have been read.
    values: usize,
    /// Whether it has been reported that these are too many.
    is_full: bool,
}

/// The value of a key and the place of the key.
#[derive(Clone, Copy)]
struct Field<'n> {
    key: &'n Place,
    value: &'n Node,
}

/// The known keys of a mapping.
pub(super) struct Fields<'n> {
    pub(super) place: &'n Place,
    shape: &'static Shape,
    entries: Vec<(&'static str, Field<'n>)>,
}

impl<'n> Fields<'n> {
    /// Returns the value of a key, if the key is present.
    pub(super) fn take(&self, key: &'static str) -> Option<&'n Node> {
        self.field(key).map(|field| field.value)
    }

    /// Iterates over keys and values, in the order in which they are written.
    pub(super) fn in_order(&self) -> impl Iterator<Item = (&'static str, &'n Node)> {
        self.entries
            .iter()
            .map(|(name, field)| (*name, field.value))
    }

    /// Returns the place of a key, or of the mapping if the key is absent.
    pub(super) fn place_of(&self, key: &'static str) -> &'n Place {
        self.field(key).map_or(self.place, |field| field.key)
    }

    /// Returns the type of the value of a key.
    pub(super) fn form(&self, key: &'static str) -> Option<&'static Form> {
        self.member(key).map(|member| &member.holds)
    }

    /// Returns whether a key may hold the name of a file.
    pub(super) fn holds_file(&self, key: &'static str) -> bool {
        let is_file = |form: &Form| matches!(form, Form::File(_));
        self.member(key).is_some_and(|member| match member.holds {
            Form::Either(forms) => forms.iter().any(is_file),
            ref form => is_file(form),
        })
    }

    /// Returns the default of a key that is a flag.
    pub(super) fn default_flag(&self, key: &'static str) -> bool {
        { self.member(key) }.is_some_and(|member| matches!(member.holds, Form::Flag(true)))
    }

    /// Returns the definition of a key in the shape.
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
    /// Creates a reader of a file that takes the diagnostics of preceding stages into account.
    pub(super) fn after(diagnostics: &Diagnostics, file: &Node) -> Self {
        let places = diagnostics.iter().filter_map(Diagnostic::place);
        let is_error = |found: &&Diagnostic| found.severity() == Severity::Error;
        let errors = diagnostics.iter().filter(is_error);
        Self {
            mended: places.map(identity).collect(),
            errors: errors.filter_map(Diagnostic::place).cloned().collect(),
            values: Size::of(file).values,
            ..Self::default()
        }
    }

    /// Creates a reader for a file that is nested in the current one.
    pub(super) fn inside(&self) -> Self {
        Self {
            mended: self.mended.clone(),
            errors: Arc::clone(&self.errors),
            values: self.values,
            is_full: self.is_full,
            ..Self::default()
        }
    }

    /// Takes over the diagnostics of a reader of a nested file, and the number of values that it has counted.
    pub(super) fn take(&mut self, inside: Self) {
        self.diagnostics.extend(inside.diagnostics);
        (self.values, self.is_full) = (inside.values, inside.is_full);
    }

    /// Returns whether neither this reader nor a preceding stage has found an error in a node.
    pub(super) fn is_sound(&self, node: &Node) -> bool {
        !self.diagnostics.has_errors() && !self.errors.iter().any(|place| node.holds(place))
    }

    /// Returns whether a diagnostic at exactly the place of this node precedes reading.
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

    /// Reports a value of a wrong type.
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

    /// Returns the keys of a mapping. Unknown keys are reported, and each is interpreted as the key
    /// that was probably meant; then keys that are absent.
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
        for member in shape.members() {
            if let Some((message, hint)) = member.absent
                && known.iter().all(|(name, _)| *name != member.name)
            {
                let place = node.place.first_line();
                self.error_with_hint(&place, message, hint.unwrap_or(shape.hint));
            }
        }
        Some(Fields {
            place: &node.place,
            shape,
            entries: known,
        })
    }

    /// Returns whether this is the name of a component that was not inlined because of another mistake.
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

    /// Reads `true` or `false`.
    pub(super) fn flag(&mut self, node: &Node) -> Option<bool> {
        if let Value::Bool(flag) = node.value {
            return Some(flag);
        }
        let hint = match node.written().map(str::to_lowercase).as_deref() {
            Some("yes" | "on" | "true") => "write true",
            Some("no" | "off" | "false") => "write false",
            _ => "write true or false, without quotes",
        };
        self.mismatch(node, "true or false", hint);
        None
    }

    /// Reads a name.
    pub(super) fn name(&mut self, node: &Node) -> Option<Written<String>> {
        self.text(node).map(|value| Written {
            value,
            place: node.place.clone(),
        })
    }

    /// Returns the entries of a mapping of arbitrary names.
    pub(super) fn entries<'n>(
        &mut self,
        node: &'n Node,
        what: &str,
        hint: &str,
    ) -> Option<&'n [(Key, Node)]> {
        if let Value::Mapping(entries) = &node.value {
            return Some(entries);
        }
        self.mismatch(node, what, hint);
        None
    }

    /// Returns the entries of a mapping whose names other values may use.
    pub(super) fn names<'n>(
        &mut self,
        node: &'n Node,
        what: &str,
        hint: &str,
    ) -> &'n [(Key, Node)] {
        let entries = self.entries(node, what, hint);
        self.names_are_missing |= entries.is_none();
        entries.unwrap_or_default()
    }

    pub(super) fn list<'n>(&mut self, node: &'n Node, what: &str, hint: &str) -> &'n [Node] {
        if let Value::Sequence(entries) = &node.value {
            entries
        } else {
            self.mismatch(node, what, hint);
            &[]
        }
    }

    /// Returns the entries of a list; an empty one is reported as one in which there is no `entry`.
    pub(super) fn filled<'n>(
        &mut self,
        node: &'n Node,
        what: &str,
        entry: &str,
        hint: &str,
    ) -> &'n [Node] {
        let entries = self.list(node, what, hint);
        if matches!(&node.value, Value::Sequence(all) if all.is_empty()) {
            let message = format!("there is no {entry} in this list");
            self.error_with_hint(&node.place, message, hint);
        }
        entries
    }

    /// Reads the name of a variant of an enumeration.
    pub(super) fn variant<T: Named>(&mut self, node: &Node, what: &str) -> Option<T> {
        let name = match &node.value {
            Value::Text(name) => name.as_str(),
            // YAML reads an unquoted `none` as text, but `null` and `~` as null.
            Value::Null => "none",
            _ => node.place.text(),
        };
        let found = T::from_name(name);
        if found.is_none() {
            let names = T::NAMES.iter().map(|(name, _)| *name);
            self.no_name(node, name, names, what);
        }
        found
    }

    /// Reads one of several words.
    pub(super) fn word(
        &mut self,
        node: &Node,
        words: &[&'static str],
        what: &str,
    ) -> Option<&'static str> {
        let name = match &node.value {
            Value::Text(name) => name.as_str(),
            _ => node.place.text(),
        };
        let found = words.iter().find(|word| **word == name);
        if found.is_none() {
            self.no_name(node, name, words.iter().copied(), what);
        }
        found.copied()
    }

    fn no_name<'n>(
        &mut self,
        node: &Node,
        name: &str,
        names: impl Iterator<Item = &'n str> + Clone,
        what: &str,
    ) {
        let hint = did_you_mean(name, names.clone())
            .unwrap_or_else(|| format!("one of: {}", names.collect::<Vec<_>>().join(", ")));
        self.error_with_hint(&node.place, format!("'{name}' is no {what}"), hint);
    }
}

/// Returns a key that identifies a source span.
fn identity(place: &Place) -> (*const Source, usize, usize) {
    let range = place.range();
    (Arc::as_ptr(place.source()), range.start, range.end)
}
