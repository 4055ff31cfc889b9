//! Contraction of systems, against known joint spectral radii and against all products of a length.

use kfrac::geometry::{DAffine2, DMat2, DVec2};
use kfrac::ifs::{Contraction, Ifs, Map, Verdict};
use proptest::prelude::*;

use super::{definition, digraph, edges, map, matrix, recurrent, system};

fn linear(matrices: &[DMat2]) -> Vec<Map> {
    let maps = matrices
        .iter()
        .map(|&matrix| DAffine2::from_mat2_translation(matrix, DVec2::ONE));
    maps.map(Map::new).collect()
}

/// Returns the contraction of matrices, given by rows.
fn of(rows: &[[f64; 4]]) -> Contraction {
    let matrices = rows
        .iter()
        .map(|&[a, b, c, d]| DMat2::from_cols_array(&[a, c, b, d]));
    system(linear(&matrices.collect::<Vec<_>>())).contraction()
}

#[track_caller]
fn assert_radius(contraction: &Contraction, verdict: Verdict, radius: f64, word: &[usize]) {
    assert_eq!(contraction.verdict, verdict, "{contraction:?}");
    assert!(
        (contraction.lower - radius).abs() <= 1e-14 * radius,
        "{contraction:?}"
    );
    assert!(contraction.upper <= radius * 1.0011, "{contraction:?}");
    assert_eq!(contraction.word, word, "{contraction:?}");
}

#[test]
fn maps_that_are_no_contractions_may_contract() {
    assert_radius(&of(&[[0.5, 10.0, 0.0, 0.5]]), Verdict::Contracts, 0.5, &[0]);
    assert_radius(&of(&[[0.0, 4.0, 0.01, 0.0]]), Verdict::Contracts, 0.2, &[0]);
    // Skewed copies of the gasket's maps, whose best coordinates are far from the given ones.
    let skewed = [[0.5, 0.0, 0.0, 0.5], [1.5, -1.0, 1.0, -0.5]];
    assert_radius(&of(&skewed), Verdict::Contracts, 0.5, &[0]);
}

/// Small eigenvalues are not sufficient (Demko, Hodges & Naylor's condition), nor is a small determinant
/// (Jones & Campa's).
#[test]
fn the_shortest_product_that_diverges_is_named() {
    let nilpotent = [[0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0]];
    assert_radius(&of(&nilpotent), Verdict::Diverges, 2.0, &[0, 1]);
    let flat = [[0.5, 0.0, 0.0, 0.5], [2.0, 0.0, 0.0, 0.25]];
    assert_radius(&of(&flat), Verdict::Diverges, 2.0, &[1]);
    // A rotation, a shear and a translation do not shrink.
    let turn = (1.0f64.cos(), 1.0f64.sin());
    for map in [
        [turn.0, -turn.1, turn.1, turn.0],
        [1.0, 1.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, 1.0],
    ] {
        assert_radius(&of(&[map]), Verdict::Diverges, 1.0, &[0]);
    }
}

/// Alternating shears upwards and to the right grow fastest, by the golden ratio a step.
#[test]
fn products_decide_where_maps_do_not() {
    let golden = f64::midpoint(1.0, 5f64.sqrt());
    for (factor, verdict) in [(0.6, Verdict::Contracts), (0.62, Verdict::Diverges)] {
        let shears = [[factor, factor, 0.0, factor], [factor, 0.0, factor, factor]];
        let found = of(&shears);
        assert_eq!(found.verdict, verdict);
        assert!((found.lower - factor * golden).abs() < 1e-14, "{found:?}");
        assert_eq!(found.word, [0, 1]);
        assert!(found.upper < 1.001 * factor * golden || verdict == Verdict::Diverges);
    }
}

#[test]
fn a_digraph_forbids_products() {
    let maps = [
        map(2.0, 0.0, 0.0, 2.0, [0.0, 0.0]),
        map(0.0, -0.25, 0.25, 0.0, [1.0, 0.0]),
    ];
    assert_radius(
        &system(maps.to_vec()).contraction(),
        Verdict::Diverges,
        2.0,
        &[0],
    );
    let turns = recurrent(maps.to_vec(), &[(0, 1), (1, 0), (1, 1)]);
    assert_radius(
        &turns.contraction(),
        Verdict::Contracts,
        0.5f64.sqrt(),
        &[0, 1],
    );
    let rows = (0..7).map(|row| map(0.5, 0.0, 0.0, 0.4 + 0.01 * f64::from(row), [0.0, 0.0]));
    let cycle: Vec<(usize, usize)> = (0..7).map(|from| (from, (from + 1) % 7)).collect();
    let round = recurrent(rows.collect(), &cycle).contraction();
    assert_radius(&round, Verdict::Contracts, 0.5, &[0, 1, 2, 3, 4, 5, 6]);
}

/// The unit disc of the best norm for these matrices is a square, so ellipses leave a gap of √2, which only
/// long products close.
#[test]
fn what_is_undecided_says_so() {
    let rows = [
        [1.0, 1.0, 0.0, 0.0],
        [1.0, -1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 1.0],
        [0.0, 0.0, 1.0, -1.0],
    ];
    let matrices = rows.map(|[a, b, c, d]| 0.9 * DMat2::from_cols_array(&[a, c, b, d]));
    let system = system(linear(&matrices));
    for (products, length) in [(0, 1), (19, 1), (20, 2), (83, 2), (84, 3)] {
        let found = system.contraction_within(products);
        assert_eq!(
            (found.verdict, found.length),
            (Verdict::Undecided, length),
            "{products}"
        );
        assert!((found.lower - 0.9).abs() < 1e-15, "{found:?}");
        let expected = 0.9 * 2f64.powf(0.5 / f64::from(length));
        assert!((found.upper - expected).abs() < 1e-8, "{found:?}");
    }
    assert_eq!(system.contraction_within(400).verdict, Verdict::Contracts);
}

