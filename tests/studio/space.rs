//! Design by hand in space: figures in views along an axis.

use super::*;

const MAPS: &str = "\
kind: ifs
space: 3
maps:
  - {scale: 1/2} # at the origin
  - {scale: 1/2, rotate: {z: 0}, translate: [1/2, 0, 1/4]}
  - {scale: [1/2, 1/3, 1/4], fixed: [0, 3, 0]}
  - {matrix: [[1/2, 0, 0], [0, 1/2, 0], [0, 0, 1/2]], translate: [3, 3, 3]}
";

/// The Koch surface of triangles.
const TILES: &str = "\
space: 3
initiator: [{face: [[0, 0, 0], [1, 0, 0], [1/2, sqrt(3)/2, 0]]}]
base_element: {surfaces: [{points: [[0, 0, 0], [1, 0, 0], [1/2, sqrt(3)/2, 0]], sides: 2}]}
generator:
  - {face: [[0, 0, 0], [1/2, 0, 0], [1/4, sqrt(3)/4, 0]]}
  - {face: [[1/2, 0, 0], [1, 0, 0], [3/4, sqrt(3)/4, 0]]}
  - {face: [[1/4, sqrt(3)/4, 0], [3/4, sqrt(3)/4, 0], [1/2, sqrt(3)/2, 0]]}
  - {face: [[1/2, 0, 0], [3/4, sqrt(3)/4, 0], [1/2, sqrt(3)/6, sqrt(6)/6]]}
  - {face: [[3/4, sqrt(3)/4, 0], [1/4, sqrt(3)/4, 0], [1/2, sqrt(3)/6, sqrt(6)/6]]}
  - {face: [[1/4, sqrt(3)/4, 0], [1/2, 0, 0], [1/2, sqrt(3)/6, sqrt(6)/6]]}
";

impl Page {
    fn view(&self, view: &str) -> Value {
        let reply = self.call("POST", "/design/view", &json!({ "view": view }));
        assert_eq!(reply.status, 200, "{}", reply.error());
        reply.json()
    }

    /// Returns a panel of the design.
    fn panel(&self, id: &str) -> Value {
        let panels = self.state()["design"]["panels"].clone();
        let found = panels.as_array().unwrap().iter().find(|it| it["id"] == id);
        found
            .unwrap_or_else(|| panic!("no {id} in {panels}"))
            .clone()
    }

    /// Drags in a panel; returns the text after it, and what the badge has.
    fn pull(&self, panel: &str, from: [f64; 2], to: [f64; 2]) -> (String, String) {
        let mut badge = String::new();
        for (phase, [x, y]) in [("down", from), ("move", to), ("up", to)] {
            let pointer = json!({ "panel": panel, "phase": phase, "x": x, "y": y, "pixel": 0.004 });
            let reply = self.call("POST", "/pointer", &json!({ "pointer": pointer }));
            assert_eq!(reply.status, 200, "{}", reply.error());
            if phase == "move" {
                badge = reply.json()["hand"]["badge"]
                    .as_str()
                    .unwrap_or_default()
                    .to_owned();
            }
        }
        (self.state()["text"].as_str().unwrap().to_owned(), badge)
    }

    fn undo(&self) {
        self.call("POST", "/undo", &json!({}));
    }
}

fn near(value: &Value, wanted: &[f64]) -> bool {
    let all: Vec<f64> = match value {
        Value::Array(all) if all[0].is_array() => all
            .iter()
            .flat_map(|it| it.as_array().unwrap())
            .map(|it| it.as_f64().unwrap())
            .collect(),
        value => value
            .as_array()
            .unwrap()
            .iter()
            .map(|it| it.as_f64().unwrap())
            .collect(),
    };
    all.len() == wanted.len() && all.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-9)
}

