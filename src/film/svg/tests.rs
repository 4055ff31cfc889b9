//! Tests of animated SVG.

use super::*;

#[test]
fn lines_have_lengths() {
    let data = "M0 0l30 40 0-40z M10 10c0 55.2-44.8 100-100 100 M5 5h0";
    let lines: Vec<&str> = subpaths(data).collect();
    assert_eq!(lines.len(), 3);
    assert_eq!(length_of(lines[0]), 50.0 + 40.0 + 30.0);
    // A quarter of a circle, of length 157.1.
    assert!((length_of(lines[1]) - 157.1).abs() < 5.0);
    assert_eq!(length_of(lines[2]), 0.0);
    assert_eq!(length_of("M0 0L3 4L3 8"), 9.0);
    assert_eq!(
        commands("M0 0l1-2 3 4c1 2 3 4 5 6z"),
        [('M', 2), ('l', 4), ('c', 6), ('z', 0)]
    );
}

#[test]
fn transforms_have_units() {
    assert_eq!(
        with_units("translate(.5 2)rotate(-60)scale(.25)"),
        "translate(0.5px,2px)rotate(-60deg)scale(0.25)"
    );
    assert_eq!(with_units("matrix(1 0 0 -1 5 6)"), "matrix(1,0,0,-1,5,6)");
}

#[test]
fn a_pen_shows_a_line_between_its_ends() {
    assert!(state(0.25, [0.25, 0.5]).starts_with("visibility:hidden"));
    assert!(state(0.375, [0.25, 0.5]).contains("stroke-dashoffset:0.5;fill-opacity:0"));
    assert!(state(0.5, [0.25, 0.5]).contains("stroke-dashoffset:0;fill-opacity:1"));
    assert!(state(1.0, [1.0, 1.0]).contains("fill-opacity:1"));
}
