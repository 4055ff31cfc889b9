//! Iterated function systems from the file to the elements, against the reference's maps, fixed points and
//! dimensions, and against images computed here without a graph.

mod boxes;
mod cells;
mod fractals;
mod same;
mod space;

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::Arc;

use crate::common::random_systems;
use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::diagnostic::{Diagnostics, Source};
use kfrac::document::Document;
use kfrac::export;
use kfrac::geometry::{Bounds, DAffine2, DVec2};
use kfrac::graph::Graph;
use kfrac::grow::{Element, FractalInfo, Growth, Visitor, walk};
use kfrac::ifs::System;
use kfrac::measure::similarity_dimension;
use kfrac::model::Model;
use kfrac::render::{self, Detail, Format, Options, Size};
use kfrac::style::{ColorBy, Colour, Palette};

fn read(source: &Arc<Source>) -> Result<(Arc<System>, Diagnostics), Diagnostics> {
    let (model, doubts) = Document::read(source, &Catalogue::embedded())?.resolve(&[])?;
    let Model::Ifs(system) = model else {
        panic!("this is no system")
    };
    Ok((system, doubts))
}

/// Returns a system from text.
#[track_caller]
fn system(text: &str) -> Arc<System> {
    let source = Source::new("test.yaml", format!("kind: ifs\n{text}"));
    let (system, doubts) = read(&source).unwrap_or_else(|errors| panic!("{errors}\n{text}"));
    assert!(doubts.is_empty(), "{doubts}");
    system
}

/// Returns all systems of the library, with their names.
fn library() -> Vec<(String, Arc<System>)> {
    let catalogue = Catalogue::embedded();
    let entries = catalogue.entries().into_iter();
    let entries = entries.filter(|entry| entry.shelf == Shelf::IFS);
    let systems = entries.filter_map(|entry| {
        let source = catalogue.open(&entry).unwrap();
        let (model, doubts) = Document::read(&source, &catalogue)
            .unwrap()
            .resolve(&[])
            .unwrap();
        assert!(doubts.is_empty(), "{doubts}");
        match model {
            Model::Ifs(system) => Some((entry.name, system)),
            _ => None,
        }
    });
    systems.collect()
}

fn named(name: &str) -> Arc<System> {
    let (_, system) = library().into_iter().find(|(own, _)| own == name).unwrap();
    system
}

/// Returns the elements of an approximant.
fn elements(graph: &Graph, steps: u32) -> Vec<Element> {
    struct All(Vec<Element>);
    impl Visitor for All {
        type Error = Infallible;
        fn begin(&mut self, _: FractalInfo) -> Result<(), Infallible> {
            Ok(())
        }
        fn element(&mut self, element: &Element) -> Result<(), Infallible> {
            self.0.push(*element);
            Ok(())
        }
        fn end(&mut self, _: bool) -> Result<(), Infallible> {
            Ok(())
        }
    }
    let mut all = All(Vec::new());
    walk(graph, &Growth::steps(steps), &mut all).unwrap();
    all.0
}

/// Returns the visible elements of an approximant.
fn drawn(graph: &Graph, steps: u32) -> Vec<Element> {
    let mut all = elements(graph, steps);
    all.retain(|element| graph.objects()[element.object].visible);
    all
}

fn maps(system: &System) -> Vec<DAffine2> {
    system.ifs().maps().iter().map(|map| map.affine).collect()
}

/// Returns all products of `length` maps that the digraph admits, with the index of the map that is applied
/// last.
fn products(system: &System, length: u32) -> Vec<(usize, DAffine2)> {
    let maps = maps(system);
    let follows = |from: usize, to: usize| match system.ifs().edges() {
        Some(mut edges) => edges.any(|(edge, _)| (edge.from, edge.to) == (from, to)),
        None => true,
    };
    // Each product with the map that was applied last.
    let mut all: Vec<(usize, DAffine2)> = maps.iter().copied().enumerate().collect();
    for _ in 1..length {
        all = all
            .iter()
            .flat_map(|&(last, product)| {
                let next = (0..maps.len()).filter(move |&to| follows(last, to));
                let maps = &maps;
                next.map(move |to| (to, maps[to] * product))
            })
            .collect();
    }
    all
}

