//! Every rule of the reference: counts, lengths, bounds, areas and sequences of turns are compared with it;
//! and the walk is compared with a second engine that is independent of graphs.

mod closed_forms;
mod data;
mod draws;
mod invented;
mod naive;
mod structure;
mod turns;

use std::collections::BTreeSet;

use crate::common::{self, Grown, compiled, document, grown, resolved};
use data::{Entry, reference};
use kfrac::Count;
use kfrac::geometry::{Bounds, DVec2};
use kfrac::graph::Graph;
use kfrac::grow::{Element, Growth};
use kfrac::measure::similarity_dimension;

const CLOSE: f64 = 1e-12;

/// Limit of the number of elements of an approximant.
const MAX_ELEMENTS: u64 = 20_000;

#[track_caller]
fn assert_close(what: &str, value: f64, expected: f64) {
    let off = (value - expected).abs();
    assert!(
        off <= CLOSE * expected.abs().max(1.0),
        "{what}: {value}, not {expected}"
    );
}

#[track_caller]
fn assert_same_box(what: &str, bounds: &Bounds, expected: [f64; 4]) {
    let corners = [
        bounds.min().x,
        bounds.min().y,
        bounds.max().x,
        bounds.max().y,
    ];
    for (value, expected) in corners.into_iter().zip(expected) {
        assert_close(what, value, expected);
    }
}

/// Returns the deepest step up to 4 within the limit of elements.
fn deepest(graph: &Graph) -> u32 {
    match graph.check_size(4, MAX_ELEMENTS) {
        Ok(_) => 4,
        Err(error) => error.deepest.unwrap(),
    }
}

fn elements(fractals: &[Grown]) -> impl Iterator<Item = &Element> {
    fractals.iter().flat_map(|grown| &grown.elements)
}

#[test]
fn every_rule_of_the_library_is_held_against_the_reference() {
    let rules: BTreeSet<_> = reference()
        .rules
        .iter()
        .map(|entry| entry.rule_name().to_owned())
        .collect();
    for name in common::plane_rules() {
        // There are no independent numbers for rules that were made for kfrac.
        let rule = resolved(&document(&name), &[]);
        if !rule.description().tags.iter().any(|tag| tag == "own") {
            assert!(rules.contains(&name), "{name} is not in the reference");
        }
    }
}

#[test]
fn walk_forecast_bounds_and_reference_agree() {
    for entry in reference().rules.iter().filter(|entry| !entry.is_random()) {
        assert_eq!(entry.per_step.len(), 3, "{}", entry.id);
        let graph = entry.graph(3);
        let mut forecast = graph.forecast().unwrap();
        for step in &entry.per_step {
            let what = format!("{} at {}", entry.id, step.n);
            let fractals = grown(&graph, &Growth::steps(step.n));
            let level = forecast.level();

            let count = elements(&fractals).count() as u64;
            let fertile = elements(&fractals)
                .filter(|element| element.fertile)
                .count() as u64;
            let expected = [step.elements, step.fertile, step.fractals.unwrap_or(1)];
            assert_eq!(
                [count, fertile, fractals.len() as u64],
                expected,
                "{what}: walk"
            );
            let forecasted = [level.elements, level.fertile, level.fractals];
            assert_eq!(forecasted, expected.map(Count::from), "{what}: forecast");

            let lengths = elements(&fractals).map(|element| element.frame.ends());
            let length: f64 = lengths.map(|[p0, p1]| (p1 - p0).length()).sum();
            assert_close(&format!("{what}: length by the walk"), length, step.length);
            assert_close(
                &format!("{what}: forecast length"),
                level.length.unwrap(),
                step.length,
            );

            let mut ends = Bounds::EMPTY;
            let mut drawn = Bounds::EMPTY;
            for element in elements(&fractals) {
                element
                    .frame
                    .ends()
                    .into_iter()
                    .for_each(|end| ends.add(end));
                let points = entry
                    .base_element
                    .points
                    .iter()
                    .map(|&point| DVec2::from(point));
                points.for_each(|point| drawn.add(element.frame.apply(point)));
            }
            let base_bbox = step.base_bbox.unwrap_or(step.bbox);
            assert_same_box(&format!("{what}: end points"), &ends, step.bbox);
            assert_same_box(&format!("{what}: base elements"), &drawn, base_bbox);
            assert_same_box(
                &format!("{what}: bounds"),
                &graph.bounds(step.n).unwrap(),
                base_bbox,
            );

            assert!(forecast.advance(), "{what}");
        }
    }
}

#[test]
fn dimensions_are_those_of_the_reference() {
    for entry in reference().rules.iter().filter(|entry| !entry.is_random()) {
        let dimension = similarity_dimension(&entry.graph(3));
        let value = dimension
            .value
            .unwrap_or_else(|| panic!("{}: {dimension:?}", entry.id));
        assert_close(&entry.id, value, entry.dimension.unwrap());
    }
}

