//! The turtle in space: headings against rotations about axes in space, and systems against closed forms.

use std::collections::BTreeSet;

use kfrac::Fractal;
use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::geometry::{DMat3, DVec2, DVec3};
use kfrac::geometry::{Frame, Frame3, Outline as _};
use kfrac::graph::Graph;
use kfrac::grow::{Elements, Growth};
use kfrac::lsystem::{NoGraph, Tropism};
use kfrac::model::Model;
use kfrac::style::ColorBy;

use crate::common::document_of;

/// Returns a model in space from text.
fn model(text: &str) -> Model {
    let document = document_of(&format!("kind: lsystem\nspace: 3\n{text}"));
    let (model, warnings) = document
        .resolve(&[])
        .unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    assert!(warnings.is_empty(), "{}", warnings.render(false));
    model
}

/// Returns the frames of the elements of a graph that are drawn, in order.
fn placed(graph: &Graph<Frame3>, steps: u32) -> Vec<Frame3> {
    let elements = Elements::of(graph, &Growth::steps(steps));
    let elements = elements.map(|element| element.unwrap().1);
    let drawn = elements.filter(|element| graph.objects()[element.object].visible);
    drawn.map(|element| element.frame).collect()
}

fn frames(model: &Model, steps: u32) -> Vec<Frame3> {
    placed(&model.graph_in_space(steps).unwrap().unwrap(), steps)
}

fn walked(model: &Model) -> Option<NoGraph> {
    match model {
        Model::LSystemInSpace(system) => system.walked(),
        _ => panic!("a system in space"),
    }
}

/// Turns a vector about an axis by the right-hand rule (Rodrigues 1840), with the trigonometry of the platform.
fn about(axis: DVec3, degrees: f64, vector: DVec3) -> DVec3 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    vector * cosine + axis.cross(vector) * sine + axis * axis.dot(vector) * (1.0 - cosine)
}

/// A turtle whose vectors H, L and U are turned in space, one by one.
struct Reference {
    at: DVec3,
    axes: [DVec3; 3],
}

impl Reference {
    fn read(&mut self, symbol: char, value: f64) -> Option<[DVec3; 2]> {
        let [ahead, left, up] = self.axes;
        let (axis, angle) = match symbol {
            '+' => (up, value),
            '-' => (up, -value),
            '&' => (left, value),
            '^' => (left, -value),
            '/' => (ahead, value),
            '\\' => (ahead, -value),
            '|' => (up, 180.0),
            _ => {
                let from = self.at;
                self.at += ahead * value;
                return Some([from, self.at]);
            }
        };
        // Without the lengths, rounding errors grow from turn to turn.
        self.axes = { self.axes }.map(|vector| about(axis, angle, vector).normalize());
        None
    }
}

#[test]
fn symbols_turn_about_the_axes_of_the_turtle() {
    let mut state = 12_345_u64;
    let mut random = |most: u64| -> usize {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        usize::try_from((state >> 33) % most).unwrap()
    };
    for _ in 0..40 {
        let mut word = String::new();
        let mut turtle = Reference {
            at: DVec3::ZERO,
            axes: [DVec3::X, DVec3::Y, DVec3::Z],
        };
        let mut lines = Vec::new();
        for _ in 0..30 {
            let symbol = ['+', '-', '&', '^', '/', '\\', '|', 'F', 'F'][random(9)];
            let value = [15.0, 90.0, 45.0, 30.0, 22.5, 137.5, 7.0, 180.0][random(8)];
            let value = if symbol == 'F' { value / 45.0 } else { value };
            match symbol {
                '|' => word.push('|'),
                _ => word += &format!("{symbol}({value})"),
            }
            let up = turtle.axes[2];
            lines.extend(turtle.read(symbol, value).map(|line| (line, up)));
        }
        let word = word.replace('\\', "\\\\");
        let frames = frames(
            &model(&format!("axiom: \"{word}\"\nproductions: {{}}\n")),
            0,
        );
        assert_eq!(frames.len(), lines.len(), "{word}");
        for (frame, ([from, to], up)) in frames.iter().zip(lines) {
            let [own_from, own_to] = frame.ends();
            let near = |a: DVec3, b: DVec3| (a - b).length() < 1e-11;
            assert!(near(own_from, from) && near(own_to, to), "{word}");
            let own_up = frame.map().matrix3.z_axis.normalize();
            assert!(near(own_up, up), "{word}: {own_up} {up}");
        }
    }
}