#[track_caller]
fn assert_close(what: &str, value: f64, expected: f64, tolerance: f64) {
    let off = (value - expected).abs();
    assert!(off <= tolerance, "{what}: {value}, not {expected}");
}

#[derive(serde::Deserialize)]
struct Entry {
    maps: Vec<[f64; 6]>,
    fixed_points: Option<Vec<[f64; 2]>>,
    dimension: Option<f64>,
}

#[test]
fn the_library_is_held_against_the_reference() {
    let reference: BTreeMap<String, Entry> =
        serde_json::from_str(include_str!("systems/reference.json")).unwrap();
    assert_eq!(reference.len(), 30);
    for (name, entry) in &reference {
        let system = named(name);
        let graph = Graph::of_system(&system);
        assert_eq!(system.ifs().maps().len(), entry.maps.len(), "{name}");
        for (map, expected) in maps(&system).iter().zip(&entry.maps) {
            let [a, b, c, d, e, f] = *expected;
            let size = 1e-12 * (1.0 + map.translation.length());
            // A system on a line is given along the line only.
            let line = entry
                .maps
                .iter()
                .all(|map| map[5] == 0.0 && map[0] == map[3]);
            let own = map.to_cols_array();
            for (value, expected) in own.into_iter().zip([a, b, c, d, e, f]) {
                assert_close(name, value, expected, size);
            }
            assert!(!line || map.translation.y == 0.0, "{name}");
        }
        if let Some(points) = &entry.fixed_points {
            for (point, expected) in system.ifs().fixed_points().iter().zip(points) {
                let off = (point.unwrap() - DVec2::from(*expected)).length();
                assert!(off <= 1e-11 * point.unwrap().length().max(1.0), "{name}");
            }
        }
        let own = similarity_dimension(&graph);
        match entry.dimension {
            Some(dimension) => assert_close(name, own.value.unwrap(), dimension, 1e-12),
            None => assert_eq!(own.value, None, "{name}"),
        }
        if let Some(published) = system.metadata().dimension {
            assert_close(name, own.value.unwrap(), published, 1e-12);
        }
    }
}

#[test]
fn approximants_are_the_images_under_all_products() {
    for (name, system) in library() {
        if !system.ifs().condensation().is_empty() || system.ifs().maps().len() > 6 {
            continue;
        }
        let graph = Graph::of_system(&system);
        assert_eq!(elements(&graph, 0).len(), 1, "{name}");
        for steps in 1..=3 {
            let key = |map: &DAffine2| map.to_cols_array().map(|value| (value * 1e9).round());
            let mut own: Vec<_> = elements(&graph, steps)
                .iter()
                .map(|element| key(element.frame.map()))
                .collect();
            let mut expected: Vec<_> = products(&system, steps)
                .iter()
                .map(|(_, product)| key(product))
                .collect();
            let order = |a: &[f64; 6], b: &[f64; 6]| a.partial_cmp(b).unwrap();
            own.sort_by(order);
            expected.sort_by(order);
            assert_eq!(own, expected, "{name} at {steps}");
        }
    }
}

/// An edge from 1 to 2 means that map 2 may be applied after map 1.
#[test]
fn an_edge_leads_from_what_is_applied_before() {
    let system = system(
        "maps:\n  - {scale: 1/2}\n  - {scale: 1/2, shift: [1/2, 0]}\n  \
         - {scale: 1/2, shift: [0, 1/2]}\nedges: {1: [1, 2], 2: [3], 3: [1]}\n",
    );
    let graph = Graph::of_system(&system);
    let maps = maps(&system);
    let all: Vec<DAffine2> = elements(&graph, 2)
        .iter()
        .map(|element| *element.frame.map())
        .collect();
    assert_eq!(all.len(), 4);
    for [first, then] in [[0, 0], [0, 1], [1, 2], [2, 0]] {
        assert!(all.contains(&(maps[then] * maps[first])), "{first} {then}");
    }
    assert!(!all.contains(&(maps[0] * maps[1])));
}

