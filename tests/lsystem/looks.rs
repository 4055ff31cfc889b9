//! Colours and widths in words leave limit sets and dimensions unchanged.

use std::process::Command;

use kfrac::measure::similarity_dimension;
use kfrac::model::Model;
use proptest::prelude::*;

use super::system;

/// Angle, axiom and successor of F, for systems that rewrite edges.
const EDGES: [[&str; 3]; 4] = [
    ["60", "F--F--F", "F+F--F+F"],
    ["90", "F", "F+F-F-FF+F+F-F"],
    ["25", "F", "F[+F]F"],
    ["60", "FfF", "FfF"],
];

fn text([angle, axiom, word]: [&str; 3]) -> String {
    format!("angle: {angle}\naxiom: \"{axiom}\"\nproductions: {{F: \"{word}\", f: fff}}\n")
}

/// Returns the bounds of the limit set, and the dimension.
fn limit(text: &str) -> [f64; 5] {
    let graph = Model::LSystem(system(text)).of_limit().compile(64).unwrap();
    let bounds = graph.limit_bounds().expect(text);
    let [min, max] = [bounds.min(), bounds.max()];
    let dimension = similarity_dimension(&graph).value.expect(text);
    [min.x, min.y, max.x, max.y, dimension]
}

/// Inserts modules that change the appearance between the modules of a word.
fn adorned(word: &str, looks: &[&str]) -> String {
    let mut looks = looks.iter().cycle();
    let module = |module: char| format!("{}{module}", looks.next().unwrap());
    word.chars().map(module).collect()
}

proptest! {
    #![proptest_config(crate::common::cases(48))]

    #[test]
    fn limit_sets_have_no_looks(
        number in 0..EDGES.len(),
        looks in prop::collection::vec(
            prop::sample::select(vec!["", "", "", "", "'", "'(2)", "!", "!(0.7)", "!(1.5)", "!(0)"]),
            1..12,
        ),
        both in any::<bool>(),
    ) {
        let [angle, axiom, word] = EDGES[number];
        let adorned_word = if both { adorned(word, &looks) } else { word.into() };
        let with = text([angle, &adorned(axiom, &looks), &adorned_word]);
        let [found, known] = [&with, &text(EDGES[number])].map(|it| limit(it));
        for (found, known) in found.iter().zip(known) {
            prop_assert!((found - known).abs() < 1e-12, "{found} is not {known}: {with}");
        }
    }
}

#[test]
fn commands_tell_the_limit_sets_of_words_with_looks() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, [axiom, word]: [&str; 2]| {
        let text = text(["60", axiom, word]);
        let file = folder.path().join(name);
        std::fs::write(&file, format!("kind: lsystem\nparams: {{w: 1}}\n{text}")).unwrap();
        file.to_str().unwrap().to_owned()
    };
    let told = |arguments: &[&str]| -> serde_json::Value {
        let mut kfrac = Command::new(assert_cmd::cargo::cargo_bin("kfrac"));
        let output = kfrac.args(arguments).arg("--json").output().unwrap();
        assert!(output.status.success(), "{output:?}");
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let plain = file("plain.yaml", ["F--F--F", "F+F--F+F"]);
    let known = told(&["info", &plain]);
    assert!(known["limit_bounds"].is_object() && known["dimension"]["hausdorff"].is_object());
    // The colours of one of the systems change at every step.
    for looks in [
        ["'(1)F--!(w)F--F", "F+F--F+F"],
        ["F--F--F", "F'+F--!(w)F+F"],
    ] {
        let file = file("looks.yaml", looks);
        let info = told(&["info", &file]);
        assert_eq!(info["limit_bounds"], known["limit_bounds"], "{looks:?}");
        assert_eq!(info["dimension"], known["dimension"], "{looks:?}");
        let dimensions = told(&["dim", &file, "--set", "w=1..2", "--samples", "2"]);
        for sample in dimensions["samples"].as_array().unwrap() {
            let similarity = &known["dimension"]["similarity"];
            for dimension in ["similarity", "hausdorff"] {
                let apart = sample[dimension].as_f64().unwrap() - similarity.as_f64().unwrap();
                assert!(apart.abs() < 1e-14, "{looks:?}: {apart}");
            }
        }
        let compared = told(&["compare", &plain, &file, "--tolerance", "0.1"]);
        assert_eq!(compared["same"], true, "{looks:?}");
    }
}
