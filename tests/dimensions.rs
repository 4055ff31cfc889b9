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

#[test]
fn exact_dimensions_are_those_of_rules() {
    let mut command = assert_cmd::Command::cargo_bin("kfrac").unwrap();
    let points = "x,y\n0,0\n1,1\n2,0\n";
    let run = command
        .args(["dim", "-", "--exact"])
        .write_stdin(points)
        .assert()
        .code(2);
    let messages = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    assert!(
        messages.contains("--exact computes the dimensions of rules"),
        "{messages}"
    );
}