/// Limit sets with bounds in closed form.
#[test]
fn limit_sets_have_their_boxes() {
    let third = 3f64.sqrt() / 6.0;
    for (name, expected) in [
        ("koch-ifs", [0.0, 0.0, 1.0, third]),
        ("cantor", [0.0, 0.0, 1.0, 0.0]),
        ("cantor-about-zero", [-1.5, 0.0, 1.5, 0.0]),
        ("gasket", [0.0, 0.0, 1.0, 3.0 * third]),
        ("pound-sign", [-1.0, -1.0, 1.0, 1.0]),
        ("square-filled", [0.0, 0.0, 1.0, 1.0]),
        ("parabola", [0.0, 0.0, 1.0, 0.5]),
        ("blancmange", [0.0, 0.0, 1.0, 2.0 / 3.0]),
        ("snowflake-tiles", [-3.0 * third, -1.0, 3.0 * third, 1.0]),
        ("levy-ifs", [-0.5, -0.25, 1.5, 1.0]),
    ] {
        let bounds = Graph::of_system(&named(name)).limit_bounds().unwrap();
        let own = [
            bounds.min().x,
            bounds.min().y,
            bounds.max().x,
            bounds.max().y,
        ];
        for (value, expected) in own.into_iter().zip(expected) {
            assert_close(name, value, expected, 1e-12);
        }
    }
}

/// The bounds are compared with images of a point of the limit set, under as many products as time permits.
#[test]
fn limit_boxes_hold_the_orbits_and_no_more() {
    for (name, system) in library() {
        if !system.ifs().condensation().is_empty() || system.ifs().is_recurrent() {
            continue;
        }
        let bounds = Graph::of_system(&system).limit_bounds().unwrap();
        let start = system.ifs().fixed_points()[0].unwrap();
        let mut points = vec![start];
        let maps = maps(&system);
        while points.len() * maps.len() <= 50_000 {
            points = points
                .iter()
                .flat_map(|&point| maps.iter().map(move |map| map.transform_point2(point)))
                .collect();
        }
        let mut orbit = Bounds::EMPTY;
        points.iter().for_each(|point| orbit.add(*point));
        let size = bounds.size().max_element();
        let slack = 1e-9 * size;
        assert!(
            (orbit.min() - bounds.min()).min_element() >= -slack
                && (bounds.max() - orbit.max()).min_element() >= -slack,
            "{name}: {bounds:?} does not hold {orbit:?}"
        );
        let off = (orbit.min() - bounds.min()).max(bounds.max() - orbit.max());
        assert!(
            off.max_element() <= 0.35 * size,
            "{name}: {bounds:?} is larger than {orbit:?}"
        );
    }
}

/// Neither map contracts, but all their products do.
#[test]
fn products_may_contract_where_maps_do_not() {
    let text = "maps:\n  - {matrix: [[0, 2], [0, 0]], shift: [1, 0]}\n  \
                - {matrix: [[0, 0], [0.3, 0]], shift: [0, 1]}\n";
    let system = system(text);
    let graph = Graph::of_system(&system);
    assert!(graph.contracts() && graph.shrinks());
    let bounds = graph.limit_bounds().unwrap();
    // x = 1 + 2 y and y = 1 + 0.3 x where both are largest.
    assert!((bounds.min() - DVec2::ZERO).length() < 1e-12);
    assert!((bounds.max() - DVec2::new(7.5, 3.25)).length() < 1e-12);
    let options = Options::default().detail(Some(Detail {
        pixels: 1.0,
        decides_steps: true,
    }));
    let picture = render::write(&graph, &Growth::steps(1000), &options, &mut Vec::new()).unwrap();
    assert!(picture.steps > 5 && picture.steps < 1000);
}

