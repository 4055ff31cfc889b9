//! Figures of instancing graphs.

use std::collections::BTreeSet;
use std::fs;

use crate::common::{self, document, run};
use kfrac::catalogue::{Catalogue, Shelf};
use kfrac::figure::rule::{RuleFigureOptions, Topology, write_graph, write_graph_in_space};
use kfrac::geometry::Frame;
use kfrac::graph::{Graph, Replacement};
use kfrac::grow::Growth;
use kfrac::style::ColorBy;

/// Returns the numbers of objects and of instances of a figure.
fn counts(svg: &str) -> [usize; 2] {
    let of = |label: &str| svg.matches(&format!("aria-label=\"{label}\"")).count();
    // An arrow with a number stands for several.
    let more = svg.split("aria-label=\"×").skip(1).map(|rest| {
        let number: usize = rest.split('"').next().unwrap().parse().unwrap();
        number - 1
    });
    [of("object"), of("instance") + more.sum::<usize>()]
}

#[test]
fn a_gasket_has_the_graphs_of_hart() {
    let folder = tempfile::tempdir().unwrap();
    for (options, expected) in [
        // One object of three instances of itself, and the instance in the initiator.
        ("--graph", [1, 4]),
        // An object for each number of steps that remain, from 3 to 0.
        ("--graph=levels", [4, 10]),
        ("--graph=levels --steps 1", [2, 4]),
        // A tree of 1 + 3 + 9 circles.
        ("--graph=tree --steps 2", [13, 13]),
    ] {
        let line = format!("show sierpinski-triangles {options} -q -o graph.svg");
        assert!(run(folder.path(), &line).0, "{line}");
        let svg = fs::read_to_string(folder.path().join("graph.svg")).unwrap();
        assert_eq!(counts(&svg), expected, "{line}");
    }
    // Maps that differ by nothing but their places are instances of one object.
    for (name, expected) in [("menger", [1, 21]), ("gasket", [1, 4]), ("koch", [1, 5])] {
        let line = format!("show {name} --graph -q -o graph.svg");
        assert!(run(folder.path(), &line).0, "{line}");
        let svg = fs::read_to_string(folder.path().join("graph.svg")).unwrap();
        assert_eq!(counts(&svg), expected, "{line}");
    }
}

/// Returns the numbers of objects and of instances that an initiator leads to.
fn reached<F: Frame>(graph: &Graph<F>, steps: u32) -> [usize; 2] {
    let start = &graph.initiator(steps).instances;
    let mut instances = start.len();
    let mut waiting: Vec<usize> = start.iter().map(|instance| instance.object).collect();
    let mut known = BTreeSet::new();
    while let Some(object) = waiting.pop() {
        if !known.insert(object) {
            continue;
        }
        let children: Vec<usize> = match &graph.objects()[object].replacement {
            Replacement::Fixed(successor) => {
                let seeds = { successor.seeds.iter() }.flat_map(|seed| &seed.chain.instances);
                let body = successor.body.instances.iter().chain(seeds);
                body.map(|instance| instance.object).collect()
            }
            Replacement::Evaluated(alternatives) => { alternatives.iter() }
                .flat_map(|it| it.objects.clone())
                .collect(),
            Replacement::Kept | Replacement::Unresolved => Vec::new(),
        };
        instances += children.len();
        waiting.extend(children);
    }
    [known.len(), instances]
}

/// Objects that are replaced alike are one circle, and there is no other loss.
#[test]
fn every_graph_of_the_library_is_drawn() {
    const STEPS: u32 = 3;
    let entries = Catalogue::embedded().entries().into_iter();
    let names = entries.filter(|entry| matches!(entry.shelf, Shelf::Fractals(_)));
    let [mut whole, mut exact] = [0; 2];
    for name in names.map(|entry| entry.name) {
        let (model, _) = document(&name).resolve(&[]).unwrap();
        let growth = Growth::steps(STEPS);
        let options = RuleFigureOptions::default();
        for topology in [Topology::Cyclic, Topology::Levels, Topology::Tree] {
            let mut svg = Vec::new();
            let drawn = model.drawn_in_space(Some(STEPS), &growth, ColorBy::None);
            let (size, most) = match drawn {
                Some(drawn) => {
                    let graph = drawn
                        .unwrap_or_else(|error| panic!("{name}: {error}"))
                        .graph;
                    let size = write_graph_in_space(&graph, topology, STEPS, &options, &mut svg);
                    (size, reached(&graph, STEPS))
                }
                None => {
                    let graph = model.compile(STEPS).unwrap();
                    let size = write_graph(&graph, topology, STEPS, &options, &mut svg);
                    (size, reached(&graph, STEPS))
                }
            };
            let size = size.unwrap();
            assert!(size.iter().all(|side| *side < 20_000), "{name}: {size:?}");
            let svg = String::from_utf8(svg).unwrap();
            if topology == Topology::Cyclic && !svg.contains("There are more") {
                let [objects, instances] = counts(&svg);
                let is_bounded = objects <= most[0] && instances <= most[1];
                assert!(
                    (objects > 0 || most[0] == 0) && is_bounded,
                    "{name}: {objects} {instances} {most:?}"
                );
                exact += usize::from([objects, instances] == most);
                whole += 1;
            }
        }
    }
    assert!(whole > 100 && exact > 20, "{whole} {exact}");
}

