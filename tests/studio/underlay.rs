//! A picture under the figures of a design, and fits.

use super::*;

/// Sets the pixels of a square of 64 pixels in a picture of 66 that are black.
fn picture(is_black: impl Fn(usize, usize) -> bool) -> String {
    let rows = (0..66).map(|row| {
        let pixels = (0..66).map(|column| {
            let is_inside = (1..65).contains(&column) && (1..65).contains(&row);
            if is_inside && is_black(column - 1, row - 1) {
                "1"
            } else {
                "0"
            }
        });
        pixels.collect::<String>()
    });
    format!("P1\n66 66\n{}\n", rows.collect::<Vec<_>>().join("\n"))
}

/// Four quarters of that square, on the unit square.
const QUARTERS: &str = "\
kind: ifs
params: {bend: 0}
maps:
  - {scale: 1/2, rotate: 0 + bend, translate: [1/132, 1/132]} # lower left
  - {scale: 1/2, translate: [65/132, 1/132]}
  - {matrix: [[1/2, 0], [0, 1/2]], translate: [1/132, 65/132]}
  - {scale: 1/2, fixed: [65/66, 65/66]}
";

impl Page {
    fn lay(&self, name: &str, picture: &str) -> Reply {
        self.call("PUT", &format!("/underlay?name={name}"), &picture.into())
    }

    /// Fits a system to the picture, and opens it.
    fn fit(&self, asked: &Value) -> Reply {
        let fitted = self.call("POST", "/fit", asked);
        match fitted.status {
            200 => self.call("POST", "/fit/open", &json!({})),
            _ => fitted,
        }
    }

    fn collage(&self) -> Value {
        self.call("GET", "/underlay/collage", &Value::Null).json()
    }

    /// Drags in the panel of the maps; returns the text after it.
    fn drag(&self, from: [f64; 2], to: [f64; 2]) -> String {
        for (phase, [x, y]) in [("down", from), ("move", to), ("up", to)] {
            let pointer =
                json!({ "panel": "maps", "phase": phase, "x": x, "y": y, "pixel": 0.002 });
            let reply = self.call("POST", "/pointer", &json!({ "pointer": pointer }));
            assert_eq!(reply.status, 200, "{}", reply.error());
        }
        self.state()["text"].as_str().unwrap().to_owned()
    }
}

#[test]
fn a_picture_lies_under_the_maps_whose_collage_is_measured() {
    let page = Page::of(QUARTERS);
    assert_eq!(page.call("GET", "/underlay", &Value::Null).status, 422);
    assert_eq!(
        page.call("GET", "/underlay/collage", &Value::Null).status,
        422
    );
    let state = page.lay("square.pbm", &picture(|_, _| true)).json();
    let underlay = &state["underlay"];
    assert_eq!(underlay["size"], json!([66, 66]));
    assert_eq!(
        (&underlay["corner"], &underlay["width"]),
        (&json!([0.0, 0.0]), &json!(1.0))
    );
    assert_eq!(underlay["why"], Value::Null);
    // The pixels of the shape, and the picture as browsers show it, are PNGs of its size.
    for path in ["/underlay", "/underlay?ink=true"] {
        let shown = page.call("GET", path, &Value::Null);
        assert_eq!(shown.headers["content-type"], "image/png");
        let decoder = png::Decoder::new(std::io::Cursor::new(shown.body));
        assert_eq!(decoder.read_info().unwrap().info().size(), (66, 66));
    }
    let found = page.collage();
    assert_eq!(found["iou"], 1.0);
    assert!(found["distance"].as_f64().unwrap() < 0.71, "{found}");
    // The set value of a parameter counts: the first copy is turned about its corner, out of the square.
    page.draw(json!({ "look": { "set": { "bend": "90" } } }))
        .picture();
    assert!((page.collage()["iou"].as_f64().unwrap() - 0.75).abs() < 0.01);
    page.draw(json!({ "look": {} })).picture();
    // A picture elsewhere has another collage.
    let put = |corner: Value, width: f64| {
        let asked = json!({ "corner": corner, "width": width });
        page.call("POST", "/underlay/place", &asked).status
    };
    assert_eq!(put(json!([-1.0, 0.0]), 2.0), 200);
    assert!(page.collage()["iou"].as_f64().unwrap() < 0.9);
    assert_eq!(put(json!([0.0, 0.0]), 0.0), 422);
    assert_eq!(put(json!([0.0, 1e300]), 1.0), 422);
    assert_eq!(
        page.call("DELETE", "/underlay", &Value::Null).json()["underlay"],
        Value::Null
    );
}