#[test]
fn condensation_sets_are_drawn_at_every_level() {
    let system = named("cantor-gaps");
    let graph = Graph::of_system(&system);
    let middle = DVec2::new(0.5, 0.0);
    for steps in 0..5 {
        let mut points: Vec<f64> = drawn(&graph, steps)
            .iter()
            .map(|element| element.frame.apply(middle).x)
            .collect();
        points.sort_by(f64::total_cmp);
        assert_eq!(points.len(), (1 << (steps + 1)) - 1);
        if steps == 2 {
            let expected = [1.0, 3.0, 5.0, 9.0, 13.0, 15.0, 17.0];
            for (point, expected) in points.iter().zip(expected) {
                assert_close("a middle", *point, expected / 18.0, 1e-15);
            }
        }
    }
    // Without an initial set, both condensation sets exist from the beginning.
    let graph = Graph::of_system(&named("tree-libeskind-hadas"));
    let counts = [0, 1, 2].map(|steps| drawn(&graph, steps).len());
    assert_eq!(counts, [2, 8, 26]);
}

#[test]
fn elements_tell_their_first_and_last_maps() {
    let system = named("gasket");
    let graph = Graph::with_last_maps(&system).unwrap();
    for (number, element) in elements(&graph, 4).iter().enumerate() {
        let object = &graph.objects()[element.object];
        assert_eq!(object.last_map, Some(number / 27));
        assert_eq!(object.origin, Some(number % 3));
    }
    let plain = Graph::of_system(&system);
    let frames = |graph: &Graph| -> Vec<_> {
        let all = elements(graph, 4);
        all.iter().map(|element| element.frame).collect()
    };
    assert_eq!(frames(&plain), frames(&graph));
    assert_eq!(plain.bounds(4), graph.bounds(4));
}

/// A graph that distinguishes the map applied last is refused for many maps: it has an instance of every map
/// inside every map, for every last map.
#[test]
fn many_maps_are_not_told_apart() {
    let maps = "{scale: 1/2}, ".repeat(200);
    let system = system(&format!("maps: [{maps}]\n"));
    assert!(Graph::with_last_maps(&system).is_none());
}

#[test]
fn maps_are_left_out() {
    let system = named("pound-sign");
    let left = system.omitting(&[1]).unwrap();
    assert_eq!(left.ifs().maps().len(), 3);
    assert_eq!(elements(&Graph::of_system(&left), 2).len(), 6);
    assert!(system.omitting(&[0, 1, 2]).is_err());
    assert!(system.omitting(&[0, 1, 2, 3]).is_err());
}

