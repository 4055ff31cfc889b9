//! Conversions between kinds, against the originals.

mod random;

use std::collections::BTreeMap;

use crate::common::{document, document_of};
use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::convert::{ConvertError, Keeps, Refusal, convert};
use kfrac::document::Document;
use kfrac::extent::NoLimit;
use kfrac::geometry::{Bounds, DVec3};
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::lsystem::NoGrowth;
use kfrac::measure::{Precision, Subject, Subset, hausdorff, similarity_dimension};
use kfrac::model::{Kind, Model};
use kfrac::style::ColorBy;

fn model(document: &Document) -> Model {
    let resolved = document.resolve(&[]);
    resolved
        .unwrap_or_else(|errors| panic!("{}", errors.render(false)))
        .0
}

/// Returns all fractals of the library with their names, except L-systems.
fn library() -> Vec<(String, Model)> {
    let catalogue = Catalogue::embedded();
    let entries = catalogue.entries().into_iter();
    let is_meant = |shelf| Shelf::grown().contains(&shelf) && shelf != Shelf::LSYSTEMS;
    let grown = entries.filter(|entry| is_meant(entry.shelf));
    grown
        .map(|entry| {
            let source = catalogue.component(entry.shelf, &entry.name).unwrap();
            let document = Document::read(&source, &catalogue).unwrap();
            (entry.name, model(&document))
        })
        .filter(|(_, model)| !model.is_in_space())
        .collect()
}

/// Asserts that a set of two graphs is the same; covers of few points show large differences.
fn assert_same(name: &str, graphs: [&Graph; 2], set: Subset<'_>) {
    let subjects = graphs.map(|graph| {
        let subject = Subject::new(graph, set);
        subject.unwrap_or_else(|error| panic!("{name}: {error}"))
    });
    // A limit set that takes too long to be bounded is not compared.
    if matches!(set, Subset::Limit) && graphs.iter().any(|graph| graph.limit_bounds().is_none()) {
        return;
    }
    let [a, b] = [0, 1].map(|which| *subjects[which].bounds());
    // A set may be a single point.
    let size = (a.size().max_element()).max(a.min().abs().max_element());
    for (a, b) in [(a.min(), b.min()), (a.max(), b.max())] {
        let off = (a - b).abs().max_element();
        assert!(off <= 1e-9 * size, "{name}: {a} and {b}");
    }
    let precision = Precision {
        tolerance: 1.0 / 16.0,
        max_points: 100_000,
    };
    // Sets that take too many points are compared by their boxes alone.
    if let Ok(distance) = hausdorff([&subjects[0], &subjects[1]], &precision) {
        assert!(distance.may_be_same(), "{name}: {distance:?}");
    }
}

#[test]
fn all_of_the_library_keeps_its_limit_set() {
    let mut converted: BTreeMap<_, usize> = BTreeMap::new();
    for (name, model) in library() {
        let graph = model.compile(64).unwrap();
        for to in Kind::ALL {
            if to == model.kind() {
                continue;
            }
            let document = match convert(&model, to, Keeps::Limit) {
                Ok(document) => document,
                Err(ConvertError::Refused(refusal)) => {
                    let is_limit = matches!(refusal, Refusal::NoLimit(_));
                    assert_eq!(is_limit, graph.limit().is_err(), "{name}");
                    continue;
                }
                // Each of the many elements of a scene becomes one of a rule.
                Err(error) if error.to_string().contains("is larger than 4 MiB") => continue,
                Err(error) => panic!("{name} to {to:?}: {error}"),
            };
            *converted.entry((model.kind(), to)).or_default() += 1;
            let other = self::model(&document);
            let other = other.compile(64).unwrap();
            assert_same(&name, [&graph, &other], Subset::Limit);
            let dimensions = [&graph, &other].map(similarity_dimension);
            if let [Some(a), Some(b)] = [dimensions[0].value, dimensions[1].value] {
                // Shapes that have become maps of lines and triangles have dimensions of their own.
                let may_be = [a, a.max(1.0), a.max(2.0)];
                let is_one = may_be.iter().any(|may| (may - b).abs() < 1e-9);
                assert!(is_one, "{name} to {to:?}: {a} and {b}");
            }
        }
    }
    let count = |from, to| converted.get(&(from, to)).copied().unwrap_or_default();
    assert!(count(Kind::Rule, Kind::Ifs) >= 25, "{converted:?}");
    assert!(count(Kind::Rule, Kind::Instancing) >= 30, "{converted:?}");
    assert!(count(Kind::Instancing, Kind::Ifs) >= 2, "{converted:?}");
    assert!(count(Kind::Rule, Kind::LSystem) >= 20, "{converted:?}");
}