/// ABOP, section 1.5: H × L = U, + turns left, & down, and the half turn keeps the back upwards.
#[test]
fn single_symbols_by_hand() {
    let ends = |word: &str| {
        let text = format!("angle: 90\naxiom: \"{word}\"\nproductions: {{}}\n");
        let frames = frames(&model(&text), 0);
        let frame = frames.last().unwrap();
        (frame.ends()[1], frame.map().matrix3.z_axis)
    };
    assert_eq!(ends("F"), (DVec3::X, DVec3::Z));
    assert_eq!(ends("+F"), (DVec3::Y, DVec3::Z));
    assert_eq!(ends("-F"), (DVec3::NEG_Y, DVec3::Z));
    assert_eq!(ends("&F"), (DVec3::NEG_Z, DVec3::X));
    assert_eq!(ends("^F"), (DVec3::Z, DVec3::NEG_X));
    assert_eq!(ends("|F"), (DVec3::NEG_X, DVec3::Z));
    assert_eq!(ends("/F"), (DVec3::X, DVec3::NEG_Y));
    assert_eq!(ends("\\\\F"), (DVec3::X, DVec3::Y));
    assert_eq!(ends("/+F"), (DVec3::Z, DVec3::NEG_Y));
}

#[test]
fn levelling_lays_the_left_side_flat_and_keeps_the_heading() {
    for turns in [
        "&(20)/(70)+(33)",
        "^(50)/(200)",
        "/(45)",
        "&(110)+(10)/(300)",
    ] {
        let text = |level: &str| format!("axiom: \"{turns}{level}F\"\nproductions: {{}}\n");
        let before = frames(&model(&text("")), 0)[0];
        let levelled = model(&text("$"));
        assert_eq!(walked(&levelled), Some(NoGraph::Level));
        let after = frames(&levelled, 0)[0].map().matrix3;
        assert!((before.map().matrix3.x_axis - after.x_axis).length() < 1e-14);
        assert!(
            after.y_axis.y.abs() < 1e-14 && after.z_axis.y > 0.0,
            "{after}"
        );
        assert!((after.x_axis.cross(after.y_axis) - after.z_axis).length() < 1e-14);
    }
    // Upwards there is nothing to level.
    let upright = frames(&model("heading: 90\naxiom: $F\nproductions: {}\n"), 0)[0];
    assert_eq!(upright.map().matrix3.x_axis, DVec3::Y);
    // Nor after turns there and back, whose rounding does not decide about the left side.
    for angle in [18, 25] {
        let text = |level: &str| {
            format!("heading: 90\naxiom: /(40)&({angle})^({angle}){level}F\nproductions: {{}}\n")
        };
        let [before, after] = ["", "$"].map(|level| frames(&model(&text(level)), 0)[0]);
        assert!((before.map().matrix3.y_axis - after.map().matrix3.y_axis).length() < 1e-14);
    }
}