#[test]
fn tables_have_the_maps_of_elements() {
    let system = system("maps: [{matrix: [[1/2, 1/4], [0, 1/8]], shift: [1, 2]}]\n");
    let graph = Graph::of_system(&system);
    let table = |format| {
        let mut bytes = Vec::new();
        let one = std::num::NonZero::<usize>::MIN;
        export::write(&graph, &Growth::steps(1), format, one, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    };
    assert_eq!(
        table(export::TableFormat::Csv),
        "fractal,age,index,x0,y0,x1,y1,fertile,direction,visible,a,b,c,d,e,f\n\
         0,1,1,1,2,1.5,2,true,1,true,0.5,0,0.25,0.125,1,2\n"
    );
    assert!(
        table(export::TableFormat::JsonLines).ends_with(
            "\"visible\":true,\"a\":0.5,\"b\":0,\"c\":0.25,\"d\":0.125,\"e\":1,\"f\":2}\n"
        )
    );
}

/// With colours by index no element is skipped; the picture is the same.
#[test]
fn what_is_left_out_beside_a_window_is_not_seen() {
    for (name, window, steps) in [
        ("barnsley-fern", [0.5, 7.0, 1.0, 1.0], 9),
        ("tree-libeskind-hadas", [0.0, 60.0, 20.0, 20.0], 7),
        ("maple-leaf", [-1.0, -1.0, 1.0, 1.0], 6),
        ("barnsley-fern-four", [-0.5, 0.0, 1.0, 3.0], 7),
    ] {
        let system = named(name);
        let graph = Graph::of_system(&system);
        let picture = |color_by| {
            let mut options = Options::of(system.metadata());
            options.format = Format::Png;
            options.size = Size::Long(120);
            options.view.window = Some(window);
            options.style.stroke = None;
            options.style.fill = Some(Colour::BLACK);
            options.style.color_by = color_by;
            options.style.palette = Palette::of_colours("black", &[Colour::BLACK]);
            let mut bytes = Vec::new();
            let wrote = render::write(&graph, &Growth::steps(steps), &options, &mut bytes).unwrap();
            (bytes, wrote.elements)
        };
        let (culled, few) = picture(ColorBy::None);
        let (whole, all) = picture(ColorBy::Fractal);
        assert!(few < all, "{name}: {few} of {all}");
        assert!(culled == whole, "{name}");
    }
}

#[test]
fn points_may_be_in_a_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("data.csv"),
        "x,y\n0, 0\n\n1;2\n# no\n3\t1\n",
    )
    .unwrap();
    let path = folder.path().join("curve.yaml");
    let text = "kind: ifs\ninterpolate: {points: data.csv, scale: 0.3}\n";
    std::fs::write(&path, text).unwrap();
    let source = Catalogue::embedded().rule(&path).unwrap();
    let (system, _) = read(&source).unwrap();
    let graph = Graph::of_system(&system);
    let [first, second] = elements(&graph, 1)[..] else {
        panic!("two points make two pieces")
    };
    let ends = [DVec2::ZERO, DVec2::new(3.0, 1.0)];
    let of = |element: Element| ends.map(|end| element.frame.apply(end));
    assert!((of(first)[1] - DVec2::new(1.0, 2.0)).length() < 1e-15);
    assert!((of(second)[0] - DVec2::new(1.0, 2.0)).length() < 1e-15);
    assert!(second.joined);
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    assert!(
        document.to_yaml().contains("[1, 2]"),
        "{}",
        document.to_yaml()
    );
}

/// Different notations give equal maps.
#[test]
fn maps_may_be_written_in_several_ways() {
    let system = system(
        "maps:\n  - {matrix: [[0, -1/2], [1/2, 0]], shift: [1, 0]}\n  \
         - {scale: 1/2, rotate: 90, shift: [1, 0]}\n  \
         - {times: [0, 1/2], shift: [1, 0]}\n  \
         - {scale: [1/2, -1/2], rotate: [90, -90], shift: [1, 0]}\n  \
         - {scale: 1/2, rotate: 90, fixed: [0.8, 0.4]}\n",
    );
    let maps = maps(&system);
    for (number, map) in maps.iter().enumerate() {
        assert!(map.abs_diff_eq(maps[0], 1e-15), "{number}: {map:?}");
    }
    let mirrored = self::system("maps: [{times: [0, 1/2], conjugate: true}]\n");
    let image = self::maps(&mirrored)[0].transform_point2(DVec2::new(1.0, 2.0));
    assert_eq!(image, DVec2::new(1.0, 0.5));
}

/// The unit disc of the best norm for these maps is a square, which only long products distinguish from an
/// ellipse: convex hulls decide where products do not.
#[test]
fn what_is_not_decided_is_said() {
    let maps = "maps:\n  - {matrix: [[s, s], [0, 0]]}\n  \
                - {matrix: [[s, -s], [0, 0]], shift: [1, 0]}\n  \
                - {matrix: [[0, 0], [s, s]]}\n  - {matrix: [[0, 0], [s, -s]]}\n";
    let decided = system(&format!("params: {{s: 0.99}}\n{maps}"));
    assert!(decided.contraction().upper < 1.0);
    assert!(Graph::of_system(&decided).limit_bounds().is_some());
    let text = "kind: ifs\nparams: {s: 0.99999}\nmaps:\n  - {matrix: [[s, s], [0, 0]]}\n  \
                - {matrix: [[s, -s], [0, 0]], shift: [1, 0]}\n  \
                - {matrix: [[0, 0], [s, s]]}\n  - {matrix: [[0, 0], [s, -s]]}\n";
    let (system, said) = read(&Source::new("test.yaml", text)).unwrap();
    assert!(said.to_string().contains("do not decide"), "{said}");
    let graph = Graph::of_system(&system);
    assert!(!graph.shrinks());
    assert_eq!(graph.limit_bounds(), None);
    assert_eq!(elements(&graph, 2).len(), 16);
}

