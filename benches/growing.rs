//! Benchmarks of growing and writing: `cargo bench --locked`, or `cargo bench --locked -- walk` for some of them.

#![allow(missing_docs, reason = "a program of its own")]
#![allow(
    clippy::unwrap_used,
    reason = "a benchmark ends where it unwraps nothing"
)]

use std::convert::Infallible;
use std::hint::black_box;
use std::io;
use std::num::NonZero;
use std::sync::Arc;

use divan::Bencher;
use divan::counter::ItemsCount;
use kfrac::catalogue::Catalogue;
use kfrac::document::Document;
use kfrac::export;
use kfrac::graph::Graph;
use kfrac::grow::{Element, FractalInfo, Growth, Visitor, count, walk};
use kfrac::render::{self, Options};
use kfrac::rule::Rule;

fn main() {
    divan::main();
}

fn rule(name: &str) -> Arc<Rule> {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule(name).unwrap();
    let document = Document::read(&source, &catalogue).unwrap();
    document.resolve(&[]).unwrap().0.into_rule().unwrap()
}

fn graph(name: &str, steps: u32) -> Graph {
    Graph::compile(&rule(name), steps).unwrap()
}

/// A visitor that reads every element and discards it.
struct Looks;

impl Visitor for Looks {
    type Error = Infallible;

    fn begin(&mut self, _: FractalInfo) -> Result<(), Infallible> {
        Ok(())
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        black_box(element);
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}

#[divan::bench(args = [("koch", 10), ("dragon", 18), ("random-tree", 14)])]
fn walk_elements(bencher: Bencher, (name, steps): (&str, u32)) {
    let graph = graph(name, steps);
    let growth = Growth::steps(steps);
    let elements = walk(&graph, &growth, &mut Looks).unwrap().elements;
    bencher
        .counter(ItemsCount::new(elements))
        .bench(|| walk(&graph, &growth, &mut Looks).unwrap());
}

#[divan::bench(args = [("koch", 11, 1), ("koch", 11, 2), ("dragon", 22, 1), ("dragon", 22, 2), ("random-tree", 14, 2)])]
fn count_elements(bencher: Bencher, (name, steps, threads): (&str, u32, usize)) {
    let graph = graph(name, steps);
    let growth = Growth::steps(steps);
    let threads = NonZero::new(threads).unwrap();
    let elements = count(&graph, &growth, threads).unwrap().walked.elements;
    bencher
        .counter(ItemsCount::new(elements))
        .bench(|| count(&graph, &growth, threads).unwrap());
}

#[divan::bench(args = [("koch", 9), ("dragon", 16), ("carpet", 5)])]
fn write_svg(bencher: Bencher, (name, steps): (&str, u32)) {
    let graph = graph(name, steps);
    let growth = Growth::steps(steps);
    let options = Options::of(rule(name).metadata());
    let write = || render::write(&graph, &growth, &options, &mut io::sink()).unwrap();
    bencher
        .counter(ItemsCount::new(write().elements))
        .bench(write);
}

#[divan::bench]
fn write_csv(bencher: Bencher) {
    let graph = graph("koch", 8);
    let growth = Growth::steps(8);
    let one = NonZero::<usize>::MIN;
    let write = || {
        let format = export::TableFormat::Csv;
        export::write(&graph, &growth, format, one, &mut io::sink()).unwrap()
    };
    bencher
        .counter(ItemsCount::new(write().elements))
        .bench(write);
}

#[divan::bench(args = ["koch", "vegetation", "snow-crystal"])]
fn forecast_step_2000(bencher: Bencher, name: &str) {
    let graph = graph(name, 2000);
    bencher.bench(|| {
        let mut forecast = graph.forecast().unwrap();
        (0..2000).for_each(|_| assert!(forecast.advance()));
        forecast.level()
    });
}

#[divan::bench(args = ["koch", "gosper", "pythagoras"])]
fn bounds(bencher: Bencher, name: &str) {
    let graph = graph(name, 40);
    bencher.bench(|| (graph.bounds(40), graph.limit_bounds()));
}

#[divan::bench(args = ["koch", "vegetation", "snow-crystal"])]
fn compile(bencher: Bencher, name: &str) {
    let rule = rule(name);
    bencher.bench(|| Graph::compile(&rule, 20).unwrap());
}
