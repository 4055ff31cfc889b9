//! Components of rules: exchanged with those of the library, and saved there.

use crate::catalogue::Shelf;
use crate::document::node::{Node, Value, scalar};
use crate::edit::{Edit, PathStep, find};

use super::super::answer::Refusal;
use super::act::{Design, plain};
use super::scene::{Panel, Role};

/// A component to be saved.
pub(in crate::studio) struct NewComponent {
    pub(in crate::studio) shelf: Shelf,
    /// Text of its file.
    pub(in crate::studio) text: String,
    /// Text of a rule that has nothing but the component.
    pub(in crate::studio) rule: String,
}

/// Returns where the component is written whose points a panel shows.
pub(super) fn component(panel: &Panel) -> Vec<PathStep> {
    // One of several has a name of its own.
    let named = ["generators", "objects"].map(PathStep::from);
    let steps = match panel.list.first() {
        Some(key) if named.contains(key) => 2,
        _ => 1,
    };
    panel.list.iter().take(steps).cloned().collect()
}

impl Design<'_> {
    /// Names a component of the library in place of one of the file. A rule need not have a base element.
    pub(super) fn exchange(&self, panel: &str, name: &str) -> Result<Vec<Edit>, Refusal> {
        match self.panel(panel) {
            Ok(panel) => Ok(vec![Edit::set(component(panel), scalar(name))]),
            Err(_) if panel == "base_element" => {
                Ok(vec![Edit::add(Vec::new(), panel, scalar(name))])
            }
            Err(refusal) => Err(refusal),
        }
    }

    /// Returns the file of a component, with a title.
    pub(super) fn saved(&self, panel: &str, title: &str) -> Result<NewComponent, Refusal> {
        let panel = self.open(panel)?;
        let (shelf, points) = match panel.role {
            Role::Initiator => (Shelf::Initiators, "elements"),
            Role::Generator => (Shelf::Generators, "elements"),
            Role::BaseElement if panel.id == "base_element" => (Shelf::BaseElements, "points"),
            _ => return Err(Refusal::wrong("this is no component of a rule")),
        };
        let node = find(self.root, &component(panel));
        let node = node.ok_or_else(|| Refusal::wrong("there is no such component"))?;
        let mut text = format!("{}\ntitle: {}\n", shelf.modeline(), scalar(title));
        match &node.value {
            Value::Mapping(entries) => {
                let described = ["title", "about", "source", "tags"];
                let own = entries
                    .iter()
                    .filter(|(key, _)| !described.contains(&key.name.as_str()));
                own.for_each(|(key, node)| text += &block(&key.name, node));
            }
            _ => text += &block(points, node),
        }
        let line = |points: &str| format!("[[0, 0], {points}[1, 0]]");
        let [mut initiator, mut generator] = [line(""), line("[1/2, 0], ")];
        let mut more = String::new();
        match shelf {
            Shelf::Initiators => initiator = plain(node),
            Shelf::Generators => generator = plain(node),
            _ => more = format!("base_element: {}\n", plain(node)),
        }
        let rule = format!("initiator: {initiator}\ngenerator: {generator}\n{more}");
        Ok(NewComponent { shelf, text, rule })
    }
}

/// Returns an entry of a mapping, a list with an item on each line.
fn block(key: &str, node: &Node) -> String {
    match &node.value {
        Value::Sequence(items) if !items.is_empty() => {
            let items = items.iter().map(|item| format!("  - {}\n", plain(item)));
            format!("{key}:\n{}", items.collect::<String>())
        }
        _ => format!("{key}: {}\n", plain(node)),
    }
}
