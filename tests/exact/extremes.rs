//! Systems whose ratios are near the ends of their range: exact dimensions that are right, and measurements that are right
//! or left out.

use std::num::NonZero;

use glam::{DAffine2, DMat2, DVec2};
use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::graph::Graph;
use kfrac::measure::{BoxCounting, Grid, LimitSet};

use super::{line, near, of};

/// Returns the graph of a system with given maps, or the messages with which it is refused.
fn graph(maps: &[&str]) -> Result<Graph, String> {
    let maps: String = maps.iter().map(|map| format!("  - {map}\n")).collect();
    let source = Source::new("test.yaml", format!("kind: ifs\nmaps:\n{maps}"));
    let document = Document::read(&source, &Catalogue::embedded()).map_err(|it| it.to_string())?;
    let (model, _) = document.resolve(&[]).map_err(|it| it.to_string())?;
    model.compile(0).map_err(|it| it.to_string())
}

/// Returns the measured dimension of a limit set; `None` if it has none, or if none is measured.
fn measured(graph: &Graph) -> Option<[f64; 2]> {
    let set = LimitSet::of(graph).ok()?;
    let grids = Grid::spread(NonZero::<usize>::MIN);
    let counting = BoxCounting::of_limit(&set, None, &grids, NonZero::<usize>::MIN);
    let estimate = counting.estimate?;
    Some([estimate.value, estimate.std_error])
}

#[test]
fn ratios_at_the_ends_of_their_range() {
    // Ratios of two maps of a line, and the solution of Σ r^D = 1 by bisection.
    for ([a, b], similarity, is_known) in [
        ([1e-300, 1e-300], 0.0010034333188799372, true),
        ([0.5, 1e-9], 0.12144025038624126, true),
        ([1e-9, 1e-9], 0.033447777295997905, true),
        ([0.999999, 0.999999], 693146.8339663652, false),
    ] {
        let found = of(&[line(a, 0.0), line(b, 1.0)]);
        let own = found.similarity.unwrap().value;
        assert!((own / similarity - 1.0).abs() < 1e-9, "{a}, {b}: {own}");
        assert_eq!(found.hausdorff.value.is_some(), is_known, "{a}, {b}");
        assert!(
            found
                .hausdorff
                .value
                .is_none_or(|value| near(value, similarity)),
            "{a}, {b}"
        );
    }
}

#[test]
fn sizes_span_a_generation() {
    for (maps, expected) in [
        (["{scale: 1/2}", "{scale: 1e-9, shift: [1, 0]}"], None),
        (["{scale: 1e-300}", "{scale: 1e-300, shift: [1, 0]}"], None),
        (
            ["{scale: 1/2}", "{scale: 1/100, shift: [1, 0]}"],
            Some(0.3393191293874512),
        ),
        // A segment.
        (
            [
                "{matrix: [[1/2, 0], [0, 0]]}",
                "{matrix: [[1/2, 0], [0, 0]], shift: [1/2, 0]}",
            ],
            Some(1.0),
        ),
        // Two points.
        (["{scale: 0}", "{scale: 0, shift: [1, 0]}"], None),
        // The first products that contract are those of fifteen maps, which are too many.
        (
            [
                "{matrix: [[1/2, 100], [0, 1/2]]}",
                "{matrix: [[1/2, 100], [0, 1/2]], shift: [1, 0]}",
            ],
            None,
        ),
    ] {
        let found = measured(&graph(&maps).unwrap());
        let Some(expected) = expected else {
            assert_eq!(found, None, "{maps:?}");
            continue;
        };
        let [value, error] = found.unwrap();
        assert!(
            (value - expected).abs() < 3.0 * error + 1e-3,
            "{maps:?}: {value} ± {error}"
        );
    }
}

#[test]
fn copies_that_enlarge_before_they_shrink_are_composed() {
    // A segment of the line y = 0.
    let shear = "[[1/2, 2], [0, 1/2]]";
    let maps = [
        format!("{{matrix: {shear}}}"),
        format!("{{matrix: {shear}, shift: [1, 0]}}"),
    ];
    let graph = graph(&[&maps[0], &maps[1]]).unwrap();
    let set = LimitSet::of(&graph).unwrap();
    let size = set.bounds().size() * graph.place().ratio();
    assert!((size - DVec2::new(2.0, 0.0)).length() < 1e-9, "{size}");
    let [value, error] = measured(&graph).unwrap();
    assert!(
        (value - 1.0).abs() < 3.0 * error + 1e-3,
        "{value} ± {error}"
    );
}

#[test]
fn maps_that_do_not_contract_have_no_limit_set() {
    for map in ["{scale: 2}", "{scale: 3}"] {
        let error = graph(&[map, "{scale: 1/2, shift: [1, 0]}"]).unwrap_err();
        assert!(error.contains("does not contract"), "{map}: {error}");
    }
    // On average, these systems contract.
    for map in [
        "{scale: 1}",
        "{scale: 1 - 1e-15}",
        "{matrix: [[1, 1], [0, 1]]}",
    ] {
        let graph = graph(&[map, "{scale: 1/2, shift: [1, 0]}"]).unwrap();
        assert!(LimitSet::of(&graph).is_err(), "{map}");
        assert_eq!(measured(&graph), None, "{map}");
    }
    // A matrix without an inverse is no similarity.
    let flat = DMat2::from_cols(DVec2::X / 2.0, DVec2::ZERO);
    let flat = DAffine2::from_mat2_translation(flat, DVec2::X);
    assert!(of(&[flat, line(0.5, 0.0)]).similarity.is_none());
}
