//! Tests of diagnostics for mistakes of syntax, and of bounded effort on malicious files.

use crate::diagnostic::{Diagnostics, Source};
use crate::document::node::Node;

fn errors(text: &str) -> String {
    let found = Node::parse(&Source::new("koch.yaml", text)).expect_err(text);
    assert!(found.has_errors());
    found.to_string()
}

/// Returns the messages with line and column.
fn messages(text: &str) -> Vec<String> {
    let found = Node::parse(&Source::new("koch.yaml", text)).expect_err(text);
    let line = |diagnostic: &crate::diagnostic::Diagnostic| {
        let place = diagnostic.place().expect("a place");
        format!(
            "{}:{} {}",
            place.line(),
            place.column(),
            diagnostic.message()
        )
    };
    found.iter().map(line).collect()
}

#[test]
fn a_comma_in_an_expression_is_one_mistake() {
    assert_eq!(
        errors("random: {tilt: uniform(-20, 20), apex: max(1, 2, min(3, 4))}\n"),
        "\
error: the comma splits 'uniform(-20, 20)'
 --> koch.yaml:1:16
  |
1 | random: {tilt: uniform(-20, 20), apex: max(1, 2, min(3, 4))}
  |                ^^^^^^^^^^^^^^^^
  |
  = help: in YAML's flow style a comma ends the value: put the expression in quotes, or on a line of its own

error: the comma splits 'max(1, 2, min(3, 4))'
 --> koch.yaml:1:40
  |
1 | random: {tilt: uniform(-20, 20), apex: max(1, 2, min(3, 4))}
  |                                        ^^^^^^^^^^^^^^^^^^^^
  |
  = help: in YAML's flow style a comma ends the value: put the expression in quotes, or on a line of its own"
    );
    assert_eq!(
        messages("- [0, atan2(1, 2)]\n"),
        ["1:7 the comma splits 'atan2(1, 2)'"]
    );
    let good = "- {tilt: \"uniform(-20, 20)\"}\n- x: uniform(-20, 20)\n- [(1, \"2)\", f(1]\n";
    assert!(Node::parse(&Source::new("a", good)).is_ok());
}

#[test]
fn what_was_meant_is_read_on() {
    let text = "a: {t: f(1, 2), u: f(1, 2)}\nstroke: #ff0000\nb: 1\nb: 2\nc: !tag 3\n";
    let mut found = Diagnostics::default();
    let node = Node::parse_with(&Source::new("koch.yaml", text), &mut found);
    assert_eq!(found.len(), 5);
    let mended = "\
a:
  t: f(1, 2)
  u: f(1, 2)
stroke: \"#ff0000\"
b: 1
c: 3
";
    assert_eq!(node.expect("a node").to_yaml(), mended);
}

#[test]
fn mistakes_are_shown_with_their_mend() {
    assert_eq!(
        errors("title: Köch # 1\nä: 1\ntitle: x\n"),
        "\
error: the key 'title' is already in line 1
 --> koch.yaml:3:1
  |
3 | title: x
  | ^^^^^
  |
  = help: keep one of the two"
    );
    assert_eq!(
        errors("params:\n\tangle: 1\n"),
        "\
error: a tab is used as indentation
 --> koch.yaml:2:1
  |
2 |     angle: 1
  | ^^^^
  |
  = help: YAML is indented with spaces: use two for each level"
    );
    assert_eq!(
        errors("title: \"Koch\ngenerator: x\n"),
        "\
error: this quote is never closed
 --> koch.yaml:1:8
  |
1 | title: \"Koch
  |        ^
  |
  = help: close it where the text ends"
    );
    assert_eq!(
        errors(""),
        "\
error: the file is empty
 --> koch.yaml:1:1
  |
1 |
  | ^
  |
  = help: a file holds 'key: value' lines, such as 'title: Koch curve'"
    );
}

