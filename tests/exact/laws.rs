//! Laws of exact dimensions for arbitrary systems.

use std::collections::BTreeSet;

use kfrac::geometry::{DAffine2, DVec2};
use kfrac::measure::exact::Overlap;
use proptest::prelude::*;

use super::{line, near, of, similarity};

/// Returns the numbers of distinct sums Σ d_k 3^k with n digits, for n = 0, 1, ….
fn distinct_sums(digits: &BTreeSet<i64>, generations: usize) -> Vec<usize> {
    let mut sums = BTreeSet::from([0]);
    let mut counts = vec![1];
    for _ in 0..generations {
        sums = sums
            .iter()
            .flat_map(|sum| digits.iter().map(move |digit| 3 * sum + digit))
            .collect();
        counts.push(sums.len());
    }
    counts
}

proptest! {
    #![proptest_config(crate::common::cases(40))]

    /// Pieces of (x + d)/3 with integers d lie on a lattice, where distinct ones can be counted.
    #[test]
    fn exact_overlaps_are_counted(digits in prop::collection::btree_set(0i64..8, 2..5)) {
        let third = 1.0 / 3.0;
        #[allow(clippy::cast_precision_loss, reason = "digits")]
        let maps: Vec<DAffine2> = digits.iter().map(|&d| line(third, d as f64 * third)).collect();
        let found = of(&maps).hausdorff;
        let counts = distinct_sums(&digits, 9);
        let all = counts.iter().enumerate().all(|(n, count)| {
            *count == digits.len().pow(u32::try_from(n).unwrap())
        });
        prop_assert_eq!(found.overlap != Overlap::Exact, all, "{:?} {:?}", digits, counts);
        #[allow(clippy::cast_precision_loss, reason = "counts")]
        let growth = counts[9] as f64 / counts[8] as f64;
        let expected = 3f64.powf(found.value.unwrap());
        prop_assert!((growth / expected - 1.0).abs() < 0.03, "{:?} {} {}", digits, growth, expected);
    }

    /// Dimensions are invariant under similarities of the set and permutations of the maps.
    #[test]
    fn similar_sets_have_equal_dimensions(
        turn in -180.0..180.0f64,
        scale in 0.01..100.0f64,
        reflected: bool,
        shift in prop::array::uniform2(-50.0..50.0f64),
        which in 0usize..4,
    ) {
        let half = 0.5f64.sqrt();
        let third = 1.0 / 3.0;
        let maps = match which {
            0 => vec![similarity(half, 45.0, false, [0.0, 0.0]), similarity(half, 135.0, false, [1.0, 0.0])],
            1 => vec![similarity(half, 45.0, false, [0.0, 0.0]), similarity(half, -45.0, false, [0.5, 0.5])],
            // With exact overlaps.
            2 => [0.0, 1.0, 3.0].map(|d| line(third, d)).to_vec(),
            _ => vec![
                line(third, 0.0),
                line(third, 2.0 * third),
                similarity(third.sqrt(), 30.0, true, [0.0, 0.0]),
            ],
        };
        let change = similarity(scale, turn, reflected, shift);
        let changed: Vec<DAffine2> =
            maps.iter().rev().map(|map| change * *map * change.inverse()).collect();
        let (before, after) = (of(&maps), of(&changed));
        prop_assert_eq!(before.hausdorff.overlap, after.hausdorff.overlap);
        prop_assert_eq!(before.hausdorff.value.is_some(), after.hausdorff.value.is_some());
        if let (Some(a), Some(b)) = (before.hausdorff.value, after.hausdorff.value) {
            prop_assert!(near(a, b), "{} {}", a, b);
        }
        let boundaries = [before.boundary, after.boundary].map(|boundary| boundary.and_then(|found| found.value));
        prop_assert_eq!(boundaries[0].is_some(), boundaries[1].is_some());
        if let [Some(a), Some(b)] = boundaries {
            prop_assert!(near(a, b), "{} {}", a, b);
        }
    }

}

proptest! {
    #![proptest_config(crate::common::cases(12))]

    /// The computation neither panics nor runs forever for any maps, and its bounds hold.
    #[test]
    fn whatever_the_maps_are(
        maps in prop::collection::vec((0.05..0.95f64, -180.0..180.0f64, any::<bool>(), -2.0..2.0f64, -2.0..2.0f64), 1..5),
    ) {
        let maps: Vec<DAffine2> = maps
            .into_iter()
            .map(|(ratio, turn, reflected, x, y)| similarity(ratio, turn, reflected, DVec2::new(x, y).into()))
            .collect();
        let found = of(&maps);
        let bound = found.hausdorff.upper_bound.unwrap();
        prop_assert!(bound <= 2.0 && bound <= found.similarity.unwrap().value + 1e-12);
        if let Some(value) = found.hausdorff.value {
            prop_assert!(value <= 2.0 + 1e-12 && value <= bound);
        }
    }
}
