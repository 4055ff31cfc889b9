//! Systems and structures built in code are equal to those written in files.

use kfrac::Parameter;
use kfrac::build::{
    InstanceBuilder, MapBuilder, SetBuilder, StructureBuilder, SystemBuilder, UnionBuilder,
};
use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::model::Model;
use kfrac::style::Colour;

use super::common;

fn model(text: &str) -> Model {
    let resolved = common::document_of(text).resolve(&[]);
    resolved.unwrap_or_else(|errors| panic!("{errors}")).0
}

fn assert_is_system(text: &str, built: &SystemBuilder) {
    let system = built.build().unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(Model::Ifs(system.into()), model(text));
    let saved = built.document().unwrap().to_yaml();
    assert_eq!(model(&saved), model(text), "saved as YAML");
}

fn assert_is_structure(text: &str, built: &StructureBuilder) {
    let structure = built.build().unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(Model::Instancing(structure.into()), model(text));
}

#[test]
fn everything_that_a_system_says_can_be_said() {
    let text = "
kind: ifs
params: {lean: 30}
maps:
  left: {scale: [0.5, 0.6], rotate: [lean, 20], translate: [0, 1], weight: 2}
  right: {times: [0.3, -0.2], conjugate: true, fixed: [1, 1], weight: 1}
  '3': {matrix: [[1/2, 0], [0.1, 1/3]], weight: 1/2}
edges: {left: [left, right], right: {'3': 2, left: 1}, '3': [left]}
condensation:
  - {ellipse: {centre: [0, 1], axes: [2, 1], rotate: 30}, weight: 3}
  - {disk: {centre: [0, 0], radius: 1/2}}
  - {fractal: random-tree, steps: 2, seed: 5, map: {scale: 1/2, rotate: lean}}
  - {fractal: pythagoras, steps: 2, set: {angle: lean + 5}}
  - {point: [1, 2]}
initial: {polygon: [[0, 0], [1, 0], [0, 1]]}
steps: 4
dimension: 1.5
";
    let placed = MapBuilder::scale(0.5).rotate("lean");
    let built = SystemBuilder::new()
        .parameter(Parameter::new("lean", 30.0))
        .map(
            MapBuilder::scales((0.5, 0.6))
                .rotate_axes(("lean", 20))
                .translate((0, 1))
                .weight(2)
                .name("left"),
        )
        .map(
            MapBuilder::times((0.3, -0.2))
                .conjugate()
                .fixed((1, 1))
                .weight(1)
                .name("right"),
        )
        .map(MapBuilder::matrix([("1/2", "0"), ("0.1", "1/3")]).weight("1/2"))
        .edges("left", ["left", "right"])
        .weighted_edges("right", [("3", 2), ("left", 1)])
        .edges(3, ["left"])
        .condensation(SetBuilder::ellipse((0, 1), (2, 1), 30).weight(3))
        .condensation(SetBuilder::disk((0, 0), 0.5))
        .condensation(SetBuilder::fractal("random-tree", 2).seed(5).placed(placed))
        .condensation(SetBuilder::fractal("pythagoras", 2).parameters([("angle", "lean + 5")]))
        .condensation(SetBuilder::point((1, 2)))
        .initial(SetBuilder::polygon([(0, 0), (1, 0), (0, 1)]))
        .steps(4)
        .dimension(1.5);
    assert_is_system(text, &built);
}

#[test]
fn maps_may_be_made_by_points() {
    let corners = [(0, 0), (1, 0), (0, 1)];
    let text = "{kind: ifs, vertices: {points: [[0, 0], [1, 0], [0, 1]], shrink: 1/3}}";
    assert_is_system(text, &SystemBuilder::new().vertices(corners, "1/3"));
    let points = [(0, 0), (1, 2), (3, 1)];
    let text = "{kind: ifs, interpolate: {points: [[0, 0], [1, 2], [3, 1]], scale: [1/3, -0.5]}}";
    assert_is_system(
        text,
        &SystemBuilder::new().interpolate(points, ["1/3", "-0.5"]),
    );
    let text = "{kind: ifs, interpolate: {points: [[0, 0], [1, 2], [3, 1]], dimension: 1.4}}";
    assert_is_system(
        text,
        &SystemBuilder::new().interpolate_to_dimension(points, 1.4),
    );
}

