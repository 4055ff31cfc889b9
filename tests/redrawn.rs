//! Pictures that are grown again.

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::TempDir;

/// Runs the program in a folder; returns its exit status and its messages.
fn kfrac(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::cargo_bin("kfrac").unwrap();
    let output = command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    let messages = String::from_utf8(output.stderr).unwrap();
    (output.status.code(), messages)
}

/// Draws a picture with options and a title that have to be quoted.
fn drawn(file: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let rule = "title: Bäume (\\2 & <3>)\nparams: {angle: {value: 45, min: 5, max: 85}, t: 1}\ninitiator: segment\n\
                generator: [[0, 0], [t/2, tan(angle)/2], [1, 0]]\n";
    fs::write(folder.path().join("tree.yaml"), rule).unwrap();
    let stroke = "rgb(10, 20, 200)";
    let arguments = [
        "grow",
        "tree.yaml",
        "--set",
        "angle=30",
        "--steps",
        "5",
        "--stroke",
        stroke,
        "-o",
        file,
    ];
    assert_eq!(kfrac(folder.path(), &arguments).0, Some(0));
    folder
}

#[test]
fn pictures_hold_what_they_show() {
    for file in ["tree.png", "tree.svg", "tree.pdf"] {
        let from = drawn(file);
        let picture = from.path().join(file);
        let folder = tempfile::tempdir().unwrap();
        let (status, messages) = kfrac(folder.path(), &["grow", picture.to_str().unwrap()]);
        assert_eq!(status, Some(0), "{messages}");
        let again = fs::read(folder.path().join(file)).unwrap();
        assert!(again == fs::read(&picture).unwrap(), "{file}");
    }
}

#[test]
fn options_override_those_of_the_picture() {
    let folder = drawn("tree.png");
    let same = |redrawn: &[&str], written: &[&str]| {
        for (arguments, file) in [(redrawn, "a.svg"), (written, "b.svg")] {
            let all: Vec<&str> = arguments.iter().copied().chain(["-o", file]).collect();
            let (status, messages) = kfrac(folder.path(), &all);
            assert_eq!(status, Some(0), "{all:?} {messages}");
        }
        let [a, b] = ["a.svg", "b.svg"].map(|file| fs::read(folder.path().join(file)).unwrap());
        assert!(a == b, "{redrawn:?}");
    };
    let stroke = ["--stroke", "rgb(10, 20, 200)"];
    for options in [
        &["--set", "angle=30", "--steps", "3"][..],
        &["--set", "angle=60", "--steps", "5"],
        &[
            "--set", "angle=30", "--set", "t=0.9", "--steps", "5", "--size", "300",
        ],
        &["--set", "angle=30", "--detail", "3"],
    ] {
        let written = [&["grow", "tree.yaml"][..], options, &stroke].concat();
        same(&[&["grow", "tree.png"][..], options].concat(), &written);
    }
    assert_eq!(kfrac(folder.path(), &["info", "tree.png"]).0, Some(0));
    assert_eq!(kfrac(folder.path(), &["check", "tree.png"]).0, Some(0));
}

#[test]
fn pictures_that_are_read_are_not_replaced() {
    let folder = drawn("tree.svg");
    let before = fs::read(folder.path().join("tree.svg")).unwrap();
    let (status, messages) = kfrac(folder.path(), &["grow", "tree.svg", "--steps", "2"]);
    assert_eq!(status, Some(1));
    assert!(messages.contains("would be overwritten"), "{messages}");
    assert!(fs::read(folder.path().join("tree.svg")).unwrap() == before);
}

#[test]
fn other_pictures_are_refused() {
    let folder = drawn("tree.svg");
    let svg = fs::read_to_string(folder.path().join("tree.svg")).unwrap();
    let (before, rest) = svg.split_once("<metadata>").unwrap();
    let without = format!("{before}{}", rest.split_once("</metadata>").unwrap().1);
    fs::write(folder.path().join("without.svg"), without).unwrap();
    fs::write(
        folder.path().join("broken.png"),
        b"\x89PNG\r\n\x1a\nnothing",
    )
    .unwrap();
    fs::write(
        folder.path().join("broken.pdf"),
        b"%PDF-1.7 /Provenance(# kfrac ",
    )
    .unwrap();
    assert_eq!(
        kfrac(folder.path(), &["sheet", "tree.yaml", "-o", "sheet.svg"]).0,
        Some(0)
    );
    for (file, message) in [
        ("without.svg", "holds no rule"),
        ("broken.png", "cannot be read"),
        ("broken.pdf", "holds no rule"),
        ("sheet.svg", "was drawn by kfrac sheet"),
        ("missing.svg", "missing.svg"),
    ] {
        let (status, messages) = kfrac(folder.path(), &["grow", file, "-o", "out.svg"]);
        assert!(status.is_some_and(|status| status != 0), "{file}");
        assert!(messages.contains(message), "{file}: {messages}");
        assert!(!folder.path().join("out.svg").exists());
    }
}
