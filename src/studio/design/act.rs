//! Gestures that change more than a place: each becomes edits of the text.

use std::iter::once;

use serde::Deserialize;

use crate::document::node::{Node, Value};
use crate::edit::{Edit, PathStep, find, steps};

use super::super::answer::Refusal;
use super::components::component;
use super::followers;
use super::nice;
use super::scene::{Element, Panel, Role, Scene};
use super::space::View;

/// A gesture.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "act", rename_all = "snake_case", deny_unknown_fields)]
pub(in crate::studio) enum Act {
    /// Gives an element a key: `direction`, `fertile`, `visible`, `connected`, `use`, `base_element`; none if `null`.
    Key {
        panel: String,
        element: usize,
        key: String,
        value: Option<String>,
    },
    /// Divides an element in its middle.
    Split {
        panel: String,
        element: usize,
    },
    /// Removes a point: the elements that meet there become one.
    Join {
        panel: String,
        point: usize,
    },
    /// Moves a point to a place as it is written.
    Place {
        panel: String,
        point: usize,
        x: String,
        y: String,
    },
    /// Draws a polyline in place of all points.
    Draw {
        panel: String,
        points: Vec<[String; 2]>,
    },
    /// Makes a component a part of the file.
    Own {
        panel: String,
    },
    /// Names a component of the library in place of one of the file.
    Exchange {
        panel: String,
        name: String,
    },
    /// Adds a generator: a copy of another one.
    AddGenerator {
        from: String,
        name: String,
    },
    /// Gives a generator another name, wherever it is used.
    RenameGenerator {
        from: String,
        to: String,
    },
    /// Removes a generator.
    RemoveGenerator {
        name: String,
    },
    /// From a step on, replaces elements by a copy of the present generator.
    FromHere {
        step: u32,
        name: String,
    },
    /// Writes a value at a place: a weight, a condition, limits.
    Set {
        at: String,
        value: String,
    },
    /// Removes a value.
    Remove {
        at: String,
    },
    /// Adds a copy of a map or an instance behind it, or removes one.
    AddMap {
        panel: String,
        map: usize,
    },
    RemoveMap {
        panel: String,
        map: usize,
    },
}

/// Design from which gestures make edits.
pub(super) struct Design<'a> {
    pub(super) scene: &'a Scene,
    /// The assembled document.
    pub(super) root: &'a Node,
    /// The values of the file alone.
    pub(super) raw: &'a Node,
}

/// Keys of elements with their defaults.
const DEFAULTS: [(&str, &str); 4] = [
    ("direction", "1"),
    ("fertile", "true"),
    ("visible", "true"),
    ("connected", "true"),
];

pub(super) fn below(at: &[PathStep], step: impl Into<PathStep>) -> Vec<PathStep> {
    at.iter().cloned().chain([step.into()]).collect()
}

