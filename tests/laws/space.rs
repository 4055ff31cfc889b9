//! Laws of rules in space.

use std::sync::Arc;

use kfrac::Count;
use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::document::Document;
use kfrac::geometry::{
    Attitude, Bounds, DMat3, DVec3, Direction, Frame as _, Frame2, Frame3, Outline as _,
};
use kfrac::graph::Graph;
use kfrac::grow::{Element, Elements, FractalInfo, Growth};
use kfrac::measure::similarity_dimension;
use kfrac::model::Model;
use kfrac::render::{MeshOptions, Options, write_mesh};
use kfrac::rule::{Rule, RuleFrame};
use kfrac::style::ColorBy;
use proptest::prelude::*;

use super::rules::{self, Features};
use super::{lists, model, read};

fn read_in_space(text: &str) -> Arc<Rule<Frame3>> {
    match model(text) {
        Model::RuleInSpace(rule) => rule,
        other => panic!("{:?} {text}", other.kind()),
    }
}

type Listed<F> = Vec<(FractalInfo, Element<F>)>;

fn grow<F: RuleFrame>(rule: &Arc<Rule<F>>, steps: u32, seed: u64) -> Listed<F> {
    let graph = Graph::compile(rule, steps).unwrap();
    elements(&graph, steps, seed)
}

fn elements<F: RuleFrame>(graph: &Graph<F>, steps: u32, seed: u64) -> Listed<F> {
    let growth = Growth::steps(steps).seed(seed).max_elements(20_000);
    Elements::of(graph, &growth).map_while(Result::ok).collect()
}

/// Asserts that elements in space are those of the plane, to the last bit.
fn assert_same(plane: &Listed<Frame2>, space: &Listed<Frame3>, name: &str) {
    assert_eq!(plane.len(), space.len(), "{name}");
    for ((fractal, plane), (other, space)) in plane.iter().zip(space) {
        assert_eq!(fractal, other, "{name}");
        let (own, linear) = (plane.frame.map(), space.frame.map().matrix3);
        assert_eq!(linear.x_axis, own.matrix2.x_axis.extend(0.0), "{name}");
        assert_eq!(linear.y_axis, own.matrix2.y_axis.extend(0.0), "{name}");
        let origin = own.translation.extend(0.0);
        assert_eq!(space.frame.origin(), origin, "{name}");
        assert_eq!(space.frame.direction(), plane.frame.direction(), "{name}");
        assert_eq!(space.length, plane.length, "{name}");
        assert_eq!(space.index, plane.index, "{name}");
        // Which outlines join depends on the base element.
        assert_eq!(space.fertile, plane.fertile, "{name}");
        assert_eq!(space.born, plane.born, "{name}");
    }
}

/// Returns a file in block style without a key at the top.
fn without(text: &str, key: &str) -> String {
    let mut left_out = false;
    let mut kept = String::new();
    for line in text.lines() {
        if !line.starts_with([' ', '-']) {
            left_out = line.starts_with(key);
        }
        if !left_out {
            kept.push_str(line);
            kept.push('\n');
        }
    }
    kept
}

#[test]
fn the_rules_of_the_library_are_the_same_in_space() {
    let catalogue = Catalogue::embedded();
    let mut compared = 0;
    for entry in catalogue.entries() {
        if entry.shelf != Shelf::RULES {
            continue;
        }
        let source = catalogue.open(&entry).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        if document.resolve(&[]).unwrap().0.is_in_space() {
            continue;
        }
        let text = without(&document.to_yaml(), "view:");
        let plane = read(&text);
        let space = read_in_space(&format!("space: 3\n{text}"));
        for steps in [0, 1, 3, 4] {
            let (plane, space) = (grow(&plane, steps, 7), grow(&space, steps, 7));
            assert_same(&plane, &space, &entry.name);
            compared += plane.len();
        }
    }
    assert!(compared > 50_000, "{compared}");
}

