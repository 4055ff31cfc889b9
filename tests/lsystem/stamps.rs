//! Stamps, and numbers that are drawn for modules.

use kfrac::geometry::DVec2;
use kfrac::graph::Graph;
use kfrac::grow::{Elements, Growth};
use kfrac::lsystem::LSystem;

use crate::common::document_of;

use super::{MOST, system};

fn graph(system: &LSystem, steps: u32, seed: u64) -> Graph {
    Graph::of_lsystem(system, steps, seed, MOST).unwrap()
}

/// Returns the ends of the elements that a graph draws, each with the number of its base element.
fn drawn(graph: &Graph, steps: u32, seed: u64) -> Vec<(usize, [DVec2; 2])> {
    let mut growth = Growth::steps(steps);
    growth.seed = seed;
    let elements = Elements::of(graph, &growth).map(|element| element.unwrap().1);
    let elements = elements.filter(|element| graph.objects()[element.object].visible);
    elements
        .map(|it| (graph.objects()[it.object].base_element, it.frame.ends()))
        .collect()
}

/// Lines of a system with random numbers.
fn lines(text: &str, steps: u32, seed: u64) -> Vec<[DVec2; 2]> {
    let graph = graph(&system(text), steps, seed);
    let drawn = drawn(&graph, steps, seed).into_iter();
    drawn.map(|(_, ends)| ends).collect()
}

/// Names are read from the text, however the file writes it.
#[test]
fn words_of_several_lines_and_with_escapes_place_stamps() {
    let drawn_of = |axiom: &str| {
        let text = format!("axiom: {axiom}\nproductions: {{F: F}}\n");
        drawn(&graph(&system(&text), 0, 0), 0, 0)
    };
    let expected = drawn_of("F ~(triangle)F FF[~(triangle, 2)]F");
    assert!(expected.len() == 7 && expected[1].0 != expected[0].0);
    for axiom in [
        ">-\n  F ~(triangle)F\n  FF[~(triangle, 2)]F",
        "F ~(triangle)F\n  FF[~(triangle, 2)]F",
        r#""F \u007e(triangle)F FF[~(\u0074riangle, 2)]F""#,
    ] {
        assert_eq!(drawn_of(axiom), expected, "{axiom}");
    }
}

/// A triangle and a trapezium, by one symbol, whether the word is compiled or read.
#[test]
fn polygons_of_one_symbol_are_kept_apart() {
    let text = "axiom: Z\nproductions: {A: A}\n\
                symbols: {Z: [open, draw, {turn: 120}, draw, {turn: 120}, draw, close, {turn: 90}, \
                open, {draw: 3}, {turn: 90}, {draw: 4}, {turn: 90}, {draw: 3}, {turn: 90}, {draw: 4}, close]}\n";
    let system = system(text);
    for graph in [
        graph(&system, 0, 0),
        Graph::of_derived_word(&system, 0, 0, MOST).unwrap(),
    ] {
        let areas = drawn(&graph, 0, 0).into_iter().map(|(number, _)| {
            let area = graph.base_elements()[number].signed_area();
            (area * 1e6).round() / 1e6
        });
        assert_eq!(areas.collect::<Vec<_>>(), [0.433_013, 12.0]);
    }
}

#[test]
fn stamps_lie_along_the_heading() {
    let text = "length: 3\naxiom: F+~(leaf)f~(dot, 2)L\nproductions: {}\n\
                stamps: {dot: {disk: {centre: [1/2, 0], radius: 1/2}}}\n\
                symbols: {L: [{turn: 90}, {stamp: dot, scale: 1/3}]}\n";
    let system = system(text);
    for graph in [
        graph(&system, 0, 0),
        Graph::of_derived_word(&system, 0, 0, MOST).unwrap(),
    ] {
        let drawn = drawn(&graph, 0, 0);
        let ends: Vec<_> = drawn.iter().map(|(_, ends)| *ends).collect();
        let expected = [
            [[0.0, 0.0], [3.0, 0.0]],
            [[3.0, 0.0], [3.0, 3.0]],
            [[3.0, 3.0], [3.0, 9.0]],
            [[3.0, 3.0], [2.0, 3.0]],
        ];
        assert_eq!(ends, expected.map(|ends| ends.map(DVec2::from_array)));
        // The disk of two sizes is one base element.
        assert_eq!(drawn[2].0, drawn[3].0);
        let [line, leaf, dot] = [0, 1, 2].map(|it: usize| &graph.base_elements()[drawn[it].0]);
        assert!(line.is_line() && leaf.is_closed() && dot.is_closed());
        assert!((dot.signed_area().abs() - std::f64::consts::FRAC_PI_4).abs() < 1e-6);
    }
}

