//! Tests of PNG drawing: threads, chunks and segment batches do not change pixels.

#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use std::io;
use std::num::NonZero;

use crate::catalogue::{Catalogue, Shelf};
use crate::diagnostic::Source;
use crate::document::Document;
use crate::graph::Graph;
use crate::grow::Growth;
use crate::parallel::with_team;
use crate::render::canvas::Size;
use crate::render::drawing::Drawing;
use crate::render::layout::Layout;
use crate::render::options::Options;
use crate::render::paint::{Paint, Pen, Position, Stroke};
use crate::render::scene::Scene;
use crate::render::surface::Surface;
use crate::style::{Cap, Colour, Join, Style, Width};

use super::skia::Outline;
use super::{Pixmap, Png, Raster, Spare};

mod threads;

const SIZE: [u32; 2] = [80, 60];

fn stroke(width: f64) -> Paint {
    let pen = Pen {
        width,
        cap: Cap::Round,
        join: Join::Round,
        dash: 0.0,
    };
    Paint {
        stroke: Some(Stroke {
            colour: Colour::BLACK,
            pen,
        }),
        fill: None,
        has_holes: false,
    }
}

/// Returns paths for every way of drawing: hairlines, round pens, small polygons, and paths that are left to
/// tiny-skia.
fn paths() -> Vec<(Paint, Vec<Position>)> {
    let fill = Paint {
        fill: Some(Colour::BLACK),
        stroke: None,
        has_holes: false,
    };
    let paints = [0.02, 0.2, 0.9, 2.5, 4.0].map(stroke);
    let paints = paints.iter().chain([&fill]).cycle();
    let place = |number: i64| [number * 7919 % 8000, number * 104_729 % 6000];
    let small = |number: i64| {
        let [x, y] = place(number);
        vec![[x, y], [x + 300, y + 40], [x + 90, y + 260]]
    };
    let large = |number: i64| (number..number + 3).map(place).collect();
    let all = (0..120).map(|number| {
        if number % 5 == 0 {
            large(number)
        } else {
            small(number)
        }
    });
    paints.copied().zip(all).collect()
}

fn draw(png: &mut impl Surface, paths: &[(Paint, Vec<Position>)]) {
    for (paint, vertices) in paths {
        png.begin(paint).unwrap();
        png.move_to(vertices[0]);
        png.lines_to(&vertices[1..]);
        if paint.fill.is_some() {
            png.close();
        }
        png.hand_on().unwrap();
        png.end().unwrap();
    }
}

/// Returns the pixels of a picture that is drawn on `threads` threads.
fn drawn(threads: usize, draw: impl FnOnce(&mut Png<'_, '_>)) -> Vec<u8> {
    with_team(NonZero::new(threads).unwrap(), |team| {
        let mut png = Png::begin(SIZE, None, Spare::default(), team).unwrap();
        draw(&mut png);
        png.settle();
        png.part.pixmap.data().to_vec()
    })
}

#[test]
fn the_number_of_threads_does_not_show() {
    let once = paths();
    let mut all = shaped_paths();
    for ink in [[0, 0, 0, 255], [200, 90, 0, 255], [0, 90, 200, 100]] {
        let colour = Colour::of_rgba(ink);
        let of_colour = once.iter().cloned().map(|(mut paint, vertices)| {
            paint.fill = paint.fill.map(|_| colour);
            paint.stroke = paint.stroke.map(|stroke| Stroke { colour, ..stroke });
            (paint, vertices)
        });
        // More than one chunk.
        let rounds = if colour == colour.opaque() { 150 } else { 1 };
        for _ in 0..rounds {
            all.extend(of_colour.clone());
        }
    }
    let one = drawn(1, |png| draw(png, &all));
    assert!(one.iter().any(|&value| value > 0));
    for threads in [2, 3, 5] {
        let many = drawn(threads, |png| draw(png, &all));
        assert!(many == one, "on {threads} threads");
    }
}