/// Returns a random rule of the plane as one in space: points get a third coordinate, elements directions from 1 to 8 and
/// attitudes, and turns an axis.
fn lifted(text: &str) -> String {
    let mut lifted = String::from("space: 3\n");
    let third = ["0", "1/5", "-1/3", "2/7", "1/2"];
    for (number, line) in text.lines().enumerate() {
        let mut line = line.replace(
            "rotate: tilt",
            "rotate: [{axis: [1, 2, -1], angle: tilt}, {y: 20}]",
        );
        let is_point = line.trim_start().starts_with("- [") || line.contains("to: [");
        let is_end = line.contains("[0, 0]") || line.contains("[1, 0]");
        if is_point && !is_end {
            let at = line.find("to: [").map_or(0, |at| at + 5);
            let end = at + line[at..].find(']').unwrap();
            line.insert_str(end, &format!(", {}", third[number % third.len()]));
        }
        if let Some(at) = line.find("direction: ") {
            let digit = at + "direction: ".len();
            let own: usize = line[digit..=digit].parse().unwrap();
            let direction = own + 4 * (number % 2);
            let attitude = ["", ", roll: 25", ", normal: [1/9, 1, 2]"][number % 3];
            line.replace_range(digit..=digit, &format!("{direction}{attitude}"));
        }
        lifted.push_str(&line);
        lifted.push('\n');
    }
    lifted
}

fn close(a: DVec3, b: DVec3) -> bool {
    a.distance(b) <= 1e-11 * (1.0 + a.length())
}