#[test]
fn maps_of_space_are_dragged_in_views_along_an_axis() {
    let page = Page::of(MAPS);
    assert_eq!(page.state()["design"]["view"], "front");
    let frame = |map: usize| page.panel("maps")["maps"][map]["frame"].clone();
    assert!(
        near(&frame(1), &[0.5, 0.0, 1.0, 0.0, 0.5, 0.5]),
        "{}",
        frame(1)
    );
    assert!(
        near(&frame(2), &[0.0, 2.0, 0.5, 2.0, 0.0, 2.0 + 1.0 / 3.0]),
        "{}",
        frame(2)
    );
    // A turn about the axis of the view, and a stretch.
    let (text, _) = page.pull("maps", [1.0, 0.0], [0.5, 0.75]);
    assert!(
        text.contains("- {scale: 3/4, rotate: {z: 90}, translate: [1/2, 0, 1/4]}"),
        "{text}"
    );
    page.undo();
    // One factor of three, and the coordinates of a fixed point.
    let (text, _) = page.pull("maps", [0.5, 2.0], [0.25, 2.0]);
    assert!(
        text.contains("{scale: [1/4, 1/3, 1/4], fixed: [0, 3, 0]}"),
        "{text}"
    );
    page.undo();
    let (text, _) = page.pull("maps", [0.0, 2.0], [0.5, 2.0]);
    assert!(text.contains("fixed: [1, 3, 0]}"), "{text}");
    page.undo();
    // Two entries of a matrix.
    let (text, _) = page.pull("maps", [3.0, 3.5], [3.25, 3.25]);
    assert!(
        text.contains("{matrix: [[1/2, 1/4, 0], [0, 1/4, 0], [0, 0, 1/2]], translate: [3, 3, 3]}"),
        "{text}"
    );
    page.undo();
    assert_eq!(page.view("below")["design"]["view"], "below");
    assert!(
        near(&frame(1), &[0.5, 0.25, 1.0, 0.25, 0.5, 0.75]),
        "{}",
        frame(1)
    );
    let (text, _) = page.pull("maps", [0.5, 0.25], [0.25, 0.5]);
    assert!(text.contains("translate: [1/4, 0, 1/2]}"), "{text}");
    page.undo();
    page.view("left");
    assert!(
        near(&frame(1), &[0.25, 0.0, 0.75, 0.0, 0.25, 0.5]),
        "{}",
        frame(1)
    );
    // About the x axis, against the turn that is seen from its other end. The turn about z stays what it is.
    let (text, _) = page.pull("maps", [0.75, 0.0], [0.25, 0.25]);
    assert!(
        text.contains("- {scale: 1/4, rotate: {z: 0}, translate: [1/2, 0, 1/4]}"),
        "{text}"
    );
    page.undo();
    let (text, _) = page.pull("maps", [0.5, 0.0], [0.0, 0.5]);
    assert!(
        text.contains("- {scale: 1/2, rotate: {x: -90}} # at the origin"),
        "{text}"
    );
    // The turn is right: the image of the z axis is the y axis.
    assert!(
        near(&frame(0), &[0.0, 0.0, 0.0, 0.5, -0.5, 0.0]),
        "{}",
        frame(0)
    );
    page.undo();
    assert_eq!(page.state()["text"], MAPS);
    assert_eq!(
        page.call("POST", "/design/view", &json!({ "view": "back" }))
            .status,
        422
    );
}

#[test]
fn the_origin_of_a_map_stays_where_it_is_stretched() {
    let page = Page::of(
        "\
kind: ifs
space: 3
maps:
  - {scale: 1/2, fixed: [1, 0, 0]}
  - {matrix: [[1/2, 0, 0], [0, 1/3, 0], [0, 0, 1/4]], fixed: [3, 4, 5]}
",
    );
    let is_at = |map: usize, wanted: [[f64; 2]; 2]| {
        let frame = page.panel("maps")["maps"][map]["frame"].clone();
        let coordinate = |point: usize, axis: usize| frame[point][axis].as_f64().unwrap();
        let all = [0, 1].map(|point| [0, 1].map(|axis| coordinate(point, axis)));
        let far = { all.as_flattened().iter() }.zip(wanted.as_flattened());
        let far = far.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(far < 0.01, "{all:?} {wanted:?}");
    };
    let (text, _) = page.pull("maps", [1.0, 0.0], [0.8, 0.0]);
    assert!(
        text.contains("- {scale: 3/10, fixed: [5/7, 0, 0]}"),
        "{text}"
    );
    is_at(0, [[0.5, 0.0], [0.8, 0.0]]);
    page.undo();
    let origin = [1.5, 8.0 / 3.0];
    is_at(1, [origin, [2.0, origin[1]]]);
    page.pull("maps", [2.0, origin[1]], [2.1, 2.717]);
    is_at(1, [origin, [2.1, 2.717]]);
    // Nothing is written before a translation that is the first key.
    let text = "\
kind: instancing
space: 3
objects: {brick: [{box: {}}]}
scene: [brick, {translate: [3, 0, 0], object: brick}]
";
    let page = Page::of(text);
    let (after, _) = page.pull("scene", [4.0, 0.0], [4.5, 0.0]);
    assert_eq!(after, text);
}