#[test]
fn what_overlaps_too_much_to_be_grown_can_be_drawn_at_random() {
    let text = "kind: ifs\nmaps:\n  - {times: [0.9, 0.1]}\n  - {times: [0.7, -0.55], shift: [1, 0]}\n  \
                - {times: [-0.3, 0.85], shift: [0, 1]}\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("full.yaml"), text).unwrap();
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_kfrac"));
    // The system is drawn by cells, as some thousand lines and dots.
    let arguments = "grow full.yaml --max-elements 1000 -o full.png";
    let output = command
        .current_dir(&folder)
        .args(arguments.split(' '))
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("--method chaos --points 10M"), "{said}");
}

/// Returns the status of the program, its standard output, and its standard error.
fn kfrac(arguments: &[&str]) -> (Option<i32>, String, String) {
    let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_kfrac"));
    let output = command.args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code(),
        text(output.stdout),
        text(output.stderr),
    )
}

#[test]
fn the_command_line_sweeps_parameters_and_leaves_maps_out() {
    let sweep = ["sheet", "tree-libeskind-hadas", "--steps", "2", "-o", "-"];
    let (code, sheet, said) =
        kfrac(&[&sweep[..], &["--set", "frame=1..3", "--samples", "3"]].concat());
    assert_eq!(code, Some(0), "{said}");
    for caption in ["frame = 1: ", "frame = 2: ", "frame = 3: "] {
        assert!(sheet.contains(caption), "{caption}");
    }
    let parts = [
        "--set",
        "s.re=0.3..0.5",
        "--set",
        "s.im=0,0.5",
        "--samples",
        "2",
    ];
    let pair = ["sheet", "complex-pair", "--steps", "2", "-o", "-"];
    let (code, sheet, said) = kfrac(&[&pair[..], &parts].concat());
    assert_eq!(code, Some(0), "{said}");
    for caption in ["s.re = 0.3, s.im = 0: ", "s.re = 0.5, s.im = 0.5: "] {
        assert!(sheet.contains(caption), "{caption}");
    }
    let line = ["--set", "s=[0.3,0]..[0.5,0.5]", "--samples", "2"];
    let (code, same, said) = kfrac(&[&pair[..], &line].concat());
    assert!(code == Some(0) && same == sheet, "{said}");
    let (code, _, said) = kfrac(&[&pair[..], &parts[..5], &["3"]].concat());
    assert!(code == Some(2) && said.contains("do not match"), "{said}");
    let (code, _, said) = kfrac(&["info", "pythagoras", "--set", "angle=20,40"]);
    assert!(code == Some(2) && said.contains("kfrac sheet"), "{said}");
    let (code, table, said) = kfrac(&[
        "grow", "gasket", "--omit", "2", "--steps", "3", "--format", "csv", "-o", "-",
    ]);
    assert_eq!((code, table.lines().count()), (Some(0), 9), "{said}");
    for (arguments, message) in [
        (["info", "gasket", "--omit", "4"], "has 3 maps"),
        (["info", "gasket", "--omit", "1,2,3"], "at least one map"),
        (["info", "koch", "--omit", "1"], "has none"),
        (["grow", "koch", "--color-by", "last-map"], "has no maps"),
    ] {
        let (code, _, said) = kfrac(&arguments);
        assert!(code != Some(0) && said.contains(message), "{said}");
    }
    let (_, info, _) = kfrac(&["info", "cantor", "--steps", "0", "--json"]);
    let info: serde_json::Value = serde_json::from_str(&info).unwrap();
    let measure = &info["measure"];
    assert_close("mean", measure["mean"][0].as_f64().unwrap(), 0.5, 1e-12);
    let variance = measure["covariance"][0][0].as_f64().unwrap();
    assert_close("variance", variance, 0.125, 1e-12);
    assert_eq!(info["default_weights"], true);
    assert_eq!(info["weights_by"], "determinants");
    assert_eq!(info["contraction"]["contracts"], true);
}

