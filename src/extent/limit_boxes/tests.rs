//! Compares boxes that share bounds with boxes that do not.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use std::borrow::Cow;

use crate::Fractal;
use crate::catalogue::{Catalogue, Shelf};
use crate::geometry::{Bounds, Point};
use crate::graph::{Graph, Instance};

use super::{Bounded, LimitBoxes, Recurrent};

/// Asserts that the boxes of all objects are those of graphs that begin with them.
fn assert_shared<F: Bounded>(graph: &Graph<F>, name: &str) {
    let shared = graph.limit_boxes().unwrap();
    for object in 0..graph.objects().len() {
        let mut alone = graph.clone();
        let root = Instance {
            length: F::UNIT.stretch(),
            ..Instance::new(object, F::UNIT, 0)
        };
        alone.initiators_mut()[0].instances = vec![root];
        assert_eq!(
            shared.at_object(object),
            alone.limit_bounds(),
            "{name}: object {object}"
        );
    }
}

#[test]
fn objects_share_bounds() {
    for name in ["barnsley-fern", "hilbert", "maple-leaf"] {
        let fractal = Fractal::named(name).unwrap();
        assert_shared(&fractal.model().compile(2).unwrap(), name);
    }
    for name in ["menger", "fern-in-space"] {
        let fractal = Fractal::named(name).unwrap();
        assert_shared(&fractal.model().compile_in_space(false).unwrap(), name);
    }
}

/// Asserts that a box that compilation has found is that of the compiled graph; returns whether there is one.
fn is_known<F: Bounded>(graph: &Graph<F>, name: &str) -> bool {
    let mut fresh = graph.clone();
    fresh.initiators_mut();
    let Some(known) = graph.limit_bounds else {
        return false;
    };
    let [known, found] = [known, fresh.limit_bounds()];
    assert_eq!(known.is_some(), found.is_some(), "{name}");
    if let Some((known, found)) = known.zip(found) {
        let size = found.size().length();
        for (a, b) in [(known.min(), found.min()), (known.max(), found.max())] {
            assert!(
                (a - b).length() <= 1e-10 * size,
                "{name}: {known:?} {found:?}"
            );
        }
    }
    true
}

#[test]
fn boxes_that_compilation_finds_are_those_of_its_graph() {
    let catalogue = Catalogue::embedded();
    let mut known = 0;
    for entry in catalogue.entries() {
        if ![Shelf::IFS, Shelf::INSTANCING].contains(&entry.shelf) {
            continue;
        }
        let fractal = Fractal::named(&entry.name).unwrap();
        let model = fractal.model();
        known += usize::from(match model.compile(2) {
            Ok(graph) => is_known(&graph, &entry.name),
            Err(_) => is_known(&model.compile_in_space(false).unwrap(), &entry.name),
        });
    }
    assert!(known > 60, "{known}");
}

#[test]
fn instances_that_vanish_change_no_box() {
    let text = "kind: ifs\nmaps:\n  - {scale: 1/2}\n  - {scale: 1/3, rotate: 40, translate: [1, 0]}\n\
                initial: {fractal: binary-tree, steps: 4}\n";
    let fractal = Fractal::parse(text).unwrap();
    let graph = fractal.model().compile(2).unwrap();
    let boxes = graph.limit_boxes().unwrap();
    assert!(matches!(boxes.graph, Cow::Owned(_)));
    let whole = LimitBoxes {
        graph: Cow::Borrowed(&graph),
        ..graph.limit_boxes().unwrap()
    };
    let start = &graph.initiator(0).instances;
    let [living, all]: [Bounds; 2] = [boxes, whole].map(|boxes| boxes.at(start).unwrap());
    for (a, b) in [(living.min(), all.min()), (living.max(), all.max())] {
        assert!((a - b).length() < 1e-14, "{living:?} {all:?}");
    }
}

/// Asserts that policy iteration finds the box that is found level by level.
fn assert_recurrent<F: Bounded>(graph: &Graph<F>, name: &str) {
    let recurrent = Recurrent::of(graph).unwrap_or_else(|| panic!("{name}: directions recur"));
    let found = recurrent.box_of(&graph.initiator(0).instances).unwrap();
    let expected = graph.limit_bounds().unwrap();
    let size = expected.size().length();
    for (a, b) in [(found.min(), expected.min()), (found.max(), expected.max())] {
        assert!(
            (a - b).length() < 1e-13 * size,
            "{name}: {found:?} {expected:?}"
        );
    }
}

#[test]
fn policy_iteration_finds_the_same_boxes() {
    for name in ["hilbert", "dragon", "koch", "pentaflake"] {
        let fractal = Fractal::named(name).unwrap();
        assert_recurrent(&fractal.model().compile(2).unwrap(), name);
    }
    for name in ["menger", "icosahedron-flake", "jerusalem-cube"] {
        let fractal = Fractal::named(name).unwrap();
        assert_recurrent(&fractal.model().compile_in_space(false).unwrap(), name);
    }
    // A single map of ratio 0.999, from one object to the other and back.
    let slow = "kind: instancing\nobjects:\n  a: [{object: b, scale: 0.999, translate: [1, 0]}]\n  \
                b: [{object: a, scale: 0.999, translate: [0, 1]}, {object: a, scale: 0.5}]\nscene: [a]\n";
    let fractal = Fractal::parse(slow).unwrap();
    assert_recurrent(&fractal.model().compile(2).unwrap(), "slow");
    // Directions that turn by an irrational part of a circle do not recur.
    let fractal = Fractal::named("gosper").unwrap();
    let graph = fractal.model().compile(2).unwrap();
    assert!(Recurrent::of(&graph).is_none());
}

/// Objects in a ring, each a smaller copy of the next and of the one after it: farthest values follow from the one after.
#[test]
fn many_objects_that_contract_slowly_have_boxes() {
    const COUNT: usize = 1500;
    const RATIO: f64 = 0.97;
    let shift = |object: usize| (object * 7 % 11) as f64 / 10.0;
    let mut text = "kind: instancing\nobjects:\n".to_owned();
    for object in 0..COUNT {
        let [next, after] = [1, 2].map(|step| (object + step) % COUNT);
        text += &format!(
            "  o{object}:\n    - {{object: o{next}, scale: {RATIO}, translate: [{}, 0]}}\n    \
             - {{object: o{after}, scale: {RATIO}, rotate: 180}}\n",
            shift(object)
        );
    }
    text += "scene: [o0]\n";
    let graph = Fractal::parse(&text).unwrap().model().compile(0).unwrap();
    assert!(graph.has_many_behaviours());
    let [mut least, mut most] = [[0.0_f64; COUNT]; 2];
    for _ in 0..2000 {
        let value = |object: usize| {
            let [next, after] = [1, 2].map(|step| (object + step) % COUNT);
            let low = (shift(object) + RATIO * least[next]).min(-RATIO * most[after]);
            let high = (shift(object) + RATIO * most[next]).max(-RATIO * least[after]);
            (low, high)
        };
        let values: Vec<_> = (0..COUNT).map(value).collect();
        for (object, (low, high)) in values.into_iter().enumerate() {
            (least[object], most[object]) = (low, high);
        }
    }
    let bounds = graph.limit_bounds().unwrap();
    let found = [bounds.min().x, bounds.max().x];
    for (found, expected) in found.into_iter().zip([least[0], most[0]]) {
        assert!(
            (found - expected).abs() < 1e-12 * expected.abs(),
            "{found} {expected}"
        );
    }
    assert_eq!(bounds.size().y, 0.0);
}
