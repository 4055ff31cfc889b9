//! Handles of a design: points and elements, with the places in the text that they edit.

use std::sync::Arc;

use serde::Serialize;

use crate::diagnostic::Source;
use crate::document::node::{Node, Value};
use crate::edit::{Step, find};

use super::maps;
use super::names::{Basis, Names};

/// Largest number of handles of a panel.
pub(super) const MOST: usize = 300;

/// Everything that is designed by hand.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Scene {
    pub(super) panels: Vec<Panel>,
    /// Names of generators, in the order of the file.
    pub(super) generators: Vec<String>,
    /// Selection, as it is written: `by_index`, `at_random` or cases.
    pub(super) select: Option<serde_json::Value>,
    /// Reason why nothing is designed here.
    pub(super) why: Option<String>,
    #[serde(skip)]
    pub(super) names: Names,
}

/// Content of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Role {
    Initiator,
    Generator,
    BaseElement,
    Maps,
}

/// A list of points, or of maps.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Panel {
    pub(super) id: String,
    pub(super) title: String,
    pub(super) role: Role,
    /// Reason why nothing in it can be changed: it is written elsewhere, or has too many handles.
    pub(super) why: Option<String>,
    pub(super) closed: bool,
    pub(super) points: Vec<Point>,
    pub(super) elements: Vec<Element>,
    pub(super) maps: Vec<maps::MapHandle>,
    /// Limits of random functions: polylines.
    pub(super) ghosts: Vec<Vec<[f64; 2]>>,
    /// Lower left and upper right corner.
    pub(super) window: [f64; 4],
    #[serde(skip)]
    pub(super) list: Vec<Step>,
    #[serde(skip)]
    pub(super) names: Names,
}

/// A point.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Point {
    pub(super) x: f64,
    pub(super) y: f64,
    /// As written.
    pub(super) text: [String; 2],
    pub(super) basis: Basis,
    /// Whether it is an end of a generator.
    pub(super) pinned: bool,
    /// The places where it is written.
    #[serde(skip)]
    pub(super) written: Vec<Vec<Step>>,
}

/// An element.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Element {
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) direction: u8,
    pub(super) fertile: bool,
    pub(super) visible: bool,
    pub(super) connected: bool,
    #[serde(rename = "use")]
    pub(super) generator: Option<String>,
    pub(super) base_element: Option<String>,
    /// Its entry in the list; the last element of a closed list has none.
    pub(super) entry: Option<usize>,
}

/// Builds a scene from an assembled document of the plane.
pub(super) struct Builder<'a> {
    source: &'a Arc<Source>,
    root: &'a Node,
    /// The values of the file alone.
    raw: &'a Node,
    names: Names,
    scene: Scene,
}

fn below(at: &[Step], more: &[Step]) -> Vec<Step> {
    at.iter().chain(more).cloned().collect()
}

impl<'a> Builder<'a> {
    pub(super) fn new(
        source: &'a Arc<Source>,
        root: &'a Node,
        raw: &'a Node,
        names: Names,
    ) -> Self {
        let scene = Scene {
            names: names.clone(),
            ..Scene::default()
        };
        Self {
            source,
            root,
            raw,
            names,
            scene,
        }
    }

    /// Shows a production rule.
    pub(super) fn rule(mut self) -> Scene {
        self.component("initiator", "Initiator", Role::Initiator);
        if find(self.root, &["generator".into()]).is_some() {
            self.generator(&["generator".into()], "Generator");
        }
        if let Some(Value::Mapping(entries)) = self.root.get("generators").map(|it| &it.value) {
            for (key, _) in entries {
                let at = ["generators".into(), Step::Key(key.name.clone())];
                self.scene.generators.push(key.name.clone());
                self.generator(&at, &key.name);
            }
        }
        self.component("base_element", "Base element", Role::BaseElement);
        self.scene.select = self.root.get("select").map(json);
        self.scene
    }

    /// Shows an iterated function system.
    pub(super) fn system(mut self) -> Scene {
        let vertices = ["vertices", "points"].map(Step::from);
        if let Some(list) = find(self.root, &vertices) {
            let mut panel = self.panel(&vertices, "Vertices", Role::Maps, list);
            panel.id = "vertices".into();
            if let Value::Sequence(points) = &list.value {
                for (number, node) in points.iter().enumerate().take(MOST) {
                    panel.add(node, below(&vertices, &[number.into()]));
                }
            }
            let points = panel.points.iter().map(|point| [point.x, point.y]);
            panel.window = window(points.chain([[0.0, 0.0], [1.0, 1.0]]));
            self.scene.panels.push(panel);
        }
        self.maps();
        self.condensation();
        if self.scene.panels.is_empty() {
            self.scene.why = Some(
                "this system has neither maps nor vertices: it is designed in its text".into(),
            );
        }
        self.scene
    }