#[test]
fn points_of_space_keep_the_coordinate_that_is_not_seen() {
    let rule = "\
space: 3
initiator: [[0, 0, 0], [1, 0, 0]]
generator:
  - [0, 0]
  - [1/3, 0, 0] # the foot
  - {to: [1/2, 0.3, 0.1], roll: 10}
  - [2/3, 0, 0]
  - [1, 0, 0]
";
    let page = Page::of(rule);
    let panel = "generator";
    let points = page.panel(panel)["points"].clone();
    let pinned: Vec<bool> = points
        .as_array()
        .unwrap()
        .iter()
        .map(|it| it["pinned"].as_bool().unwrap())
        .collect();
    assert_eq!(pinned, [true, false, false, false, true]);
    assert_eq!(
        (&points[2]["x"], &points[2]["y"], &points[2]["depth"]),
        (&json!(0.5), &json!(0.3), &json!(0.1))
    );
    page.view("left");
    let (text, badge) = page.pull(panel, [0.1, 0.3], [0.25, 0.4]);
    assert!(text.contains("- {to: [1/2, "), "{text}");
    let point = page.panel(panel)["points"][2].clone();
    assert!(
        (point["x"].as_f64().unwrap() - 0.25).abs() < 0.01
            && (point["y"].as_f64().unwrap() - 0.4).abs() < 0.01,
        "{badge} {text}"
    );
    page.undo();
    // The end of a generator is written with two numbers: it has no z, and does not move.
    let (text, badge) = page.pull(panel, [0.0, 0.0], [0.1, 0.1]);
    assert!(
        badge.contains("ends of a generator") && text == rule,
        "{badge}"
    );
    page.view("below");
    let (text, _) = page.pull(panel, [1.0 / 3.0, 0.0], [0.25, 0.125]);
    assert!(
        text.contains("0, ") && text.contains("# the foot"),
        "{text}"
    );
    let foot = page.panel(panel)["points"][1].clone();
    assert_eq!(foot["depth"], 0.0);
    assert!((foot["y"].as_f64().unwrap() - 0.125).abs() < 0.01, "{text}");
    page.undo();
    // A split lies half-way in space; eight directions, and the roll.
    let asked = |gesture: Value| {
        page.call("POST", "/edit", &json!({ "gesture": gesture }))
            .status
    };
    assert_eq!(
        asked(json!({ "act": "split", "panel": panel, "element": 1 })),
        200
    );
    let text = page.state()["text"].as_str().unwrap().to_owned();
    assert!(
        text.contains("{to: [5/12, 0.15, 0.05], roll: 10}")
            || text.contains("{to: [5/12, 3/20, 1/20], roll: 10}"),
        "{text}"
    );
    page.undo();
    for (key, value) in [("direction", "7"), ("roll", "-30")] {
        let gesture =
            json!({ "act": "key", "panel": panel, "element": 1, "key": key, "value": value });
        assert_eq!(asked(gesture), 200, "{key}");
    }
    let text = page.state()["text"].as_str().unwrap().to_owned();
    assert!(
        text.contains("{to: [1/2, 0.3, 0.1], roll: -30, direction: 7}"),
        "{text}"
    );
    let wrong =
        json!({ "act": "key", "panel": panel, "element": 1, "key": "direction", "value": "9" });
    assert_eq!(asked(wrong), 422);
    // A figure that is drawn lies in the plane of the view.
    let points = json!([["0", "0"], ["1/2", "1/4"], ["1", "0"]]);
    assert_eq!(
        asked(json!({ "act": "draw", "panel": panel, "points": points })),
        200
    );
    let text = page.state()["text"].as_str().unwrap().to_owned();
    assert!(text.contains("[1/2, 0, 1/4]"), "{text}");
    page.view("left");
    assert_eq!(
        asked(json!({ "act": "draw", "panel": panel, "points": points })),
        422
    );
}

