//! Scenes of designs, from the values of a file.

mod structure;

use std::sync::Arc;

use crate::diagnostic::Source;
use crate::document::node::{Node, Value};
use crate::edit::{PathStep, find};

use super::limits::Functions;
use super::maps::{self, MapHandle};
use super::names::Names;
use super::scene::{MOST, Panel, Role, Scene, element, json, moved, window};

/// Builds a scene from an assembled document of the plane.
pub(super) struct Builder<'a> {
    source: &'a Arc<Source>,
    root: &'a Node,
    /// The values of the file alone.
    raw: &'a Node,
    names: Names,
    scene: Scene,
}

fn below(at: &[PathStep], more: &[PathStep]) -> Vec<PathStep> {
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
            view: names.is_in_space().then(|| names.view()),
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
                let at = ["generators".into(), PathStep::Key(key.name.clone())];
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
        let vertices = ["vertices", "points"].map(PathStep::from);
        if let Some(list) = find(self.root, &vertices) {
            let mut panel = self.panel(&vertices, "Vertices", Role::Maps, list);
            panel.id = "vertices".into();
            let shrink = find(self.root, &["vertices", "shrink"].map(PathStep::from));
            panel.shrink = shrink.and_then(Node::written).map(str::to_owned);
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
        self.scene.edges = self.root.get("edges").map(json);
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
            let at = ["condensation".into(), number.into()];
            self.shape(&at, &format!("Condensation set {}", number + 1), set);
        }
    }

    /// Shows a set that is a line or a polygon; returns whether it is one.
    fn shape(&mut self, at: &[PathStep], title: &str, set: &Node) -> bool {
        let forms = ["segment", "polyline", "polygon"];
        let found = forms.iter().find_map(|form| Some((*form, set.get(form)?)));
        let Some((form, list)) = found else {
            return false;
        };
        let at = below(at, &[form.into()]);
        let mut panel = self.panel(&at, &format!("{title}: {form}"), Role::BaseElement, list);
        self.fill(&mut panel, list, form == "polygon");
        self.scene.panels.push(panel);
        true
    }

    fn maps(&mut self) {
        let at = [PathStep::from("maps")];
        let Some(node) = self.root.get("maps") else {
            return;
        };
        let handles = maps::handles(node, &at, &self.names);
        self.parallelograms(&at, "Maps", node, handles);
    }

    /// Shows maps or instances as parallelograms.
    fn parallelograms(&mut self, at: &[PathStep], title: &str, node: &Node, maps: Vec<MapHandle>) {
        let mut panel = self.panel(at, title, Role::Maps, node);
        if maps.len() > MOST / 4 {
            panel.why = Some(format!("{} maps are too many to drag", maps.len()));
        }
        let corners = maps.iter().flat_map(MapHandle::corners);
        panel.window = window(corners.chain([[0.0, 0.0], [1.0, 1.0]]));
        panel.maps = maps;
        self.scene.panels.push(panel);
    }

    fn panel(&self, at: &[PathStep], title: &str, role: Role, node: &Node) -> Panel {
        let is_own = Arc::ptr_eq(node.place.source(), self.source);
        let file = node.place.source().name();
        let id: Vec<_> = at.iter().map(PathStep::to_string).collect();
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
            faces: Vec::new(),
            limits: Vec::new(),
            shrink: None,
            functions: None,
            window: [0.0, 0.0, 1.0, 1.0],
            list: at.to_vec(),
            names: self.names.clone(),
        }
    }

    /// Shows an initiator or a base element.
    fn component(&mut self, key: &str, title: &str, role: Role) {
        let at = [PathStep::from(key)];
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
    fn generator(&mut self, at: &[PathStep], title: &str) {
        let Some(node) = find(self.root, at) else {
            return;
        };
        let random = node.get("random");
        let lists: Vec<(Vec<PathStep>, String, bool)> = match node.get("parts").map(|it| &it.value)
        {
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
            if let Some(random) = random {
                let moves = node.get("move").is_some();
                if !(moves && self.names.is_in_space()) {
                    panel.ghosts = self.ghosts(&list, elements, node, closed);
                }
                let functions = Functions {
                    node: random.clone(),
                    at: below(at, &["random".into()]),
                };
                // Points that are moved lie elsewhere.
                if !moves {
                    panel.limits = functions.limits(&panel, &self.names, self.root);
                }
                panel.functions = Some(functions);
            }
            self.scene.panels.push(panel);
        }
    }

    /// Returns the figures at the limits of random functions.
    fn ghosts(
        &self,
        at: &[PathStep],
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

    /// Adds the points of a face or of corners in space, of which the first side is an element.
    fn face(&self, panel: &mut Panel, entry: &Node, at: &[PathStep]) -> Option<Vec<usize>> {
        let keys = ["face", "corners"].into_iter();
        let (key, face) = { keys }.find_map(|key| Some((key, entry.get(key)?)))?;
        let Value::Sequence(points) = &face.value else {
            return None;
        };
        let points = points.iter().enumerate();
        let found: Option<Vec<usize>> = points
            .map(|(number, node)| panel.add(node, below(at, &[key.into(), number.into()])))
            .collect();
        found.filter(|found| found.len() > 2)
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
            if let Some(found) = self.face(panel, entry, &at) {
                let raw = find(self.raw, &at).unwrap_or(entry);
                panel
                    .elements
                    .push(element(raw, found[0], found[1], number));
                end = Some(found[1]);
                panel.faces.push(found);
                continue;
            }
            let from = from
                .and_then(|node| panel.add(node, below(&at, &["from".into()])))
                .or(end);
            let Some(to) = to.and_then(|node| panel.add(node, to_at)) else {
                panel.why = Some("it has other forms: it is changed in the text".into());
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
        let sets = ["condensation", "objects", "scene"].map(|key| Some(PathStep::from(key)));
        let is_set = sets.contains(&panel.list.first().cloned());
        if panel.role != Role::Initiator && !is_set {
            let ends = ["0, 0", "1, 0", "0, 0, 0", "1, 0, 0"];
            let is_rule = panel.faces.is_empty();
            for point in &mut panel.points {
                point.pinned = is_rule && ends.contains(&point.whole.as_str());
            }
        }
        let points = panel.points.iter().map(|point| [point.x, point.y]);
        panel.window = window(points.chain([[0.0, 0.0], [1.0, 0.0]]));
    }
}
