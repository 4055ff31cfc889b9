//! Small files that demand large results: accepted in bounded time and memory, or refused.

use std::fs;
use std::sync::atomic::AtomicBool;

use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::extent::bounding_box;
use kfrac::graph::Graph;
use kfrac::grow::{Growth, WalkError};

use super::hostile::{kfrac, refused};

/// Asserts that the program accepts a file without a diagnostic.
pub(super) fn accepted(text: &str, arguments: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("many.yaml"), text).unwrap();
    let outcome = kfrac(folder.path(), arguments);
    assert_eq!(outcome.status, Some(0), "{}", outcome.said);
}

pub(super) const CHECK: [&str; 2] = ["check", "many.yaml"];
const INFO: [&str; 4] = ["info", "many.yaml", "--steps", "2"];

/// Returns a rule with two lists of equal numbers of elements, and many generators that name each other.
fn entangled(count: usize) -> String {
    let mut text = String::from("initiator: segment\ngenerators:\n");
    for (name, y) in [("a", 0), ("b", 1)] {
        text += &format!("  {name}: [[0, 0], [1/4, {y}/9], {{to: [1/2, 0], use: g1}}, [1, 0]]\n");
    }
    for i in 0..count {
        let (next, other) = ((i + 1) % count, (i + 7) % count);
        text += &format!(
            "  g{i}: [[0, 0], {{to: [1/2, 0], use: g{next}}}, {{to: [1, 0], use: g{other}}}]\n"
        );
    }
    text
}

#[test]
fn what_many_elements_become_is_held_once() {
    let generators: String = (0..3_000)
        .map(|i| format!("  g{i}: [[0, 0], [1/2, 0]]\n"))
        .collect();
    let weights: String = (0..3_000).map(|i| format!("g{i}: 1, ")).collect();
    let text = format!(
        "initiator: segment\ngenerators:\n{generators}select: {{at_random: {{{weights}}}}}\n"
    );
    accepted(&text, &CHECK);
    accepted(&text, &INFO);
    let looks: String = (0..3_000)
        .map(|i| {
            format!("  - {{to: [{i}/9999, 1/2], base_element: {{points: [[0, 0], [1, 0]]}}}}\n")
        })
        .collect();
    let text = format!("initiator: segment\ngenerator:\n  - [0, 0]\n{looks}");
    accepted(&text, &CHECK);
    accepted(&text, &INFO);
}

#[test]
fn what_is_too_much_to_resolve_is_counted() {
    let select = "select: [{when: i % 61 == 1, use: a}, {use: b}]\nsteps: 16\n";
    let text = entangled(1_000) + select;
    accepted(&text, &CHECK);
    accepted(&text, &INFO);
    let points: String = (0..20)
        .map(|i| format!("[{}/977, {i}/7], ", i * i))
        .collect();
    let cases: String = (2..20_000)
        .map(|i| format!("  - {{when: length == {i}/99999, use: a}}\n"))
        .collect();
    let text = format!(
        "initiator: segment\ngenerators: {{a: [{points}]}}\nselect:\n{cases}  - {{use: a}}\nsteps: 6\n"
    );
    accepted(&text, &CHECK);
    accepted(&text, &INFO);
}