#[test]
fn all_of_the_library_keeps_its_approximants() {
    let mut converted = 0;
    for (name, model) in library() {
        let graph = model.compile(64).unwrap();
        for to in Kind::ALL {
            let Ok(document) = convert(&model, to, Keeps::Approximants) else {
                continue;
            };
            converted += 1;
            let other = self::model(&document).compile(64).unwrap();
            for steps in 0..3 {
                let set = Subset::Approximant(Growth::steps(steps));
                if Subject::new(&graph, set).is_err() {
                    assert!(
                        Subject::new(&other, set).is_err(),
                        "{name} to {to:?}: step {steps}"
                    );
                    continue;
                }
                assert_same(&format!("{name} to {to:?}"), [&graph, &other], set);
            }
        }
    }
    assert!(converted >= 40, "{converted}");
}

fn converted(text: &str, to: Kind, keeps: Keeps) -> Result<String, String> {
    let model = model(&document_of(text));
    let converted = convert(&model, to, keeps);
    converted
        .map(|document| document.to_yaml())
        .map_err(|error| error.to_string())
}

const KOCH: &str = "\
title: Koch curve
initiator: segment
generator: [[0, 0], [1/3, 0], [1/2, sqrt(3)/6], [2/3, 0], [1, 0]]
style: {width: 2}
";

#[test]
fn a_rule_becomes_a_system_of_maps() {
    let expected = "\
kind: ifs
title: Koch curve
maps:
  - {scale: 1/3}
  - {times: [0.16666666666666669, 0.28867513459481287], translate: [1/3, 0]}
  - times: [0.16666666666666663, -0.28867513459481287]
    translate: [0.5, 0.28867513459481287]
  - {scale: 0.33333333333333337, translate: [2/3, 0]}
initial:
  segment:
    - [0, 0]
    - [1, 0]
style: {width: 2}
";
    let written = converted(KOCH, Kind::Ifs, Keeps::Approximants).unwrap();
    assert_eq!(written, expected);
}

/// A tree with a trunk that is kept, on a rotated and translated initiator.
const TREE: &str = "\
initiator: [[1, 1], [1, 3]]
generator:
  elements:
    - {from: [0, 0], to: [1, 0], fertile: false}
    - {from: [1, 0], to: [1.4, 0.3]}
    - {from: [1, 0], to: [1.3, -0.4], direction: 2}
";

#[test]
fn what_stays_becomes_a_condensation_set() {
    let written = converted(TREE, Kind::Ifs, Keeps::Approximants).unwrap();
    let segment = "segment:\n      - [1, 1]\n      - [1, 3]\n";
    assert!(
        written.contains(&format!("condensation:\n  - {segment}")),
        "{written}"
    );
    let initial = "initial:\n  segment:\n    - [1, 1]\n    - [1, 3]\n";
    assert!(written.contains(initial), "{written}");
}

#[test]
fn an_initiator_of_several_elements_becomes_a_recurrent_system() {
    let text = KOCH.replace("initiator: segment", "initiator: triangle");
    let written = converted(&text, Kind::Ifs, Keeps::Limit).unwrap();
    assert_eq!(
        written.matches("  - {scale").count()
            + written.matches("  - scale").count()
            + written.matches("times:").count(),
        12,
        "{written}"
    );
    // Copies are kept apart: only maps of the second side follow maps of the second side.
    assert!(
        written.contains("  \"5\": [\"5\", \"6\", \"7\", \"8\"]")
            || written.contains("5: [5, 6, 7, 8]"),
        "{written}"
    );
}

