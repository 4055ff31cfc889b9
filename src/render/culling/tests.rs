//! Tests of culling: a window shows the same as the whole approximant does there.

use std::collections::BTreeMap;
use std::convert::Infallible;
use std::io;
use std::num::NonZero;
use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::catalogue::{Catalogue, Shelf};
use crate::diagnostic::Source;
use crate::document::Document;
use crate::grow::{Element, Visitor, walk};
use crate::parallel::with_team;
use crate::random_rules::{self as rules, Features};
use crate::render::canvas::Size;
use crate::render::drawing::Drawing;
use crate::render::layout::Layout;
use crate::render::options::{Detail, Options};
use crate::render::paint::{Paint, Position};
use crate::render::prepass::Prepass;
use crate::render::scene::Scene;
use crate::render::surface::Surface;
use crate::rule::Rule;
use crate::style::{Colour, View};

/// Side of the pictures, in pixels.
const SIDE: u32 = 100;

/// Recorded paths: polygons that include the control points of curves, each with its paint and whether it is
/// closed.
#[derive(Default)]
struct Recorder {
    paint: Paint,
    paths: Vec<(Paint, Vec<Position>, bool)>,
}

impl Recorder {
    fn vertices(&mut self) -> &mut Vec<Position> {
        &mut self.paths.last_mut().unwrap().1
    }
}

impl Surface for Recorder {
    fn begin(&mut self, paint: &Paint) -> io::Result<()> {
        self.paint = *paint;
        Ok(())
    }

    fn move_to(&mut self, to: Position) {
        self.paths.push((self.paint, vec![to], false));
    }

    fn line_to(&mut self, to: Position) {
        self.vertices().push(to);
    }

    fn curve_to(&mut self, a: Position, b: Position, to: Position) {
        self.vertices().extend([a, b, to]);
    }

    fn close(&mut self) {
        let start = self.vertices()[0];
        self.vertices().push(start);
        self.paths.last_mut().unwrap().2 = true;
    }