#[test]
fn affine_maps_are_maps() {
    let map = DAffine2::from_mat2_translation(
        DMat2::from_cols_array(&[0.5, 0.1, -0.2, 0.3]),
        DVec2::new(1.0, 2.0),
    );
    let built = SystemBuilder::new().map(map).build().unwrap();
    assert_eq!(built.ifs().maps()[0].affine, map);
}

#[test]
fn everything_that_a_structure_says_can_be_said() {
    let text = "
kind: instancing
params: {levels: 3}
objects:
  wood: [{polyline: [[0, 0], [0, 1], [1, 1]]}]
  tree(0): [{disk: {centre: [0, 0], radius: 1}, tint: {color: teal, alpha: 1/2, hue: 10}}]
  tree(n):
    union:
      - wood
      - {object: tree(n - 1), transform: [{scale: 0.7}, {rotate: 10*n}, {translate: [0, 1]}]}
      - {object: tree(n - 1), transform: [{translate: [1, 0]}, {scale: [0.5, 0.6]}]}
    transform: [{matrix: [[1, 0.1], [0, 1]]}]
scene: [tree(levels)]
initial: {segment: [[0, 0], [0, 1]]}
";
    let tree = UnionBuilder::new()
        .with(InstanceBuilder::of("wood"))
        .with(
            InstanceBuilder::of("tree(n - 1)")
                .scale(0.7)
                .rotate("10*n")
                .translate((0, 1)),
        )
        .with(
            InstanceBuilder::of("tree(n - 1)")
                .translate((1, 0))
                .scales((0.5, 0.6)),
        )
        .matrix([(1.0, 0.1), (0.0, 1.0)]);
    let leaf = InstanceBuilder::from(SetBuilder::disk((0, 0), 1))
        .tint(Colour::parse("teal").unwrap(), 0.5)
        .hue(10);
    let built = StructureBuilder::new(InstanceBuilder::of("tree(levels)"))
        .parameter(Parameter::new("levels", 3.0))
        .object(
            "wood",
            InstanceBuilder::from(SetBuilder::polyline([(0, 0), (0, 1), (1, 1)])),
        )
        .object("tree(0)", leaf)
        .object("tree(n)", tree)
        .initial(SetBuilder::segment((0, 0), (0, 1)));
    assert_is_structure(text, &built);
}

#[test]
fn structures_are_drawn_at_random() {
    let text = "kind: instancing\nparams: {w: 2}\nobjects:\n  A: {at_random: [{weight: w + 1, rotate: 10, \
                union: [{object: A, scale: 1/2}, {disk: {radius: 1}}]}, {weight: 1, union: []}]}\nscene: [A]\n";
    let branch = UnionBuilder::new()
        .with(InstanceBuilder::of("A").scale("1/2"))
        .with(SetBuilder::disk((0, 0), 1))
        .rotate(10);
    let built = StructureBuilder::new(InstanceBuilder::of("A"))
        .parameter(Parameter::new("w", 2.0))
        .object_at_random("A", [("w + 1", branch), ("1", UnionBuilder::new())]);
    assert_is_structure(text, &built);
}

#[test]
fn mistakes_of_systems_and_structures_are_those_of_their_files() {
    let diverges = SystemBuilder::new()
        .map(MapBuilder::scale(2))
        .build()
        .unwrap_err();
    assert!(diverges.to_string().contains("contract"), "{diverges}");
    let nothing = SystemBuilder::new().build().unwrap_err();
    assert!(
        nothing.to_string().contains("the system has no maps"),
        "{nothing}"
    );
    let missing = StructureBuilder::new(InstanceBuilder::of("B"))
        .object("A", InstanceBuilder::from(SetBuilder::point((0, 0))))
        .build()
        .unwrap_err();
    assert!(missing.to_string().contains("no object 'B'"), "{missing}");
}