/// A recurrent system of three maps with a condensation set.
const RECURRENT: &str = "\
kind: ifs
maps:
  - {scale: 1/2}
  - {times: [0.25, 0.25], translate: [1/2, 0]}
  - {matrix: [[0.5, 0.125], [0, 0.375]], translate: [0, 1/2]}
edges: {1: [2, 3], 2: [1], 3: [1, 2, 3]}
condensation:
  - segment: [[0, 0], [0.25, 0.5]]
";

#[test]
fn a_recurrent_system_becomes_objects_and_a_system_again() {
    let objects = converted(RECURRENT, Kind::Instancing, Keeps::Limit).unwrap();
    assert!(objects.contains("A2:"), "{objects}");
    let again = converted(&objects, Kind::Ifs, Keeps::Limit).unwrap();
    let (Model::Ifs(first), Model::Ifs(second)) =
        (model(&document_of(RECURRENT)), model(&document_of(&again)))
    else {
        panic!("{again}");
    };
    let edges = |model: &kfrac::ifs::Ifs| {
        let mut edges: Vec<_> = model
            .edges()
            .unwrap()
            .map(|(edge, _)| (edge.from, edge.to))
            .collect();
        edges.sort_unstable();
        edges
    };
    assert_eq!(first.ifs().maps(), second.ifs().maps());
    assert_eq!(edges(first.ifs()), edges(second.ifs()));
    assert_eq!(first.ifs().condensation(), second.ifs().condensation());
}

/// Converts to a system, which must agree with the original to a hundredth.
fn as_system(text: &str) -> String {
    let written = converted(text, Kind::Ifs, Keeps::Limit).unwrap();
    let graphs = [text, &written].map(|text| model(&document_of(text)).compile(64).unwrap());
    let [a, b] = [0, 1].map(|which| Subject::new(&graphs[which], Subset::Limit).unwrap());
    let precision = Precision {
        tolerance: 0.01,
        ..Precision::default()
    };
    let distance = hausdorff([&a, &b], &precision).unwrap();
    assert!(distance.may_be_same(), "{distance:?}\n{written}");
    assert!(distance.error < 0.1, "{distance:?}");
    written
}

#[test]
fn shapes_that_are_not_everywhere_become_copies_of_themselves() {
    // Two trunks, each with a tree of its own: every line becomes two halves.
    let forest = TREE.replace("[[1, 1], [1, 3]]", "[[1, 1], [1, 3], [2, 3]]");
    let written = as_system(&forest);
    assert!(!written.contains("condensation"), "{written}");
    // A polygon with a notch, which does not follow the map: every triangle becomes four quarters.
    let notched = "\
kind: instancing
objects:
  A:
    - {object: A, scale: 1/2}
    - {object: A, scale: 1/3, translate: [2, 0]}
    - {segment: [[0, 0], [0, 1]]}
    - {point: [-1, -1]}
scene: [A, {polygon: [[3, 0], [5, 0], [5, 2], [4, 0.5], [3, 2]]}]
";
    assert!(as_system(notched).contains("-0.5"));
}

#[test]
fn a_disk_is_an_ellipse_under_any_map() {
    let disk = "\
kind: instancing
objects:
  A:
    - {object: A, scale: 1/2}
    - {disk: {radius: 1}, matrix: [[1, 0.5], [0, 0.5]], translate: [1, 0]}
scene: [A]
";
    let written = as_system(disk);
    assert!(written.contains("  - ellipse:"), "{written}");
}

