//! What is drawn in a window is what all of it would draw there.

use std::collections::BTreeMap;
use std::io;
use std::num::NonZero;
use std::sync::Arc;

use proptest::prelude::*;

use super::*;
use crate::catalogue::{Catalogue, Shelf};
use crate::diagnostic::Source;
use crate::document::Document;
use crate::parallel::with_team;
use crate::random_rules::{self as rules, Features};
use crate::render::layout::Layout;
use crate::render::{
    Canvas, Detail, Drawing, Options, Paint, Position, Scene, Size, Surface, Survey,
};
use crate::rule::Rule;
use crate::style::{Colour, View};

/// The side of the pictures, in pixels.
const SIDE: u32 = 100;

/// Paths as polygons with the control points of curves, each with its paint, and whether closed.
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

    fn enter(&mut self, _: [u32; 2], _: [u32; 2]) -> io::Result<()> {
        unreachable!("pictures have no parts")
    }

    fn leave(&mut self) -> io::Result<()> {
        unreachable!("pictures have no parts")
    }

    fn label(&mut self, _: &str) {}
}

/// How often a path goes around a place, in a fiftieth of what positions are whole numbers of, so
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

/// Whether a line meets a square.
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

/// What shows on a picture: pieces with their paint, the corners at their ends if these show, and
/// how often what is filled goes around some places.
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

/// Draws a window with and without looking at what lies outside, and tells how many elements were
/// visited.
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
            margin: 0.0,
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
    let Layout { survey, canvas, .. } = Layout::find(&graph, &growth, &options).unwrap();
    let everything = Sight {
        window: None,
        ..survey.sight().clone()
    };
    let all = Survey::new(&graph, style, steps).of_what_is_in(everything);
    let all = all.walked(&growth, NonZero::<usize>::MIN).unwrap();
    let draw = |survey: &Survey<'_>, canvas: Canvas| {
        let mut recorder = Recorder::default();
        let scene = Scene::new(survey, &growth, canvas);
        with_team(NonZero::<usize>::MIN, |team| {
            scene.draw(&mut recorder, team)
        })
        .unwrap();
        // Round caps look like a round corner.
        shown(&recorder, style.join != Join::Round)
    };
    let (some_shown, all_shown) = (draw(&survey, canvas), draw(&all, canvas));
    for (what, count) in &all_shown {
        assert_eq!(some_shown.get(what), Some(count), "{what} is missing");
    }
    for (what, count) in &some_shown {
        assert_eq!(all_shown.get(what), Some(count), "{what} is too much");
    }
    [survey.elements, all.elements]
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
        color_by in prop_oneof![Just(ColorBy::None), Just(ColorBy::Step), Just(ColorBy::Direction)],
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
    // Lines, links, areas, polygons, curves, seeds, draws; with what part of all is to be visited.
    for (name, steps, part) in [
        ("koch", 5, 0.2),
        ("dragon", 9, 0.3),
        ("hilbert", 5, 0.2),
        ("peano", 3, 0.2),
        ("koch-snowflake", 4, 0.3),
        ("pythagoras", 8, 0.6),
        ("self-seeding-square", 3, 0.6),
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
        let source = catalogue.component(Shelf::Rules, name).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let plain = Style {
            // Where elements are numbered, all are visited.
            color_by: ColorBy::Step,
            fill: None,
            ..rule.style().clone()
        };
        let filled = Style {
            fill: Some(Colour::BLACK),
            color_by: ColorBy::None,
            join: Join::Miter,
            ..plain.clone()
        };
        let mut visited = [0, 0];
        for number in 0..16 {
            let corner = [f64::from(number % 4), f64::from(number / 4)].map(|n| n / 3.0 - 0.15);
            let window = [corner[0], corner[1], 0.07, 0.06];
            for style in [&plain, &filled] {
                let counts = compare(&rule, steps, window, style, None);
                visited = [visited[0] + counts[0], visited[1] + counts[1]];
            }
        }
        #[expect(clippy::cast_precision_loss, reason = "the numbers are small")]
        let visited = visited[0] as f64 / visited[1] as f64;
        assert!(visited <= part, "{name}: {visited}");
    }
}

/// What is born after what a pass paints is left out of its walk.
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
        let source = catalogue.component(Shelf::Rules, name).unwrap();
        let document = Document::read(&source, &catalogue).unwrap();
        let rule = document.resolve(&[]).unwrap().0.into_rule().unwrap();
        let graph = Graph::compile(&rule, 4).unwrap();
        let growth = Growth::steps(4);
        let drawn = |color_by: ColorBy| {
            let options = Options {
                style: Style {
                    color_by,
                    fill: None,
                    ..rule.style().clone()
                },
                ..Options::default()
            };
            let Layout { survey, canvas, .. } = Layout::find(&graph, &growth, &options).unwrap();
            let mut recorder = Recorder::default();
            let scene = Scene::new(&survey, &growth, canvas);
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
