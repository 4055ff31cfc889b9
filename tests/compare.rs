//! Distances between fractals, against known values and against brute force.

use std::collections::HashMap;
use std::process::{Command, Output};

use crate::common::{compiled, document, document_of, grown, resolved};
use kfrac::geometry::{DAffine2, DVec2};
use kfrac::graph::{Graph, Replacement};
use kfrac::grow::Growth;
use kfrac::measure::{Distance, NoCover, Precision, Subject, Subset, hausdorff};

const KOCH: &str = "\
kind: ifs
maps:
  - {scale: 1/3}
  - {scale: 1/3, rotate: 60, shift: [1/3, 0]}
  - {scale: 1/3, rotate: -60, shift: [1/2, sqrt(3)/6]}
  - {scale: 1/3, shift: [2/3, 0]}
";

fn graph(text: &str) -> Graph {
    let (model, _) = document_of(text)
        .resolve(&[])
        .unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    model.compile(64).unwrap()
}

fn rule(name: &str) -> Graph {
    compiled(&resolved(&document(name), &[]), 64)
}

fn distance(a: &Graph, b: &Graph, tolerance: f64) -> Distance {
    let [a, b] = [a, b].map(|graph| Subject::new(graph, Subset::Limit).unwrap());
    let precision = Precision {
        tolerance,
        ..Precision::default()
    };
    hausdorff([&a, &b], &precision).unwrap()
}

/// Asserts that a distance agrees with the expected one within its error, which is at most `most`.
fn assert_is(found: &Distance, expected: f64, most: f64) {
    assert!((found.value() - expected).abs() <= found.error, "{found:?}");
    assert!(found.error <= most, "{found:?}");
}

#[test]
fn koch_is_one_set_as_a_rule_and_as_a_system() {
    let found = distance(&rule("koch"), &graph(KOCH), 1e-3);
    assert!(found.may_be_same(), "{found:?}");
    assert!(found.error < 1.1e-3, "{found:?}");
}

#[test]
fn a_set_that_is_moved_is_as_far_as_it_is_moved() {
    let moved = "initiator: [[0.1, 0], [1.1, 0]]\ngenerator: koch\n";
    // The nearest point to (0, 0) is (0.1, 0).
    assert_is(&distance(&rule("koch"), &graph(moved), 1e-3), 0.1, 1.3e-3);
}

#[test]
fn the_middle_of_a_segment_is_far_from_the_cantor_set() {
    let cantor = "kind: ifs\nmaps: [{scale: 1/3}, {scale: 1/3, shift: [2/3, 0]}]\n";
    let segment = "kind: ifs\nmaps: [{scale: 1/2}, {scale: 1/2, shift: [1/2, 0]}]\n";
    let found = distance(&graph(cantor), &graph(segment), 1e-4);
    assert_is(&found, 1.0 / 6.0, 1.1e-4);
    assert!(
        found.there <= found.error,
        "the Cantor set lies in the segment: {found:?}"
    );
}

#[test]
fn what_an_outline_encloses_belongs_to_it() {
    // A square as four of its quarters, and as a condensation set of a system inside it.
    let quarters = "kind: ifs\nvertices: {points: [[0, 0], [1, 0], [1, 1], [0, 1]], shrink: 1/2}\n";
    let filled = "\
kind: ifs
maps: [{scale: 1/2}]
condensation:
  - polygon: [[0, 0], [1, 0], [1, 1], [0, 1]]
";
    let found = distance(&graph(quarters), &graph(filled), 1e-2);
    assert!(found.may_be_same() && found.error < 1.5e-2, "{found:?}");
    // The distance from the centre of a disc to its circle is the radius.
    let disk = "kind: ifs\nmaps: [{scale: 1/2}]\ncondensation:\n  - disk: {radius: 1}\n";
    let point = "kind: ifs\nmaps: [{scale: 1/2}]\n";
    assert_is(&distance(&graph(disk), &graph(point), 1e-2), 1.0, 3e-2);
}