#[test]
fn what_cannot_be_written_is_refused_with_the_reason() {
    let shear =
        "kind: ifs\nmaps:\n  - {scale: 1/2}\n  - {scale: [1/2, 1/4], translate: [1/2, 0]}\n";
    let seeds = "\
initiator: segment
generator:
  parts:
    - {elements: [[0, 0], [0.5, 0]]}
    - {seeds: true, placed: initiator, elements: [[0, 0], [0.5, 0]]}
";
    let grows = "initiator: segment\ngenerator: [[0, 0], [1, 1], [1, 0]]\n";
    let forest = TREE.replace("[[1, 1], [1, 3]]", "[[1, 1], [1, 3], [2, 3]]");
    let linked = format!("{KOCH}base_element: {{points: [[0, 0], [1/4, 0], [3/4, 1/4]]}}\n");
    let random = "initiator: segment\ngenerator:\n  random: {h: \"uniform(0, 1)\"}\n  elements: [[0, 0], [0.5, h/4], [1, 0]]\n";
    for (text, to, keeps, said) in [
        (
            shear,
            Kind::Rule,
            Keeps::Limit,
            "map 2 is no similarity: it stretches by 0.500000 one way and by 0.250000 another",
        ),
        (
            seeds,
            Kind::Ifs,
            Keeps::Limit,
            "its seeds are placed as the initiator",
        ),
        (
            grows,
            Kind::Instancing,
            Keeps::Limit,
            "what is replaced does not shrink",
        ),
        (
            &forest,
            Kind::Ifs,
            Keeps::Approximants,
            "a system draws one initial set at first, in one place",
        ),
        (
            random,
            Kind::Ifs,
            Keeps::Limit,
            "numbers are drawn in it at random",
        ),
        (
            KOCH,
            Kind::Rule,
            Keeps::Limit,
            "it is of the kind 'rule' already",
        ),
        (RECURRENT, Kind::Instancing, Keeps::Approximants, ""),
        (
            &linked,
            Kind::Instancing,
            Keeps::Approximants,
            "lines join base elements in it that do not end where their frames do",
        ),
        (&linked, Kind::Instancing, Keeps::Limit, ""),
    ] {
        match converted(text, to, keeps) {
            Err(error) => assert!(!said.is_empty() && error.contains(said), "{error}"),
            Ok(written) => assert!(said.is_empty(), "{written}"),
        }
    }
    let flat = model(&document_of(
        "initiator: segment\ngenerator: [[0, 0], {to: [1, 0], visible: false, fertile: false}]\n",
    ));
    let error = convert(&flat, Kind::Ifs, Keeps::Limit).unwrap_err();
    assert!(
        matches!(
            error,
            ConvertError::Refused(Refusal::NoLimit(NoLimit::Empty))
        ),
        "{error}"
    );
}

/// Of a system that has no limit set, a step is written.
#[test]
fn l_systems_become_what_they_draw() {
    let model_of = |name: &str| {
        let catalogue = Catalogue::embedded();
        let source = catalogue.component(Shelf::LSYSTEMS, name).unwrap();
        model(&Document::read(&source, &catalogue).unwrap())
    };
    for (name, reason) in [
        ("honda-tree", NoGrowth::Arguments),
        ("cordate-leaf", NoGrowth::Actions),
    ] {
        let own = model_of(name);
        let steps = own.metadata().steps.unwrap();
        let graph = own.compile(steps).unwrap();
        assert!(graph.is_time_indexed(), "{name}");
        let document = convert(&own, Kind::Instancing, Keeps::Limit).unwrap();
        let other = model(&document).compile(steps).unwrap();
        let set = Subset::Approximant(Growth::steps(steps));
        assert_same(name, [&graph, &other], set);
        let refused = convert(&own, Kind::Rule, Keeps::Limit);
        let reason = Refusal::NoLimit(NoLimit::Words(reason));
        assert!(matches!(refused, Err(ConvertError::Refused(why)) if why == reason));
    }
    for name in [
        "koch-lsystem",
        "gosper-lsystem",
        "levy-lsystem",
        "hilbert-lsystem",
        "dragon-lsystem",
        "plant-d",
    ] {
        let own = model_of(name);
        for to in [Kind::Rule, Kind::Ifs, Kind::Instancing] {
            let document = convert(&own, to, Keeps::Limit).unwrap();
            let graphs = [
                own.of_limit().compile(1).unwrap(),
                model(&document).compile(1).unwrap(),
            ];
            assert_same(name, [&graphs[0], &graphs[1]], Subset::Limit);
        }
    }
}

