//! Scenes in Universal Scene Description hold the elements of sets in space, in their colours.

use std::collections::BTreeMap;

use crate::common;
use kfrac::geometry::{DAffine3, DMat3, DVec3, Frame3};
use kfrac::graph::Graph;
use kfrac::grow::{Elements, Growth};
use kfrac::render::space::SpaceOptions;
use kfrac::render::{NotInstanced, Options, RenderError, SceneFormat, write_scene};
use kfrac::style::ColorBy;

fn graph(name: &str, records_last: bool) -> (Options, Graph<Frame3>) {
    let model = common::document(name).resolve(&[]).unwrap().0;
    let graph = model.compile_in_space(records_last).unwrap();
    (Options::of(model.metadata()), graph)
}

fn scene(graph: &Graph<Frame3>, steps: u32, options: &Options) -> String {
    let mut bytes = Vec::new();
    write_scene(
        graph,
        steps,
        options,
        &SpaceOptions::default(),
        SceneFormat::Usda,
        None,
        &mut bytes,
    )
    .unwrap();
    String::from_utf8(bytes).unwrap()
}

/// Instance of a prim that another refers to.
struct Reference {
    name: String,
    map: DAffine3,
}

/// Returns the references of every prim, and the colours of those that are elements.
fn read(text: &str) -> (BTreeMap<String, Vec<Reference>>, BTreeMap<String, String>) {
    let (mut prims, mut colours) = (BTreeMap::new(), BTreeMap::new());
    let mut prim = String::new();
    let mut name = None;
    for line in text.lines() {
        if line.starts_with("class") || line.starts_with("def Xform") {
            prim = line.split('"').nth(1).unwrap().to_owned();
            prims.insert(prim.clone(), Vec::new());
        } else if let Some((_, rest)) = line.split_once("references=</") {
            name = Some(rest.split('>').next().unwrap().to_owned());
        } else if let Some((_, map)) = line.split_once("xformOp:transform=")
            // Round elements have a transform, too, and are no references.
            && let Some(name) = name.take()
        {
            let numbers = map.split(['(', ')', ',']).filter(|it| !it.is_empty());
            let numbers: Vec<f64> = numbers.map(|it| it.parse().unwrap()).collect();
            let row = |row: usize| DVec3::from_slice(&numbers[4 * row..]);
            assert_eq!(
                [3, 7, 11, 15].map(|at: usize| numbers[at]),
                [0.0, 0.0, 0.0, 1.0]
            );
            let linear = DMat3::from_cols(row(0), row(1), row(2));
            let map = DAffine3::from_mat3_translation(linear, row(3));
            prims.get_mut(&prim).unwrap().push(Reference { name, map });
        } else if line.starts_with("color3f") {
            colours.insert(prim.clone(), line.to_owned());
        }
    }
    (prims, colours)
}

/// Returns the places and colours of all elements of a scene.
fn expand(text: &str) -> Vec<([i64; 3], String)> {
    let (prims, colours) = read(text);
    let mut open = vec![("World", DAffine3::IDENTITY)];
    let mut elements = Vec::new();
    while let Some((name, place)) = open.pop() {
        if let Some(colour) = colours.get(name) {
            elements.push((rounded(place.translation), colour.clone()));
        }
        let inner = prims[name].iter();
        open.extend(inner.map(|it| (it.name.as_str(), place * it.map)));
    }
    elements.sort();
    elements
}

#[expect(clippy::cast_possible_truncation, reason = "the sets are small")]
fn rounded(point: DVec3) -> [i64; 3] {
    point.to_array().map(|number| (number * 1e6).round() as i64)
}

fn walked(graph: &Graph<Frame3>, steps: u32) -> Vec<[i64; 3]> {
    let elements = Elements::of(graph, &Growth::steps(steps));
    let places = elements.map(|element| rounded(element.unwrap().1.frame.map().translation));
    let mut places: Vec<[i64; 3]> = places.collect();
    places.sort_unstable();
    places
}

#[test]
fn a_scene_has_the_elements_of_the_walk() {
    for (name, steps) in [
        ("menger", 2),
        ("icosahedron-flake", 2),
        ("solid-tetrahedron", 3),
        ("pound-sign-in-space", 2),
        ("hart-tree", 25),
    ] {
        let (options, graph) = graph(name, true);
        let scene = expand(&scene(&graph, steps, &options));
        let places: Vec<[i64; 3]> = scene.into_iter().map(|(place, _)| place).collect();
        assert_eq!(places, walked(&graph, steps), "{name}");
    }
}

#[test]
fn elements_of_a_scene_have_the_colours_of_their_last_maps() {
    // Yellow towards the four corners, red towards the six middles of edges.
    let (options, graph) = graph("solid-tetrahedron", true);
    let mut counts: BTreeMap<String, u32> = BTreeMap::new();
    for (_, colour) in expand(&scene(&graph, 3, &options)) {
        *counts.entry(colour).or_default() += 1;
    }
    assert_eq!(counts.into_values().collect::<Vec<_>>(), [600, 400]);
}

#[test]
fn a_scene_grows_with_the_steps_not_with_the_elements() {
    let (options, graph) = graph("menger", false);
    let one = scene(&graph, 30, &options).len();
    let two = scene(&graph, 60, &options).len();
    assert!(
        two < 400_000 && two < 2 * one,
        "{two} bytes, {one} at half the steps"
    );
}

#[test]
fn colours_that_distinguish_elements_of_one_object_are_refused() {
    let (mut options, graph) = graph("menger", false);
    options.style.color_by = ColorBy::Index;
    let error = write_scene(
        &graph,
        2,
        &options,
        &SpaceOptions::default(),
        SceneFormat::Usda,
        None,
        &mut Vec::new(),
    )
    .unwrap_err();
    assert!(
        matches!(
            error,
            RenderError::NotInstanced(NotInstanced::Colours { by: "index" })
        ),
        "{error}"
    );
}
