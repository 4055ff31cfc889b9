use std::num::NonZero;

use super::field::Field;
use super::{Found, LimitCells, Search};
use crate::catalogue::Catalogue;
use crate::document::Document;

/// The branches of the tree are the tree again, in one way each: points of it lead to points of it, with
/// no cells of branches between.
#[test]
fn sets_between_are_left_out() {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule("ternary-tree").unwrap();
    let document = Document::read(&source, &catalogue).unwrap();
    let graph = document.resolve(&[]).unwrap().0.compile(30).unwrap();
    let parts = graph.initiator(0).instances.iter();
    let layer = parts.map(|it| (it.frame.map, it.object)).collect();
    let set = LimitCells::new(&graph, &[layer]);
    let search = Search {
        scale: 10.0,
        most_images: u64::MAX,
        threads: NonZero::<usize>::MIN,
        cancel: None,
    };
    let Ok(Found { fields, images, .. }) = set.find_all(&search, false) else {
        panic!("stopped");
    };
    let layer = fields.last().unwrap();
    let cells = layer.count_without(&Field::new(layer.scale())) as u64;
    // Three branches and the picture for each, which were seven images with those of the branches.
    assert!(cells > 5_000 && images < 5 * cells, "{images} of {cells}");
}