#[test]
fn components_have_no_graph() {
    let folder = tempfile::tempdir().unwrap();
    let (status, said) = common::said(folder.path(), &["show", "generators/koch", "--graph"]);
    assert_ne!(status, Some(0));
    assert!(said.contains("--graph draws the graph of a rule"), "{said}");
}

/// An initiator with corners that are not those of the base element shears all elements; their lengths are then not multiplied by
/// the factors of the generator.
#[test]
fn forecasts_know_sheared_initiators() {
    let text = |third: &str| {
        format!(
            "space: 3\ninitiator: [{{corners: [[0, 0, 0], [1, 0, 0], {third}], up: [0, 0, 1]}}]\n\
             base_element: triangle-tile\n\
             generator: [{{face: [[0, 0, 0], [1/2, 0, 0], [1/4, 0, sqrt(3)/4]]}}]\n"
        )
    };
    for (third, is_known) in [("[1/2, sqrt(3)/2, 0]", true), ("[0, 3, 0]", false)] {
        let document = common::document_of(&text(third));
        let model = document.resolve(&[]).unwrap().0;
        let graph = model.graph_in_space(1).unwrap().unwrap();
        let mut forecast = graph.forecast().unwrap();
        assert!(forecast.advance());
        assert_eq!(forecast.level().length.is_some(), is_known, "{third}");
    }
}

#[test]
fn rules_have_no_maps_to_colour_by() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["pythagoras", "hilbert-in-space"] {
        let given = ["grow", name, "--steps", "1", "--color-by", "first-map"];
        let (status, said) = common::said(folder.path(), &given);
        assert_eq!(status, Some(1));
        assert!(said.contains("is a rule and has no maps"), "{said}");
    }
}

#[test]
fn files_of_faces_are_not_written_without_any() {
    let folder = tempfile::tempdir().unwrap();
    let text = "kind: lsystem\nspace: 3\naxiom: F\nproductions: {F: F^F}\n";
    for (tube, status) in [("", 1), ("style: {tube: 4}\n", 0)] {
        fs::write(folder.path().join("lines.yaml"), text.to_owned() + tube).unwrap();
        for file in ["a.stl", "a.ply", "a.obj", "a.glb", "a.3mf", "a.pov"] {
            let given = ["grow", "lines.yaml", "--steps", "2", "-o", file];
            let (code, said) = common::said(folder.path(), &given);
            assert_eq!(code, Some(status), "{file}: {said}");
            assert_eq!(said.contains("which have no faces"), status == 1, "{said}");
            let path = folder.path().join(file);
            assert_eq!(path.exists(), status == 0);
            fs::remove_file(path).ok();
        }
    }
}

/// Meshes and tables hold whole elements, as seen from nowhere.
#[test]
fn options_of_pictures_are_refused_in_files_of_elements() {
    let folder = tempfile::tempdir().unwrap();
    let said = |options: &str| {
        let given = format!("grow menger --steps 1 {options}");
        let given: Vec<&str> = given.split(' ').collect();
        common::said(folder.path(), &given)
    };
    for (options, refusal) in [
        ("--cut 1,0,0=0.5 -o a.stl", "--cut applies to pictures"),
        ("--cut 1,0,0=0.5 -o a.glb", "--cut applies to pictures"),
        ("--cut 1,0,0=0.5 -o a.pov", "--cut applies to pictures"),
        ("--slice 1,0,0=0.5 -o a.csv", "--slice applies to pictures"),
        ("--from 30,40 -o a.stl", "--from applies to pictures"),
        ("--shade relief -o a.usda", "--shade applies to pictures"),
        ("--light 30,40 -o a.csv", "--light applies to pictures"),
        ("--view 0,0,1,1 -o a.obj", "--view "),
        ("--mesh shell -o a.png", "--mesh applies to meshes"),
    ] {
        let (status, said) = said(options);
        assert_ne!(status, Some(0), "{options}");
        assert!(said.contains(refusal), "{said}");
    }
    let (status, said) = said("--from 30,40 --light 10,20 -o a.pov");
    assert_eq!(status, Some(0), "{said}");
}
