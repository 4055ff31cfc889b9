//! Exact dimensions against the boxes of limit sets.

use std::num::NonZero;

use kfrac::geometry::DAffine2;
use kfrac::measure::{BoxCounting, Grid, LimitSet};
use proptest::prelude::*;

use crate::common::document_of;

/// Grids on which boxes are counted.
const GRIDS: usize = 8;

proptest! {
    #![proptest_config(crate::common::cases(8))]

    /// Maps of one ratio with turns by right angles and integers as translations have exact overlaps, or none.
    #[test]
    fn boxes_have_the_exact_dimension(
        whole in 2..5u8,
        maps in prop::collection::btree_set((0..4u8, any::<bool>(), 0..3i8, 0..3i8), 2..6),
    ) {
        let mut text = String::from("kind: ifs\nmaps:\n");
        for (quarter, reflected, x, y) in maps {
            let (scale, turn) = (if reflected { -1 } else { 1 }, 90 * u16::from(quarter));
            text += &format!("  - {{scale: [1/{whole}, {scale}/{whole}], rotate: {turn}, shift: [{x}, {y}]}}\n");
        }
        let (model, _) = document_of(&text).resolve(&[]).unwrap();
        let graph = model.compile(3).unwrap();
        let exact = kfrac::measure::exact::dimensions_of_graph(&graph);
        let Some(exact) = exact.dimensions.and_then(|it| it.hausdorff.value) else {
            return Ok(());
        };
        let set = LimitSet::<DAffine2>::of(&graph).unwrap();
        let threads = NonZero::<usize>::MIN;
        let grids = Grid::spread(NonZero::new(GRIDS).unwrap());
        let counting = BoxCounting::of_limit(&set, None, &grids, threads);
        if let Some(estimate) = counting.estimate {
            let away = (estimate.value - exact).abs();
            prop_assert!(away <= (6.0 * estimate.std_error).max(0.02), "{} {:?}\n{}", exact, estimate, text);
        }
    }
}
