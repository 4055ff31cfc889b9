//! Benchmark of the short cuts of PNG pictures: `cargo bench --locked --bench short_cuts`.
//!
//! Draws ten rules of the library to half a pixel, 2048 pixels wide or high, and a tree of one colour to a number
//! of steps, with all short cuts and without one each. Rows are named by the rule and by the short cut left out.
//! Rules that take none of a short cut's ways show the noise.

#![allow(missing_docs, reason = "a program of its own")]
#![allow(
    clippy::unwrap_used,
    reason = "a benchmark ends where it unwraps nothing"
)]

use std::fmt;
use std::io;
use std::num::NonZero;
use std::sync::Arc;

use divan::Bencher;
use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::document::Document;
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::model::Model;
use kfrac::render::{self, Detail, Format, Options, ShortCut, Size};
use kfrac::style::ColorBy;

const RULES: [&str; 10] = [
    "dragon",
    "dragon-wreath",
    "gosper",
    "pythagoras",
    "terdragon-rose",
    "random-tree",
    "self-seeding-square",
    "mandala",
    "quadric-koch-18",
    TREE,
];

/// Tree of one colour.
const TREE: &str = "h-tree";

fn main() {
    divan::main();
}

struct Case(&'static str, Option<ShortCut>);

impl fmt::Display for Case {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.1 {
            None => write!(out, "{} with all", self.0),
            Some(left_out) => write!(out, "{} without {left_out:?}", self.0),
        }
    }
}

fn cases() -> impl Iterator<Item = Case> {
    let left_out = || std::iter::once(None).chain(ShortCut::ALL.map(Some));
    RULES
        .into_iter()
        .flat_map(move |rule| left_out().map(move |it| Case(rule, it)))
}

fn graph(name: &str) -> (Graph, u32, Options) {
    let catalogue = Catalogue::embedded();
    let source = catalogue.component(Shelf::RULES, name).unwrap();
    let document = Document::read(&source, &catalogue).unwrap();
    let (Model::Rule(rule), _) = document.resolve(&[]).unwrap() else {
        unreachable!("a rule");
    };
    let rule = Arc::new(rule);
    let mut options = Options::of(rule.metadata());
    options.format = Format::Png;
    options.size = Size::Long(2048);
    options.detail = Some(Detail {
        pixels: 0.5,
        decides_steps: true,
    });
    let mut steps = 1000;
    if name == TREE {
        options.style.color_by = ColorBy::None;
        options.detail = None;
        steps = 20;
    }
    options.threads = NonZero::new(2).unwrap();
    (Graph::compile(&rule, steps).unwrap(), steps, options)
}

#[divan::bench(args = cases(), sample_count = 5, sample_size = 1)]
fn detailed(bencher: Bencher, Case(name, left_out): &Case) {
    let (graph, steps, mut options) = graph(name);
    if let Some(left_out) = left_out {
        options.short_cuts = options.short_cuts.without(*left_out);
    }
    bencher.bench_local(|| {
        render::write(&graph, &Growth::steps(steps), &options, &mut io::sink()).unwrap()
    });
}
