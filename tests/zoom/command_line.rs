//! `--zoom` and `--at` on the command line.

use super::common;

/// Returns status and standard error of `kfrac grow`.
fn said(arguments: &[&str]) -> (Option<i32>, String) {
    let folder = tempfile::tempdir().unwrap();
    common::said(folder.path(), &[&["grow"], arguments].concat())
}

#[test]
fn mistakes_are_told() {
    for (arguments, status, part) in [
        (
            &["koch", "--zoom", "-3", "--at", "0.(1)"][..],
            2,
            "a zoom is a number above 0",
        ),
        (
            &["koch", "--zoom", "0", "--at", "0.(1)"],
            2,
            "a zoom is a number above 0",
        ),
        (
            &["koch", "--zoom", "1e", "--at", "0.(1)"],
            2,
            "a zoom is a number above 0",
        ),
        (
            &["koch", "--zoom", "1e99999999999999", "--at", "0.(1)"],
            2,
            "1e10000 at most",
        ),
        (
            &["koch", "--zoom", "9^999999999", "--at", "0.(1)"],
            2,
            "1e10000 at most",
        ),
        (
            &["koch", "--zoom", "10", "--at", "0.1"],
            2,
            "stands in brackets",
        ),
        (
            &["koch", "--zoom", "10", "--at", "0.(1"],
            2,
            "goes on for ever",
        ),
        (
            &["koch", "--zoom", "10", "--at", "0.()"],
            2,
            "goes on for ever",
        ),
        (&["koch", "--zoom", "10"], 2, "--zoom needs --at"),
        (
            &["koch", "--zoom", "10", "--at", "0.(1)", "--view", "0,0,1,1"],
            2,
            "--zoom and --at cannot be combined with --view",
        ),
        (
            &["koch", "--zoom", "10", "--at", "0.(1)", "-o", "x.csv"],
            2,
            "--zoom applies to pictures only",
        ),
        (
            &[
                "barnsley-fern",
                "--zoom",
                "10",
                "--at",
                "0.(0)",
                "--method",
                "chaos",
            ],
            2,
            "--zoom magnifies elements",
        ),
        (
            &["koch", "--zoom", "10", "--at", "0.(7)"],
            1,
            "no position 7 at depth 1, where there are 4",
        ),
        (
            &["pythagoras", "--zoom", "10", "--at", "0.(0)"],
            1,
            "ends at depth 1",
        ),
        (
            &["koch", "--zoom", "1e40", "--at", "0.5,0.25"],
            1,
            "some 16 digits",
        ),
        (
            &[
                "dragon",
                "--zoom",
                "10",
                "--at",
                "0.(0)",
                "--color-by",
                "index",
            ],
            1,
            "--color-by none",
        ),
        (
            &["vegetation", "--zoom", "10", "--at", "0.(0)"],
            1,
            "zoom into",
        ),
        // The words of the system are never stored: they are long.
        (
            &["signals-a", "--zoom", "10", "--at", "0.(0)"],
            1,
            "productions have contexts",
        ),
    ] {
        let (code, text) = said(arguments);
        assert!(text.contains(part), "{arguments:?}: {text}");
        assert_eq!(code, Some(status), "{arguments:?}: {text}");
    }
}

#[test]
fn a_zoom_writes_pictures_of_both_formats() {
    for file in ["deep.png", "deep.svg"] {
        let (code, text) = said(&["koch", "--zoom", "1e50", "--at", "0.(1.2)", "-o", file]);
        assert_eq!(code, Some(0), "{text}");
        assert!(text.contains("koch to a detail of 1 pixel, 1"), "{text}");
    }
}

/// A window off the set gives an empty picture, which is reported with the distance of the set.
#[test]
fn a_window_beside_the_set_is_said_to_be_empty() {
    let note = "note: no part of koch lies within the window";
    let beside = ["koch", "--zoom", "1000", "--at", "0.5,0.1", "-o"];
    for file in ["beside.png", "beside.svg"] {
        let (code, text) = said(&[&beside[..], &[file]].concat());
        assert_eq!(code, Some(0), "{text}");
        let (first, _) = text.split_once('\n').unwrap();
        // From the nearest corners, which lie at (4/9, √3/9) and its mirror image.
        let nearest = "; the nearest part is about 0.11 from the centre, and --zoom 1.7 shows it";
        assert_eq!(first, format!("{note}{nearest}"), "{text}");
        let (_, text) = said(&[&beside[..], &[file, "--quiet"]].concat());
        assert_eq!(text, "");
    }
    for rest in [["--zoom", "1.3"], ["--steps", "0"]] {
        let at = ["koch", "--at", "0.5,0.1", "-o", "near.png"];
        let (code, text) = said(&[&at[..], &rest].concat());
        assert!(code == Some(0) && !text.contains("note"), "{text}");
    }
    let (_, text) = said(&[&beside[..], &["steps.png", "--steps", "3"]].concat());
    assert!(text.starts_with(&format!("{note}\n")), "{text}");
    let (_, text) = said(&["koch", "--view", "5,5,1,1", "-o", "view.png"]);
    assert!(text.starts_with(&format!("{note}\n")), "{text}");
    // The area that a chain encloses is visible, for it is filled.
    let inside = ["koch-snowflake", "--zoom", "50", "--at", "0.5,-0.2"];
    let (code, text) = said(&[&inside[..], &["--fill", "teal", "-o", "inside.png"]].concat());
    assert!(code == Some(0) && !text.contains("note"), "{text}");
}

/// A rule whose style colours elements by index is drawn in one colour, which is reported.
#[test]
fn rules_that_colour_by_index_are_zoomed_into_in_one_colour() {
    for name in ["dragon", "levy", "hilbert"] {
        let arguments = [name, "--zoom", "1e40", "--at", "0.(0.1)", "-o", "deep.png"];
        let (code, text) = said(&arguments);
        assert_eq!(code, Some(0), "{text}");
        assert!(text.starts_with("note: drawn in one colour"), "{text}");
    }
}
