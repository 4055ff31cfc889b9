//! Boxes of sets in space.

use kfrac::geometry::DAffine3;
use kfrac::measure::{BoxCounting, Cascade, Generalised, Grid, LimitSet, Masses, Scale};

use super::{assert_is, common, number};

fn text(text: &str) -> LimitSet<DAffine3> {
    let (model, _) = common::document_of(text).resolve(&[]).unwrap();
    LimitSet::of(&model.compile_in_space(false).unwrap()).unwrap()
}

fn named(name: &str) -> LimitSet<DAffine3> {
    let (model, _) = common::document(name).resolve(&[]).unwrap();
    LimitSet::of(&model.compile_in_space(false).unwrap()).unwrap()
}

/// Returns the counts of cubes with sides of the extent divided by powers of a base.
fn counts(set: &LimitSet<DAffine3>, base: usize) -> Vec<u64> {
    let scales = set.sampled_scales(number(base), &[Grid::ALONG], number(1));
    assert!(scales.iter().all(|scale| !scale.sampled));
    scales.iter().map(|scale| scale.count).collect()
}

#[test]
fn cubes_of_a_sponge_are_counted_exactly() {
    let sponge = counts(&named("menger"), 3);
    let powers: Vec<u64> = (1..=12).map(|level| 20u64.pow(level)).collect();
    assert_eq!(sponge, powers);
    let cube = counts(&named("solid-cube"), 2);
    let powers: Vec<u64> = (1..20).map(|level| 8u64.pow(level)).collect();
    assert_eq!(cube[..19], powers);
}

/// Counts by states agree with covers, whose boxes are marked one by one.
#[test]
fn counts_by_states_are_those_of_covers() {
    for name in ["octahedron-flake", "sierpinski-tetrahedron"] {
        let set = named(name);
        let by_states = counts(&set, 2);
        let covers: Vec<Scale> = set.scales(2.0, 300, &[Grid::ALONG], number(1));
        assert!(covers.len() > 3);
        for (cover, count) in covers.iter().zip(by_states) {
            assert_eq!(cover.count, count, "{name} {}", cover.size);
        }
    }
}

/// A flat carpet in a common side of cubes is covered once, and a segment too.
#[test]
fn flat_sets_are_covered_once() {
    let square = "kind: ifs\nspace: 3\nvertices: {points: [[0, 0, 5], [1, 0, 5], [1, 1, 5], [0, 1, 5]], shrink: 1/2}\n";
    let expected: Vec<u64> = (1..=10).map(|level| 4u64.pow(level)).collect();
    assert_eq!(counts(&text(square), 2)[..10], expected);
    let segment = "kind: ifs\nspace: 3\nvertices: {points: [[0, 0, 0], [3, 3, 3]], shrink: 1/2}\n";
    let expected: Vec<u64> = (1..=10).map(|level| 2u64.pow(level)).collect();
    assert_eq!(counts(&text(segment), 2)[..10], expected);
}

/// A recurrent system: eight halves of a cube, none of which follows itself.
#[test]
fn recurrent_sets_have_the_cubes_of_their_graph() {
    let mut sign = "kind: ifs\nspace: 3\nmaps:\n".to_owned();
    for corner in 0..8 {
        let at = [0, 1, 2].map(|axis| if corner >> axis & 1 == 1 { 0.5 } else { -0.5 });
        sign += &format!("  - {{scale: 1/2, translate: {at:?}}}\n");
    }
    sign += "edges:\n";
    for corner in 1..=8 {
        let others: Vec<usize> = (1..=8).filter(|other| *other != corner).collect();
        sign += &format!("  {corner}: {others:?}\n");
    }
    let set = text(&sign);
    assert!((set.bounds().size().x - 2.0).abs() < 1e-9);
    let own: Vec<u64> = (0..8).map(|level| 8 * 7u64.pow(level)).collect();
    assert_eq!(counts(&set, 2)[..8], own);
}

#[test]
fn turned_sets_are_measured_from_samples() {
    let turned = "kind: ifs\nspace: 3\nmaps:\n  - {scale: 0.5, rotate: {axis: [1, 2, 3], angle: 40}}\n  \
                  - {scale: 0.5, translate: [1, 0, 0]}\n  - {scale: 0.5, translate: [0, 1, 0]}\n";
    let set = text(turned);
    let estimate = BoxCounting::of_limit(&set, None, &Grid::spread(number(3)), number(2)).estimate;
    let estimate = estimate.unwrap();
    let dimension = 3f64.ln() / 2f64.ln();
    assert!(
        (estimate.value - dimension).abs() < 3.0 * estimate.std_error + 0.02,
        "{estimate:?}"
    );
}

#[test]
fn spectra_and_lacunarity_in_space() {
    let (model, _) = common::document("sierpinski-tetrahedron")
        .resolve(&[])
        .unwrap();
    let graph = model.compile_in_space(false).unwrap();
    let measure = Cascade::natural(&graph).unwrap();
    for it in Generalised::of_measure(&measure, &[0.0, 2.0], None, number(1), number(2)) {
        assert_is(&it.estimate.unwrap(), 2.0, 0.02);
    }
    let masses = Masses::of_limit(measure.set(), &Grid::ALONG, 32).unwrap();
    let lacunarity = masses.lacunarity();
    // 4^5 of 32³ boxes are met: ⟨m²⟩ / ⟨m⟩² is 2^5 for single boxes, and 1 for the whole.
    assert!((lacunarity[0].value - 32.0).abs() < 1e-9, "{lacunarity:?}");
    assert!((lacunarity[5].value - 1.0).abs() < 1e-9, "{lacunarity:?}");
}
