//! Import of EisenScript, against closed forms and against a construction generation by generation.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

use kfrac::Fractal;
use kfrac::diagnostic::Source;
use kfrac::geometry::{DAffine3, DVec3};
use kfrac::import::{ImportOptions, SourceFormat, read};
use proptest::prelude::*;
use tempfile::TempDir;

use super::{imported, kfrac, said};
use crate::common::cases;

/// Returns the file of a program and the messages about it.
fn converted(program: &str) -> (Option<String>, String) {
    let source = Source::new("program.es", program);
    let (mut imported, _) = read(
        &source,
        SourceFormat::EisenScript,
        &ImportOptions::default(),
    );
    let entry = imported.pop().expect("a program is an entry");
    let yaml = entry.document.map(|document| document.to_yaml());
    (yaml, entry.found.to_string())
}

/// Returns the maps of all elements of a program, from the cube about the origin.
fn maps(program: &str) -> Vec<DAffine3> {
    let (yaml, said) = converted(program);
    let yaml = yaml.unwrap_or_else(|| panic!("{program}\n{said}"));
    let structure = Fractal::parse(&yaml).unwrap_or_else(|error| panic!("{error}\n{yaml}"));
    let structure = structure.steps(100_000);
    let elements = structure.elements_in_space().unwrap();
    elements
        .map(|element| *element.unwrap().frame.map())
        .collect()
}

/// Returns the centres of all elements, in order of their coordinates.
fn centres(program: &str) -> Vec<[f64; 3]> {
    let centre = |map: &DAffine3| map.translation.to_array();
    sorted(maps(program).iter().map(centre).collect())
}

fn sorted(mut points: Vec<[f64; 3]>) -> Vec<[f64; 3]> {
    for coordinate in points.as_flattened_mut() {
        *coordinate = (*coordinate * 1e6).round() / 1e6 + 0.0;
    }
    points.sort_by(|a, b| a.partial_cmp(b).unwrap());
    points
}

#[test]
fn loops_multiply_and_begin_with_one_step() {
    let expected = [1, 2, 3]
        .into_iter()
        .flat_map(|i| [1, 2].map(|j| [2.0 * f64::from(i) + 0.5, f64::from(j) + 0.5, 0.5]));
    let expected: Vec<_> = expected.collect();
    assert_eq!(centres("3 * { x 2 } 2 * { y 1 } box"), expected);
    // Loops that are written as formulas, as transforms that are repeated, as levels and as halves.
    let helix = |count: u32, turn: f64| {
        let all = (1..=count).scan(DAffine3::IDENTITY, |map, _| {
            let step = DAffine3::from_rotation_z(turn.to_radians());
            *map *= DAffine3::from_translation(DVec3::X) * step;
            Some((map.translation + 0.5).to_array())
        });
        sorted(all.collect())
    };
    for (count, turn, colour) in [
        (20, 9, ""),
        (100, 3, "hue 1"),
        (100, 3, ""),
        (777, 1, "hue 1"),
    ] {
        let program = format!("{count} * {{ x 1 rz {turn} {colour} }} box");
        assert_eq!(centres(&program), helix(count, turn.into()), "{program}");
    }
    let chain = "r rule r md 2 { { z 50 } r 300 * { x 1 rz 1 hue 1 } box }";
    assert_eq!(centres(chain).len(), 600);
}

#[test]
fn turns_and_sizes_are_about_the_centre_of_the_cube() {
    for (transformation, centre) in [
        ("rz 90", [0.5, 0.5, 0.5]),
        ("x 2 rz 90", [2.5, 0.5, 0.5]),
        ("rz 90 x 2", [0.5, 2.5, 0.5]),
        ("ry 90 x 1", [0.5, 0.5, -0.5]),
        ("rx 90 y 1", [0.5, 0.5, 1.5]),
        ("s 2 x 1", [2.5, 0.5, 0.5]),
        ("s 1 2 3 x 1 y 1 z 1", [1.5, 2.5, 3.5]),
        ("fx x 1", [-0.5, 0.5, 0.5]),
        ("m 0 1 0 1 0 0 0 0 1 x 1", [0.5, 1.5, 0.5]),
        ("reflect 1 0 0", [-0.5, 0.5, 0.5]),
        ("x 1/4 x -0.5", [0.25, 0.5, 0.5]),
    ] {
        let program = format!("{{ {transformation} }} box");
        assert_eq!(centres(&program), [centre], "{transformation}");
    }
    let map = maps("{ s 2 3 4 } box")[0];
    assert_eq!(map.transform_vector3(DVec3::ONE), DVec3::new(2.0, 3.0, 4.0));
}

