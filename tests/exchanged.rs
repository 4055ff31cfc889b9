//! Components that are exchanged on the command line.

use std::fs;
use std::path::Path;

use crate::common;

fn table(folder: &Path, arguments: &[&str]) -> String {
    let grow = ["--steps", "3", "--format", "csv", "-o", "out.csv", "-q"];
    let (status, said) = common::said(folder, &[&["grow"], arguments, &grow].concat());
    assert_eq!(status, Some(0), "{arguments:?}: {said}");
    fs::read_to_string(folder.join("out.csv")).unwrap()
}

#[test]
fn exchanged_components_are_those_of_a_file_that_extends_the_rule() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mine = "initiator: segment\ngenerator: [[0, 0], [1/2, 1/2], [1, 0]]\n";
    fs::write(folder.join("mine.yaml"), mine).unwrap();
    let cases = [
        (
            &["koch", "--initiator", "pentagon"][..],
            "extends: koch\ninitiator: pentagon\n",
        ),
        (
            &["koch", "--generator", "levy", "--base-element", "leaf"],
            "extends: koch\ngenerator: levy\nbase_element: leaf\n",
        ),
        (
            &["mine.yaml", "--initiator=triangle"],
            "extends: mine.yaml\ninitiator: triangle\n",
        ),
    ];
    for (arguments, text) in cases {
        fs::write(folder.join("whole.yaml"), text).unwrap();
        let exchanged = table(folder, arguments);
        assert_eq!(exchanged, table(folder, &["whole.yaml"]), "{text}");
        assert_ne!(exchanged, table(folder, &arguments[..1]), "{text}");
    }
    // The picture of such a rule holds all that grows it again.
    let rule = ["koch", "--initiator", "pentagon"];
    let picture = ["--steps", "2", "-q", "-o", "one.png"];
    let (status, said) = common::said(folder, &[&["grow"], &rule[..], &picture].concat());
    assert_eq!(status, Some(0), "{said}");
    assert_eq!(table(folder, &rule), table(folder, &["one.png"]));
}

#[test]
fn components_that_cannot_be_exchanged_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |arguments: &[&str]| common::said(folder.path(), arguments);
    let (status, said) = refused(&["info", "koch", "--generator", "levvy"]);
    assert_eq!(status, Some(1));
    assert!(said.contains("levvy") && said.contains("'levy'"), "{said}");
    let (status, said) = refused(&["info", "menger", "--initiator", "pentagon"]);
    assert_eq!(status, Some(1));
    assert!(said.contains("of kind 'ifs', not 'rule'"), "{said}");
    let (status, said) = refused(&["grow", "-", "--initiator", "pentagon"]);
    assert_eq!(status, Some(2));
    assert!(said.contains("--initiator exchanges a component"), "{said}");
}
