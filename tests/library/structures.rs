//! The instancing structures of the library.

use std::sync::Arc;

use kfrac::catalogue::Shelf;
use kfrac::grow::Growth;
use kfrac::instancing::Instancing;
use kfrac::measure::similarity_dimension;
use kfrac::model::Model;
use kfrac::render::{self, Labels, Options, Size};

use super::common::{document, document_of, grown};
use super::picture::Picture;
use super::{check_paths, entries};

/// Returns all structures with their names and the numbers of steps that they are drawn with.
fn structures() -> Vec<(String, Arc<Instancing>, u32)> {
    let names = entries(Shelf::INSTANCING).into_iter();
    let is_in_plane = |name: &str| !document(name).resolve(&[]).unwrap().0.is_in_space();
    let names = names.filter(|entry| is_in_plane(&entry.name));
    let structures = names.map(|entry| {
        let structure = structure(&document(&entry.name).to_yaml());
        let steps = structure.metadata().steps.or_else(|| structure.depth());
        let steps = steps.unwrap_or_else(|| panic!("{} says no steps", entry.name));
        (entry.name, structure, steps)
    });
    structures.collect()
}

fn structure(text: &str) -> Arc<Instancing> {
    let (model, warnings) = document_of(text).resolve(&[]).unwrap();
    assert!(warnings.is_empty(), "{}", warnings.render(false));
    match model {
        Model::Instancing(structure) => structure,
        other => panic!("{text} is a {}", other.kind().name()),
    }
}

fn svg_of(name: &str, structure: &Arc<Instancing>, steps: u32, size: u32) -> String {
    let graph = Model::Instancing(Arc::clone(structure))
        .compile(steps)
        .unwrap();
    let options = Options::of(structure.metadata())
        .size(Size::Long(size))
        .labels(Labels {
            provenance: document(name).to_yaml(),
            ..Labels::default()
        });
    let mut bytes = Vec::new();
    render::write(&graph, &Growth::steps(steps), &options, &mut bytes)
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    String::from_utf8(bytes).unwrap()
}

#[test]
fn the_promised_structures_exist() {
    let all = structures();
    for name in [
        "gasket-iterative",
        "gasket-recursive",
        "pound-sign-tinted",
        "ternary-tree",
        "ternary-tree-levels",
    ] {
        assert!(all.iter().any(|(known, ..)| known == name), "{name}");
    }
}

#[test]
fn every_structure_is_drawn_within_its_picture() {
    for (name, structure, steps) in structures() {
        for size in [1024, 24] {
            let text = svg_of(&name, &structure, steps, size);
            assert!(
                text == svg_of(&name, &structure, steps, size),
                "{name}: twice"
            );
            let picture = Picture::read(&text);
            let has_window = structure.metadata().view.window.is_some();
            check_paths(&format!("{name}, {size} pixels"), &picture, has_window);
            assert_eq!(self::structure(&picture.metadata), structure, "{name}");
        }
    }
}

#[test]
fn every_structure_grows_as_forecast() {
    for (name, structure, steps) in structures() {
        let graph = Model::Instancing(Arc::clone(&structure))
            .compile(steps)
            .unwrap();
        let Some(mut forecast) = graph.forecast() else {
            assert!(graph.draws(), "{name}");
            continue;
        };
        (0..steps).for_each(|_| assert!(forecast.advance()));
        // Images under a symmetry are fractals of their own.
        let fractals = grown(&graph, &Growth::steps(steps)).into_iter();
        let elements: Vec<_> = fractals.flat_map(|fractal| fractal.elements).collect();
        assert!(elements.len() < 50_000, "{name}: a library is to be quick");
        let count = forecast.level().elements.to_u64();
        assert_eq!(count, Some(elements.len() as u64), "{name}");
        let shown = elements
            .iter()
            .filter(|it| graph.objects()[it.object].visible);
        assert!(shown.count() > 100, "{name}: there is little to see");
        if structure.depth().is_some_and(|depth| depth <= steps) {
            assert!(elements.iter().all(|it| !it.fertile), "{name} has ended");
        }
        let published = structure.metadata().dimension;
        let computed = similarity_dimension(&graph).value;
        match (published, computed) {
            (Some(published), Some(computed)) => {
                assert!((published - computed).abs() < 1e-12, "{name}");
            }
            (Some(_), None) => panic!("{name}: no dimension to hold it against"),
            (None, _) => {}
        }
    }
}

#[test]
fn printing_and_reading_again_is_the_identity() {
    for (name, structure, _) in structures() {
        let printed = document(&name).to_yaml();
        assert_eq!(self::structure(&printed), structure, "{name}");
        assert_eq!(document_of(&printed).to_yaml(), printed, "{name}");
    }
}
