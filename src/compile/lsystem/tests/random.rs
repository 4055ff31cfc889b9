//! Compares compiled graphs with derived words for random L-systems.

use proptest::prelude::*;

use crate::compile::lsystem::effects::Effects;
use crate::geometry::Frame2;
use crate::graph::Graph;

use super::{assert_reported, assert_same, system};

/// Words of letters, turns, scalings, reflections and stroke attributes, with balanced brackets.
fn word(drawn: bool) -> impl Strategy<Value = String> {
    let letters = "ABFGf+-+-|RSsWCL"
        .chars()
        .map(String::from)
        .collect::<Vec<_>>();
    let module = prop_oneof![
        6 => prop::sample::select(letters),
        1 => Just("F(2/3)".to_owned()),
        1 => Just("P(1)".to_owned()),
        1 => Just("~(triangle, 1/2)".to_owned()),
    ];
    let inner = prop::collection::vec(module, 0..6).prop_map(|all| all.concat());
    let bracketed = prop_oneof![
        4 => inner.clone(),
        2 => inner.clone().prop_map(|word| format!("[{word}]")),
        1 => inner.prop_map(move |word| {
            // The vertices of a filled polygon may not depend on draws.
            let word = if drawn { word.replace(['A', 'B', 'F', 'P'], "G") } else { word };
            format!("{{.{}+f.}}", word.replace("(1)", "").replace("(2/3)", ""))
        }),
    ];
    prop::collection::vec(bracketed, 1..5).prop_map(|all| all.concat())
}

/// Systems with two replaced letters, a drawing one and one with an argument; deterministic or random.
fn text(drawn: bool) -> impl Strategy<Value = String> {
    let angles = prop::sample::select(vec!["60", "90", "25.7", "360/7", "17.3", "120"]);
    let words = prop::collection::vec(word(drawn), if drawn { 8 } else { 5 });
    (angles, words).prop_map(move |(angle, words)| {
        let mut text = format!(
            "angle: {angle}\nheading: 10\naxiom: '{}'\nsymbols:\n  G: draw\n  R: reflect\n  \
             S: {{scale: 2/3}}\n  s: {{scale: 3/2}}\n  W: {{width: 0.8}}\n  C: {{shift_colour: 1}}\n  L: {{stamp: flake, scale: 0.4}}\nstamps: {{flake: {{fractal: koch, steps: 1}}}}\n\
             productions:\n",
            if drawn { "[A][B]".into() } else { format!("A[B]{}", words[0]) }
        );
        let mut weight = if drawn { ", weight: 2" } else { "" };
        for (number, word) in words[1..].iter().enumerate() {
            let symbol = ["A", "B", "F", "P(n) : n > 1/5", "A", "B", "A"][number];
            let more = if number == 3 { "P(n/2)" } else { "" };
            // A random width or colour cannot be compiled.
            let word = if drawn {
                word.replace(['W', 'C', 'S', 's'], "-")
            } else {
                word.clone()
            };
            text += &format!("- {{production: '{symbol} -> {word}{more}'{weight}}}\n");
            if number == 4 {
                weight = ", weight: 1";
            }
        }
        text
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn systems_draw_what_their_words_draw(text in text(false)) {
        let system = system(&text);
        let effects = Effects::<Frame2>::of_system(&system, 4).unwrap();
        let graph = Graph::of_levels(effects, 4).unwrap();
        for steps in 0..=4 {
            if Graph::of_derived_word(&system, steps, 0, 2_000).is_ok() {
                assert_same(&text, &graph, &system, steps, 0);
                assert_reported(&graph, steps);
            }
        }
    }

    #[test]
    fn drawn_systems_do_so_too(text in text(true), seed in 0u64..100) {
        let system = system(&text);
        let Ok(graph) = Effects::<Frame2>::of_system(&system, 4)
            .and_then(|effects| Graph::of_levels(effects, 4)) else {
            return Ok(());
        };
        for steps in 0..=4 {
            if Graph::of_derived_word(&system, steps, seed, 2_000).is_ok() {
                assert_same(&text, &graph, &system, steps, seed);
            }
        }
    }
}
