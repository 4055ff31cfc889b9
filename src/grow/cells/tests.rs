//! Tests of searches for cells.

use std::num::NonZero;
use std::sync::Arc;

use super::field::Field;
use super::{CellSearch, FoundCells, LimitCells};
use crate::catalogue::Catalogue;
use crate::diagnostic::Source;
use crate::document::Document;
use crate::geometry::{DMat2, DVec2};

/// Finds the cells of a limit set, `scale` cells per unit of length.
fn cells_of(source: &Arc<Source>, scale: f64) -> FoundCells {
    let document = Document::read(source, &Catalogue::embedded()).unwrap();
    let graph = document.resolve(&[]).unwrap().0.compile(30).unwrap();
    let parts = graph.initiator(0).instances.iter();
    let layer = parts.map(|it| (*it.frame.map(), it.object)).collect();
    let search = CellSearch {
        scale,
        max_images: 100_000_000,
        threads: NonZero::<usize>::MIN,
        cancel: None,
    };
    let found = LimitCells::new(&graph, &[layer]).find_all(&search, false);
    found.unwrap_or_else(|stopped| panic!("{stopped:?}"))
}

/// Each branch of the tree is part of the tree in one way only, so that points of the tree lead to points of
/// the tree without cells of branches in between.
#[test]
fn sets_between_are_left_out() {
    let source = Catalogue::embedded().rule("ternary-tree").unwrap();
    let FoundCells { fields, images, .. } = cells_of(&source, 10.0);
    let layer = fields.last().unwrap();
    let cells = layer.count_without(&Field::new(layer.scale())) as u64;
    // Three images for the branches and one for the picture; with cells of branches there were seven.
    assert!(cells > 5_000 && images < 5 * cells, "{images} of {cells}");
}

/// A map that hardly contracts moves points by less than a cell, or in rounds through the same cells. Its
/// orbits lead to its fixed point all the same.
#[test]
fn maps_that_hardly_contract_are_followed_to_their_fixed_points() {
    const SCALE: f64 = 100.0;
    let slow: [(f64, f64); 6] = [
        (0.99, 0.0),
        (0.9995, 0.0),
        (0.9999, 0.0),
        (0.999, 1.0),
        (0.9999, 30.0),
        (0.9999, 137.5),
    ];
    for (ratio, degrees) in slow {
        let text = format!(
            "kind: ifs\nmaps:\n  - {{scale: {ratio}, rotate: {degrees}}}\n  \
             - {{scale: 1/8, translate: [7/8, 0]}}\n"
        );
        let found = cells_of(&Source::new("slow.yaml", text), SCALE);
        let limit = found.fields.last().unwrap();
        let turn = DMat2::from_angle(degrees.to_radians());
        let mut point = DVec2::X;
        while point.length() * SCALE > 2.0 {
            let mut near =
                (0..9).map(|at| DVec2::new(f64::from(at % 3 - 1), f64::from(at / 3 - 1)));
            let is_met = near.any(|way| limit.holds(point + way / SCALE));
            assert!(is_met, "{ratio}, {degrees} degrees: {point}");
            point = turn * point * ratio;
        }
    }
}
