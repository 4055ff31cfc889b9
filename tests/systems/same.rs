//! Maps listed twice, sets of every level, and frames of a family.

use kfrac::document::Setting;

use super::*;

const TWICE: &str = "maps:\n  - {scale: 1/3}\n  - {scale: 1/3, shift: [2/3, 0]}\n  - {scale: 1/3, shift: [2/3, 0]}\n";

/// A map listed twice adds no elements, but is picked twice as often.
#[test]
fn a_map_that_is_listed_twice_is_one() {
    let twice = system(TWICE);
    let once = named("cantor");
    let [graph, expected] = [&twice, &once].map(|system| Graph::of_system(system));
    for steps in 0..5 {
        assert_eq!(
            elements(&graph, steps).len(),
            elements(&expected, steps).len()
        );
        assert_eq!(
            elements(&Graph::with_last_maps(&twice).unwrap(), steps).len(),
            1 << steps
        );
    }
    let dimension = |graph| similarity_dimension(graph).value.unwrap();
    assert_close("dimension", dimension(&graph), dimension(&expected), 1e-12);
    assert_eq!(graph.limit_bounds(), expected.limit_bounds());
    assert_close(
        "mean",
        twice.ifs().measure().unwrap().moments.mean.x,
        2.0 / 3.0,
        1e-12,
    );
    // The elements differ if other maps may be applied before the copy.
    let apart = system(&format!("{TWICE}edges: {{1: [1, 2], 2: [1, 3], 3: [2]}}\n"));
    assert_eq!(elements(&Graph::of_system(&apart), 2).len(), 5);
    let alike = system(&format!("{TWICE}edges: {{1: [1, 2, 3], 2: [1], 3: [1]}}\n"));
    let fewer =
        system("maps: [{scale: 1/3}, {scale: 1/3, shift: [2/3, 0]}]\nedges: {1: [1, 2], 2: [1]}\n");
    let [alike, fewer] = [alike, fewer].map(|system| elements(&Graph::of_system(&system), 5).len());
    assert_eq!(alike, fewer);
}

/// All sets of level k are born in step k, also the first of several.
#[test]
fn the_sets_of_a_level_are_born_in_one_step() {
    let maps = "maps: [{scale: 1/2}, {scale: 1/2, shift: [1, 0]}]\n";
    let sets =
        "condensation: [{disk: {radius: 1}}, {segment: [[0, 0], [1, 1]]}, {point: [0, 1]}]\n";
    let graph = Graph::of_system(&system(&format!("{maps}{sets}")));
    let mut counts = BTreeMap::new();
    for element in drawn(&graph, 4) {
        assert!(!element.fertile);
        let level = -element.frame.map().x_axis.x.log2();
        assert_close("level", f64::from(element.born), level, 1e-12);
        *counts.entry(element.born).or_insert(0) += 1;
    }
    assert_eq!(counts, (0..5).map(|level| (level, 3 << level)).collect());
}

/// Figure 8 of Libeskind-Hadas & Maragos 1987: its table for the three frames, in radians.
#[test]
fn the_tree_bends_as_the_frames_of_the_paper() {
    let with = |name: &str, value: f64| {
        let catalogue = Catalogue::embedded();
        let source = catalogue.rule("tree-libeskind-hadas").unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let setting = Setting {
            name: name.into(),
            value,
            written: None,
            place: None,
        };
        let Model::Ifs(system) = document.resolve(&[setting]).unwrap().0 else {
            panic!("this is a system")
        };
        maps(&system)
    };
    let frames = [
        (1.0, [-0.1, -0.7, 0.6], [0.0, 50.0]),
        (2.0, [-0.2, -0.8, 0.7], [0.0, 50.0]),
        (3.0, [-0.3, -0.9, 0.8], [5.0, 55.0]),
    ];
    for (frame, angles, top) in frames {
        let scales = [[0.7, 0.85], [0.3, 0.4], [0.25, 0.4]];
        let shifts = [top, [5.0, 20.0], [-5.0, 30.0]];
        let bent = with("angle", -f64::to_degrees(angles[0]));
        for (number, map) in with("frame", frame).into_iter().enumerate() {
            let ([x, y], (sin, cos)) = (scales[number], f64::sin_cos(angles[number]));
            let expected = [
                x * cos,
                x * sin,
                -y * sin,
                y * cos,
                shifts[number][0],
                shifts[number][1],
            ];
            for (own, expected) in map.to_cols_array().into_iter().zip(expected) {
                assert_close("frame", own, expected, 1e-12);
            }
            // The angle rotates without a translation.
            assert!(bent[number].matrix2.abs_diff_eq(map.matrix2, 1e-12));
        }
    }
}