/// Products of such maps down to the error are too many to enumerate.
#[test]
fn copies_that_overlap_a_lot_are_covered() {
    let corners = ["[0, 0]", "[16, 0]", "[8, 14]"];
    let maps = corners.map(|corner| format!("  - {{scale: 0.9, fixed: {corner}}}\n"));
    let copies = graph(&format!("kind: ifs\nmaps:\n{}", maps.concat()));
    let corners = corners.join(", ");
    let triangle = format!("condensation:\n  - polygon: [{corners}]\n");
    let triangle = graph(&format!(
        "kind: ifs\nmaps: [{{scale: 1/2, fixed: [8, 5]}}]\n{triangle}"
    ));
    let found = distance(&copies, &triangle, 1e-2);
    assert!(found.may_be_same() && found.error < 0.17, "{found:?}");
    // Without one of its corners, the line is left.
    let line = graph("kind: ifs\nmaps: [{scale: 1/2}, {scale: 1/2, shift: [8, 0]}]\n");
    assert_is(&distance(&copies, &line, 1e-2), 14.0, 0.17);
}

/// Objects of different sizes and shapes, whose copies overlap.
#[test]
fn structures_that_overlap_a_lot_are_covered() {
    let structure = "\
kind: instancing
objects:
  large:
    - {object: small, scale: 9}
    - {object: large, scale: 0.8, rotate: 30, translate: [3, 0]}
  small:
    - {segment: [[0, 0], [1, 0]]}
    - {object: large, scale: 0.1, rotate: -20, translate: [0, 0.5]}
    - {object: small, scale: 0.85, rotate: 70, translate: [0.3, 0.2]}
scene: [{object: large, scale: [1, 2]}, {segment: [[40, 0], [41, 0]]}]
";
    let structure = graph(structure);
    let found = distance(&structure, &structure, 1e-2);
    let subject = Subject::new(&structure, Subset::Limit).unwrap();
    let size = subject.bounds().size().max_element();
    assert!(found.error <= 0.011 * size, "{found:?}, {size}");
    assert_covers(&structure, 5e-3);
}

/// Maps that contract by little in some directions, where errors of many images would add up.
#[test]
fn affine_copies_that_overlap_a_lot_are_covered() {
    let maps = [
        [0.28, 0.01, -0.1, -0.16, 0.8, 0.5],
        [-0.16, 0.24, 0.27, 0.27, -1.0, 0.7],
        [0.84, -0.01, -0.06, -0.93, 0.9, 0.1],
    ]
    .map(|columns| DAffine2::from_cols_array(&columns));
    let system = |maps: &[DAffine2]| {
        let entry = |map: &DAffine2| {
            let [a, c, b, d, e, f] = map.to_cols_array();
            format!("  - {{matrix: [[{a}, {b}], [{c}, {d}]], translate: [{e}, {f}]}}\n")
        };
        let maps: String = maps.iter().map(entry).collect();
        graph(&format!("kind: ifs\nmaps:\n{maps}"))
    };
    let one = system(&maps);
    assert_covers(&one, 1e-3);
    // The products of two maps have the limit set of the maps, and other words and cells.
    let products = maps.map(|outer| maps.map(|inner| outer * inner));
    let found = distance(&one, &system(&products.concat()), 2e-3);
    assert!(found.is_reached() && found.may_be_same(), "{found:?}");
}

/// Asserts that points of the limit set are near those of its cover, for a radius as a multiple of its size.
fn assert_covers(graph: &Graph, radius: f64) {
    let subject = Subject::new(graph, Subset::Limit).unwrap();
    let radius = radius * subject.bounds().size().max_element();
    #[expect(clippy::cast_possible_truncation, reason = "there are few cells")]
    let cell = |point: DVec2| (point / radius).floor().to_array().map(|it| it as i64);
    let mut cover: HashMap<[i64; 2], Vec<DVec2>> = HashMap::new();
    for point in subject.cover(radius, 4_000_000).unwrap() {
        cover.entry(cell(point)).or_default().push(point);
    }
    let is_near = |point: DVec2| {
        let [x, y] = cell(point);
        let around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y]));
        let mut near = around.filter_map(|cell| cover.get(&cell)).flatten();
        near.any(|other| other.distance(point) <= radius)
    };
    // Each is the image under hundreds of maps that are picked in turn.
    let points = orbit(graph, 2000);
    let missed = points.iter().filter(|point| !is_near(**point)).count();
    assert_eq!(missed, 0);
}

