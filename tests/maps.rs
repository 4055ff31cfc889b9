//! Maps of parameters: oracles, symmetries, and the command.

use std::fs;
use std::num::NonZero;

use crate::common::{document, document_of, said};
use kfrac::family::{
    Family, FamilyError, MapOptions, ParameterMap, ParameterPlane, ParameterRange, PlaneValue,
    Property,
};
use kfrac::ifs::{Connectedness, ConnectednessSearch};

fn axis(name: &str, from: f64, to: f64) -> ParameterRange {
    let name = name.to_owned();
    ParameterRange { name, from, to }
}

fn names(plane: &ParameterPlane) -> Vec<String> {
    plane.axes().iter().map(|axis| axis.name.clone()).collect()
}

/// Returns a map of {s z + 1, s z − 1}.
fn pairs(axes: [ParameterRange; 2], size: [u32; 2], options: &MapOptions<'_>) -> ParameterMap {
    let plane = ParameterPlane::new(axes.into(), size).unwrap();
    let family = Family::of(&document("complex-pair"), &[], &names(&plane)).unwrap();
    ParameterMap::compute(&family, &plane, options).unwrap()
}

fn all(side: u32, property: Property) -> ParameterMap {
    let axes = ["s.re", "s.im"].map(|name| axis(name, -1.0, 1.0));
    pairs(axes, [side, side], &MapOptions::new(property))
}

/// Dust below 1/2, connected from 1/√2, connected for real s from 1/2 alone.
#[test]
fn pairs_of_maps_have_their_mandelbrot_set() {
    let map = all(201, Property::Connected);
    let mut counts = [0; 3];
    for row in 0..201 {
        for column in 0..201 {
            let [x, y] = map.plane().values(column, row);
            let (size, value) = (f64::hypot(x, y), map.value(column, row));
            match value {
                PlaneValue::Number(depth) => {
                    assert!((1.0..=32.0).contains(&depth));
                    assert!(size < 0.5_f64.sqrt(), "{x} {y}");
                    assert!(y != 0.0 || x.abs() < 0.5, "{x} {y}");
                    counts[0] += 1;
                }
                PlaneValue::Connected => {
                    let is_large = 2.0 * size * size > 0.999_999;
                    assert!(is_large || (y == 0.0 && x.abs() >= 0.5), "{x} {y}");
                    counts[1] += 1;
                }
                PlaneValue::NotCertified => {
                    assert!((0.5..0.708).contains(&size), "{x} {y}");
                    counts[2] += 1;
                }
                PlaneValue::DoesNotContract => assert!(size >= 1.0, "{x} {y}"),
                other => panic!("{x} {y}: {other}"),
            }
        }
    }
    assert!(counts.iter().all(|count| *count > 1000), "{counts:?}");
    let family = Family::of(&document("complex-pair"), &[], &names(map.plane())).unwrap();
    let mut member = family.member();
    let mut at = |s: [f64; 2]| ConnectednessSearch::new(60).of(member.at(&s).unwrap());
    assert!(matches!(at([0.0, 0.69]), Connectedness::Disconnected(_)));
    assert_eq!(at([0.5, 0.49]), Connectedness::NotCertified);
}

#[test]
fn maps_are_symmetric_to_the_last_bit() {
    let map = all(120, Property::Connected);
    for row in 0..120 {
        for column in 0..120 {
            let value = map.value(column, row);
            assert_eq!(value, map.value(119 - column, 119 - row));
            assert_eq!(value, map.value(column, 119 - row));
        }
    }
}

#[test]
fn threads_change_nothing() {
    let of = |threads: usize| {
        let options = MapOptions {
            threads: NonZero::new(threads).unwrap(),
            ..MapOptions::new(Property::Connected)
        };
        let axes = [axis("s.re", 0.4, 0.7), axis("s.im", 0.0, 0.3)];
        pairs(axes, [61, 40], &options).values().to_vec()
    };
    assert_eq!(of(1), of(5));
}

