//! Benchmarks of pictures of random systems: `cargo bench --locked --bench systems`.
//!
//! Every sample is a different one of 1,000 affine systems, in a picture of 1024 × 1024 pixels on two
//! threads; median and slowest sample are the figures of interest. A system that is refused ends the
//! benchmark.

#![allow(missing_docs, reason = "a program of its own")]
#![allow(
    clippy::unwrap_used,
    reason = "a benchmark ends where it unwraps nothing"
)]

#[path = "../tests/common/random_systems.rs"]
mod random_systems;

use std::io;
use std::num::NonZero;

use divan::Bencher;
use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::model::Model;
use kfrac::render::{self, Detail, Format, Options, Size};

fn main() {
    divan::main();
}

fn graph(text: String) -> Graph {
    let source = Source::new("random.yaml", format!("kind: ifs\n{text}"));
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    let (Model::Ifs(system), _) = document.resolve(&[]).unwrap() else {
        unreachable!("maps are a system");
    };
    Graph::of_system(&system)
}

fn draw(graph: &Graph) {
    let options = Options::default()
        .format(Format::Png)
        .size(Size::Long(1024))
        .detail(Some(Detail {
            pixels: 1.0,
            decides_steps: true,
        }))
        .threads(NonZero::new(2).unwrap());
    render::write(graph, &Growth::steps(1_000_000), &options, &mut io::sink()).unwrap();
}

#[divan::bench(sample_count = 1000, sample_size = 1)]
fn affine(bencher: Bencher) {
    let mut seeds = 0..;
    let next = || graph(random_systems::random_system(seeds.next().unwrap()));
    bencher
        .with_inputs(next)
        .bench_local_refs(|graph| draw(graph));
}

#[divan::bench(sample_count = 1000, sample_size = 1)]
fn similar(bencher: Bencher) {
    let mut seeds = 0..;
    let next = || graph(random_systems::random_similar_system(seeds.next().unwrap()));
    bencher
        .with_inputs(next)
        .bench_local_refs(|graph| draw(graph));
}
