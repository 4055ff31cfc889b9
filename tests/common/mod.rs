//! Helpers shared by several test files.

pub(crate) mod random_systems;

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use kfrac::catalogue::{Catalogue, LibraryFile, Shelf};
use kfrac::diagnostic::Source;
use kfrac::document::{Document, Setting};
use kfrac::graph::Graph;
use kfrac::grow::{Element, FractalInfo, Growth, Visitor, walk};
use kfrac::instancing::Instancing;
use kfrac::model::Model;
use kfrac::rule::Rule;
use proptest::test_runner::Config as ProptestConfig;

/// Returns the configuration of a property that is tested on `cases` inputs, or on `KFRAC_CASES` times as many.
pub(crate) fn cases(cases: u32) -> ProptestConfig {
    let times = std::env::var("KFRAC_CASES")
        .map(|times| times.parse().expect("KFRAC_CASES is a whole number"));
    ProptestConfig {
        cases: cases.saturating_mul(times.unwrap_or(1)),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Runs the program in a folder; returns its status and its standard error.
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

/// Returns a rule of the embedded library as a document.
pub(crate) fn document(name: &str) -> Document {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule(name).unwrap();
    Document::read(&source, &catalogue).unwrap_or_else(|errors| panic!("{}", errors.render(false)))
}

/// Returns the names of the library's rules in the plane.
pub(crate) fn plane_rules() -> Vec<String> {
    let catalogue = Catalogue::embedded();
    let is_meant = |entry: &LibraryFile| {
        let is_rule = entry.shelf == Shelf::RULES;
        let is_in_space = |text: &str| text.contains("\nspace: 3\n");
        is_rule && !is_in_space(catalogue.open(entry).unwrap().text())
    };
    let entries = catalogue.entries().into_iter().filter(is_meant);
    entries.map(|entry| entry.name).collect()
}

/// Returns a document from text, with the components of the embedded library.
pub(crate) fn document_of(text: &str) -> Document {
    let source = Source::new("test.yaml", text);
    Document::read(&source, &Catalogue::embedded())
        .unwrap_or_else(|errors| panic!("{}{text}", errors.render(false)))
}

/// Returns the structure of a text, which must resolve without warnings.
pub(crate) fn structure(text: &str) -> Instancing {
    let (model, warnings) = document_of(text)
        .resolve(&[])
        .unwrap_or_else(|errors| panic!("{}{text}", errors.render(false)));
    assert!(warnings.is_empty(), "{}", warnings.render(false));
    let Model::Instancing(structure) = model else {
        panic!("{text} is no structure");
    };
    (*structure).clone()
}

/// Returns the validated rule, which must resolve without warnings.
pub(crate) fn resolved(document: &Document, settings: &[Setting]) -> Arc<Rule> {
    let (model, warnings) = document
        .resolve(settings)
        .unwrap_or_else(|errors| panic!("{}", errors.render(false)));
    assert!(warnings.is_empty(), "{}", warnings.render(false));
    model.into_rule().unwrap()
}

/// Returns the graph of a rule, resolved for a number of steps.
pub(crate) fn compiled(rule: &Arc<Rule>, steps: u32) -> Graph {
    Graph::compile(rule, steps).unwrap()
}

/// A fractal of an approximant with all its elements.
pub(crate) struct Grown {
    pub(crate) fractal: FractalInfo,
    pub(crate) elements: Vec<Element>,
    /// Whether the last element is joined to the first.
    pub(crate) is_ring: bool,
}

#[derive(Default)]
struct Collector(Vec<Grown>);

impl Visitor for Collector {
    type Error = Infallible;

    fn begin(&mut self, fractal: FractalInfo) -> Result<(), Infallible> {
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

/// Returns an approximant by the walk, fractal by fractal.
pub(crate) fn grown(graph: &Graph, growth: &Growth<'_>) -> Vec<Grown> {
    let mut collector = Collector::default();
    walk(graph, growth, &mut collector).unwrap();
    collector.0
}

/// Numbers that look drawn, the same in every run.
pub(crate) struct Draws(pub(crate) u64);

impl Draws {
    /// Returns a number below a count.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap() % count
    }

    /// Returns a number from 0 to 1, in millionths.
    pub(crate) fn unit(&mut self) -> f64 {
        self.below(1_000_001) as f64 / 1_000_000.0
    }
}

/// Returns the files below a folder, with their bytes.
pub(crate) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.strip_prefix(folder).unwrap().display().to_string();
            found.insert(name, fs::read(&path).unwrap());
        }
    }
    found
}

/// Runs a command line in a folder; returns whether it succeeds, and its messages.
pub(crate) fn run(folder: &Path, line: &str) -> (bool, String) {
    let mut command = assert_cmd::Command::cargo_bin("kfrac").unwrap();
    let command = command.current_dir(folder).args(line.split(' '));
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    (output.status.success(), said)
}