/// Returns paths of all caps and joins, with and without a fill.
fn shaped_paths() -> Vec<(Paint, Vec<Position>)> {
    let mut paths = Vec::new();
    let zigzag = [
        [800, 900],
        [2500, 4100],
        [3300, 1500],
        [3400, 4600],
        [5200, 1200],
        [7100, 4400],
    ];
    for cap in [Cap::Butt, Cap::Square, Cap::Round] {
        for join in [Join::Miter, Join::Bevel, Join::Round] {
            for width in [0.7, 1.6, 3.5] {
                for fill in [None, Some(Colour::of_rgba([200, 90, 0, 255]))] {
                    let mut paint = stroke(width);
                    paint.fill = fill;
                    if let Some(Stroke { pen, .. }) = &mut paint.stroke {
                        (pen.cap, pen.join) = (cap, join);
                    }
                    paths.push((paint, zigzag.to_vec()));
                }
            }
        }
    }
    paths
}

/// tiny-skia distinguishes sixteen shades along one axis and four along the other, and draws no corners of
/// strokes that are thinner than a pixel.
#[test]
fn strokes_with_corners_are_those_of_the_reference() {
    let is_wide = |paint: &Paint| paint.stroke.is_some_and(|stroke| stroke.pen.width > 1.0);
    for (paint, vertices) in shaped_paths()
        .into_iter()
        .filter(|(paint, _)| is_wide(paint))
    {
        let path = [(paint, vertices)];
        let drawn = drawn(1, |png| draw(png, &path));
        let mut reference = Pixmap::new(SIZE[0], SIZE[1]).unwrap();
        let mut outline = Outline::default();
        let [(paint, vertices)] = &path;
        outline.begin(*paint);
        outline.move_to(vertices[0]);
        vertices[1..]
            .iter()
            .for_each(|&vertex| outline.line_to(vertex));
        if paint.fill.is_some() {
            outline.close(&mut reference);
        }
        outline.end(&mut reference);
        let differences = drawn
            .iter()
            .zip(reference.data())
            .map(|(a, b)| a.abs_diff(*b));
        let most = differences.clone().max().unwrap();
        let mean = differences.map(f64::from).sum::<f64>() / drawn.len() as f64;
        assert!(most <= 60 && mean < 0.5, "{most} and {mean} with {paint:?}");
        assert!(drawn.iter().any(|&value| value > 0));
    }
}

/// A path of several shapes, each with fill and stroke: all strokes lie over all fills.
#[test]
fn strokes_lie_over_fills() {
    let fill = Colour::of_rgba([200, 90, 0, 255]);
    let square = |x: i64| vec![[x, 1000], [x + 2000, 1000], [x + 2000, 3000], [x, 3000]];
    let mut paint = stroke(1.0);
    paint.fill = Some(fill);
    let drawn = drawn(2, |png| {
        png.begin(&paint).unwrap();
        for x in [1000, 2000] {
            let square = square(x);
            png.move_to(square[0]);
            png.lines_to(&square[1..]);
            png.close();
        }
        png.end().unwrap();
        // Later paths lie on top.
        png.begin(&Paint {
            fill: Some(Colour::BLACK),
            stroke: None,
            has_holes: false,
        })
        .unwrap();
        let square = [[1300, 1300], [1500, 1300], [1500, 1500], [1300, 1500]];
        assert_eq!(png.polygons(&square, 4), 1);
        png.end().unwrap();
    });
    let pixel = |x: usize, y: usize| &drawn[4 * (y * SIZE[0] as usize + x)..][..4];
    assert_eq!(pixel(15, 20), [200, 90, 0, 255]);
    assert_eq!(pixel(14, 14), [0, 0, 0, 255]);
    // The side of one square in the middle of the other, on both sides of the border between pixels.
    for x in [19, 20, 29, 30] {
        let [red, green, blue, alpha] = *pixel(x, 20) else {
            panic!()
        };
        assert!(
            (90..110).contains(&red) && (40..50).contains(&green),
            "{red} {green} at {x}"
        );
        assert_eq!([blue, alpha], [0, 255]);
    }
}