/// A complex parameter is a pair of real ones, which maps use together.
#[test]
fn parameters_may_be_complex() {
    let written = system(
        "maps: [{times: [1/2, 1/3], shift: [1, 0]}, {times: [0.7, 1/3], fixed: [1/2, 1/3]}]",
    );
    let all = "maps: [{times: s, shift: [1, 0]}, {times: [0.2 + s.re, s.im], fixed: s}]";
    for params in [
        "s: [1/2, 1/3]",
        "s: [1/2, 2*s.re/3]",
        "one: 1, s: {value: [1/2, 1/3], min: [0, 0], max: [1, one], about: a factor}",
    ] {
        let named = system(&format!("params: {{{params}}}\n{all}"));
        assert_eq!(maps(&named), maps(&written), "{params}");
    }
    let set = |text: &str| {
        let (code, info, said) = kfrac(&[
            "info",
            "complex-pair",
            "--steps",
            "0",
            "--set",
            text,
            "--json",
        ]);
        let info: serde_json::Value = serde_json::from_str(&info).unwrap_or_default();
        (code, info["params"].clone(), said)
    };
    let (_, params, said) = set("s=[1/2, max(0, 1/4)]");
    assert_eq!(
        params,
        serde_json::json!({"s.re": 0.5, "s.im": 0.25}),
        "{said}"
    );
    let (_, params, _) = set("s.im=-0.5");
    assert_eq!(params, serde_json::json!({"s.re": 0.55, "s.im": -0.5}));
    for (text, message) in [
        ("s=0.5", "'s' is complex: [real part, imaginary part]"),
        ("s=[0.5,2]", "'s.im' is 2, above its largest value 1"),
        ("s=[0.5", "a complex value is written [RE,IM]"),
        ("s=[0,0],[0.1,0]", "several values are for `kfrac sheet`"),
        ("r=[0,0]", "it has: s"),
    ] {
        let (code, _, said) = set(text);
        assert!(code == Some(2) && said.contains(message), "{text}: {said}");
    }
    let (code, _, said) = kfrac(&["info", "pythagoras", "--set", "angle=[1,2]"]);
    assert!(
        code == Some(2) && said.contains("'angle' is a real number"),
        "{said}"
    );
}

#[test]
fn info_says_where_weights_come_from() {
    let info = |rule: &str, form: &[&str]| {
        let (code, info, said) = kfrac(&[&["info", rule, "--steps", "0"], form].concat());
        assert_eq!(code, Some(0), "{said}");
        info
    };
    let weights = |rule: &str| {
        let info = info(rule, &[]);
        let mut lines = info.lines().filter(|line| line.starts_with("weights "));
        lines
            .next()
            .map(|line| line["weights".len()..].trim().to_owned())
    };
    let determinants = "by the determinants of the maps, or a twentieth of their mean if that is more, \
                        since the file gives none";
    let widths = "by the widths of the pieces between the points, since the file gives none";
    assert_eq!(weights("gasket").as_deref(), Some(determinants));
    assert_eq!(weights("profile").as_deref(), Some(widths));
    assert_eq!(weights("barnsley-fern"), None);
    for (rule, is_default, by) in [
        ("profile", true, "widths".into()),
        ("barnsley-fern", false, serde_json::Value::Null),
    ] {
        let info: serde_json::Value = serde_json::from_str(&info(rule, &["--json"])).unwrap();
        assert_eq!(
            (&info["default_weights"], &info["weights_by"]),
            (&is_default.into(), &by)
        );
    }
}