/// ABOP, section 2.3.3: the turtle turns by e · |H × T| about H × T after each line.
#[test]
fn tropism_bends_by_its_formula() {
    let text = "heading: [1, 1, 0]\ntropism: {towards: [0, -2, 0], e: 0.1}\naxiom: FFFF\nproductions: {}\n";
    let model = model(text);
    assert_eq!(walked(&model), Some(NoGraph::Tropism));
    let lines = frames(&model, 0);
    for pair in lines.windows(2) {
        let [a, b] = [&pair[0], &pair[1]].map(|frame| frame.map().matrix3.x_axis);
        let across = a.cross(DVec3::new(0.0, -2.0, 0.0));
        let angle = 0.1 * across.length();
        assert!((a.dot(b) - angle.cos()).abs() < 1e-14);
        assert!((a.cross(b) - across.normalize() * angle.sin()).length() < 1e-14);
    }
    let tropism = Tropism {
        towards: DVec3::Y,
        susceptibility: 0.3,
    };
    assert_eq!(tropism.turn(DVec3::Y), DMat3::IDENTITY);
}

/// Hilbert in space (ABOP, fig. 1.19): 8ⁿ cells, each visited once by unit steps.
#[test]
fn hilbert_visits_all_cells_of_a_cube_once() {
    let model = of_library("hilbert-lsystem-in-space");
    for steps in 1..=4 {
        let lines = frames(&model, steps);
        let cells = 8_usize.pow(steps);
        assert_eq!(lines.len(), cells - 1);
        let mut visited = BTreeSet::new();
        let first = lines[0].ends()[0];
        let points = std::iter::once(first).chain(lines.iter().map(|line| line.ends()[1]));
        let mut bounds = [first; 2];
        let mut last = first;
        for (number, point) in points.enumerate() {
            assert!(number == 0 || ((point - last).length() - 1.0).abs() < 1e-12);
            let cell = point.round();
            assert!((cell - point).length() < 1e-9);
            // Adding zero turns −0 into 0.
            visited.insert(cell.to_array().map(|at| (at + 0.0).to_bits()));
            bounds = [bounds[0].min(cell), bounds[1].max(cell)];
            last = point;
        }
        assert_eq!(visited.len(), cells);
        let side = f64::from(2_u32.pow(steps) - 1);
        assert_eq!(bounds[1] - bounds[0], DVec3::splat(side));
    }
}

/// Hart 1992, equations (5) to (8): 2·3ⁿ − 1 lines, and the two systems differ by scale alone.
#[test]
fn the_trees_of_hart_have_their_lines_and_one_shape() {
    let apices = of_library("hart-tree-lsystem");
    let nodes = of_library("hart-tree-elongating");
    for steps in 0..=5_u32 {
        let (a, b) = (frames(&apices, steps), frames(&nodes, steps));
        let lines = 2 * 3_usize.pow(steps) - 1;
        assert_eq!([a.len(), b.len()], [lines; 2]);
        let scale = 1.109_f64.powi(steps.cast_signed());
        for (a, b) in a.iter().zip(&b) {
            for (a, b) in a.ends().into_iter().zip(b.ends()) {
                assert!((a * scale - b).length() < 1e-9 * (1.0 + b.length()));
            }
        }
    }
    // Of far steps, too, no word is written down.
    for (model, steps) in [
        (apices, 400),
        (of_library("hilbert-lsystem-in-space"), 1000),
    ] {
        let graph = model.graph_in_space(steps).unwrap().unwrap();
        assert_eq!(graph.depth(), Some(steps));
    }
}

/// A system that has a tropism without an effect is read word by word.
#[test]
fn compiled_systems_draw_what_the_word_does() {
    for name in [
        "hilbert-lsystem-in-space",
        "bush-in-space",
        "flowering-plant",
        "hart-tree-lsystem",
        "hart-tree-elongating",
        "phyllotaxis-cone",
        "conifer",
        "umbel",
        "dragon-lsystem-in-space",
        "spiral-stair",
    ] {
        let compiled = of_library(name);
        assert_eq!(walked(&compiled), None, "{name}");
        let text = text_of(name);
        let read = document_of(&format!("{text}\ntropism: {{towards: [0, -1, 0], e: 0}}\n"));
        let (read, _) = read.resolve(&[]).unwrap();
        assert_eq!(walked(&read), Some(NoGraph::Tropism));
        for steps in [0, 1, 2, 4, 5] {
            let graph = compiled.graph_in_space(steps).unwrap().unwrap();
            assert_eq!(graph.depth(), Some(steps), "{name} is compiled");
            let (a, b) = (placed(&graph, steps), frames(&read, steps));
            assert_eq!(a.len(), b.len(), "{name} at step {steps}");
            is_near(&a, &b, name);
            // As drawn, with tubes and surfaces.
            let growth = Growth::steps(steps);
            let drawn = [&compiled, &read].map(|model| {
                let drawn = model.drawn_in_space(Some(steps), &growth, ColorBy::None);
                let drawn = drawn.unwrap().unwrap();
                (placed(&drawn.graph, steps), drawn)
            });
            let [(a, one), (b, other)] = drawn;
            is_near(&a, &b, name);
            assert_eq!(one.graph.tints(), other.graph.tints());
        }
    }
}

