//! Vector graphics in SVG, PDF and DXF, pictures and plots, and tables, as other programs read them.

mod paper;
mod plots;
mod readers;
mod tables;

use std::num::NonZero;
use std::sync::Arc;

use crate::common;
use kfrac::graph::Graph;
use kfrac::grow::Growth;
use kfrac::render::{self, Format, Options, Picture, Size, Unit};
use kfrac::rule::Rule;
use kfrac::style::{Style, Width};

/// Returns a rule of the library.
fn library(name: &str) -> Arc<Rule> {
    common::document(name)
        .resolve(&[])
        .unwrap()
        .0
        .into_rule()
        .unwrap()
}

/// Returns a rule from text.
fn written(text: &str) -> Arc<Rule> {
    common::resolved(&common::document_of(text), &[])
}

/// Draws a rule in one colour; returns the picture and its bytes.
fn draw(rule: &Arc<Rule>, steps: u32, change: impl FnOnce(&mut Options)) -> (Picture, Vec<u8>) {
    let graph = Graph::compile(rule, steps).unwrap();
    let mut options = Options::default()
        .style(Style {
            width: Width::Pixels(1.5),
            ..Style::default()
        })
        .threads(NonZero::<usize>::MIN);
    change(&mut options);
    let mut bytes = Vec::new();
    let picture = render::write(&graph, &Growth::steps(steps), &options, &mut bytes).unwrap();
    (picture, bytes)
}

/// Plots a rule, 200 mm on the long side.
fn plot(rule: &Arc<Rule>, steps: u32, format: Format) -> (Picture, Vec<u8>) {
    draw(rule, steps, |options| {
        options.format = format;
        options.plot = true;
        options.unit = Unit::Tenth;
        options.size = Size::Long(2000);
    })
}

/// A stroke as read: its vertices in millimetres, y down, and whether it is closed.
#[derive(Clone, Debug, Default)]
struct Read {
    vertices: Vec<[f64; 2]>,
    closed: bool,
    /// Colour of the stroke as text.
    ink: String,
}

impl Read {
    fn edges(&self) -> Vec<[[f64; 2]; 2]> {
        let pairs = self.vertices.windows(2).map(|pair| [pair[0], pair[1]]);
        let last = [*self.vertices.last().unwrap(), self.vertices[0]];
        pairs.chain(self.closed.then_some(last)).collect()
    }
}

fn length([[a, b], [c, d]]: [[f64; 2]; 2]) -> f64 {
    (c - a).hypot(d - b)
}

fn total(strokes: &[Read]) -> f64 {
    strokes.iter().flat_map(Read::edges).map(length).sum()
}

/// Returns the bounds of all vertices: least x and y, greatest x and y.
fn bounds(strokes: &[Read]) -> [f64; 4] {
    let mut bounds = [f64::INFINITY, f64::INFINITY, -f64::INFINITY, -f64::INFINITY];
    for [x, y] in strokes.iter().flat_map(|stroke| &stroke.vertices) {
        bounds = [
            bounds[0].min(*x),
            bounds[1].min(*y),
            bounds[2].max(*x),
            bounds[3].max(*y),
        ];
    }
    bounds
}
