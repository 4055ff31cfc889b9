//! Colours by the angle, the length and the place of elements.

use std::fs;

use crate::common::{self, run};
use kfrac::style::Palette;

/// Lines of lengths 1, 2, 4 and 8 at 0°, 45°, 180° and 315°.
const LINES: &str = "initiator:
  - {from: [0, 0], to: [1, 0]}
  - {from: [0, 2], to: [sqrt(2), 2 + sqrt(2)], connected: false}
  - {from: [8, 8], to: [4, 8], connected: false}
  - {from: [4, 6], to: [4 + 4*sqrt(2), 6 - 4*sqrt(2)], connected: false}
generator: [[0, 0], [1/2, 0], [1, 0]]
";

/// Returns the colours of the paths of an SVG, in order.
fn strokes(svg: &str) -> Vec<String> {
    let parts = svg.split("stroke=\"#").skip(1);
    parts.map(|part| format!("#{}", &part[..6])).collect()
}

/// Draws step 0 of the lines by a command line; returns the colours.
fn drawn(options: &str) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("lines.yaml"), LINES).unwrap();
    run(
        folder.path(),
        &format!("grow lines.yaml --steps 0 -q --margin 0 --stroke-width 0.01 -o x.svg {options}"),
    );
    strokes(&fs::read_to_string(folder.path().join("x.svg")).unwrap())
}

/// Returns the colours of a palette at shares of its length, rounded to 1/`count`.
fn colours(palette: &str, shares: [f64; 4], count: f64) -> Vec<String> {
    let palette = Palette::named(palette).unwrap();
    let at = |share: f64| palette.at((share * count).round() / count).to_string();
    shares.into_iter().map(at).collect()
}

#[test]
fn angles_run_over_a_full_turn() {
    let expected = colours("sinebow", [0.0, 0.125, 0.5, 0.875], 256.0);
    assert_eq!(drawn("--color-by angle --palette sinebow"), expected);
    // Beyond a range, the nearer end counts.
    let expected = colours("fire", [0.0, 0.5, 1.0, 0.0], 255.0);
    assert_eq!(
        drawn("--color-by angle --palette fire --color-range 0..90"),
        expected
    );
}

#[test]
fn lengths_differ_by_ratios() {
    let expected = colours("viridis", [0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0], 255.0);
    assert_eq!(drawn("--color-by length"), expected);
    let expected = colours("viridis", [0.25, 0.5, 0.75, 1.0], 255.0);
    assert_eq!(drawn("--color-by length --color-range 0.5..8"), expected);
    // Elements of one length have one colour, however they are rounded.
    let folder = tempfile::tempdir().unwrap();
    run(
        folder.path(),
        "grow koch --steps 5 -q --color-by length -o x.svg",
    );
    let svg = fs::read_to_string(folder.path().join("x.svg")).unwrap();
    assert_eq!(strokes(&svg).len(), 1);
}

#[test]
fn places_are_those_in_the_picture() {
    // The picture is 4 + 4√2 wide and 8 high.
    let width = 4.0 + 32.0_f64.sqrt();
    let x = [0.5, 0.5_f64.sqrt(), 6.0, 4.0 + 8.0_f64.sqrt()];
    let y = [0.0, 2.0 + 0.5_f64.sqrt(), 8.0, 6.0 - 8.0_f64.sqrt()];
    let near = |found: Vec<String>, shares: [f64; 4]| {
        // The margin of a hundredth of a pixel, and rounding.
        let possible = [-1.0, 0.0, 1.0].map(|off| {
            colours(
                "ice",
                shares.map(|share| (share + off / 1e4).clamp(0.0, 1.0)),
                255.0,
            )
        });
        for (number, colour) in found.iter().enumerate() {
            let known = possible.iter().any(|all| all[number] == *colour);
            assert!(known, "{number}: {colour} of {possible:?}");
        }
        assert_eq!(found.len(), 4);
    };
    near(drawn("--color-by x --palette ice"), x.map(|x| x / width));
    near(drawn("--color-by y --palette ice"), y.map(|y| y / 8.0));
    let distance = std::array::from_fn(|number| {
        (x[number] - width / 2.0).hypot(y[number] - 4.0) / (width / 2.0)
    });
    near(drawn("--color-by distance --palette ice"), distance);
    near(
        drawn("--color-by x --palette ice --color-range 0..16"),
        x.map(|x| x / 16.0),
    );
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let folder = tempfile::tempdir().unwrap();
    for by in ["angle", "length", "x", "distance"] {
        let mut pictures = Vec::new();
        for threads in [1, 3] {
            run(
                folder.path(),
                &format!(
                    "grow random-tree --steps 7 -q --color-by {by} -o x.png --threads {threads}"
                ),
            );
            pictures.push(fs::read(folder.path().join("x.png")).unwrap());
        }
        assert!(pictures[0] == pictures[1], "{by}");
    }
}

#[test]
fn a_range_in_units_is_refused_where_the_picture_has_none() {
    let folder = tempfile::tempdir().unwrap();
    for (line, expected) in [
        (
            "grow koch --zoom 100 --at 0.(1) --color-by length --color-range 0.1..1 -o x.png",
            "have no range",
        ),
        (
            "grow koch --steps 4 --color-by distance --tiles x",
            "use angle, x or y",
        ),
        (
            "grow koch --steps 4 --color-by length --tiles x",
            "--color-range 0.01..1",
        ),
        ("grow menger --color-by angle -o x.png", "angle"),
        (
            "grow koch --steps 4 --color-by y --svg instanced -o x.svg",
            "color",
        ),
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let (status, said) = common::said(folder.path(), &arguments);
        assert_ne!(status, Some(0), "{line}");
        assert!(said.contains(expected), "{line}: {said}");
    }
}