#[test]
fn generations_end_as_in_structure_synth() {
    let at =
        |xs: &[i32]| -> Vec<_> { xs.iter().map(|x| [f64::from(*x) + 0.5, 0.5, 0.5]).collect() };
    // The first generation calls the rule, the last one draws the box of the last but one.
    let row = "set maxdepth 10 r rule r { { x 1 } r box }";
    assert_eq!(centres(row), at(&[0, 1, 2, 3, 4, 5, 6, 7]));
    // A rule in between takes a generation of its own.
    let slow = "set maxdepth 10 r rule r { { x 1 } r tile } rule tile { box }";
    assert_eq!(centres(slow), at(&[0, 1, 2, 3, 4, 5, 6]));
    assert_eq!(centres("r rule r md 3 { { x 1 } r box }"), at(&[0, 1, 2]));
    // A successor takes the place of the next copy, and the count begins anew behind it.
    let ended = "r rule r md 3 > tile { { x 1 } r box } rule tile { box }";
    assert_eq!(centres(ended), at(&[0, 1, 2, 3]));
    let again =
        "set maxdepth 9 a rule a md 2 > b { { x 1 } a box } rule b md 1 > a { { x 10 } b box }";
    assert_eq!(centres(again), at(&[0, 1, 2, 12, 13, 14, 24]));
    // 96 calls wait before the last generation, which makes 192.
    let many = "set maxobjects 100 r rule r { { x 1 } r { y 1 } r box }";
    assert_eq!(centres(many).len(), 1 + 2 + 4 + 8 + 16 + 32);
}

#[test]
fn alternatives_are_drawn_by_their_weights() {
    let program = |seed: u32| {
        format!(
            "set seed {seed} 400 * {{ x 1 }} r rule r w 3 {{ box }} rule r {{ {{ y 1 }} box }} rule r w 0 {{ {{ y 9 }} box }}"
        )
    };
    let first = centres(&program(1));
    assert_eq!(first, centres(&program(1)));
    assert_ne!(first, centres(&program(2)));
    assert_eq!(first.len(), 400);
    let raised = first.iter().filter(|[_, y, _]| *y == 1.5).count();
    // Four standard deviations about a quarter.
    assert!(raised.abs_diff(100) < 35, "{raised}");
    assert!(first.iter().all(|[_, y, _]| *y < 2.0));
    let xs: Vec<_> = first.iter().map(|[x, ..]| *x).collect();
    let expected: Vec<_> = (1..=400).map(|x| f64::from(x) + 0.5).collect();
    assert_eq!(xs, expected);
}

#[test]
fn large_loops_stay_small() {
    let (folder, said_of_it) = imported(
        "row.es",
        "set maxobjects 10000000 3000 * { x 1 } 3000 * { y 1 hue 1 } box",
        &[],
    );
    assert_eq!(said_of_it, "row.es: 1 written to .\n");
    let output = kfrac(folder.path())
        .args(["count", "row.yaml", "--steps", "64", "--json"])
        .output()
        .unwrap();
    let (counted, errors) = said(&output);
    assert!(counted.contains("9000000"), "{counted}{errors}");
    assert!(
        fs::read_to_string(folder.path().join("row.yaml"))
            .unwrap()
            .len()
            < 20_000
    );
}

#[test]
fn programs_are_drawn_and_read_from_standard_input() {
    let folder = TempDir::new().unwrap();
    let output = kfrac(folder.path())
        .args(["import", "-", "--from", "eisenscript"])
        .write_stdin("set background navy\n{ color #fc0 } box // gold\n")
        .output()
        .unwrap();
    assert!(output.status.success(), "{:?}", said(&output));
    let output = kfrac(folder.path())
        .args(["grow", "program.yaml", "-o", "box.csv"])
        .output()
        .unwrap();
    assert!(output.status.success(), "{:?}", said(&output));
    let rows = fs::read_to_string(folder.path().join("box.csv")).unwrap();
    assert_eq!(rows.lines().count(), 2, "{rows}");
}

#[test]
fn mistakes_have_their_places() {
    let folder = TempDir::new().unwrap();
    let program =
        "rule a md 3 {\n  { x 1 qq 3 } a\n  { x one } box\n}\n{ x 1 } aa\nset maxdepth ten\ntube\n";
    fs::write(folder.path().join("bad.es"), program).unwrap();
    let output = kfrac(folder.path())
        .args(["import", "bad.es"])
        .output()
        .unwrap();
    let (_, errors) = said(&output);
    assert_eq!(output.status.code(), Some(1), "{errors}");
    for place in [
        "bad.es:2:9",
        "bad.es:3:7",
        "bad.es:5:9",
        "bad.es:6:14",
        "bad.es:7:1",
    ] {
        assert!(errors.contains(place), "{place}: {errors}");
    }
    assert!(errors.ends_with("not written: bad\n"), "{errors}");
}

/// A call of a random program: a rule, or none for a box, once or in a loop.
#[derive(Clone, Debug)]
struct Call {
    rule: Option<usize>,
    count: u32,
    transformation: String,
    map: DAffine3,
}

