//! Handles of a design: points and elements, with the places in the text that they edit.

use serde::Serialize;

use crate::document::node::{Node, Value};
use crate::edit::PathStep;
use crate::geometry::DAffine2;

use super::limits::{Functions, Limit};
use super::maps;
use super::names::{Basis, Names};
use super::space::View;

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
    /// Maps that may follow each map of a recurrent system, as they are written.
    pub(super) edges: Option<serde_json::Value>,
    /// Reason why nothing is designed here.
    pub(super) why: Option<String>,
    /// View of a figure in space; `None` in the plane.
    pub(super) view: Option<View>,
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
    /// Points of faces of which elements are sides, in space.
    pub(super) faces: Vec<Vec<usize>>,
    /// Figures at the limits of random functions: polylines.
    pub(super) ghosts: Vec<Vec<[f64; 2]>>,
    /// Their points that are dragged.
    pub(super) limits: Vec<Limit>,
    /// Factor of the maps towards vertices, as written.
    pub(super) shrink: Option<String>,
    /// Lower left and upper right corner.
    pub(super) window: [f64; 4],
    #[serde(skip)]
    pub(super) functions: Option<Functions>,
    #[serde(skip)]
    pub(super) list: Vec<PathStep>,
    #[serde(skip)]
    pub(super) names: Names,
}

/// A point.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Point {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Coordinate that is not seen, in space.
    pub(super) depth: f64,
    /// Coordinates that are seen, as written.
    pub(super) text: [String; 2],
    /// All coordinates, as written.
    #[serde(skip)]
    pub(super) whole: String,
    pub(super) basis: Basis,
    /// Whether it is an end of a generator.
    pub(super) pinned: bool,
    /// The places where it is written.
    #[serde(skip)]
    pub(super) written: Vec<Vec<PathStep>>,
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
    /// Angle by which it is turned about itself, in space.
    pub(super) roll: Option<String>,
    /// Its entry in the list; the last element of a closed list has none.
    pub(super) entry: Option<usize>,
}

impl Scene {
    /// Shows images of a rectangle, of which `frame` is the map from the unit square, in place of those of the unit square.
    pub(in crate::studio) fn lay(&mut self, frame: DAffine2) {
        for panel in &mut self.panels {
            let maps = panel.maps.iter_mut().filter(|map| !map.is_instance);
            maps.for_each(|map| map.lay(frame));
            if panel.role == Role::BaseElement {
                continue;
            }
            let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
            let frame = corners.map(|corner| frame.transform_point2(corner.into()).to_array());
            let points = panel.points.iter().map(|point| [point.x, point.y]);
            let maps = panel.maps.iter().flat_map(maps::MapHandle::corners);
            panel.window = window(frame.into_iter().chain(points).chain(maps));
        }
    }
}

impl Panel {
    /// Adds a point, or a place where a known one is written.
    pub(super) fn add(&mut self, node: &Node, at: Vec<PathStep>) -> Option<usize> {
        let ([x, y], basis) = self.names.point(node)?;
        let [right, up, along] = self.names.view().axes();
        let (text, whole) = match &node.value {
            Value::Sequence(parts) => {
                let text = |axis: usize| match parts.get(axis) {
                    Some(part) => part.written().unwrap_or_default(),
                    None => "0",
                };
                let size = parts.len();
                let whole: Vec<_> = (0..size).map(text).collect();
                ([text(right), text(up)].map(str::to_owned), whole.join(", "))
            }
            _ => {
                let text = node.written()?.to_owned();
                ([text.clone(), String::new()], text)
            }
        };
        let depth = self.names.vector(node).map_or(0.0, |(at, _)| at[along]);
        let known = self.points.iter().position(|point| {
            let is_number = basis == Basis::Numbers && point.basis == basis;
            point.whole == whole || is_number && [point.x, point.y, point.depth] == [x, y, depth]
        });
        if let Some(known) = known {
            self.points[known].written.push(at);
            return Some(known);
        }
        self.points.push(Point {
            x,
            y,
            depth,
            text,
            whole,
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
                depth: 0.0,
                text: text.clone(),
                whole: text.join(", "),
                basis: Basis::Numbers,
                pinned: false,
                written: Vec::new(),
            });
        }
    }

    /// Returns a point of space as it is written: with two coordinates in the plane.
    pub(super) fn written(&self, text: [String; 3]) -> String {
        let size = if self.names.is_in_space() { 3 } else { 2 };
        format!("[{}]", text[..size].join(", "))
    }

    pub(super) fn place(&self, point: usize) -> [f64; 2] {
        [self.points[point].x, self.points[point].y]
    }
}

pub(super) fn element(entry: &Node, from: usize, to: usize, number: usize) -> Element {
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
        roll: text("roll"),
        entry: Some(number),
    }
}

/// Moves the inner points of a panel by the moves of a generator.
pub(super) fn moved(panel: &mut Panel, generator: &Node) {
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
            point("translate").or(point("shift")).unwrap_or_default(),
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
pub(super) fn window(points: impl Iterator<Item = [f64; 2]>) -> [f64; 4] {
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
pub(super) fn json(node: &Node) -> serde_json::Value {
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
