//! Fuzzing of edits of YAML: a value of a text is set, removed, renamed, or joined by others.
//!
//! Checks that a new text is read, that a value that was set has the value, that setting the old one again gives the
//! values of the old text, and that a refusal is of bounded length.

#![no_main]

mod mutate;
mod random;

use kfrac::diagnostic::Source;
use kfrac::document::node::{Node, Value};
use kfrac::edit::{Edit, PathStep, edit, find};
use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use mutate::mutated;
use random::Random;

const VALUES: [&str; 8] = [
    "1/3",
    "-7",
    "[0, 1/2]",
    "{to: [1, 0], direction: 2}",
    "\"uniform(-20, 20)\"",
    "true",
    "a word # of it",
    "|\n  a block\n  of lines\n",
];

fuzz_target!(|bytes: &[u8]| {
    let Some((choice, text)) = bytes.split_first_chunk::<4>() else {
        return;
    };
    let Ok(source) = Source::read("fuzz.yaml", text.to_vec()) else {
        return;
    };
    let text = source.text();
    let Ok(node) = Node::parse(&source) else {
        return;
    };
    let mut random = Random::new(u32::from_le_bytes(*choice));
    let at = place(&node, &mut random);
    let value = VALUES[random.below(VALUES.len())];
    let edits = match random.below(5) {
        0 => Edit::remove(at.clone()),
        1 => Edit::rename(at.clone(), "another key"),
        2 => Edit::insert(at.clone(), random.below(4), value),
        3 => Edit::add(at.clone(), "a new key", value),
        _ => Edit::set(at.clone(), value),
    };
    let new = match edit(text, &[edits.clone()]) {
        Ok(new) => new,
        Err(error) => {
            assert!(error.to_string().len() < 1 << 16, "too much is said");
            return;
        }
    };
    let read = parse(&new);
    if let Edit::Set { .. } = edits {
        let set = find(&read, &at).expect("the value was set");
        assert!(set.same_value(&parse(value)), "{text}\n---\n{new}");
        let old = find(&node, &at).expect("the value was there");
        let (Value::Number(_) | Value::Bool(_)) = old.value else {
            return;
        };
        let written = &text[old.place.range()];
        if let Ok(again) = edit(&new, &[Edit::set(at, written)]) {
            assert!(
                parse(&again).same_value(&node),
                "{text}\n---\n{new}\n---\n{again}"
            );
        }
    }
});

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    let mut random = Random::new(seed);
    let text = data[..size].split_first_chunk::<4>();
    match text.and_then(|(_, text)| str::from_utf8(text).ok()) {
        Some(text) if random.below(3) > 0 => {
            let text = mutated(text, &mut random);
            let size = (4 + text.len()).min(max_size);
            data[..4].copy_from_slice(&seed.to_le_bytes());
            data[4..size].copy_from_slice(&text.as_bytes()[..size - 4]);
            size
        }
        _ => fuzzer_mutate(data, size, max_size),
    }
});

fn parse(text: &str) -> Node {
    Node::parse(&Source::new("a", text)).unwrap_or_else(|errors| panic!("{errors}\n{text}"))
}

/// Returns the steps to a value of a node.
fn place(node: &Node, random: &mut Random) -> Vec<PathStep> {
    let mut at = Vec::new();
    let mut node = node;
    loop {
        let (step, next) = match &node.value {
            Value::Sequence(items) if !items.is_empty() && random.below(6) > 0 => {
                let item = random.below(items.len());
                (PathStep::Item(item), &items[item])
            }
            Value::Mapping(entries) if !entries.is_empty() && random.below(6) > 0 => {
                let (key, node) = &entries[random.below(entries.len())];
                (PathStep::Key(key.name.clone()), node)
            }
            _ => return at,
        };
        at.push(step);
        node = next;
    }
}
