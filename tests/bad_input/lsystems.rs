//! L-systems whose sizes are refused, or reported, before the work that they would take.

use std::fs;

use super::hostile::{Outcome, kfrac, refused};

/// Runs the program on a file that holds an L-system.
fn run(text: &str, arguments: &[&str]) -> Outcome {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("many.yaml"), text).unwrap();
    kfrac(folder.path(), arguments)
}

const CHECK: [&str; 2] = ["check", "many.yaml"];
const INFO: [&str; 2] = ["info", "many.yaml"];

/// Returns a system of a word of one symbol that has many actions.
fn many_actions(modules: usize, actions: usize) -> String {
    let word = "X".repeat(modules);
    let turns = "{turn: 7}, ".repeat(actions - 1);
    format!(
        "kind: lsystem\naxiom: {word}\nproductions: {{F: F+F}}\nsymbols: {{X: [{turns}draw]}}\nsteps: 1\n"
    )
}

#[test]
fn actions_are_counted_with_their_modules() {
    let message = "the modules up to here have more than 100,000 actions together";
    refused(many_actions(1_000, 101).as_bytes(), message);
    refused(many_actions(2, 50_001).as_bytes(), message);
    let outcome = run(&many_actions(999, 100), &CHECK);
    assert_eq!(outcome.status, Some(0), "{}", outcome.said);
    // The message has the place of the first module that is one too many.
    let outcome = run(&many_actions(1_000, 101), &CHECK);
    assert!(outcome.said.contains(":2:998"), "{}", outcome.said);
}

/// Each number of arguments makes another symbol of the same actions.
#[test]
fn symbols_of_many_arguments_share_their_actions() {
    let turns = "{turn: 7}, ".repeat(20_000);
    let mut word = String::from("F");
    for arguments in 1..200 {
        word += &format!("X({})", vec!["1"; arguments].join(","));
    }
    let text = format!(
        "kind: lsystem\naxiom: {word}\nproductions: {{F: F+F}}\nsymbols: {{X: [{turns}draw]}}\n"
    );
    refused(text.as_bytes(), "more than 100,000 actions together");
}

#[test]
fn steps_times_words_are_counted_before_they_are_read() {
    let mut word = String::new();
    for number in 0..50_000u32 {
        word +=
            ["F", "+", "F", "-", "F", "F"][(number.wrapping_mul(2_654_435_761) >> 16) as usize % 6];
    }
    let text =
        format!("kind: lsystem\nangle: 60\naxiom: F\nproductions:\n  F: \"{word}\"\nsteps: 1000\n");
    let message = "1000 steps need a graph of 50,00";
    let outcome = run(&text, &INFO);
    assert_eq!(outcome.status, Some(1));
    assert!(outcome.said.contains(message), "{}", outcome.said);
    assert!(
        outcome.said.contains("step 1 is the deepest"),
        "{}",
        outcome.said
    );
    // The file is right, and the number of steps is warned of at its place.
    let outcome = run(&text, &CHECK);
    assert_eq!(outcome.status, Some(0), "{}", outcome.said);
    assert!(outcome.said.contains(message), "{}", outcome.said);
    assert!(
        outcome.said.contains("steps: 41, or fewer symbols"),
        "{}",
        outcome.said
    );
}

#[test]
fn steps_times_symbols_are_counted_before_they_are_read() {
    let symbol = |number: u32| char::from_u32(0x4e00 + number % 3_000).unwrap();
    let mut text = String::from("kind: lsystem\naxiom: 一\nsteps: 200\nproductions:\n");
    for number in 0..3_000 {
        let [next, other] = [1, 2].map(|by| symbol(number * 2 + by));
        text += &format!("  {}: \"F+({number}){next}F{other}\"\n", symbol(number));
    }
    let outcome = run(&text, &INFO);
    assert_eq!(outcome.status, Some(1));
    let message = "200 steps need a graph of";
    assert!(outcome.said.contains(message), "{}", outcome.said);
    let outcome = run(&text.replace("steps: 200", "steps: 8"), &INFO);
    assert_eq!(outcome.status, Some(0), "{}", outcome.said);
}

/// Words that are too long at step 0 already have the graph of their axiom.
#[test]
fn long_axioms_are_no_mistake() {
    let text = format!(
        "kind: lsystem\naxiom: {}\nproductions: {{X: 'F[+X]X'}}\nsteps: 40\n",
        "X".repeat(60_000)
    );
    let outcome = run(&text, &CHECK);
    assert_eq!(outcome.status, Some(0), "{}", outcome.said);
    assert!(
        outcome.said.contains("40 steps need a graph of 2,460,"),
        "{}",
        outcome.said
    );
}