/// Chunks may end anywhere along a path, also at its start.
#[test]
fn long_paths_are_in_one_piece() {
    let zigzag = |number: i64| [number % 8000, 1000 + 4000 * (number % 2) + number / 20];
    for width in [0.1, 0.9] {
        let vertices: Vec<Position> = (0..40_000).map(zigzag).collect();
        let whole = drawn(1, |png| {
            png.begin(&stroke(width)).unwrap();
            png.move_to(vertices[0]);
            png.lines_to(&vertices[1..]);
            png.end().unwrap();
        });
        let in_pieces = drawn(3, |png| {
            png.begin(&stroke(width)).unwrap();
            png.move_to(vertices[0]);
            png.hand_on().unwrap();
            for vertices in vertices[1..].chunks(1001) {
                png.lines_to(vertices);
                png.hand_on().unwrap();
            }
            png.end().unwrap();
        });
        assert!(whole == in_pieces, "{width} pixels");
    }
}

/// A closed path of very many vertices is filled and stroked on any thread; chunks hold its lines, not the
/// polygons of its stroke.
#[test]
fn long_outlines_are_those_of_the_reference() {
    let corner = |number: i64| {
        let turn = number as f64 / 30_000.0 * std::f64::consts::TAU;
        let radius = 1900.0 + 600.0 * libm::sin(9.0 * turn) + (number % 2 * 40) as f64;
        #[expect(clippy::cast_possible_truncation, reason = "a small picture")]
        [
            4000 + (radius * libm::cos(turn)) as i64,
            3000 + (radius * libm::sin(turn)) as i64,
        ]
    };
    let mut vertices: Vec<Position> = (0..30_000).map(corner).collect();
    vertices.dedup();
    let fill = Colour::of_rgba([200, 90, 0, 255]);
    for (cap, join) in [(Cap::Butt, Join::Miter), (Cap::Round, Join::Round)] {
        let mut paint = stroke(1.5);
        paint.fill = Some(fill);
        if let Some(Stroke { pen, .. }) = &mut paint.stroke {
            (pen.cap, pen.join) = (cap, join);
        }
        let paths = [(paint, vertices.clone())];
        let one = drawn(1, |png| draw(png, &paths));
        for threads in [2, 3, 8] {
            let in_pieces = drawn(threads, |png| {
                png.begin(&paint).unwrap();
                png.move_to(vertices[0]);
                for vertices in vertices[1..].chunks(1001) {
                    png.lines_to(vertices);
                    png.hand_on().unwrap();
                    assert!(png.chunk.list.points.len() <= (1 << 14) + 1001);
                }
                png.close();
                png.end().unwrap();
            });
            assert!(in_pieces == one, "on {threads} threads");
        }
        let mut reference = Pixmap::new(SIZE[0], SIZE[1]).unwrap();
        let mut outline = Outline::default();
        outline.begin(paint);
        outline.move_to(vertices[0]);
        vertices[1..]
            .iter()
            .for_each(|&vertex| outline.line_to(vertex));
        outline.close(&mut reference);
        outline.end(&mut reference);
        let differences = one
            .iter()
            .zip(reference.data())
            .map(|(a, b)| a.abs_diff(*b));
        let most = differences.clone().max().unwrap();
        let mean = differences.map(f64::from).sum::<f64>() / one.len() as f64;
        assert!(most <= 60 && mean < 0.5, "{most} and {mean} with {join:?}");
    }
}

/// Surface on which every line is drawn by itself.
struct Plain<'p, 't, 'w>(&'p mut Png<'t, 'w>);

impl Surface for Plain<'_, '_, '_> {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        self.0.begin(paint)
    }
    fn move_to(&mut self, to: Position) {
        self.0.move_to(to);
    }
    fn line_to(&mut self, to: Position) {
        self.0.line_to(to);
    }
    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.0.curve_to(a, b, to);
    }
    fn close(&mut self) {
        self.0.close();
    }
    fn hand_on(&mut self) -> io::Result<()> {
        self.0.hand_on()
    }
    fn end(&mut self) -> io::Result<()> {
        self.0.end()
    }
    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<bool> {
        self.0.enter(corner, size)
    }
    fn leave(&mut self) -> io::Result<()> {
        self.0.leave()
    }
}

