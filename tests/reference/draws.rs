//! Rules with random functions: the reference fixes the facts that do not depend on draws.

use kfrac::Count;
use kfrac::document::Setting;
use kfrac::grow::Growth;

use super::common::{compiled, document, grown, resolved};
use super::data::reference;
use super::{compare, elements};

#[test]
fn the_random_tree_has_the_counts_of_the_reference_whatever_is_drawn() {
    let reference = reference();
    let entry = reference
        .rules
        .iter()
        .find(|entry| entry.id == "kaandorp_fig4_random_tree")
        .unwrap();
    let graph = entry.graph(8);
    let mut forecast = graph.forecast().unwrap();
    for n in 0..=8 {
        let count = 3 * 2u64.pow(n) - 2;
        assert_eq!(forecast.elements(), Count::from(count));
        for seed in 0..4 {
            let fractals = grown(&graph, &Growth::steps(n).seed(seed));
            let fertile = elements(&fractals)
                .filter(|element| element.fertile)
                .count() as u64;
            assert_eq!(
                [elements(&fractals).count() as u64, fertile],
                [count, 2u64.pow(n)],
                "seed {seed}"
            );
            if let Some(step) = entry.per_step.iter().find(|step| step.n == n) {
                assert_eq!([step.elements, step.fertile], [count, fertile]);
            }
        }
        forecast.advance();
    }
}

#[test]
fn a_random_tree_that_does_not_sway_is_the_simple_tree() {
    let reference = reference();
    let entry = reference
        .rules
        .iter()
        .find(|entry| entry.id == "kaandorp_fig4_random_tree")
        .unwrap();
    let still = ["sway", "spread"].map(|name| Setting {
        name: name.into(),
        value: 0.0,
        written: None,
        place: None,
    });
    let graph = compiled(&resolved(&document("random-tree"), &still), 4);
    for n in 0..=4 {
        compare(entry, n, &grown(&graph, &Growth::steps(n)));
    }
}

#[test]
fn vegetation_has_the_counts_of_the_reference() {
    let reference = reference();
    let entry = reference
        .rules
        .iter()
        .find(|entry| entry.id == "kaandorp_fig6_vegetation")
        .unwrap();
    let counts = entry.counts.as_ref().unwrap();
    let graph = entry.graph(8);
    let mut forecast = graph.forecast().unwrap();
    assert_eq!(counts.fertile.len(), 9);
    for n in 0..=8u32 {
        let at = n as usize;
        let fertile = counts.fertile[at];
        let expected = [fertile + counts.infertile[at], fertile, counts.fractals[at]];
        let level = forecast.level();
        assert_eq!(
            [level.elements, level.fertile, level.fractals],
            expected.map(Count::from),
            "{n}"
        );
        for seed in 0..2 {
            let fractals = grown(&graph, &Growth::steps(n).seed(seed));
            let fertile = elements(&fractals)
                .filter(|element| element.fertile)
                .count() as u64;
            let count = elements(&fractals).count() as u64;
            assert_eq!(
                [count, fertile, fractals.len() as u64],
                expected,
                "{n}, seed {seed}"
            );
        }
        forecast.advance();
    }
}
