//! What several test files share.

#![allow(dead_code, reason = "each test file uses its share")]

use std::convert::Infallible;
use std::path::Path;
use std::sync::Arc;

use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::{Document, Setting};
use kfrac::graph::Graph;
use kfrac::grow::{Element, Fractal, Growth, Visitor, walk};
use kfrac::rule::Rule;

/// Runs the program in a folder: its status, and what it says beside its output.
pub(crate) fn said(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let mut command = assert_cmd::Command::cargo_bin("kfrac").unwrap();
    let output = command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    (output.status.code(), said)
}

/// A rule of the embedded library as it is written.
pub(crate) fn document(name: &str) -> Document {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule(name).unwrap();
    Document::read(&source, &catalogue).unwrap_or_else(|errors| panic!("{}", errors.render(false)))
}

/// A rule that is written in a test, with the components of the embedded library.
pub(crate) fn document_of(text: &str) -> Document {
    let source = Source::new("test.yaml", text);
    Document::read(&source, &Catalogue::embedded())
        .unwrap_or_else(|errors| panic!("{}{text}", errors.render(false)))
}

/// The validated rule, which must not be doubtful.
pub(crate) fn resolved(document: &Document, settings: &[Setting]) -> Arc<Rule> {
    let (model, warnings) = document
        .resolve(settings)
        .unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    assert!(warnings.is_empty(), "{}", warnings.render(false));
    model.into_rule().unwrap()
}

/// The graph of a rule, resolved for some steps.
pub(crate) fn compiled(rule: &Arc<Rule>, steps: u32) -> Graph {
    Graph::compile(rule, steps).unwrap()
}

/// A fractal of an approximant with all its elements.
pub(crate) struct Grown {
    pub(crate) fractal: Fractal,
    pub(crate) elements: Vec<Element>,
    /// Whether the last element goes on to the first.
    pub(crate) is_ring: bool,
}

#[derive(Default)]
struct Collector(Vec<Grown>);

impl Visitor for Collector {
    type Error = Infallible;

    fn begin(&mut self, fractal: Fractal) -> Result<(), Infallible> {
        self.0.push(Grown {
            fractal,
            elements: Vec::new(),
            is_ring: false,
        });
        Ok(())
    }

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.0.last_mut().unwrap().elements.push(*element);
        Ok(())
    }

    fn end(&mut self, joined: bool) -> Result<(), Infallible> {
        let grown = self.0.last_mut().unwrap();
        grown.is_ring = joined && grown.elements.first().is_some_and(|first| first.joined);
        Ok(())
    }
}

/// An approximant, fractal by fractal, by the walk.
pub(crate) fn grown(graph: &Graph, growth: &Growth<'_>) -> Vec<Grown> {
    let mut collector = Collector::default();
    walk(graph, growth, &mut collector).unwrap();
    collector.0
}