/// Equal ratios have the dimension log 2 / log(1/|s|); others satisfy Moran's equation.
#[test]
fn dimensions_solve_the_equation_of_moran() {
    let map = all(50, Property::Dimension);
    for row in 0..50 {
        for column in 0..50 {
            let [x, y] = map.plane().values(column, row);
            let size = f64::hypot(x, y);
            match map.value(column, row) {
                PlaneValue::Number(dimension) => {
                    let expected = 2.0_f64.ln() / (1.0 / size).ln();
                    assert!((dimension - expected).abs() < 1e-9 * expected, "{x} {y}");
                }
                other => assert!(other == PlaneValue::DoesNotContract && size >= 1.0),
            }
        }
    }
    let text = "{kind: ifs, params: {a: 0.3, b: 0.5}, maps: [{scale: a}, {scale: b, shift: [1, 0]}, \
                {scale: [a, -a], shift: [0, 1]}]}";
    let axes = vec![axis("a", 0.05, 0.6), axis("b", 0.05, 0.9)];
    let plane = ParameterPlane::new(axes, [9, 9]).unwrap();
    let family = Family::of(&document_of(text), &[], &names(&plane)).unwrap();
    let map =
        ParameterMap::compute(&family, &plane, &MapOptions::new(Property::Dimension)).unwrap();
    for (number, value) in map.values().iter().enumerate() {
        let number = u32::try_from(number).unwrap();
        let [a, b] = plane.values(number % 9, number / 9);
        let dimension = value.number().unwrap();
        let sum = 2.0 * a.powf(dimension) + b.powf(dimension);
        assert!((sum - 1.0).abs() < 1e-9, "{a} {b}: {dimension}");
    }
}

/// The members of a family are the systems that the file has with these values.
#[test]
fn members_are_what_the_file_resolves_to() {
    let own = "{kind: ifs, params: {a: {value: 0.4, min: 0, max: 1}, b: {value: a / 2, max: 0.4}, \
               c: 'if(a < 0.5, 1, 2)'}, maps: [{scale: b, rotate: 90 * a, shift: [c, a % 0.3]}, \
               {matrix: [[b, 0.1], [0, a]], fixed: [1/a, c]}], initial: {disk: {radius: 1}}}";
    let corners = "{kind: ifs, params: {a: 0.4}, vertices: {points: [[0, 0], [1, a], [sqrt(a), 2]], shrink: a}}";
    let scattered = "{kind: ifs, params: {a: 0.4}, vertices: {scatter: {ellipsoid: [1, a], count: 5}, \
                     shrink: a}}";
    let curve =
        "{kind: ifs, params: {a: 0.4}, interpolate: {points: [[0, 0], [1, a], [2, 0]], scale: a}}";
    for text in [own, corners, scattered, curve] {
        let document = document_of(text);
        let family = Family::of(&document, &[], &["a".into()]).unwrap();
        let mut member = family.member();
        let mut systems = 0;
        for step in 0..40 {
            let a = f64::from(step) / 37.0;
            let resolved = document.resolve(&[("a", a).into()]);
            let found = member.at(&[a]);
            let Ok((kfrac::model::Model::Ifs(system), _)) = resolved else {
                // A system that does not contract is a member, whose attractor does not exist.
                let verdict = found.map(|maps| ConnectednessSearch::new(8).of(maps));
                let is_none = verdict.is_none_or(|it| it == Connectedness::DoesNotContract);
                assert!(is_none, "{a}: {verdict:?}");
                continue;
            };
            systems += 1;
            let expected: Vec<_> = system.ifs().maps().iter().map(|map| map.affine).collect();
            assert_eq!(found, Some(&expected[..]), "{a}: {text}");
        }
        assert!(systems > 20, "{text}");
    }
}

#[test]
fn files_without_families_are_refused() {
    let of = |text: &str, name: &str| Family::of(&document_of(text), &[], &[name.into()]);
    let maps = "params: {a: 0.4}, maps: [{scale: a}, {scale: a, shift: [1, 0]}]";
    for (more, expected) in [
        ("edges: {1: [1, 2], 2: [1]}", "recurrent"),
        ("condensation: [{point: [0, 0]}]", "condensation"),
    ] {
        let error = of(&format!("{{kind: ifs, {maps}, {more}}}"), "a").unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
    }
    let error = of(&format!("{{kind: ifs, {maps}}}"), "b").unwrap_err();
    assert!(matches!(error, FamilyError::NoParameter { .. }), "{error}");
    let error = Family::of(&document("koch"), &[], &[]).unwrap_err();
    assert!(matches!(error, FamilyError::NotASystem), "{error}");
    let error = Family::of(&document("menger"), &[], &[]).unwrap_err();
    assert!(matches!(error, FamilyError::InSpace), "{error}");
}

