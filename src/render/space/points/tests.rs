//! Compares pictures of points with those of the descent.

use std::num::NonZero;

use super::*;
use crate::catalogue::Catalogue;
use crate::chaos::{ClassBy as Classes, Start};
use crate::diagnostic::Source;
use crate::document::Document;
use crate::geometry::HalfSpace;
use crate::model::Model;
use crate::render::Size;
use crate::render::space::{Camera, Shade, pixels_in_space};
use crate::style::Colour;

const FERN: &str = "{kind: ifs, space: 3, maps: [
    {matrix: [[0, 0, 0], [0, 0.18, 0], [0, 0, 0]], weight: 1},
    {matrix: [[0.85, 0, 0], [0, 0.85, 0.1], [0, -0.1, 0.85]], translate: [0, 1.6, 0], weight: 85},
    {matrix: [[0.2, -0.2, 0], [0.2, 0.2, 0], [0, 0, 0.3]], translate: [0, 0.8, 0], weight: 7},
    {matrix: [[-0.2, 0.2, 0], [0.2, 0.2, 0], [0, 0, 0.3]], translate: [0, 0.8, 0], weight: 7}]}";
const TETRAHEDRON: &str = "{kind: ifs, space: 3, vertices: {solid: tetrahedron, shrink: 1/2}}";
/// Cubes in a row, larger and larger, none of which touches the next.
const RECURRENT: &str = "{kind: ifs, space: 3, vertices: {solid: cube, shrink: 0.4}}";

fn of(text: &str) -> (Graph<Frame3>, WeightedMaps<DAffine3>) {
    let source = Source::new("test", text.to_owned());
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    let model = document.resolve(&[]).unwrap().0;
    let graph = model.compile_in_space(false).unwrap();
    let Model::IfsInSpace(system) = model else {
        panic!("not in space");
    };
    (graph, WeightedMaps::of(system.ifs()).unwrap())
}

fn options(side: u32, color_by: ColorBy) -> Options {
    let mut options = Options::default().size(Size::Long(side));
    options.style.background = Some(Colour::BLACK);
    options.style.fill = Some(Colour::grey(255));
    options.style.color_by = color_by;
    options.view.margin = None;
    options
}

/// Depth as brightness: a point is drawn where the descent draws, and at its depth.
#[test]
fn points_are_drawn_where_the_descent_draws() {
    const SIDE: u32 = 64;
    /// Size of the exact picture, whose pixels are means, relative to that of points.
    const FINE: usize = 8;
    let cut = |y: f64| HalfSpace {
        normal: DVec3::new(0.2, 1.0, 0.4),
        distance: y,
    };
    for (text, covered, cut) in [
        (TETRAHEDRON, 0.97, cut(0.3)),
        (RECURRENT, 0.97, cut(0.3)),
        (FERN, 0.8, cut(6.0)),
    ] {
        let (graph, system) = of(text);
        for (perspective, cuts) in [
            (None, vec![]),
            (Some(50.0), vec![]),
            (None, vec![cut]),
            (Some(50.0), vec![cut]),
        ] {
            let coarse = options(SIDE, ColorBy::None);
            let camera = Camera::default().perspective(perspective);
            let space = SpaceOptions::default().camera(camera).cuts(cuts.clone());
            let game = Game::default().points(400_000);
            let points = draw_with(&graph, &system, &game, Tone::Log, &coarse, &space, 1);
            let points = points.unwrap().0;
            let fine = options(SIDE * 8, ColorBy::None);
            let pixels_of = |space: &SpaceOptions| {
                let drawn = pixels_in_space(&graph, None, &fine, space, None);
                drawn.unwrap().pixels
            };
            let descent = pixels_of(&space);
            // White ink on black: the share of a pixel that is covered.
            let cover = pixels_of(&space.clone().shade(Some(Shade::None)));
            let (width, height) = (points.width() as usize, points.height() as usize);
            let [columns, rows] = descent.size().map(|side| side as usize);
            // Greatest brightness within a pixel, of the part that is covered.
            let exact = |x: usize, y: usize| {
                let near = (FINE * y..(FINE * (y + 1)).min(rows)).flat_map(|y| {
                    (FINE * x..(FINE * (x + 1)).min(columns)).map(move |x| 4 * (y * columns + x))
                });
                let bright = near.map(|at| {
                    let [own, cover] =
                        [&descent, &cover].map(|it| i32::from(it.premultiplied()[at]));
                    own * 255 / cover.max(1)
                });
                bright.max().unwrap_or(0)
            };
            let (mut ink, mut hits, mut far) = (0, 0, 0);
            for (at, pixel) in points.pixels().iter().enumerate() {
                let (x, y) = (at % width, at / width);
                let own = exact(x, y);
                ink += u32::from(own > 24);
                if pixel.red() == 0 {
                    continue;
                }
                let columns = x.saturating_sub(1)..(x + 2).min(width);
                let near = columns.flat_map(|x| {
                    (y.saturating_sub(1)..(y + 2).min(height)).map(move |y| exact(x, y))
                });
                let most = near.max().unwrap();
                // Two pixels in depth; nothing is nearer than the exact picture has it.
                let pixels = 2 * 255 / i32::try_from(SIDE).unwrap();
                let seen = i32::from(pixel.red());
                assert!(
                    most > 0 && seen <= most + pixels,
                    "{text} {x} {y}: {seen} {most}"
                );
                hits += u32::from(own > 24);
                far += u32::from(own > 24 && seen < own - 2 * pixels);
            }
            let share = f64::from(hits) / f64::from(ink);
            assert!(
                ink > 500 && share > covered - 0.02 * cuts.len() as f64,
                "{text} {perspective:?} {cuts:?}: {ink} {share}"
            );
            assert!(
                f64::from(far) < 0.05 * f64::from(ink),
                "{text} {cuts:?}: {far} of {ink}"
            );
        }
    }
}

