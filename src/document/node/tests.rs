//! Tests of parsing nodes, of their source spans and of writing them.

use std::fmt::Write;

use super::{Key, Node, Value};
use crate::diagnostic::Source;

fn parse(text: &str) -> Node {
    let source = Source::new("koch.yaml", text);
    Node::parse(&source).unwrap_or_else(|found| panic!("{text:?}\n{found}"))
}

/// Lists the path, type and text of each node.
fn outline(node: &Node) -> String {
    fn visit(node: &Node, path: &str, out: &mut String) {
        let _ = writeln!(out, "{path} {} {:?}", node.kind(), node.place.text());
        match &node.value {
            Value::Sequence(items) => {
                for (index, item) in items.iter().enumerate() {
                    visit(item, &format!("{path}/{index}"), out);
                }
            }
            Value::Mapping(entries) => {
                for (key, item) in entries {
                    assert_eq!(key.name, key.place.text());
                    visit(item, &format!("{path}/{}", key.name), out);
                }
            }
            _ => {}
        }
    }
    let mut out = String::new();
    visit(node, "", &mut out);
    out
}

#[test]
fn places_are_the_scalars_text() {
    let text = "\u{feff}# Kochs Fläche\r\ntitle: \"Köch's\"  # ä\r\nä: é + x\r\nn:\r\n- ~\r\n-\r\n\
                p: [ü, 1/3 , {x: true}]\r\nabout: |\r\n  one\r\n  two\r\n\r\n";
    let node = parse(text);
    assert_eq!(
        outline(&node),
        r#" a mapping "title: \"Köch's\"  # ä\r\nä: é + x\r\nn:\r\n- ~\r\n-\r\np: [ü, 1/3 , {x: true}]\r\nabout: |\r\n  one\r\n  two"
/title text "Köch's"
/ä text "é + x"
/n a list "- ~\r\n-"
/n/0 nothing "~"
/n/1 nothing ""
/p a list "[ü, 1/3 , {x: true}]"
/p/0 text "ü"
/p/1 text "1/3"
/p/2 a mapping "{x: true}"
/p/2/x true or false "true"
/about text "one\r\n  two"
"#
    );
    let value = node.get("ä").expect("a value");
    assert_eq!((value.place.line(), value.place.column()), (3, 4));
    assert_eq!(value.within(5..6).text(), "x");
    assert_eq!(value.within(5..6).column(), 8);
    assert_eq!(value.written(), Some("é + x"));
    assert_eq!(node.written(), None);
    assert_eq!(
        node.get("about").expect("about").value,
        Value::Text("one\ntwo\n".into())
    );
}

