//! Sets that are other fractals.

use super::*;

/// A polyline and a fractal that draws it are equal sets.
#[test]
fn a_fractal_is_what_it_draws() {
    let maps = "maps: [{scale: 0.5}, {scale: 0.5, shift: [1, 1]}]\n";
    let points = "[[2, 1], [4, 1], [5, 1 + sqrt(3)], [6, 1], [8, 1]]";
    let fractal = "{fractal: koch, steps: 1, map: {scale: 6, shift: [2, 1]}}";
    let line = format!("{{polyline: {points}}}");
    for key in [
        "initial: SET\n",
        "condensation: [SET]\n",
        "condensation: [SET, {point: [0, 0]}]\n",
    ] {
        let [named, written] = [fractal, &line].map(|set| {
            let graph = Graph::of_system(&system(&(maps.to_owned() + &key.replace("SET", set))));
            let all = elements(&graph, 3);
            let outlines = all.iter().map(|element| {
                let outline = &graph.base_elements()[graph.objects()[element.object].base_element];
                let ends = outline.pieces().iter().map(kfrac::rule::Piece::end);
                let points = std::iter::once(outline.start()).chain(ends);
                points.map(|point| element.frame.apply(point)).collect()
            });
            outlines.collect::<Vec<Vec<DVec2>>>()
        });
        assert_eq!(named.len(), written.len());
        for (named, written) in named.iter().zip(&written) {
            assert_eq!(named.len(), written.len());
            for (a, b) in named.iter().zip(written) {
                assert!((*a - *b).length() < 1e-12, "{key}: {a} {b}");
            }
        }
    }
}

/// An approximant consists of all compositions of maps applied to all outlines; the limit set is that of the
/// maps.
#[test]
fn an_initial_set_may_have_several_outlines() {
    let maps = "vertices: {points: [[0, 0], [1, 0], [1/2, 1]], shrink: 1/2}\n";
    let text = format!("{maps}initial: {{fractal: sierpinski-triangles, steps: 2}}\n");
    let graph = Graph::of_system(&system(&text));
    for steps in 0..4 {
        let all = elements(&graph, steps);
        assert_eq!(all.len(), 9 * 3usize.pow(steps));
        assert!(all.iter().all(|element| element.fertile));
    }
    let alone = Graph::of_system(&system(maps));
    assert_eq!(graph.limit_bounds(), alone.limit_bounds());
    assert_eq!(
        similarity_dimension(&graph).value,
        similarity_dimension(&alone).value
    );
    let recurrent = format!("{text}edges: {{1: [1, 2], 2: [3], 3: [1]}}\n");
    let graph = Graph::of_system(&system(&recurrent));
    let counts = [0, 1, 2, 3].map(|steps| elements(&graph, steps).len());
    // The number of admitted words of maps.
    let ways = |length| products(&system(&recurrent), length).len();
    assert_eq!(counts, [9, 27, 9 * ways(2), 9 * ways(3)]);
}

/// Moments of the set that is drawn in place of points: four lines of equal lengths.
#[test]
fn a_fractal_is_drawn_from_by_length_or_by_area() {
    let mean = |set: &str| {
        let text = format!("maps: [{{scale: 1/2}}]\ncondensation: [{set}]\n");
        let system = system(&text);
        system.ifs().condensation()[0].shape.moments().unwrap().mean
    };
    let koch = mean("{fractal: koch, steps: 1}");
    let height = 3f64.sqrt() / 6.0 / 4.0;
    assert!((koch - DVec2::new(0.5, height)).length() < 1e-12, "{koch}");
    let filled = mean("{fractal: koch-snowflake, steps: 2}");
    let centre = DVec2::new(0.5, 3f64.sqrt() / 6.0);
    assert!((filled - centre).length() < 1e-12, "{filled}");
}

#[test]
fn the_draws_of_a_fractal_hang_on_its_seed() {
    let of = |seed: &str| {
        let set = format!("{{fractal: random-tree, steps: 4{seed}}}");
        system(&format!("maps: [{{scale: 1/2}}]\ninitial: {set}\n"))
            .ifs()
            .initial()
            .cloned()
    };
    assert_eq!(of(""), of(", seed: 0"));
    assert_ne!(of(""), of(", seed: 1"));
}

/// Parameters are set as in a file that extends the fractal's, by expressions of the naming file.
#[test]
fn the_parameters_of_a_fractal_are_set() {
    let of = |fractal: &str| {
        let text =
            format!("params: {{lean: 12}}\nmaps: [{{scale: lean/24}}]\ninitial: {fractal}\n");
        system(&text).ifs().initial().cloned()
    };
    let set = of("{fractal: pythagoras, steps: 3, set: {angle: 5*lean}}");
    let written = of("{fractal: {extends: pythagoras, params: {angle: 60}}, steps: 3}");
    assert_eq!(set, written);
    assert_ne!(set, of("{fractal: pythagoras, steps: 3}"));
    let set = of("{fractal: complex-pair, steps: 2, set: {s: [lean/24, 0.2]}}");
    let written = "{kind: ifs, extends: complex-pair, params: {s: [0.5, 0.2]}}";
    assert_eq!(set, of(&format!("{{fractal: {written}, steps: 2}}")));
    assert_ne!(set, of("{fractal: complex-pair, steps: 2}"));
    // As an object's shape, too.
    let objects = |fractal: &str| {
        let text = format!("kind: instancing\nobjects: {{a: [{fractal}]}}\nscene: [a]\n");
        let source = Source::new("test.yaml", text);
        let document = Document::read(&source, &Catalogue::embedded()).unwrap();
        let Model::Instancing(structure) = document.resolve(&[]).unwrap().0 else {
            panic!("a structure is written")
        };
        Graph::of_structure(&structure).base_elements().to_vec()
    };
    let set = objects("{fractal: frost-tree, steps: 1, set: {flake: 1}}");
    let written =
        objects("{fractal: {kind: ifs, extends: frost-tree, params: {flake: 1}}, steps: 1}");
    assert_eq!(set, written);
    assert_ne!(set, objects("{fractal: frost-tree, steps: 1}"));
}

#[test]
fn what_is_inlined_reads_as_the_same() {
    let text = "kind: ifs\nmaps: [{scale: 1/2}]\ncondensation: [{fractal: frost-tree, steps: 2, set: {flake: 1}, weight: 2}]\n";
    let document = |text: &str| {
        let source = Source::new("test.yaml", text.to_owned());
        Document::read(&source, &Catalogue::embedded()).unwrap()
    };
    let inlined = document(text).to_yaml();
    assert!(
        !inlined.contains("frost-tree") && !inlined.contains("koch-snowflake"),
        "{inlined}"
    );
    assert!(inlined.contains("flake: 1"), "{inlined}");
    let [a, b] = [text, &inlined].map(|text| document(text).resolve(&[]).unwrap().0);
    let (Model::Ifs(a), Model::Ifs(b)) = (a, b) else {
        panic!("systems are written")
    };
    assert_eq!(a.ifs(), b.ifs());
}
