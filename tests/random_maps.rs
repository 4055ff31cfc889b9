//! Structures and systems whose maps have random variables, and systems of which one list of maps is drawn.

use kfrac::catalogue::Catalogue;
use kfrac::diagnostic::Source;
use kfrac::document::Document;
use kfrac::geometry::{DAffine2, DVec2, DVec3};
use kfrac::grow::{Elements, Growth};
use kfrac::measure::exact::dimensions_of_graph;

use crate::common::{document_of, run};

const CHAIN: &str = "kind: instancing
random: {size: 'uniform(0.6, 0.9)', lean: 'normal(5, 2)', side: 'choice(-1, 1)', still: 'uniform(0.2, 0.2)'}
objects:
  A:
    - {segment: [[0, 0], [0, 1]]}
    - {object: A, scale: size, rotate: side*lean, translate: [still, 1]}
scene: [A, {object: A, rotate: 180}]
";

/// Returns the maps of all elements of approximant `steps` of a file.
fn maps(text: &str, steps: u32, seed: u64) -> Vec<DAffine2> {
    let (model, _) = document_of(text).resolve(&[]).unwrap();
    let graph = model.compile(steps).unwrap();
    let mut growth = Growth::steps(steps);
    growth.seed = seed;
    let elements = Elements::of(&graph, &growth).map(|element| element.unwrap().1);
    elements.map(|it| *it.frame.map()).collect()
}

fn are_equal(a: &[DAffine2], b: &[DAffine2]) -> bool {
    let mut pairs = a.iter().zip(b);
    a.len() == b.len() && pairs.all(|(a, b)| a.abs_diff_eq(*b, 1e-12))
}

/// Draws lie in their ranges, and their means within four standard errors of the expected ones.
#[test]
fn maps_are_drawn_from_their_distributions() {
    const STEPS: u32 = 30;
    let (mut sizes, mut leans, mut rights) = (Vec::new(), Vec::new(), 0);
    for seed in 0..40 {
        let all = maps(CHAIN, STEPS, seed);
        let lines = |steps: usize| {
            let mut maps = maps(CHAIN, u32::try_from(steps).unwrap(), seed);
            // The last element of a chain is the object that is not replaced yet.
            maps.remove(2 * steps + 1);
            maps.remove(steps);
            maps
        };
        // A further step keeps all lines.
        let further = lines(10);
        assert!(
            lines(9).iter().all(|line| further.contains(line)),
            "seed {seed}"
        );
        for chain in all.chunks(all.len() / 2) {
            for pair in chain.windows(2) {
                let step = pair[0].inverse() * pair[1];
                let column = step.matrix2.col(0);
                let angle = column.y.atan2(column.x).to_degrees();
                sizes.push(column.length());
                leans.push(angle.abs());
                rights += usize::from(angle > 0.0);
                assert!((step.translation - DVec2::new(0.2, 1.0)).length() < 1e-9);
            }
        }
    }
    let count = sizes.len() as f64;
    assert!(count > 1000.0);
    assert!(sizes.iter().all(|size| (0.6..=0.9).contains(size)));
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    assert!((mean(&sizes) - 0.75).abs() < 4.0 * 0.3 / 12f64.sqrt() / count.sqrt());
    assert!((mean(&leans) - 5.0).abs() < 0.02 + 4.0 * 2.0 / count.sqrt());
    assert!((rights as f64 / count - 0.5).abs() < 4.0 * 0.5 / count.sqrt());
}

#[test]
fn variables_without_spread_are_constants() {
    let fixed = CHAIN
        .replace("random: {size: 'uniform(0.6, 0.9)', lean: 'normal(5, 2)', side: 'choice(-1, 1)', still: 'uniform(0.2, 0.2)'}", "params: {size: 0.7, lean: 5, side: -1, still: 0.2}");
    let drawn = CHAIN
        .replace("uniform(0.6, 0.9)", "uniform(0.7, 0.7)")
        .replace("normal(5, 2)", "normal(5, 0)")
        .replace("choice(-1, 1)", "choice(-1)");
    assert!(are_equal(&maps(&fixed, 8, 0), &maps(&drawn, 8, 3)));
}