#[test]
fn instances_of_space_are_dragged() {
    let text = "\
kind: instancing
space: 3
objects:
  tower: [brick, {object: brick, translate: [0, 1, 0]}]
  brick: [{box: {}}]
scene:
  - tower
  - {object: tower, scale: 1/2, rotate: {y: 30}, translate: [3, 0, 0]} # a small one
  - {object: brick, translate: [0, 0, 5], rotate: {y: 90}}
";
    let page = Page::of(text);
    let frame = |map: usize| page.panel("scene")["maps"][map]["frame"].clone();
    assert!(
        near(&frame(0), &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]),
        "{}",
        frame(0)
    );
    let (after, _) = page.pull("scene", [0.0, 0.0], [-2.0, 0.0]);
    assert!(
        after.contains("  - {object: tower, translate: [-2, 0, 0]}\n"),
        "{after}"
    );
    page.undo();
    let (after, _) = page.pull("scene", [3.0, 0.5], [3.0, 1.0]);
    assert!(
        after.contains(
            "{object: tower, scale: 1, rotate: {y: 30}, translate: [3, 0, 0]} # a small one"
        ),
        "{after}"
    );
    page.undo();
    page.view("below");
    let (after, _) = page.pull("scene", [3.0, 0.0], [3.0, 1.0]);
    assert!(
        after.contains("translate: [3, 0, 1]} # a small one"),
        "{after}"
    );
    page.undo();
    // A turn behind a translation carries it along.
    assert!(
        near(&frame(2), &[5.0, 0.0, 5.0, -1.0, 6.0, 0.0]),
        "{}",
        frame(2)
    );
    let (after, badge) = page.pull("scene", [5.0, 0.0], [5.0, 1.0]);
    assert!(after == text && badge.contains("in this order"), "{badge}");
    // Linear transforms come before the translation.
    page.view("front");
    let (after, _) = page.pull("objects/tower", [1.0, 1.0], [0.5, 1.0]);
    assert!(
        after.contains("{object: brick, scale: 1/2, translate: [0, 1, 0]}"),
        "{after}"
    );
    page.undo();
    let (after, _) = page.pull("objects/tower", [1.0, 1.0], [0.0, 2.0]);
    assert!(
        after.contains("{object: brick, rotate: {z: 90}, translate: [0, 1, 0]}"),
        "{after}"
    );
}

#[test]
fn faces_share_their_points() {
    let page = Page::of(TILES);
    let panel = page.panel("generator");
    assert_eq!(panel["faces"].as_array().unwrap().len(), 6, "{panel}");
    // Three corners of the triangle, the middles of its sides, and the top.
    assert_eq!(panel["points"].as_array().unwrap().len(), 7, "{panel}");
    // A corner that moves makes triangles of other forms, which is refused.
    let text = page.state()["text"].clone();
    let (after, badge) = page.pull("generator", [0.5, 0.0], [0.5, 0.1]);
    assert!(text == after.as_str() && !badge.is_empty(), "{badge}");
}

#[test]
fn what_is_designed_in_its_text_has_its_figure() {
    for (name, why) in [
        ("hilbert-lsystem", "files of this kind"),
        ("bush-in-space", "files of this kind"),
    ] {
        let page = Page::named(name);
        let said = page.state()["design"]["why"].as_str().unwrap().to_owned();
        assert!(said.contains(why), "{said}");
        let reply = page.call("GET", "/figure", &Value::Null);
        assert_eq!(reply.headers["content-type"], "image/svg+xml");
        let figure = String::from_utf8(reply.body).unwrap();
        assert!(
            figure.starts_with("<svg") && figure.trim_end().ends_with("</svg>"),
            "{name}"
        );
    }
}