proptest! {
    #![proptest_config(crate::common::cases(200))]

    /// A rule of the plane has the same elements in space.
    #[test]
    fn a_plane_rule_is_the_same_in_space(text in rules::rule(Features::ALL), steps in 0..4u32, seed in 0..3u64) {
        let space = read_in_space(&format!("space: 3\n{text}"));
        assert_same(&grow(&read(&text), steps, seed), &grow(&space, steps, seed), &text);
    }

    /// The walk over the graph agrees with Kaandorp's algorithm on lists.
    #[test]
    fn the_walk_agrees_with_kaandorps_lists(text in rules::rule(Features::ALL), steps in 0..4u32, seed in 0..3u64) {
        let rule = read_in_space(&lifted(&text));
        let graph = Graph::compile(&rule, steps).unwrap();
        let walked = elements(&graph, steps, seed);
        let grown = lists::grow(&rule, steps, seed);
        let items = grown.all().into_iter().flat_map(|list| list.items.iter().map(|item| (list.age, item)));
        let items: Vec<_> = items.collect();
        prop_assert_eq!(walked.len(), items.len());
        for ((fractal, element), (age, item)) in walked.iter().zip(items) {
            prop_assert_eq!(fractal.age, age);
            prop_assert_eq!(element.frame.direction(), item.frame.direction());
            let (own, other) = (element.frame.map().matrix3, item.frame.map().matrix3);
            prop_assert!(own.abs_diff_eq(other, 1e-11), "{} {}", own, other);
            prop_assert!(close(element.frame.origin(), item.frame.origin()));
            prop_assert!((element.length - item.length).abs() < 1e-12);
            prop_assert_eq!(element.fertile, item.listed.fertile);
            prop_assert_eq!(element.born, item.born);
            // Frames are similarities, mirrored as their directions say.
            let ratio = element.frame.length();
            let square = own.transpose() * own / (ratio * ratio);
            prop_assert!(square.abs_diff_eq(DMat3::IDENTITY, 1e-9), "{}", square);
            prop_assert_eq!(own.determinant() < 0.0, element.frame.direction().is_mirrored());
        }
    }

    /// The forecast of a regular rule agrees with the walk, in numbers, length and surface.
    #[test]
    fn the_forecast_agrees_with_the_walk(text in rules::rule(Features::REGULAR), steps in 0..4u32) {
        let text = lifted(&text) + "base_element: {solid: cube}\n";
        let graph = Graph::compile(&read_in_space(&text), steps).unwrap();
        let Some(mut forecast) = graph.forecast() else { return Ok(()) };
        for _ in 0..steps {
            prop_assert!(forecast.advance());
        }
        let level = forecast.level();
        let walked = elements(&graph, steps, 0);
        prop_assert_eq!(level.elements, Count::from(walked.len()));
        let sum = |of: fn(f64) -> f64| {
            let visible = walked.iter().filter(|(_, it)| graph.objects()[it.object].visible);
            visible.map(|(_, element)| of(element.frame.length())).sum::<f64>()
        };
        let all: f64 = walked.iter().map(|(_, element)| element.frame.length()).sum();
        if let Some(length) = level.length {
            prop_assert!((length - all).abs() < 1e-9 * (1.0 + all));
        }
        if let Some(area) = level.area {
            let surface = sum(|length| 6.0 * length * length);
            prop_assert!((area - surface).abs() < 1e-9 * (1.0 + surface), "{} {}", area, surface);
        }
    }

    /// The bounds computed from the graph are those of the base elements of the walk.
    #[test]
    fn the_bounds_agree_with_the_walk(text in rules::rule(Features::DETERMINISTIC), steps in 0..4u32) {
        let text = lifted(&text) + "base_element: {solid: tetrahedron}\n";
        let graph = Graph::compile(&read_in_space(&text), steps).unwrap();
        let Some(bounds) = graph.bounds(steps) else { return Ok(()) };
        let mut walked = Bounds::EMPTY;
        for (_, element) in elements(&graph, steps, 0) {
            if graph.objects()[element.object].visible {
                graph.base_elements()[0].add_to(&mut walked, &element.frame, 0.0);
            }
        }
        prop_assert!(close(bounds.min(), walked.min()) && close(bounds.max(), walked.max()),
            "{:?} {:?}", bounds, walked);
    }

    /// Growing commutes with a similarity of the initiator.
    #[test]
    fn growing_commutes_with_a_similarity(
        text in rules::rule(Features { seeds: false, ..Features::ALL }),
        steps in 0..4u32,
        numbers in proptest::array::uniform3(-1.0..1.0f64),
    ) {
        let along = DVec3::from(numbers) + DVec3::new(0.0, 0.0, 1.5);
        let similarity = Frame3::between(DVec3::X, DVec3::X + along, Direction::Normal, Attitude::Roll(40.0));
        let lifted = lifted(&text);
        let (_, generators) = lifted.split_once("generators:").unwrap();
        let walk_of = |frame: &Frame3| {
            let at = |point: DVec3| format!("[{}, {}, {}]", point.x, point.y, point.z);
            let [from, to] = frame.ends().map(at);
            let normal = at(frame.map().matrix3.z_axis);
            let initiator = format!("initiator: [{{from: {from}, to: {to}, normal: {normal}}}]");
            grow(&read_in_space(&format!("space: 3\n{initiator}\ngenerators:{generators}")), steps, 1)
        };
        let (plain, moved) = (walk_of(&Frame3::UNIT), walk_of(&similarity));
        prop_assert_eq!(plain.len(), moved.len());
        for ((_, plain), (_, moved)) in plain.iter().zip(&moved) {
            let expected = similarity.compose(&plain.frame);
            let (own, other) = (expected.map().matrix3, moved.frame.map().matrix3);
            prop_assert!(own.abs_diff_eq(other, 1e-10), "{} {}", own, other);
            prop_assert!(close(expected.origin(), moved.frame.origin()));
        }
    }
}

/// Returns a rule of the library in space.
fn of_library(name: &str) -> Model {
    let catalogue = Catalogue::embedded();
    let source = catalogue.component(Shelf::RULES, name).unwrap();
    let document = Document::read(&source, &catalogue).unwrap();
    let (model, warnings) = document.resolve(&[]).unwrap();
    assert!(warnings.is_empty(), "{name}: {warnings:?}");
    model
}

