//! Exact dimensions against the boxes of limit sets.

use std::cell::Cell;
use std::num::NonZero;

use kfrac::geometry::DAffine2;
use kfrac::measure::exact::dimensions_of_graph;
use kfrac::measure::{BoxCounting, Grid, LimitSet};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;

use crate::common::document_of;

/// Maps of one ratio with turns by right angles and integers as translations have exact overlaps, or none.
fn files() -> impl Strategy<Value = String> {
    let map = (0..4u16, any::<bool>(), 0..3i8, 0..3i8);
    let maps = prop::collection::btree_set(map, 2..6);
    (2..5u8, maps).prop_map(|(whole, maps)| {
        let mut text = String::from("kind: ifs\nmaps:\n");
        for (quarter, reflected, x, y) in maps {
            let (across, turn) = (if reflected { -1 } else { 1 }, 90 * quarter);
            text += &format!(
                "  - {{scale: [1/{whole}, {across}/{whole}], rotate: {turn}, shift: [{x}, {y}]}}\n"
            );
        }
        text
    })
}

/// Asserts that the boxes of a set have its exact dimension; returns whether both are known.
fn agree(text: &str) -> bool {
    let (model, _) = document_of(text).resolve(&[]).unwrap();
    let graph = model.compile(3).unwrap();
    let exact = dimensions_of_graph(&graph).dimensions;
    let Some(exact) = exact.and_then(|it| it.hausdorff.value) else {
        return false;
    };
    let set = LimitSet::<DAffine2>::of(&graph).unwrap();
    let grids = Grid::spread(NonZero::new(8).unwrap());
    let counting = BoxCounting::of_limit(&set, None, &grids, NonZero::<usize>::MIN);
    let Some(estimate) = counting.estimate else {
        return false;
    };
    let away = (estimate.value - exact).abs();
    assert!(
        away <= (6.0 * estimate.std_error).max(0.02),
        "{exact} {estimate:?}\n{text}"
    );
    true
}

#[test]
fn boxes_have_the_exact_dimension() {
    let config = crate::common::cases(8);
    let cases = config.cases;
    let known = Cell::new(0);
    let run = TestRunner::new(config).run(&files(), |text| {
        known.set(known.get() + u32::from(agree(&text)));
        Ok(())
    });
    run.unwrap_or_else(|error| panic!("{error}"));
    assert!(2 * known.get() >= cases, "{} of {cases}", known.get());
}
