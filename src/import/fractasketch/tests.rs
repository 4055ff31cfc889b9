//! Tests of the import of FractaSketch's templates.

use crate::diagnostic::Source;
use crate::import::{ImportOptions, Imported, SourceFormat};

fn read(text: &str) -> Imported {
    let source = Source::new("some/koch.fsk", text);
    let (mut imported, stray) = crate::import::read(
        &source,
        SourceFormat::FractaSketch,
        &ImportOptions::default(),
    );
    assert!(stray.is_empty() && imported.len() == 1, "{imported:?}");
    imported.remove(0)
}

#[test]
fn lines_are_elements() {
    let imported =
        read("100 400\n1 300 400\n2 300 200\n5 400 100\n6 500 200\n4 500 400\n3 700 400\n");
    let document = imported.document.as_ref();
    let yaml = document
        .unwrap_or_else(|| panic!("{}", imported.found))
        .to_yaml();
    let expected = "\
title: koch
source: koch in koch.fsk, for FractaSketch
initiator:
  - [0, 0]
  - [1, 0]
generator:
  - [0, 0]
  - [1/3, 0]
  - {to: [1/3, 1/3], direction: 2}
  - {to: [1/2, 1/2], fertile: false}
  - {to: [2/3, 1/3], fertile: false, visible: false}
  - {to: [2/3, 0], direction: 4}
  - {to: [1, 0], direction: 3}
steps: 6
";
    assert_eq!(yaml, expected);
    let imported = read("0 0 1 0.5 -0.5 1 1 0");
    let yaml = imported.document.unwrap().to_yaml();
    assert!(yaml.contains("  - [0.5, 0.5]\n"), "{yaml}");
}

#[test]
fn refusals_have_their_places() {
    for (text, place, message) in [
        ("1", "1", "this template has no lines"),
        ("1 2", "1", "this template has no lines"),
        ("1 2 1 3", "1", "the last line has 2 of 3 numbers"),
        ("1 x 1 3 4", "x", "'x' is no coordinate up to 1000000"),
        ("1 2 1 inf 4", "inf", "'inf' is no coordinate up to 1000000"),
        ("1 2 7 3 4", "7", "'7' is no type of a line from 1 to 6"),
        (
            "1 2 1 3 4 1 1 2",
            "1 1 2",
            "the template ends where it begins: it has no base line",
        ),
        (
            "0 0 5 1 1 1 1 0 1 5 0 1 2 0",
            "1 5 0",
            "this line is replaced, and not shorter than the base line",
        ),
        ("0 0 5 1 1 6 2 0", "0", "no line is replaced"),
    ] {
        let imported = read(text);
        let found = imported.found.iter().next().unwrap();
        assert_eq!(
            (found.place().unwrap().text(), found.message()),
            (place, message),
            "{text}"
        );
        assert!(imported.document.is_none());
    }
}
