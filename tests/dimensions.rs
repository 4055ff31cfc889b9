//! Similarity dimensions of graphs with several objects, against values derived by hand.

use crate::common;
use kfrac::measure::{Similarity, similarity_dimension};

fn dimension(text: &str) -> Similarity {
    let document = common::document_of(text);
    let (model, _) = document.resolve(&[]).unwrap();
    similarity_dimension(&model.compile(3).unwrap())
}

fn value(text: &str) -> f64 {
    dimension(text).value.unwrap()
}

#[test]
fn what_leads_nowhere_does_not_count() {
    let text = "initiator: segment\ngenerators:\n  grow: [[0, 0], [1/3, 0], {from: [1/3, 0], to: [2/3, 0]}, \
                {to: [1, 0], use: leaf}]\n  leaf: [[0, 0], {to: [1, 0], fertile: false}]\nselect: [{use: grow}]\n";
    assert!((value(text) - 2f64.ln() / 3f64.ln()).abs() < 1e-12);
    let dead = "initiator: segment\ngenerators:\n  a: [[0, 0], {to: [0.2, 0], use: b}, {to: [0.7, 0], use: b}]\n  \
                b: [[0, 0], {to: [1/2, 0], fertile: false}]\nselect: [{use: a}]\n";
    assert_eq!(dimension(dead).note.unwrap(), "nothing stays fertile");
}

#[test]
fn the_largest_part_decides_also_where_parts_are_alike() {
    // Two parts of dimension 1, one leading to the other.
    let alike = "initiator: segment\ngenerators:\n  a: [[0, 0], [1/2, 0], [1, 0], {from: [0, 0], to: [0, 1/3], \
                 use: b}]\n  b: [[0, 0], {to: [1/2, 0], use: b}, {to: [1, 0], use: b}]\nselect: [{use: a}]\n";
    assert!((value(alike) - 1.0).abs() < 1e-12);
    let points = "initiator: segment\ngenerators:\n  a: [[0, 0], [1/2, 0], {to: [1, 0], use: b}]\n  \
                  b: [[0, 0], {to: [1/2, 0], use: b}]\nselect: [{use: a}]\n";
    assert_eq!(value(points), 0.0);
}