/// The strings of the literature for these curves.
#[test]
fn chains_of_equal_lines_become_plain_strings() {
    let strings = |name: &str| {
        let catalogue = Catalogue::embedded();
        let source = catalogue.component(Shelf::RULES, name).unwrap();
        let own = model(&Document::read(&source, &catalogue).unwrap());
        let written = convert(&own, Kind::LSystem, Keeps::Limit)
            .unwrap()
            .to_yaml();
        let kept = ["angle:", "heading:", "axiom:", "productions:", "symbols:"];
        let kept = written
            .lines()
            .filter(|line| kept.iter().any(|key| line.starts_with(key)));
        kept.collect::<Vec<_>>().join("\n")
    };
    assert_eq!(
        strings("koch"),
        "angle: 360/6\naxiom: F\nproductions: {F: F+F--F+F}"
    );
    assert_eq!(
        strings("terdragon"),
        "angle: 360/3\naxiom: F\nproductions: {F: F-F+F}"
    );
    // A is F traversed backwards.
    assert_eq!(
        strings("gosper"),
        "angle: 360/6\naxiom: F\nproductions: {F: F-A--A+F++FF+A-, A: +F-AA--A-F++F+A}\nsymbols: {A: draw}"
    );
    assert_eq!(
        strings("dragon"),
        "angle: 360/4\naxiom: F\nproductions: {F: F-A+, A: -F+A}\nsymbols: {A: draw}"
    );
    assert_eq!(
        strings("koch-snowflake"),
        "angle: 360/6\nheading: 60\naxiom: F--F--F\nproductions: {F: F+F--F+F}"
    );
}

/// The trunks are kept, and every instance is in brackets.
#[test]
fn other_rules_become_strings_with_ways() {
    let written = converted(TREE, Kind::LSystem, Keeps::Approximants).unwrap();
    assert!(written.contains("scale: s"), "{written}");
    assert!(written.contains("reflect"), "{written}");
    let (rule, other) = (model(&document_of(TREE)), model(&document_of(&written)));
    let graphs = [&rule, &other].map(|model| model.compile(8).unwrap());
    for steps in 0..6 {
        let set = Subset::Approximant(Growth::steps(steps));
        assert_same("a tree", [&graphs[0], &graphs[1]], set);
    }
    assert_same("a tree", [&graphs[0], &graphs[1]], Subset::Limit);
}

/// Branches as long as the one they grow on, which leads back to it only by way of a shorter one.
#[test]
fn what_shrinks_by_way_of_others_is_not_doubted() {
    let catalogue = Catalogue::embedded();
    let source = catalogue
        .component(Shelf::INSTANCING, "ternary-tree")
        .unwrap();
    let tree = model(&Document::read(&source, &catalogue).unwrap());
    let rule = convert(&tree, Kind::Rule, Keeps::Limit).unwrap();
    let (model, doubts) = rule.resolve(&[]).unwrap();
    assert!(doubts.is_empty(), "{doubts}");
    let boxes = [tree, model].map(|it| it.compile(4).unwrap().limit_bounds().unwrap());
    assert!((boxes[0].size() - boxes[1].size()).length() < 1e-9);
    // A branch that leads to itself at its own length has no limit set.
    let text = "initiator: {elements: [{from: [0, 0], to: [1, 0], use: a}]}\ngenerators:\n  \
                a: {elements: [{from: [0, 0], to: [1, 0], use: b}]}\n  \
                b: {elements: [{from: [0, 0], to: [1, 0], use: a}]}\n";
    let (_, doubts) = document_of(text).resolve(&[]).unwrap();
    assert!(doubts.to_string().contains("does not shrink"), "{doubts}");
}

/// Messages name objects as the file does.
#[test]
fn what_is_refused_is_called_by_its_name() {
    let text = "kind: instancing\nobjects:\n  twig: [{polyline: [[0, 0], [0, 1]]}]\n  \
                bough: {union: [twig, {object: leaf, translate: [0, 1]}], scale: 1/2}\n  \
                leaf: {union: [twig, {object: bough, scale: [1/2, 1/3]}], scale: 1/2}\n\
                scene: [bough]\n";
    let refused = convert(&model(&document_of(text)), Kind::Rule, Keeps::Approximants);
    let said = refused.unwrap_err().to_string();
    assert!(said.contains("of the object 'leaf'"), "{said}");
}