impl Design<'_> {
    pub(super) fn panel(&self, id: &str) -> Result<&Panel, Refusal> {
        let panel = self.scene.panels.iter().find(|panel| panel.id == id);
        panel.ok_or_else(|| Refusal::wrong(format!("nothing called '{id}' is designed here")))
    }

    /// Returns a panel that can be changed.
    pub(super) fn open(&self, id: &str) -> Result<&Panel, Refusal> {
        let panel = self.panel(id)?;
        match &panel.why {
            None => Ok(panel),
            Some(why) => Err(Refusal::wrong(why.clone())),
        }
    }

    fn element<'p>(
        &self,
        panel: &'p Panel,
        element: usize,
    ) -> Result<(&'p Element, usize), Refusal> {
        let found = panel.elements.get(element);
        let found = found.and_then(|it| Some((it, it.entry?)));
        found.ok_or_else(|| {
            Refusal::wrong("this element closes the figure: it has no entry of its own")
        })
    }

    fn entry(&self, panel: &Panel, entry: usize) -> Result<&Node, Refusal> {
        let found = find(self.raw, &below(&panel.list, entry));
        found.ok_or_else(|| Refusal::wrong("there is no such entry"))
    }

    /// Returns the edits of a gesture.
    pub(super) fn edits(&self, act: &Act) -> Result<Vec<Edit>, Refusal> {
        match act {
            Act::Key {
                panel,
                element,
                key,
                value,
            } => self.key(self.open(panel)?, *element, key, value.as_deref()),
            Act::Split { panel, element } => self.split(self.open(panel)?, *element),
            Act::Join { panel, point } => self.join(self.open(panel)?, *point),
            Act::Place { panel, point, x, y } => {
                self.place(self.open(panel)?, *point, [x, y].map(String::as_str))
            }
            Act::Draw { panel, points } => self.draw(panel, points),
            Act::Own { panel } => self.own(panel),
            Act::Exchange { panel, name } => self.exchange(panel, name),
            Act::AddGenerator { from, name } => self.add_generator(from, name),
            Act::RenameGenerator { from, to } => Ok(self.rename(from, to)),
            Act::RemoveGenerator { name } => self.remove_generator(name),
            Act::FromHere { step, name } => self.later(*step, name),
            Act::Set { at, value } => Ok(vec![match find(self.root, &steps(at)) {
                Some(_) => Edit::set(steps(at), value),
                None => {
                    let mut outer = steps(at);
                    let key = outer
                        .pop()
                        .ok_or_else(|| Refusal::wrong("nothing is named"))?;
                    Edit::add(outer, key.to_string(), value)
                }
            }]),
            Act::Remove { at } => Ok(vec![Edit::remove(steps(at))]),
            Act::AddMap { panel, map } => {
                let map = self.map(panel, *map)?;
                let text = super::source_text(&map.node);
                let mut list = map.at.clone();
                let last = list.pop();
                let name = followers::copy_of(self.raw, &list, &map.name);
                let copy = match last {
                    Some(PathStep::Item(item)) => Edit::insert(list, item + 1, text),
                    _ => Edit::add(list, name.clone(), text),
                };
                let edges = followers::copied(self.raw, &map.at, &name);
                Ok(once(copy).chain(edges).collect())
            }
            Act::RemoveMap { panel, map } => {
                let at = &self.map(panel, *map)?.at;
                let edges = followers::removed(self.raw, at);
                Ok(once(Edit::remove(at.clone())).chain(edges).collect())
            }
        }
    }

    fn map(&self, panel: &str, map: usize) -> Result<&super::maps::MapHandle, Refusal> {
        let found = self.open(panel)?.maps.get(map);
        found.ok_or_else(|| Refusal::wrong("there is no such map"))
    }

    /// Writes a key of an element. A point becomes a mapping, and a mapping with nothing but an end a point again.
    fn key(
        &self,
        panel: &Panel,
        element: usize,
        key: &str,
        value: Option<&str>,
    ) -> Result<Vec<Edit>, Refusal> {
        const KEYS: [&str; 7] = [
            "direction",
            "fertile",
            "visible",
            "connected",
            "use",
            "base_element",
            "roll",
        ];
        if !KEYS.contains(&key) {
            return Err(Refusal::wrong(format!(
                "an element has no key '{key}' to set here"
            )));
        }
        let (_, number) = self.element(panel, element)?;
        let entry = self.entry(panel, number)?;
        let at = below(&panel.list, number);
        let value = value.filter(|value| !DEFAULTS.contains(&(key, *value)));
        let written = |value: &str| match key {
            "use" | "base_element" => crate::document::node::scalar(value),
            _ => value.to_owned(),
        };
        Ok(match (&entry.value, value) {
            (Value::Mapping(entries), None) if entry.get(key).is_some() => {
                let to = entry.get("to").filter(|_| entries.len() == 2);
                match to {
                    Some(to) => vec![Edit::set(at, super::source_text(to))],
                    None => vec![Edit::remove(below(&at, key))],
                }
            }
            (_, None) => Vec::new(),
            (Value::Mapping(_), Some(value)) => vec![match entry.get(key) {
                Some(_) => Edit::set(below(&at, key), written(value)),
                None => Edit::add(at, key, written(value)),
            }],
            (_, Some(value)) => {
                let to = super::source_text(entry);
                vec![Edit::set(
                    at,
                    format!("{{to: {to}, {key}: {}}}", written(value)),
                )]
            }
        })
    }

    fn split(&self, panel: &Panel, element: usize) -> Result<Vec<Edit>, Refusal> {
        let (found, number) = self.element(panel, element)?;
        let [a, b] = [found.from, found.to].map(|point| {
            let point = &panel.points[point];
            [point.x, point.y, point.depth]
        });
        let [a, b] = [a, b].map(|place| panel.names.view().point(place));
        let middle = (a + b) / 2.0;
        let middle = panel.written(middle.to_array().map(|it| nice::written(it, true, 1e-9)));
        let entry = self.entry(panel, number)?;
        let Value::Mapping(entries) = &entry.value else {
            return Ok(vec![Edit::insert(panel.list.clone(), number, middle)]);
        };
        if entry.get("to").is_none() {
            return Err(Refusal::wrong("a face is divided in the text"));
        }
        let copy: Vec<_> = entries
            .iter()
            .map(|(key, node)| match key.name.as_str() {
                "to" => format!("to: {middle}"),
                name => format!("{name}: {}", super::source_text(node)),
            })
            .collect();
        let mut edits = Vec::new();
        if entry.get("from").is_some() {
            let from = below(&below(&panel.list, number), "from");
            edits.push(Edit::set(from, middle.clone()));
        }
        let copy = format!("{{{}}}", copy.join(", "));
        edits.push(Edit::insert(panel.list.clone(), number, copy));
        Ok(edits)
    }

    fn join(&self, panel: &Panel, point: usize) -> Result<Vec<Edit>, Refusal> {
        let ends = |it: &&Element| it.to == point && it.entry.is_some();
        let all: Vec<_> = panel.elements.iter().filter(ends).collect();
        if panel.role == Role::Maps && point < panel.points.len() {
            return Ok(vec![Edit::remove(below(&panel.list, point))]);
        }
        let Value::Sequence(entries) = &find(self.root, &panel.list)
            .ok_or_else(|| Refusal::wrong("there is no such list"))?
            .value
        else {
            return Err(Refusal::wrong("this is no list"));
        };
        if panel.points.get(point).is_some_and(|it| it.pinned) {
            return Err(Refusal::wrong(
                "an end of a generator joins its neighbours: it stays",
            ));
        }
        if entries.len() <= 2 {
            return Err(Refusal::wrong("a figure has one element at least"));
        }
        let mut edits = Vec::new();
        // From the end, so that the numbers before stay.
        for element in all.iter().rev() {
            let number = element.entry.unwrap_or_default();
            let next = entries.get(number + 1).and_then(|entry| entry.get("from"));
            let starts_here = next.is_some()
                && panel
                    .elements
                    .iter()
                    .any(|it| it.entry == Some(number + 1) && it.from == point);
            if starts_here {
                let from = &panel.points[element.from].whole;
                let at = below(&below(&panel.list, number + 1), "from");
                edits.push(Edit::set(at, format!("[{from}]")));
            }
            edits.push(Edit::remove(below(&panel.list, number)));
        }
        let starts = panel.elements.first().is_some_and(|it| it.from == point);
        if starts && all.is_empty() {
            if let Some(to) = entries.get(1).and_then(|entry| entry.get("to")) {
                edits.push(Edit::set(below(&panel.list, 1), super::source_text(to)));
            }
            edits.push(Edit::remove(below(&panel.list, 0)));
        }
        match edits.is_empty() {
            true => Err(Refusal::wrong("no element ends there")),
            false => Ok(edits),
        }
    }

    /// Writes the coordinates of a point wherever it is written.
    pub(super) fn place(
        &self,
        panel: &Panel,
        point: usize,
        text: [&str; 2],
    ) -> Result<Vec<Edit>, Refusal> {
        let found = panel
            .points
            .get(point)
            .ok_or_else(|| Refusal::wrong("there is no such point"))?;
        let mut edits = Vec::new();
        for at in &found.written {
            match find(self.root, at).map(|node| &node.value) {
                Some(Value::Sequence(parts)) => {
                    let axes = panel.names.view().axes();
                    let changed = [0, 1]
                        .into_iter()
                        .filter(|side| found.text[*side] != text[*side])
                        .map(|side| (axes[side], text[side]));
                    for (axis, text) in changed {
                        edits.push(match axis < parts.len() {
                            true => Edit::set(below(at, axis), text),
                            // A point of two numbers lies in z = 0.
                            false => Edit::insert(at.clone(), axis, text),
                        });
                    }
                }
                _ => edits.push(Edit::set(at.clone(), format!("[{}, {}]", text[0], text[1]))),
            }
        }
        Ok(edits)
    }

    /// Replaces all points by a polyline. That of a generator runs from [0, 0] to [1, 0]; one that returns to its start
    /// closes an initiator or a base element.
    fn draw(&self, panel: &str, points: &[[String; 2]]) -> Result<Vec<Edit>, Refusal> {
        let panel = self.panel(panel)?;
        let mut points = points.to_vec();
        let ends = [["0", "0"], ["1", "0"]].map(|it| it.map(str::to_owned));
        if panel.role == Role::Generator {
            if points.first() != Some(&ends[0]) {
                points.insert(0, ends[0].clone());
            }
            if points.last() != Some(&ends[1]) {
                points.push(ends[1].clone());
            }
        }
        let closes =
            panel.role != Role::Generator && points.len() > 3 && points.first() == points.last();
        if closes {
            points.pop();
        }
        if points.len() < 2 {
            return Err(Refusal::wrong("a polyline has two points at least"));
        }
        let view = panel.names.view();
        if view == View::Left && panel.role == Role::Generator {
            let message =
                "a generator runs along the x axis: it is drawn in one of the other views";
            return Err(Refusal::wrong(message));
        }
        let written = |[x, y]: [String; 2]| {
            let mut text = ["0"; 3].map(str::to_owned);
            let [right, up, _] = view.axes();
            (text[right], text[up]) = (x, y);
            panel.written(text)
        };
        let all: Vec<_> = points.into_iter().map(written).collect();
        let list = format!("[{}]", all.join(", "));
        let whole = match panel.list.first() {
            Some(PathStep::Key(key)) if key == "initiator" => {
                Some(("elements", [key.as_str().into()]))
            }
            Some(PathStep::Key(key)) if key == "base_element" => {
                Some(("points", [key.as_str().into()]))
            }
            _ => None,
        };
        Ok(vec![match whole {
            Some((key, at)) if closes || panel.closed || panel.why.is_some() || key == "points" => {
                let closed = if closes { "closed: true, " } else { "" };
                Edit::set(at.into(), format!("{{{closed}{key}: {list}}}"))
            }
            _ if panel.why.is_some() => Edit::set(
                panel
                    .list
                    .iter()
                    .filter(|it| **it != "elements".into())
                    .cloned()
                    .collect(),
                list,
            ),
            _ => Edit::set(panel.list.clone(), list),
        }])
    }

    /// Writes a component that is named into the file.
    fn own(&self, panel: &str) -> Result<Vec<Edit>, Refusal> {
        let panel = self.panel(panel)?;
        let at = component(panel);
        let node =
            find(self.root, &at).ok_or_else(|| Refusal::wrong("there is no such component"))?;
        let text = plain(node);
        Ok(vec![Edit::set(at, text)])
    }
}

/// Returns whether a component is written out, and no name.
pub(super) fn is_written(node: &&Node) -> bool {
    !matches!(node.value, Value::Text(_))
}

/// Returns a value in flow style, with its numbers as they are written.
pub(super) fn plain(node: &Node) -> String {
    crate::edit::flow(node)
}