    /// Shows condensation sets that are lines or polygons.
    fn condensation(&mut self) {
        let Some(Value::Sequence(sets)) = self.root.get("condensation").map(|it| &it.value) else {
            return;
        };
        for (number, set) in sets.iter().enumerate() {
            for form in ["segment", "polyline", "polygon"] {
                if let Some(list) = set.get(form) {
                    let at = ["condensation".into(), number.into(), form.into()];
                    let title = format!("Condensation set {}: {form}", number + 1);
                    let mut panel = self.panel(&at, &title, Role::BaseElement, list);
                    self.fill(&mut panel, list, form == "polygon");
                    self.scene.panels.push(panel);
                }
            }
        }
    }

    fn maps(&mut self) {
        let at = [Step::from("maps")];
        let Some(node) = self.root.get("maps") else {
            return;
        };
        let mut panel = self.panel(&at, "Maps", Role::Maps, node);
        panel.maps = maps::handles(node, &at, &self.names);
        if panel.maps.len() > MOST / 4 {
            panel.why = Some(format!("{} maps are too many to drag", panel.maps.len()));
        }
        let corners = panel.maps.iter().flat_map(maps::MapHandle::corners);
        panel.window = window(corners.chain([[0.0, 0.0], [1.0, 1.0]]));
        self.scene.panels.push(panel);
    }

    fn panel(&self, at: &[Step], title: &str, role: Role, node: &Node) -> Panel {
        let is_own = Arc::ptr_eq(node.place.source(), self.source);
        let file = node.place.source().name();
        let id: Vec<_> = at.iter().map(Step::to_string).collect();
        Panel {
            id: id.join("/"),
            title: title.to_owned(),
            role,
            why: (!is_own).then(|| {
                format!("it is written in {file}: make it a part of this file to change it")
            }),
            closed: false,
            points: Vec::new(),
            elements: Vec::new(),
            maps: Vec::new(),
            ghosts: Vec::new(),
            window: [0.0, 0.0, 1.0, 1.0],
            list: at.to_vec(),
            names: self.names.clone(),
        }
    }

    /// Shows an initiator or a base element.
    fn component(&mut self, key: &str, title: &str, role: Role) {
        let at = [Step::from(key)];
        let Some(node) = self.root.get(key) else {
            return;
        };
        let inner = match role {
            Role::BaseElement => "points",
            _ => "elements",
        };
        let closed = matches!(
            node.get("closed").map(|it| &it.value),
            Some(Value::Bool(true))
        );
        let mut panel = match node.get(inner) {
            Some(list) => {
                let mut panel = self.panel(&below(&at, &[inner.into()]), title, role, list);
                self.fill(&mut panel, list, closed);
                panel
            }
            None => {
                let mut panel = self.panel(&at, title, role, node);
                self.fill(&mut panel, node, closed);
                panel
            }
        };
        panel.id = key.to_owned();
        self.scene.panels.push(panel);
    }

    /// Shows a generator: each of its parts.
    fn generator(&mut self, at: &[Step], title: &str) {
        let Some(node) = find(self.root, at) else {
            return;
        };
        let random = node.get("random");
        let lists: Vec<(Vec<Step>, String, bool)> = match node.get("parts").map(|it| &it.value) {
            Some(Value::Sequence(parts)) => parts
                .iter()
                .enumerate()
                .map(|(number, part)| {
                    let closed = matches!(
                        part.get("closed").map(|it| &it.value),
                        Some(Value::Bool(true))
                    );
                    let seeds = matches!(
                        part.get("seeds").map(|it| &it.value),
                        Some(Value::Bool(true))
                    );
                    let what = if seeds { "seed" } else { "part" };
                    let steps = ["parts".into(), number.into(), "elements".into()];
                    (
                        below(at, &steps),
                        format!("{title}, {what} {}", number + 1),
                        closed,
                    )
                })
                .collect(),
            _ if node.get("elements").is_some() => {
                vec![(below(at, &["elements".into()]), title.into(), false)]
            }
            _ => vec![(at.to_vec(), title.into(), false)],
        };
        for (list, title, closed) in lists {
            let Some(elements) = find(self.root, &list) else {
                continue;
            };
            let mut panel = self.panel(&list, &title, Role::Generator, elements);
            panel.names = self.names.with_drawn(random, 0.5);
            self.fill(&mut panel, elements, closed);
            if random.is_some() {
                panel.ghosts = self.ghosts(&list, elements, node, closed);
            }
            self.scene.panels.push(panel);
        }
    }

