//! Repetition of list entries: an entry with `for: {k: 0..11}` stands for one entry for each value of `k`, and an instance
//! with `repeat: {count: 12, rotate: 30}` for 12 instances, each turned by 30 degrees against the one before.
//!
//! Entries are repeated before they are read, so that all kinds of files have repetitions, in every list. The name is
//! replaced by its value in all texts of the entry; values keep the notation of the file, and thereby all their digits.

use std::collections::{BTreeMap, BTreeSet};

use crate::diagnostic::{Diagnostic, Diagnostics, Place};
use crate::expression::{Expression, Scope, is_name, is_reserved};
use crate::kind::Kind;
use crate::rule::ElementContext;

use super::node::{Key, Node, Value};
use super::read::TRANSFORMS;
use super::yaml::{Budget, Size};

/// Key of the names and values of a repetition.
pub(super) const FOR: &str = "for";

/// Key of an entry that is not a mapping, such as a point.
pub(super) const EACH: &str = "each";

/// Key of the number and the transform of repeated instances.
pub(super) const REPEAT: &str = "repeat";

/// Key of an alternative of an object, which is no instance.
const UNION: &str = "union";

/// Key of their number.
const COUNT: &str = "count";

/// Maximum depth of parameters that are defined by each other.
const MAX_DEPTH: usize = 64;

/// Maximum number of values of a name.
const MAX_COPIES: i64 = 100_000;

const HINT: &str = "for: {k: 0..11}, or a list of values: {k: [1, 3, 5]}";

/// Returns whether a list in a node has a repetition.
pub(super) fn repeats(node: &Node) -> bool {
    match &node.value {
        Value::Sequence(items) => items
            .iter()
            .any(|item| item.get(FOR).or(item.get(REPEAT)).is_some() || repeats(item)),
        Value::Mapping(entries) => entries.iter().any(|(_, node)| repeats(node)),
        _ => false,
    }
}

/// A file with all its repetitions written out.
pub(super) struct WrittenOut {
    pub(super) node: Node,
    /// Names of parameters that ranges use.
    pub(super) used: BTreeSet<String>,
}

/// Writes out all repetitions of a file. Reports mistakes and returns `None`: without their entries, lists would seem to have
/// other mistakes.
pub(super) fn written_out(file: &Node, diagnostics: &mut Diagnostics) -> Option<WrittenOut> {
    let mut expansion = Expansion {
        parameters: file.get("params"),
        has_instances: matches!(file.get("kind").map(|kind| &kind.value), Some(Value::Text(kind)) if kind == Kind::Instancing.name()),
        values: BTreeMap::new(),
        budget: Budget::default(),
        is_full: false,
        mistakes: Diagnostics::default(),
    };
    expansion.budget.own(Size::of(file));
    let node = expansion.node(file);
    let used = expansion.values.into_keys().collect();
    let is_sound = expansion.mistakes.is_empty();
    diagnostics.extend(expansion.mistakes);
    is_sound.then_some(WrittenOut { node, used })
}

struct Expansion<'f> {
    /// Parameters of the file, which ranges may use.
    parameters: Option<&'f Node>,
    /// Whether the file is a structure, whose instances may be repeated.
    has_instances: bool,
    /// Values of the parameters that ranges use.
    values: BTreeMap<String, f64>,
    budget: Budget,
    /// Whether the file has become too large, which is reported once.
    is_full: bool,
    mistakes: Diagnostics,
}