#[test]
fn counts_lengths_and_areas_have_their_closed_forms() {
    let reference = reference();
    let deterministic = reference.rules.iter().filter(|entry| !entry.is_random());
    assert_eq!(deterministic.count(), closed_forms::CLOSED_FORMS.len());
    for &(id, count, length, area) in closed_forms::CLOSED_FORMS {
        let entry = reference.rules.iter().find(|entry| entry.id == id).unwrap();
        let graph = entry.graph(12);
        let mut forecast = graph.forecast().unwrap();
        for n in 0..=12 {
            let what = format!("{id} at {n}");
            let level = forecast.level();
            let exponent = i32::try_from(n).unwrap();
            assert_eq!(level.elements, Count::from(count(n)), "{what}");
            assert_close(
                &format!("{what}: length"),
                level.length.unwrap() / length(exponent),
                1.0,
            );
            assert_eq!(
                level.area.is_some(),
                area.is_some(),
                "{what}: area {:?}",
                level.area
            );
            if let (Some(value), Some(area)) = (level.area, area) {
                assert_close(&format!("{what}: area"), value, area(exponent));
            }
            forecast.advance();
        }
    }
}

#[test]
fn areas_of_closed_paths_are_those_that_the_walk_encloses() {
    let closed = |entry: &&Entry| entry.closed && !entry.base_element.closed;
    for entry in reference().rules.iter().filter(closed) {
        let graph = entry.graph(4);
        let mut forecast = graph.forecast().unwrap();
        for n in 0..=deepest(&graph) {
            let area = |grown: &Grown| {
                let ends = grown.elements.iter().map(|element| element.frame.ends());
                ends.map(|[p0, p1]| p0.perp_dot(p1)).sum::<f64>().abs() / 2.0
            };
            let area: f64 = grown(&graph, &Growth::steps(n)).iter().map(area).sum();
            assert_close(
                &format!("{} at {n}", entry.id),
                forecast.level().area.unwrap(),
                area,
            );
            forecast.advance();
        }
    }
}

#[test]
fn limit_sets_have_the_boxes_that_the_reference_tells() {
    let height = 3f64.sqrt() / 2.0;
    let snowflake = [0.0, -height / 3.0, 1.0, height];
    for (id, expected) in [
        ("koch_curve", [0.0, 0.0, 1.0, height / 3.0]),
        ("peano_9_mandelbrot", [0.0, -0.5, 1.0, 0.5]),
        ("peano_switchback", [0.0, -0.5, 1.0, 0.5]),
        ("hilbert", [0.0, 0.0, 1.0, 1.0]),
        ("snowflake_sweep_7", snowflake),
        ("snowflake_sweep_13", snowflake),
        ("sierpinski_carpet", [0.0, 0.0, 1.0, 1.0]),
        (
            "kaandorp_fig12_disconnected_triangles",
            [0.0, 0.0, 1.0, height],
        ),
        ("pythagoras_tree_squares", [-2.5, 0.0, 3.5, 4.0]),
        ("t_square", [-0.5, -0.5, 1.5, 1.5]),
    ] {
        let reference = reference();
        let entry = reference.rules.iter().find(|entry| entry.id == id).unwrap();
        assert_same_box(id, &entry.graph(3).limit_bounds().unwrap(), expected);
    }
    // Project Euler, problem 395.
    let rule = resolved(&document("pythagoras-345"), &[]);
    let size = compiled(&rule, 3).limit_bounds().unwrap().size();
    assert!((size.x * size.y - 28.2453753155).abs() < 1e-10, "{size}");
}

/// Asserts that an approximant agrees with that of the naive engine.
fn compare(entry: &Entry, steps: u32, fractals: &[Grown]) {
    let expected = naive::grow(entry, steps);
    assert_eq!(fractals.len(), expected.len(), "{} at {steps}", entry.id);
    for (grown, tree) in fractals.iter().zip(&expected) {
        let what = format!("{} at {steps}, fractal {}", entry.id, grown.fractal.number);
        assert_eq!(grown.fractal.age, steps - tree.born, "{what}");
        assert_eq!(grown.elements.len(), tree.elements.len(), "{what}");
        for ((rank, element), placed) in (1..).zip(&grown.elements).zip(&tree.elements) {
            let what = format!("{what}, element {rank}: {element:?}");
            assert_eq!(element.index, rank, "{what}");
            assert_eq!(element.fertile, placed.fertile, "{what}");
            assert_eq!(
                element.frame.direction().number(),
                placed.direction,
                "{what}"
            );
            for (end, expected) in element.frame.ends().into_iter().zip(placed.ends) {
                assert!(
                    end.abs_diff_eq(expected.into(), CLOSE),
                    "{what}, not {placed:?}"
                );
            }
            let top = element.frame.apply(DVec2::Y);
            assert!(
                top.abs_diff_eq(placed.map([0.0, 1.0]).into(), CLOSE),
                "{what}, not {placed:?}"
            );
        }
    }
}

#[test]
fn the_walk_is_that_of_a_naive_engine() {
    for entry in reference().rules.iter().filter(|entry| !entry.is_random()) {
        assert!(
            entry.by_index || entry.generators.len() == 1,
            "{}",
            entry.id
        );
        let graph = entry.graph(4);
        for n in 0..=deepest(&graph) {
            compare(entry, n, &grown(&graph, &Growth::steps(n)));
        }
    }
}