#[test]
fn extents_of_many_elements_and_maps_are_bounded() {
    let many = |count: usize, element: &dyn Fn(usize) -> String| {
        let elements: String = (0..count).map(element).collect();
        format!("initiator: segment\ngenerator:\n  - [0, 0]\n{elements}  - [1, 0]\n")
    };
    let numbers = |i| format!("  - [0.0{}, 0.00{}]\n", i % 7, i % 13);
    accepted(&many(75_000, &numbers), &INFO);
    let formulas = |i| format!("  - [sin(30)*{}/100, cos(30 + {})/100]\n", i % 7, i % 13);
    accepted(&many(15_000, &formulas), &INFO);
    let message = "with the operations of its formulas, the file holds more than 250,000 values";
    refused(many(75_000, &formulas).as_bytes(), message);
    let maps: String = (0..600)
        .map(|i| {
            let (axis, turn, x, y) = (i % 5, i % 360, i % 97, i % 89);
            format!(
                "  - {{scale: 0.9, rotate: {{axis: [1, {axis}, 2], angle: {turn}}}, translate: [{x}, {y}, 3]}}\n"
            )
        })
        .collect();
    accepted(&format!("kind: ifs\nspace: 3\nmaps:\n{maps}"), &CHECK);
    let maps: String = (0..200)
        .map(|i| {
            let (turn, x, y) = (i * 77 % 360, i % 17, i % 13);
            format!("  - {{scale: 0.9, rotate: {turn}, translate: [{x}, {y}]}}\n")
        })
        .collect();
    accepted(&format!("kind: ifs\nmaps:\n{maps}"), &["dim", "many.yaml"]);
    accepted(&format!("kind: ifs\nmaps:\n{maps}"), &INFO);
}

/// Returns a rule whose generator is a half circle of `count` chords.
fn half_circle(count: u32) -> String {
    let points = (0..=count).map(|number| {
        let angle = std::f64::consts::PI * f64::from(number) / f64::from(count);
        format!(
            "  - [{:.9}, {:.9}]\n",
            0.5 - 0.5 * angle.cos(),
            0.5 * angle.sin()
        )
    });
    let points: String = points.collect();
    format!("initiator: segment\ngenerator:\n{points}")
}

#[test]
fn limit_sets_of_many_copies_on_a_round_hull_have_boxes() {
    let text = half_circle(20_000);
    accepted(&text, &INFO);
    let bounds = graph_of(&text, 2).limit_bounds().unwrap();
    // The copies of the circle stand out by their height, which is half of a chord.
    let chord = std::f64::consts::PI / 40_000.0;
    let expected = [0.5 + 0.5 * chord, 1.0 + 0.5 * chord];
    assert!((bounds.max().y - expected[0]).abs() < 1e-8, "{bounds:?}");
    assert!((bounds.max().x - expected[1]).abs() < 1e-8, "{bounds:?}");
    let slow: String = (0..30)
        .map(|number| {
            let (turn, x, y) = (f64::from(number) * 37.77, number % 97, number % 89);
            format!("  - {{scale: 0.99, rotate: {turn}, translate: [{x}, {y}]}}\n")
        })
        .collect();
    accepted(&format!("kind: ifs\nmaps:\n{slow}"), &INFO);
}

#[test]
fn choices_of_many_generators_are_few() {
    let generators: String = (0..6000)
        .map(|number| format!("  g{number}: [[0, 0], [0.3, {}/10], [1, 0]]\n", number % 7))
        .collect();
    let names: Vec<String> = (0..6000).map(|number| format!("g{number}")).collect();
    let names = names.join(", ");
    let text =
        format!("initiator: segment\ngenerators:\n{generators}select: {{by_index: [{names}]}}\n");
    accepted(&text, &INFO);
    let cases: String = (0..1500)
        .map(|number| {
            format!(
                "  - {{when: step == {number} and i % {} == 1, use: b}}\n",
                number + 2
            )
        })
        .collect();
    let text = format!(
        "initiator: segment\ngenerators:\n  a: [[0, 0], [0.3, 0.2], [1, 0]]\n  b: [[0, 0], [0.5, 0.2], [1, 0]]\nselect:\n{cases}  \
         - {{use: a}}\n"
    );
    accepted(&text, &["info", "many.yaml", "--steps", "16"]);
}

