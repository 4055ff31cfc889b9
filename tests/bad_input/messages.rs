//! Refusals and warnings that state what is wrong, and are found in little time.

use std::fmt::Write as _;
use std::fs;
use std::process::Command;

use super::hostile::{kfrac, refused};

/// Runs the program for a file; returns its status and its diagnostics.
fn run(text: &str, arguments: &[&str]) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("it.yaml"), text).unwrap();
    let outcome = kfrac(folder.path(), arguments);
    (outcome.status, outcome.said)
}

const CHECK: [&str; 2] = ["check", "it.yaml"];

#[test]
fn many_unknown_names_are_compared_in_little_time() {
    let long = "parameter".repeat(6);
    let short = "paramter".repeat(6);
    let mut text = String::from("params:\n");
    (0..15_000).for_each(|i| writeln!(text, "  {long}{i}: 1").unwrap());
    text += "initiator: segment\ngenerator:\n  - [0, 0]\n";
    (0..15_000).for_each(|i| writeln!(text, "  - [{short}{i}, 0]").unwrap());
    refused(text.as_bytes(), &format!("did you mean '{long}0'?"));
}

#[test]
fn many_missing_components_take_little_memory() {
    let generators: String = (0..100_000)
        .map(|i| format!("  g{i}: kocch{i}\n"))
        .collect();
    let text = format!("initiator: segment\ngenerators:\n{generators}");
    refused(text.as_bytes(), "did you mean 'koch'?");
}

#[test]
fn many_unknown_colours_are_refused() {
    let colours: Vec<String> = (0..100_000)
        .map(|i| format!("lightgoldenrodyelow{i}"))
        .collect();
    let text = format!(
        "initiator: segment\ngenerator: koch\nstyle:\n  palette: [{}]\n",
        colours.join(", ")
    );
    refused(text.as_bytes(), "'lightgoldenrodyelow0' is no colour");
}

#[test]
fn images_that_can_be_drawn_are_not_refused() {
    let text = |initiator: &str| {
        format!(
            "initiator: {initiator}\ngenerator: koch\nsymmetry: {{rotate: 360, mirror: true}}\nsteps: 1\n"
        )
    };
    let hundred = "[[0, 0], {for: {k: 1..100}, each: [k, k%2]}]";
    assert_eq!(run(&text(hundred), &CHECK).0, Some(0));
    // 720 images of 65,536 elements.
    let (status, said) = run(&text("{from: koch, steps: 8}"), &CHECK);
    assert_eq!(status, Some(1), "{said}");
    assert!(said.contains("more than 20,000,000 elements"), "{said}");
}

/// Returns a ring of objects, each of which is an image of the next one.
fn ring(count: usize, first: &str, other: &str) -> String {
    let mut text = String::from("kind: instancing\nobjects:\n");
    for i in 0..count {
        let transform = if i == 0 { first } else { other };
        let next = (i + 1) % count;
        writeln!(text, "  o{i}: [{{object: o{next}, {transform}}}]").unwrap();
    }
    text + "scene: [o0]\n"
}

#[test]
fn rings_of_similarities_are_decided() {
    let never = "an instancing loop does not contract";
    for count in [3, 100, 1_000, 3_000] {
        let (status, said) = run(&ring(count, "rotate: 1", "rotate: 1"), &CHECK);
        assert_eq!(status, Some(1), "{count}: {said}");
        assert!(said.contains(never), "{count}: {said}");
        // One object is smaller than the others are larger.
        let (status, said) = run(
            &ring(count, "scale: 0.5", "rotate: 1, scale: 1.0001"),
            &CHECK,
        );
        assert_eq!(
            (status, said.contains("do not decide")),
            (Some(0), false),
            "{count}: {said}"
        );
        let (status, said) = run(
            &ring(count, "scale: 0.999", "rotate: 1, scale: 1.001"),
            &CHECK,
        );
        assert_eq!(
            (status, said.contains(never)),
            (Some(1), true),
            "{count}: {said}"
        );
    }
}

#[test]
fn steps_of_a_file_are_forecast_as_far_as_may_be() {
    let text = "initiator: segment\ngenerator: koch\nsteps: 1000000\n";
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("it.yaml"), text).unwrap();
    for json in [&[][..], &["--json"]] {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("kfrac"));
        command.current_dir(folder.path()).args(["info", "it.yaml"]);
        let output = command.args(json).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{said}");
        let warning = "only 10000 of 1000000 steps are forecast";
        assert!(said.contains(warning), "{said}");
        assert!(said.contains("it.yaml:3:8"), "{said}");
    }
    let (status, said) = run(text, &["info", "it.yaml", "--steps", "10001"]);
    assert_eq!(status, Some(2), "{said}");
}

#[test]
fn elements_that_are_not_visible_are_no_lines() {
    let fractal = |last: &str| {
        format!(
            "kind: ifs\nmaps:\n  - {{scale: 0.5}}\n  - {{scale: 0.5, translate: [1, 0]}}\ncondensation:\n  \
             - {{fractal: {{initiator: segment, generator: [[0, 0], {{to: [0.4, 0.1], visible: false}}, \
             {{to: [0.6, 0.1], visible: false}}, {{to: [1, 0]{last}}}]}}, steps: 12}}\n"
        )
    };
    for last in ["", ", visible: false"] {
        let message = "have more than 100000 elements in all, with those that are not visible";
        refused(fractal(last).as_bytes(), message);
    }
}

#[test]
fn repetitions_that_yield_nothing_are_named() {
    let text = "kind: instancing\nobjects:\n  s: [{disk: {radius: 1}}]\n  \
                a: [{for: {a: 0..299, b: 0..299, c: 5..1}, object: s}]\nscene: [a]\n";
    refused(text.as_bytes(), "its `for` makes too many copies");
}

#[test]
fn lengths_that_are_not_1_are_not_rounded_to_1() {
    for (x, length) in [
        ("1", "as long"),
        ("1.0000001", "1.0000001 times as long"),
        ("1.5", "1.5 times as long"),
    ] {
        let text = format!("initiator: segment\ngenerator: [[0, 0], [{x}, 0], [1, 0]]\n");
        let (status, said) = run(&text, &CHECK);
        assert_eq!(status, Some(0), "{said}");
        assert!(said.contains(&format!("it is {length}")), "{said}");
    }
}
