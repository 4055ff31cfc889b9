//! Estimates of file sizes before drawing, against the files that are drawn.

use crate::common::{self, document, resolved};
use kfrac::estimate::Estimator;
use kfrac::extent::bounding_box;
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::render::{self, Format, Options, Size};

/// Compares the estimates for those steps of a rule that have a number of elements in a range with pictures
/// of `side` pixels; returns the number of steps compared.
fn hold(name: &str, elements: std::ops::RangeInclusive<u64>, side: u32) -> usize {
    const TOLERANCE: f64 = 1.5;
    const DEEPEST: u32 = 16;
    let rule = resolved(&document(name), &[]);
    let graph = Graph::compile(&rule, DEEPEST).unwrap();
    let options = Options::of(rule.metadata()).size(Size::Long(side));
    let estimator = Estimator::new(&graph, &options);
    let Some(mut forecast) = graph.forecast().filter(|_| graph.is_plain()) else {
        return 0;
    };
    let mut held = 0;
    for step in 0..=DEEPEST {
        let count = forecast.elements().to_u64().unwrap();
        if elements.contains(&count) {
            let growth = Growth::steps(step);
            let bounds = bounding_box(&graph, &growth).unwrap();
            let estimate = estimator.at(&forecast, &bounds).unwrap();
            let mut svg = Vec::new();
            render::write(&graph, &growth, &options, &mut svg).unwrap();
            let ratio = estimate.svg_bytes / svg.len() as f64;
            assert!(
                (1.0 / TOLERANCE..=TOLERANCE).contains(&ratio),
                "{name} at {step}: {estimate:?}, but {} bytes",
                svg.len(),
            );
            held += 1;
        }
        if count > *elements.end() || !forecast.advance() {
            break;
        }
    }
    held
}

#[test]
fn sizes_of_the_library_are_estimated() {
    let rules = common::plane_rules();
    let held = rules.iter().map(|name| {
        let sides = [64, 1024, 4000];
        let held = sides.map(|side| hold(name, 1_000..=6_000, side));
        held.iter().sum::<usize>()
    });
    assert!(held.sum::<usize>() > 150);
}

#[test]
fn sizes_are_estimated_where_elements_are_smaller_than_can_be_written() {
    for name in ["koch", "dragon", "pythagoras", "carpet"] {
        assert!(hold(name, 10_000..=300_000, 40) > 0);
    }
}

/// Large PNG files are pictures with whole areas of one colour.
#[test]
fn sizes_of_png_are_estimated() {
    for (name, step) in [
        ("koch", 5),
        ("koch-snowflake", 6),
        ("dragon", 10),
        ("pythagoras", 8),
        ("gosper", 3),
    ] {
        let rule = resolved(&document(name), &[]);
        let graph = Graph::compile(&rule, step).unwrap();
        let options = Options::of(rule.metadata())
            .size(Size::Long(4000))
            .format(Format::Png);
        let mut forecast = graph.forecast().unwrap();
        assert!((0..step).all(|_| forecast.advance()));
        let growth = Growth::steps(step);
        let bounds = bounding_box(&graph, &growth).unwrap();
        let estimator = Estimator::new(&graph, &options);
        let estimate = estimator.at(&forecast, &bounds).unwrap().png_bytes;
        let mut png = Vec::new();
        render::write(&graph, &growth, &options, &mut png).unwrap();
        let ratio = estimate / png.len() as f64;
        assert!(
            (0.33..=3.0).contains(&ratio),
            "{name}: {estimate}, but {} bytes",
            png.len()
        );
    }
}

#[test]
fn there_is_no_estimate_of_what_draws_decide() {
    let rule = resolved(&document("random-tree"), &[]);
    let graph = Graph::compile(&rule, 4).unwrap();
    let bounds = bounding_box(&graph, &Growth::steps(4)).unwrap();
    let options = Options::of(rule.metadata());
    let estimator = Estimator::new(&graph, &options);
    assert_eq!(estimator.at(&graph.forecast().unwrap(), &bounds), None);
}
