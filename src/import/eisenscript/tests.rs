//! Tests of the import of EisenScript.

use crate::diagnostic::Source;
use crate::import::{ImportOptions, Imported, SourceFormat};
use crate::instancing::{Appearance, Drift, Tint};
use crate::style::Colour;

use super::colour::{hsv, parse};

fn read(text: &str) -> Imported {
    let source = Source::new("some/tower.es", text);
    let (mut imported, stray) = crate::import::read(
        &source,
        SourceFormat::EisenScript,
        &ImportOptions::default(),
    );
    assert!(stray.is_empty() && imported.len() == 1, "{imported:?}");
    imported.remove(0)
}

/// Returns the file of a program about which there is nothing to say.
fn yaml(text: &str) -> String {
    let imported = read(text);
    assert!(imported.found.is_empty(), "{text}: {}", imported.found);
    imported.document.unwrap().to_yaml()
}

/// Returns the messages about a program.
fn said(text: &str) -> String {
    read(text).found.to_string()
}

#[test]
fn a_rule_is_an_object_with_levels() {
    let program = "
/* slabs */ set background #123
slab // the first one
rule slab md 40 > top {
  { y 0.9 ry 7 s 0.98 hue 5 } slab
  { s 3 0.8 3 } box
}
rule Top { { color white } sphere }
";
    let expected = "\
title: tower
source: tower in tower.es, for Structure Synth
kind: instancing
space: 3
objects:
  slab(1):
    - object: top
      scale: 0.98
      rotate: {y: 7}
      translate: [0, 0.9, 0]
      tint: {hue: 5}
    - {object: box, scale: [3, 0.8, 3]}
  slab(n):
    - object: slab(n - 1)
      scale: 0.98
      rotate: {y: 7}
      translate: [0, 0.9, 0]
      tint: {hue: 5}
    - {object: box, scale: [3, 0.8, 3]}
  top:
    - object: sphere
      tint: {color: \"#ffffff\"}
  box:
    - box: {from: [-0.5, -0.5, -0.5], to: [0.5, 0.5, 0.5]}
  sphere:
    - sphere: {radius: 0.5}
scene: {union: [slab(40)], translate: [1/2, 1/2, 1/2]}
style: {stroke: \"#ff0000\", fill: \"#ff0000\", background: \"#112233\"}
view: {shade: cosine, ambient: 0.3}
";
    assert_eq!(yaml(program), expected);
}

#[test]
fn loops_are_repetitions() {
    let written = |program: &str, part: &str| {
        let yaml = yaml(program);
        assert!(yaml.contains(part), "{program}: {yaml}");
    };
    let part =
        "- for: {k: 1..36}\n      object: box\n      rotate: {y: 10*k}\n      tint: {hue: 10*k}";
    written("36 * { ry 10 hue 10 } box", part);
    written("9 * { s -0.5 } box", "scale: (-0.5)^k");
    written("3 * { x 1 } 2 * { y -1 } box", "for: {k: 1..3, l: 1..2}");
    written("9 * { x 1 ry 5 } box", "repeat:\n        count: 9");
    written("9 * { x 1 ry 5 hue 1 } box", "box__x1(n):");
    // A loop has one copy at least.
    written("0 * { x 1 } box", "{object: box, translate: [1, 0, 0]}");
}

#[test]
fn names_are_those_of_yaml() {
    let program = "
#define Turn 30 (float:0-90)
#define step x 1 y -Turn
k N-1 n-1 a.b { step rz -turn } k { step rz -Turn } k
rule k { box } rule n-1 { sphere } rule a.b { grid line dot cylinder point }
";
    let found = said(program);
    assert!(
        found.contains("'-turn' where a number of 'rz' is expected"),
        "{found}"
    );
    let yaml = yaml(&program.replace("{ step rz -turn } k", ""));
    let moved = "rotate: {z: -30}\n      translate: [1, -30, 0]";
    for part in ["r_k: [box]", "n_1: [sphere]", "a_b: [grid", moved] {
        assert!(yaml.contains(part), "{part}: {yaml}");
    }
}

#[test]
fn absolute_colours_stand_at_the_primitives() {
    let found = yaml("{ color red } r rule r md 2 { { color lime x 1 } box { x 2 } r sphere }");
    assert!(found.contains("tint: {color: \"#00ff00\"}"), "{found}");
    assert!(
        found.contains("- object: sphere\n      tint: {color: \"#ff0000\"}"),
        "{found}"
    );
    // Changes of the same transformation apply to the colour itself.
    let found = yaml("{ hue 120 color red b 0.5 } box");
    assert!(found.contains("color: \"#008000\""), "{found}");
    let found = said("{ hue 20 } r rule r md 2 { r { color lime } box { color white } box }");
    assert_eq!(found.matches("goes on changing").count(), 1, "{found}");
    assert_eq!(parse("#80ff0000"), Some(Colour::of_rgba([255, 0, 0, 128])));
    assert_eq!(parse("#ff"), None);
    assert_eq!(parse("none"), None);
}

#[test]
fn changes_in_hsv_are_those_in_hsl_where_one_part_is_full() {
    let tinted = |drift: Drift, colour: Colour| {
        let tint = Tint {
            colour: Colour::BLACK,
            alpha: 0.0,
            drift,
        };
        hsv(Appearance::of(tint).on(colour))
    };
    let near = |a: [f64; 4], b: [f64; 4]| {
        assert!(
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.01),
            "{a:?} {b:?}"
        );
    };
    for colour in ["#ff0000", "#ff8000", "#ffbbaa", "#80c0ff"] {
        let colour = parse(colour).unwrap();
        let [hue, saturation, value, alpha] = hsv(colour);
        let paler = Drift {
            lightness: 0.3,
            ..Drift::default()
        };
        let [found, rest @ ..] = tinted(paler, colour);
        near(
            [0.0, rest[0], rest[1], rest[2]],
            [0.0, 0.7 * saturation, value, alpha],
        );
        assert!((found - hue).abs() < 2.0, "{found} {hue}");
    }
    for colour in ["#ff0000", "#0080ff", "#555555", "#400020"] {
        let colour = parse(colour).unwrap();
        let [_, saturation, value, alpha] = hsv(colour);
        let darker = Drift {
            lightness: -0.2,
            ..Drift::default()
        };
        let [_, rest @ ..] = tinted(darker, colour);
        near(
            [0.0, rest[0], rest[1], rest[2]],
            [0.0, saturation, 0.8 * value, alpha],
        );
    }
}

#[test]
fn approximate_colours_are_reported() {
    for (program, part) in [
        ("{ sat 0.5 } box", ""),
        ("{ b 0.5 } box", ""),
        (
            "{ sat 0.5 } box { b 0.5 } box",
            "the saturation times 0.5 of HSV is approximate",
        ),
        (
            "{ b 1.2 } box",
            "the brightness times 1.2 of HSV is approximate",
        ),
        (
            "{ color #ccaaaa } r rule r { { b 0.5 } box }",
            "the brightness times 0.5",
        ),
        ("{ a 0.5 } box", "whatever their alpha"),
        ("{ blend blue 1 } box", "mixed in RGB here"),
        ("{ color random } box", "is drawn for all copies"),
        ("set colorpool list:red,lime\n{ x 1 } box", ""),
    ] {
        let found = said(program);
        assert!(
            found.contains(part) && found.is_empty() == part.is_empty(),
            "{program}: {found}"
        );
    }
    let blended = read("{ blend blue 1 } box").document.unwrap().to_yaml();
    assert!(
        blended.contains("tint: {color: \"#0000ff\", alpha: 0.5}"),
        "{blended}"
    );
}

#[test]
fn what_has_no_counterpart_is_reported_at_its_place() {
    for (program, part) in [
        ("set raytracer::shadows false box", "1:5"),
        ("r rule r { set seed initial box }", "within a rule"),
        ("box::shiny", "the class 'shiny' is left out"),
        ("{ s 1 2 3 } sphere", "spheres become ellipsoids"),
        (
            "triangle[0,0,0;1,0,0;0,1,0]",
            "no counterpart of 'triangle'",
        ),
        ("/* box", "this comment is not closed"),
        ("#include x\nbox", "this directive is unknown"),
        ("#define a b\n#define b a\na", "'a' is defined by itself"),
        (
            "rule r { box",
            "the program ends where the } of a rule is expected",
        ),
        ("rule box { sphere }", "'box' is a primitive"),
        ("rule r w -1 { box } r", "the weight -1 is negative"),
        ("{ blend red -1 } box", "the strength -1 is negative"),
        ("{ reflect 0 0 0 } box", "this vector is 0"),
        ("r rule r { r }", "this program draws nothing"),
        ("set maxdepth 0 box", "this program draws nothing"),
        (
            "set maxdepth 1000000 set maxobjects 1000000000 r rule r { { x 1 } r }",
            "this program is too large",
        ),
        ("1e999 * { x 1 } box", "'1e999'"),
        ("{ x 1e999 } box", "'1e999'"),
        (
            "}",
            "'}' where the name of a rule or of a primitive is expected",
        ),
        ("set colorpool image:a.png box", "no pool of colours here"),
        ("boks rule boxes { box }", "there is no rule 'boks'"),
    ] {
        let found = said(program);
        assert!(found.contains(part), "{program}: {found}");
    }
    let spheres = "{ s 1 2 3 } box { x 1 } sphere";
    assert_eq!(said(spheres), "");
}

#[test]
fn random_programs_are_drawn_once() {
    let program =
        "set maxdepth 20 r rule r { { x 1 } r box } rule r w 2 { { x 1 rz 20 } r sphere }";
    let imported = read(program);
    let found = imported.found.to_string();
    assert!(
        found.contains("the 2 alternatives of 'r' are drawn here, once"),
        "{found}"
    );
    let yaml = imported.document.unwrap().to_yaml();
    assert_eq!(yaml, read(program).document.unwrap().to_yaml());
    assert!(yaml.contains("sphere:") && yaml.contains("box:"), "{yaml}");
    let large = "r rule r { { x 1 } r { y 1 } r box } rule r { { z 1 } r { y 1 } r box }";
    let imported = read(large);
    assert!(
        imported
            .found
            .to_string()
            .contains("more draws are too large"),
        "{}",
        imported.found
    );
    assert!(imported.document.is_some());
    let number = read("{ x random[1,2] } box").document.unwrap().to_yaml();
    assert!(number.contains("translate: [1."), "{number}");
}

/// Meshes join: the upper face of each is the lower face of the next one, and the first state has none.
#[test]
fn meshes_connect_states() {
    // Sides in one plane are quadrilaterals.
    let straight = yaml("2 * { z 1 s 0.5 } mesh");
    assert_eq!(straight.matches("polygon").count(), 2 * 4, "{straight}");
    let twisted = yaml("{ z 1 rz 30 } mesh");
    assert_eq!(twisted.matches("polygon").count(), 2 * 4, "{twisted}");
    // Of a sheared cube, two sides have no area. Without a movement, none has.
    assert_eq!(yaml("{ x 1 } mesh").matches("polygon").count(), 2);
    let still = yaml("{ hue 9 } mesh box");
    assert!(!still.contains("mesh"), "{still}");
    // The first call of the rule has no mesh. Each of the others joins that before it.
    let tower = yaml("set maxdepth 9 r rule r { { z 1 ry 6 s 0.9 } r mesh }");
    let first = "r:\n    - object: r__2(7)\n      scale: 0.9\n      rotate: {y: 6}\n      translate: [0, 0, 1]\n  r__2(2): [mesh__1]";
    assert!(tower.contains(first), "{tower}");
    assert_eq!(tower.matches("mesh__").count(), 3, "{tower}");
    // A call without a transformation keeps the one before it.
    let kept = yaml("{ z 2 } a rule a { b } rule b { mesh { z 1 } box }");
    let side = "[-0.5, -0.5, -2.5]\n        - [0.5, -0.5, -2.5]\n        - [0.5, -0.5, -0.5]";
    assert!(kept.contains(side), "{kept}");
    // Nothing lies before the first state.
    assert!(said("mesh").contains("draws nothing"));
    assert!(said("box rule mesh { box }").contains("'mesh' is a primitive"));
}