#[test]
fn measures_of_many_states_are_found() {
    let maps: String = (0..900)
        .map(|i| {
            let (turn, x, y) = (i * 77 % 360, i % 17, i % 13);
            format!("  - {{scale: 0.01, rotate: {turn}, translate: [{x}, {y}]}}\n")
        })
        .collect();
    let edges = (1..=900).map(|from| {
        let targets = (0..40).map(|step| ((from * 7 + step * 61) % 900 + 1).to_string());
        format!("  {from}: [{}]\n", targets.collect::<Vec<_>>().join(", "))
    });
    let text = format!(
        "kind: ifs\nmaps:\n{maps}edges:\n{}",
        edges.collect::<String>()
    );
    accepted(&text, &INFO);
    let system = kfrac::Fractal::parse(&text).unwrap();
    let kfrac::model::Model::Ifs(system) = system.model() else {
        panic!("it is a system of the plane");
    };
    assert!(system.ifs().measure().is_some());
}

#[test]
fn many_generators_see_many_parameters() {
    let params: String = (0..10_000).map(|i| format!("  p{i}: 1\n")).collect();
    let generators: String = (0..10_000)
        .map(|i| {
            format!(
                "  g{i}: {{random: {{t: \"uniform(0, p{i})\"}}, elements: [[0, 0], [t/2, 0]]}}\n"
            )
        })
        .collect();
    let text = format!(
        "initiator: segment\nparams:\n{params}generators:\n{generators}select: {{by_index: [g0]}}\n"
    );
    accepted(&text, &CHECK);
}

#[test]
fn components_count_as_often_as_they_are_named() {
    let generators: String = (0..8_000)
        .map(|i| format!("  g{i}: quadric-32\n"))
        .collect();
    let text = format!("initiator: segment\ngenerators:\n{generators}select: {{by_index: [g0]}}\n");
    refused(
        text.as_bytes(),
        "with its components and repetitions the file holds more than 250,000 values",
    );
}

#[test]
fn many_parameters_are_inherited() {
    let folder = tempfile::tempdir().unwrap();
    let params: String = (0..60_000).map(|i| format!("  p{i}: 1\n")).collect();
    for (name, extends) in [("a", "koch"), ("b", "a.yaml"), ("many", "b.yaml")] {
        let text = format!("extends: {extends}\nparams:\n{params}");
        fs::write(folder.path().join(format!("{name}.yaml")), text).unwrap();
    }
    let outcome = kfrac(folder.path(), &CHECK);
    assert_eq!(outcome.status, Some(0), "{}", outcome.said);
}

/// Returns a structure with given objects and scene.
fn structure(objects: &str, scene: &str) -> String {
    format!("kind: instancing\nobjects:\n{objects}scene: [{scene}]\n")
}

const POINT: &str = "  a(0): [{point: [0, 0]}]\n";

#[test]
fn many_levels_are_few_objects() {
    let chain = format!("{POINT}  a(n): [{{object: a(n - 1), translate: [1, 0]}}]\n");
    accepted(&structure(&chain, "a(19999)"), &CHECK);
    let text = structure(&chain, "a(1500)");
    accepted(&text, &INFO);
    accepted(&text, &["show", "many.yaml"]);
    accepted(&text, &["grow", "many.yaml"]);
    let text = structure(&chain, "a(20000)");
    refused(text.as_bytes(), "more than 20000 levels of itself");
    let endless = format!("{POINT}  a(n): [a(n + 1)]\n");
    refused(structure(&endless, "a(1)").as_bytes(), "levels of itself");
    let large = format!("{POINT}  a(n): [{}]\n", "a(n - 1), ".repeat(100));
    refused(
        structure(&large, "a(15000)").as_bytes(),
        "more than 250000 instances",
    );
}

#[test]
fn many_shapes_are_told_apart() {
    let shapes: String = (0..20_000)
        .map(|i| format!("    - {{segment: [[0, {i}], [1, 0]]}}\n"))
        .collect();
    let text = structure(&format!("  a:\n{shapes}"), "a");
    accepted(&text, &CHECK);
    accepted(&text, &INFO);
    accepted(&text, &["grow", "many.yaml"]);
    accepted(&text, &["show", "many.yaml"]);
}

