//! Figures of production rules, systems, structures and L-systems: their content and its legibility.

mod svg;

use crate::common::{self, document, document_of, resolved};
use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::document::Document;
use kfrac::figure::rule::{self, RuleFigureOptions};
use kfrac::model::Model;
use kfrac::render::space::Camera;
use kfrac::render::{Format, Labels, Size};
use kfrac::rule::Rule;
use svg::Path;

fn names(shelf: Shelf) -> impl Iterator<Item = String> {
    let entries = Catalogue::embedded().entries().into_iter();
    let alike = entries.filter(move |entry| entry.shelf == shelf);
    alike.map(|entry| entry.name)
}

/// Returns the figure of a document in a format, with its size.
fn figure(document: &Document, format: Format, size: Option<Size>) -> (Vec<u8>, [u32; 2]) {
    let model = document.resolve(&[]).unwrap().0;
    let title = model.metadata().description.title.clone();
    let options = RuleFigureOptions::default()
        .format(format)
        .size(size)
        .labels(Labels {
            title: title.unwrap_or_default(),
            ..Labels::default()
        });
    let mut bytes = Vec::new();
    let size = rule::write(&model, document, None, &options, &mut bytes);
    (bytes, size.unwrap())
}

fn svg_of(document: &Document) -> String {
    String::from_utf8(figure(document, Format::Svg, None).0).unwrap()
}

/// Returns the labels of a figure, one a line.
fn said(text: &str) -> String {
    let (_, paths) = svg::read(&svg_of(&document_of(text)));
    let labels: Vec<_> = paths.into_iter().filter_map(|path| path.label).collect();
    labels.join("\n")
}