    /// Returns the figures at the limits of random functions.
    fn ghosts(
        &self,
        at: &[Step],
        list: &Node,
        generator: &Node,
        closed: bool,
    ) -> Vec<Vec<[f64; 2]>> {
        let limits = [0.0, 1.0].map(|part| {
            let mut panel = self.panel(at, "", Role::Generator, list);
            panel.names = self.names.with_drawn(generator.get("random"), part);
            self.fill(&mut panel, list, closed);
            moved(&mut panel, generator);
            let ends = panel.elements.iter().map(|element| element.to);
            let first = panel.elements.first().map(|element| element.from);
            let line = first.into_iter().chain(ends);
            line.map(|point| [panel.points[point].x, panel.points[point].y])
                .collect::<Vec<_>>()
        });
        limits.into()
    }

    /// Adds the points and elements of a list.
    fn fill(&self, panel: &mut Panel, list: &Node, closed: bool) {
        panel.closed = closed;
        let Value::Sequence(entries) = &list.value else {
            panel.why = Some("it is no list of points: it is changed in the text".into());
            return;
        };
        if entries.len() > MOST {
            panel.why = Some(format!("{} points are too many to drag", entries.len()));
            return;
        }
        let mut end: Option<usize> = None;
        for (number, entry) in entries.iter().enumerate() {
            let at = below(&panel.list, &[number.into()]);
            let (to, from) = match &entry.value {
                Value::Mapping(_) => (entry.get("to"), entry.get("from")),
                _ => (Some(entry), None),
            };
            let to_at = match &entry.value {
                Value::Mapping(_) => below(&at, &["to".into()]),
                _ => at.clone(),
            };
            let from = from
                .and_then(|node| panel.add(node, below(&at, &["from".into()])))
                .or(end);
            let Some(to) = to.and_then(|node| panel.add(node, to_at)) else {
                panel.why = Some("it has faces or other forms: it is changed in the text".into());
                return;
            };
            if let Some(from) = from {
                let raw = find(self.raw, &at).unwrap_or(entry);
                panel.elements.push(element(raw, from, to, number));
            }
            end = Some(to);
        }
        if let (true, Some(last), Some(first)) = (closed, end, panel.elements.first()) {
            let from = first.from;
            let mut more = panel.elements[0].clone();
            (more.from, more.to, more.entry) = (last, from, None);
            (more.direction, more.fertile, more.visible) = (1, true, true);
            panel.elements.push(more);
        }
        let is_set = panel.list.first() == Some(&"condensation".into());
        if panel.role != Role::Initiator && !is_set {
            let ends = [[0.0, 0.0], [1.0, 0.0]];
            for point in &mut panel.points {
                point.pinned = point.basis == Basis::Numbers && ends.contains(&[point.x, point.y]);
            }
        }
        let points = panel.points.iter().map(|point| [point.x, point.y]);
        panel.window = window(points.chain([[0.0, 0.0], [1.0, 0.0]]));
    }
}

impl Panel {
    /// Adds a point, or a place where a known one is written.
    fn add(&mut self, node: &Node, at: Vec<Step>) -> Option<usize> {
        let ([x, y], basis) = self.names.point(node)?;
        let text = match &node.value {
            Value::Sequence(parts) => {
                let text =
                    |index: usize| parts.get(index).and_then(Node::written).unwrap_or_default();
                [text(0), text(1)].map(str::to_owned)
            }
            _ => [node.written()?.to_owned(), String::new()],
        };
        let known = self.points.iter().position(|point| {
            point.text == text
                || (basis == Basis::Numbers && point.basis == basis && [point.x, point.y] == [x, y])
        });
        if let Some(known) = known {
            self.points[known].written.push(at);
            return Some(known);
        }
        self.points.push(Point {
            x,
            y,
            text,
            basis,
            pinned: false,
            written: vec![at],
        });
        Some(self.points.len() - 1)
    }

