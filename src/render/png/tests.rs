#![allow(clippy::unwrap_used, reason = "a test fails where it unwraps nothing")]

use std::io;
use std::num::NonZero;
use std::sync::Arc;

use crate::catalogue::{Catalogue, Shelf};
use crate::diagnostic::Source;
use crate::document::Document;
use crate::graph::Graph;
use crate::grow::Growth;
use crate::parallel::with_team;
use crate::render::filled::Filled;
use crate::render::layout::Layout;
use crate::render::surface::{Paint, Pen, Position, Stroke, Surface};
use crate::render::{Drawing, Options, Scene, Size};
use crate::style::{Cap, ColorBy, Colour, Join, Style, Width};

use super::Png;

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
    }
}

/// Paths of all the ways in which something is drawn: hairs, round pens, small polygons, and what
/// is left to others.
fn paths() -> Vec<(Paint, Vec<Position>)> {
    let fill = Paint {
        fill: Some(Colour::BLACK),
        stroke: None,
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

/// The pixels of a picture that some threads have drawn.
fn drawn(threads: usize, draw: impl FnOnce(&mut Png<'_, '_>)) -> Vec<u8> {
    with_team(NonZero::new(threads).unwrap(), |team| {
        let mut png = Png::begin(SIZE, None, team).unwrap();
        draw(&mut png);
        png.settle();
        png.part.pixmap.data().to_vec()
    })
}

#[test]
fn the_number_of_threads_does_not_show() {
    let once = paths();
    let mut all = Vec::new();
    for ink in [[0, 0, 0, 255], [200, 90, 0, 255], [0, 90, 200, 100]] {
        let colour = Colour::of_rgba(ink);
        let of_colour = once.iter().cloned().map(|(mut paint, vertices)| {
            paint.fill = paint.fill.map(|_| colour);
            paint.stroke = paint.stroke.map(|stroke| Stroke { colour, ..stroke });
            (paint, vertices)
        });
        // More than one stretch.
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

/// Stretches end anywhere along a path, also where it has only begun.
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

/// A picture on which every line is drawn by itself, and even what is hidden unless it is asked.
struct Plain<'p, 't, 'w> {
    png: &'p mut Png<'t, 'w>,
    hides: bool,
    /// The number of vertices.
    drawn: usize,
}

impl<'p, 't, 'w> Plain<'p, 't, 'w> {
    fn new(png: &'p mut Png<'t, 'w>, hides: bool) -> Self {
        Self {
            png,
            hides,
            drawn: 0,
        }
    }
}

impl Surface for Plain<'_, '_, '_> {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        self.png.begin(paint)
    }
    fn move_to(&mut self, to: Position) {
        self.drawn += 1;
        self.png.move_to(to);
    }
    fn line_to(&mut self, to: Position) {
        self.drawn += 1;
        self.png.line_to(to);
    }
    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.drawn += 1;
        self.png.curve_to(a, b, to);
    }
    fn close(&mut self) {
        self.png.close();
    }
    fn hand_on(&mut self) -> io::Result<()> {
        self.png.hand_on()
    }
    fn end(&mut self) -> io::Result<()> {
        self.png.end()
    }
    fn filled(&mut self, paint: &Paint) -> Option<Arc<Filled>> {
        self.png.filled(paint).filter(|_| self.hides)
    }
    fn layer(&mut self, layer: u64) {
        self.png.layer(layer);
    }
    fn enter(&mut self, corner: [u32; 2], size: [u32; 2]) -> io::Result<()> {
        self.png.enter(corner, size)
    }
    fn leave(&mut self) -> io::Result<()> {
        self.png.leave()
    }
    fn label(&mut self, text: &str) {
        self.png.label(text);
    }
}

/// A tree of two unlike branches.
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
fn combed_pictures_are_those_where_every_line_is_drawn() {
    let catalogue = Catalogue::embedded();
    let source = |name: &str| match name {
        "tree" => Source::new("tree.yaml", TREE),
        name => catalogue.component(Shelf::Rules, name).unwrap(),
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
        let scene = Scene::new(&layout.survey, &layout.growth, layout.canvas);
        let pixels = |is_combed: bool| {
            with_team(NonZero::<usize>::MIN, |team| {
                let mut png = Png::begin(scene.size(), None, team).unwrap();
                if is_combed {
                    scene.draw(&mut png, team).unwrap();
                } else {
                    scene.draw(&mut Plain::new(&mut png, false), team).unwrap();
                }
                png.settle();
                png.part.pixmap.data().to_vec()
            })
        };
        let (combed, every) = (pixels(true), pixels(false));
        assert!(combed != every, "{name} is not combed");
        let shades = combed.iter().zip(&every);
        let most = shades.map(|(one, other)| one.abs_diff(*other)).max();
        assert!(most <= Some(2), "{name} {steps} {width}: {most:?}");
    }
}

/// Squares, each on another one like it.
const TWICE: &str = "
title: Twice
initiator: segment
base_element: square
generator:
  connected: false
  elements:
    - {from: [0, 0], to: [1/2, 0]}
    - {from: [1/2, 0], to: [1, 0]}
    - {from: [0, 1/2], to: [1/2, 1/2]}
    - {from: [1/2, 1/2], to: [1, 1/2]}
    - {from: [0, 0], to: [1/2, 0]}
    - {from: [1/2, 0], to: [1, 0]}
    - {from: [0, 1/2], to: [1/2, 1/2]}
    - {from: [1/2, 1/2], to: [1, 1/2]}
";

/// Also where another colour comes next, and on several threads, some of which look while others
/// draw.
#[test]
fn what_is_hidden_would_not_show() {
    let catalogue = Catalogue::embedded();
    let source = Source::new("twice.yaml", TWICE);
    let document = Document::read(&source, &catalogue).unwrap();
    let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
    let graph = Graph::compile(&rule, 6).unwrap();
    for color_by in [ColorBy::None, ColorBy::Index, ColorBy::Direction] {
        let options = Options {
            style: Style {
                color_by,
                ..Style::default()
            },
            size: Size::Long(150),
            ..Options::default()
        };
        let growth = Growth::steps(6);
        let layout = Layout::find(&graph, &growth, &options).unwrap();
        let scene = Scene::new(&layout.survey, &layout.growth, layout.canvas);
        let drawn = |threads: usize, hides: bool| {
            with_team(NonZero::new(threads).unwrap(), |team| {
                let mut png = Png::begin(scene.size(), None, team).unwrap();
                let mut plain = Plain::new(&mut png, hides);
                scene.draw(&mut plain, team).unwrap();
                let drawn = plain.drawn;
                png.settle();
                (drawn, png.part.pixmap.data().to_vec())
            })
        };
        let (all, every) = drawn(1, false);
        for threads in [1, 3] {
            let (some, seen) = drawn(threads, true);
            assert!(seen == every, "{color_by:?} on {threads} threads");
            // How much is left out on several threads depends on who is faster.
            let is_less = some < all * 3 / 4 || threads > 1 || color_by == ColorBy::Index;
            assert!(is_less, "{color_by:?}: {some} of {all}");
        }
    }
}