    fn hand_on(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn end(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn enter(&mut self, _: [u32; 2], _: [u32; 2]) -> io::Result<bool> {
        unreachable!("pictures have no parts")
    }

    fn leave(&mut self) -> io::Result<()> {
        unreachable!("pictures have no parts")
    }
}

/// Returns the winding number of a path about a point. The point is in fiftieths of the unit of positions, so
/// that no vertex is at its height.
fn turns(path: &[Position], [x, y]: [i64; 2]) -> i64 {
    let ends = path.iter().zip(path.iter().cycle().skip(1));
    let crossings = ends.map(|(from, to)| {
        let [[x0, y0], [x1, y1]] =
            [from, to].map(|end| [50 * end[0] - x, 50 * end[1] - y].map(i128::from));
        let left = (x0 * y1 - x1 * y0).signum();
        match (y0 < 0, y1 < 0) {
            (true, false) if left < 0 => -1,
            (false, true) if left > 0 => 1,
            _ => 0,
        }
    });
    crossings.sum()
}

/// Returns whether a line meets a square.
fn meets([from, to]: [Position; 2], edge: i64) -> bool {
    let beside = |axis: usize| {
        let places = [from[axis], to[axis]];
        places.iter().all(|&place| place < 0) || places.iter().all(|&place| place > edge)
    };
    let sides = [[0, 0], [edge, 0], [0, edge], [edge, edge]].map(|corner: Position| {
        let [[x0, y0], [x1, y1]] =
            [to, corner].map(|end| [end[0] - from[0], end[1] - from[1]].map(i128::from));
        (x0 * y1 - x1 * y0).signum()
    });
    let passes = sides.iter().all(|&side| side == 1) || sides.iter().all(|&side| side == -1);
    !beside(0) && !beside(1) && !passes
}

/// Returns the visible features of a picture: lines with their paint, the corners at their ends if these are
/// visible, and the winding numbers of filled paths about some points.
fn shown(recorder: &Recorder, with_corners: bool) -> BTreeMap<String, i64> {
    let edge = i64::from(SIDE) * 100;
    let mut shown = BTreeMap::new();
    let mut add = |what: String, count: i64| *shown.entry(what).or_default() += count;
    for (paint, vertices, is_closed) in &recorder.paths {
        for ends in vertices.windows(2) {
            if meets([ends[0], ends[1]], edge) {
                add(format!("{paint:?} {ends:?}"), 1);
            }
        }
        let wrapped = is_closed.then(|| [vertices[vertices.len() - 2], vertices[0], vertices[1]]);
        let corners = vertices.windows(3).chain(wrapped.as_ref().map(|w| &w[..]));
        for corner in corners {
            if with_corners && corner[1].iter().all(|place| (0..=edge).contains(place)) {
                add(format!("{paint:?} corner {corner:?}"), 1);
            }
        }
        if paint.fill.is_some() {
            for place in (0..25).map(|n| [n % 5, n / 5].map(|at| at * edge * 10 + 21)) {
                add(
                    format!("{:?} around {place:?}", paint.fill),
                    turns(vertices, place),
                );
            }
        }
    }
    shown.retain(|_, count| *count != 0);
    shown
}

/// Compares the drawings of a window with and without culling. Returns the numbers of elements visited.
fn compare(
    rule: &Arc<Rule>,
    steps: u32,
    window: [f64; 4],
    style: &Style,
    detail: Option<f64>,
) -> [u64; 2] {
    let graph = Graph::compile(rule, steps).unwrap();
    let options = Options {
        size: Size::Exactly(SIDE, SIDE),
        view: View {
            window: Some(window),
            margin: Some(0.0),
        },
        style: style.clone(),
        detail: detail
            .filter(|_| !graph.counts_index())
            .map(|pixels| Detail {
                pixels,
                decides_steps: false,
            }),
        ..Options::default()
    };
    let growth = Growth::steps(steps);
    let layout = Layout::find(&graph, &growth, &options).unwrap();
    let Layout {
        prepass, canvas, ..
    } = layout;
    let shortest = options
        .detail
        .map_or(0.0, |detail| detail.pixels / canvas.scale());
    let everything = Culling::to_length(&graph, shortest);
    let mut all = Prepass::new(&graph, style, layout.growth.steps).of_what_is_in(everything);
    // The walk visits and counts all elements.
    walk(&graph, &growth, &mut all).unwrap();
    let draw = |scene: &Scene<'_>, threads: usize| {
        let mut recorder = Recorder::default();
        let threads = NonZero::new(threads).unwrap();
        with_team(threads, |team| scene.draw(&mut recorder, team)).unwrap();
        // Round caps look like a round corner.
        shown(&recorder, style.join != Join::Round)
    };
    let some_shown = draw(&Scene::new(&prepass, &layout.growth, canvas), 2);
    let all_shown = draw(&Scene::new(&all, &growth, canvas), 1);
    for (what, count) in &all_shown {
        assert_eq!(some_shown.get(what), Some(count), "{what} is missing");
    }
    for (what, count) in &some_shown {
        assert_eq!(all_shown.get(what), Some(count), "{what} is too much");
    }
    [prepass.elements, all.elements]
}

fn read(text: &str) -> Arc<Rule> {
    let source = Source::new("random.yaml", text);
    let document = Document::read(&source, &Catalogue::embedded()).unwrap();
    document.resolve(&[]).unwrap().0.into_rule().unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn windows_of_random_rules_show_their_part(
        text in rules::rule(Features { free_index: false, ..Features::ALL }),
        steps in 0..5u32,
        (x, y) in (-4..9i32, -4..5i32),
        fill in any::<bool>(),
        relative in any::<bool>(),
        join in prop_oneof![Just(Join::Round), Just(Join::Miter)],
        color_by in prop_oneof![
            Just(ColorBy::None), Just(ColorBy::Step), Just(ColorBy::Direction), Just(ColorBy::Index),
        ],
        detail in prop_oneof![Just(None), Just(Some(3.0)), Just(Some(20.0))],
    ) {
        let style = Style {
            fill: fill.then_some(Colour::BLACK),
            width: if relative { Width::Relative(0.3) } else { Width::Pixels(2.0) },
            join,
            color_by,
            ..Style::default()
        };
        let window = [f64::from(x) / 7.0, f64::from(y) / 7.0, 0.15, 0.15];
        compare(&read(&text), steps, window, &style, detail);
    }
}

#[test]
fn windows_of_the_library_show_their_part() {
    let catalogue = Catalogue::embedded();
    // Lines, links, areas, polygons, curves, seeds, draws; with the greatest part of the elements to be
    // visited.
    for (name, steps, part) in [
        ("koch", 5, 0.2),
        ("dragon", 9, 0.3),
        ("hilbert", 5, 0.2),
        ("peano", 3, 0.2),
        ("koch-snowflake", 4, 0.3),
        ("pythagoras", 8, 0.6),
        ("self-seeding-square", 3, 0.7),
        ("mandala", 3, 0.6),
        ("base-element", 4, 0.3),
        ("penrose-stars", 3, 0.9),
        ("terdragon", 6, 0.2),
        ("vegetation", 2, 1.0),
        ("archipelago", 2, 1.0),
        ("sea-fan", 6, 1.0),
        ("random-tree", 8, 0.6),
        ("fern", 6, 0.9),
    ] {
        let source = catalogue.component(Shelf::RULES, name).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let plain = Style {
            color_by: ColorBy::Step,
            fill: None,
            ..rule.style().clone()
        };
        let numbered = Style {
            color_by: ColorBy::Index,
            ..plain.clone()
        };
        let filled = Style {
            fill: Some(Colour::BLACK),
            color_by: ColorBy::None,
            join: Join::Miter,
            ..plain.clone()
        };
        let draws = rule.is_random();
        let mut visited = [0, 0];
        for number in 0..16 {
            let corner = [f64::from(number % 4), f64::from(number / 4)].map(|n| n / 3.0 - 0.15);
            let window = [corner[0], corner[1], 0.07, 0.06];
            // If ranks depend on draws, all elements are visited.
            let styles = [&plain, &filled, &numbered].into_iter();
            for style in styles.take(if draws { 2 } else { 3 }) {
                let counts = compare(&rule, steps, window, style, None);
                visited = [visited[0] + counts[0], visited[1] + counts[1]];
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
        let visited = visited[0] as f64 / visited[1] as f64;
        assert!(visited <= part, "{name}: {visited}");
    }
}

/// Includes elements of unequal lengths, and fractals that are closed or seeded.
#[test]
fn ranks_count_what_is_not_visited() {
    let catalogue = Catalogue::embedded();
    for name in [
        "snowflake-sweep",
        "cesaro-sweep",
        "peano-mandelbrot",
        "dragon-wreath",
        "gosper",
        "koch-snowflake",
        "pythagoras",
        "snow-crystal",
        "mandala",
    ] {
        let source = catalogue.component(Shelf::RULES, name).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let style = |fill: Option<Colour>| Style {
            color_by: ColorBy::Index,
            fill,
            ..rule.style().clone()
        };
        let mut visited = [0, 0];
        for (number, fill) in [None, Some(Colour::BLACK)]
            .into_iter()
            .cycle()
            .take(2)
            .enumerate()
        {
            let corner = [0.4, 0.05 + number as f64 / 4.0];
            let window = [corner[0], corner[1] - 0.3, 0.09, 0.09];
            let counts = compare(&rule, 4, window, &style(fill), Some(8.0));
            visited = [visited[0] + counts[0], visited[1] + counts[1]];
        }
        assert!(visited[0] < visited[1], "{name}: {visited:?}");
    }
}

/// Each of the 64 elements of the third step becomes a 64th of Hilbert's curve, so that its colour identifies
/// it, whatever the number of steps: 4^36 elements exceed 64 bits.
#[test]
fn ranks_may_be_larger_than_any_walk_counts() {
    let catalogue = Catalogue::embedded();
    let name = "hilbert";
    for detail in [None, Some(16.0)] {
        let source = catalogue.rule(name).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let model = document.resolve(&[]).unwrap().0;
        let style = Style {
            color_by: ColorBy::Index,
            ..model.metadata().style.clone()
        };
        let rough = model.compile(3).unwrap();
        let growth = Growth::steps(3);
        let mut cells = Cells::default();
        walk(&rough, &growth, &mut cells).unwrap();
        assert_eq!(cells.0.len(), 64);
        let graph = model.compile(36).unwrap();
        let growth = Growth::steps(36);
        let mut classes = Classes::before_survey(&style, &graph, 36);
        classes = classes.after_survey(1, 64);
        for (class, middle) in (0..).zip(cells.0) {
            let [x, y] = [middle.x - 1e-10, middle.y - 1e-10];
            let options = Options {
                size: Size::Exactly(SIDE, SIDE),
                view: View {
                    window: Some([x, y, 2e-10, 2e-10]),
                    margin: Some(0.0),
                },
                style: style.clone(),
                detail: detail.map(|pixels| Detail {
                    pixels,
                    decides_steps: true,
                }),
                ..Options::default()
            };
            let layout = Layout::find(&graph, &growth, &options).unwrap();
            let mut recorder = Recorder::default();
            let scene = Scene::new(&layout.prepass, &layout.growth, layout.canvas);
            with_team(NonZero::new(3).unwrap(), |team| {
                scene.draw(&mut recorder, team)
            })
            .unwrap();
            let colour = classes.colour(class, &style);
            let strokes = recorder.paths.iter().map(|(paint, ..)| paint.stroke);
            let mut colours = strokes.map(|stroke| stroke.map(|stroke| stroke.colour));
            assert!(
                !recorder.paths.is_empty() && colours.all(|of| of == colour),
                "{class}"
            );
        }
    }
}

/// Centres of elements.
#[derive(Default)]
struct Cells(Vec<DVec2>);

impl Visitor for Cells {
    type Error = Infallible;

    fn element(&mut self, element: &Element) -> Result<(), Infallible> {
        self.0.push(element.frame.apply(DVec2::new(0.5, 0.5)));
        Ok(())
    }
}

/// Elements born after the steps that a pass paints are left out of its walk.
#[test]
fn colours_by_step_leave_out_nothing() {
    let catalogue = Catalogue::embedded();
    for name in [
        "random-tree",
        "hilbert",
        "mandala",
        "koch-snowflake",
        "t-square",
        "archipelago",
    ] {
        let source = catalogue.component(Shelf::RULES, name).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let graph = Graph::compile(&rule, 4).unwrap();
        let growth = Growth::steps(4);
        let drawn = |color_by: ColorBy| {
            let options = Options {
                style: Style {
                    color_by,
                    fill: None,
                    stroke: None,
                    ..rule.style().clone()
                },
                ..Options::default()
            };
            let Layout {
                prepass, canvas, ..
            } = Layout::find(&graph, &growth, &options).unwrap();
            let mut recorder = Recorder::default();
            let scene = Scene::new(&prepass, &growth, canvas);
            with_team(NonZero::<usize>::MIN, |team| {
                scene.draw(&mut recorder, team)
            })
            .unwrap();
            let paths = recorder.paths.iter().map(|(_, vertices, _)| vertices);
            let pairs = paths.flat_map(|vertices| vertices.windows(2).map(<[_]>::to_vec));
            let mut pairs: Vec<_> = pairs.collect();
            pairs.sort();
            pairs
        };
        assert_eq!(drawn(ColorBy::Step), drawn(ColorBy::None), "{name}");
    }
}

#[test]
fn links_to_what_lies_outside_are_drawn() {
    let rule = read(
        "initiator: segment\ngenerator: [[0, 0], [1/2, 0], [1, 0]]\n\
         base_element: {points: [[0.45, 0.05], [0.55, 0.05]]}\n",
    );
    for number in 0..50 {
        let window = [f64::from(number) / 50.0, 0.0, 0.01, 0.01];
        let visited = compare(&rule, 3, window, &Style::default(), None);
        assert!(visited[0] < visited[1]);
    }
}