#[test]
fn threads_do_not_change_a_picture() {
    let (graph, system) = of(FERN);
    for (color_by, classes) in [
        (ColorBy::LastMap, Classes::Map { ago: 0 }),
        (ColorBy::FirstMap, Classes::Map { ago: 5 }),
        (ColorBy::Hits, Classes::One),
    ] {
        let mut options = options(48, color_by);
        options.style.palette = crate::style::Palette::default();
        let drawn = [1, 3].map(|threads| {
            let game = Game::default()
                .points(3_000_000)
                .classes(classes)
                .threads(NonZero::new(threads).unwrap());
            let space = SpaceOptions::default();
            let drawn = draw(&graph, &system, &game, Tone::Log, &options, &space);
            drawn.unwrap().0
        });
        assert!(drawn[0] == drawn[1]);
    }
}

#[test]
fn ways_from_starts_are_in_the_picture() {
    let (graph, system) = of(TETRAHEDRON);
    let start = Start::Points {
        points: vec![DVec3::new(9.0, 0.0, 0.0)],
        steps: NonZero::new(8).unwrap(),
    };
    let game = Game::default().points(200_000).start(start);
    let space = SpaceOptions::default().camera(Camera::default().from([0.0, 0.0]));
    let drawn = draw(
        &graph,
        &system,
        &game,
        Tone::Log,
        &options(64, ColorBy::None),
        &space,
    );
    let drawn = drawn.unwrap().0;
    // The first step leads to x = (9 ± 1)/2, and the set reaches from −1 to 1: 6 wide, 2 high.
    assert_eq!(
        [drawn.width(), drawn.height()],
        [64, (64 * 2_u32).div_ceil(6)]
    );
    let last = drawn
        .pixels()
        .chunks_exact(64)
        .filter(|row| row[63].red() > 0);
    assert!(last.count() > 0);
}

/// Many points leave no sample on the set empty, and edges are as in the exact picture.
#[test]
fn dense_points_are_antialiased() {
    let (graph, system) = of("{kind: ifs, space: 3, vertices: {solid: cube, shrink: 1/2}}");
    let options = options(40, ColorBy::None);
    let space = SpaceOptions::default().shade(Some(Shade::None));
    let exact = pixels_in_space(&graph, None, &options, &space, None).unwrap();
    let play = |points| {
        let game = Game::default().points(points);
        let drawn = draw(&graph, &system, &game, Tone::Log, &options, &space).unwrap();
        let pairs = drawn.0.data().chunks_exact(4);
        let pairs = pairs.zip(exact.pixels.premultiplied().chunks_exact(4));
        let away = pairs.map(|(a, b)| u64::from(a[0].abs_diff(b[0])));
        (away.sum::<u64>(), drawn.0)
    };
    let [sparse, dense] = [90_000, 400_000].map(play);
    let greys = |pixmap: &Pixmap| {
        let between = |pixel: &&tiny_skia::PremultipliedColorU8| (1..255).contains(&pixel.red());
        pixmap.pixels().iter().filter(between).count()
    };
    assert_eq!(greys(&sparse.1), 0);
    assert!(greys(&dense.1) > 40, "{}", greys(&dense.1));
    assert!(dense.0 * 3 < sparse.0 * 2, "{} {}", dense.0, sparse.0);
}