#[test]
fn the_command_draws_and_lists() {
    let folder = tempfile::tempdir().unwrap();
    let run = |arguments: &[&str]| {
        said(
            folder.path(),
            &[&["map", "complex-pair"], arguments].concat(),
        )
    };
    let whole = ["--over", "s=[-1,-1]..[1,1]", "--size", "64"];
    let (status, said) = run(&whole);
    assert_eq!(status, Some(0), "{said}");
    let first = "complex-pair-map.png: connected over s, 64 x 64 pixels, ";
    assert!(said.starts_with(first), "{said}");
    for kind in [
        "disconnected, certified by compositions of 1 to ",
        "connected, by a theorem",
    ] {
        assert!(said.contains(kind), "{said}");
    }
    let png = fs::read(folder.path().join("complex-pair-map.png")).unwrap();
    let decoder = png::Decoder::new(std::io::Cursor::new(&png));
    let reader = decoder.read_info().unwrap();
    let texts = reader
        .info()
        .utf8_text
        .iter()
        .map(|it| it.get_text().unwrap());
    let texts = texts.collect::<Vec<_>>().join("\n");
    let command = "kfrac map complex-pair.yaml --over='s=[-1,-1]..[1,1]' --of=connected --size=64";
    assert!(texts.contains(command), "{texts}");
    let table = |more: &[&str]| {
        let (status, said) = run(&[more, &["-q", "-o", "map.csv"]].concat());
        assert_eq!((status, said.as_str()), (Some(0), ""));
        fs::read_to_string(folder.path().join("map.csv")).unwrap()
    };
    let rows = table(&["--over", "s=[0.2,0]..[0.8,0.4]", "--size", "3x2"]);
    let rows: Vec<_> = rows.lines().collect();
    assert_eq!(rows[0], "x,y,value");
    assert_eq!(rows.len(), 7);
    let near = |row: &str, expected: [f64; 2]| {
        let mut parts = row
            .split(',')
            .map(|it| it.parse::<f64>().unwrap_or(f64::NAN));
        expected
            .iter()
            .all(|it| (parts.next().unwrap() - it).abs() < 1e-12)
    };
    assert!(
        near(rows[1], [0.3, 0.3]) && rows[1].ends_with(",1"),
        "{rows:?}"
    );
    assert!(near(rows[3], [0.7, 0.3]) && rows[3].ends_with(",connected"));
    assert!(near(rows[6], [0.7, 0.1]) && rows[6].ends_with(",not-certified"));
    let line = ["--over", "s.re=0..0.6", "--set", "s=[0,0.9]", "--size", "6"];
    let rows = table(&line);
    assert_eq!(rows.lines().count(), 7);
    assert!(rows.starts_with("x,value\n0.0"), "{rows}");
    assert_eq!(rows.matches(",connected\n").count(), 4, "{rows}");
    assert!(rows.ends_with(",does-not-contract\n"), "{rows}");
    let rows = table(&[
        "--over",
        "s=[0.2,0]..[0.8,0.4]",
        "--omit",
        "2",
        "--size",
        "2x1",
    ]);
    assert_eq!(rows.matches("connected").count(), 2, "{rows}");
}

#[test]
fn wrong_command_lines_have_their_messages() {
    let folder = tempfile::tempdir().unwrap();
    let plane = "s=[-1,-1]..[1,1]";
    for (arguments, expected) in [
        (vec!["complex-pair"], "--over"),
        (vec!["complex-pair", "--over", "s=1"], "write NAME=FROM..TO"),
        (
            vec!["complex-pair", "--over", "s.re=1..1"],
            "the range of 's.re' is empty",
        ),
        (vec!["complex-pair", "--over", "t=0..1"], "it has: s"),
        (vec!["complex-pair", "--over", "s=0..1"], "'s' is complex"),
        (
            vec!["complex-pair", "--over", "s=[-2,0]..[1,1]"],
            "its least value is -1",
        ),
        (
            vec!["complex-pair", "--over", plane, "--over", "s.re=0..1"],
            "not 3 real ones",
        ),
        (
            vec!["complex-pair", "--over", "s.re=0..1", "--over", "s.re=0..1"],
            "along one axis only",
        ),
        (
            vec!["complex-pair", "--over", plane, "--size", "100000"],
            "up to 67108864 pixels",
        ),
        (
            vec![
                "complex-pair",
                "--over",
                plane,
                "--of",
                "area",
                "--depth",
                "11",
            ],
            "at most 10",
        ),
        (
            vec!["complex-pair", "--over", plane, "-o", "map.svg"],
            ".png and .csv are",
        ),
        (
            vec!["pythagoras", "--over", "angle=10..80"],
            "iterated function systems",
        ),
    ] {
        let (status, said) = said(folder.path(), &[&["map"], &arguments[..]].concat());
        assert!(matches!(status, Some(1 | 2)), "{arguments:?}");
        assert!(said.contains(expected), "{arguments:?}: {said}");
        assert_eq!(
            fs::read_dir(folder.path()).unwrap().count(),
            0,
            "{arguments:?}"
        );
    }
}

/// A path that is found in a map can be followed.
#[test]
fn paths_in_a_map_are_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let path = ["--set", "s=[0.3,0.5]..[0.6,0.3]", "--steps", "5"];
    for arguments in [
        [&["sheet", "complex-pair", "--samples", "3"], &path[..]].concat(),
        [
            &["animate", "complex-pair", "--frames", "3", "--size", "32"],
            &path[..],
        ]
        .concat(),
    ] {
        let (status, said) = said(folder.path(), &arguments);
        assert_eq!(status, Some(0), "{said}");
    }
}