#[test]
fn rules_of_the_library_in_space_have_their_dimensions_and_are_drawn() {
    let mut found = 0;
    for entry in Catalogue::embedded().entries() {
        let source = Catalogue::embedded().open(&entry).unwrap();
        if entry.shelf != Shelf::RULES || !source.text().contains("\nspace: 3\n") {
            continue;
        }
        let model = of_library(&entry.name);
        let steps = model.metadata().steps.unwrap().min(3);
        let graph = model.graph_in_space(steps).unwrap().unwrap();
        let similarity = similarity_dimension(&graph).value;
        if let Some(published) = model.metadata().dimension {
            let similarity = similarity.unwrap();
            assert!(
                (similarity - published).abs() < 1e-12,
                "{} {similarity}",
                entry.name
            );
        }
        let growth = Growth::steps(steps).seed(3);
        let drawn = model.drawn_in_space(Some(steps), &growth, ColorBy::None);
        let drawn = drawn.unwrap().unwrap();
        assert!(drawn.graph.is_plain(), "{}", entry.name);
        let bounds = drawn.graph.bounds(drawn.steps.unwrap()).unwrap();
        assert!(bounds.size().min_element() > 0.0, "{}", entry.name);
        found += 1;
    }
    assert!(found >= 12, "{found}");
}

#[test]
fn the_sponge_of_cubes_has_the_cubes_and_faces_of_mengers() {
    let model = of_library("menger-cubes");
    for (steps, shell) in [(1, 72), (2, 1056), (3, 18048)] {
        let graph = model.graph_in_space(steps).unwrap().unwrap();
        let mut forecast = graph.forecast().unwrap();
        (0..steps).for_each(|_| assert!(forecast.advance()));
        let level = forecast.level();
        assert_eq!(level.elements, Count::from(20_u64.pow(steps)));
        // All sides of all cubes: 6 (20/9)ⁿ.
        let sides = 6.0 * (20.0_f64 / 9.0).powi(i32::try_from(steps).unwrap());
        assert!((level.area.unwrap() - sides).abs() < 1e-9);
        let mut out = Vec::new();
        let options = MeshOptions::default().shell(true);
        let growth = Growth::steps(steps);
        let written = write_mesh(&graph, &growth, &Options::default(), options, &mut out).unwrap();
        // A square is two triangles in STL.
        let faces = written.faces;
        assert!(faces == shell || faces == 2 * shell, "{faces}");
    }
}

#[test]
fn a_base_element_of_several_surfaces_is_one_element_and_several_shapes() {
    let text = "space: 3\ninitiator: tiles\ngenerator: koch-squares\nbase_element:\n  surfaces:\n    \
                - {points: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], color: gold}\n    \
                - {points: [[0, 0, 0], [1, 0, 0], [1/2, 1/2, 1/2]]}\n";
    let model = model(text);
    for steps in 0..3 {
        let growth = Growth::steps(steps);
        let graph = model.graph_in_space(steps).unwrap().unwrap();
        let elements = elements(&graph, steps, 0).len();
        assert_eq!(elements, 9 * 13_usize.pow(steps));
        let drawn = model
            .drawn_in_space(Some(steps), &growth, ColorBy::None)
            .unwrap()
            .unwrap();
        let shapes = super::space::elements(&drawn.graph, steps, 0);
        let visible = shapes
            .iter()
            .filter(|(_, it)| drawn.graph.objects()[it.object].visible);
        assert_eq!(visible.count(), 2 * elements);
        assert!(drawn.graph.tints());
    }
}