/// A rule of a random program.
#[derive(Clone, Debug)]
struct Rule {
    depth: Option<u32>,
    successor: Option<usize>,
    calls: Vec<Call>,
}

const RULES: usize = 3;

fn call() -> impl Strategy<Value = Call> {
    let rule = prop_oneof![2 => (0..RULES).prop_map(Some), 1 => Just(None)];
    let about = |map: DAffine3| {
        let centre = DVec3::splat(0.5);
        DAffine3::from_translation(centre) * map * DAffine3::from_translation(-centre)
    };
    (
        rule,
        1..3_u32,
        -20..20_i32,
        0..3_usize,
        -4..4_i32,
        7..12_i32,
    )
        .prop_map(move |(rule, count, shift, axis, turn, scale)| {
            let (name, axis) = [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)][axis];
            let (shift, angle, scale) =
                (f64::from(shift) / 8.0, 45 * turn, f64::from(scale) / 10.0);
            let turned = DAffine3::from_axis_angle(axis, f64::from(angle).to_radians());
            Call {
                rule,
                count,
                transformation: format!("x {shift} r{name} {angle} s {scale}"),
                map: DAffine3::from_translation(DVec3::X * shift)
                    * about(turned)
                    * about(DAffine3::from_scale(DVec3::splat(scale))),
            }
        })
}

fn rule() -> impl Strategy<Value = Rule> {
    let depth = prop::option::of(1..4_u32);
    let successor = prop::option::of(0..RULES);
    (depth, successor, prop::collection::vec(call(), 1..4)).prop_map(|(depth, successor, calls)| {
        Rule {
            depth,
            successor,
            calls,
        }
    })
}

fn written(rules: &[Rule], generations: u32, objects: usize) -> String {
    let mut text = format!("set maxdepth {generations}\nset maxobjects {objects}\nr0\n");
    for (number, rule) in rules.iter().enumerate() {
        write!(text, "rule r{number}").unwrap();
        if let Some(depth) = rule.depth {
            write!(text, " md {depth}").unwrap();
            if let Some(successor) = rule.successor {
                write!(text, " > r{successor}").unwrap();
            }
        }
        text += " {\n";
        for call in &rule.calls {
            let name = call.rule.map_or("box".into(), |rule| format!("r{rule}"));
            writeln!(
                text,
                "  {} * {{ {} }} {name}",
                call.count, call.transformation
            )
            .unwrap();
        }
        text += "}\n";
    }
    text
}

/// Builds a program as Structure Synth does, with a list of calls that wait for the next generation.
fn built(rules: &[Rule], generations: u32, objects: usize) -> Vec<[f64; 3]> {
    type Waiting = (Option<usize>, DAffine3, BTreeMap<usize, u32>);
    let mut waiting: Vec<Waiting> = vec![(Some(0), DAffine3::IDENTITY, BTreeMap::new())];
    let mut boxes = Vec::new();
    // The first generation is that of the call of the first rule.
    let mut generation = 1;
    while generation < generations && boxes.len() < objects && waiting.len() < objects {
        generation += 1;
        let mut next = Vec::new();
        for (rule, map, mut left) in waiting {
            let Some(mut number) = rule else {
                boxes.push((map.transform_point3(DVec3::splat(0.5))).to_array());
                continue;
            };
            while let Some(0) = left.get(&number) {
                left.remove(&number);
                match rules[number].successor {
                    Some(successor) => number = successor,
                    None => {
                        number = usize::MAX;
                        break;
                    }
                }
            }
            let Some(rule) = rules.get(number) else {
                continue;
            };
            if let Some(depth) = rule.depth {
                let count = left.get(&number).copied().unwrap_or(depth);
                left.insert(number, count - 1);
            }
            for call in &rule.calls {
                let mut map = map;
                for _ in 0..call.count {
                    map *= call.map;
                    next.push((call.rule, map, left.clone()));
                }
            }
        }
        waiting = next;
        if waiting.is_empty() {
            break;
        }
    }
    sorted(boxes)
}

proptest! {
    #![proptest_config(cases(60))]

    #[test]
    fn structures_have_the_boxes_of_the_construction(
        rules in prop::collection::vec(rule(), RULES),
        generations in 2..9_u32,
        objects in prop_oneof![Just(30_usize), Just(1000)],
    ) {
        let program = written(&rules, generations, objects);
        let expected = built(&rules, generations, objects);
        if expected.is_empty() {
            let (yaml, said) = converted(&program);
            prop_assert!(yaml.is_none() && said.contains("draws nothing"), "{program}\n{said}");
        } else {
            let found = centres(&program);
            prop_assert_eq!(found.len(), expected.len(), "{}", program);
            let mut both = found.iter().flatten().zip(expected.iter().flatten());
            prop_assert!(both.all(|(a, b)| (a - b).abs() < 1e-5), "{program}");
        }
    }
}