#[test]
fn polygons_without_an_area_become_the_lines_that_they_trace() {
    let catalogue = Catalogue::embedded();
    let source = catalogue
        .component(Shelf::LSYSTEMS, "cordate-leaf")
        .unwrap();
    let leaf = Document::read(&source, &catalogue).unwrap();
    let leaf = convert(&model(&leaf), Kind::Instancing, Keeps::Limit).unwrap();
    let written = leaf.to_yaml();
    assert!(
        written.contains("polygon:") && written.contains("segment:"),
        "{written}"
    );
}

#[test]
fn systems_in_space_become_structures_and_return() {
    let parsed = |text: &str| document_of(text).resolve(&[]).unwrap().0;
    let maps = |model: &Model| {
        let Model::IfsInSpace(system) = model else {
            panic!("it is a system in space");
        };
        let maps = system.ifs().maps().iter();
        maps.map(|map| map.affine.to_cols_array())
            .collect::<Vec<_>>()
    };
    let sponge = document("menger").resolve(&[]).unwrap().0;
    let plant = parsed(
        "kind: ifs
space: 3
maps:
  - {scale: 0.6, rotate: {axis: [1, 1, 0], angle: 35}, translate: [0, 1, 0]}
  - {matrix: [[0.5, 0.1, 0], [0, 0.4, 0], [0, 0, 0.3]], translate: [0, 1, 0]}
condensation:
  - {cylinder: {radius: 0.07}}
  - {sphere: {centre: [0, 1, 0], radius: 0.1}}
  - {box: {from: [0, 0, 0], to: [0.1, 0.2, 0.3]}}
  - {polygon: [[0, 0, 0], [1, 0, 0], [0, 1, 1]]}
",
    );
    for model in [sponge, plant] {
        let structure = convert(&model, Kind::Instancing, Keeps::Limit).unwrap();
        let structure = structure.resolve(&[]).unwrap().0;
        assert!(matches!(structure, Model::InstancingInSpace(_)));
        let bounds = |model: &Model| {
            model
                .compile_in_space(false)
                .unwrap()
                .limit_bounds()
                .unwrap()
        };
        let (own, found) = (bounds(&model), bounds(&structure));
        assert!(
            own.min().abs_diff_eq(found.min(), 1e-12) && own.max().abs_diff_eq(found.max(), 1e-12)
        );
        let back = convert(&structure, Kind::Ifs, Keeps::Limit).unwrap();
        let back = back.resolve(&[]).unwrap().0;
        for (own, found) in maps(&model).iter().zip(maps(&back)) {
            let same = own.iter().zip(found).all(|(a, b)| (a - b).abs() < 1e-14);
            assert!(same, "{own:?} {found:?}");
        }
        assert_eq!(maps(&model).len(), maps(&back).len());
        for kind in [Kind::Rule, Kind::LSystem] {
            let refused = convert(&model, kind, Keeps::Limit).unwrap_err();
            assert!(refused.to_string().contains("lies in space"), "{refused}");
        }
    }
}

fn bounds_in_space(model: &Model) -> Bounds<DVec3> {
    let limit = model.of_limit();
    let graph = limit.graph_in_space(64).unwrap().unwrap();
    graph.limit_bounds().unwrap()
}

fn assert_near(name: &str, own: Bounds<DVec3>, found: Bounds<DVec3>) {
    let size = own.size().max_element();
    for (a, b) in [(own.min(), found.min()), (own.max(), found.max())] {
        assert!(a.abs_diff_eq(b, 1e-9 * size), "{name}: {a} and {b}");
    }
}

