//! `kfrac grow --svg instanced` on the command line.

use std::path::Path;

use super::common;

/// Returns status and standard error of `kfrac grow --svg instanced`.
fn said(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let instanced = ["grow", "--svg", "instanced"];
    common::said(folder, &[&instanced, arguments].concat())
}

#[test]
fn what_does_not_go_together_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (arguments, status, message) in [
        (
            &["koch", "-o", "koch.png"][..],
            2,
            "--svg instanced applies to SVG only: write a .svg",
        ),
        (
            &["koch", "--format", "csv"],
            2,
            "--svg instanced applies to SVG only: write a .svg",
        ),
        (&["koch", "--plot"], 2, "--plot draws every single line"),
        (
            &["koch", "--detail", "1"],
            2,
            "--detail leaves out small elements",
        ),
        (
            &["koch", "--zoom", "10", "--at", "0.(1)"],
            2,
            "--zoom draws the neighbourhood of a point",
        ),
        (
            &["gasket", "--method", "chaos", "-o", "gasket.png"],
            2,
            "--svg instanced applies to lines",
        ),
        (&["random-tree"], 1, "drawn at random, each in its own way"),
        (
            &["dragon", "--color-by", "index"],
            1,
            "step, age, generator",
        ),
    ] {
        let (code, text) = said(folder.path(), arguments);
        assert!(text.contains(message), "{arguments:?}: {text}");
        assert_eq!(code, Some(status), "{arguments:?}: {text}");
    }
    assert_eq!(folder.path().read_dir().unwrap().count(), 0);
}

/// A small file has more elements than the limits admit, and includes the command that made it.
#[test]
fn many_steps_make_a_small_file() {
    let folder = tempfile::tempdir().unwrap();
    let (code, text) = said(folder.path(), &["koch", "--steps", "200"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(
        text.starts_with("warning: browsers expand every instance"),
        "{text}"
    );
    assert!(
        text.contains("koch.svg: step 200 of koch, 201 symbols"),
        "{text}"
    );
    let svg = std::fs::read_to_string(folder.path().join("koch.svg")).unwrap();
    assert!(svg.contains("--steps=200 --seed=0 --svg=instanced"));
    let (code, text) = said(folder.path(), &["koch", "--steps", "5"]);
    assert_eq!(code, Some(0), "{text}");
    assert!(!text.contains("warning"), "{text}");
}
