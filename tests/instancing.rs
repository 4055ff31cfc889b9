//! Structures of objects that instance each other, against a naive expansion and against systems.

use crate::common::{document, document_of, grown, structure};
use kfrac::geometry::{DAffine2, DVec2};
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::ifs::Shape;
use kfrac::instancing::{Instancing, Master, ObjectInstance};
use kfrac::measure::similarity_dimension;
use kfrac::model::Model;
use proptest::prelude::*;

/// Returns the instances of objects, with `None`, and of shapes after some steps, in order, by plain
/// recursion.
fn expanded(
    structure: &Instancing,
    instances: &[ObjectInstance],
    at: DAffine2,
    steps: u32,
    found: &mut Vec<(DAffine2, Option<Shape>)>,
) {
    for instance in instances {
        let map = at * instance.map;
        match &instance.master {
            Master::Shape(shape) => found.push((map, Some((**shape).clone()))),
            Master::Object(number) => {
                let object = &structure.objects()[*number];
                let map = map * object.map;
                if steps == 0 {
                    found.push((map, None));
                } else {
                    expanded(structure, &object.instances, map, steps - 1, found);
                }
            }
        }
    }
}

fn assert_grows_as_expanded(structure: &Instancing, steps: u32) {
    let graph = Graph::of_structure(structure);
    let mut expected = Vec::new();
    expanded(
        structure,
        structure.scene(),
        DAffine2::IDENTITY,
        steps,
        &mut expected,
    );
    let objects = structure
        .objects()
        .iter()
        .flat_map(|object| &object.instances);
    let has_shapes = structure
        .scene()
        .iter()
        .chain(objects)
        .any(|instance| matches!(instance.master, Master::Shape(_)));
    let found = grown(&graph, &Growth::steps(steps));
    assert_eq!(found.len(), 1);
    let found = &found[0].elements;
    assert_eq!(found.len(), expected.len());
    for (element, (map, shape)) in found.iter().zip(&expected) {
        assert!(
            element
                .frame
                .map()
                .abs_diff_eq(*map, 1e-12 * (1.0 + map.translation.length()))
        );
        assert_eq!(element.fertile, shape.is_none());
        let object = &graph.objects()[element.object];
        match shape {
            Some(Shape::Outline(outline)) => {
                assert_eq!(&graph.base_elements()[object.base_element], outline);
            }
            Some(Shape::Point(point)) => {
                assert_eq!(graph.base_elements()[object.base_element].start(), *point);
            }
            Some(Shape::Union(_)) => unreachable!("a structure has every outline alone"),
            None => assert_eq!(object.visible, structure.initial().is_some() || !has_shapes),
        }
    }
}

const GASKET: &str = "kind: instancing
objects:
  up: {union: [up, left, right], scale: 0.5, translate: [0, 0.5]}
  left: {union: [up, left, right], scale: 0.5, translate: [-0.433, -0.25]}
  right: {union: [up, left, right], scale: 0.5, translate: [0.433, -0.25]}
scene: [up, left, right]
";

/// The gasket of Hart 1992, section 2.1, with the numbers printed there.
#[test]
fn the_gasket_of_the_paper_is_the_system_of_three_maps() {
    let structure = structure(GASKET);
    for steps in 0..5 {
        assert_grows_as_expanded(&structure, steps);
    }
    let graph = Graph::of_structure(&structure);
    let forecast = graph.forecast().unwrap().level();
    assert_eq!(forecast.elements.to_u64(), Some(3));
    let dimension = similarity_dimension(&graph).value.unwrap();
    assert!((dimension - 3f64.ln() / 2f64.ln()).abs() < 1e-12);
    // The corners are the fixed points of the three maps.
    let bounds = graph.limit_bounds().unwrap();
    assert!((bounds.min() - DVec2::new(-0.866, -0.5)).length() < 1e-12);
    assert!((bounds.max() - DVec2::new(0.866, 1.0)).length() < 1e-12);
}

#[test]
fn objects_of_levels_end_where_there_is_one_of_that_level() {
    let iterative = document("gasket-iterative").resolve(&[]).unwrap().0;
    let Model::Instancing(iterative) = iterative else {
        panic!("this is a structure");
    };
    // A triangle, the whole of 7 levels, and three objects on each of 6.
    assert_eq!(iterative.objects().len(), 1 + 7 + 3 * 6);
    assert_grows_as_expanded(&iterative, 3);
    let graph = Graph::of_structure(&iterative);
    let all = grown(&graph, &Growth::steps(14));
    assert_eq!(all[0].elements.len(), 729);
    assert!(all[0].elements.iter().all(|element| !element.fertile));
    // Later steps have as many elements.
    assert_eq!(grown(&graph, &Growth::steps(20))[0].elements.len(), 729);

    let recursive = document("gasket-recursive").resolve(&[]).unwrap().0;
    let recursive = recursive.compile(6).unwrap();
    let both = [
        grown(&recursive, &Growth::steps(5)),
        grown(&graph, &Growth::steps(14)),
    ];
    let maps = both
        .each_ref()
        .map(|grown| grown[0].elements.iter().map(|it| *it.frame.map()));
    let [recursive, iterative] = maps;
    recursive
        .zip(iterative)
        .for_each(|(a, b)| assert!(a.abs_diff_eq(b, 1e-12)));
}