/// The middles of the cells of a curve, in its order: `middle` is that of the cell of the unit element.
fn cells(name: &str, steps: u32, middle: DVec3) -> Vec<DVec3> {
    let graph = of_library(name).graph_in_space(steps).unwrap().unwrap();
    let all = elements(&graph, steps, 0);
    let ends = all.iter().map(|(_, element)| element.frame.ends());
    let ends: Vec<_> = ends.collect();
    assert!(ends.windows(2).all(|pair| close(pair[0][1], pair[1][0])));
    all.iter()
        .map(|(_, element)| element.frame.map().transform_point3(middle))
        .collect()
}

/// Hilbert 1891, in space: all 8ⁿ cells once, each in a face with the one before.
#[test]
fn the_hilbert_curve_goes_through_all_cells_of_a_cube() {
    for steps in 0..=4 {
        let middles = cells("hilbert-in-space", steps, DVec3::new(0.5, 0.5, -0.5));
        let side = f64::from(1 << steps);
        let mut found: Vec<[i64; 3]> = { middles.iter() }
            .map(|middle| {
                let at = *middle * side - DVec3::new(0.5, 0.5, -0.5);
                assert!(at.distance(at.round()) < 1e-9, "{at}");
                #[expect(clippy::cast_possible_truncation, reason = "cells are few")]
                at.round().to_array().map(|it| it as i64)
            })
            .collect();
        let is_step = |pair: &[[i64; 3]]| {
            let apart = [0, 1, 2].map(|axis| (pair[1][axis] - pair[0][axis]).abs());
            apart.iter().sum::<i64>() == 1
        };
        assert!(found.windows(2).all(is_step), "step {steps}");
        found.sort_unstable();
        found.dedup();
        assert_eq!(found.len(), 8_usize.pow(steps));
        let inside = |cell: &[i64; 3]| {
            let [x, y, z] = cell.map(|it| it.unsigned_abs());
            x.max(y).max(z) < 1 << steps && cell[0] >= 0 && cell[1] >= 0 && cell[2] <= 0
        };
        assert!(found.iter().all(inside), "step {steps}");
    }
}

/// The arrowhead passes the tetrahedra of Sierpinski's, each once.
#[test]
fn the_arrowhead_goes_through_all_tetrahedra() {
    let middle = DVec3::new(0.5, 3f64.sqrt() / 6.0, -6f64.sqrt() / 12.0);
    for steps in 0..=5 {
        let own = cells("arrowhead-in-space", steps, middle);
        let model = model(&format!(
            "space: 3\ninitiator: [{{face: [[0, 0, 0], [1, 0, 0], [1/2, 0, sqrt(3)/2]]}}]\ngenerator:\n{TETRIX}"
        ));
        let graph = model.graph_in_space(steps).unwrap().unwrap();
        let tetrix = elements(&graph, steps, 0);
        assert_eq!(own.len(), tetrix.len());
        let mut names = [
            own,
            { tetrix.iter() }
                .map(|(_, element)| element.frame.map().transform_point3(middle))
                .collect(),
        ];
        let names = names.each_mut().map(|middles| {
            #[expect(clippy::cast_possible_truncation, reason = "cells are few")]
            let names = middles
                .iter()
                .map(|it| (*it * 1e6).round().to_array().map(|it| it as i64));
            let mut names: Vec<[i64; 3]> = names.collect();
            names.sort_unstable();
            names
        });
        assert_eq!(names[0], names[1], "step {steps}");
    }
}

const TETRIX: &str = "  connected: false
  elements:
    - {from: [0, 0, 0], to: [1/2, 0, 0]}
    - {from: [1/2, 0, 0], to: [1, 0, 0]}
    - {from: [1/4, sqrt(3)/4, 0], to: [3/4, sqrt(3)/4, 0]}
    - {from: [1/4, sqrt(3)/12, -sqrt(6)/6], to: [3/4, sqrt(3)/12, -sqrt(6)/6]}
";

