//! Generators of a rule: copied, renamed, removed, and replaced from a step on.

use crate::document::node::{Node, Value};
use crate::edit::{Edit, PathStep, find};

use super::super::answer::Refusal;
use super::act::{Design, below, is_written, plain};

impl Design<'_> {
    /// Adds a copy of a generator, to the selection too: the two take turns where there is none yet.
    pub(super) fn add_generator(&self, from: &str, name: &str) -> Result<Vec<Edit>, Refusal> {
        let mut edits = self.copy(from, name)?;
        let [old, new] = [from, name].map(crate::document::node::scalar);
        let select = || vec![PathStep::from("select")];
        match self.root.get("select") {
            None => edits.push(Edit::Add {
                to: Vec::new(),
                key: "select".into(),
                value: format!("{{by_index: [{old}, {new}]}}"),
                after: Some("generators".into()),
            }),
            Some(node) => {
                if let Some(Value::Sequence(items)) = node.get("by_index").map(|it| &it.value) {
                    edits.push(Edit::insert(below(&select(), "by_index"), items.len(), new));
                } else if node.get("at_random").is_some() {
                    edits.push(Edit::add(below(&select(), "at_random"), name, "1"));
                }
            }
        }
        Ok(edits)
    }

    pub(super) fn copy(&self, from: &str, name: &str) -> Result<Vec<Edit>, Refusal> {
        let single = self.root.get("generator");
        let mut edits = Vec::new();
        let node = match single {
            Some(node) => {
                edits.push(Edit::Nest {
                    at: vec!["generator".into()],
                    key: from.to_owned(),
                });
                edits.push(Edit::rename(vec!["generator".into()], "generators"));
                self.raw.get("generator").filter(is_written).unwrap_or(node)
            }
            None => {
                let at = ["generators".into(), from.into()];
                let raw = find(self.raw, &at).filter(is_written);
                raw.or_else(|| find(self.root, &at))
                    .ok_or_else(|| Refusal::wrong(format!("there is no generator '{from}'")))?
            }
        };
        edits.push(Edit::add(vec!["generators".into()], name, plain(node)));
        Ok(edits)
    }

    /// Returns the places where generators are named, with the names.
    fn uses(&self) -> Vec<(Vec<PathStep>, String)> {
        let mut found = Vec::new();
        add_uses(self.root, &mut Vec::new(), &mut found);
        let by_index: Vec<PathStep> = ["select", "by_index"].map(PathStep::from).into();
        if let Some(Value::Sequence(items)) = find(self.root, &by_index).map(|it| &it.value) {
            for (number, item) in items.iter().enumerate() {
                let name = item.written().unwrap_or_default().to_owned();
                found.push((below(&by_index, number), name));
            }
        }
        found
    }

    pub(super) fn rename(&self, from: &str, to: &str) -> Vec<Edit> {
        let mut edits = vec![Edit::rename(vec!["generators".into(), from.into()], to)];
        let at_random: Vec<PathStep> = ["select", "at_random", from].map(PathStep::from).into();
        if find(self.root, &at_random).is_some() {
            edits.push(Edit::rename(at_random, to));
        }
        let name = crate::document::node::scalar(to);
        for (mut at, used) in self.uses() {
            if used == from {
                if at.len() > 1 && at[0] == "generators".into() && at[1] == from.into() {
                    at[1] = to.into();
                }
                edits.push(Edit::set(at, name.clone()));
            }
        }
        edits
    }

    /// Removes a generator, with its entries in a selection by index or at random.
    pub(super) fn remove_generator(&self, name: &str) -> Result<Vec<Edit>, Refusal> {
        if self.scene.generators.len() < 2 {
            return Err(Refusal::wrong("a rule has one generator at least"));
        }
        let mut edits = Vec::new();
        for (at, used) in self
            .uses()
            .into_iter()
            .rev()
            .filter(|(_, used)| used == name)
        {
            match at.as_slice() {
                [select, by_index, _]
                    if *select == "select".into() && *by_index == "by_index".into() =>
                {
                    edits.push(Edit::remove(at));
                }
                _ => {
                    let message = format!(
                        "'{used}' is used at {}: choose another generator there first",
                        super::joined(&at)
                    );
                    return Err(Refusal::wrong(message));
                }
            }
        }
        let at_random: Vec<PathStep> = ["select", "at_random", name].map(PathStep::from).into();
        if find(self.root, &at_random).is_some() {
            edits.push(Edit::remove(at_random));
        }
        edits.push(Edit::remove(vec!["generators".into(), name.into()]));
        Ok(edits)
    }

    /// Writes a selection by step: the present generator before a step, and a copy of it from there on.
    pub(super) fn later(&self, step: u32, name: &str) -> Result<Vec<Edit>, Refusal> {
        let select = self.root.get("select");
        let single = self.root.get("generator").is_some();
        let (present, edits) = match (select.map(|it| &it.value), single) {
            (None, true) => ("first".to_owned(), Vec::new()),
            (None, false) => match self.scene.generators.as_slice() {
                [one] => (one.clone(), Vec::new()),
                _ => return Err(Refusal::wrong("the rule has no selection to go on from")),
            },
            (Some(Value::Sequence(cases)), _) => {
                let number = cases.len().saturating_sub(1);
                let last = cases
                    .last()
                    .and_then(|case| case.get("use"))
                    .and_then(Node::written);
                let last = last.ok_or_else(|| Refusal::wrong("the selection has no last case"))?;
                let at = below(&["select".into()], number);
                let used = crate::document::node::scalar(last);
                let case = format!("{{when: step < {step}, use: {used}}}");
                let edits = vec![
                    Edit::set(below(&at, "use"), crate::document::node::scalar(name)),
                    Edit::insert(vec!["select".into()], number, case),
                ];
                (last.to_owned(), edits)
            }
            _ => {
                let message = "elements are selected by index or at random: from a step on, the text has to say so";
                return Err(Refusal::wrong(message));
            }
        };
        let mut all = self.copy(&present, name)?;
        if !edits.is_empty() {
            all.extend(edits);
            return Ok(all);
        }
        let [old, new] = [present.as_str(), name].map(crate::document::node::scalar);
        all.push(Edit::Add {
            to: Vec::new(),
            key: "select".into(),
            value: format!("[{{when: step < {step}, use: {old}}}, {{use: {new}}}]"),
            after: Some("generators".into()),
        });
        Ok(all)
    }
}

/// Adds the places of all keys `use`.
fn add_uses(node: &Node, at: &mut Vec<PathStep>, found: &mut Vec<(Vec<PathStep>, String)>) {
    match &node.value {
        Value::Sequence(items) => {
            for (number, item) in items.iter().enumerate() {
                at.push(number.into());
                add_uses(item, at, found);
                at.pop();
            }
        }
        Value::Mapping(entries) => {
            for (key, node) in entries {
                at.push(PathStep::Key(key.name.clone()));
                add_uses(node, at, found);
                at.pop();
                if let ("use", Some(name)) = (key.name.as_str(), node.written()) {
                    found.push((below(at, "use"), name.to_owned()));
                }
            }
        }
        _ => {}
    }
}