#[test]
fn rules_in_space_become_systems_and_structures() {
    let mut converted = 0;
    for name in ["koch-surface", "menger-cubes", "koch-icosahedron"] {
        let model = document(name).resolve(&[]).unwrap().0;
        assert!(matches!(model, Model::RuleInSpace(_)), "{name}");
        for kind in [Kind::Ifs, Kind::Instancing] {
            let other = convert(&model, kind, Keeps::Limit);
            let other = other.unwrap_or_else(|error| panic!("{name}: {error}"));
            let other = other.resolve(&[]).unwrap().0;
            assert_near(name, bounds_in_space(&model), bounds_in_space(&other));
            converted += 1;
        }
    }
    assert_eq!(converted, 6);
}

/// Steps of L-systems in space are structures of tubes, polygons and surfaces with as many elements in one box.
#[test]
fn l_systems_in_space_become_structures() {
    let catalogue = Catalogue::embedded();
    let entries = catalogue.entries().into_iter();
    let mut converted = Vec::new();
    for entry in entries.filter(|entry| entry.shelf == Shelf::LSYSTEMS) {
        let source = catalogue.component(entry.shelf, &entry.name).unwrap();
        let model = model(&Document::read(&source, &catalogue).unwrap());
        if !model.is_in_space() {
            continue;
        }
        let structure = match convert(&model, Kind::Instancing, Keeps::Approximants) {
            Ok(document) => document.resolve(&[]).unwrap().0,
            Err(error) => {
                let text = error.to_string();
                let reasons = ["random", "tropism", "'$'", "250,000 values"];
                assert!(
                    reasons.iter().any(|it| text.contains(it)),
                    "{}: {text}",
                    entry.name
                );
                continue;
            }
        };
        assert_eq!(model.metadata().space, structure.metadata().space);
        let steps = model.resolved_steps_in_space(None);
        let drawn = |model: &Model| {
            let growth = Growth::steps(steps);
            let drawn = model.drawn_in_space(Some(steps), &growth, ColorBy::None);
            let graph = drawn.unwrap().unwrap().graph;
            let count = graph.check_size(steps, u64::MAX).unwrap();
            (graph.bounds(steps).unwrap(), count)
        };
        let ((own, own_count), (found, count)) = (drawn(&model), drawn(&structure));
        assert_near(&entry.name, own, found);
        assert_eq!(own_count, count, "{}", entry.name);
        converted.push(entry.name);
    }
    assert!(converted.len() >= 9, "{converted:?}");
}

/// Limit sets of L-systems in space are recurrent systems: Hilbert's curve fills a cube, and systems of the plane draw what
/// they draw in the plane.
#[test]
fn l_systems_in_space_become_systems() {
    let hilbert = document("hilbert-lsystem-in-space").resolve(&[]).unwrap().0;
    for kind in [Kind::Ifs, Kind::Instancing] {
        let system = convert(&hilbert, kind, Keeps::Limit).unwrap();
        let found = bounds_in_space(&system.resolve(&[]).unwrap().0);
        let sides = found.size();
        assert!(sides.abs_diff_eq(DVec3::ONE, 1e-12), "{sides}");
    }
    let mut flat = 0;
    for name in [
        "dragon-lsystem",
        "hilbert-lsystem",
        "peano-lsystem",
        "plant-b",
        "koch-lsystem",
    ] {
        let plane = document(name);
        let model = plane.resolve(&[]).unwrap().0;
        let limit = model.of_limit();
        let own = limit.compile(8).unwrap().limit_bounds().unwrap();
        let text = format!("space: 3\n{}", plane.to_yaml());
        let system = convert(
            &document_of(&text).resolve(&[]).unwrap().0,
            Kind::Ifs,
            Keeps::Limit,
        );
        let system = system.unwrap_or_else(|error| panic!("{name}: {error}"));
        let found = bounds_in_space(&system.resolve(&[]).unwrap().0);
        // A set of edge rewriting ends where the first step does, and others begin as its first part does.
        let scale = own.size().max_element() / found.size().max_element();
        let sides = found.size() * scale;
        let same = own.size().distance(sides.truncate()) <= 1e-6 * own.size().length();
        assert!(
            same && sides.z <= 1e-9,
            "{name}: {} and {sides}",
            own.size()
        );
        flat += 1;
    }
    assert_eq!(flat, 5);
}
