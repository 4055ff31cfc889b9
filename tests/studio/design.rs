//! Design by hand: scripts of gestures lead to the files that a person would have written, and back.

use crate::common::Draws;
use kfrac::Fractal;
use serde_json::{Value, json};

use super::{Page, Reply};

/// A rule that does nothing yet.
const NOTHING: &str = "\
title: Mine # my own
initiator: segment
generator:
  - [0, 0]
  - [1, 0]
";

/// A page with a hand.
struct Hand {
    page: Page,
    /// Grid and number of its cells in the unit length.
    grid: Option<(&'static str, u32)>,
}

impl Hand {
    fn of(text: &str) -> Self {
        let page = Page::of(text);
        Self { page, grid: None }
    }

    fn grid(self, kind: &'static str, parts: u32) -> Self {
        let grid = Some((kind, parts));
        Self { grid, ..self }
    }

    fn text(&self) -> String {
        self.page.state()["text"].as_str().unwrap().to_owned()
    }

    fn pointer(&self, panel: &str, phase: &str, [x, y]: [f64; 2], more: Value) -> Reply {
        let mut pointer = json!({ "panel": panel, "phase": phase, "x": x, "y": y, "pixel": 0.004 });
        let fields = pointer.as_object_mut().unwrap();
        if let Some((grid, parts)) = self.grid {
            fields.extend([
                ("grid".to_owned(), grid.into()),
                ("parts".to_owned(), parts.into()),
            ]);
        }
        if let Value::Object(more) = more {
            fields.extend(more);
        }
        let asked = json!({ "tab": "a", "pointer": pointer });
        self.page.call("POST", "/pointer", &asked)
    }

    /// Drags from a place to another one in some movements; returns what the badge has.
    fn drag(&self, panel: &str, from: [f64; 2], to: [f64; 2], more: Value) -> String {
        let all = [("down", from), ("move", from), ("move", to), ("up", to)];
        let mut badge = String::new();
        for (phase, place) in all {
            let reply = self.pointer(panel, phase, place, more.clone());
            assert_eq!(reply.status, 200, "{}", reply.error());
            if phase == "move" {
                badge = reply.json()["hand"]["badge"]
                    .as_str()
                    .unwrap_or_default()
                    .to_owned();
            }
        }
        badge
    }

    fn asked(&self, gesture: Value) -> Reply {
        let asked = json!({ "tab": "a", "gesture": gesture });
        self.page.call("POST", "/edit", &asked)
    }

    fn act(&self, gesture: Value) {
        let reply = self.asked(gesture.clone());
        assert_eq!(reply.status, 200, "{gesture}: {}", reply.error());
    }

    /// Draws a polyline by clicks.
    fn draw(&self, panel: &str, clicks: &[[f64; 2]]) {
        let mut drawn: Vec<Value> = Vec::new();
        for place in clicks {
            let reply = self.pointer(panel, "hover", *place, json!({ "drawn": drawn }));
            drawn.push(reply.json()["place"]["text"].clone());
        }
        self.act(json!({ "act": "draw", "panel": panel, "points": drawn }));
    }

    fn key(&self, element: usize, key: &str, value: &str) {
        let panel = "generator";
        self.act(
            json!({ "act": "key", "panel": panel, "element": element, "key": key, "value": value }),
        );
    }

    fn dimension(&self) -> f64 {
        let rule = Fractal::parse(&self.text()).unwrap();
        rule.dimension().unwrap().value
    }