#[test]
fn many_loops_are_checked() {
    // Every object instances all others; one of each pair of instances grows.
    for (objects, factor) in [(40, "1/2"), (12, "[1.5, 0.3]"), (150, "[1.5, 0.3]")] {
        let names: Vec<_> = (0..objects)
            .map(|i| format!("{{object: a{i}, scale: {factor}, rotate: 90}}"))
            .collect();
        let one = names.join(", ");
        let all: String = (0..objects).map(|i| format!("  a{i}: *all\n")).collect();
        let text = structure(&format!("  first: &all [{one}]\n{all}"), "first");
        accepted(&text, &CHECK);
    }
}

#[test]
fn many_objects_in_each_other_are_bounded() {
    let count = 5_000;
    let objects = |instance: &dyn Fn(usize) -> String| {
        let objects = (0..count).map(|i| format!("  a{i}: [{}]\n", instance(i)));
        structure(&objects.collect::<String>(), "a0")
    };
    let crossed = |scale: f64| {
        objects(&|i| {
            let [next, other] = [i + 1, i * 7 + 3].map(|number| number % count);
            let turn = 0.37 * i as f64;
            format!(
                "{{object: a{next}, scale: {scale}, translate: [1, 0]}}, \
                 {{object: a{other}, scale: {scale}, rotate: {turn:.2}}}"
            )
        })
    };
    accepted(&crossed(0.6), &INFO);
    accepted(&crossed(0.9), &INFO);
    // Translations without turns reach farthest: 1 + 0.6 + 0.36 + …
    let bounds = graph_of(&crossed(0.6), 2).limit_bounds().unwrap();
    assert!((bounds.max().x - 2.5).abs() < 1e-12, "{bounds:?}");
    // All maps of a half enlarge, and those of the other half shrink more.
    let ring = objects(&|i| {
        let scale = if i < count / 2 { 1.01 } else { 0.9 };
        let before = (i + count - 1) % count;
        format!("{{object: a{before}, scale: {scale}, translate: [1, 0]}}")
    });
    accepted(&ring, &INFO);
    // Each map squeezes heights more than widths.
    let squeezed = objects(&|i| {
        let before = (i + count - 1) % count;
        format!("{{object: a{before}, scale: [0.9, 0.8], translate: [1, 0]}}")
    });
    accepted(&squeezed, &INFO);
}

#[test]
fn initial_sets_of_many_faces_are_left_out_of_limits() {
    let side = 80;
    let height = |i: usize, j: usize| (i * 7 + j * 3) % 5;
    let points = (0..=side).flat_map(|i| (0..=side).map(move |j| (i, j)));
    let points = points.map(|(i, j)| format!("[{i}/{side}, {j}/{side}, {}/50], ", height(i, j)));
    let faces = (0..side).flat_map(|i| {
        (0..side).map(move |j| {
            let corner = i * (side + 1) + j;
            format!("[{corner}, {}, {}], ", corner + 1, corner + side + 2)
        })
    });
    let maps = (0..8).map(|map| {
        let [x, y, z] = [map & 1, map >> 1 & 1, map >> 2];
        format!("  - {{scale: 1/2, translate: [{x}/2, {y}/2, {z}/2]}}\n")
    });
    let text = format!(
        "kind: ifs\nspace: 3\nmaps:\n{}initial: {{mesh: {{points: [{}], faces: [{}]}}}}\n",
        maps.collect::<String>(),
        points.collect::<String>(),
        faces.collect::<String>()
    );
    accepted(&text, &INFO);
    let source = Source::new("hostile.yaml", &text);
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    let (model, _) = document.resolve(&[]).unwrap();
    let bounds = model
        .compile_in_space(false)
        .unwrap()
        .limit_bounds()
        .unwrap();
    let sides = (bounds.max() - bounds.min()).to_array();
    assert!(
        sides.iter().all(|side| (side - 1.0).abs() < 1e-12),
        "{bounds:?}"
    );
}

