//! Design by hand: initiators, generators, base elements, maps and instances as points that a hand drags.
//!
//! This is the first state of Kaandorp's system (CWI CS-R8706, 1987, section 2.3). Every gesture becomes
//! [edits](crate::edit) of the text, whose comments and layout stay; a gesture that would lead to a text with mistakes is
//! refused.
//!
//! | module | content |
//! |---|---|
//! | `scene` | points and elements, with the places where they are written |
//! | `maps` | maps of systems, and instances of structures, as parallelograms |
//! | `instances` | transforms of instances, in the order of the file |
//! | `limits` | limits of random functions |
//! | `space` | views of space along an axis, and maps of space in them |
//! | `names` | values of numbers, and what they depend on |
//! | `hit` | handles under a pointer |
//! | `drag` | a hand that drags: preview, end, and cancelling |
//! | `snap`, `nice` | where a point comes to rest, and how it is written |
//! | `solve` | parameters for which a point lies where it is dragged |
//! | `act` | other gestures |
//! | `components` | components that are exchanged and saved |

mod act;
mod builder;
mod components;
mod drag;
mod followers;
mod generators;
mod hit;
mod instances;
mod limits;
mod maps;
mod names;
mod nice;
mod scene;
mod snap;
mod solve;
mod space;

use serde::Serialize;

use crate::document::node::Node;
use crate::edit::{Edit, PathStep, edit};
use crate::kind::Kind;

use super::answer::Refusal;
use super::good::{Checked, Good, Reader};
use super::look::Look;
pub(super) use act::Act;
pub(super) use components::NewComponent;
pub(super) use drag::{Pointer, pointer};
pub(super) use names::Names;
pub(super) use scene::Scene;
pub(super) use space::View;

/// State of the hand that designs.
#[derive(Clone, Debug, Default)]
pub(super) struct Hand {
    drag: Option<drag::Drag>,
    /// Effect of the last movement, in words.
    pub(super) badge: Option<String>,
    pub(super) selected: Option<Selected>,
    /// View of figures in space.
    pub(super) view: View,
}

/// Selected handle.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct Selected {
    panel: String,
    /// `point`, `element`, `map` or `limit`.
    what: &'static str,
    index: usize,
}

impl Hand {
    /// Lets go of what is dragged.
    pub(super) fn let_go(&mut self) {
        self.drag = None;
        self.badge = None;
    }

    /// Returns what the page shows of it.
    pub(super) fn state(&self) -> serde_json::Value {
        serde_json::json!({ "badge": self.badge, "selected": self.selected, "drags": self.drag.is_some() })
    }
}

/// Returns the handles of a text.
pub(super) fn scene(good: &Good, look: &Look, view: View) -> Scene {
    let names = Names::of(&good.parameters, &look.set);
    let names = match good.is_in_space {
        true => names.seen(view),
        false => names,
    };
    let raw = raw(good).unwrap_or_else(|_| Node::clone(good.node()));
    let builder = builder::Builder::new(&good.source, good.node(), &raw, names);
    let why = match good.kind {
        Kind::Rule => return builder.rule(),
        Kind::Ifs => return builder.system(),
        Kind::Instancing => return builder.structure(),
        _ => "files of this kind are designed in their text",
    };
    Scene {
        why: Some(why.into()),
        ..Scene::default()
    }
}

/// Returns the text after a gesture.
pub(super) fn acted(
    reader: &Reader,
    (good, look, view): (&Good, &Look, View),
    text: &str,
    act: &Act,
) -> Result<Checked, Refusal> {
    let edits = with_design(good, look, view, |design| design.edits(act))?;
    edited(reader, text, &edits)
}

/// Returns the file of a component, with a title. It depends on nothing else in the rule.
pub(super) fn component(
    reader: &Reader,
    good: &Good,
    look: &Look,
    panel: &str,
    title: &str,
) -> Result<NewComponent, Refusal> {
    if good.is_in_space {
        let message = "components in space are saved by hand: copy them from the text";
        return Err(Refusal::wrong(message));
    }
    let new = with_design(good, look, View::Front, |design| design.saved(panel, title))?;
    checked(reader, new.rule.clone())?;
    Ok(new)
}

/// Calls `act` with what is designed in a file.
fn with_design<T>(
    good: &Good,
    look: &Look,
    view: View,
    act: impl FnOnce(&act::Design<'_>) -> Result<T, Refusal>,
) -> Result<T, Refusal> {
    act(&act::Design {
        scene: &scene(good, look, view),
        root: good.node(),
        raw: &raw(good)?,
    })
}

/// Returns the values of the file alone.
fn raw(good: &Good) -> Result<Node, Refusal> {
    Node::parse(&good.source).map_err(|_| Refusal::wrong("the text has mistakes"))
}

/// Returns an edited text, which has no mistakes.
fn edited(reader: &Reader, text: &str, edits: &[Edit]) -> Result<Checked, Refusal> {
    let new = edit(text, edits).map_err(|error| Refusal::wrong(error.to_string()))?;
    checked(reader, new)
}

/// Returns a text that has no mistakes.
fn checked(reader: &Reader, text: String) -> Result<Checked, Refusal> {
    let checked = reader.check(text.into());
    if checked.good.is_none() {
        let first = checked.problems.iter().find(|it| it.is_error());
        let message = first.map_or_else(
            || "the text would have a mistake".into(),
            |it| it.message.clone(),
        );
        return Err(Refusal::wrong(message));
    }
    Ok(checked)
}

/// Returns a value as it is written, on one line.
fn source_text(node: &Node) -> String {
    let text = node.place.text();
    let is_flow = text.starts_with(['[', '{']) && !text.contains(['\n', '#']);
    match node.value {
        _ if is_flow => text.to_owned(),
        _ => crate::edit::flow(node),
    }
}

fn joined(at: &[PathStep]) -> String {
    let all: Vec<_> = at.iter().map(PathStep::to_string).collect();
    all.join("/")
}