/// Returns a figure without the outlines of letters, which are long and hold no information.
fn reduced(name: &str) -> String {
    let mut reduced = String::new();
    for piece in svg_of(&document(name)).split_inclusive("/>\n") {
        let label = piece.contains("aria-label") && !piece.contains(r#""*""#);
        match piece.find(" d=\"").filter(|_| label) {
            Some(data) => {
                let start = piece[data + 5..].split(['l', 'c']).next().unwrap();
                reduced.push_str(&format!("{} at=\"{start}\"/>\n", &piece[..data]));
            }
            None => reduced.push_str(piece),
        }
    }
    reduced
}

#[test]
fn the_koch_curve_has_four_fertile_sides() {
    insta::assert_snapshot!("koch-rule", reduced("koch"));
}

#[test]
fn the_dragon_has_two_generators() {
    insta::assert_snapshot!("dragon-rule", reduced("dragon"));
}

#[test]
fn the_monkeys_tree_tells_its_directions() {
    insta::assert_snapshot!("monkeys-tree-rule", reduced("monkeys-tree"));
}

fn fertile_sides(rule: &Rule) -> usize {
    let generators = rule.generators().iter().flat_map(|it| it.elements());
    let all = generators.chain(&rule.initiator().elements);
    all.filter(|element| element.fertile).count()
}

#[test]
fn every_rule_of_the_library_can_be_read() {
    for name in common::plane_rules() {
        let document = document(&name);
        let (size, paths) = svg::read(&svg_of(&document));
        let labels = labels(&paths);
        let stars = labels.iter().filter(|it| it.label.as_deref() == Some("*"));
        let rule = resolved(&document, &[]);
        assert_eq!(stars.count(), fertile_sides(&rule), "{name}");
        for heading in ["initiator", "generator", "base element", "fertile"] {
            let says = |path: &&&Path| path.label.as_ref().unwrap().starts_with(heading);
            assert!(labels.iter().any(|path| says(&path)), "{name}: {heading}");
        }
        assert_can_be_read(&name, size, &paths);
    }
}

fn labels(paths: &[Path]) -> Vec<&Path> {
    paths.iter().filter(|path| path.label.is_some()).collect()
}

/// Asserts that all labels lie inside the figure, and that none overlaps another one or an element.
fn assert_can_be_read(name: &str, size: [i64; 2], paths: &[Path]) {
    let labels = labels(paths);
    for (number, label) in labels.iter().enumerate() {
        let what = format!("{name}: {:?}", label.label);
        let within = |side: usize| label.min[side] >= 0 && label.max[side] <= 100 * size[side];
        assert!(within(0) && within(1), "{what}");
        for other in &labels[..number] {
            assert!(!overlap(label, other), "{what} and {:?}", other.label);
        }
        let drawn = paths.iter().filter(|path| is_element(path));
        for line in drawn.flat_map(|path| &path.lines) {
            assert!(!crosses(label, *line), "{what} lies on an element");
        }
    }
}

#[test]
fn every_structure_of_the_library_can_be_read() {
    for name in names(Shelf::INSTANCING) {
        let document = document(&name);
        let (size, paths) = svg::read(&svg_of(&document));
        assert_can_be_read(&name, size, &paths);
        let structure = match document.resolve(&[]).unwrap().0 {
            Model::Instancing(structure) => structure,
            Model::InstancingInSpace(_) => continue,
            _ => panic!("{name} is a structure"),
        };
        let labels: Vec<_> = labels(&paths)
            .into_iter()
            .filter_map(|path| path.label.as_deref())
            .collect();
        assert!(labels.contains(&"scene"), "{name}");
        // Every name occurs once, as a panel; levels may be left out.
        for object in structure.objects() {
            let own = object.name.split('(').next().unwrap();
            let is_own = |label: &&&str| label.split('(').next() == Some(own);
            assert!(labels.iter().any(|label| is_own(&label)), "{name}: {own}");
        }
        let shown = structure.objects().len().min(3);
        for object in &structure.objects()[..shown] {
            let panels = labels.iter().filter(|label| **label == object.name);
            assert!(panels.count() >= 1, "{name}: {}", object.name);
        }
    }
}

#[test]
fn every_l_system_of_the_library_can_be_read() {
    for name in names(Shelf::LSYSTEMS) {
        let document = document(&name);
        let (size, paths) = svg::read(&svg_of(&document));
        let labels = labels(&paths);
        // Letters of branches that leave a point in nearly one direction may overlap.
        for label in &labels {
            let within = |side: usize| label.min[side] >= 0 && label.max[side] <= 100 * size[side];
            assert!(within(0) && within(1), "{name}: {:?}", label.label);
        }
        let said = |text: &str| {
            let mut labels = labels.iter().filter_map(|path| path.label.as_deref());
            labels.any(|label| label.starts_with(text))
        };
        assert!(said("axiom") && said("production"), "{name}");
        for production in &document.lsystem().unwrap().productions {
            assert!(
                said(&production.predecessor.character.to_string()),
                "{name}"
            );
        }
    }
}

#[test]
fn productions_are_drawn_with_the_arguments_that_they_are_applied_to_first() {
    let text = "kind: lsystem
axiom: A(2)
angle: 90
productions: ['A(x) : x > 1 -> F(x)[+B]A(x/2)', 'A(x) : x <= 1 -> F(x)', 'B -> ']";
    let (_, paths) = svg::read(&svg_of(&document_of(text)));
    let labels: Vec<_> = labels(&paths);
    let said: Vec<_> = labels.iter().filter_map(|it| it.label.as_deref()).collect();
    for label in [
        "A(x) : x > 1 -> F(x)[+B]A(x/2)",
        "A(x) : x <= 1 -> F(x)",
        "B ->",
        "productions",
        "+ and - turn by 90 degrees",
    ] {
        assert!(said.contains(&label), "{label}: {said:?}");
    }
    // A is at the start of the axiom, of two words that it is replaced in, and at the end of one that replaces it.
    assert_eq!(said.iter().filter(|it| **it == "A").count(), 4);
    // Lines of two steps are twice as long as those of one.
    let lengths: Vec<i64> = { paths.iter().filter(|path| is_element(path)) }
        .flat_map(|path| &path.lines)
        .map(|[from, to]| (from[0] - to[0]).abs().max((from[1] - to[1]).abs()))
        .collect();
    assert_eq!(lengths.len(), 2, "{lengths:?}");
    assert!((lengths[0] - 2 * lengths[1]).abs() <= 2, "{lengths:?}");
}

#[test]
fn instances_are_named_where_they_stand() {
    let text = "kind: instancing
objects:
  wood: [{segment: [[0, 0], [0, 1]]}]
  twig: [wood, {object: twig, scale: 1/2, translate: [0, 1]}]
  row(0): [twig]
  row(n): [row(n - 1), {object: row(n - 1), translate: [2, 0]}]
scene: [row(9)]";
    let said = said(text);
    for label in [
        "scene", "objects", "wood", "twig", "row(9)", "row(8)", "row(7)",
    ] {
        assert!(
            said.split('\n').any(|line| line == label),
            "{label}: {said}"
        );
    }
    // Three of ten levels are shown, and their instances are named.
    assert!(said.contains("7 more objects are not shown"), "{said}");
    assert!(
        said.contains("row(6)") && !said.contains("row(5)"),
        "{said}"
    );
}

fn overlap(a: &Path, b: &Path) -> bool {
    (0..2).all(|side| a.min[side] < b.max[side] && b.min[side] < a.max[side])
}

/// Returns whether a path holds lines of elements: solid, with a width that only elements have.
fn is_element(path: &Path) -> bool {
    let width = path.width.as_deref();
    path.label.is_none()
        && !path.is_filled
        && !path.is_dashed
        && (width.is_none() || width == Some("150.0"))
}

/// Returns whether a line segment crosses the bounding box of a path.
fn crosses(path: &Path, line: [[i64; 2]; 2]) -> bool {
    // The part of the line, from 0 to 1, that lies within the box (Liang and Barsky 1984).
    let (mut first, mut last) = (0.0f64, 1.0f64);
    for side in 0..2 {
        let [from, to] = line.map(|point| point[side] as f64);
        let [min, max] = [path.min[side] as f64, path.max[side] as f64];
        if from == to {
            if from <= min || from >= max {
                return false;
            }
        } else {
            let (a, b) = ((min - from) / (to - from), (max - from) / (to - from));
            first = first.max(a.min(b));
            last = last.min(a.max(b));
        }
    }
    first < last
}

#[test]
fn both_formats_have_the_size_that_is_asked_for() {
    let document = document("dragon");
    for (asked, expected) in [
        (None, None),
        (Some(Size::Long(400)), None),
        (Some(Size::Exactly(300, 200)), Some([300, 200])),
    ] {
        let (png, size) = figure(&document, Format::Png, asked);
        let side = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
        assert_eq!([side(16), side(20)], size);
        let (svg, svg_size) = figure(&document, Format::Svg, asked);
        assert_eq!(svg_size, size);
        let (written, _) = svg::read(&String::from_utf8(svg).unwrap());
        assert_eq!(written, size.map(i64::from));
        if let Some(Size::Long(side)) = asked {
            assert_eq!(size.into_iter().max(), Some(side));
        }
        assert!(expected.is_none_or(|expected| expected == size));
    }
}

#[test]
fn selections_are_said() {
    let two = "initiator: segment\ngenerators: {a: koch, b: levy, c: dragon}\nselect: ";
    let by_index = said(&format!("{two}{{by_index: [b, a]}}"));
    assert!(by_index.contains("odd i: b\neven i: a\n"), "{by_index}");
    let in_turn = said(&format!("{two}{{by_index: [a, b, c, b]}}"));
    assert!(in_turn.contains("in turn: a, b, c, b\n"), "{in_turn}");
    let cases = said(&format!("{two}[{{when: age>2, use: a}}, {{use: c}}]"));
    assert!(cases.contains("age > 2: a\notherwise: c\n"), "{cases}");
    let random = said(&format!("{two}{{at_random: {{a: 3, b: 1}}}}"));
    assert!(
        random.contains("at random:\n75 %: a\n25 %: b\n"),
        "{random}"
    );
    let named = said(
        "initiator: [[0, 0], {to: [1, 0], use: b}]
generators:
  a: [[0, 0], {to: [1/2, 1/2], use: b}, {to: [1, 0], use: a}]
  b: [[0, 0], {to: [1/2, 1/3], use: a}, {to: [1, 0], fertile: false}]",
    );
    assert!(named.contains("every side names its own\n"), "{named}");
    assert!(named.contains("*\na\n"), "{named}");
}

#[test]
fn random_functions_and_seeds_are_said() {
    let said = said(
        "initiator: segment
generator:
  random:
    tilt: uniform(-20, 20 + i)
    top: normal(0.5, 0.1)
    side: choice(1, 2)
  move:
    - {rotate: tilt, about: [1/2, 0], points: [1]}
    - {scale: side/2, shift: [0, top/9]}
  parts:
    - elements: [[0, 0], [1/2, top], [1, 0]]
    - {seeds: true, elements: [[0, -1/3], [1/3, -1/3]]}
    - {seeds: true, placed: initiator, elements: [[1/2, -1/3], [1, -1/3]]}",
    );
    let joined = said.replace('\n', " ");
    for line in [
        "tilt: uniform from -20 to 20 + i",
        "top: normal with mean 0.5, deviation 0.1",
        "side: one of 1, 2",
        "p1 = (1/2, top)",
        "p1: turned by tilt° about (1/2, 0)",
        "all points but the ends: scaled by side/2, shifted by (0, top/9)",
        "part 2 seeds a new fractal",
        "part 3 seeds a new fractal, as large and as upright as the initiator, measured from where the side begins",
        "drawn for i = 1",
    ] {
        assert!(joined.contains(line), "{line}\n{said}");
    }
    // The point is labelled at its position, too.
    assert!(said.split('\n').any(|label| label == "p1"), "{said}");
}

/// A generator may be finite only at the moments at which it is selected.
#[test]
fn a_generator_is_drawn_for_a_moment_that_selects_it() {
    let text = "initiator: segment
generators:
  young: [[0, 0], [1/2, 1/3], [1, 0]]
  old: [[0, 0], [1/2, 1/age], [1, 0]]
select: [{when: age < 2, use: young}, {use: old}]";
    let said = said(text);
    assert!(said.contains("drawn for age = 2\n"), "{said}");
}

#[test]
fn what_is_odd_is_drawn_all_the_same() {
    for text in [
        "initiator: [[0, 0], {to: [1, 0], fertile: false}]\ngenerator: koch",
        "initiator: [[0, 0], [0, 1e300]]\ngenerator: [[0, 0], [1e-300, 0], [1, 0]]",
        "title: 分形 ⁂ \\t\ninitiator: segment\ngenerator: koch\nbase_element: half-circle",
        "initiator: segment\ngenerator: [[0, 0], {to: [1/2, 1/2], visible: false}, [1/2, 0]]",
        "initiator: segment\ngenerator: [[0, 0], [1/2, 1/(i - i)], [1, 0]]",
        "kind: instancing\nobjects: {a: [{point: [0, 0]}]}\nscene: [a]",
        "kind: instancing\nobjects: {a: [{object: a, scale: 0}]}\nscene: [a]",
        "kind: instancing\nobjects: {a: [b, b, b, b], b: [{segment: [[0, 0], [1, 0]]}]}\nscene: [a, b]",
    ] {
        let document = document_of(text);
        let (bytes, _) = figure(&document, Format::Svg, None);
        let (size, _) = svg::read(&String::from_utf8(bytes).unwrap());
        assert!(size[0] < 2000 && size[1] < 2000, "{text}");
    }
}

#[test]
fn systems_in_space_show_their_maps_as_seen() {
    let text = "{title: Cube, kind: ifs, space: 3, vertices: {solid: cube, shrink: 1/2}}";
    let document = document_of(text);
    let (_, paths) = svg::read(&svg_of(&document));
    let labels = labels(&paths);
    let labels: Vec<_> = labels.iter().filter_map(|it| it.label.as_deref()).collect();
    for label in ["Cube", "initial set", "maps", "1", "8"] {
        assert!(labels.contains(&label), "{label}: {labels:?}");
    }
    // Three edges of a cube are hidden by itself: they are dashed, and nine are seen.
    let lines = |is_dashed: bool, count: usize| {
        let paths = paths.iter().filter(|path| path.label.is_none());
        let alike = paths.filter(|path| path.is_dashed == is_dashed && path.lines.len() == count);
        alike.count()
    };
    // In the panels of the initial set and of the maps.
    assert_eq!(lines(true, 3), 2);
    assert_eq!(lines(true, 9), 1);
    // The initial set, and its eight images.
    assert_eq!(lines(false, 9), 9);
    let seen = |from| {
        let (model, options) = (
            document.resolve(&[]).unwrap().0,
            RuleFigureOptions::default(),
        );
        let camera = Camera::default().from(from);
        let mut bytes = Vec::new();
        rule::write(&model, &document, None, &options.camera(camera), &mut bytes).unwrap();
        bytes
    };
    assert_ne!(seen([30.0, 25.0]), seen([0.0, 0.0]));
}

#[test]
fn every_set_in_space_of_the_library_has_a_figure() {
    let mut drawn = 0;
    for name in names(Shelf::IFS).chain(names(Shelf::INSTANCING)) {
        let document = document(&name);
        if document.resolve(&[]).unwrap().0.is_in_space() {
            let (size, paths) = svg::read(&svg_of(&document));
            let inside = |path: &Path| {
                (0..2).all(|side| path.min[side] >= 0 && path.max[side] <= 100 * size[side])
            };
            assert!(paths.iter().all(inside), "{name}");
            drawn += 1;
        }
    }
    assert!(drawn >= 13);
}

/// From the front: a cone is a triangle, a ball a circle, and a box a square with its edges.
#[test]
fn structures_in_space_show_their_instances_as_seen() {
    let text = "{kind: instancing, space: 3, objects: {pair: [cone, {object: sphere, \
                translate: [2, 0, 0]}]}, scene: [pair, {box: {to: [1, 2, 1]}, translate: [4, 0, 0]}]}";
    let document = document_of(text);
    let model = document.resolve(&[]).unwrap().0;
    let camera = Camera::default().from([0.0, 0.0]);
    let options = RuleFigureOptions::default().camera(camera);
    let mut bytes = Vec::new();
    rule::write(&model, &document, None, &options, &mut bytes).unwrap();
    let (_, paths) = svg::read(&String::from_utf8(bytes).unwrap());
    let labels = labels(&paths);
    let labels: Vec<_> = labels.iter().filter_map(|it| it.label.as_deref()).collect();
    for label in ["scene", "object", "pair"] {
        assert!(labels.contains(&label), "{label}: {labels:?}");
    }
    let count = |lines: usize| {
        let shapes = paths.iter().filter(|path| path.label.is_none());
        shapes.filter(|path| path.lines.len() == lines).count()
    };
    assert_eq!((count(3), count(48)), (1, 1));
    // The square of the box, and that of the object's box; each has a front face of four edges.
    assert_eq!(count(4), 4);
}
