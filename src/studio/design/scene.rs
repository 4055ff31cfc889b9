//! Handles of a design: points and elements, with the places in the text that they edit.

use serde::Serialize;

use crate::document::node::{Node, Value};
use crate::edit::PathStep;

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
    pub(super) list: Vec<PathStep>,
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
    /// Its entry in the list; the last element of a closed list has none.
    pub(super) entry: Option<usize>,
}

impl Panel {
    /// Adds a point, or a place where a known one is written.
    pub(super) fn add(&mut self, node: &Node, at: Vec<PathStep>) -> Option<usize> {
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