impl Expansion<'_> {
    fn node(&mut self, node: &Node) -> Node {
        let value = match &node.value {
            Value::Sequence(items) => {
                let mut all = Vec::with_capacity(items.len());
                items.iter().for_each(|item| self.entry(item, &mut all));
                Value::Sequence(all)
            }
            Value::Mapping(entries) => {
                let entry = |(key, value): &(Key, Node)| (key.clone(), self.node(value));
                Value::Mapping(entries.iter().map(entry).collect())
            }
            scalar => scalar.clone(),
        };
        Node {
            place: node.place.clone(),
            value,
        }
    }

    /// Appends the entries that an entry of a list stands for.
    fn entry(&mut self, entry: &Node, all: &mut Vec<Node>) {
        if let Some(repetition) = entry.get(FOR) {
            self.repeat(entry, repetition, all);
        } else if let Some(repetition) = entry
            .get(REPEAT)
            .filter(|_| self.has_instances && entry.get(UNION).is_none())
        {
            self.repeat_instance(entry, repetition, all);
        } else {
            all.push(self.node(entry));
        }
    }

    /// Appends the instances that an instance with a number and a transform stands for: with none of the transform, with
    /// one, and so on.
    fn repeat_instance(&mut self, entry: &Node, repetition: &Node, all: &mut Vec<Node>) {
        const HINT: &str = "repeat: {count: 12, rotate: 30}";
        let (Value::Mapping(keys), Value::Mapping(own)) = (&repetition.value, &entry.value) else {
            let message = format!(
                "a number and a transform are needed here, this is {}",
                repetition.kind()
            );
            return self.error(&repetition.place, message, HINT);
        };
        let (count, step): (Vec<_>, Vec<_>) =
            keys.iter().cloned().partition(|(key, _)| key.name == COUNT);
        let Some((_, count)) = count.first() else {
            let message = "a repetition needs a `count`".into();
            return self.error(&repetition.place, message, HINT);
        };
        if let Some((key, _)) = step.iter().find(|(key, _)| !is_transform(key)) {
            let message = format!("unknown key '{}' in a repetition", key.name);
            return self.error(&key.place, message, HINT);
        }
        if step.is_empty() {
            let message = "the copies lie on each other: a repetition needs a transform".into();
            return self.error(&repetition.place, message, HINT);
        }
        let Some(count) = self.whole(&text_of(count), &count.place, HINT) else {
            return;
        };
        if !(1..=MAX_COPIES).contains(&count) {
            let message = format!("a repetition has from 1 to {MAX_COPIES} copies, not {count}");
            return self.error(&repetition.place, message, HINT);
        }
        let (transforms, mut rest): (Vec<_>, Vec<_>) =
            own.iter().cloned().partition(|(key, _)| is_transform(key));
        let mut lists = transforms.iter().chain(&step);
        if let Some((_, list)) = lists.find(|(_, list)| list.value == Value::Sequence(Vec::new())) {
            let message = "there is no transform in this list".into();
            return self.error(&list.place, message, HINT);
        }
        rest.retain(|(key, _)| key.name != REPEAT);
        let step = in_order(step);
        let mut transforms = in_order(transforms);
        for _ in 0..count {
            let mut keys = rest.clone();
            if !transforms.is_empty() {
                let key = Key {
                    name: "transform".into(),
                    place: repetition.place.clone(),
                };
                let list = Node {
                    place: repetition.place.clone(),
                    value: Value::Sequence(transforms.clone()),
                };
                keys.push((key, list));
            }
            let copy = Node {
                place: entry.place.clone(),
                value: Value::Mapping(keys),
            };
            if !self.has_room(&copy, &entry.place, false) {
                return;
            }
            all.push(self.node(&copy));
            transforms.extend_from_slice(&step);
        }
    }

    /// Returns whether the limit of the size admits another copy, which is to be repeated further if it `is_outer`.
    /// Exceeding the limit is reported once.
    fn has_room(&mut self, copy: &Node, place: &Place, is_outer: bool) -> bool {
        let room = self.budget.component(Size::of(copy), place);
        if let Err(mut error) = room {
            if is_outer {
                let message = "the repetitions of this file take too long: its `for` makes too many copies of this entry";
                let hint = "the outer names alone make so many, even if the values of the last name are few or none: give them fewer values";
                error = Diagnostic::error(message).at(place).hint(hint);
            }
            if !std::mem::replace(&mut self.is_full, true) {
                self.mistakes.push(error);
            }
            return false;
        }
        true
    }

    /// Appends the entries that an entry stands for.
    fn repeat(&mut self, entry: &Node, repetition: &Node, all: &mut Vec<Node>) {
        let Value::Mapping(names) = &repetition.value else {
            let message = format!(
                "names and their values are needed here, this is {}",
                repetition.kind()
            );
            return self.error(&repetition.place, message, HINT);
        };
        let Some(body) = self.body(entry) else {
            return;
        };
        let mut copies = vec![body];
        for (name, values) in names {
            if !self.check_name(name) {
                return;
            }
            let is_last = names.last().is_some_and(|(last, _)| last.name == name.name);
            let mut next = Vec::new();
            for copy in &copies {
                // The values of a name may depend on those before it.
                let before = copy.get(FOR).and_then(|before| before.get(&name.name));
                let Some(values) = self.values(before.unwrap_or(values)) else {
                    return;
                };
                for value in &values {
                    let copy = with(copy, &name.name, value);
                    if !self.has_room(&copy, &entry.place, !is_last) {
                        return;
                    }
                    next.push(copy);
                }
            }
            copies = next;
        }
        for copy in copies {
            let Value::Mapping(mut entries) = copy.value else {
                continue;
            };
            entries.retain(|(key, _)| key.name != FOR);
            if let Some((_, each)) = entries.iter().find(|(key, _)| key.name == EACH) {
                let copy = self.node(each);
                all.push(copy);
                continue;
            }
            let copy = Node {
                place: copy.place,
                value: Value::Mapping(entries),
            };
            self.entry(&copy, all);
        }
    }

    /// Returns an entry that is to be repeated, with its `for`, if it has a content.
    fn body(&mut self, entry: &Node) -> Option<Node> {
        let Value::Mapping(entries) = &entry.value else {
            return None;
        };
        let is_each = entries.iter().any(|(key, _)| key.name == EACH);
        let others = entries.len() - 1;
        if others == 0 {
            self.error(
                &entry.place,
                "nothing is repeated here".into(),
                "write the keys of an entry beside `for`, or `each`",
            );
            return None;
        }
        if is_each && others > 1 {
            let message = "`each` is the whole entry: no other key stands beside it";
            self.error(
                &entry.place,
                message.into(),
                "{for: {k: 0..4}, each: [cos(72*k), sin(72*k)]}",
            );
            return None;
        }
        if let Some(Value::Mapping(_)) = entry.get(EACH).map(|each| &each.value) {
            let message = "`each` is no mapping: its keys stand beside `for`";
            self.error(&entry.place, message.into(), HINT);
            return None;
        }
        Some(entry.clone())
    }

    fn check_name(&mut self, key: &Key) -> bool {
        let name = key.name.as_str();
        let (message, hint) = if !is_name(name) {
            let hint = "a name has letters, digits and _, and begins with a letter";
            (format!("'{name}' cannot be the name of a repetition"), hint)
        } else if is_reserved(name) || ElementContext::NAMES.contains(&name) {
            let message = format!("'{name}' has a meaning of its own in expressions");
            (message, "take another name, such as k")
        } else if self.parameters.is_some_and(|all| all.get(name).is_some()) {
            (format!("'{name}' is a parameter"), "take another name")
        } else {
            return true;
        };
        self.error(&key.place, message, hint);
        false
    }

    /// Returns the values of a name, in the notation of expressions.
    fn values(&mut self, node: &Node) -> Option<Vec<String>> {
        if let Value::Sequence(items) = &node.value {
            let item = |item: &Node| match &item.value {
                Value::Number(_) | Value::Text(_) => Some(text_of(item)),
                _ => None,
            };
            let values: Option<Vec<String>> = items.iter().map(item).collect();
            if values.is_none() {
                self.error(&node.place, "these are no values".into(), HINT);
            }
            return values;
        }
        let ends = match &node.value {
            Value::Text(text) => text.split_once(".."),
            _ => None,
        };
        let Some((first, last)) = ends else {
            let message = match &node.value {
                Value::Text(text) => format!("'{text}' is no range"),
                _ => format!("a range is needed here, this is {}", node.kind()),
            };
            self.error(&node.place, message, HINT);
            return None;
        };
        let [first, last] = [first, last].map(|text| self.whole(text, &node.place, HINT));
        let ends = [first?, last?];
        if ends[1] - ends[0] >= MAX_COPIES {
            let message = format!("this is more than {MAX_COPIES} values");
            self.error(&node.place, message, HINT);
            return None;
        }
        Some((ends[0]..=ends[1]).map(|value| value.to_string()).collect())
    }

    /// Returns the value of an expression of parameters, which is a whole number.
    fn whole(&mut self, text: &str, place: &Place, hint: &str) -> Option<i64> {
        /// Bound of the absolute values.
        const MOST: f64 = 1e9;
        let message = match self.number(text, 0) {
            Ok(value) if value.abs() >= MOST => {
                format!("'{}' is beyond a thousand million", text.trim())
            }
            #[expect(clippy::cast_possible_truncation, reason = "it is below 1e9")]
            Ok(value) if (value.round() - value).abs() < 1e-9 => return Some(value.round() as i64),
            Ok(_) => format!("'{}' is no whole number", text.trim()),
            Err(message) => message,
        };
        self.error(place, message, hint);
        None
    }

    /// Returns the value of an expression of parameters.
    fn number(&mut self, text: &str, depth: usize) -> Result<f64, String> {
        let expression = Expression::parse(text.trim()).map_err(|error| error.message)?;
        let mut scope = Scope::new();
        for (name, _) in expression.names() {
            let known = self.parameters.and_then(|all| all.get(name));
            let Some(known) = known.filter(|_| depth < MAX_DEPTH) else {
                continue;
            };
            let value = match self.values.get(name) {
                Some(value) => *value,
                None => self.number(&text_of(known.get("value").unwrap_or(known)), depth + 1)?,
            };
            self.values.insert(name.to_owned(), value);
            scope.constant(name, value);
        }
        let program = expression.compile(&scope).map_err(|error| error.message)?;
        let value = program.as_constant().filter(|value| value.is_finite());
        value.ok_or_else(|| format!("'{}' is no constant", text.trim()))
    }

    fn error(&mut self, place: &Place, message: String, hint: &str) {
        self.mistakes
            .push(Diagnostic::error(message).at(place).hint(hint));
    }
}

