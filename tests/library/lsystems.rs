//! The L-systems of the library.

use std::sync::Arc;

use kfrac::catalogue::Shelf;
use kfrac::grow::Growth;
use kfrac::lsystem::LSystem;
use kfrac::model::Model;
use kfrac::render::{self, Labels, Options, Size};

use super::common::{document, document_of, grown};
use super::picture::Picture;
use super::{check_paths, entries};

/// Iterates over all L-systems of the plane, with their names.
fn systems() -> impl Iterator<Item = (String, Arc<LSystem>)> {
    let is_in_plane = |name: &str| !document(name).resolve(&[]).unwrap().0.is_in_space();
    let names = entries(Shelf::LSYSTEMS).into_iter();
    let names = names.filter(move |entry| is_in_plane(&entry.name));
    names.map(|entry| {
        let system = system(&document(&entry.name).to_yaml());
        (entry.name, system)
    })
}

fn system(text: &str) -> Arc<LSystem> {
    let (model, warnings) = document_of(text).resolve(&[]).unwrap();
    assert!(warnings.is_empty(), "{}{text}", warnings.render(false));
    match model {
        Model::LSystem(system) => system,
        other => panic!("{text} is a {}", other.kind().name()),
    }
}

#[test]
fn the_promised_systems_exist() {
    let all: Vec<_> = systems().map(|(name, _)| name).collect();
    for name in [
        "koch-lsystem",
        "dragon-lsystem",
        "gasket-lsystem",
        "gosper-lsystem",
        "hilbert-lsystem",
        "peano-lsystem",
        "levy-lsystem",
        "penrose-lsystem",
        "plant-a",
        "plant-f",
        "bush",
        "plant-with-flowers",
        "stochastic-plant",
        "branching-pattern",
        "ternary-tree-lsystem",
        "wild-meadow",
        "honda-tree",
    ] {
        assert!(all.iter().any(|known| known == name), "{name}");
    }
}

/// Hart 1992, equations (5) to (8): 2·3ⁿ − 1 lines, a stem and three branches for every apex.
#[test]
fn ternary_trees_have_the_lines_of_the_paper() {
    for name in ["ternary-tree-lsystem", "ternary-tree-apices"] {
        let system = system(&document(name).to_yaml());
        for (steps, lines) in (0..).zip([1, 5, 17, 53, 161]) {
            let graph = Model::LSystem(Arc::clone(&system)).compile(steps).unwrap();
            let elements = grown(&graph, &Growth::steps(steps)).remove(0).elements;
            assert_eq!(elements.len(), lines, "{name}, step {steps}");
        }
    }
}

#[test]
fn every_system_is_drawn_within_its_picture() {
    for (name, system) in systems() {
        let steps = system.metadata().steps.unwrap();
        let graph = Model::LSystem(Arc::clone(&system)).compile(steps).unwrap();
        let elements = grown(&graph, &Growth::steps(steps)).remove(0).elements;
        assert!(elements.len() >= 12, "{name}: there is little to see");
        assert!(elements.len() < 50_000, "{name}: a library is to be quick");
        for size in [1024, 24] {
            let options = Options::of(system.metadata())
                .size(Size::Long(size))
                .labels(Labels {
                    provenance: document(&name).to_yaml(),
                    ..Labels::default()
                });
            let draw = || {
                let mut bytes = Vec::new();
                render::write(&graph, &Growth::steps(steps), &options, &mut bytes)
                    .unwrap_or_else(|error| panic!("{name}: {error}"));
                String::from_utf8(bytes).unwrap()
            };
            let text = draw();
            assert!(text == draw(), "{name}: twice");
            let picture = Picture::read(&text);
            check_paths(&format!("{name}, {size} pixels"), &picture, false);
            assert_eq!(self::system(&picture.metadata), system, "{name}");
        }
    }
}

#[test]
fn printing_and_reading_again_is_the_identity() {
    for (name, system) in systems() {
        let printed = document(&name).to_yaml();
        assert_eq!(self::system(&printed), system, "{name}");
        assert_eq!(document_of(&printed).to_yaml(), printed, "{name}");
    }
}

/// Every seed gives a different individual, and the same seed the same one.
#[test]
fn meadows_grow_wild() {
    let system = system(&document("wild-meadow").to_yaml());
    let word = |seed| system.word(8, seed, 100_000).unwrap();
    assert_eq!(word(1), word(1));
    assert_ne!(word(1), word(2));
}