/// A system is the structure of an object that is replaced by its images.
#[test]
fn systems_are_structures() {
    let system = "kind: ifs
random: {t: 'uniform(-30, 30)', s: 'normal(0.5, 0.02)'}
maps:
  - {scale: s, rotate: t, fixed: [1, 0]}
  - {matrix: [[s, 0], [0.1, s/2]], translate: [t/100, 0.5]}
  - {scale: [s, 1/3], rotate: [t, 20], translate: [1, 1]}
  - {times: [s, t/100], conjugate: true}
condensation: [{segment: [[0, 0], [1, 0]]}]
";
    let structure = "kind: instancing
random: {t: 'uniform(-30, 30)', s: 'normal(0.5, 0.02)'}
objects:
  X:
    - {object: X, transform: [{translate: [-1, 0]}, {scale: s}, {rotate: t}, {translate: [1, 0]}]}
    - {object: X, matrix: [[s, 0], [0.1, s/2]], translate: [t/100, 0.5]}
    - {object: X, matrix: [['s*cos(t)', -sin(20)/3], ['s*sin(t)', cos(20)/3]], translate: [1, 1]}
    - {object: X, matrix: [[s, t/100], [t/100, -s]]}
    - {segment: [[0, 0], [1, 0]]}
scene: [X]
";
    for seed in 0..5 {
        assert!(are_equal(&maps(system, 4, seed), &maps(structure, 4, seed)));
    }
    let system = "kind: ifs
at_random:
  - [{scale: 1/2}, {scale: 1/2, translate: [1/2, 0]}]
  - {weight: 2, maps: [{scale: 1/3}, {scale: 1/3, translate: [2/3, 0]}]}
  - {weight: 1/4, maps: []}
initial: {segment: [[0, 0], [1, 0]]}
";
    let structure = "kind: instancing
objects:
  X:
    at_random:
      - [{object: X, scale: 1/2}, {object: X, scale: 1/2, translate: [1/2, 0]}]
      - {weight: 2, union: [{object: X, scale: 1/3}, {object: X, scale: 1/3, translate: [2/3, 0]}]}
      - {weight: 1/4, union: []}
initial: {segment: [[0, 0], [1, 0]]}
scene: [X]
";
    let mut sizes = std::collections::BTreeSet::new();
    for seed in 0..9 {
        let found = maps(system, 5, seed);
        assert!(are_equal(&found, &maps(structure, 5, seed)));
        sizes.insert(found.len());
    }
    assert!(sizes.len() > 3, "{sizes:?}");
    let toward = "kind: ifs\nrandom: {f: 'uniform(0.3, 0.5)'}\nvertices: {points: [[0, 0], [1, 0], [0, 1]], shrink: f}\n";
    let listed = "kind: ifs\nrandom: {f: 'uniform(0.3, 0.5)'}\nmaps: [{scale: f}, {scale: f, fixed: [1, 0]}, {scale: f, fixed: [0, 1]}]\n";
    assert!(are_equal(&maps(toward, 4, 2), &maps(listed, 4, 2)));
}

#[test]
fn structures_in_space_draw_the_same_maps() {
    let space = CHAIN
        .replace("kind: instancing", "kind: instancing\nspace: 3")
        .replace("rotate: side*lean", "rotate: {z: side*lean}")
        .replace("rotate: 180", "rotate: {z: 180}")
        .replace(
            "{segment: [[0, 0], [0, 1]]}",
            "{box: {from: [0, 0, 0], to: [1, 1, 1]}}",
        )
        .replace("[still, 1]", "[still, 1, 0]");
    let (model, _) = document_of(&space).resolve(&[]).unwrap();
    let graph = model.graph_in_space(9).unwrap().unwrap();
    for seed in 0..5 {
        let mut growth = Growth::steps(9);
        growth.seed = seed;
        let elements = Elements::of(&graph, &growth).map(|element| element.unwrap().1);
        let origins: Vec<DVec3> = elements.map(|it| it.frame.map().translation).collect();
        let flat = maps(CHAIN, 9, seed);
        assert_eq!(flat.len(), origins.len());
        for (map, origin) in flat.iter().zip(origins) {
            assert!((map.translation.extend(0.0) - origin).length() < 1e-12);
        }
    }
}

/// The dimension solves E Σ rᴰ = 1 (Falconer 1986): for uniform ratios, an integral of powers.
#[test]
fn dimensions_are_expected_ones() {
    let dimension = |text: &str| {
        let (model, _) = document_of(text).resolve(&[]).unwrap();
        let graph = model.compile(3).unwrap();
        let found = dimensions_of_graph(&graph).dimensions?;
        Some(found.similarity?.value)
    };
    let uniform = "kind: ifs\nrandom: {r: 'uniform(1/4, 1/2)', turn: 'uniform(0, 360)'}\nmaps:\n  \
                   - {scale: r, rotate: turn}\n  - {scale: r, translate: [1, 0]}\n  - {scale: r, rotate: 3*turn, translate: [0, 1]}\n";
    let d = dimension(uniform).unwrap();
    let power = |x: f64| x.powf(d + 1.0) / (d + 1.0);
    let sum = 3.0 * (power(0.5) - power(0.25)) / 0.25;
    assert!((sum - 1.0).abs() < 1e-10, "{d}: {sum}");
    let gasket = "kind: ifs\nat_random:\n  - {weight: 3, maps: [{scale: 1/2}, {scale: 1/2, translate: [1, 0]}, {scale: 1/2, translate: [0, 1]}]}\n  \
                  - [{scale: 1/3}, {scale: 1/3, translate: [1, 0]}, {scale: 1/3, translate: [2, 0]}, {scale: 1/3, translate: [0, 1]}, {scale: 1/3, translate: [1, 1]}, {scale: 1/3, translate: [0, 2]}]\n";
    let d = dimension(gasket).unwrap();
    let sum = 0.75 * 3.0 * 2f64.powf(-d) + 0.25 * 6.0 * 3f64.powf(-d);
    assert!((sum - 1.0).abs() < 1e-12, "{d}: {sum}");
    // Maps that are similarities for some draws only have no such dimension.
    assert!(dimension(&uniform.replace("{scale: r, rotate: turn}", "{scale: [r, 1/3]}")).is_none());
}