/// Returns whether a key of an instance transforms it.
fn is_transform(key: &Key) -> bool {
    TRANSFORMS.iter().any(|member| member.name == key.name)
}

/// Returns transforms as a list, in the order in which they are written.
fn in_order(transforms: Vec<(Key, Node)>) -> Vec<Node> {
    let mut list = Vec::new();
    for (key, node) in transforms {
        match node.value {
            Value::Sequence(items) if key.name == "transform" => list.extend(items),
            value => list.push(Node {
                place: node.place.clone(),
                value: Value::Mapping(vec![(
                    key,
                    Node {
                        place: node.place,
                        value,
                    },
                )]),
            }),
        }
    }
    list
}

/// Returns a scalar in the notation of expressions.
fn text_of(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => text.clone(),
        // A setting is not written in the file.
        Value::Number(value) if node.place.text().parse() != Ok(*value) => value.to_string(),
        _ => node.place.text().to_owned(),
    }
}

/// Returns a node in which a name is replaced by a value in all texts.
fn with(node: &Node, name: &str, value: &str) -> Node {
    let value_of = |text: &str| Value::Text(replaced(text, name, value));
    let replaced = match &node.value {
        Value::Text(text) => value_of(text),
        Value::Sequence(items) => {
            Value::Sequence(items.iter().map(|item| with(item, name, value)).collect())
        }
        Value::Mapping(entries) => {
            let entry = |(key, node): &(Key, Node)| (key.clone(), with(node, name, value));
            Value::Mapping(entries.iter().map(entry).collect())
        }
        scalar => scalar.clone(),
    };
    Node {
        place: node.place.clone(),
        value: replaced,
    }
}

