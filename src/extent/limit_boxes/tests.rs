//! Compares boxes that share bounds with boxes that do not.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use std::borrow::Cow;

use crate::Fractal;
use crate::geometry::Bounds;
use crate::graph::{Graph, Instance};

use super::{Bounded, LimitBoxes};

/// Asserts that the boxes of all objects are those of graphs that begin with them.
fn assert_shared<F: Bounded>(graph: &Graph<F>, name: &str) {
    let shared = graph.limit_boxes().unwrap();
    for object in 0..graph.objects().len() {
        let mut alone = graph.clone();
        let root = Instance {
            length: F::UNIT.stretch(),
            ..Instance::new(object, F::UNIT, 0)
        };
        alone.initiators[0].instances = vec![root];
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
