//! The rules in the two README files are read, resolved without a warning, compiled and grown.
//!
//! A block that begins with ```` ```yaml ```` alone is a whole rule, and one that begins with ```` ```yaml dataset ```` a
//! data set. One that begins with ```` ```yaml fragment ```` is a part of one and is skipped.

use std::convert::Infallible;

use kfrac::catalogue::Catalogue;
use kfrac::dataset::Dataset;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::geometry::Frame;
use kfrac::graph::Graph;
use kfrac::grow::{Element, FractalInfo, Growth, Visitor, walk};

/// Returns the blocks that are whole rules, named by file and line.
fn rules(file: &str, text: &str) -> Vec<(String, String)> {
    let mut rules = Vec::new();
    let mut lines = text.lines().zip(1..);
    while let Some((line, number)) = lines.next() {
        let Some(info) = line.strip_prefix("```") else {
            continue;
        };
        let block: Vec<_> = lines
            .by_ref()
            .map(|(line, _)| line)
            .take_while(|line| *line != "```")
            .collect();
        match info.trim() {
            "yaml" => rules.push((format!("{file}:{number}"), block.join("\n") + "\n")),
            "yaml dataset" => {
                let set = Dataset::parse(&block.join("\n"));
                set.unwrap_or_else(|error| panic!("{file}:{number}: {error}"));
            }
            "yaml fragment" | "text" | "rust" | "sh" | "python" => {}
            other => panic!("{file}:{number}: blocks of '{other}' are not known to this test"),
        }
    }
    rules
}

/// A visitor that counts visible elements.
struct Visible<'g, F: Frame> {
    graph: &'g Graph<F>,
    count: usize,
}

impl<F: Frame> Visitor<F> for Visible<'_, F> {
    type Error = Infallible;

    fn begin(&mut self, _: FractalInfo) -> Result<(), Infallible> {
        Ok(())
    }

    fn element(&mut self, element: &Element<F>) -> Result<(), Infallible> {
        self.count += usize::from(self.graph.objects()[element.object].visible);
        Ok(())
    }

    fn end(&mut self, _: bool) -> Result<(), Infallible> {
        Ok(())
    }
}

/// Returns the number of visible elements after two steps.
fn visible<F: Frame>(graph: &Graph<F>) -> usize {
    let mut visible = Visible { graph, count: 0 };
    walk(graph, &Growth::steps(2), &mut visible).unwrap();
    visible.count
}

fn check(file: &str, text: &str) -> usize {
    let catalogue = Catalogue::embedded();
    let rules = rules(file, text);
    for (name, text) in &rules {
        let source = Source::new(name.as_str(), text.as_str());
        let document = Document::read(&source, &catalogue)
            .unwrap_or_else(|diagnostics| panic!("{name}: {diagnostics:#?}"));
        let (model, warnings) = document
            .resolve(&[])
            .unwrap_or_else(|diagnostics| panic!("{name}: {diagnostics:#?}"));
        assert!(warnings.is_empty(), "{name}: {warnings:#?}");
        let count = match model.graph_in_space(2) {
            Some(graph) => visible(&graph.unwrap()),
            None => visible(&model.compile(2).unwrap()),
        };
        assert!(count > 0, "{name}: nothing is to be seen at step 2");
    }
    rules.len()
}

#[test]
fn the_rules_of_the_reference_grow() {
    let rules = check("library/README.md", include_str!("../library/README.md"));
    assert!(rules >= 10, "only {rules} whole rules were found");
}

#[test]
fn the_rule_of_the_front_page_grows() {
    assert!(check("README.md", include_str!("../README.md")) >= 1);
}