    /// Adds a point that is drawn, where it can be read.
    pub(super) fn draw(&mut self, text: &[String; 2]) {
        let parts = [0, 1].map(|axis| crate::cli::family::value(&text[axis]).ok());
        if let [Some(x), Some(y)] = parts {
            self.points.push(Point {
                x,
                y,
                text: text.clone(),
                basis: Basis::Numbers,
                pinned: false,
                written: Vec::new(),
            });
        }
    }

    pub(super) fn place(&self, point: usize) -> [f64; 2] {
        [self.points[point].x, self.points[point].y]
    }
}

fn element(entry: &Node, from: usize, to: usize, number: usize) -> Element {
    let flag = |key: &str| !matches!(entry.get(key).map(|it| &it.value), Some(Value::Bool(false)));
    let text = |key: &str| entry.get(key).and_then(Node::written).map(str::to_owned);
    let direction = text("direction")
        .and_then(|it| it.parse().ok())
        .unwrap_or(1);
    Element {
        from,
        to,
        direction,
        fertile: flag("fertile"),
        visible: flag("visible"),
        connected: flag("connected"),
        generator: text("use"),
        base_element: { entry.get("base_element") }
            .map(|node| node.written().unwrap_or("its own").to_owned()),
        entry: Some(number),
    }
}

/// Moves the inner points of a panel by the moves of a generator.
fn moved(panel: &mut Panel, generator: &Node) {
    let Some(node) = generator.get("move") else {
        return;
    };
    let moves = match &node.value {
        Value::Sequence(moves) => moves.as_slice(),
        _ => std::slice::from_ref(node),
    };
    for one in moves {
        let number = |key: &str| {
            one.get(key)
                .and_then(|node| panel.names.value(node))
                .map(|it| it.0)
        };
        let point = |key: &str| {
            one.get(key)
                .and_then(|node| panel.names.point(node))
                .map(|it| it.0)
        };
        let (angle, scale) = (
            number("rotate").unwrap_or(0.0),
            number("scale").unwrap_or(1.0),
        );
        let (about, shift) = (
            point("about").unwrap_or_default(),
            point("shift").unwrap_or_default(),
        );
        let (sin, cos) = libm::sincos(angle.to_radians());
        let chosen: Option<Vec<usize>> = match one.get("points").map(|it| &it.value) {
            Some(Value::Sequence(numbers)) => Some(
                numbers
                    .iter()
                    .filter_map(|node| node.written()?.parse().ok())
                    .collect(),
            ),
            _ => None,
        };
        let is_all = matches!(one.get("points").map(|it| &it.value), Some(Value::Text(_)));
        let last = panel.points.len().saturating_sub(1);
        for (number, point) in panel.points.iter_mut().enumerate() {
            let is_moved = match &chosen {
                Some(chosen) => chosen.contains(&number),
                None => is_all || (number != 0 && number != last),
            };
            if is_moved {
                let (x, y) = (scale * (point.x - about[0]), scale * (point.y - about[1]));
                point.x = about[0] + cos * x - sin * y + shift[0];
                point.y = about[1] + sin * x + cos * y + shift[1];
            }
        }
    }
}

/// Returns the box of points, with a margin.
fn window(points: impl Iterator<Item = [f64; 2]>) -> [f64; 4] {
    let all: Vec<_> = points
        .filter(|it| it.iter().all(|it| it.is_finite()))
        .collect();
    let low = |axis: usize| all.iter().map(|it| it[axis]).fold(f64::INFINITY, f64::min);
    let high = |axis: usize| {
        all.iter()
            .map(|it| it[axis])
            .fold(f64::NEG_INFINITY, f64::max)
    };
    let size = (high(0) - low(0)).max(high(1) - low(1)).max(0.1);
    let margin = 0.16 * size;
    [
        low(0) - margin,
        low(1) - margin,
        high(0) + margin,
        high(1) + margin,
    ]
}

/// Returns a value as the page has it.
fn json(node: &Node) -> serde_json::Value {
    match &node.value {
        Value::Sequence(items) => items.iter().map(json).collect(),
        Value::Mapping(entries) => {
            let entries = entries.iter();
            serde_json::Value::Object(
                entries
                    .map(|(key, node)| (key.name.clone(), json(node)))
                    .collect(),
            )
        }
        _ => node.written().unwrap_or_default().into(),
    }
}