#[test]
fn copies_of_the_picture_are_dragged() {
    let page = Page::of(QUARTERS);
    page.lay("square.pbm", &picture(|_, _| true));
    let put = json!({ "corner": [1.0, 1.0], "width": 2.0 });
    assert_eq!(page.call("POST", "/underlay/place", &put).status, 200);
    // Images of the corners [1, 1], [3, 1] and [1, 3].
    let corner = 0.5 + 1.0 / 132.0;
    let maps = &page.state()["design"]["panels"][0]["maps"];
    let frame: Vec<f64> = serde_json::from_value::<Vec<[f64; 2]>>(maps[0]["frame"].clone())
        .unwrap()
        .concat();
    let wanted = [corner, corner, corner + 1.0, corner, corner, corner + 1.0];
    assert!(
        frame.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12),
        "{frame:?}"
    );
    let far = corner + 1.0;
    // The body moves; the angle before a parameter turns, and the corner stays where it is.
    let text = page.drag([far, corner], [corner, corner + 1.0]);
    assert!(
        text.contains("{scale: 1/2, rotate: 90 + bend, translate: ["),
        "{text}"
    );
    let frame = page.state()["design"]["panels"][0]["maps"][0]["frame"].clone();
    let frame: Vec<[f64; 2]> = serde_json::from_value(frame).unwrap();
    assert!(
        (frame[0][0] - corner).abs() + (frame[0][1] - corner).abs() < 0.002,
        "{frame:?}"
    );
    assert!(
        (frame[1][0] - corner).abs() + (frame[1][1] - far).abs() < 0.002,
        "{frame:?}"
    );
    page.call("POST", "/undo", &json!({}));
    let text = page.drag([corner, corner], [corner + 0.25, corner]);
    assert!(
        text.contains("rotate: 0 + bend, translate: [0.2576, 1/132]}"),
        "{text}"
    );
    page.call("POST", "/undo", &json!({}));
    assert_eq!(page.state()["text"], QUARTERS);
}

#[test]
fn a_picture_is_fitted() {
    let page = Page::of(TREE);
    let asked = json!({ "maps": [3, 3], "method": "auto" });
    assert_eq!(
        page.call("POST", "/fit", &asked).status,
        422,
        "there is no picture"
    );
    // Sierpinski's gasket of right angles.
    let state = page
        .lay(
            "gasket.pbm",
            &picture(|column, row| column & (63 - row) == 0),
        )
        .json();
    assert_eq!(state["underlay"]["corner"], json!([0.0, -0.5]));
    let state = page.fit(&asked).json();
    let text = state["text"].as_str().unwrap();
    assert!(
        text.contains("title: \"Fit of gasket.pbm\"") && text.matches("weight: ").count() == 3,
        "{text}"
    );
    assert_eq!(
        (&state["path"], &state["name"]),
        (&Value::Null, &json!("gasket"))
    );
    // The picture lies where the text has its view.
    let width = state["underlay"]["width"].as_f64().unwrap();
    assert!(
        text.contains(&format!("{width}, {width}], margin: 0")),
        "{text}"
    );
    assert!(page.collage()["iou"].as_f64().unwrap() > 0.9);
    assert_eq!(page.call("POST", "/undo", &json!({})).json()["text"], TREE);
    // A fitted system waits for the page that asked for it, and is opened once.
    let mut of_tab = asked.clone();
    of_tab["tab"] = "a".into();
    assert_eq!(page.call("POST", "/fit", &of_tab).status, 200);
    assert_eq!(page.state()["text"], TREE);
    for (tab, status) in [("b", 410), ("a", 200), ("a", 410)] {
        let open = page.call("POST", "/fit/open", &json!({ "tab": tab }));
        assert_eq!(open.status, status, "{tab}");
    }
    page.call("POST", "/undo", &json!({}));
    for (key, wrong) in [
        ("maps", json!([1, 3])),
        ("maps", json!([3, 2])),
        ("method", json!("magic")),
        ("disks", json!(1000)),
    ] {
        let mut asked = asked.clone();
        asked[key] = wrong;
        assert_eq!(page.call("POST", "/fit", &asked).status, 422, "{asked}");
    }
}

#[test]
fn a_fit_is_ended_with_the_best_so_far() {
    let page = Page::of(TREE);
    // Noise has no good fit, and methods look at it for long.
    let noise = |column: usize, row: usize| (column * 7919 + row * 104_729) % 31 < 9;
    page.lay("noise.pbm", &picture(noise));
    let progress = || page.call("GET", "/fit", &Value::Null).json();
    assert_eq!(progress()["evaluated"], Value::Null);
    let asked = json!({ "maps": [2, 32], "method": "collage" });
    let text = thread::scope(|scope| {
        let fit = scope.spawn(|| page.fit(&asked));
        until("a system is found", || {
            progress()["best"]["iou"].is_number()
        });
        assert_eq!(page.call("DELETE", "/fit", &Value::Null).status, 200);
        let reply = fit.join().unwrap();
        assert_eq!(reply.status, 200, "{}", reply.error());
        reply.json()["text"].as_str().unwrap().to_owned()
    });
    assert!(text.contains("kind: ifs"), "{text}");
    assert_eq!(progress()["evaluated"], Value::Null);
}

#[test]
fn pictures_without_a_shape_lie_under_designs_and_are_not_fitted() {
    let page = Page::of(TREE);
    let state = page.lay("white.pbm", &picture(|_, _| false)).json();
    let why = state["underlay"]["why"].as_str().unwrap();
    assert!(why.contains("no pixel is dark"), "{why}");
    let asked = json!({ "maps": [2, 8], "method": "auto" });
    assert_eq!(page.call("POST", "/fit", &asked).error(), why);
    // Trees have no collage.
    assert_eq!(page.collage(), json!({}));
    for wrong in ["", "P1\n3 3\n1", "<svg/>"] {
        let reply = page.lay("wrong.png", wrong);
        assert_eq!(reply.status, 422, "{wrong}");
        assert!(!reply.error().is_empty());
    }
    assert_eq!(
        page.state()["underlay"]["name"],
        "white.pbm",
        "the last picture stays"
    );
    let window = &page.state()["design"]["panels"][1]["window"];
    assert!(
        window[0].as_f64().unwrap() < 0.0 && window[3].as_f64().unwrap() > 0.5,
        "{window}"
    );
}