/// Loops that shrink for all draws are known from the ranges, at any angle; others are drawn by their steps.
#[test]
fn loops_that_may_grow_are_warned_of() {
    let warnings = |text: &str| {
        let (_, doubts) = document_of(text).resolve(&[]).unwrap();
        doubts.render(false)
    };
    let turned = CHAIN.replace("normal(5, 2)", "uniform(0, 360)");
    assert_eq!(warnings(&turned), "");
    let wide = CHAIN.replace("uniform(0.6, 0.9)", "uniform(0.6, 1.1)");
    assert!(
        warnings(&wide).contains("all loops contract"),
        "{}",
        warnings(&wide)
    );
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(
        folder.path().join("wide.yaml"),
        format!("{wide}steps: 20\n"),
    )
    .unwrap();
    for line in [
        "grow wide.yaml -o wide.png --size 64",
        "grow wide.yaml -o wide.svg --view 0,0,1,1",
        "show wide.yaml -o show.svg",
        "info wide.yaml",
    ] {
        let (is_done, said) = run(folder.path(), line);
        assert!(is_done, "{line}: {said}");
    }
    let (is_done, said) = run(folder.path(), "convert wide.yaml --to ifs");
    assert!(!is_done && said.contains("random"), "{said}");
}

#[test]
fn mistakes_have_their_places() {
    let mistakes = |text: &str| document_of(text).resolve(&[]).unwrap_err().render(false);
    for (from, to, message) in [
        (
            "scene: [A,",
            "scene: [{object: A, scale: size},",
            "it is drawn at random, and not known here",
        ),
        (
            "{segment: [[0, 0], [0, 1]]}",
            "{segment: [[0, 0], [size, 1]]}",
            "it is drawn at random, and not known here",
        ),
        (
            "object: A, scale: size,",
            "object: A, scale: size, tint: {hue: lean},",
            "it is drawn at random, and not known here",
        ),
        (
            "'uniform(0.6, 0.9)'",
            "0.7",
            "a distribution is needed here",
        ),
        (
            "object: A, scale: size,",
            "object: A, scale: log(0*size),",
            "not finite",
        ),
    ] {
        let said = mistakes(&CHAIN.replace(from, to));
        assert!(said.contains(message), "{message}: {said}");
    }
    let level = "kind: instancing\nrandom: {n: 'uniform(0, 1)'}\nobjects:\n  A(n): [{object: A(n - 1), scale: 1/2}]\n  \
                 A(0): [{point: [0, 0]}]\nscene: [A(3)]\n";
    assert!(mistakes(level).contains("'n' is a random variable here"));
    let read = |text: &str| {
        let source = Source::new("test.yaml", text);
        Document::read(&source, &Catalogue::embedded())
            .unwrap_err()
            .render(false)
    };
    for (text, message) in [
        (
            "kind: ifs\nrandom: {s: 'uniform(0, 1/2)'}\nmaps: [{scale: s, weight: 1}]\n",
            "random iteration does not draw",
        ),
        (
            "kind: ifs\nrandom: {s: 'uniform(0, 1/2)'}\nmaps: [{scale: s}]\nedges: {1: [1]}\n",
            "has no `edges`",
        ),
        (
            "kind: ifs\nrandom: {s: 'uniform(0, 1/2)'}\ninterpolate: {points: [[0, 0], [1, 1], [2, 0]], scale: s}\n",
            "no maps that can be drawn",
        ),
        (
            "kind: ifs\nat_random: [{weight: 2}]\n",
            "an alternative needs `maps`",
        ),
        (
            "kind: ifs\nmaps: [{scale: 1/2}]\nat_random: [[{scale: 1/2}]]\n",
            "`at_random` stands in place of `maps`",
        ),
    ] {
        let said = read(text);
        assert!(said.contains(message), "{message}: {said}");
    }
}

/// A drawn map that is not finite stops the growth with the object's name.
#[test]
fn drawn_maps_are_finite() {
    let folder = tempfile::tempdir().unwrap();
    let text = "kind: instancing\nrandom: {x: 'uniform(-1, 1)'}\nobjects:\n  A: [{segment: [[0, 0], [1, 0]]}, {object: A, scale: 1/2, translate: [sqrt(x + 0.01), 0]}]\n\
                scene: [A]\nsteps: 9\n";
    std::fs::write(folder.path().join("root.yaml"), text).unwrap();
    let (is_done, said) = run(
        folder.path(),
        "grow root.yaml --steps 9 --format csv -o root.csv",
    );
    assert!(
        !is_done && said.contains("object 'A' has a drawn transform that is not finite"),
        "{said}"
    );
    assert!(!folder.path().join("root.csv").exists());
}