fn is_near(a: &[Frame3], b: &[Frame3], name: &str) {
    assert_eq!(a.len(), b.len(), "{name}");
    for (a, b) in a.iter().zip(b) {
        let size = 1.0 + b.map().translation.length() + b.stretch();
        let near = a.map().abs_diff_eq(*b.map(), 1e-9 * size);
        assert!(near, "{name}: {:?} {:?}", a.map(), b.map());
    }
}

/// The law of space.md: the plane's systems under `space: 3` have the plane's elements.
#[test]
fn systems_of_the_plane_are_the_same_in_space() {
    let catalogue = Catalogue::embedded();
    let mut found = 0;
    for entry in catalogue.entries() {
        let text = catalogue.open(&entry).unwrap().text().to_owned();
        let is_base = !text.contains("extends:") && !text.contains("\nview: {window");
        if entry.shelf != Shelf::LSYSTEMS || text.contains("\nspace: 3\n") || !is_base {
            continue;
        }
        let (plane, _) = document_of(&text).resolve(&[]).unwrap();
        let (space, _) = document_of(&format!("{text}\nspace: 3\n"))
            .resolve(&[])
            .unwrap_or_else(|errors| panic!("{}", errors.render(false)));
        let Model::LSystem(system) = &plane else {
            panic!("{}", entry.name);
        };
        for steps in [0, 1, 3] {
            let word = system.word(steps, 0, 1_000_000).unwrap();
            let drawing = system.draw(&word);
            let frames = frames(&space, steps);
            // In space, a polygon on a line has no extent, and is not visible.
            let is_flat = |number: usize| drawing.polygons[number].signed_area().abs() < 1e-12;
            let elements = drawing.elements.iter();
            let elements: Vec<_> = elements
                .filter(|it| !it.polygon().is_some_and(is_flat))
                .collect();
            assert_eq!(frames.len(), elements.len(), "{}", entry.name);
            for (own, plane) in frames.iter().zip(elements) {
                let (map, plane) = (own.map(), plane.frame.map());
                let size = 1.0 + plane.translation.length();
                let near = |a: DVec3, b: DVec2| (a - b.extend(0.0)).length() < 1e-9 * size;
                let is_near = near(map.matrix3.x_axis, plane.matrix2.x_axis)
                    && near(map.matrix3.y_axis, plane.matrix2.y_axis)
                    && near(map.translation, plane.translation);
                assert!(is_near, "{} {map:?} {plane:?}", entry.name);
                assert!(map.matrix3.z_axis.z > 0.0 && map.matrix3.z_axis.x == 0.0);
            }
        }
        found += 1;
    }
    assert!(found >= 30, "{found}");
}

