//! Random rules, as YAML in the form that users write.

use std::fmt::Write;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

/// Features that a random rule may have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Features {
    /// Random functions and selection by weight.
    pub draws: bool,
    /// Conditions on the index that cannot be resolved.
    pub free_index: bool,
    /// Seed parts.
    pub seeds: bool,
}

#[allow(dead_code, reason = "each test file uses its share")]
impl Features {
    pub(crate) const ALL: Self = Self {
        draws: true,
        free_index: true,
        seeds: true,
    };
    pub(crate) const DETERMINISTIC: Self = Self {
        draws: false,
        ..Self::ALL
    };
    pub(crate) const REGULAR: Self = Self {
        draws: false,
        free_index: false,
        seeds: true,
    };
}

/// Generates random rules.
pub(crate) fn rule(features: Features) -> impl Strategy<Value = String> {
    let initiator = (chain(1..4, None), any::<bool>());
    (initiator, vec(generator(features), 1..4)).prop_flat_map(
        move |((initiator, closed), generators)| {
            selection(features, generators.len()).prop_map(move |selection| {
                let mut text = String::from("initiator:\n");
                writeln!(
                    text,
                    "  closed: {closed}\n  elements:\n{initiator}generators:"
                )
                .unwrap();
                for (number, generator) in generators.iter().enumerate() {
                    write!(text, "  g{number}:\n{generator}").unwrap();
                }
                text.push_str(&selection);
                text
            })
        },
    )
}

/// Generates coordinates that may depend on the moment.
fn moving(features: Features) -> impl Strategy<Value = String> {
    let free = if features.free_index { "i/50" } else { "0" };
    let moments = [
        "",
        "",
        "",
        "",
        " + (i % 2)/9",
        " + age/20",
        " - step/30",
        " + length/7",
        free,
    ];
    (number(), 0..moments.len()).prop_map(move |(number, moment)| match moments[moment] {
        "i/50" => format!("{number} + i/50"),
        moment => format!("{number}{moment}"),
    })
}

fn number() -> impl Strategy<Value = &'static str> {
    select(&["0", "1/4", "1/3", "1/2", "-1/4", "2/3", "sqrt(3)/6", "3/4"][..])
}

fn element(features: Option<Features>) -> impl Strategy<Value = String> {
    let named = features.is_some();
    let flags = (1..5u8, any::<bool>(), 0..8u8, 0..6u8, 0..4u8);
    let x = match features {
        Some(features) => moving(features).boxed(),
        None => number().prop_map(String::from).boxed(),
    };
    (x, number(), flags, number(), number()).prop_map(
        move |(x, y, (direction, fertile, visible, connected, jump), a, b)| {
            let mut text = format!("to: [{x}, {y}], direction: {direction}");
            if jump == 0 {
                write!(text, ", from: [{a}, 2/5 + {b}]").unwrap();
            }
            if !fertile {
                text.push_str(", fertile: false");
            } else if named && jump == 1 {
                text.push_str(", use: g0");
            }
            if visible == 0 {
                text.push_str(", visible: false");
            }
            if connected == 0 {
                text.push_str(", connected: false");
            }
            format!("{{{text}}}")
        },
    )
}

/// Generates the entries of a list of elements, from (0, 0) and, for a generator, to (1, 0).
fn chain(
    count: std::ops::Range<usize>,
    features: Option<Features>,
) -> impl Strategy<Value = String> {
    let generator = features.is_some();
    let indent = if generator { "          " } else { "    " };
    (vec(element(features), count), 0..5u8, 1..5u8).prop_map(move |(elements, end, direction)| {
        let mut text = format!("{indent}- [0, 0]\n");
        for (number, element) in elements.iter().enumerate() {
            // Every point has a small offset of its own, so that no element has length 0.
            let element = element.replacen("to: [", &format!("to: [1/{} + ", number + 7), 1);
            writeln!(text, "{indent}- {element}").unwrap();
        }
        if generator && end > 0 {
            writeln!(text, "{indent}- {{to: [1, 0], direction: {direction}}}").unwrap();
        }
        text
    })
}

fn generator(features: Features) -> impl Strategy<Value = String> {
    let part = (chain(0..3, Some(features)), 0..6u8, any::<bool>());
    (vec(part, 1..3), 0..4u8).prop_map(move |(parts, draws)| {
        let mut text = String::new();
        if features.draws && draws == 0 {
            text.push_str(
                "    random:\n      tilt: uniform(-20, 20)\n      size: normal(1, 0.1)\n",
            );
            text.push_str("    move: {rotate: tilt, scale: size, about: [1/2, 1/5]}\n");
        }
        text.push_str("    parts:\n");
        for (elements, seeds, closed) in parts {
            let elements = if elements.lines().count() < 2 {
                elements + "          - [1, 0]\n"
            } else {
                elements
            };
            let seeds = match seeds {
                0 | 1 if features.seeds => format!("seeds: true\n        closed: {closed}"),
                2 if features.seeds => "seeds: true\n        placed: initiator".into(),
                _ => "connected: true".into(),
            };
            write!(text, "      - {seeds}\n        elements:\n{elements}").unwrap();
        }
        text
    })
}

fn selection(features: Features, generators: usize) -> BoxedStrategy<String> {
    let names = vec(0..generators, 1..4);
    let last = 0..generators;
    let conditions = if features.free_index {
        &[
            "i % 3 == 1",
            "odd(i)",
            "age == 1",
            "step >= 2",
            "i < 4",
            "length < 1/3",
            "i > 2 and age < 2",
        ][..]
    } else {
        &[
            "i % 3 == 1",
            "odd(i)",
            "age == 1",
            "step >= 2",
            "age % 2 == 1",
        ][..]
    };
    let by_index = names.clone().prop_map(|names| {
        let names: Vec<_> = names.iter().map(|name| format!("g{name}")).collect();
        format!("select: {{by_index: [{}]}}\n", names.join(", "))
    });
    let cases = (vec((select(conditions), 0..generators), 1..3), last).prop_map(|(cases, last)| {
        let mut text = String::from("select:\n");
        for (condition, name) in cases {
            writeln!(text, "  - {{when: {condition}, use: g{name}}}").unwrap();
        }
        writeln!(text, "  - {{use: g{last}}}").unwrap();
        text
    });
    let at_random = names.prop_map(|names| {
        let mut weights = std::collections::BTreeMap::new();
        for name in names {
            *weights.entry(name).or_insert(0) += 1;
        }
        let weights: Vec<_> = weights
            .iter()
            .map(|(name, weight)| format!("g{name}: {weight}"))
            .collect();
        format!("select: {{at_random: {{{}}}}}\n", weights.join(", "))
    });
    if features.draws {
        prop_oneof![by_index, cases, at_random].boxed()
    } else {
        prop_oneof![by_index, cases].boxed()
    }
}
