//! Objects of structures that are one of several unions, drawn at random for every instance.

use std::collections::BTreeSet;

use kfrac::geometry::{DAffine2, DVec3};
use kfrac::graph::Graph;
use kfrac::grow::{Elements, Growth};
use kfrac::instancing::{Instancing, Master, ObjectInstance};
use kfrac::measure::exact::dimensions_of_graph;

use crate::common::{document, document_of, run, structure};

const STEM: &str = "kind: instancing
objects:
  A:
    at_random:
      - {weight: 3, union: [wood, {object: A, scale: 0.8, rotate: 20, translate: [0, 1]}]}
      - weight: 2
        scale: 0.7
        translate: [0, 1]
        union: [{object: A, rotate: 40}, wood, {object: A, rotate: -30, scale: [1, 0.5]}]
      - [{disk: {radius: 1/2}}]
      - {weight: 0.5, union: []}
    rotate: 3
  wood: [{segment: [[0, 0], [0, 1]]}]
scene: [A, {object: A, rotate: 180}, {object: A, rotate: 90}]
";

/// Element as drawn: its map, and whether it is an object that is not replaced yet.
type Drawn = (DAffine2, bool);

fn drawn(graph: &Graph, steps: u32, seed: u64) -> Vec<Drawn> {
    let mut growth = Growth::steps(steps);
    growth.seed = seed;
    let elements = Elements::of(graph, &growth).map(|element| element.unwrap().1);
    elements.map(|it| (*it.frame.map(), it.fertile)).collect()
}

/// Returns the numbers of first elements that some draws make of instances.
fn counts(
    structure: &Instancing,
    instances: &[ObjectInstance],
    at: DAffine2,
    steps: u32,
    found: &[Drawn],
) -> BTreeSet<usize> {
    let one = |map: DAffine2, fertile: bool, found: &[Drawn]| -> BTreeSet<usize> {
        let is_it = |it: &Drawn| {
            it.1 == fertile
                && it
                    .0
                    .abs_diff_eq(map, 1e-12 * (1.0 + map.translation.length()))
        };
        found
            .first()
            .filter(|it| is_it(it))
            .map(|_| 1)
            .into_iter()
            .collect()
    };
    let mut all = BTreeSet::from([0]);
    for instance in instances {
        let map = at * instance.map;
        let of = |found: &[Drawn]| match instance.master {
            Master::Shape(_) => one(map, false, found),
            Master::Object(number) => {
                let object = &structure.objects()[number];
                let map = map * object.map;
                if steps == 0 {
                    return one(map, true, found);
                }
                let mut unions: Vec<_> = { object.alternatives.iter() }
                    .map(|it| &object.instances[it.instances.clone()])
                    .collect();
                if unions.is_empty() {
                    unions.push(&object.instances);
                }
                let unions = unions.into_iter();
                unions
                    .flat_map(|all| counts(structure, all, map, steps - 1, found))
                    .collect()
            }
        };
        all = all
            .into_iter()
            .flat_map(|before| of(&found[before..]).into_iter().map(move |it| before + it))
            .collect();
    }
    all
}

#[test]
fn one_alternative_is_drawn_for_every_instance() {
    let structure = structure(STEM);
    let graph = Graph::of_structure(&structure);
    let mut seen = BTreeSet::new();
    for seed in 0..40 {
        let mut before: Vec<Drawn> = Vec::new();
        for steps in 0..6 {
            let found = drawn(&graph, steps, seed);
            let counts = counts(
                &structure,
                structure.scene(),
                DAffine2::IDENTITY,
                steps,
                &found,
            );
            assert!(
                counts.contains(&found.len()),
                "seed {seed}, step {steps}: {found:?}"
            );
            // A further step keeps all shapes.
            let mut shapes = before.iter().filter(|(_, is_object)| !is_object);
            assert!(
                shapes.all(|shape| found.contains(shape)),
                "seed {seed}, step {steps}"
            );
            before = found;
        }
        seen.insert(before.len());
    }
    assert!(seen.len() > 10, "{seen:?}");
}

/// Alternatives are drawn as often as their weights state, within four standard errors.
#[test]
fn weights_are_probabilities() {
    const COUNT: u32 = 8000;
    let text = format!(
        "kind: instancing\nparams: {{w: 3/2}}\nobjects:\n  A: {{at_random: [{{weight: 2*w, union: [line]}}, [area], {{weight: 0, union: []}}]}}\n  \
         line: [{{segment: [[0, 0], [1, 0]]}}]\n  area: [{{disk: {{radius: 1}}}}]\n\
         scene: [{{for: {{k: 1..{COUNT}}}, object: A, translate: [k, 0]}}]\n"
    );
    let graph = Graph::of_structure(&structure(&text));
    let elements = Elements::of(&graph, &Growth::steps(2)).map(|element| element.unwrap().1);
    let is_area = |object: usize| {
        let base_element = graph.objects()[object].base_element;
        graph.base_elements()[base_element].is_closed()
    };
    let kinds: Vec<bool> = elements.map(|element| is_area(element.object)).collect();
    assert_eq!(kinds.len(), COUNT as usize);
    let areas = kinds.iter().filter(|it| **it).count() as f64 / f64::from(COUNT);
    let deviation = (0.25f64 * 0.75 / f64::from(COUNT)).sqrt();
    assert!((areas - 0.25).abs() < 4.0 * deviation, "{areas}");
}