#[test]
fn many_objects_see_many_parameters() {
    let params: String = (0..10_000).map(|i| format!("  p{i}: 1\n")).collect();
    let objects: String = (0..10_000)
        .map(|i| {
            format!(
                "  a{i}: [{{object: \"a{}\", scale: p{i}/2}}]\n",
                (i + 1) % 10_000
            )
        })
        .collect();
    let text = format!("params:\n{params}{}", structure(&objects, "a0"));
    accepted(&text, &CHECK);
}

fn graph_of(text: &str, steps: u32) -> Graph {
    let source = Source::new("hostile.yaml", text);
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    let (model, _) = document.resolve(&[]).unwrap();
    model.compile(steps).unwrap()
}

#[test]
fn forecasts_of_many_steps_are_given_up() {
    let steps = 1_000_000;
    let listed: String = (0..2_000)
        .map(|i| format!("  - {{to: [{}, 0], use: g{i}}}\n", i + 1))
        .collect();
    let generators: String = (0..2_000)
        .map(|i| {
            let next = (i + 1) % 2_000;
            format!("  g{i}: [[0, 0], {{to: [1/2, 0], use: g{next}}}]\n")
        })
        .collect();
    let text = format!(
        "initiator:\n  - [0, 0]\n{listed}generators:\n{generators}select: {{by_index: [g0]}}\n"
    );
    let graph = graph_of(&text, steps);
    assert_eq!(graph.check_size(steps, 2_000), Ok(None));
    let refused = graph.check_size(steps, 1_000).unwrap_err();
    assert_eq!((refused.elements, refused.deepest), (None, None));
}

#[test]
fn long_ways_to_few_elements_end() {
    let folder = tempfile::tempdir().unwrap();
    let lone = "initiator: segment\ngenerator:\n  parts:\n    - elements: [[0, 0], [1/2, 0]]\n    \
                - {seeds: true, elements: [[0, 1], {to: [1, 1], fertile: false}]}\nsteps: 20000\n";
    fs::write(folder.path().join("lone.yaml"), lone).unwrap();
    let outcome = kfrac(
        folder.path(),
        &["grow", "lone.yaml", "--max-elements", "100000"],
    );
    assert_eq!(outcome.status, Some(1));
    let message = "lone takes too long; --max-elements allows more";
    assert!(outcome.said.contains(message), "{}", outcome.said);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_walk_that_finds_nothing_can_be_cancelled() {
    // All elements vanish in the last step.
    let text = "initiator: segment\ngenerators:\n  a: [[0, 0], [1/4, 0], [1/2, 0], [3/4, 0], [1, 0]]\n  \
                v: {parts: [{seeds: true, elements: [[0, 0], [1/2, 0]]}]}\n\
                select: [{when: step == 40 and i > 0, use: v}, {use: a}]\n";
    let graph = graph_of(text, 41);
    let cancel = AtomicBool::new(true);
    let growth = Growth::steps(41).cancel(Some(&cancel));
    assert_eq!(bounding_box(&graph, &growth), Err(WalkError::Cancelled));
}

#[test]
fn fractals_of_fractals_are_counted() {
    let text = |steps: u32, count: usize| {
        let set = format!("  - {{fractal: koch, steps: {steps}}}\n");
        let sets = set.repeat(count);
        format!("kind: ifs\nmaps: [{{scale: 1/2}}]\ncondensation:\n{sets}")
    };
    accepted(&text(1, 1000), &CHECK);
    refused(text(1, 1001).as_bytes(), "more than 1000 others");
    accepted(&text(6, 24), &CHECK);
    refused(text(6, 25).as_bytes(), "more than 100000 lines");
    refused(text(1_000_000, 1).as_bytes(), "more than 100000 lines");
}

/// The depth of brackets exceeds that of the call stack.
#[test]
fn brackets_may_be_nested_deeply() {
    const DEPTH: usize = 45_000;
    let (open, close) = ("[".repeat(DEPTH), "]".repeat(DEPTH));
    let text =
        |axiom: String| format!("kind: lsystem\naxiom: '{axiom}'\nproductions: {{F: F+F}}\n");
    accepted(
        &text(format!("F{open}F{close}F")),
        &["count", "many.yaml", "--steps", "3"],
    );
    let contexts = "productions: ['F < F > F -> F[F]']";
    let context = text(format!("F{open}F{close}F")).replace("productions: {F: F+F}", contexts);
    accepted(&context, &["count", "many.yaml", "--steps", "3"]);
    refused(text(open.clone()).as_bytes(), "not closed");
    refused(text(close).as_bytes(), "no bracket is open");
    let polygons = "{".repeat(DEPTH) + "fff" + &"}".repeat(DEPTH);
    accepted(&text(polygons), &["count", "many.yaml", "--steps", "1"]);
    let brackets = "[".repeat(DEPTH) + &"]".repeat(DEPTH);
    let context = format!("kind: lsystem\naxiom: F\nproductions: ['F > {brackets} -> F']\n");
    refused(context.as_bytes(), "nested");
    let arguments = format!("F{}", "(".repeat(DEPTH));
    refused(text(arguments).as_bytes(), "not closed");
    refused(text("F".repeat(300_000)).as_bytes(), "100,000 modules");
    let mut state = 1_u32;
    let module = |_| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ["F", "+", "-", "F"][(state >> 30) as usize]
    };
    let word: String = (0..90_000).map(module).collect();
    let text = format!("kind: lsystem\nangle: 60\naxiom: F\nproductions:\n  F: {word}\n");
    accepted(&text, &INFO);
}

