//! Laws of edits, on every file of the library and on layouts that it does not have.

use std::fs;
use std::path::PathBuf;

use crate::common::Draws;
use kfrac::diagnostic::Source;
use kfrac::document::node::{Key, Node, Value};
use kfrac::edit::{Edit, EditError, PathStep, edit, find, steps};

/// Returns the texts of all files of the library.
fn library() -> Vec<(PathBuf, String)> {
    let mut folders = vec![PathBuf::from("library")];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        let mut entries: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|it| it.unwrap().path())
            .collect();
        entries.sort();
        for path in entries {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "yaml") {
                let text = fs::read_to_string(&path).unwrap();
                files.push((path, text));
            }
        }
    }
    assert!(files.len() > 170, "{}", files.len());
    files
}

fn read(text: &str) -> Node {
    Node::parse(&Source::new("a", text)).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Adds the steps to every value of a node.
fn all_steps(node: &Node, at: &mut Vec<PathStep>, found: &mut Vec<Vec<PathStep>>) {
    found.push(at.clone());
    let mut visit = |step: PathStep, node: &Node| {
        at.push(step);
        all_steps(node, at, found);
        at.pop();
    };
    match &node.value {
        Value::Sequence(items) => {
            let items = items.iter().enumerate();
            items.for_each(|(index, item)| visit(index.into(), item));
        }
        Value::Mapping(entries) => {
            let entries = entries.iter();
            entries.for_each(|(key, node)| visit(PathStep::Key(key.name.clone()), node));
        }
        _ => {}
    }
}

const VALUES: [&str; 9] = [
    "1/3",
    "0.25",
    "-7",
    "sqrt(3)/6",
    "[0, 1/2]",
    "{to: [1, 0], direction: 2}",
    "\"uniform(-20, 20)\"",
    "true",
    "a word # of it",
];

/// Returns the values after an edit, by a way of its own: the values are written, changed as paths with scalars, and
/// compared as such.
fn leaves(node: &Node, at: String, found: &mut Vec<(String, String)>) {
    match &node.value {
        Value::Sequence(items) if !items.is_empty() => {
            for (index, item) in items.iter().enumerate() {
                leaves(item, format!("{at}/#{index}"), found);
            }
        }
        Value::Mapping(entries) if !entries.is_empty() => {
            for (number, (key, node)) in entries.iter().enumerate() {
                leaves(node, format!("{at}/{number}:{}", key.name), found);
            }
        }
        value => found.push((
            at,
            format!(
                "{}{value:?}",
                if matches!(value, Value::Text(_)) {
                    "t"
                } else {
                    ""
                }
            ),
        )),
    }
}

fn leaves_of(node: &Node) -> Vec<(String, String)> {
    let mut found = Vec::new();
    leaves(node, String::new(), &mut found);
    found
}

/// Rebuilds a node with another part.
fn rebuilt(node: &Node, at: &[PathStep], change: &dyn Fn(&Node) -> Node) -> Node {
    let Some((first, rest)) = at.split_first() else {
        return change(node);
    };
    let value = match (&node.value, first) {
        (Value::Sequence(items), PathStep::Item(index)) => {
            let items = items
                .iter()
                .enumerate()
                .map(|(own, item)| match own == *index {
                    true => rebuilt(item, rest, change),
                    false => item.clone(),
                });
            Value::Sequence(items.collect())
        }
        (Value::Mapping(entries), step) => {
            let entries = entries
                .iter()
                .map(|(key, node)| match key.name == step.to_string() {
                    true => (key.clone(), rebuilt(node, rest, change)),
                    false => (key.clone(), node.clone()),
                });
            Value::Mapping(entries.collect())
        }
        _ => panic!("no such step"),
    };
    value.into()
}

/// Lengths of what two texts have in common at their start and at their end.
fn common(a: &str, b: &str) -> (usize, usize) {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let start = a.iter().zip(b).take_while(|(a, b)| a == b).count();
    let most = a.len().min(b.len()) - start;
    let ends = a.iter().rev().zip(b.iter().rev()).take(most);
    (start, ends.take_while(|(a, b)| a == b).count())
}

fn is_inserted(old: &str, new: &str) -> bool {
    let (start, end) = common(old, new);
    start + end == old.len()
}

fn is_scalar(node: &Node) -> bool {
    !matches!(node.value, Value::Sequence(_) | Value::Mapping(_))
}

#[derive(Default)]
struct Tally {
    done: usize,
    back: usize,
    refused: Vec<String>,
}

/// Edits a text, and checks the laws of what it becomes.
fn check(text: &str, node: &Node, at: &[PathStep], draws: &mut Draws, tally: &mut Tally) {
    let old = find(node, at).unwrap();
    let value = VALUES[draws.below(VALUES.len())];
    let meant = read(value);
    let list = |items: Vec<Node>| Node::from(Value::Sequence(items));
    let mapping = |entries: Vec<(Key, Node)>| Node::from(Value::Mapping(entries));
    let (asked, wanted): (Edit, Node) = match (&old.value, draws.below(3)) {
        (Value::Sequence(items), 0) => {
            let index = draws.below(items.len() + 1);
            let mut items = items.clone();
            items.insert(index, meant.clone());
            (Edit::insert(at.to_vec(), index, value), list(items))
        }
        (Value::Mapping(entries), 0) => {
            let mut entries = entries.clone();
            entries.push((Key::new("key of mine"), meant.clone()));
            (
                Edit::add(at.to_vec(), "key of mine", value),
                mapping(entries),
            )
        }
        (Value::Sequence(items), 1) if !items.is_empty() => {
            let index = draws.below(items.len());
            let mut items = items.clone();
            items.remove(index);
            let below = at.iter().cloned().chain([index.into()]).collect();
            (Edit::remove(below), list(items))
        }
        (Value::Mapping(entries), 1 | 2) if !entries.is_empty() => {
            let index = draws.below(entries.len());
            let mut entries = entries.clone();
            let key = PathStep::Key(entries[index].0.name.clone());
            let below = at.iter().cloned().chain([key]).collect();
            if draws.below(2) == 0 {
                entries.remove(index);
                (Edit::remove(below), mapping(entries))
            } else {
                entries[index].0.name = "key of mine".into();
                (Edit::rename(below, "key of mine"), mapping(entries))
            }
        }
        _ => (Edit::set(at.to_vec(), value), meant.clone()),
    };
    let new = match edit(text, std::slice::from_ref(&asked)) {
        Ok(new) => new,
        Err(EditError::Unfaithful(_)) => {
            tally
                .refused
                .push(format!("{asked:?} {:?}", old.place.text()));
            return;
        }
        Err(error) => panic!("{asked:?}: {error}\n{text}"),
    };
    tally.done += 1;
    if new == text {
        assert!(matches!(asked, Edit::Set { .. }) && old.same_value(&meant));
        return;
    }
    let wanted = rebuilt(node, at, &|_| wanted.clone());
    let result = read(&new);
    let same = match &asked {
        // The order of keys follows the old mapping.
        Edit::Set { .. } if matches!(meant.value, Value::Mapping(_)) => true,
        _ => leaves_of(&result) == leaves_of(&wanted),
    };
    assert!(same, "{asked:?}\n{text}\nbecame\n{new}");
    let (start, end) = common(text, &new);
    match &asked {
        Edit::Set { .. } if is_scalar(old) => {
            let range = old.place.range();
            let before = text[..range.start].trim_end();
            let is_block = text[before.len()..range.start].contains('\n')
                && before.ends_with(['>', '|', '-', '+']);
            let first = if is_block {
                before.len() - 2
            } else {
                range.start
            };
            assert!(
                start + 1 >= first && text.len() - end <= range.end + 1,
                "{asked:?}\n{new}"
            );
            if range.is_empty() {
                return;
            }
            // With what was written, the bytes come back.
            let own = text[range.clone()].to_owned();
            let quoted =
                range.start > 0 && ["\"", "'"].contains(&&text[range.start - 1..range.start]);
            if !quoted
                && !is_block
                && !new.contains("\"uniform(-20, 20)\"")
                && is_scalar(&meant)
                && !own.contains('\n')
            {
                // A text of several lines has no form on one line.
                if let Ok(back) = edit(&new, &[Edit::set(at.to_vec(), own)]) {
                    tally.back += 1;
                    assert_eq!(back, text, "{asked:?}");
                }
            }
        }
        Edit::Set { .. } => {}
        Edit::Rename { .. } => {
            let key = new.len() - end - start;
            assert!(key <= "\"key of mine\"".len(), "{asked:?}\n{new}");
        }
        Edit::Insert { index, .. } => {
            assert!(is_inserted(text, &new), "{asked:?}\n{text}\nbecame\n{new}");
            let below: Vec<_> = at.iter().cloned().chain([(*index).into()]).collect();
            if matches!(&old.value, Value::Sequence(items) if !items.is_empty())
                && text.ends_with('\n')
            {
                let back = edit(&new, &[Edit::remove(below)]).unwrap();
                assert_eq!(back, text, "{asked:?}\nvia\n{new}");
            }
        }
        Edit::Add { key, .. } => {
            assert!(is_inserted(text, &new), "{asked:?}\n{text}\nbecame\n{new}");
            let below = at
                .iter()
                .cloned()
                .chain([PathStep::Key(key.clone())])
                .collect();
            let back = edit(&new, &[Edit::remove(below)]).unwrap();
            assert_eq!(back, text, "{asked:?}\nvia\n{new}");
        }
        Edit::Remove { at } => {
            let comments = |text: &str| text.matches(" #").count();
            let gone = find(node, at).unwrap().place.range();
            let line = text[gone.end..].lines().next().unwrap_or_default();
            // A comment beside the key of a block goes with it.
            let before = text[..gone.start].trim_end_matches([' ', '\n', '-']);
            let beside = before.lines().next_back().unwrap_or_default();
            let own = comments(beside) + comments(&text[gone.clone()]) + comments(line);
            assert!(
                comments(&new) + own >= comments(text),
                "{asked:?}\n{text}\nbecame\n{new}"
            );
        }
        other => panic!("{other:?} is not among the edits"),
    }
}

#[test]
fn edits_of_the_library_are_what_they_state_and_nothing_else() {
    let mut draws = Draws(1);
    let mut tally = Tally::default();
    for (path, text) in library() {
        let mut text = text;
        // Files whose lines end as on other systems, too.
        if draws.below(3) == 0 {
            text = text.replace('\n', "\r\n");
        }
        if draws.below(6) == 0 {
            text.truncate(text.trim_end().len());
        }
        let node = read(&text);
        let mut all = Vec::new();
        all_steps(&node, &mut Vec::new(), &mut all);
        let many = if text.len() > 20_000 { 4 } else { 40 };
        for _ in 0..many {
            let at = &all[draws.below(all.len())];
            check(&text, &node, at, &mut draws, &mut tally);
        }
        assert!(tally.done > 0, "{}", path.display());
    }
    let refused = tally.refused.len();
    assert!(tally.back > 500, "{} values came back", tally.back);
    assert!(
        refused * 50 < tally.done,
        "{} done, refused:\n{}",
        tally.done,
        tally.refused.join("\n")
    );
}

#[test]
fn edits_of_other_layouts_are_what_they_state() {
    let layouts = [
        "{\"title\": \"A\", \"generator\": [[0, 0], [\"1/3\", 0], {\"to\": [1, 0], \"fertile\": false}]}\n",
        "{\n  \"steps\": 3,\n  \"generator\": [\n    [0, 0],\n    [1, 0]\n  ]\n}",
        "- - 1 # one\n  - 2\n- a: 1\n  b: 2 # two\n  c: 3\n-   - x\n    - y\n",
        "a:\n- 1\n- 2   # two\n\n# between\n- 3\nb: {c: [1, 2], d: 'it''s'} # end",
        "points: [ [0, 0],  # first\n  [1, 0] # last\n  ]\r\nabout: >\r\n  some words\r\n  and more\r\nc: |-\r\n  x\r\n",
        "- - 1/2\n  - >-\n    cos +\n    sin\n- - |\n    a\n  - >-\n    b\n    c",
        "\u{feff}a: [1, 2, 3,]\nb:\nc: ~\nd: \"\"\n",
        "a: &x [1, 2]\nb: *x\nc: [*x, 3]\n",
    ];
    let mut draws = Draws(2);
    for text in layouts {
        let mut tally = Tally::default();
        let bare = text.trim_start_matches('\u{feff}');
        let node = read(bare);
        let mut all = Vec::new();
        all_steps(&node, &mut Vec::new(), &mut all);
        for _ in 0..300 {
            let at = &all[draws.below(all.len())];
            check(bare, &node, at, &mut draws, &mut tally);
        }
        // Aliases are not edited.
        let has_aliases = text.contains('*');
        assert!(
            has_aliases || tally.done > tally.refused.len(),
            "{text} {:?}",
            tally.refused
        );
        let marked = edit(text, &[Edit::set(all[1].clone(), "5")]);
        let plain = edit(bare, &[Edit::set(all[1].clone(), "5")]);
        if let (Ok(marked), Ok(plain)) = (marked, plain) {
            assert_eq!(marked.trim_start_matches('\u{feff}'), plain);
            assert_eq!(marked.starts_with('\u{feff}'), text.starts_with('\u{feff}'));
        }
    }
}

#[test]
fn layout_is_followed() {
    let text = "# mine\ngenerator:\n  # the start\n  - [0, 0]\n  - [1/3, 0]  # a third\n  - {to: [1, 0]}\nsteps: 3 # few\n";
    let at = |path: &str| steps(path);
    let inserted = edit(
        text,
        &[Edit::insert(at("generator"), 2, "[1/2, sqrt(3)/6]")],
    )
    .unwrap();
    assert_eq!(
        inserted,
        text.replace("# a third\n", "# a third\n  - [1/2, sqrt(3)/6]\n")
    );
    let wrapped = edit(
        text,
        &[Edit::set(at("generator/1"), "{to: [1/3, 0], direction: 2}")],
    )
    .unwrap();
    assert_eq!(
        wrapped,
        text.replace("[1/3, 0]", "{to: [1/3, 0], direction: 2}")
    );
    let flagged = edit(
        text,
        &[Edit::set(at("generator/2"), "{to: [1, 0], fertile: false}")],
    )
    .unwrap();
    assert_eq!(
        flagged,
        text.replace("{to: [1, 0]}", "{to: [1, 0], fertile: false}")
    );
    let select = "[{when: step < 3, use: generator}, {use: other}]";
    let chosen = edit(text, &[Edit::add(Vec::new(), "select", select)]).unwrap();
    assert_eq!(chosen, format!("{text}select: {select}\n"));
    let json = "{\"a\": [[\"1/3\", 0]]}";
    assert_eq!(
        edit(json, &[Edit::insert(at("a"), 1, "[1/2, {b: c}]")]).unwrap(),
        "{\"a\": [[\"1/3\", 0], [\"1/2\", {\"b\": \"c\"}]]}"
    );
}

#[test]
fn values_are_nested_with_their_comments() {
    let text =
        "a: 1\ngenerator: # mine\n  # the start\n  - [0, 0]\n\n  - {to: [1, 0]} # end\nsteps: 3\n";
    let nested = Edit::Nest {
        at: steps("generator"),
        key: "first".into(),
    };
    assert_eq!(
        edit(text, std::slice::from_ref(&nested)).unwrap(),
        "a: 1\ngenerator: # mine\n  first:\n    # the start\n    - [0, 0]\n\n    - {to: [1, 0]} # end\nsteps: 3\n"
    );
    let beside = "generator:\n- [0, 0]\n- [1, 0]\n";
    assert_eq!(
        edit(beside, std::slice::from_ref(&nested)).unwrap(),
        "generator:\n  first:\n    - [0, 0]\n    - [1, 0]\n"
    );
    let short = "generator: koch # as it is\n";
    assert_eq!(
        edit(short, std::slice::from_ref(&nested)).unwrap(),
        "generator:\n  first: koch # as it is\n"
    );
    let json = "{\"generator\": [[0, 0]]}";
    assert_eq!(
        edit(json, &[nested]).unwrap(),
        "{\"generator\":\n  \"first\": [[0, 0]]}"
            .replace(":\n  \"first\": [[0, 0]]}", ": {\"first\": [[0, 0]]}}")
    );
}

#[test]
fn what_is_written_elsewhere_is_refused() {
    let text = "a: &x [1, 2]\nb: *x\ng: &y {d: 1}\nc: {<<: *y, e: 2}\n";
    for path in ["a/0", "b/0", "c/d", "g/d"] {
        let refused = edit(text, &[Edit::set(steps(path), "7")]);
        assert!(
            matches!(refused, Err(EditError::Unfaithful(_))),
            "{path}: {refused:?}"
        );
    }
    assert_eq!(
        edit(text, &[Edit::set(steps("c/e"), "7")]).unwrap(),
        text.replace("e: 2", "e: 7")
    );
    for wrong in [
        Edit::set(steps("z"), "1"),
        Edit::insert(steps("a"), 3, "1"),
        Edit::add(steps("c"), "e", "1"),
    ] {
        assert!(matches!(edit(text, &[wrong]), Err(EditError::Missing(_))));
    }
    assert!(matches!(
        edit(text, &[Edit::set(steps("c/e"), "[1")]),
        Err(EditError::Value(_))
    ));
    assert!(matches!(
        edit("a: [", &[Edit::remove(steps("a"))]),
        Err(EditError::Text(_))
    ));
}