#[test]
fn structures_in_space_draw_the_same_alternatives() {
    let plane = Graph::of_structure(&structure(STEM));
    let text = STEM.replace("kind: instancing", "kind: instancing\nspace: 3");
    let text = text.replace("scale: [1, 0.5]", "scale: [1, 0.5, 1]");
    let angle = |text: &str, angle: &str| {
        text.replace(
            &format!("rotate: {angle}"),
            &format!("rotate: {{z: {angle}}}"),
        )
    };
    let text = ["20", "40", "-30", "3\n", "180", "90"]
        .into_iter()
        .fold(text, |text, it| match it.strip_suffix('\n') {
            Some(it) => text.replace(
                &format!("rotate: {it}\n"),
                &format!("rotate: {{z: {it}}}\n"),
            ),
            None => angle(&text, it),
        });
    let (model, _) = document_of(&text).resolve(&[]).unwrap();
    let space = model.graph_in_space(5).unwrap().unwrap();
    for seed in 0..5 {
        let mut growth = Growth::steps(5);
        growth.seed = seed;
        let elements = Elements::of(&space, &growth).map(|element| element.unwrap().1);
        let origins: Vec<DVec3> = elements.map(|it| it.frame.map().translation).collect();
        let flat = drawn(&plane, 5, seed);
        assert_eq!(flat.len(), origins.len());
        for ((map, _), origin) in flat.iter().zip(origins) {
            assert!((map.translation.extend(0.0) - origin).length() < 1e-12);
        }
    }
}

/// Percolation has the dimension log(9p)/log(3) where it survives (Chayes, Chayes & Durrett 1988).
#[test]
fn the_dimension_is_the_expected_one() {
    for p in [0.2, 0.5, 0.78, 1.0] {
        let (model, _) = document("fractal-percolation")
            .resolve(&[("p", p).into()])
            .unwrap();
        let graph = model.compile(5).unwrap();
        let found = dimensions_of_graph(&graph).dimensions.unwrap();
        let expected = f64::ln(9.0 * p) / 3f64.ln();
        let value = found.similarity.unwrap().value;
        assert!((value - expected).abs() < 1e-12, "{p}: {value} {expected}");
    }
    // Maps that are no similarities, and what dies out, have no such dimension.
    let affine = Graph::of_structure(&structure(STEM));
    assert!(dimensions_of_graph(&affine).dimensions.is_none());
    let text = "kind: instancing\nobjects:\n  A: {at_random: [[B], [B, B]]}\n  \
                B: [{object: A, scale: [1/2, 1/4]}]\nscene: [A]\n";
    let fixed = Graph::of_structure(&structure(text));
    assert!(dimensions_of_graph(&fixed).dimensions.is_none());
    let alike = Graph::of_structure(&structure(&text.replace("[1/2, 1/4]", "1/2")));
    let found = dimensions_of_graph(&alike).dimensions.unwrap();
    let value = found.similarity.unwrap().value;
    assert!((value - 1.5f64.log2()).abs() < 1e-12, "{value}");
    let (model, _) = document("fractal-percolation")
        .resolve(&[("p", 1.0 / 9.0).into()])
        .unwrap();
    assert!(
        dimensions_of_graph(&model.compile(5).unwrap())
            .dimensions
            .is_none()
    );
}

#[test]
fn other_kinds_and_limits_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("stem.yaml"), format!("{STEM}steps: 4\n")).unwrap();
    for line in ["convert stem.yaml --to ifs", "convert stem.yaml --to rule"] {
        let (is_done, said) = run(folder.path(), line);
        assert!(!is_done && said.contains("random"), "{line}: {said}");
    }
    for line in [
        "grow stem.yaml -o stem.png --size 64",
        "show stem.yaml -o show.svg",
        "info stem.yaml",
    ] {
        let (is_done, said) = run(folder.path(), line);
        assert!(is_done, "{line}: {said}");
    }
}

/// Weights that depend on the level have a positive sum at every level.
#[test]
fn one_weight_is_positive() {
    let text = "kind: instancing\nobjects:\n  A(n): {at_random: [{weight: 'max(0, n - 1)', union: \
                [{object: A(n - 1), scale: 1/2}]}, {weight: 0*n, union: [line]}]}\n  \
                line: [{segment: [[0, 0], [1, 0]]}]\nscene: [A(3)]\n";
    let mistakes = document_of(text).resolve(&[]).unwrap_err().render(false);
    assert!(
        mistakes.contains("the sum of the weights is 0 at level 1"),
        "{mistakes}"
    );
}