/// A draw by edge depends on the edge alone: not on the element that draws it, its order or its steps.
#[test]
fn draws_belong_to_edges() {
    // Two triangles on both sides of an edge, which they list in opposite directions and in other places.
    let rule = |others: &str| {
        read_in_space(&format!(
            "space: 3\ninitiator:\n  - {{corners: [[0, 0, 0], [1, 0, 0], [1/2, 1, 0]]}}\n  \
             - {{corners: [[1/2, -1, 0], [1, 0, 0], [0, 0, 0]]}}\n{others}generator:\n  random:\n    \
             lift: by_edge(uniform(-1, 1))\n    own: uniform(-1, 1)\n  elements:\n    \
             - {{from: [0, 0, 0], to: [1/2, lift_01, own]}}\n    \
             - {{from: [0, 0, 0], to: [1/2, lift_12, own]}}\n    - {{from: [0, 0, 0], to: [1/2, lift_20, own]}}\n\
             base_element: triangle-tile\n"
        ))
    };
    let drawn = |rule: &Arc<Rule<Frame3>>, seed: u64, element: usize| {
        let graph = Graph::compile(rule, 1).unwrap();
        let all = elements(&graph, 1, seed);
        let frames = rule.initiator().elements.iter();
        let parent = frames.map(|it| Frame3::placed(it, rule.initiator_points()));
        let back = parent.collect::<Vec<_>>()[element].map().inverse();
        [0, 1, 2].map(|edge: usize| {
            let [_, to] = all[3 * element + edge].1.frame.ends();
            back.transform_point3(to)
                .to_array()
                .map(|it| (it * 1e9).round())
        })
    };
    for seed in 0..20 {
        let plain = rule("");
        let [above, below] = [0, 1].map(|element| drawn(&plain, seed, element));
        // Edge 0 of the one is edge 1 of the other.
        assert_eq!(above[0][1], below[1][1]);
        assert_ne!(above[0][1], above[1][1]);
        assert_ne!(above[0][2], below[1][2]);
        // Further elements change nothing.
        let more = rule("  - {corners: [[5, 0, 0], [6, 0, 0], [5, 1, 0]]}\n");
        assert_eq!(drawn(&more, seed, 1), below);
    }
}

/// Turns about axes across z, by up to 25°: elements along z come to lie in a cone about it, in all directions, and as far from
/// it as drawn.
#[test]
fn generators_tilt_within_a_cone() {
    const COUNT: usize = 400;
    let text = format!(
        "space: 3\ninitiator:\n  - {{for: {{k: 1..{COUNT}}}, from: [k, 0, 0], to: [k + 1/2, 0, 0]}}\n\
         generator:\n  random:\n    around: uniform(0, 360)\n    tilt: uniform(0, 25)\n  \
         move: {{rotate: {{axis: [cos(around), sin(around), 0], angle: tilt}}, points: all}}\n  elements:\n    \
         - {{from: [0, 0, 0], to: [0, 0, 1]}}\n"
    );
    let rule = read_in_space(&text);
    let along = grow(&rule, 1, 7).into_iter().map(|(_, element)| {
        let along = element.frame.map().matrix3.x_axis;
        along / along.length()
    });
    let along: Vec<DVec3> = along.collect();
    assert_eq!(along.len(), COUNT);
    let tilts = { along.iter() }.map(|along| along.z.clamp(-1.0, 1.0).acos().to_degrees());
    let tilts: Vec<f64> = tilts.collect();
    assert!(tilts.iter().all(|tilt| *tilt <= 25.0 + 1e-9));
    // Of a uniform law; the standard error of the mean is 0.36 degrees.
    let mean = tilts.iter().sum::<f64>() / COUNT as f64;
    assert!((mean - 12.5).abs() < 1.5, "{mean}");
    let mut quadrants = [0; 4];
    for along in &along {
        quadrants[usize::from(along.x > 0.0) + 2 * usize::from(along.y > 0.0)] += 1;
    }
    let all = quadrants.iter().all(|count| *count > COUNT / 8);
    assert!(all, "{quadrants:?}");
}