#[test]
fn escaped_text_is_underlined_as_a_whole() {
    let node = parse(r#"a: "x \u00e4 + y""#);
    let value = node.get("a").expect("a value");
    assert_eq!(value.value, Value::Text("x ä + y".into()));
    assert_eq!(value.within(6..7).text(), r"x \u00e4 + y");
}

#[test]
fn keys_are_text_and_keep_their_order() {
    let node = parse("b: 1\n1: x\ntrue: y\n'a b': z\n1.50: w\n<<: {c: 3, b: 4}\n");
    let Value::Mapping(entries) = &node.value else {
        panic!("no mapping")
    };
    let names: Vec<_> = entries.iter().map(|(key, _)| key.name.as_str()).collect();
    assert_eq!(names, ["b", "1", "true", "a b", "1.50", "c"]);
    assert_eq!(node.get("b").expect("b").value, Value::Number(1.0));
}

#[test]
fn aliases_and_merge_keys_have_the_places_they_refer_to() {
    let node = parse(
        "base: &base {x: 1, y: 2}\nlist: [&p [0, 1], *p]\nboth:\n  <<: [*base, {y: 3, z: 4}]\n  \
         x: 5\nlast: *p\n",
    );
    let expected = parse(
        "base: {x: 1, y: 2}\nlist: [[0, 1], [0, 1]]\nboth: {y: 2, z: 4, x: 5}\nlast: [0, 1]\n",
    );
    assert!(node.same_value(&expected), "{}", node.to_yaml());
    assert_eq!(node.get("last").expect("last").place.line(), 2);
    assert!(node.place.text().ends_with("last: *p"));
}

#[test]
fn yaml_is_written_as_a_person_would() {
    let text = "\
title: Koch curve
about: |
  Two lines,
  the second one.
generator:
  - [0, 0]
  - {to: [1/6, sqrt(3)/6], direction: 2}
  - {to: [\"atan2(1, 2)\", 1 + sin(angle)*cos(angle)]}
params:
  angle: {value: 45, min: 5, max: 85.5, about: foot angle of the roof}
  other:
    value: 45
    about: foot angle, in degrees
random:
  tilt: uniform(-20, 20)
select:
  - when: age == 3 && step > 0 || length < 0.000001 || i == 100 || i == 200 || i == 300
    use: seed
  - {use: grow}
parts:
  - - [1, 2]
    - [3, 4]
  - []
style: {color: \"#ff0000\", fill: null, \"null\": \"yes\", 5: \"5\", rest: {}}
";
    assert_eq!(parse(text).to_yaml(), text);
}

#[test]
fn text_is_quoted_only_where_needed() {
    for (text, written) in [
        ("1/3", "1/3"),
        ("-x", "-x"),
        ("a:b", "a:b"),
        ("a#b", "a#b"),
        ("f(1, 2)", "f(1, 2)"),
        ("it's", "it's"),
        ("", "\"\""),
        ("12", "\"12\""),
        ("true", "\"true\""),
        ("No", "\"No\""),
        ("- x", "\"- x\""),
        ("a: b", "\"a: b\""),
        ("a #b", "\"a #b\""),
        ("\"x\" it's", "'\"x\" it''s'"),
        ("x ", "\"x \""),
        ("a\tb\u{7f}", "\"a\\tb\\u007f\""),
    ] {
        assert_eq!(
            Node::from(Value::Text(text.into())).to_yaml(),
            format!("{written}\n")
        );
    }
}

const TEXTS: [&str; 65] = [
    "",
    " ",
    "a",
    "12",
    "-1",
    "1e5",
    "0x1F",
    "0o7",
    ".5",
    "1/3",
    "1e999",
    ".inf",
    ".nan",
    "true",
    "false",
    "True",
    "null",
    "Null",
    "~",
    "yes",
    "no",
    "on",
    "=",
    "<<",
    "- a",
    "-",
    "-a",
    "--- a",
    "---",
    "...",
    "a: b",
    "a:",
    ":a",
    ": a",
    "? a",
    "?",
    "a #b",
    "#b",
    "a#b",
    " a",
    "a ",
    "a\nb",
    "a\nb\n",
    "\na",
    "a\n\n",
    "a\n\nb\n",
    "  a\nb",
    "a\n  b\n c",
    "a\n \nb",
    "a\n\tb",
    "tab\there",
    "ä ü 🌿",
    "\u{85}\u{2028}\u{feff}x",
    "\u{0}\u{1b}",
    "cr\r\nlf",
    "'single'",
    "\"double\"",
    "it's \"both\" \\",
    "[a]",
    "{a: b}",
    "a, b",
    "&a *b !c |d >e %f @g `h",
    "| a",
    "# a\n# b",
    "a\u{a0}",
];

#[test]
fn what_is_written_reads_as_the_same() {
    let numbers = [
        0.0,
        -0.0,
        1.0,
        -2.5,
        1e-9,
        1e300,
        0.1 + 0.2,
        f64::MAX,
        f64::MIN_POSITIVE,
    ];
    let text = |text: &str| Node::from(Value::Text(text.into()));
    let mut nodes: Vec<Node> = TEXTS.iter().copied().map(text).collect();
    nodes.extend(numbers.map(|number| Value::Number(number).into()));
    let empty = [Value::Sequence(vec![]), Value::Mapping(vec![])];
    nodes.extend(
        [Value::Bool(true), Value::Bool(false)]
            .into_iter()
            .chain(empty)
            .map(Node::from),
    );
    nodes.extend([text(&"long ".repeat(300)), text(&"long,".repeat(300))]);
    nodes.iter().for_each(round_trip);
    nodes.push(Value::Null.into());
    // Each value as an item, beside other values, and nested in the collections that result.
    for round in 0..3 {
        let mut built = Vec::new();
        for (index, node) in nodes.iter().enumerate() {
            let next = &nodes[(index * 7 + round) % nodes.len()];
            built.push(sequence(&[node]));
            built.push(sequence(&[node, next, node]));
            built.push(mapping(&[("a", node)]));
            built.push(mapping(&[("a", next), ("b b", node), ("c", next)]));
        }
        built.iter().for_each(round_trip);
        nodes = built.into_iter().step_by(round * 2 + 3).collect();
        nodes.push(mapping(&[]));
    }
    let long = "k".repeat(2000);
    let one = Node::from(Value::Number(1.0));
    for key in TEXTS.iter().copied().chain([long.as_str()]) {
        let flat = mapping(&[(key, &one)]);
        round_trip(&flat);
        round_trip(&mapping(&[
            ("nested", &flat),
            (key, &sequence(&[&flat, &flat])),
        ]));
    }
}

fn sequence(items: &[&Node]) -> Node {
    Value::Sequence(items.iter().map(|item| (*item).clone()).collect()).into()
}

fn mapping(entries: &[(&str, &Node)]) -> Node {
    let entries = entries
        .iter()
        .map(|(key, node)| (Key::new(*key), (*node).clone()));
    Value::Mapping(entries.collect()).into()
}

fn round_trip(node: &Node) {
    let text = node.to_yaml();
    assert!(parse(&text).same_value(node), "{text}\n{node:?}");
    assert_eq!(parse(&text).to_yaml(), text);
}