/// A fractal as a stamp has the elements of its approximant.
#[test]
fn fractals_are_stamps() {
    let document = document_of("initiator: segment\ngenerator: koch\nsteps: 3\n");
    let model = document.resolve(&[]).unwrap().0;
    let koch = model.compile_normalised(3, 0, MOST).unwrap();
    let expected = Elements::of(&koch, &Growth::steps(3)).map(|it| it.unwrap().1.frame.ends());
    let text = "axiom: f~(koch, 2)\nproductions: {}\nstamps: {koch: {fractal: koch, steps: 3}}\n";
    let graph = graph(&system(text), 0, 0);
    let [(base_element, [from, to])] = drawn(&graph, 0, 0)[..] else {
        panic!("one outline");
    };
    assert_eq!([from, to], [DVec2::X, DVec2::new(3.0, 0.0)]);
    let koch = &graph.base_elements()[base_element];
    let pieces = koch.pieces().iter().map(kfrac::geometry::Piece::end);
    let points: Vec<_> = std::iter::once(koch.start()).chain(pieces).collect();
    let sides = points.windows(2).map(|ends| [ends[0], ends[1]]);
    assert_eq!(sides.clone().count(), 64);
    for (side, expected) in sides.zip(expected) {
        for (ours, theirs) in side.into_iter().zip(expected) {
            assert!(ours.distance(theirs) < 1e-12, "{ours} {theirs}");
        }
    }
}

const PLANT: &str = "heading: 90\naxiom: A(1)\n\
                     random: {long: 'uniform(0.8, 1.2)', lean: 'normal(30, 5)', twice: 'choice(lean, 2*lean)'}\n\
                     productions: ['A(s) -> F(s*long)f(s*long)F(s*long)[+(lean)A(s/2)]-(twice)A(s/2)']\n";

/// Numbers are drawn once for a module, from their distributions, and by its path: a further step keeps them.
#[test]
fn numbers_are_drawn_for_modules() {
    let (deep, shallow) = (lines(PLANT, 11, 0), lines(PLANT, 5, 0));
    assert_eq!(deep.len(), 2 * ((1 << 11) - 1));
    for [from, to] in &shallow {
        let is_kept = |ends: &[DVec2; 2]| ends[0] == *from && ends[1] == *to;
        assert!(deep.iter().any(is_kept), "{from} {to}");
    }
    let length = |ends: &[DVec2; 2]| ends[0].distance(ends[1]);
    let shares = |[first, second]: &[[DVec2; 2]; 2]| {
        let long = length(first);
        assert!(
            (length(second) - long).abs() < 1e-12,
            "{first:?} {second:?}"
        );
        // The size of the module is a power of 1/2.
        let size = (long / 0.8).log2().floor().exp2();
        let share = long / size;
        assert!((0.8 - 1e-9..1.2 + 1e-9).contains(&share), "{share}");
        share
    };
    let (pairs, rest) = deep.as_chunks::<2>();
    assert!(rest.is_empty());
    let shares: Vec<f64> = pairs.iter().map(shares).collect();
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    assert!(
        (mean - 1.0).abs() < 4.0 * 0.4 / 12f64.sqrt() / (shares.len() as f64).sqrt(),
        "{mean}"
    );
    assert_ne!(lines(PLANT, 5, 1), shallow);
    assert_eq!(lines(PLANT, 5, 0), shallow);
}

/// A system whose variables have one value each draws what the same system without variables does.
#[test]
fn numbers_without_spread_are_constants() {
    let drawn = "angle: 60\naxiom: A(3)F\nrandom: {x: 'uniform(2, 2)', y: 'normal(x*x, 0)', z: 'choice(y/2)'}\n\
                 productions: ['A(n) : n > 0 -> F(x)[+(y*5)A(n - 1)]F(z)A(n - y/4)', 'B < F -> A']\n";
    let constant = "angle: 60\naxiom: A(3)F\n\
                    productions: ['A(n) : n > 0 -> F(2)[+(20)A(n - 1)]F(2)A(n - 1)', 'B < F -> A']\n";
    for steps in 0..5 {
        assert_eq!(lines(drawn, steps, 7), lines(constant, steps, 7));
    }
}
