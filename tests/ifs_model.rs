//! The model of iterated function systems, against the reference, closed forms and brute force.

mod averages;
mod contraction;
mod interpolation;
mod measure;
mod mistakes;
mod reference;
mod shapes;
mod walk;

use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::ifs::{Definition, Edge, Ifs, Map};
use proptest::prelude::*;

/// Returns a map, given its matrix by rows and its translation.
fn map(a: f64, b: f64, c: f64, d: f64, shift: [f64; 2]) -> Map {
    Map::new(DAffine2::from_cols(
        DVec2::new(a, c),
        DVec2::new(b, d),
        shift.into(),
    ))
}

fn definition(maps: Vec<Map>) -> Definition {
    Definition {
        maps,
        ..Definition::default()
    }
}

fn system(maps: Vec<Map>) -> Ifs {
    Ifs::new(definition(maps)).unwrap()
}

fn edges(pairs: &[(usize, usize)]) -> Option<Vec<Edge>> {
    let edges = pairs.iter().map(|&(from, to)| Edge {
        from,
        to,
        weight: None,
    });
    Some(edges.collect())
}

fn recurrent(maps: Vec<Map>, pairs: &[(usize, usize)]) -> Ifs {
    let edges = edges(pairs);
    Ifs::new(Definition {
        edges,
        ..definition(maps)
    })
    .unwrap()
}

#[track_caller]
fn assert_near(value: DVec2, expected: DVec2, tolerance: f64) {
    let off = (value - expected).abs().max_element();
    assert!(off <= tolerance, "{value}, not {expected}: {off:e} off");
}

#[track_caller]
fn assert_near_matrix(value: DMat2, expected: DMat2, tolerance: f64) {
    assert_near(value.x_axis, expected.x_axis, tolerance);
    assert_near(value.y_axis, expected.y_axis, tolerance);
}

/// Generates matrices with entries up to a size.
fn matrix(size: f64) -> impl Strategy<Value = DMat2> {
    prop::array::uniform4(-size..size).prop_map(|entries| DMat2::from_cols_array(&entries))
}

/// Generates edges among a number of maps: a cycle through all, so that each is entered and left, and some
/// more.
fn digraph(maps: usize) -> impl Strategy<Value = Vec<(usize, usize)>> {
    prop::collection::vec(any::<bool>(), maps * maps).prop_map(move |chosen| {
        let pairs = (0..maps * maps).map(|pair| (pair / maps, pair % maps));
        let listed = pairs
            .zip(chosen)
            .filter(|&((from, to), chosen)| chosen || to == (from + 1) % maps);
        listed.map(|(pair, _)| pair).collect()
    })
}
