//! Maps of nested instances, composed as a viewer composes them.

use std::collections::HashMap;

use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::graph::{Graph, Replacement};

use super::{common, compiled, options, write};

/// Parses a transform in SVG's notation.
fn read(text: &str) -> DAffine2 {
    let calls = text.split(')').filter(|call| !call.is_empty());
    calls.fold(DAffine2::IDENTITY, |map, call| {
        let (name, numbers) = call.split_once('(').unwrap();
        let numbers: Vec<f64> = numbers
            .split(' ')
            .map(|number| number.parse().unwrap())
            .collect();
        let next = match (name, numbers.as_slice()) {
            ("matrix", &[a, b, c, d, e, f]) => DAffine2::from_cols_array(&[a, b, c, d, e, f]),
            ("translate", &[x]) => DAffine2::from_translation(DVec2::new(x, 0.0)),
            ("translate", &[x, y]) => DAffine2::from_translation(DVec2::new(x, y)),
            ("rotate", &[degrees]) => DAffine2::from_angle(degrees.to_radians()),
            ("scale", &[scale]) => DAffine2::from_scale(DVec2::splat(scale)),
            ("scale", &[x, y]) => DAffine2::from_mat2(DMat2::from_diagonal(DVec2::new(x, y))),
            other => panic!("{other:?}"),
        };
        map * next
    })
}

/// Returns the maps of all levels on a path of children through the graph.
fn by_graph(graph: &Graph, steps: u32, mut choose: impl FnMut(usize) -> usize) -> Vec<DAffine2> {
    let mut chain = graph.initiator(steps);
    let mut map = DAffine2::IDENTITY;
    let mut maps = Vec::new();
    loop {
        let instance = &chain.instances[choose(chain.instances.len())];
        map *= instance.frame.map();
        maps.push(map);
        match &graph.objects()[instance.object].replacement {
            Replacement::Fixed(production) if maps.len() <= steps as usize => {
                chain = &production.body;
            }
            _ => return maps,
        }
    }
}

/// Errors do not accumulate: composed of written numbers, positions are exact to rounding at any depth, and
/// sizes to as many digits.
#[test]
fn many_levels_are_as_precise_as_one() {
    for name in ["koch", "gosper", "pythagoras-345", "monkeys-tree", "peano"] {
        let steps = 60;
        let (heading, graph) = compiled(&common::document(name), 0);
        let mut options = options(&heading);
        options.style.color_by = kfrac::style::ColorBy::None;
        options.style.fill = None;
        let (_, text) = write(&graph, steps, &options).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let symbols: HashMap<_, _> = document
            .descendants()
            .filter_map(|node| Some((node.attribute("id")?, node)))
            .collect();
        for way in 0..20usize {
            // Children are chosen pseudorandomly.
            let chance = |state: &mut usize, count: usize| {
                *state = state
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1);
                (*state >> 33) % count
            };
            let mut state = way;
            let expected = by_graph(&graph, steps, |count| chance(&mut state, count));
            let mut state = way;
            let root = document.root_element();
            let mut group = root
                .descendants()
                .filter(|node| node.has_tag_name("g") && node.attribute("id").is_none());
            let mut node = group.nth(1).unwrap();
            let mut map = DAffine2::IDENTITY;
            for (level, expected) in expected.iter().enumerate() {
                let uses: Vec<_> = node
                    .children()
                    .filter(|child| child.has_tag_name("use"))
                    .collect();
                let child = uses[chance(&mut state, uses.len())];
                map *= read(child.attribute("transform").unwrap_or_default());
                node = symbols[&child.attribute("href").unwrap()[1..]];
                let off = (map.translation - expected.translation).length();
                assert!(off < 1e-9, "{name} at level {level}: {off:e}");
                let size = expected.matrix2.x_axis.length();
                let off = (map.matrix2.x_axis - expected.matrix2.x_axis).length() / size;
                assert!(
                    off < 3e-11 * (level + 1) as f64,
                    "{name} at level {level}: {off:e}"
                );
            }
        }
    }
}