#[test]
fn two_dragons_differ() {
    let found = distance(&rule("dragon"), &rule("twindragon"), 1e-2);
    assert!(!found.may_be_same() && found.value() > 0.1, "{found:?}");
}

/// Returns points of the limit set, by long walks from the initiator to kept elements.
fn orbit(graph: &Graph, count: u64) -> Vec<DVec2> {
    let walk = |seed: u64| {
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
        let mut pick = |count: usize| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as usize % count
        };
        let start = &graph.initiator(0).instances;
        let first = &start[pick(start.len())];
        let (mut object, mut map) = (first.object, *first.frame.map());
        for _ in 0..400 {
            let Replacement::Fixed(production) = &graph.objects()[object].replacement else {
                break;
            };
            let next = &production.body.instances[pick(production.body.instances.len())];
            (object, map) = (next.object, map * next.frame.map());
        }
        let outline = &graph.base_elements()[graph.objects()[object].base_element];
        map.transform_point2(outline.start())
    };
    (1..=count).map(walk).collect()
}

/// Returns the corners of an approximant.
fn corners(graph: &Graph, steps: u32) -> Vec<DVec2> {
    let fractals = grown(graph, &Growth::steps(steps));
    let elements = fractals.iter().flat_map(|fractal| &fractal.elements);
    elements.flat_map(|element| element.frame.ends()).collect()
}

#[test]
fn a_perturbed_map_is_as_far_as_brute_force_says() {
    let (steps, side) = (5, 1.0 / 243.0);
    for (name, text) in [
        (
            "height",
            "initiator: segment\ngenerator: [[0, 0], [1/3, 0], [0.5, 0.2986], [2/3, 0], [1, 0]]\n",
        ),
        (
            "foot",
            "initiator: segment\ngenerator: [[0, 0], [0.3433, 0], [1/2, sqrt(3)/6], [2/3, 0], [1, 0]]\n",
        ),
    ] {
        let (a, b) = (rule("koch"), graph(text));
        let found = distance(&a, &b, 5e-4);
        let (a, b) = (corners(&a, steps), corners(&b, steps));
        let far = |from: &[DVec2], to: &[DVec2]| {
            let nearest = |point: &DVec2| {
                let squares = to.iter().map(|other| (*other - *point).length_squared());
                squares.fold(f64::INFINITY, f64::min)
            };
            from.iter().map(nearest).fold(0.0, f64::max).sqrt()
        };
        let brute = far(&a, &b).max(far(&b, &a));
        // Corners belong to the sets, and no point of a set is farther from a corner than half a side: sides
        // of the perturbed curve are at most a few hundredths longer.
        let error = found.error + 1.3 * side;
        assert!(
            (found.value() - brute).abs() <= error,
            "{name}: {found:?}, {brute}"
        );
        assert!(!found.may_be_same(), "{name}: {found:?}");
    }
}

fn kfrac(arguments: &[&str]) -> Output {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin("kfrac"));
    command.env_remove("KFRAC_LIBRARY").args(arguments);
    command.output().unwrap()
}

#[test]
fn the_command_says_what_it_found() {
    let output = kfrac(&[
        "compare",
        "koch",
        "cesaro",
        "--set",
        "angle=60",
        "--json",
        "--tolerance",
        "0.01",
    ]);
    assert!(output.status.success(), "{output:?}");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["a"]["name"], "koch");
    assert_eq!(found["b"]["kind"], "rule");
    assert_eq!(found["steps"], serde_json::Value::Null);
    assert!(found["error"].as_f64().unwrap() < 0.011, "{found}");
    assert!(
        found["distance"].is_number() && found["same"].is_boolean(),
        "{found}"
    );
    assert_eq!(found["reached"], true);
    let output = kfrac(&[
        "compare",
        "koch",
        "koch",
        "--steps",
        "3",
        "--tolerance",
        "0.01",
    ]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        said.starts_with(
            "compared    step 3 of koch and koch\nverdict     the same, within the error\n"
        ),
        "{said}"
    );
}