#[test]
fn each_mistake_has_its_message() {
    for (text, expected) in [
        ("---\n", "1:1 the file is empty"),
        ("# a\n", "1:1 the file holds only comments"),
        (
            "a: \0",
            "1:4 'koch.yaml' is not a text file: it holds a zero byte",
        ),
        (
            "a: \u{1b}",
            "1:4 the control character U+001B is not allowed",
        ),
        ("a: 1\n---\nb: 2\n", "2:1 a second document starts here"),
        ("a: [1, {b: 2\nc: 3\n", "1:8 this '{' is never closed"),
        (
            "generator:\n- [0, 0\n- [1, 0]\n",
            "2:3 this '[' is never closed",
        ),
        ("a: {b: #ff0000}\n", "1:8 '#ff0000' is read as a comment"),
        ("a: [1 2}\n", "1:4 this '[' is closed by a '}'"),
        ("a: ]\n", "1:4 this ']' closes nothing"),
        ("a: \"x\n  b: 2\n", "1:4 this quote is never closed"),
        ("a: 'x' y\n", "1:8 something follows the closing quote"),
        (
            "a: \"\\q\"\n",
            "1:4 the text in quotes holds a '\\' that means nothing",
        ),
        ("a: #f00\n", "1:4 '#f00' is read as a comment"),
        ("- #ff0000\n- x\n", "1:3 '#ff0000' is read as a comment"),
        ("[a]: 1\n", "1:1 a list cannot be a key"),
        ("{b: 1}: 2\n", "1:1 a mapping cannot be a key"),
        (": 3\n", "1:1 this entry has no key"),
        (
            "a: !!python/object:os 1",
            "1:4 tags such as '!!python/object:os' are not used here",
        ),
        ("a: !e!x 1\n", "1:4 tags such as '!e!x' are not used here"),
        ("a: b: c\n", "1:5 a second ':' in a line"),
        (
            &*format!("{}: 1\n", "k".repeat(1100)),
            "1:1 a key has at most 1,024 characters",
        ),
        (
            "a: 1\n b: 2\n",
            "2:2 this line continues the text of line 1",
        ),
        ("a:b\nc: 1\n", "2:1 this line continues the text of line 1"),
        ("a: 1\nb\nc: 2\n", "2:1 this line has no ':'"),
        ("- a\nb: 1\n", "2:1 an entry of the list is expected here"),
        ("a:\n  b: 1\n c: 2\n", "3:2 a key is expected here"),
        ("a: *x\n", "1:4 nothing is marked for '*x' to refer to"),
        (
            "a: &x [*x]\n",
            "1:8 '*x' stands inside of what it refers to",
        ),
        ("{a: 1 b: 2}", "1:8 a ',' or '}' is expected here"),
        ("[1, 2\nb: 1\n", "2:2 a ':' is not expected here"),
        ("a: @x\n", "1:4 text cannot start with '@'"),
        ("a: - 1\n", "1:4 a list cannot start here"),
        ("a: [1]#c\n", "1:7 a comment starts right behind a value"),
        (
            "a:\n  <<: 1\n",
            "2:7 '<<' merges mappings, and this is a number",
        ),
    ] {
        assert_eq!(messages(text), [expected], "{text:?}");
    }
}

#[test]
fn nothing_costs_much() {
    let bomb = |width: usize| {
        let mut text = String::from("a0: &a0 [x, x, x, x, x, x, x, x, x]\n");
        for level in 1..20 {
            let before = format!("*a{}, ", level - 1).repeat(width);
            text += &format!("a{level}: &a{level} [{before}]\n");
        }
        text
    };
    let deep = "nested more than 64 deep";
    let many = "more than 250,000 values";
    let size = (1 << 20) - 4;
    let fill = |piece: &str| piece.repeat(size / piece.len());
    let copies = format!(
        "a: &a {}\nb: [{}]\n",
        "x".repeat(1 << 20),
        "*a, ".repeat(20)
    );
    let chain: String = (1..40)
        .map(|i| format!("a{i}: &a{i} [[*a{}]]\n", i - 1))
        .collect();
    for (name, text, expected) in [
        ("brackets", "[".repeat(100_000), deep),
        ("braces", "{a: ".repeat(100_000), deep),
        ("dashes", "- ".repeat(100_000), deep),
        ("questions", "? ".repeat(100_000), deep),
        ("both", "- [".to_owned() + &"[{a: ".repeat(100_000), deep),
        ("aliases", bomb(9), many),
        ("aliases of one", bomb(1), ""),
        ("chain", format!("a0: &a0 x\n{chain}"), deep),
        ("copies", copies, "16 MiB of text"),
        ("numbers", format!("[{}]", fill("1,")), many),
        (
            "keys",
            format!(
                "{{{}}}",
                (0..240_000).map(|i| format!("{i},")).collect::<String>()
            ),
            "",
        ),
        ("calls", format!("[{}]", fill("f(,")), many),
        ("lines", fill("- 1\n"), many),
        ("same keys", fill("a: 1\n"), many),
        (
            "some same keys",
            "a: 1\n".repeat(100_000),
            "already in line 1",
        ),
        ("colons", fill(":"), ""),
        ("quotes", fill("\"\\"), ""),
        ("commas", fill(","), ""),
        ("anchors", fill("&a "), ""),
        ("hashes", fill("#"), "only comments"),
        ("spaces", fill(" "), "empty"),
        (
            "lines of a text",
            format!("a: b\n{}c: d", " b\n".repeat(size / 4)),
            "",
        ),
        ("large", "a".repeat((4 << 20) + 1), "larger than 4 MiB"),
    ] {
        let source = Source::new("a.yaml", text);
        let text = Node::parse(&source).map_or_else(|found| found.to_string(), |_| String::new());
        assert!(
            text.contains(expected),
            "{name}: {}",
            &text[..text.len().min(300)]
        );
    }
}
