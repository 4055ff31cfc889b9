//! Estimates of the sizes of files, whose work is bounded by counts that are known before it.

use std::fmt::Write;

use cpu_time::ThreadTime;
use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::estimate::{Estimator, instanced_bytes};
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::render::{self, Options};

/// Returns the graph of a file for a number of steps, and the options of its pictures.
fn compiled(text: &str, steps: u32) -> (Graph, Options) {
    let source = Source::new("test.yaml", text);
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    let (model, _) = document.resolve(&[]).unwrap();
    let options = Options::of(model.metadata());
    (model.compile(steps).unwrap(), options)
}

/// Returns objects each of which is the union of all of them, a fifth of their size and placed differently, and of a disk.
fn complete(count: usize) -> String {
    let mut text = String::from("kind: instancing\nobjects:\n");
    for i in 0..count {
        write!(text, "  a{i}: [{{disk: {{radius: 0.1}}}}").unwrap();
        for j in 0..count {
            let place = (131 * i + 17 * j) % 1_000;
            write!(
                text,
                ", {{object: a{j}, scale: 0.2, translate: [0.{place:03}, 0]}}"
            )
            .unwrap();
        }
        text += "]\n";
    }
    text + "scene: [a0]\n"
}

/// The symbols of 40 objects consist of 1,640 instances at each of 32 steps, those of 165 objects of 27,390.
#[test]
fn files_of_nested_instances_are_estimated_where_they_take_little_work() {
    let (graph, options) = compiled(&complete(40), 32);
    assert!(instanced_bytes(&graph, &options, 32, &|steps| graph.bounds(steps)).is_some());
    let (graph, options) = compiled(&complete(165), 32);
    let before = ThreadTime::now();
    assert_eq!(
        instanced_bytes(&graph, &options, 32, &|steps| graph.bounds(steps)),
        None
    );
    assert!(before.elapsed().as_secs_f64() < 10.0);
}

/// Each step has 3,000 elements of 3,000 objects that are replaced alike.
#[test]
fn elements_that_are_replaced_alike_are_looked_at_once() {
    let mut text = String::from("initiator: segment\ngenerator:\n  - [0, 0]\n");
    for i in 1..=3_000 {
        writeln!(
            text,
            "  - {{to: [{i}/3000, 0.1], tint: {{hue: {}}}}}",
            i % 360
        )
        .unwrap();
    }
    let (graph, options) = compiled(&text, 32);
    let before = ThreadTime::now();
    let _ = instanced_bytes(&graph, &options, 32, &|steps| graph.bounds(steps));
    assert!(before.elapsed().as_secs_f64() < 10.0);
}

/// Returns a rule whose base element is a polygon of many sides, of different lengths.
fn jagged(sides: u32) -> String {
    let mut text = String::from("initiator: segment\nbase_element: {closed: true, points: [[0, 0]");
    for i in 1..sides {
        let height = f64::from(i * i % 17 + 1) / 20.0;
        write!(text, ", [{i}/{sides}, {height}]").unwrap();
    }
    text + "]}\ngenerator: [[0, 0], [1/3, 0], [2/3, 0.2], [1, 0]]\n"
}

#[test]
fn many_sides_are_estimated_from_some() {
    let (graph, options) = compiled(&jagged(2_000), 3);
    let mut svg = Vec::new();
    render::write(&graph, &Growth::steps(3), &options, &mut svg).unwrap();
    let mut forecast = graph.forecast().unwrap();
    assert!((0..3).all(|_| forecast.advance()));
    let bounds = graph.bounds(3).unwrap();
    let estimator = Estimator::new(&graph, &options);
    let estimate = estimator.at(&forecast, &bounds).unwrap();
    let ratio = estimate.svg_bytes / svg.len() as f64;
    assert!((0.8..1.25).contains(&ratio), "{ratio}");
    // 256 sides and an element are 257 of 2²⁰, and one estimate has been made.
    let made = (0..8_000).take_while(|_| estimator.at(&forecast, &bounds).is_some());
    let objects = forecast.populations().unwrap().count();
    assert_eq!(made.count(), (1 << 20) / (257 * objects) - 1);
}

/// A step adds a thousand numbers, and looks at as many sums. Of n steps, the numbers have 3 n digits: the work of 10⁸ additions
/// and of as many looks ends them.
#[test]
fn forecasts_of_many_digits_end_soon() {
    let mut text = String::from("kind: ifs\nmaps:\n");
    for i in 0..1_000 {
        writeln!(
            text,
            "  - {{scale: 0.02, translate: [0.{i:03}, {}]}}",
            i % 7
        )
        .unwrap();
    }
    let (graph, _) = compiled(&text, 1);
    let mut forecast = graph.forecast().unwrap();
    let steps = (0..10_000).take_while(|_| forecast.advance()).count();
    assert!((300..600).contains(&steps), "{steps}");
}