#[test]
fn a_tolerance_that_is_not_reached_is_told() {
    let compared = |more: &[&str]| {
        let mut arguments = vec!["compare", "koch", "cesaro", "--tolerance", "0.01"];
        arguments.extend(more);
        let output = kfrac(&arguments);
        assert!(output.status.success(), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    let found = compared(&["--max-points", "400", "--json"]);
    let found: serde_json::Value = serde_json::from_str(&found).unwrap();
    assert_eq!(found["reached"], false);
    assert!(found["error"].as_f64().unwrap() > 0.011, "{found}");
    let line = "\nerror       above the 1.00e-2 that --tolerance requests: --max-points allows more points\n";
    let said = compared(&["--max-points", "400"]);
    assert!(said.contains(line), "{said}");
    let said = compared(&[]);
    assert!(!said.contains("--tolerance"), "{said}");
}

#[test]
fn a_picture_shows_the_difference() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("difference.png");
    let path = path.to_str().unwrap();
    let two = folder.path().join("two.yaml");
    std::fs::write(
        &two,
        "initiator: [[0, 0], [1, 0], [2, 0]]\ngenerator: koch\n",
    )
    .unwrap();
    let two = two.to_str().unwrap();
    let output = kfrac(&[
        "compare",
        "koch",
        two,
        "--tolerance",
        "0.01",
        "-o",
        path,
        "--size",
        "64",
    ]);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains(" 0 of A alone, "),
        "one of two copies is all in them: {said}"
    );
    let pixmap = tiny_skia::Pixmap::load_png(path).unwrap();
    let colours: std::collections::BTreeSet<_> = pixmap
        .pixels()
        .iter()
        .filter(|pixel| pixel.alpha() > 0)
        .map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
        .collect();
    let expected = [[0x00, 0x72, 0xb2], [0x99, 0x99, 0x99]];
    assert_eq!(colours, expected.into());
}

/// A picture of the difference marks pixels and keeps no points.
#[test]
fn a_picture_needs_no_points_that_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("difference.png");
    let mut arguments = vec!["compare", "dragon", "dragon-ifs", "--tolerance", "0.1"];
    arguments.extend(["--max-points", "2000", "--size", "200", "-o"]);
    arguments.push(file.to_str().unwrap());
    let output = kfrac(&arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("0 of A alone, 0 of B alone"), "{said}");
}

#[test]
fn what_cannot_be_compared_is_told() {
    for (arguments, status, said) in [
        (
            &["compare", "koch", "random-tree"][..],
            1,
            "random-tree cannot be compared: numbers are drawn in it at random",
        ),
        (
            &["compare", "koch", "dragon", "--set", "angel=3"],
            2,
            "koch has no parameter 'angel'",
        ),
        (
            &["compare", "-", "-"],
            2,
            "only one of the two can come from standard input",
        ),
        (
            &["compare", "koch", "koch", "--tolerance", "0"],
            2,
            "expected a number from 1e-9 to 1",
        ),
        (
            &["compare", "dragon", "dragon", "--max-points", "10"],
            1,
            "--max-points allows more",
        ),
        (
            &["convert", "koch", "--to", "rule"],
            2,
            "koch is not converted: it is of the kind 'rule' already",
        ),
        (
            &["convert", "random-tree", "--to", "ifs"],
            1,
            "random-tree does not become an iterated function system: numbers",
        ),
    ] {
        let output = kfrac(arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(status), "{errors}");
        assert!(errors.contains(said), "{errors}");
        assert!(output.stdout.is_empty());
    }
}