#[test]
fn a_cut_takes_the_rest_of_its_branch_alone() {
    let lines = |axiom: &str, productions: &str, steps| {
        let text = format!("axiom: \"{axiom}\"\nproductions: {productions}\n");
        frames(&model(&text), steps).len()
    };
    assert_eq!(lines("F[+F%FF[F]F]F", "{}", 0), 3);
    assert_eq!(lines("FF%F[F]F", "{}", 0), 2);
    // A branch that is shed at the third step, compiled and read.
    for ending in ["", "$"] {
        let shed = |steps| {
            lines(
                &format!("F[+A]FF{ending}"),
                "{A: FB, B: FC, C: 'FD%', D: '%F'}",
                steps,
            )
        };
        assert_eq!([0, 1, 2, 3, 4].map(shed), [3, 4, 5, 6, 6]);
    }
    let within = |steps| lines("[AF]F", "{A: B, B: '%F'}", steps);
    assert_eq!([0, 1, 2].map(within), [2, 2, 1]);
}

#[test]
fn polygons_need_not_be_flat() {
    let area = |word: &str| {
        let text = format!("angle: 90\naxiom: \"{word}\"\nproductions: {{}}\n");
        let model = model(&text);
        let drawn = model.drawn_in_space(Some(0), &Growth::steps(0), ColorBy::None);
        let graph = drawn.unwrap().unwrap().graph;
        let elements = Elements::of(&graph, &Growth::steps(0));
        let solid = |object: usize| &graph.base_elements()[graph.objects()[object].base_element];
        let areas = elements.map(|it| solid(it.unwrap().1.object).signed_area());
        areas.collect::<Vec<_>>()
    };
    // A square, and a dart that is not convex.
    let square = area("{.f.+f.+f.}");
    assert!(
        square.len() == 1 && (square[0] - 1.0).abs() < 1e-12,
        "{square:?}"
    );
    let dart = area("{.[f(2).][+(45)f(0.5).][+f(2).]}");
    assert_eq!(dart.len(), 2, "{dart:?}");
    // Corners (0,0,0), (1,0,0), (1,1,0), (1,1,1): two triangles.
    let bent = area("{.f.+f.^f.}");
    assert_eq!(bent.len(), 2, "{bent:?}");
    let sum: f64 = bent.iter().sum();
    let first = 0.5 + 0.5 * 2f64.sqrt();
    assert!((sum - first).abs() < 1e-9, "{sum}");
}

#[test]
fn tubes_have_the_widths_and_knobs_at_bends() {
    let text = "angle: 90\naxiom: \"!(2)F(4)F!(1)F+F[-F]F\"\nproductions: {}\nstyle: {tube: {sides: 12, width: 0.5}}\n";
    let model = model(text);
    let drawn = model.drawn_in_space(Some(0), &Growth::steps(0), ColorBy::None);
    let graph = drawn.unwrap().unwrap().graph;
    let elements = Elements::of(&graph, &Growth::steps(0)).map(|it| it.unwrap().1);
    let solids: Vec<Vec<DVec3>> = elements
        .map(|element| {
            let solid = &graph.base_elements()[graph.objects()[element.object].base_element];
            let corners = solid.corners().iter();
            corners.map(|corner| element.frame.apply(*corner)).collect()
        })
        .collect();
    // Six lines, and knobs before the two that bend.
    assert_eq!(solids.len(), 8);
    let reach = |solid: &[DVec3], x: f64| {
        let near = solid.iter().filter(|it| (it.x - x).abs() < 1e-12);
        let away: Vec<f64> = near.map(|it| it.y.hypot(it.z)).collect();
        assert_eq!(away.len(), 12);
        (away.iter().fold(0.0, |a: f64, b| a.max(*b)), away[0])
    };
    let near =
        |(a, b): (f64, f64), radius: f64| (a - radius).abs() < 1e-12 && (b - radius).abs() < 1e-12;
    assert!(near(reach(&solids[0], 0.0), 0.5) && near(reach(&solids[0], 4.0), 0.5));
    // A frustum from the width before to its own.
    assert!(near(reach(&solids[2], 5.0), 0.5) && near(reach(&solids[2], 6.0), 0.25));
    // The knob lies within its radius about the joint, and reaches it in its middle.
    let joint = DVec3::new(6.0, 0.0, 0.0);
    let knob = solids
        .iter()
        .find(|solid| solid.iter().all(|it| (*it - joint).length() < 0.25 + 1e-12));
    let knob = knob.unwrap();
    assert!(
        knob.iter()
            .any(|it| (*it - joint - DVec3::NEG_Y * 0.25).length() < 1e-12)
    );
}

