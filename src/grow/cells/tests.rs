//! Tests of searches for cells.

use std::num::NonZero;

use super::field::Field;
use super::{CellSearch, FoundCells, LimitCells};
use crate::catalogue::Catalogue;
use crate::document::Document;

/// Each branch of the tree is part of the tree in one way only, so that points of the tree lead to points of
/// the tree without cells of branches in between.
#[test]
fn sets_between_are_left_out() {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule("ternary-tree").unwrap();
    let document = Document::read(&source, &catalogue).unwrap();
    let graph = document.resolve(&[]).unwrap().0.compile(30).unwrap();
    let parts = graph.initiator(0).instances.iter();
    let layer = parts.map(|it| (*it.frame.map(), it.object)).collect();
    let set = LimitCells::new(&graph, &[layer]);
    let search = CellSearch {
        scale: 10.0,
        max_images: u64::MAX,
        threads: NonZero::<usize>::MIN,
        cancel: None,
    };
    let Ok(FoundCells { fields, images, .. }) = set.find_all(&search, false) else {
        panic!("stopped");
    };
    let layer = fields.last().unwrap();
    let cells = layer.count_without(&Field::new(layer.scale())) as u64;
    // Three images for the branches and one for the picture; with cells of branches there were seven.
    assert!(cells > 5_000 && images < 5 * cells, "{images} of {cells}");
}
