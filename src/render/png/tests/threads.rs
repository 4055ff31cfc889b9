//! Tests that neither the number of threads nor the order of their work shows in pictures.

use std::num::NonZero;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

use crate::catalogue::Catalogue;
use crate::diagnostic::Source;
use crate::document::Document;
use crate::graph::Graph;
use crate::grow::Growth;
use crate::parallel::adversary::with_adversary;
use crate::parallel::with_team;
use crate::random_rules::{self, Features};
use crate::render::canvas::Size;
use crate::render::drawing::Drawing;
use crate::render::layout::Layout;
use crate::render::options::{Detail, Options};
use crate::render::png::{Png, Spare};
use crate::render::scene::Scene;
use crate::style::{ColorBy, Colour, Style, Width};

/// Returns the pixels drawn by a number of threads in an order given by `seed`.
fn drawn(
    graph: &Graph,
    growth: &Growth<'_>,
    options: &Options,
    threads: usize,
    seed: u64,
) -> Option<Vec<u8>> {
    with_adversary(seed, || {
        let layout = Layout::find(graph, growth, options).ok()?;
        let scene = Scene::new(&layout.prepass, &layout.growth, layout.canvas);
        with_team(NonZero::new(threads).unwrap(), |team| {
            let mut png =
                Png::begin(scene.size(), scene.background(), Spare::default(), team).unwrap();
            scene.draw(&mut png, team).ok()?;
            Some(png.into_pixels().0.take())
        })
    })
}

/// Compares pictures on any number of threads, in any order, with that of one thread.
fn shows_no_threads(
    name: &str,
    text: Option<&str>,
    steps: u32,
    seed: u64,
    options: &dyn Fn(&mut Options),
) -> Result<(), TestCaseError> {
    let catalogue = Catalogue::embedded();
    let source = match text {
        Some(text) => Source::new(name, text),
        None => catalogue.rule(name).unwrap(),
    };
    let document = Document::read(&source, &catalogue).unwrap();
    let model = document.resolve(&[]).unwrap().0;
    let graph = model.compile(steps).unwrap();
    let growth = Growth {
        max_elements: 100_000,
        ..Growth::steps(steps)
    };
    let mut drawing = Options {
        threads: NonZero::<usize>::MIN,
        ..Options::of(model.metadata())
    };
    options(&mut drawing);
    let draw = |threads, seed| drawn(&graph, &growth, &drawing, threads, seed);
    let expected = draw(1, 1);
    for (threads, seed) in [(2, seed), (3, seed ^ 1), (8, seed ^ 2), (8, seed ^ 3)] {
        let is_same = draw(threads, seed) == expected;
        let style = &drawing.style;
        prop_assert!(is_same, "{name} on {threads}: {style:?}");
    }
    Ok(())
}

/// The curves retrace themselves, so that many lines cover the same pixels completely.
#[test]
fn threads_do_not_show_where_curves_retrace_themselves() {
    let cases = [
        ("koch-rings", 4, 161),
        ("islands-and-lakes", 3, 90),
        ("koch-island", 3, 70),
        ("plus-sign", 4, 60),
        ("levy-lsystem", 11, 60),
        ("ternary-tree-lsystem", 7, 80),
        ("terdragon", 9, 60),
        ("sierpinski-triangles", 7, 50),
        ("binary-tree", 11, 60),
    ];
    for ((name, steps, size), seed) in cases.into_iter().zip(1u64..) {
        for width in [Width::Pixels(1.0), Width::Pixels(3.0), Width::Relative(0.4)] {
            let options = |options: &mut Options| {
                options.size = Size::Long(size);
                options.style.width = width;
                options.style.color_by = [ColorBy::None, ColorBy::Step][usize::from(seed % 2 == 0)];
            };
            shows_no_threads(name, None, steps, seed, &options).unwrap();
        }
    }
}

/// The cases are areas with outlines in the same and in another colour.
#[test]
fn threads_do_not_show_where_areas_are_outlined() {
    let cases = [
        ("mandala", 4, 60),
        ("pentaflake", 5, 40),
        ("snowflake-tiles", 4, 50),
    ];
    for ((name, steps, size), seed) in cases.into_iter().zip(1u64..) {
        for width in [0.2, 0.8, 3.0] {
            for stroke in [Colour::BLACK, Colour::of_rgba([200, 90, 40, 255])] {
                let options = |options: &mut Options| {
                    options.size = Size::Long(size);
                    options.style.width = Width::Pixels(width);
                    options.style.fill = Some(Colour::of_rgba([200, 90, 40, 255]));
                    options.style.stroke = Some(stroke);
                    options.style.color_by = [ColorBy::None, ColorBy::Step][usize::from(seed == 1)];
                };
                shows_no_threads(name, None, steps, seed, &options).unwrap();
            }
        }
    }
}

/// Returns words that go back and forth on a lattice.
fn word() -> impl Strategy<Value = String> {
    let wide = ["!(1)", "!(0.1)", "!(3)"];
    let symbols = ["F", "F", "F", "F", "F", "+", "-", "|", "f"];
    let symbols = vec(select([&symbols[..], &wide[..]].concat()), 3..9);
    symbols.prop_map(|symbols| symbols.concat())
}

fn style() -> impl Strategy<Value = Style> {
    let width = prop_oneof![
        (1..40u32).prop_map(|tenths| Width::Pixels(f64::from(tenths) / 10.0)),
        (1..60u32).prop_map(|parts| Width::Relative(f64::from(parts) / 30.0)),
        Just(Width::Pixels(1.0)),
        Just(Width::Pixels(6.0)),
    ];
    let color_by = select(vec![ColorBy::None, ColorBy::Step, ColorBy::Index]);
    let fill = select(vec![None, Some(Colour::BLACK)]);
    (width, color_by, fill).prop_map(|(width, color_by, fill)| Style {
        width,
        color_by,
        fill,
        ..Style::default()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn threads_do_not_show_in_random_words(
        axiom in word(),
        word in word(),
        angle in select(vec![90, 60, 45, 180]),
        style in style(),
        seed in any::<u64>(),
    ) {
        let text = format!(
            "kind: lsystem\nangle: {angle}\naxiom: \"F{axiom}\"\nproductions: {{F: \"F{word}\"}}\n"
        );
        let options = |options: &mut Options| {
            options.size = Size::Long(40);
            options.style = style.clone();
        };
        shows_no_threads("word.yaml", Some(&text), 4, seed, &options)?;
    }

    #[test]
    fn threads_do_not_show_in_random_rules(
        text in random_rules::rule(Features::DETERMINISTIC),
        style in style(),
        pixels in 0..3u32,
        seed in any::<u64>(),
    ) {
        let options = |options: &mut Options| {
            options.size = Size::Long(40);
            options.style = style.clone();
            options.detail = (pixels > 0).then(|| Detail {
                pixels: f64::from(pixels),
                decides_steps: false,
            });
        };
        shows_no_threads("rule.yaml", Some(&text), 6, seed, &options)?;
    }
}