/// Tree with two different branches.
const TREE: &str = "
title: Tree
initiator: segment
generator:
  connected: false
  elements:
    - {from: [0, 0], to: [1, 0], fertile: false}
    - {from: [1, 0], to: [1 + 0.72*cos(28), 0.72*sin(28)]}
    - {from: [1, 0], to: [1 + 0.68*cos(35), -0.68*sin(35)]}
";

#[test]
fn batched_pictures_are_those_where_every_line_is_drawn() {
    let catalogue = Catalogue::embedded();
    let source = |name: &str| match name {
        "tree" => Source::new("tree.yaml", TREE),
        name => catalogue.component(Shelf::RULES, name).unwrap(),
    };
    let cases = [
        ("tree", 14, 0.15),
        ("tree", 15, 0.06),
        ("tree", 15, 0.3),
        ("binary-tree", 14, 0.15),
        ("binary-tree", 15, 0.3),
        ("h-tree", 14, 0.15),
        ("h-tree", 15, 0.06),
        ("koch", 7, 0.15),
        ("dragon", 15, 0.1),
    ];
    for (name, steps, width) in cases {
        let document = Document::read(&source(name), &catalogue).unwrap();
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let graph = Graph::compile(&rule, steps).unwrap();
        let style = Style {
            width: Width::Relative(width),
            stroke: Some(Colour::BLACK),
            ..Style::default()
        };
        let options = Options {
            style,
            size: Size::Long(128),
            ..Options::default()
        };
        let growth = Growth::steps(steps);
        let layout = Layout::find(&graph, &growth, &options).unwrap();
        let scene = Scene::new(&layout.prepass, &layout.growth, layout.canvas);
        let pixels = |is_batched: bool| {
            with_team(NonZero::<usize>::MIN, |team| {
                let mut png = Png::begin(scene.size(), None, Spare::default(), team).unwrap();
                if is_batched {
                    scene.draw(&mut png, team).unwrap();
                } else {
                    scene.draw(&mut Plain(&mut png), team).unwrap();
                }
                png.settle();
                png.part.pixmap.data().to_vec()
            })
        };
        let (batched, every) = (pixels(true), pixels(false));
        assert!(batched != every, "{name} has no batches");
        let shades = batched.iter().zip(&every);
        let most = shades.map(|(one, other)| one.abs_diff(*other)).max();
        assert!(most <= Some(2), "{name} {steps} {width}: {most:?}");
    }
}

/// A square of opposite orientation inside another one is a hole, in letters of either size.
#[test]
fn letters_have_holes() {
    let square = |from: i64, to: i64| [[from, from], [to, from], [to, to], [from, to]];
    let fill = Paint {
        fill: Some(Colour::BLACK),
        stroke: None,
        has_holes: false,
    };
    for (side, wall) in [(600, 200), (4000, 1000)] {
        let mut hole = square(wall, side - wall);
        hole.reverse();
        let pixels = with_team(NonZero::<usize>::MIN, |team| {
            let mut png = Png::begin(SIZE, None, Spare::default(), team).unwrap();
            png.begin(&Paint {
                has_holes: true,
                ..fill
            })
            .unwrap();
            for contour in [square(0, side), hole] {
                png.move_to(contour[0]);
                contour[1..].iter().for_each(|&vertex| png.line_to(vertex));
                png.close();
            }
            png.end().unwrap();
            // The next path has none.
            png.begin(&fill).unwrap();
            assert!(png.covers);
            png.end().unwrap();
            png.into_pixels().0.take()
        });
        let ink = |place: i64| {
            let place = usize::try_from(place / 100).unwrap();
            pixels[4 * (place * SIZE[0] as usize + place) + 3]
        };
        assert_eq!([wall / 2, side / 2].map(ink), [255, 0], "{side}");
    }
}