/// The dimension is the root of det(I − M(D)) = 0 for a 2 × 2 matrix, by bisection on its largest eigenvalue.
#[test]
fn two_objects_have_the_root_of_their_determinant() {
    let text = "initiator: segment\ngenerators:\n  a: [[0, 0], {to: [1/2, 1/5], use: b}, {to: [1, 0], use: a}]\n  \
                b: [[0, 0], {to: [1/3, 0], use: b}, {to: [1/2, 0], use: a}, {to: [1, 0], use: b}]\n\
                select: [{use: a}]\n";
    let side = (0.25f64 + 0.04).sqrt();
    let excess = |d: f64| {
        let [[p, q], [r, s]] = [
            [side.powf(d), side.powf(d)],
            [
                (1.0 / 6.0f64).powf(d),
                (1.0 / 3.0f64).powf(d) + 0.5f64.powf(d),
            ],
        ];
        (p + s) / 2.0 + (((p - s) / 2.0).powi(2) + q * r).sqrt() - 1.0
    };
    let (mut low, mut high) = (0.5, 3.0);
    for _ in 0..100 {
        let middle = f64::midpoint(low, high);
        if excess(middle) > 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    assert!((value(text) - low).abs() < 1e-12, "{} {low}", value(text));
}

#[test]
fn a_long_cycle_of_generators_is_one_object_after_another() {
    // g0 has three copies of ratio 1/3; each of the 99 others has one of ratio 1/2.
    let mut text =
        String::from("initiator: {elements: [[0, 0], {to: [1, 0], use: g0}]}\ngenerators:\n");
    text.push_str(
        "  g0: [[0, 0], {to: [1/3, 0], use: g1}, {to: [2/3, 0], use: g1}, {to: [1, 0], use: g1}]\n",
    );
    for number in 1..100 {
        text.push_str(&format!(
            "  g{number}: [[0, 0], {{to: [1/2, 0], use: g{}}}]\n",
            (number + 1) % 100
        ));
    }
    let expected = 3f64.ln() / (3f64.ln() + 99.0 * 2f64.ln());
    assert!(
        (value(&text) - expected).abs() < 1e-12,
        "{} {expected}",
        value(&text)
    );
}

/// Runs `kfrac dim` in JSON with arguments.
fn dim(arguments: &[&str]) -> serde_json::Value {
    let mut command = assert_cmd::Command::cargo_bin("kfrac").unwrap();
    let output = command
        .arg("dim")
        .args(arguments)
        .arg("--json")
        .output()
        .unwrap();
    assert!(output.status.success(), "{arguments:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn exact_dimensions_alone_are_those_beside_measurements() {
    for name in [
        "koch",
        "twindragon-ifs",
        "menger",
        "barnsley-fern",
        "random-tree",
    ] {
        let alone = dim(&[name, "--exact"]);
        let all = dim(&[name, "--grids", "1", "--orders", "0,2"]);
        for key in [
            "similarity",
            "affinity",
            "hausdorff",
            "boundary",
            "contact",
            "box",
            "drawn",
            "notes",
        ] {
            assert_eq!(alone[key], all[key], "{name} {key}");
        }
        assert_eq!(
            alone["box_counting"]["boxes"],
            serde_json::json!([]),
            "{name}"
        );
        assert!(alone["warnings"].as_array().unwrap().is_empty(), "{name}");
    }
    // Copies of equal sizes that do not overlap: every D_q is the similarity dimension.
    let koch = dim(&["koch", "--exact", "--orders", "-2,1,5"]);
    for row in koch["spectrum"].as_array().unwrap() {
        let exact = row["exact"].as_f64().unwrap();
        assert!((exact - 4f64.ln() / 3f64.ln()).abs() < 1e-12, "{row}");
        assert!(row["value"].is_null());
    }
}

/// Options that have no effect on an input are refused.
#[test]
fn options_have_inputs_on_which_they_have_an_effect() {
    let points = "x,y\n0,0\n1,1\n2,0\n";
    let picture = "P1\n3 2\n1 0 1\n0 1 0\n";
    let rule = "kind: ifs\nmaps: [{scale: 1/2}, {scale: 1/2, translate: [1, 0]}]\n";
    let cases: [(&str, &[&str], &str); 6] = [
        (points, &["--exact"], "--exact is for rules"),
        (points, &["--threshold", "9"], "--threshold is for pictures"),
        (picture, &["--steps", "3"], "--steps is for rules"),
        (picture, &["--columns", "x,y"], "--columns is for tables"),
        (rule, &["--invert"], "and for rules with --steps"),
        (rule, &["--columns", "x,y"], "--columns is for tables"),
    ];
    for (input, options, message) in cases {
        let mut command = assert_cmd::Command::cargo_bin("kfrac").unwrap();
        command.args(["dim", "-"]).args(options);
        let run = command.write_stdin(input).assert().code(2);
        let messages = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        assert!(messages.contains(message), "{options:?}: {messages}");
    }
}

/// Approximants as they are drawn have the dimension of their limit within three standard errors, where copies do not
/// overlap and all elements of a step are equally long.
#[test]
fn drawn_approximants_have_the_dimension_of_their_limit() {
    let cases = [
        ("koch", "7", 4f64.ln() / 3f64.ln()),
        ("gasket-recursive", "8", 3f64.ln() / 2f64.ln()),
        ("vicsek", "5", 5f64.ln() / 3f64.ln()),
        ("hilbert", "7", 2.0),
        // The island is filled.
        ("quadric-koch", "4", 2.0),
        ("terdragon", "10", 2.0),
        ("sierpinski-arrowhead", "9", 3f64.ln() / 2f64.ln()),
        ("koch-lsystem", "6", 4f64.ln() / 3f64.ln()),
    ];
    for (name, steps, expected) in cases {
        let counted = &dim(&[name, "--steps", steps, "--orders", "2"])["box_counting"];
        let [value, error] = ["value", "std_error"].map(|key| counted[key].as_f64().unwrap());
        assert!(
            (value - expected).abs() <= 3.0 * error && error < 0.12,
            "{name}: {value} ± {error}, {expected}"
        );
        let set = counted["set"].as_str().unwrap();
        assert!(
            set.starts_with(&format!("approximant {steps} as it is drawn, ")),
            "{set}"
        );
    }
    // Sizes are in the units of the file: a curve three times as large has boxes three times as large.
    let [one, three] = ["1", "3"].map(|side| {
        let text = format!(
            "initiator: [[0, 0], [{side}, 0]]\ngenerator: [[0, 0], [1/3, 0], [1/2, sqrt(3)/6], [2/3, 0], [1, 0]]\n"
        );
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("curve.yaml");
        std::fs::write(&path, text).unwrap();
        let counted = dim(&[path.to_str().unwrap(), "--steps", "5"]);
        counted["box_counting"]["boxes"][0]["size"].as_f64().unwrap()
    });
    assert!((three / one - 3.0).abs() < 1e-6, "{one} {three}");
}

/// A curve with sides drawn at random has the dimension of the Koch curve, whatever the draws (Falconer 1990, example 15.2).
#[test]
fn seeds_have_a_mean_and_a_deviation() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("coast.yaml");
    let text = "initiator: segment\ngenerator:\n  random: {side: \"choice(-1, 1)\"}\n  \
                elements: [[0, 0], [1/3, 0], [1/2, \"side*sqrt(3)/6\"], [2/3, 0], [1, 0]]\n";
    std::fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap();
    let result = dim(&[path, "--steps", "7", "--seeds", "6", "--orders", "2"]);
    let draws = result["draws"].as_array().unwrap();
    let values: Vec<f64> = draws
        .iter()
        .map(|draw| draw["value"].as_f64().unwrap())
        .collect();
    assert_eq!(values.len(), 6);
    let mean = values.iter().sum::<f64>() / 6.0;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let spread = &result["box_counting"];
    let number = |key: &str| spread[key].as_f64().unwrap();
    assert!((number("mean") - mean).abs() < 1e-12);
    assert!((number("deviation") - (squares / 5.0).sqrt()).abs() < 1e-12);
    assert!((number("std_error") - (squares / 30.0).sqrt()).abs() < 1e-12);
    assert!(number("deviation") > 0.0);
    // One seed on its own is the first of several.
    let alone = dim(&[path, "--steps", "7", "--seed", "3", "--orders", "2"]);
    assert_eq!(alone["box_counting"]["value"], draws[3]["value"]);
    // Nothing is drawn at random.
    let same = dim(&["koch", "--steps", "4", "--seeds", "2", "--orders", "2"]);
    assert!(
        same["warnings"]
            .to_string()
            .contains("all seeds give the same counts")
    );
}

#[test]
fn rules_without_a_limit_set_are_measured_as_they_are_drawn() {
    let nothing = dim(&["vegetation"]);
    assert!(nothing["box_counting"]["value"].is_null());
    assert!(
        nothing["warnings"]
            .to_string()
            .contains("--steps N measures an approximant")
    );
    let drawn = dim(&["vegetation", "--steps", "6"]);
    assert!(drawn["box_counting"]["value"].as_f64().is_some());
    let mut command = assert_cmd::Command::cargo_bin("kfrac").unwrap();
    let run = command
        .args(["dim", "menger", "--steps", "2"])
        .assert()
        .code(2);
    let message = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    assert!(message.contains("drawings of the plane"), "{message}");
}
