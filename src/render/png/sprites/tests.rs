//! Tests of sprites: pictures with sprites, against pictures in which every element is drawn.

use std::num::NonZero;
use std::sync::Arc;

use crate::catalogue::Catalogue;
use crate::document::Document;
use crate::grow::Growth;
use crate::parallel::with_team;
use crate::render::canvas::Size;
use crate::render::drawing::Drawing;
use crate::render::layout::Layout;
use crate::render::options::{Detail, Options};
use crate::render::png::{Png, Spare};
use crate::render::scene::Scene;
use crate::render::short_cuts::{ShortCut, ShortCuts};
use crate::style::{ColorBy, Colour, Style, Width};

fn drawn(scene: &Scene<'_>, threads: usize) -> Vec<u8> {
    with_team(NonZero::new(threads).unwrap(), |team| {
        let mut png = Png::begin(scene.size(), scene.background(), Spare::default(), team).unwrap();
        scene.draw(&mut png, team).unwrap();
        png.into_pixels().0.take()
    })
}

/// Returns the largest difference of pixels, the mean difference, and the difference of the means.
fn difference(a: &[u8], b: &[u8]) -> (u8, f64, f64) {
    let differences = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b));
    let sum = |values: &mut dyn Iterator<Item = u8>| values.map(f64::from).sum::<f64>();
    let mean = sum(&mut differences.clone()) / a.len() as f64;
    let [all, others] = [a, b].map(|all| sum(&mut all.iter().copied()));
    let of_means = (all - others) / a.len() as f64;
    (differences.max().unwrap(), mean, of_means.abs())
}

/// Compares a picture made with sprites, for an assumed large number of elements, with one without sprites:
/// to a detail of half a pixel, or of some steps.
fn is_stamped(name: &str, steps: Option<u32>, style: impl FnOnce(&mut Style)) {
    let catalogue = Catalogue::embedded();
    let source = catalogue.rule(name).unwrap();
    let document = Document::read(&source, &catalogue).unwrap();
    let model = document.resolve(&[]).unwrap().0;
    let growth = Growth::steps(steps.unwrap_or(30));
    let graph = model.compile(growth.steps).unwrap();
    let mut options = Options {
        size: Size::Long(128),
        detail: steps.is_none().then_some(Detail {
            pixels: 0.5,
            decides_steps: true,
        }),
        ..Options::of(model.metadata())
    };
    style(&mut options.style);
    let layout = Layout::find(&graph, &growth, &options).unwrap();
    let mut scene = Scene::new(&layout.prepass, &layout.growth, layout.canvas);
    // Assume enough elements for sprites on the finest grid, or on the coarsest.
    scene.elements = steps.map_or(u64::MAX, |_| 1 << 20);
    if graph.seeds {
        scene.uses = 0;
    }
    let sprites = [ShortCut::RunSprites, ShortCut::ColonySprites];
    scene.short_cuts = sprites
        .into_iter()
        .fold(ShortCuts::default(), ShortCuts::without);
    let one_by_one = drawn(&scene, 1);
    scene.short_cuts = ShortCuts::default();
    let placed = drawn(&scene, 1);
    // Squares of some fractals lie on the grid.
    let shows = placed != one_by_one || ["square-filled", "t-square"].contains(&name);
    assert!(shows, "{name}: nothing is stamped");
    assert!(placed == drawn(&scene, 3), "{name} on three threads");
    scene.sprites = Some(Arc::default());
    for _ in 0..2 {
        assert!(
            placed == drawn(&scene, 1),
            "{name} with sprites that are kept"
        );
    }
    let (most, mean, of_means) = difference(&placed, &one_by_one);
    let is_near = most <= 40 && mean < 1.6 && of_means < 0.5;
    assert!(is_near, "{name}: {most}, {mean}, {of_means}");
}

#[test]
fn stamps_cover_what_elements_do() {
    for name in [
        "carpet",
        "t-square",
        "terdragon",
        "terdragon-rose",
        "twindragon-ifs",
        "square-filled",
        "pentaflake",
        // In each step, all elements have the same orientation; in the second, two lengths.
        "complex-pair",
        "snowflake-tiles",
    ] {
        is_stamped(name, None, |_| {});
    }
}

#[test]
fn stamps_cover_what_lines_of_steps_do() {
    for (name, steps) in [("dragon", 14), ("koch", 7), ("terdragon", 9), ("levy", 13)] {
        is_stamped(name, Some(steps), |_| {});
    }
}

/// The cases have outlines in the same and in another colour.
#[test]
fn stamps_cover_what_outlined_elements_do() {
    let [light, dark] = [Colour::of_rgba([200, 90, 40, 255]), Colour::BLACK];
    for (name, stroke) in [
        ("carpet", dark),
        ("pentaflake", dark),
        ("pentaflake", light),
    ] {
        is_stamped(name, None, |style| {
            style.fill = Some(light);
            style.stroke = Some(stroke);
            style.width = Width::Pixels(0.8);
            style.color_by = ColorBy::None;
        });
    }
}

#[test]
fn stamps_cover_what_seeded_fractals_do() {
    for color_by in [ColorBy::Step, ColorBy::Generator, ColorBy::None] {
        for stroke in [Some(Colour::of_rgba([90, 47, 78, 255])), None] {
            is_stamped("mandala", None, |style| {
                style.color_by = color_by;
                style.stroke = stroke;
            });
        }
    }
}