/// Returns a rule whose generator has a number of points on a sine curve.
fn many_points(count: usize) -> String {
    let points = (0..=count).map(|i| {
        let at = i as f64 / count as f64;
        let y = match i % count {
            0 => 0.0,
            _ => 0.3 * (3.0 * at).sin() + 1e-3 * (i * i % 7) as f64,
        };
        format!("  - [{at}, {y}]\n")
    });
    format!(
        "initiator: segment\ngenerator:\n{}",
        points.collect::<String>()
    )
}

#[test]
fn memory_does_not_grow_with_pairs_of_elements() {
    let text = many_points(6_000);
    accepted(&text, &CHECK);
    accepted(&text, &INFO);
    accepted(&text, &["dim", "many.yaml"]);
    let initiator: String = (0..60_000)
        .map(|i| format!("    - [{i}, {}]\n", i % 7))
        .collect();
    let text = format!("initiator:\n  elements:\n{initiator}generator: koch\n");
    accepted(&text, &["dim", "many.yaml", "--grids", "1"]);
}

#[test]
fn words_that_are_drawn_at_random_are_derived_as_far_as_needed() {
    let text = "kind: lsystem\nangle: 25\naxiom: F\nproductions:\n  F:\n    - {to: 'F[+F]F[-F]F', weight: 1/2}\n    \
                - {to: 'F[+F]F', weight: 1/2}\nsteps: 20\n";
    accepted(text, &CHECK);
    accepted(text, &["dim", "many.yaml"]);
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("deep.yaml"), text).unwrap();
    let outcome = kfrac(folder.path(), &["info", "deep.yaml"]);
    assert_eq!(outcome.status, Some(1));
    let message = "has more than 1,000,000 elements";
    assert!(outcome.said.contains(message), "{}", outcome.said);
    assert!(!outcome.said.contains("--max-elements"), "{}", outcome.said);
}

#[test]
fn numbers_of_a_million_digits_are_not_computed() {
    let folder = tempfile::tempdir().unwrap();
    let outcome = kfrac(folder.path(), &["grow", "koch", "--steps", "1000000"]);
    assert_eq!(outcome.status, Some(1));
    let message = "step 1000000 of koch has more elements than can be counted";
    assert!(outcome.said.contains(message), "{}", outcome.said);
    let outcome = kfrac(folder.path(), &["info", "archipelago", "--steps", "10000"]);
    assert_eq!(outcome.status, Some(0), "{}", outcome.said);
}
