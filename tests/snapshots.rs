//! Snapshots of a few pictures, byte by byte: every change is to be reviewed.

use crate::common::{compiled, document, resolved};
use kfrac::grow::Growth;
use kfrac::render::{self, Labels, Options, Size};

/// Returns the SVG of a rule of the library at a size of 256 pixels.
fn picture(name: &str, steps: u32) -> String {
    let document = document(name);
    let rule = resolved(&document, &[]);
    let labels = Labels {
        title: rule.description().title.clone().unwrap(),
        description: rule.description().about.clone().unwrap(),
        provenance: document.to_yaml(),
    };
    let options = Options::of(rule.metadata())
        .size(Size::Long(256))
        .labels(labels);
    let graph = compiled(&rule, steps);
    let mut bytes = Vec::new();
    render::write(&graph, &Growth::steps(steps), &options, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

#[test]
fn the_koch_curve_is_one_line() {
    insta::assert_snapshot!("koch", picture("koch", 3));
}

#[test]
fn the_dragon_changes_its_colour_along_the_way() {
    insta::assert_snapshot!("dragon", picture("dragon", 6));
}

#[test]
fn the_monkeys_tree_is_one_line() {
    insta::assert_snapshot!("monkeys-tree", picture("monkeys-tree", 2));
}