#[test]
fn surfaces_of_the_library_lie_along_the_heading() {
    let text = "heading: [0, 1, 0]\nup: [0, 0, 1]\naxiom: \"F~(leaf)[+(90)~(leaf, 2)]\"\nproductions: {}\n";
    let model = model(text);
    let lines = frames(&model, 0);
    assert_eq!(lines.len(), 3);
    assert_eq!(lines[1].ends(), [DVec3::Y, DVec3::Y * 2.0]);
    let [from, to] = lines[2].ends();
    assert!((to - from - DVec3::NEG_X * 2.0).length() < 1e-12);
    assert_eq!(lines[1].map().matrix3.z_axis, DVec3::Z);
}

#[test]
fn every_system_of_the_library_in_space_is_drawn() {
    let catalogue = Catalogue::embedded();
    let mut found = 0;
    for entry in catalogue.entries() {
        let text = catalogue.open(&entry).unwrap().text().to_owned();
        if entry.shelf != Shelf::LSYSTEMS || !text.contains("\nspace: 3\n") {
            continue;
        }
        let model = of_library(&entry.name);
        let steps = model.metadata().steps.unwrap().min(4);
        let drawn = model.drawn_in_space(Some(steps), &Growth::steps(steps), ColorBy::None);
        let graph = drawn.unwrap().unwrap().graph;
        assert!(graph.is_plain(), "{}", entry.name);
        let bounds = graph.bounds(steps).unwrap();
        assert!(bounds.size().max_element() > 0.0, "{}", entry.name);
        found += 1;
    }
    assert!(found >= 15, "{found}");
}

fn text_of(name: &str) -> String {
    let catalogue = Catalogue::embedded();
    let source = catalogue.component(Shelf::LSYSTEMS, name).unwrap();
    source.text().to_owned()
}

/// Returns a system of the library in space.
fn of_library(name: &str) -> Model {
    let (model, warnings) = document_of(&text_of(name)).resolve(&[]).unwrap();
    assert!(warnings.is_empty(), "{name}: {}", warnings.render(false));
    model
}

/// Returns the number of pixels of a picture that show something.
fn covered(fractal: &Fractal, steps: u32) -> usize {
    let pixels = fractal.clone().steps(steps).pixels(200).unwrap();
    let straight = pixels.into_straight();
    { straight.chunks_exact(4) }
        .filter(|pixel| *pixel != [255; 4])
        .count()
}

/// Modules too small to be replaced are drawn as boxes, however much smaller than a pixel their lines are.
#[test]
fn pictures_of_far_steps_show_what_near_ones_do() {
    for (name, near, far) in [
        ("bush-in-space", 6, 60),
        ("flowering-plant", 5, 1000),
        ("hilbert-lsystem-in-space", 4, 1000),
        ("dragon-lsystem-in-space", 9, 1000),
        ("hart-tree-lsystem", 4, 9),
    ] {
        let fractal = Fractal::named(name).unwrap();
        let [near, far] = [near, far].map(|steps| covered(&fractal, steps));
        assert!(2 * far > near && near > 0, "{name}: {near}, {far}");
    }
    // A curve of lines without a width.
    let koch = "kind: lsystem\nspace: 3\naxiom: F\nproductions: {F: F+F--F+F}\nangle: 60\n";
    let koch = Fractal::parse(koch).unwrap();
    let all = [3, 4, 5, 6, 7, 8, 9, 1000].map(|steps| covered(&koch, steps));
    let [least, most] = [all.iter().min(), all.iter().max()].map(Option::unwrap);
    assert!(most < &(4 * least) && *least > 200, "{all:?}");
}