/// Returns a text in which a name is replaced by a value wherever it stands by itself.
fn replaced(text: &str, name: &str, value: &str) -> String {
    let is_part = |it: char| it.is_alphanumeric() || it == '_';
    let is_plain = value.chars().all(|it| it.is_ascii_digit());
    let mut out = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(name) {
        let (before, after) = (&rest[..at], &rest[at + name.len()..]);
        out += before;
        let mut behind = out.chars().rev();
        let is_joined = match behind.next() {
            Some('#') => true,
            // A part of a complex number, but not the end of a range.
            Some('.') => behind
                .next()
                .is_some_and(|it| it.is_alphabetic() || it == '_'),
            Some(other) => is_part(other),
            None => false,
        };
        if is_joined || after.starts_with(is_part) {
            out += name;
        } else if is_plain {
            out += value;
        } else {
            out += &format!("({value})");
        }
        rest = after;
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::replaced;

    #[test]
    fn names_are_replaced_where_they_stand_alone() {
        for (text, expected) in [
            ("30*k", "30*7"),
            ("row(k)", "row(7)"),
            ("k", "7"),
            ("leek + k2 + _k + #k0k", "leek + k2 + _k + #k0k"),
            ("0..k", "0..7"),
            ("z.k + k", "z.k + 7"),
            ("-k^2", "-7^2"),
        ] {
            assert_eq!(replaced(text, "k", "7"), expected);
        }
        assert_eq!(replaced("2*k", "k", "-1"), "2*(-1)");
        assert_eq!(replaced("k/2", "k", "1/3"), "(1/3)/2");
    }
}