/// Thousands of parts, of which one hardly shrinks, are not all kept in memory on the way to a small part.
#[test]
fn parts_that_hardly_shrink_are_given_up() {
    let points = "  - [0.001, 0.001]\n".repeat(9_000);
    let text = format!("initiator: segment\ngenerator:\n  - [0, 0]\n{points}  - [1, 0]\n");
    let subject = graph(&text);
    let subject = Subject::new(&subject, Subset::Limit).unwrap();
    let size = subject.bounds().size().max_element();
    assert_eq!(
        subject.cover(size / 1000.0, 4_000_000),
        Err(NoCover::TooManyOpen)
    );
}

/// Copies of ferns overlap, but so little that squares would take five times the points.
#[test]
fn ferns_are_covered_by_copies() {
    for (name, most) in [("barnsley-fern", 40_000), ("barnsley-fern-four", 25_000)] {
        let fern = graph(&format!("kind: ifs\nextends: {name}\n"));
        let subject = Subject::new(&fern, Subset::Limit).unwrap();
        let size = subject.bounds().size().max_element();
        let points = subject.cover(size / 256.0, most);
        assert!(points.is_ok(), "{name}: {points:?}");
    }
}

#[test]
fn sets_in_space_are_as_far_as_their_shapes() {
    let graph = |text: &str| {
        let text = format!("kind: ifs\nspace: 3\n{text}");
        let (model, _) = document_of(&text).resolve(&[]).unwrap();
        model.compile_in_space(false).unwrap()
    };
    let distance = |a: &str, b: &str, set: Subset<'_>, tolerance: f64| {
        let graphs = [graph(a), graph(b)];
        let [a, b] = graphs
            .each_ref()
            .map(|graph| Subject::new(graph, set).unwrap());
        let precision = Precision {
            tolerance,
            ..Precision::default()
        };
        let found = hausdorff([&a, &b], &precision).unwrap();
        assert!(found.is_reached(), "{found:?}");
        found
    };
    let cube = "vertices: {solid: cube, shrink: 1/2}";
    let moved = "vertices: {points: [[-1, -1, -1], [2, -1, -1], [-1, 1, -1], [-1, -1, 1], [2, 1, -1], \
                 [2, -1, 1], [-1, 1, 1], [2, 1, 1]], shrink: 1/2}";
    // Copies of which hundreds overlap at a place.
    let overlapping = "vertices: {solid: cube, shrink: 0.8}";
    let found = distance(cube, overlapping, Subset::Limit, 0.05);
    assert!(found.may_be_same(), "{found:?}");
    let found = distance(cube, moved, Subset::Limit, 0.05);
    assert_is(&found, 1.0, 0.16);
    assert!(found.there < found.error);
    // The corners of the cube and the ball that it holds.
    let ball = "maps: [{scale: 1/2}]\ninitial: {sphere: {radius: 1}}";
    let start = Subset::Approximant(Growth::steps(0));
    assert_is(&distance(cube, ball, start, 0.05), 3f64.sqrt() - 1.0, 0.11);
    // The tetrahedron and its corners alone, of which the middle of an edge is farthest.
    let corners = "vertices: {solid: tetrahedron, shrink: 0}";
    let gasket = "vertices: {solid: tetrahedron, shrink: 1/2}";
    let found = distance(gasket, corners, Subset::Limit, 0.02);
    assert_is(&found, 2f64.sqrt(), 0.045);
    assert!(found.back < found.error);
}

#[test]
fn the_command_compares_sets_in_space() {
    let output = kfrac(&[
        "compare",
        "sierpinski-tetrahedron",
        "octahedron-flake",
        "--tolerance",
        "0.05",
    ]);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success() && said.contains("different"),
        "{said}"
    );
    assert!(
        said.contains(
            "box of A    -1.000000 to 1.000000, -1.000000 to 1.000000, -1.000000 to 1.000000"
        ),
        "{said}"
    );
    for (arguments, message) in [
        (
            &["compare", "koch", "menger"][..],
            "koch lies in the plane, and menger in space",
        ),
        (
            &["compare", "menger", "menger", "-o", "x.png"],
            "for the plane",
        ),
    ] {
        let output = kfrac(arguments);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(
            output.status.code() == Some(2) && said.contains(message),
            "{said}"
        );
    }
}