    fn undo(&self) {
        self.page.call("POST", "/undo", &json!({}));
    }
}

#[test]
fn the_koch_curve_is_drawn_from_nothing() {
    let hand = Hand::of(NOTHING).grid("triangular", 6);
    hand.draw("generator", &[[0.34, 0.01], [0.49, 0.28], [0.66, -0.02]]);
    let points = "  - [1/3, 0]\n  - [1/2, sqrt(3)/6]\n  - [2/3, 0]\n";
    let koch = NOTHING.replace("  - [1, 0]\n", &format!("{points}  - [1, 0]\n"));
    assert_eq!(hand.text(), koch);
    assert!((hand.dimension() - 4.0_f64.ln() / 3.0_f64.ln()).abs() < 1e-12);
    hand.undo();
    assert_eq!(hand.text(), NOTHING);
}

#[test]
fn the_pythagoras_tree_is_drawn_from_nothing() {
    let hand = Hand::of(NOTHING).grid("square", 2);
    hand.draw("generator", &[[0.02, 1.01], [0.49, 1.52], [0.98, 1.01]]);
    hand.key(0, "fertile", "false");
    hand.key(3, "fertile", "false");
    let points = "  - {to: [0, 1], fertile: false}\n  - [1/2, 3/2]\n  - [1, 1]\n  - {to: [1, 0], fertile: false}\n";
    assert_eq!(hand.text(), NOTHING.replace("  - [1, 0]\n", points));
    assert!((hand.dimension() - 2.0).abs() < 1e-12);
    hand.key(0, "fertile", "true");
    assert!(
        hand.text()
            .contains("  - [0, 0]\n  - [0, 1]\n  - [1/2, 3/2]\n")
    );
}

#[test]
fn the_dragon_is_drawn_from_nothing_with_two_generators() {
    let hand = Hand::of(NOTHING).grid("square", 4);
    hand.draw("generator", &[[0.5, 0.48]]);
    hand.act(json!({ "act": "add_generator", "from": "left", "name": "right" }));
    hand.drag("generators/right", [0.5, 0.5], [0.51, -0.51], json!({}));
    let text = "\
title: Mine # my own
initiator: segment
generators:
  left:
    - [0, 0]
    - [1/2, 1/2]
    - [1, 0]
  right: [[0, 0], [1/2, -1/2], [1, 0]]
select: {by_index: [left, right]}
";
    assert_eq!(hand.text(), text);
    assert!((hand.dimension() - 2.0).abs() < 1e-12);
    // Names follow wherever they are used, and a generator that is used is not lost by mistake.
    hand.act(json!({ "act": "rename_generator", "from": "left", "to": "up" }));
    let renamed = text.replace("left", "up");
    assert_eq!(hand.text(), renamed);
    hand.act(json!({ "act": "remove_generator", "name": "right" }));
    assert!(
        hand.text()
            .ends_with("    - [1, 0]\nselect: {by_index: [up]}\n")
    );
}

#[test]
fn the_monkeys_tree_is_drawn_from_nothing() {
    let hand = Hand::of(NOTHING).grid("triangular", 9);
    let high = 3.0_f64.sqrt() / 18.0;
    let clicks = [
        (1.5, 3.0),
        (3.0, 6.0),
        (6.0, 6.0),
        (7.5, 3.0),
        (6.0, 4.0),
        (4.5, 5.0),
        (3.0, 4.0),
        (3.0, 2.0),
        (3.0, 0.0),
        (6.0, 0.0),
    ];
    let clicks = clicks.map(|(x, y)| [x / 9.0 + 0.01, y * high - 0.01]);
    hand.draw("generator", &clicks);
    for (element, direction) in [
        (0, "2"),
        (1, "3"),
        (3, "3"),
        (4, "3"),
        (5, "2"),
        (6, "4"),
        (7, "4"),
        (9, "4"),
    ] {
        hand.key(element, "direction", direction);
    }
    // The numbers of the library's file, written as they are there.
    let library = include_str!("../../library/generators/monkeys-tree.yaml");
    let (_, elements) = library.split_once("elements:\n").unwrap();
    let elements = elements.replace("{to: [2/3, sqrt(3)/3]}", "[2/3, sqrt(3)/3]");
    let elements = elements
        .replace("{to: [1/3, 0]}", "[1/3, 0]")
        .replace("{to: [1, 0]}", "[1, 0]");
    assert_eq!(
        hand.text(),
        NOTHING.replace("  - [0, 0]\n  - [1, 0]\n", &elements)
    );
}

#[test]
fn vertices_and_condensation_sets_are_dragged() {
    let text = "kind: ifs\nvertices: {points: [[0, 0], [1, 0], [1/2, sqrt(3)/2]], shrink: 1/2} # gasket\ncondensation:\n  - {segment: [[0, 0], [0, 0.4]]}\n";
    let hand = Hand::of(text).grid("square", 4);
    hand.drag("vertices", [1.0, 0.0], [1.26, 0.24], json!({}));
    let moved = text.replace("[1, 0]", "[5/4, 1/4]");
    assert_eq!(hand.text(), moved);
    hand.drag(
        "condensation/0/segment",
        [0.0, 0.4],
        [0.26, 0.51],
        json!({}),
    );
    assert_eq!(hand.text(), moved.replace("[0, 0.4]", "[1/4, 1/2]"));
    hand.act(json!({ "act": "join", "panel": "vertices", "point": 0 }));
    assert!(
        hand.text()
            .contains("{points: [[5/4, 1/4], [1/2, sqrt(3)/2]], shrink: 1/2} # gasket")
    );
}

#[test]
fn a_hand_that_drags_is_one_entry_and_escape_takes_it_back() {
    let koch = NOTHING.replace("  - [1, 0]\n", "  - [1/3, 0.2] # here\n  - {to: [1, 0]}\n");
    let hand = Hand::of(&koch);
    let path = hand.page.folder.path().join("rule.yaml");
    let badge = hand.drag("generator", [1.0 / 3.0, 0.2], [0.4, 0.31], json!({}));
    assert_eq!(badge, "[0.4, 0.31]");
    let moved = koch.replace("[1/3, 0.2]", "[0.4, 0.31]");
    assert_eq!(hand.text(), moved);
    assert_eq!(std::fs::read_to_string(path).unwrap(), koch);
    // A movement is shown, with its picture, before it ends.
    hand.pointer("generator", "down", [0.4, 0.31], json!({}));
    hand.pointer("generator", "move", [0.6, 0.4], json!({}));
    assert!(hand.text().contains("[0.6, 0.4] # here"));
    hand.pointer("generator", "cancel", [0.0, 0.0], json!({}));
    assert_eq!(hand.text(), moved);
    hand.undo();
    assert_eq!(hand.text(), koch);
    assert_eq!(hand.page.state()["canUndo"], false);
}

#[test]
fn points_come_to_rest() {
    let text = NOTHING.replace(
        "  - [1, 0]\n",
        "  - [1/3, 0.2]\n  - [1/2, sqrt(3)/6]\n  - [1, 0]\n",
    );
    for (to, more, written) in [
        // On a point, as it is written there; beside one; in a direction.
        ([0.51, 0.29], json!({}), "[1/2, sqrt(3)/6]"),
        ([0.2, 0.287], json!({}), "[0.2, sqrt(3)/6]"),
        ([0.25, 0.24], json!({ "shift": true }), "[0.246, 0.246]"),
        (
            [0.26, 0.245],
            json!({ "grid": "square", "parts": 12 }),
            "[1/4, 1/4]",
        ),
    ] {
        let hand = Hand::of(&text);
        hand.drag("generator", [1.0 / 3.0, 0.2], to, more.clone());
        let found = hand.text();
        let line = found.lines().nth(4).unwrap().trim_start_matches("  - ");
        match more.get("shift") {
            None => assert_eq!(line, written),
            Some(_) => {
                let point = hand.page.state()["design"]["panels"][1]["points"][1].clone();
                let [x, y] = ["x", "y"].map(|axis| point[axis].as_f64().unwrap());
                assert!((x - y).abs() < 1e-8 && (x - 0.245).abs() < 0.01, "{line}");
            }
        }
    }
}

#[test]
fn the_ends_of_a_generator_stay_until_the_lock_is_opened() {
    let hand = Hand::of(NOTHING);
    let badge = hand.drag("generator", [1.0, 0.0], [0.9, 0.1], json!({}));
    assert!(badge.contains("lock"), "{badge}");
    assert_eq!(hand.text(), NOTHING);
    hand.drag(
        "generator",
        [1.0, 0.0],
        [0.9, 0.1],
        json!({ "unlocked": true }),
    );
    assert!(hand.text().ends_with("  - [0.9, 0.1]\n"));
    // A component of the library is first made a part of the file.
    let badge = hand.drag("initiator", [1.0, 0.0], [0.9, 0.1], json!({}));
    assert!(badge.contains("make it a part of this file"), "{badge}");
    hand.act(json!({ "act": "own", "panel": "initiator" }));
    hand.drag("initiator", [1.0, 0.0], [0.9, 0.1], json!({}));
    assert!(hand.text().contains("[0.9, 0.1]") && !hand.text().contains("segment"));
}

#[test]
fn parameters_are_solved_for_and_drawn_points_are_refused() {
    let tree = "\
params:
  angle: {value: 45, min: 5, max: 85} # of the roof
initiator: segment
generator:
  random: {tilt: \"uniform(-0.1, 0.1)\"}
  elements:
    - [0, 0]
    - {to: [0, 1], fertile: false}
    - {to: [cos(angle)^2, 1 + sin(angle)*cos(angle)]}
    - {to: [1, 1 + tilt]}
    - {to: [1, 0], fertile: false}
";
    let hand = Hand::of(tree);
    let panel = "generator/elements";
    let angle = 30.0_f64.to_radians();
    let to = [angle.cos().powi(2), 1.0 + angle.sin() * angle.cos()];
    let badge = hand.drag(panel, [0.5, 1.5], to, json!({}));
    assert_eq!(badge, "angle = 30");
    let solved = tree.replace("value: 45", "value: 30");
    assert_eq!(hand.text(), solved);
    let badge = hand.drag(panel, [1.0, 1.0], [0.8, 1.2], json!({}));
    assert!(badge.contains("drawn at random"), "{badge}");
    assert_eq!(hand.text(), solved);
    let scene = &hand.page.state()["design"]["panels"][1];
    assert_eq!(scene["ghosts"][0][3], json!([1.0, 0.9]));
    assert_eq!(scene["ghosts"][1][3], json!([1.0, 1.1]));
    hand.drag(panel, to, [0.3, 1.4], json!({ "alt": true }));
    assert!(
        hand.text().contains("- {to: [0.3, 1.4]}"),
        "{}",
        hand.text()
    );
}

#[test]
fn elements_are_split_joined_and_given_keys() {
    let hand = Hand::of(NOTHING);
    hand.act(json!({ "act": "split", "panel": "generator", "element": 0 }));
    let split = NOTHING.replace("  - [1, 0]\n", "  - [1/2, 0]\n  - [1, 0]\n");
    assert_eq!(hand.text(), split);
    for (key, value) in [
        ("direction", "3"),
        ("visible", "false"),
        ("base_element", "triangle"),
    ] {
        hand.key(1, key, value);
    }
    let keyed = "  - {to: [1, 0], direction: 3, visible: false, base_element: triangle}\n";
    assert!(hand.text().ends_with(keyed), "{}", hand.text());
    hand.act(json!({ "act": "split", "panel": "generator", "element": 1 }));
    assert!(hand.text().contains(&keyed.replace("[1, 0]", "[3/4, 0]")));
    hand.undo();
    for (key, value) in [("direction", "1"), ("visible", "true")] {
        hand.key(1, key, value);
    }
    hand.act(json!({ "act": "key", "panel": "generator", "element": 1, "key": "base_element", "value": null }));
    assert_eq!(hand.text(), split);
    hand.act(json!({ "act": "join", "panel": "generator", "point": 1 }));
    assert_eq!(hand.text(), NOTHING);
    let refused = hand.asked(json!({ "act": "key", "panel": "generator", "element": 0, "key": "use", "value": "nobody" }));
    assert!(
        refused.status == 422 && refused.error().contains("nobody"),
        "{}",
        refused.error()
    );
    assert_eq!(hand.text(), NOTHING);
    // A click on the arrow turns it to the next direction, and a double click divides.
    for phase in ["down", "up"] {
        hand.pointer("generator", phase, [0.62, 0.0], json!({}));
    }
    assert!(hand.text().ends_with("{to: [1, 0], direction: 2}\n"));
    hand.pointer("generator", "double", [0.3, 0.01], json!({}));
    assert!(
        hand.text()
            .ends_with("  - {to: [1/2, 0], direction: 2}\n  - {to: [1, 0], direction: 2}\n")
    );
}

#[test]
fn from_here_on_another_rule_is_a_selection_by_step() {
    let koch = "# mine\ninitiator: segment\ngenerator: # of Koch\n  - [0, 0]\n  - [1/3, 0] # a third\n  - [1/2, sqrt(3)/6]\n  - [2/3, 0]\n  - [1, 0]\nsteps: 4\n";
    let hand = Hand::of(koch);
    hand.act(json!({ "act": "from_here", "step": 2, "name": "later" }));
    let text = "\
# mine
initiator: segment
generators: # of Koch
  first:
    - [0, 0]
    - [1/3, 0] # a third
    - [1/2, sqrt(3)/6]
    - [2/3, 0]
    - [1, 0]
  later: [[0, 0], [1/3, 0], [1/2, sqrt(3)/6], [2/3, 0], [1, 0]]
select: [{when: step < 2, use: first}, {use: later}]
steps: 4
";
    assert_eq!(hand.text(), text);
    // Until the copy is changed, the approximants are those of before.
    let svg = |text: &str, steps| Fractal::parse(text).unwrap().steps(steps).svg().unwrap();
    for steps in 0..5 {
        assert_eq!(svg(text, steps), svg(koch, steps));
    }
    let apex = [0.5, 3.0_f64.sqrt() / 6.0];
    hand.drag("generators/later", apex, [0.5, -apex[1]], json!({}));
    let new = hand.text();
    assert!(svg(&new, 2) == svg(koch, 2) && svg(&new, 3) != svg(koch, 3));
    hand.act(json!({ "act": "from_here", "step": 3, "name": "last" }));
    let cases =
        "select: [{when: step < 2, use: first}, {when: step < 3, use: later}, {use: last}]\n";
    assert!(hand.text().contains(cases), "{}", hand.text());
    for _ in 0..3 {
        hand.undo();
    }
    assert_eq!(hand.text(), koch);
}

#[test]
fn maps_stay_in_the_form_in_which_they_are_written() {
    let text = "\
kind: ifs
maps:
  - {scale: 1/2, shift: [0, 0]} # similar
  - {matrix: [[0.5, 0], [0, 0.5]], shift: [0.5, 0]}
  - {times: [0.5, 0], fixed: [0, 1]}
  - {scale: [0.5, 0.25], rotate: [0, 0]}
";
    let line = |hand: &Hand, number: usize| hand.text().lines().nth(number + 2).unwrap().to_owned();
    let drag = |from, to, more| {
        let hand = Hand::of(text);
        hand.drag("maps", from, to, more);
        hand
    };
    // The x handle of the second map, and the y handle of the third; the others lie below.
    let hand = drag([1.0, 0.0], [0.9, 0.2], json!({}));
    assert_eq!(
        line(&hand, 1),
        "  - {matrix: [[2/5, 0], [1/5, 1/2]], shift: [0.5, 0]}"
    );
    let hand = drag([1.0, 0.0], [0.5, 0.5], json!({ "shift": true }));
    assert_eq!(
        line(&hand, 1),
        "  - {matrix: [[0, -1/2], [1/2, 0]], shift: [0.5, 0]}"
    );
    let hand = drag([0.0, 1.0], [0.0, 0.75], json!({}));
    assert_eq!(line(&hand, 2), "  - {times: [1/4, 0], fixed: [0, 2/3]}");
    let hand = drag([0.75, 0.3], [0.85, 0.4], json!({}));
    assert_eq!(
        line(&hand, 1),
        "  - {matrix: [[0.5, 0], [0, 0.5]], shift: [3/5, 1/10]}"
    );
    for (number, unchanged) in text
        .lines()
        .skip(2)
        .enumerate()
        .filter(|(number, _)| *number != 1)
    {
        assert_eq!(line(&hand, number), unchanged);
    }
    hand.act(json!({ "act": "add_map", "panel": "maps", "map": 0 }));
    assert_eq!(line(&hand, 1), "  - {scale: 1/2, shift: [0, 0]}");
    hand.act(json!({ "act": "remove_map", "panel": "maps", "map": 1 }));
    hand.undo();
    hand.undo();
    hand.undo();
    assert_eq!(hand.text(), text);
}

/// Transforms of instances are done in the order of the file, and new ones stand where they do what the hand did.
#[test]
fn instances_keep_the_order_of_their_transforms() {
    let text = "\
kind: instancing
objects:
  leaf: [{polygon: [[0, 0], [1, 0], [0.5, 1]]}]
  tree:
    - leaf # the trunk
    - {object: tree, scale: 1/2, rotate: 30, translate: [0, 1]} # turned
    - {object: tree, translate: [1, 1], scale: 0.4}
    - {object: leaf, translate: [3, 3]}
    - {object: leaf, scale: [1/2, 1/4], translate: [5, 5]}
scene: [tree]
";
    let sine = 0.75f64.sqrt();
    let dragged = |panel: &str, from, to, more| {
        let hand = Hand::of(text);
        hand.drag(panel, from, to, more);
        let new = hand.text();
        let lines = new.lines().zip(text.lines());
        let changed: Vec<_> = lines.filter(|(new, old)| new != old).collect();
        assert!(changed.len() <= 1 && new.lines().count() == text.lines().count());
        changed
            .first()
            .map_or(String::new(), |(new, _)| new.trim_start().to_owned())
    };
    let tree = |from, to| dragged("objects/tree", from, to, json!({}));
    for (from, to, line) in [
        (
            [0.0, 1.0],
            [0.5, 1.0],
            "- {object: tree, scale: 1/2, rotate: 30, translate: [1/2, 1]} # turned",
        ),
        (
            [sine / 2.0, 1.25],
            [0.0, 1.25],
            "- {object: tree, scale: 1/4, rotate: 90, translate: [0, 1]} # turned",
        ),
        // The translation is scaled, and the scale would move the instance.
        (
            [0.4, 0.4],
            [0.6, 0.4],
            "- {object: tree, translate: [3/2, 1], scale: 0.4}",
        ),
        ([0.8, 0.4], [0.6, 0.4], ""),
        (
            [0.0, 0.0],
            [0.25, 0.0],
            "- {object: leaf, translate: [1/4, 0]} # the trunk",
        ),
        (
            [4.0, 3.0],
            [3.0, 3.5],
            "- {object: leaf, scale: 1/2, rotate: 90, translate: [3, 3]}",
        ),
        (
            [5.5, 5.0],
            [6.0, 5.0],
            "- {object: leaf, scale: [1, 1/4], translate: [5, 5]}",
        ),
        (
            [5.0, 5.25],
            [4.5, 5.0],
            "- {object: leaf, scale: [1/2, 1/2], rotate: 90, translate: [5, 5]}",
        ),
    ] {
        assert_eq!(tree(from, to), line, "{from:?}");
    }
    let line = dragged(
        "objects/tree",
        [5.5, 5.0],
        [6.0, 5.0],
        json!({ "shift": true }),
    );
    assert_eq!(line, "- {object: leaf, scale: [1, 1/2], translate: [5, 5]}");
    let line = dragged("objects/leaf/0/polygon", [0.5, 1.0], [0.5, 0.5], json!({}));
    assert_eq!(line, "leaf: [{polygon: [[0, 0], [1, 0], [0.5, 0.5]]}]");
    let hand = Hand::of(text);
    hand.act(json!({ "act": "add_map", "panel": "objects/tree", "map": 1 }));
    let copies = hand.text().matches("{object: tree, scale: 1/2").count();
    assert_eq!(copies, 2, "{}", hand.text());
    hand.act(json!({ "act": "remove_map", "panel": "objects/tree", "map": 2 }));
    assert_eq!(hand.text(), text);
}

/// Of unions with transforms, the whole is moved; parameters that place an instance are solved for.
#[test]
fn whole_objects_and_parameters_move_instances() {
    let text = "\
kind: instancing
params: {angle: {value: 0, min: -90, max: 90}}
objects:
  up: {union: [up, side], scale: 1/2, translate: [0, 3/4]}
  side: {union: [side, {object: up, rotate: angle}], scale: 1/2}
scene: [up]
";
    let hand = Hand::of(text);
    hand.drag("objects", [0.0, 0.75], [0.25, 0.75], json!({}));
    assert!(
        hand.text()
            .contains("up: {union: [up, side], scale: 1/2, translate: [1/4, 3/4]}")
    );
    hand.undo();
    let badge = hand.drag("objects/side/union", [1.0, 0.0], [0.0, 1.0], json!({}));
    assert!(badge.starts_with("angle = "), "{badge}");
    assert!(hand.text().contains("rotate: angle"));
    hand.undo();
    assert_eq!(hand.text(), text);
    // A value that is set is written by a drag, and set again by undo.
    let set = json!({ "angle": "0" });
    hand.page.draw(json!({ "look": { "set": set } })).picture();
    hand.drag("objects/side/union", [1.0, 0.0], [0.0, 1.0], json!({}));
    assert_eq!(hand.page.state()["look"]["set"], json!({}));
    hand.undo();
    assert_eq!(hand.page.state()["look"]["set"], set);
}

/// A point of a ghost figure changes the number that is its limit, or the parameter on which the limit depends.
#[test]
fn limits_of_random_functions_are_dragged() {
    let text = "\
params: {wide: {value: 0.1, min: 0, max: 0.4}}
initiator: segment
generator:
  random:
    up: uniform(0.1, 0.3) # of the middle
    along: \"normal(1/2, 0.05)\"
    off: \"uniform(-wide, wide)\"
  elements:
    - [0, 0]
    - [along, up]
    - [3/4, off]
    - [1, 0]
";
    let hand = Hand::of(text);
    let panel = "generator/elements";
    let limits = hand.page.state()["design"]["panels"][1]["limits"].clone();
    let all: Vec<_> = limits
        .as_array()
        .unwrap()
        .iter()
        .map(|it| (it["side"].as_u64().unwrap(), it["at"].clone()))
        .collect();
    let wanted = [
        (0, json!([0.45, 0.1])),
        (1, json!([0.55, 0.3])),
        (0, json!([0.75, -0.1])),
        (1, json!([0.75, 0.1])),
    ];
    assert_eq!(all, wanted);
    // Both numbers of a corner, one of each function.
    let badge = hand.drag(panel, [0.55, 0.3], [0.6, 0.4], json!({}));
    assert_eq!(badge, "up: uniform(0.1, 0.4), along: normal(1/2, 0.1)");
    let first = text
        .replace("up: uniform(0.1, 0.3)", "up: uniform(0.1, 0.4)")
        .replace("(1/2, 0.05)", "(1/2, 0.1)");
    assert_eq!(hand.text(), first);
    let badge = hand.drag(panel, [0.4, 0.1], [0.45, 0.05], json!({}));
    assert_eq!(badge, "up: uniform(0.05, 0.4), along: normal(1/2, 0.05)");
    hand.undo();
    // A limit that is a formula: its parameter.
    let badge = hand.drag(panel, [0.75, -0.1], [0.75, -0.2], json!({}));
    assert_eq!(badge, "wide = 0.2");
    assert_eq!(hand.text(), first.replace("value: 0.1,", "value: 0.2,"));
    hand.undo();
    hand.undo();
    assert_eq!(hand.text(), text);
    // The least value goes up to the largest one.
    let badge = hand.drag(panel, [0.45, 0.1], [0.45, 0.5], json!({}));
    assert_eq!(badge, "up: uniform(0.3, 0.3)");
    hand.undo();
    // A limit that keys have chosen, whatever lies nearer.
    let badge = hand.drag(panel, [0.75, 0.0], [0.75, 0.3], json!({ "limit": 1 }));
    assert!(badge.starts_with("up: "), "{badge}");
    hand.undo();
    assert_eq!(hand.text(), text);
}

/// A copy follows what its map follows, and is followed by the same; numbers of the maps behind change.
#[test]
fn copies_of_maps_in_recurrent_systems_have_their_edges() {
    let text = "\
kind: ifs
maps: [{scale: 1/2}, {scale: 1/2, translate: [1/2, 0]}, {scale: 1/2, translate: [0, 1/2]}]
edges:
  1: [1, 2]  # twice
  2: [3]
  3:  # back
    1: 3
    2: 1  # seldom
";
    let hand = Hand::of(text);
    hand.act(json!({ "act": "add_map", "panel": "maps", "map": 0 }));
    let edges = |hand: &Hand| hand.page.state()["design"]["edges"].clone();
    let copied = json!({ "1": ["1", "2", "3"], "2": ["1", "2", "3"], "3": ["4"], "4": { "1": "3", "2": "3", "3": "1" } });
    assert_eq!(edges(&hand), copied);
    let written = "\
edges:
  1: [1, 2, 3]  # twice
  2: [1, 2, 3]
  3: [4]
  4:  # back
    1: 3
    2: 3
    3: 1  # seldom
";
    assert!(hand.text().ends_with(written), "{}", hand.text());
    hand.act(json!({ "act": "remove_map", "panel": "maps", "map": 0 }));
    let once = json!({ "1": ["1", "2"], "2": ["3"], "3": { "1": "3", "2": "1" } });
    assert_eq!(edges(&hand), once);
    hand.undo();
    hand.undo();
    assert_eq!(hand.text(), text);
    // Names stay; a number that stands for a map with a name is that of its place.
    let text = "\
kind: ifs
maps:
  left: {scale: 1/2}
  right: {scale: 1/2, translate: [1/2, 0]}
  top: {scale: 1/2, translate: [0, 1/2]}
edges: {left: [left, 3], right: [2, top], top: [left, right]}
";
    let hand = Hand::of(text);
    hand.act(json!({ "act": "add_map", "panel": "maps", "map": 1 }));
    let followers = "edges: {left: [left, 3], right: [2, right copy, top], right copy: [2, right copy, top], top: [left, right, right copy]}";
    assert!(hand.text().contains(followers), "{}", hand.text());
    hand.act(json!({ "act": "add_map", "panel": "maps", "map": 1 }));
    assert!(
        hand.text().contains("  right copy 2: {scale"),
        "{}",
        hand.text()
    );
    hand.undo();
    hand.act(json!({ "act": "remove_map", "panel": "maps", "map": 1 }));
    let followers =
        "edges: {left: [left, 2], right copy: [right copy, top], top: [left, right copy]}";
    assert!(hand.text().contains(followers), "{}", hand.text());
}

/// Maps that may follow each other, and the factor of maps towards vertices.
#[test]
fn edges_and_factors_are_shown_and_set() {
    let text = "\
kind: ifs
maps: [{scale: 1/2}, {scale: 1/2, translate: [1/2, 0]}, {scale: 1/2, translate: [0, 1/2]}]
edges: {1: [1, 2], 2: [3], 3: {1: 3, 2: 1}}
";
    let hand = Hand::of(text);
    let edges = &hand.page.state()["design"]["edges"];
    assert_eq!(edges["3"]["1"], "3");
    let set = json!({ "act": "set", "at": "edges", "value": "{1: [1], 2: [3], 3: [1, 2]}" });
    assert_eq!(hand.asked(set).status, 200);
    assert!(hand.text().contains("edges: {1: [1], 2: [3], 3: [1, 2]}"));
    let wrong = json!({ "act": "set", "at": "edges", "value": "{1: [1], 2: [3], 3: []}" });
    assert_eq!(hand.asked(wrong).status, 422);
    assert_eq!(
        hand.asked(json!({ "act": "remove", "at": "edges" })).status,
        200
    );
    assert_eq!(hand.page.state()["design"]["edges"], Value::Null);
    let hand =
        Hand::of("kind: ifs\nvertices: {points: [[0, 0], [1, 0], [0, 1]], shrink: 1/2} # half\n");
    assert_eq!(hand.page.state()["design"]["panels"][0]["shrink"], "1/2");
    let set = json!({ "act": "set", "at": "vertices/shrink", "value": "0.45" });
    assert_eq!(hand.asked(set).status, 200);
    assert!(hand.text().contains("shrink: 0.45} # half"));
}

/// Components are saved in the library of the person, and those of the library take the place of those of the file.
#[test]
fn components_are_saved_and_exchanged() {
    let text = "\
title: Mine
params: {high: 0.3}
initiator: segment # a line
generators:
  bump: # a bump
    random: {x: \"uniform(0, 1/4)\"}
    elements:
      - [0, 0]
      - {to: [1/2, x], direction: 2}
      - [1, 0]
  peak: [[0, 0], [1/2, high], [1, 0]]
select: {by_index: [bump, peak]}
";
    let hand = Hand::of(text);
    let save = |panel: &str, name: &str| {
        let asked = json!({ "panel": panel, "name": name });
        hand.page.call("POST", "/component", &asked)
    };
    let reply = save("generators/bump/elements", "my-bump");
    assert_eq!(reply.status, 200, "{}", reply.error());
    let saved = hand.page.read("library/generators/my-bump.yaml");
    let expected = "\
# yaml-language-server: $schema=../schema/generator.json
title: my-bump
random: {x: \"uniform(0, 1/4)\"}
elements:
  - [0, 0]
  - {to: [1/2, x], direction: 2}
  - [1, 0]
";
    assert_eq!(saved, expected);
    // It exists; it depends on a parameter; it lies in the library; its name leads elsewhere; there is none.
    for (panel, name, status) in [
        ("generators/bump/elements", "my-bump", 409),
        ("generators/peak", "my-peak", 422),
        ("initiator", "line", 422),
        ("generators/bump/elements", "../rules/x", 422),
        ("generators/none", "x", 422),
    ] {
        assert_eq!(save(panel, name).status, status, "{panel} as {name}");
    }
    let exchange = |panel: &str, name: &str| {
        hand.act(json!({ "act": "exchange", "panel": panel, "name": name }));
    };
    exchange("generators/peak", "my-bump");
    exchange("initiator", "square");
    exchange("base_element", "triangle");
    let new = text
        .replace("  peak: [[0, 0], [1/2, high], [1, 0]]", "  peak: my-bump")
        .replace("initiator: segment # a line", "initiator: square # a line");
    assert_eq!(hand.text(), new + "base_element: triangle\n");
    let reply = hand.asked(json!({ "act": "exchange", "panel": "initiator", "name": "nothing" }));
    assert_eq!(reply.status, 422);
    for _ in 0..3 {
        hand.undo();
    }
    assert_eq!(hand.text(), text);
}

/// Makes a random gesture.
fn random(hand: &Hand, draws: &mut Draws) -> u16 {
    let state = hand.page.state();
    let panels = state["design"]["panels"]
        .as_array()
        .cloned()
        .unwrap_or_default();
    if panels.is_empty() {
        return hand.page.call("POST", "/undo", &json!({})).status;
    }
    let panel = &panels[draws.below(panels.len())];
    let id = panel["id"].as_str().unwrap();
    let count = |what: &str| panel[what].as_array().map_or(0, Vec::len);
    let place = [2.0 * draws.unit() - 0.5, 2.0 * draws.unit() - 0.5];
    let points = panel["points"].as_array().unwrap();
    let maps = panel["maps"].as_array().unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    let from = if !points.is_empty() {
        let point = &points[draws.below(points.len())];
        [number(&point["x"]), number(&point["y"])]
    } else if !maps.is_empty() {
        let corner = &maps[draws.below(maps.len())]["frame"][draws.below(3)];
        [number(&corner[0]), number(&corner[1])]
    } else {
        place
    };
    let element = draws.below(count("elements").max(1));
    let few = count("elements") < 8;
    match draws.below(13) {
        0..=3 => {
            let more = json!({ "alt": draws.below(4) == 0, "shift": draws.below(3) == 0, "unlocked": draws.below(2) == 0 });
            for (phase, place) in [("down", from), ("move", place)] {
                hand.pointer(id, phase, place, more.clone());
            }
            let end = if draws.below(4) == 0 { "cancel" } else { "up" };
            hand.pointer(id, end, place, more).status
        }
        4 if few => hand.asked(json!({ "act": "split", "panel": id, "element": element })).status,
        5 => hand.asked(json!({ "act": "join", "panel": id, "point": draws.below(points.len().max(1)) })).status,
        6 => {
            let (key, value) = [("direction", "2"), ("direction", "1"), ("fertile", "false"), ("fertile", "true"), ("visible", "false"), ("connected", "false")][draws.below(6)];
            hand.asked(json!({ "act": "key", "panel": id, "element": element, "key": key, "value": value })).status
        }
        7 if few => {
            let drawn: Vec<_> = (0..1 + draws.below(3)).map(|_| [draws.unit().to_string(), draws.unit().to_string()]).collect();
            hand.asked(json!({ "act": "draw", "panel": id, "points": drawn })).status
        }
        8 => hand.asked(json!({ "act": "own", "panel": id })).status,
        9 if panels.len() < 6 => hand.asked(json!({ "act": "from_here", "step": draws.below(5), "name": format!("g{}", draws.below(9)) })).status,
        10 => hand.page.call("POST", "/undo", &json!({})).status,
        11 if maps.len() < 6 => hand.asked(json!({ "act": "add_map", "panel": id, "map": draws.below(maps.len().max(1)) })).status,
        11 => hand.asked(json!({ "act": "remove_map", "panel": id, "map": draws.below(maps.len()) })).status,
        _ => hand.pointer(id, "double", place, json!({})).status,
    }
}

#[cfg(target_os = "linux")]
fn memory() -> usize {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status
        .lines()
        .find(|line| line.starts_with("VmRSS"))
        .unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

/// A robot makes random gestures; `KFRAC_GESTURES` is their number.
#[test]
fn a_robot_breaks_nothing_and_undo_brings_back_every_byte() {
    let rule = "title: Robot # a comment\r\ninitiator: segment\r\ngenerator:\r\n  # the points\r\n  - [0, 0]\r\n  - {to: [1/2, 0.3], direction: 2} # first\r\n  - [1, 0] # second\r\n";
    robot(rule, 3);
    let structure = "kind: instancing # a comment\nobjects:\n  # the leaf\n  leaf: [{polygon: [[0, 0], [1, 0], [0.5, 1]]}]\n  tree:\n    - leaf\n    - {object: tree, scale: 1/2, translate: [0, 1]} # first\n    - {object: tree, rotate: 30, scale: 0.4}\nscene: [tree]\n";
    robot(structure, 5);
}

/// Makes many gestures, of which at least one in `share` is done, and undoes them.
fn robot(text: &str, share: usize) {
    let count = std::env::var("KFRAC_GESTURES")
        .ok()
        .and_then(|it| it.parse().ok())
        .unwrap_or(250);
    let hand = Hand::of(text);
    let mut draws = Draws(7);
    let mut done = 0;
    #[cfg(target_os = "linux")]
    let mut before = 0;
    for number in 0..count {
        let status = random(&hand, &mut draws);
        assert!([200, 422].contains(&status), "gesture {number}: {status}");
        done += usize::from(status == 200);
        let state = hand.page.state();
        assert_eq!(state["isGood"], true, "gesture {number}: {}", state["text"]);
        #[cfg(target_os = "linux")]
        if number == count / 2 {
            before = memory();
        }
    }
    assert!(done > count / share, "{done} of {count} gestures were done");
    #[cfg(target_os = "linux")]
    if count >= 2_000 {
        let after = memory();
        assert!(after * 5 <= before * 6, "{before} kB, then {after}");
    }
    while hand.page.state()["canUndo"] == true {
        hand.undo();
    }
    assert_eq!(hand.text(), text);
}