#[test]
fn transforms_are_done_in_the_order_in_which_they_are_written() {
    let at = |transforms: &str| {
        let text = format!(
            "kind: instancing\nobjects: {{a: [{{point: [1, 0]}}]}}\nscene: [{{object: a, {transforms}}}]\n"
        );
        structure(&text).scene()[0].map.transform_point2(DVec2::X)
    };
    let near = |a: DVec2, x: f64, y: f64| assert!((a - DVec2::new(x, y)).length() < 1e-12, "{a}");
    near(at("scale: 2, translate: [1, 0]"), 3.0, 0.0);
    near(at("translate: [1, 0], scale: 2"), 4.0, 0.0);
    near(at("rotate: 90, translate: [1, 0]"), 1.0, 1.0);
    near(at("translate: [1, 0], rotate: 90"), 0.0, 2.0);
    near(at("scale: [2, 3], rotate: 90"), 0.0, 2.0);
    near(at("matrix: [[0, -1], [2, 0]]"), 0.0, 2.0);
    near(
        at("transform: [{rotate: 90}, {translate: [1, 0]}, {rotate: 90}]"),
        -1.0,
        1.0,
    );
    near(
        at("rotate: 90, transform: [{translate: [1, 0]}, {rotate: 90}], scale: 2"),
        -2.0,
        2.0,
    );
}

/// Generates random structures of a few objects. Each object instances later ones at any size and arbitrary
/// ones at half the size, so that all loops contract.
fn structures() -> impl Strategy<Value = String> {
    let number = -1.5..1.5f64;
    let instance = (
        0..5usize,
        number.clone(),
        number,
        -180.0..180.0f64,
        0.2..0.5f64,
        0..4u8,
    );
    let object = proptest::collection::vec(instance, 1..4);
    proptest::collection::vec(object, 2..5).prop_map(|objects| {
        let count = objects.len();
        let union = |object: &[(usize, f64, f64, f64, f64, u8)]| {
            let instances = object.iter().map(|(to, x, y, angle, scale, form)| {
                let master = match form {
                    0 => format!("segment: [[0, 0], [{x}, 1]]"),
                    1 => "disk: {radius: 0.5}".to_owned(),
                    _ => format!("object: o{}", to % count),
                };
                format!("{{{master}, rotate: {angle}, scale: [{scale}, -{scale}], translate: [{x}, {y}]}}")
            });
            format!("[{}]", instances.collect::<Vec<_>>().join(", "))
        };
        let mut text = "kind: instancing\nobjects:\n".to_owned();
        for (number, object) in objects.iter().enumerate() {
            text.push_str(&format!("  o{number}: {}\n", union(object)));
        }
        let names: Vec<_> = (0..count).map(|number| format!("o{number}")).collect();
        text.push_str(&format!("scene: [{}]\n", names.join(", ")));
        text
    })
}

proptest! {
    #![proptest_config(crate::common::cases(64))]

    #[test]
    fn random_structures_grow_as_they_are_expanded(text in structures(), steps in 0..4u32) {
        let structure = structure(&text);
        assert_grows_as_expanded(&structure, steps);
        let graph = Graph::of_structure(&structure);
        let mut forecast = graph.forecast().unwrap();
        (0..steps).for_each(|_| assert!(forecast.advance()));
        let count = grown(&graph, &Growth::steps(steps))[0].elements.len();
        prop_assert_eq!(forecast.level().elements.to_u64(), Some(count as u64));
    }
}

/// A loop may enlarge on its way if it returns smaller. With 14 objects that all lead to each other, single
/// products of instances are too many to enumerate.
#[test]
fn loops_shrink_by_what_they_stretch_in_all() {
    let objects: String = (0..14)
        .map(|from| {
            let scale = |to| if to > from { "1.05" } else { "0.3" };
            let instance = |to| format!("{{object: a{to}, scale: {}, rotate: {to}}}", scale(to));
            let all: Vec<_> = (0..14).map(instance).collect();
            format!("  a{from}: [{}]\n", all.join(", "))
        })
        .collect();
    let text = format!("kind: instancing\nobjects:\n{objects}scene: [a0]\n");
    let (_, doubts) = document_of(&text).resolve(&[]).unwrap();
    assert!(doubts.is_empty(), "{doubts}");
}

#[test]
fn what_ends_need_not_shrink() {
    let structure = structure(
        "kind: instancing\nobjects:\n  a(0): [{segment: [[0, 0], [1, 0]]}]\n  a(n): [{object: a(n - 1), scale: 2}]\nscene: [a(400)]\n",
    );
    let dimension = similarity_dimension(&Graph::of_structure(&structure));
    assert_eq!(dimension.note.as_deref(), Some("nothing stays fertile"));
}