#[test]
fn what_is_nilpotent_contracts_to_points() {
    let found = of(&[[0.0, 1.0, 0.0, 0.0]]);
    assert_eq!((found.verdict, found.lower), (Verdict::Contracts, 0.0));
    assert!(found.word.is_empty());
    let zero = of(&[[0.0; 4]]);
    assert_eq!((zero.verdict, zero.upper), (Verdict::Contracts, 0.0));
}

#[test]
fn numbers_at_the_ends_of_the_range_do_no_harm() {
    assert_ne!(of(&[[0.5, 1e308, 0.0, 0.5]]).verdict, Verdict::Diverges);
    assert_eq!(
        of(&[[1e308, 1e308, 1e308, 1e308]]).verdict,
        Verdict::Diverges
    );
    assert_eq!(
        of(&[[0.0, f64::MIN_POSITIVE, 1e-320, 0.0]]).verdict,
        Verdict::Contracts
    );
}

/// Returns all admitted words of a length, with their products.
fn words(
    matrices: &[DMat2],
    pairs: Option<&[(usize, usize)]>,
    length: usize,
) -> Vec<(Vec<usize>, DMat2)> {
    let mut words: Vec<(Vec<usize>, DMat2)> = vec![(Vec::new(), DMat2::IDENTITY)];
    for _ in 0..length {
        let mut longer = Vec::new();
        for (word, product) in &words {
            for (map, &matrix) in matrices.iter().enumerate() {
                if word.last().is_none_or(|&last| admits(pairs, last, map)) {
                    longer.push(([&word[..], &[map]].concat(), matrix * *product));
                }
            }
        }
        words = longer;
    }
    words
}

fn admits(pairs: Option<&[(usize, usize)]>, from: usize, to: usize) -> bool {
    pairs.is_none_or(|pairs| pairs.contains(&(from, to)))
}

fn eigenvalue(matrix: DMat2) -> f64 {
    let (trace, determinant) = (matrix.x_axis.x + matrix.y_axis.y, matrix.determinant());
    let square = trace * trace / 4.0 - determinant;
    if square < 0.0 {
        determinant.sqrt()
    } else {
        trace.abs() / 2.0 + square.sqrt()
    }
}

/// Returns the Frobenius norm, an upper bound of the largest singular value.
fn norm(matrix: DMat2) -> f64 {
    (matrix.x_axis.length_squared() + matrix.y_axis.length_squared()).sqrt()
}

proptest! {
    #![proptest_config(crate::common::cases(64))]

    #[test]
    fn bounds_hold_for_all_words(
        matrices in prop::collection::vec(matrix(1.0), 1..4),
        more in digraph(3),
        free in any::<bool>(),
    ) {
        let count = matrices.len();
        let pairs = (!free).then(|| {
            let mut pairs: Vec<_> = more.iter().map(|&(a, b)| (a % count, b % count)).collect();
            pairs.sort_unstable();
            pairs.dedup();
            pairs
        });
        let system = Ifs::new(kfrac::ifs::Definition {
            edges: pairs.as_deref().and_then(edges),
            ..definition(linear(&matrices))
        }).unwrap();
        let found = system.contraction_within(20_000);
        prop_assert!(found.lower <= found.upper);
        let pairs = pairs.as_deref();
        for length in 1..7 {
            let exponent = 1.0 / f64::from(u32::try_from(length).unwrap());
            let words = words(&matrices, pairs, length);
            let largest = words.iter().map(|(_, product)| norm(*product)).fold(0.0, f64::max);
            prop_assert!(found.lower <= largest.powf(exponent) * (1.0 + 1e-9));
            for (word, product) in words {
                if admits(pairs, word[length - 1], word[0]) {
                    let radius = eigenvalue(product);
                    prop_assert!(radius.powf(exponent) <= found.upper * (1.0 + 1e-6));
                    let shorter = found.verdict == Verdict::Diverges && length < found.word.len();
                    prop_assert!(!(shorter && radius > 1.0 + 1e-9), "{word:?} {found:?}");
                }
            }
        }
        match found.verdict {
            Verdict::Contracts => prop_assert!(found.upper < 1.0),
            Verdict::Diverges => {
                let product = system.composition(&found.word).matrix2;
                prop_assert!(eigenvalue(product) > 1.0 - 1e-9);
                let cycle = found.word.iter().zip(found.word.iter().cycle().skip(1));
                for (&from, &to) in cycle {
                    prop_assert!(admits(pairs, from, to));
                }
            }
            Verdict::Undecided => prop_assert!(found.lower < 1.0 && found.upper >= 1.0 - 1e-12),
        }
    }

    #[test]
    fn coordinates_do_not_matter(
        matrices in prop::collection::vec(matrix(0.8), 1..4),
        coordinates in matrix(1.0).prop_filter("singular", |m| m.determinant().abs() > 0.1),
    ) {
        let given = system(linear(&matrices)).contraction();
        let turned: Vec<DMat2> = matrices.iter().map(|&m| coordinates * m * coordinates.inverse()).collect();
        let other = system(linear(&turned)).contraction();
        prop_assert!(given.lower <= other.upper * (1.0 + 1e-9));
        prop_assert!(other.lower <= given.upper * (1.0 + 1e-9));
    }
}
